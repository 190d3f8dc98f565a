//! Watertightness, crossings, surfaces and spawned rays of meshes; against brute force, and twins that leak.

use proptest::prelude::*;
use snell_math::Transform;

use super::*;
use crate::accel::random::Random;

fn mesh(positions: Vec<[f32; 3]>, triangles: Vec<[u32; 3]>) -> TriangleMesh {
    TriangleMesh::new(&Mesh { positions, triangles, ..Mesh::default() }).expect("a good mesh")
}

/// The octahedron of radius 1, every triangle cut in four `levels` times, its vertices on the unit sphere.
fn octasphere(levels: usize) -> (Vec<[f64; 3]>, Vec<[u32; 3]>) {
    let mut positions: Vec<Vector3> = vec![Vector3::X, -Vector3::X, Vector3::Y, -Vector3::Y, Vector3::Z, -Vector3::Z];
    let mut triangles = vec![[0, 2, 4], [2, 1, 4], [1, 3, 4], [3, 0, 4], [2, 0, 5], [1, 2, 5], [3, 1, 5], [0, 3, 5]];
    for _ in 0..levels {
        let mut middles = std::collections::BTreeMap::new();
        let mut middle = |a: u32, b: u32| {
            *middles.entry((a.min(b), a.max(b))).or_insert_with(|| {
                positions.push((positions[a as usize] + positions[b as usize]).normalize());
                positions.len() as u32 - 1
            })
        };
        let mut finer = Vec::new();
        for [a, b, c] in triangles {
            let (ab, bc, ca) = (middle(a, b), middle(b, c), middle(c, a));
            finer.extend([[a, ab, ca], [ab, b, bc], [ca, bc, c], [ab, bc, ca]]);
        }
        triangles = finer;
    }
    (positions.iter().map(|p| p.to_array()).collect(), triangles)
}

/// A torus about the z axis of radii 1 and 0.4.
fn torus(around: u32, across: u32) -> (Vec<[f64; 3]>, Vec<[u32; 3]>) {
    let turn = |i: u32, n: u32| {
        let angle = f64::from(i) / f64::from(n) * std::f64::consts::TAU;
        (snell_math::portable::cos(angle), snell_math::portable::sin(angle))
    };
    let (mut positions, mut triangles) = (Vec::new(), Vec::new());
    for i in 0..around {
        for j in 0..across {
            let ((x, y), (out, up)) = (turn(i, around), turn(j, across));
            positions.push([x * (1.0 + 0.4 * out), y * (1.0 + 0.4 * out), 0.4 * up]);
            let at = |i: u32, j: u32| i % around * across + j % across;
            triangles.push([at(i, j), at(i + 1, j), at(i + 1, j + 1)]);
            triangles.push([at(i, j), at(i + 1, j + 1), at(i, j + 1)]);
        }
    }
    (positions, triangles)
}

/// Moved by a transform and rounded to `f32`.
fn placed((positions, triangles): (Vec<[f64; 3]>, Vec<[u32; 3]>), place: &Transform) -> TriangleMesh {
    let positions = positions.into_iter().map(|p| place.point(p.into()).to_array().map(|x| x as f32)).collect();
    mesh(positions, triangles)
}

/// The number of crossings, and those from the front less those from the back.
fn crossings(mesh: &TriangleMesh, ray: &Ray, t_min: f64) -> (usize, i32) {
    let (mut count, mut sum) = (0, 0);
    let _ = mesh.for_each_hit(ray, t_min, f64::INFINITY, |hit| {
        count += 1;
        sum += if hit.front { 1 } else { -1 };
        ControlFlow::Continue(())
    });
    (count, sum)
}

/// A point of the mesh at a vertex, on an edge, or inside of a triangle.
fn target(mesh: &TriangleMesh, random: &mut Random) -> Point3 {
    let [a, b, c] = mesh.corners(random.index(mesh.triangles.len()) as u32).map(point);
    match random.index(3) {
        0 => a,
        1 => a.lerp(b, 0.5 + 0.5 * random.number()),
        _ => a.lerp(b, 0.3).lerp(c, 0.4),
    }
}

/// Sends rays at vertices, edges and faces from a point: all must cross as often as from inside (or outside) they must.
fn check_parity(mesh: &TriangleMesh, from: Point3, inside: bool, rays: usize, random: &mut Random) {
    for i in 0..rays {
        let direction = if i % 4 == 0 { random.vector() } else { target(mesh, random) - from };
        let ray = Ray::new(from, direction);
        let (count, sum) = crossings(mesh, &ray, 0.0);
        assert_eq!((count % 2 == 1, sum), (inside, -i32::from(inside)), "{count} crossings of {ray:?}");
        assert_eq!(crossings(mesh, &ray, f64::NEG_INFINITY).1, 0, "the whole line of {ray:?}");
        if inside {
            let hit = mesh.intersect(&ray, 0.0, f64::INFINITY).expect("no way out");
            // At a vertex of a silhouette the line may leave, enter and leave again within the rounding of t.
            assert!(!hit.front || crossings(mesh, &ray, hit.t * (1.0 + 1e-14)) == (1, -1), "{hit:?} of {ray:?}");
        }
    }
    assert_eq!(mesh.contains(from), inside);
}

#[test]
fn closed_meshes_are_watertight_at_all_scales() {
    let mut random = Random(1);
    for scale in [1e-3, 1.0, 1e3, 1e6] {
        let place = Transform::translate(random.vector() * scale)
            * Transform::scale(Vector3::new(scale, 0.7 * scale, 1.3 * scale))
            * Transform::rotate(Vector3::new(0.6, 0.0, 0.8), 1.0);
        for (shape, center) in [(octasphere(3), Point3::ORIGIN), (torus(24, 16), Point3::new(1.0, 0.0, 0.0))] {
            let mesh = placed(shape, &place);
            assert!(mesh.is_closed());
            for _ in 0..10 {
                check_parity(&mesh, place.point(center + random.vector() * 0.2), true, 200, &mut random);
                let outside = random.vector().try_normalize().expect("not zero") * (2.0 + 20.0 * random.number().abs());
                check_parity(&mesh, place.point(Point3::ORIGIN + outside), false, 200, &mut random);
            }
        }
    }
}

#[test]
fn lines_through_vertices_and_along_edges_are_counted_right() {
    // Whole numbers, so that the rays pass exactly through vertices, through edges, and in the planes of faces.
    let (positions, triangles) = octasphere(0);
    let octahedron = mesh(positions.iter().map(|p| p.map(|x| 4.0 * x as f32)).collect(), triangles);
    let cube = cube(4.0);
    for mesh in [octahedron, cube] {
        assert!(mesh.is_closed());
        let mut on_border = 0;
        for i in 0..13 * 13 * 13 {
            let direction = Vector3::from([i / 169, i / 13 % 13, i % 13].map(|x: i32| f64::from(x - 6)));
            for (from, inside) in
                [(Point3::ORIGIN, true), (Point3::new(1.0, -1.0, 1.0), true), (Point3::new(8.0, 4.0, -4.0), false)]
            {
                let ray = Ray::new(from, direction);
                if direction == Vector3::ZERO {
                    assert_eq!(crossings(&mesh, &ray, 0.0), (0, 0));
                    continue;
                }
                let (count, sum) = crossings(&mesh, &ray, 0.0);
                assert_eq!((count % 2 == 1, sum), (inside, -i32::from(inside)), "{ray:?}");
                if inside {
                    let hit = mesh.intersect(&ray, 0.0, f64::INFINITY).expect("no way out");
                    on_border += usize::from(hit.barycentric.contains(&0.0));
                }
            }
        }
        assert!(on_border > 500, "{on_border}");
    }
}

/// Corners at ±`half`; every face has four vertices of its own.
fn cube(half: f32) -> TriangleMesh {
    let (mut positions, mut triangles) = (Vec::new(), Vec::new());
    for face in 0..6 {
        let (axis, side) = (face / 2, if face % 2 == 0 { 1.0 } else { -1.0 });
        let first = positions.len() as u32;
        for (u, v) in [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)] {
            let mut p = [0.0; 3];
            (p[axis], p[(axis + 1) % 3], p[(axis + 2) % 3]) = (side * half, u * side * half, v * half);
            positions.push(p);
        }
        triangles.extend([[first, first + 1, first + 2], [first, first + 2, first + 3]]);
    }
    mesh(positions, triangles)
}

/// The twin: the usual test (Möller and Trumbore, JGT 2(1), 1997), every triangle for itself, in `f32` and even in `f64`,
/// lets rays from inside of a closed mesh out.
#[test]
fn the_usual_test_leaks() {
    let mut random = Random(2);
    let place = Transform::rotate(Vector3::new(0.6, 0.0, 0.8), 1.0);
    let mesh = placed(octasphere(3), &place);
    let (mut leaks_32, mut leaks_64) = (0, 0);
    for _ in 0..10_000 {
        let from = random.point();
        let from = Point3::from(from.to_array().map(|x| f64::from(0.5 * x as f32)));
        let ray = Ray::new(from, target(&mesh, &mut random) - from);
        let all = 0..mesh.triangles.len() as u32;
        leaks_32 += usize::from(!all.clone().any(|i| usual_test_32(&ray, mesh.corners(i))));
        leaks_64 += usize::from(!all.clone().any(|i| usual_test_64(&ray, mesh.corners(i))));
        assert!(mesh.intersect(&ray, 0.0, f64::INFINITY).is_some());
    }
    assert!(leaks_32 > 10 && leaks_64 > 10, "{leaks_32} {leaks_64}");
}

macro_rules! usual_test {
    ($name:ident, $float:ty) => {
        fn $name(ray: &Ray, corners: [[f32; 3]; 3]) -> bool {
            type V = [$float; 3];
            let cross = |a: V, b: V| [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
            let dot = |a: V, b: V| a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
            let minus = |a: V, b: V| [a[0] - b[0], a[1] - b[1], a[2] - b[2]];
            let [a, b, c] = corners.map(|corner| corner.map(|x| x as $float));
            let (origin, d) =
                (ray.origin.to_array().map(|x| x as $float), ray.direction.to_array().map(|x| x as $float));
            let (ab, ac, s) = (minus(b, a), minus(c, a), minus(origin, a));
            let (p, q) = (cross(d, ac), cross(s, ab));
            let inverse = 1.0 / dot(ab, p);
            let (u, v, t) = (dot(s, p) * inverse, dot(d, q) * inverse, dot(ac, q) * inverse);
            u >= 0.0 && v >= 0.0 && u + v <= 1.0 && t > 0.0
        }
    };
}
usual_test!(usual_test_32, f32);
usual_test!(usual_test_64, f64);

/// Triangles of all sizes, some twice, some without area.
fn soup(random: &mut Random, count: usize, scale: f64) -> TriangleMesh {
    let (mut positions, mut triangles) = (Vec::new(), Vec::new());
    for i in 0..count {
        let first = positions.len() as u32;
        let size = random.number() * random.number();
        let center = random.vector();
        for _ in 0..3 {
            positions.push(((center + random.vector() * size) * scale).to_array().map(|x| x as f32));
        }
        triangles.push(match i % 7 {
            3 => [first, first, first + 1],
            4 => triangles[random.index(i)],
            5 => [first, first + 1, random.index(positions.len()) as u32],
            _ => [first, first + 1, first + 2],
        });
    }
    mesh(positions, triangles)
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 100, failure_persistence: None, ..ProptestConfig::default() })]
    #[test]
    fn agrees_with_brute_force(seed in any::<u64>(), count in 1..60_usize, scale in prop::sample::select(vec![1e-3, 1.0, 1e6])) {
        let mut random = Random(seed);
        let mesh = soup(&mut random, count, scale);
        for i in 0..200 {
            let origin = Point3::ORIGIN + random.vector() * (2.0 * scale);
            let direction = if i % 2 == 0 { random.vector() } else { target(&mesh, &mut random) - origin };
            let ray = Ray::new(origin, direction);
            let t_min = if i % 5 == 0 { -0.5 } else { 0.0 };
            let t_max = if i % 3 == 0 { 1.0 } else { f64::INFINITY };
            let space = RaySpace::new(&ray).expect("a direction");
            let whole = |i: u32| { let [a, b, c] = mesh.corners(i); a != b && b != c && c != a };
            let ids = || (0..mesh.triangles.len() as u32).filter(|i| whole(*i));
            let in_range = |m: &Meeting| t_min < m.t && m.t <= t_max;
            let closest = ids()
                .filter_map(|i| Some((i, space.meet::<f64>(mesh.corners(i)).filter(in_range)?)))
                .min_by(|a, b| a.1.t.total_cmp(&b.1.t).then(a.0.cmp(&b.0)))
                .map(|(i, meeting)| MeshHit::new(i, meeting));
            prop_assert_eq!(mesh.intersect(&ray, t_min, t_max), closest);
            let all: Vec<u32> = ids().filter(|i| space.meet::<f64>(mesh.corners(*i)).as_ref().is_some_and(in_range)).collect();
            let mut found = Vec::new();
            let _ = mesh.for_each_hit(&ray, t_min, t_max, |hit| { found.push(hit.triangle); ControlFlow::Continue(()) });
            found.sort_unstable();
            prop_assert_eq!(mesh.any(&ray, t_min, t_max), !all.is_empty());
            prop_assert_eq!(found, all);
        }
    }

    #[test]
    fn spawned_rays_do_not_meet_their_plane(seed in any::<u64>(), power in prop::sample::select(vec![-10, 0, 10, 20_i32])) {
        let mut random = Random(seed);
        // A power of two between 1e-3 and 1e6, so that the plane below is exact.
        let scale = if power < 0 { 1.0 / f64::from(1 << -power) } else { f64::from(1 << power) };
        // One triangle in general position, and a plane of many, whose coordinates are exact, of very different sizes.
        let corners = [0, 1, 2].map(|_| (random.vector() * scale).to_array().map(|x| x as f32));
        let single = mesh(corners.to_vec(), vec![[0, 1, 2]]);
        let (mut positions, mut triangles) = (Vec::new(), Vec::new());
        for i in -6..=6_i32 {
            for j in -6..=6_i32 {
                let spread = |i: i32| (i * i * i * i * i) as f32 * (scale as f32 / 65536.0);
                let (x, z) = (spread(i), spread(j));
                positions.push([x, 0.5 * x - 0.25 * z, z]);
                if i < 6 && j < 6 {
                    let at = ((i + 6) * 13 + j + 6) as u32;
                    triangles.extend([[at, at + 1, at + 13], [at + 1, at + 14, at + 13]]);
                }
            }
        }
        let plane = mesh(positions, triangles);
        for mesh in [single, plane] {
            for _ in 0..50 {
                let aim = target(&mesh, &mut random);
                let origin = aim + random.vector() * scale;
                let ray = Ray::new(origin, (aim - origin).normalize());
                let Some(hit) = mesh.intersect(&ray, 0.0, f64::INFINITY) else { continue };
                let surface = mesh.surface(&ray, &hit);
                prop_assert!(surface.error < 1e-13 * scale && surface.point.distance(ray.at(hit.t)) < 1e-9 * scale);
                let normal = surface.geometric_normal.as_vector();
                let (tangent, _) = normal.orthonormal_basis();
                let around = (tangent * random.number() + normal.cross(tangent) * random.number()).normalize();
                for rise in [1.0, 1e-2, 1e-5, 1e-8, 1e-10, 1e-12, 1e-14] {
                    for side in [1.0, -1.0] {
                        let start = surface.point + normal * (side * surface.error);
                        let away = Ray::new(start, (around + normal * (side * rise)).normalize());
                        let again = mesh.intersect(&away, 0.0, f64::INFINITY);
                        prop_assert!(again.is_none(), "{again:?} rising {rise}");
                        prop_assert!(!mesh.any(&away, 0.0, f64::INFINITY));
                    }
                }
            }
        }
    }
}

/// The twin: from the point itself, without the offset, many rays meet their triangle again.
#[test]
fn without_offset_rays_meet_their_plane() {
    let mut random = Random(6);
    let mut again = 0;
    for _ in 0..1000 {
        let corners = [0, 1, 2].map(|_| random.vector().to_array().map(|x| x as f32));
        let mesh = mesh(corners.to_vec(), vec![[0, 1, 2]]);
        let ray = Ray::new(Point3::ORIGIN, target(&mesh, &mut random).to_vector());
        let Some(hit) = mesh.intersect(&ray, 0.0, f64::INFINITY) else { continue };
        let surface = mesh.surface(&ray, &hit);
        let away = Ray::new(surface.point, surface.geometric_normal.as_vector());
        again += usize::from(mesh.any(&away, 0.0, f64::INFINITY));
    }
    assert!(again > 100, "{again}");
}

#[test]
fn an_edge_belongs_to_one_triangle() {
    let positions = vec![[0.0, 0.0, 0.0], [4.0, 0.0, 0.0], [4.0, 4.0, 0.0], [0.0, 4.0, 0.0], [2.0, 2.0, 0.0]];
    let fan = mesh(positions, vec![[2, 3, 4], [3, 0, 4], [0, 1, 4], [1, 2, 4]]);
    for (x, y) in [(2.0, 2.0), (1.0, 1.0), (3.0, 3.0), (1.0, 3.0), (3.0, 1.0)] {
        for z in [-3.0, 3.0] {
            let ray = Ray::new(Point3::new(x, y, z), Vector3::new(0.0, 0.0, -z));
            assert_eq!(fan.intersect(&ray, 0.0, 1.0).map(|hit| hit.t), Some(1.0));
            assert_eq!(crossings(&fan, &ray, 0.0), (1, if z > 0.0 { 1 } else { -1 }));
            assert_eq!(fan.intersect(&ray, 1.0, 2.0), None);
        }
    }
    // Four squares, two by two, own the middle once, as they would if they were one mesh.
    let square = |x: f32, y: f32| {
        mesh(
            vec![[x, y, 0.0], [x + 1.0, y, 0.0], [x + 1.0, y + 1.0, 0.0], [x, y + 1.0, 0.0]],
            vec![[0, 1, 2], [0, 2, 3]],
        )
    };
    let squares = [square(0.0, 0.0), square(1.0, 0.0), square(0.0, 1.0), square(1.0, 1.0)];
    for (x, y) in [(1.0, 1.0), (1.0, 0.5), (1.5, 1.0)] {
        let ray = Ray::new(Point3::new(x, y, 1.0), -Vector3::Z);
        assert_eq!(squares.iter().map(|square| crossings(square, &ray, 0.0).0).sum::<usize>(), 1);
    }
    // The same triangle twice: the lower one is the closest.
    let twice = mesh(vec![[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]], vec![[0, 1, 2]; 20]);
    let ray = Ray::new(Point3::new(0.25, 0.25, 1.0), -Vector3::Z);
    assert_eq!(twice.intersect(&ray, 0.0, 1.0).map(|hit| hit.triangle), Some(0));
    assert_eq!(crossings(&twice, &ray, 0.0), (20, 20));
    // In its plane, nothing.
    let ray = Ray::new(Point3::new(-1.0, 1.0, 0.0), Vector3::X);
    assert_eq!(fan.intersect(&ray, 0.0, f64::INFINITY), None);
    assert_eq!(crossings(&fan, &ray, f64::NEG_INFINITY), (0, 0));
}

#[test]
fn surfaces_interpolate() {
    let square = Mesh {
        positions: vec![[0.0, 0.0, 0.0], [2.0, 0.0, 0.0], [0.0, 2.0, 0.0]],
        triangles: vec![[0, 1, 2]],
        normals: vec![[0.0, 0.0, 1.0], [3.0, 0.0, 3.0], [0.0, 0.0, 1.0]],
        uvs: vec![[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]],
        colors: vec![[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]],
        triangle_materials: vec![5],
        ..Mesh::default()
    };
    let mesh = TriangleMesh::new(&square).expect("a good mesh");
    let ray = Ray::new(Point3::new(1.0, 0.5, 1.0), -Vector3::Z);
    let hit = mesh.intersect(&ray, 0.0, 10.0).expect("in the way");
    let surface = mesh.surface(&ray, &hit);
    assert_eq!(hit.barycentric, [0.25, 0.5, 0.25]);
    assert_eq!((surface.point, surface.uv), (Point3::new(1.0, 0.5, 0.0), [0.5, 0.25]));
    assert_eq!(surface.geometric_normal, Normal3::new(0.0, 0.0, 1.0));
    let expected = Vector3::new(1.5, 0.0, 2.0).normalize();
    assert!((surface.shading_normal.as_vector() - expected).length() < 1e-15);
    assert_eq!(mesh.color(&hit), Some(Rgb::new(0.25, 0.5, 0.25)));
    assert_eq!((mesh.material_index(0), mesh.triangle_count()), (5, 1));
    assert_eq!(mesh.bounds(), Bounds3::new(Point3::ORIGIN, Point3::new(2.0, 2.0, 0.0)));

    // Normals on the wrong side are turned, those that say nothing are replaced; what is not finite is left out.
    let surface_with = |normal: [f32; 3], uv: f32| {
        let bad = Mesh { normals: vec![normal; 3], uvs: vec![[uv; 2]; 3], colors: vec![[uv; 3]; 3], ..square.clone() };
        let mesh = TriangleMesh::new(&bad).expect("a good mesh");
        assert!(mesh.color(&hit).is_none() || uv.is_finite());
        mesh.surface(&ray, &hit)
    };
    assert_eq!(surface_with([0.0, 0.0, -2.0], 0.5).shading_normal, Normal3::new(0.0, 0.0, 1.0));
    for nothing in [0.0, f32::NAN, f32::INFINITY] {
        let surface = surface_with([nothing; 3], f32::NAN);
        assert_eq!((surface.shading_normal, surface.uv), (Normal3::new(0.0, 0.0, 1.0), [0.0, 0.0]));
    }
    let bare = TriangleMesh::new(&Mesh { positions: square.positions, triangles: square.triangles, ..Mesh::default() });
    let bare = bare.expect("a good mesh");
    assert_eq!((bare.surface(&ray, &hit).uv, bare.color(&hit), bare.material_index(0)), ([0.0, 0.0], None, 0));
    assert!(bare.bytes() < mesh.bytes());
}

#[test]
fn borders_are_counted() {
    let (positions, triangles) = octasphere(2);
    let positions: Vec<[f32; 3]> = positions.iter().map(|p| p.map(|x| x as f32)).collect();
    assert_eq!(mesh(positions.clone(), triangles.clone()).boundary_edges(), 0);
    // A hole, a triangle turned over, one that is there twice.
    assert_eq!(mesh(positions.clone(), triangles[1..].to_vec()).boundary_edges(), 3);
    let mut turned = triangles.clone();
    turned[5].swap(0, 1);
    assert_eq!(mesh(positions.clone(), turned).boundary_edges(), 6);
    let mut twice = triangles.clone();
    twice.push(triangles[5]);
    assert!(!mesh(positions.clone(), twice).is_closed());
    // Triangles with vertices of their own are welded, with 0 and −0 for one; collapsed triangles do no harm.
    let own: Vec<[f32; 3]> = triangles.iter().flatten().map(|&v| positions[v as usize]).collect();
    let own = own.iter().enumerate().map(|(i, p)| p.map(|x| if x == 0.0 && i % 2 == 0 { -x } else { x })).collect();
    let mut separate: Vec<[u32; 3]> = (0..triangles.len() as u32).map(|i| [3 * i, 3 * i + 1, 3 * i + 2]).collect();
    separate.push([4, 4, 9]);
    assert!(mesh(own, separate).is_closed());
    let nothing = mesh(vec![], vec![]);
    assert!(!nothing.is_closed() && nothing.boundary_edges() == 0 && nothing.bounds().is_empty());
    assert_eq!(nothing.intersect(&Ray::new(Point3::ORIGIN, Vector3::X), 0.0, 1.0), None);
}

#[test]
fn points_inside_are_told() {
    let ring = placed(torus(48, 32), &Transform::translate(Vector3::ZERO));
    let mut random = Random(4);
    for _ in 0..5000 {
        let p = Point3::ORIGIN + random.vector() * 1.5;
        let out = (p.x() * p.x() + p.y() * p.y()).sqrt() - 1.0;
        let distance = (out * out + p.z() * p.z()).sqrt();
        if !(0.38..=0.41).contains(&distance) {
            assert_eq!(ring.contains(p), distance < 0.4, "{p:?}");
        }
    }
    assert!(!ring.contains(Point3::new(f64::NAN, 0.0, 0.0)));
}

#[test]
fn broken_promises_are_reported() {
    let good =
        Mesh { positions: vec![[0.0; 3], [1.0; 3], [2.0, 0.0, 0.0]], triangles: vec![[0, 1, 2]], ..Mesh::default() };
    let error = |bad: Mesh| TriangleMesh::new(&bad).expect_err("a broken promise");
    assert_eq!(error(Mesh { triangles: vec![[0, 1, 2], [0, 1, 3]], ..good.clone() }), MeshError::NoSuchVertex(1));
    let mut positions = good.positions.clone();
    positions[2][1] = f32::NAN;
    assert_eq!(error(Mesh { positions, ..good.clone() }), MeshError::NotFinite(2));
    let uvs = error(Mesh { uvs: vec![[0.0; 2]; 4], ..good.clone() });
    assert_eq!(uvs, MeshError::WrongLength { what: "texture coordinates", found: 4, expected: 3 });
    assert_eq!(uvs.to_string(), "there are 4 texture coordinates, not 3");
    assert!(matches!(error(Mesh { triangle_materials: vec![0; 2], ..good }), MeshError::WrongLength { .. }));
}

#[test]
fn strange_rays_meet_nothing() {
    let mesh = cube(1.0);
    let strange = [0.0, -0.0, 1.0, f64::NAN, f64::INFINITY, f64::NEG_INFINITY, 5e-324, f64::MAX];
    for (i, x) in strange.iter().enumerate() {
        for (j, y) in strange.iter().enumerate() {
            let ray = Ray::new(Point3::new(*x, *y, 0.5), Vector3::new(*y, strange[(i + j) % 8], *x));
            for t_max in strange {
                let hit = mesh.intersect(&ray, 0.0, t_max);
                assert!(
                    hit.is_none_or(|hit| hit.t.is_finite() && hit.t > 0.0 && ray.origin.is_finite()),
                    "{ray:?} {hit:?}"
                );
                let _ = mesh.any(&ray, f64::NAN, t_max);
            }
        }
    }
}

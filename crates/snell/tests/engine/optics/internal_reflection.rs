//! Total internal reflection: Snell's window, a light guide, a right-angled prism.

use snell::math::{Point3, Ray, Vector3, portable};
use snell_testkit::must_fail;

use crate::stage::Stage;

/// A camera under an endless, still water surface at y = 0 over a black ground, looking straight up at a white sky.
fn under_water(ior: f64) -> Stage {
    Stage::new(&format!(
        "[camera]\neye = [0, -1, 0]\ngaze = [0, 1, 0]\nup = [0, 0, 1]\nfov = 120\n[background]\ncolor = 1\n\
         [[object]]\nplane = {{}}\nmaterial = {{ dielectric = {{ ior = {ior:?} }} }}\n[[object]]\nplane = {{ y = -9 }}\n\
         material = {{ diffuse = 0 }}\n"
    ))
    .sized(401, 3)
}

/// Asserts that, along the picture's middle row, light comes from above exactly where the angle is below the critical one.
fn window_ends_at_the_critical_angle(stage: &Stage, ior: f64) {
    let camera = stage.settings.camera(&stage.scene).expect("a camera");
    let critical = portable::asin(1.0 / ior);
    let picture = stage.picture();
    let mut inside = 0;
    for ([x, y], tree) in stage.trees() {
        if y != 1 {
            continue;
        }
        let angle = portable::acos(camera.generate_ray(f64::from(x) + 0.5, 1.5).direction.y());
        let total = tree.rays[0].total_internal_reflection;
        assert_eq!(total, angle > critical, "at pixel {x}: {angle} and {critical}");
        // What is reflected comes from the dark ground, so only the window is bright.
        let color = picture.get(x, 1).expect("a pixel").r;
        assert_eq!(color > 0.0, !total, "pixel {x} is {color}");
        inside += u32::from(!total);
    }
    assert!(inside > 100 && inside < 300, "{inside} pixels");
}

#[test]
fn snells_window_is_sharp() {
    for ior in [1.333, 1.5] {
        window_ends_at_the_critical_angle(&under_water(ior), ior);
    }
    must_fail("the border is off by a pixel", || window_ends_at_the_critical_angle(&under_water(1.333), 1.338));
}

#[test]
fn a_light_guide_loses_nothing_and_counts_every_bounce() {
    let mut stage = Stage::new(
        "[background]\ncolor = 1\n[render]\ndepth = 50\n[[object]]\nbox = { min = [-1000, 0, -1000], max = [1000, 1, 1000] }\n\
         material = { dielectric = { ior = 1.5 } }\n",
    );
    // 60 degrees to the walls' normals, above the critical angle of 41.8.
    let angle = portable::radians(60.0);
    let ray = Ray::new(Point3::new(0.0, 0.5, 0.0), Vector3::new(portable::sin(angle), portable::cos(angle), 0.0));
    let (tree, statistics) = stage.shoot(ray);
    assert_eq!((statistics.total_internal_reflections, statistics.max_depth), (50, 50));
    assert_eq!((statistics.reflected_rays, statistics.refracted_rays), (49, 0));
    assert!(tree.sum().is_black(), "it never came out");
    assert_eq!(statistics.cut_weight(), 1.0, "all that was carried is known to be lost");
    // Each bounce is where plane geometry has it.
    for (bounce, ray) in tree.rays.iter().enumerate() {
        let point = ray.hit.flatten().expect("a wall").point;
        let expected = (0.5 + bounce as f64) * portable::tan(angle);
        assert!((point.x() - expected).abs() < 1e-11 * (1.0 + expected), "bounce {bounce} at {point:?}");
    }
    stage.settings.depth = 10;
    assert_eq!(stage.shoot(ray).1.total_internal_reflections, 10);
}

#[test]
fn a_right_angled_prism_turns_light_back_by_two_total_reflections() {
    // Its long side lies in x = 0; light comes along +x and returns along −x, upside down.
    let prism = |ior: f64| {
        Stage::new(&format!(
            "[background]\ncolor = 1\n[[object]]\nmaterial = {{ dielectric = {{ ior = {ior:?} }} }}\nmesh = {{ \
             vertices = [[0, -1, 1], [1, 0, 1], [0, 1, 1], [0, -1, -1], [1, 0, -1], [0, 1, -1]], \
             faces = [[0, 1, 2], [5, 4, 3], [0, 3, 4, 1], [1, 4, 5, 2], [2, 5, 3, 0]] }}"
        ))
    };
    let returns = |ior: f64| {
        let (tree, statistics) = prism(ior).shoot(Ray::new(Point3::new(-2.0, 0.3, 0.1), Vector3::X));
        let after: Vec<_> = tree.rays.iter().filter(|ray| ray.total_internal_reflection).collect();
        assert_eq!(after.len() as u64, statistics.total_internal_reflections);
        assert!(after.len() >= 2, "{} total reflections", after.len());
        let out = tree.rays.iter().find(|ray| {
            ray.task.depth == 5 && ray.task.ray.direction.x() < -0.9 && ray.task.media == Default::default()
        });
        let out = out.expect("it comes back").task;
        assert!((out.ray.direction + Vector3::X).length() < 1e-12);
        assert!((out.ray.origin.y() + 0.3).abs() < 1e-9 && (out.ray.origin.z() - 0.1).abs() < 1e-9);
        // Twice through the long side at normal incidence, with nothing lost between.
        let reflected = ((ior - 1.0) / (ior + 1.0)) * ((ior - 1.0) / (ior + 1.0));
        let expected = (1.0 - reflected) * (1.0 - reflected);
        assert!((f64::from(out.throughput.r) - expected).abs() < 1e-6);
    };
    returns(1.5);
    must_fail("an index below the square root of two", || returns(1.4));
}

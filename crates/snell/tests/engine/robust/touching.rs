//! scratch
use crate::stage::Stage;
#[test]
#[ignore = "scratch"]
fn touching() {
    for (name, body) in [
        ("box", "box = { min = [-1, 0, -1], max = [1, 1, 1] }"),
        ("cyl", "cylinder = { base = [0, 0, 0], top = [0, 1, 0] }"),
        (
            "mesh",
            "mesh = { vertices = [[-1, 0, 1], [1, 0, 1], [1, 0, -1], [-1, 0, -1], [0, 1.3, 0]], faces = [[3, 2, 1, 0], [0, 1, 4], [1, 2, 4], [2, 3, 4], [3, 0, 4]] }",
        ),
        ("ball", "sphere = { center = [0, 1, 0] }"),
    ] {
        for floor in ["plane = {}", "box = { min = [-5, -1, -5], max = [5, 0, 5] }"] {
            for order in [true, false] {
                let f = format!("[[object]]\n{floor}\nmaterial = {{ diffuse = 1 }}\n");
                let b = format!("[[object]]\n{body}\nmaterial = {{ dielectric = {{ ior = 1.5 }} }}\n");
                let text = if order { f + &b } else { b + &f };
                let stage = Stage::new(&format!(
                    "[[light]]\npoint = {{ position = [3, 4, 1] }}\n[background]\ncolor = [0, 0, 1]\n{text}"
                ))
                .sized(20, 20);
                let mut seen = [0; 2];
                let mut lit = [0; 2];
                for [x, y] in stage.pixels() {
                    let o = [(f64::from(x) - 9.5) / 12.0, (f64::from(y) - 9.3) / 12.0];
                    let tree = stage.ray([o[0], 3.0, o[1]], [0.02, -1.0, 0.01]);
                    let path = crate::stage::refracted_path(&tree);
                    let last = path.last().unwrap();
                    let hit = last.hit.flatten();
                    let floor = hit.is_some_and(|h| stage.scene.materials[h.material as usize].body.is_none());
                    seen[usize::from(floor)] += 1;
                    if floor {
                        let t = last.shadows.first().map_or(0.0, |s| s.transmittance.r);
                        lit[usize::from(t > 0.3)] += 1;
                    }
                }
                println!("{name} on {floor}, floor first {order}: sees floor {seen:?}, lit {lit:?}");
            }
        }
    }
}

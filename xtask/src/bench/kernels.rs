//! What rays meet, without a picture: million rays per CPU second, build rate and bytes a triangle, ours against Embree, of the same
//! meshes and the same rays. Embree runs in its default mode and in the robust one, which is watertight as ours is.
//!
//! Ours is the program `crates/snell/benches/kernels.rs`, Embree's `benches/embree/kernels.cpp`, which makes the rays too: primary
//! rays of a picture in tiles, what they scatter (bounce1), what that scatters (bounce2), and shadow rays to a square light.

use std::fmt::Write;
use std::path::Path;

use super::embree::Embree;
use super::mesh_file::Mesh;
use super::report::{Bar, Section, Verdict, cell};
use super::statistics::median;
use super::vectors::Vector;
use super::{Bench, models};
use crate::process;

/// From where and how a scene is seen and lit.
pub struct View {
    pub eye: Vector,
    pub at: Vector,
    /// Of half the angle of the view, across and along.
    pub tangent: f64,
    /// The middle of a square light that lies flat, and half its edge.
    pub light: Vector,
    pub half_edge: f64,
    /// How far above a surface rays begin.
    pub lift: f64,
}

const ROOM: View = View {
    eye: [1.1, 0.55, 1.9],
    at: [0.0, -0.05, 0.0],
    tangent: 0.52,
    light: [0.6, 2.8, 0.8],
    half_edge: 0.5,
    lift: 1e-4,
};
const HALL: View = View {
    eye: [-9.3, 2.1, 4.3],
    at: [3.0, 1.6, -1.2],
    tangent: 0.62,
    light: [-1.0, 5.7, -1.0],
    half_edge: 2.0,
    lift: 3e-4,
};
const LANDSCAPE: View = View {
    eye: [9.0, 4.2, 11.0],
    at: [-0.5, 0.6, 0.0],
    tangent: 0.42,
    light: [6.0, 14.0, 4.0],
    half_edge: 3.0,
    lift: 5e-4,
};

/// What Embree is called in each of its modes.
const DEFAULT: &str = "Embree";
const ROBUST: &str = "Embree, robust";

/// Rays of a set are the square of this.
const EDGE: u32 = 512;

/// What is shown of what the programs print: the key and the column's head.
const COLUMNS: &[(&str, &str)] = &[
    ("primary_mrays_per_cpu_second", "primary"),
    ("bounce1_mrays_per_cpu_second", "bounce1"),
    ("bounce2_mrays_per_cpu_second", "bounce2"),
    ("shadow_mrays_per_cpu_second", "shadow"),
    ("primary_queue_mrays_per_cpu_second", "primary, packets"),
    ("bounce2_queue_mrays_per_cpu_second", "bounce2, in queues"),
    ("build_mtriangles_per_cpu_second", "build, per CPU second"),
    ("build_mtriangles_per_second_2_threads", "build, 2 threads, per second"),
    ("bytes_per_triangle", "bytes a triangle"),
];

/// Measures all scenes.
pub fn run(bench: &Bench) -> Result<Section, String> {
    let mut section = Section::default();
    let embree = Embree::build(&bench.scratch);
    let ours = process::root().join("crates/snell/benches/kernels.rs").is_file();
    if ours {
        process::run(process::cargo().args(["bench", "-p", "snell", "--bench", "kernels", "--no-run"]))?;
    } else {
        println!("There is no crates/snell/benches/kernels.rs, so ours is left out.");
    }
    let _ = write!(
        section.text,
        "Million rays per CPU second on one thread, {EDGE} x {EDGE} rays a set; build in million triangles; \
         medians of {} rounds.\n\n| scene | triangles | program |",
        bench.runs
    );
    for (_, head) in COLUMNS {
        let _ = write!(section.text, " {head} |");
    }
    let _ = writeln!(section.text, "\n|---|---|---|{}", "---|".repeat(COLUMNS.len()));
    let mut visited = String::new();
    for (name, view, make) in scenes() {
        if !bench.wants(name) {
            continue;
        }
        let Some(mesh) = make(&bench.scratch) else {
            println!("{name} needs npm packages that are not to be had, and is left out.");
            continue;
        };
        let file = bench.scratch.join(format!("{name}.ply"));
        mesh.write_ply(&file)?;
        let triangles = mesh.triangles.len();
        drop(mesh);
        let prefix = bench.scratch.join(name);
        if let Some(embree) = &embree {
            embree.make_rays(&file, &prefix, EDGE, view)?;
        }
        let mut measured: Vec<(&str, Vec<Figures>)> = Vec::new();
        let mut keep = |program, figures| match measured.iter_mut().find(|(name, _)| *name == program) {
            Some((_, rounds)) => rounds.push(figures),
            None => measured.push((program, vec![figures])),
        };
        // The programs take turns, so that the machine's mood is the same for all.
        for _ in 0..bench.runs {
            if ours {
                // Where ours fails, Embree's figures are worth having all the same.
                match measure_ours(&file, &prefix, embree.is_some()) {
                    Ok(figures) => keep("Snell", figures),
                    Err(reason) => println!("{name}: {reason}"),
                }
            }
            if let Some(embree) = &embree {
                for (program, mode) in [(DEFAULT, "default"), (ROBUST, "robust")] {
                    keep(program, embree.measure(&file, &prefix, mode, 1)?);
                }
            }
        }
        let measured: Vec<(&str, Figures)> =
            measured.into_iter().map(|(program, rounds)| (program, medians(&rounds))).collect();
        section.verdicts.extend(verdicts(name, &measured));
        for (program, figures) in &measured {
            let _ = write!(section.text, "| {name} | {triangles} | {program} |");
            for (key, _) in COLUMNS {
                let _ = write!(section.text, " {} |", cell(find(figures, key), 1));
            }
            section.text.push('\n');
            for (key, value) in figures.iter().filter(|(key, value)| is_worth_telling(key, *value)) {
                let _ = writeln!(visited, "- {name}, {program}: {key} {value:.2}");
            }
        }
    }
    if !visited.is_empty() {
        let _ = write!(section.text, "\n{visited}");
    }
    Ok(section)
}

/// What a program printed, each with its key.
type Figures = Vec<(String, f64)>;

fn find(figures: &[(String, f64)], key: &str) -> Option<f64> {
    figures.iter().find(|(name, _)| name == key).map(|&(_, value)| value)
}

/// The median of each figure over the rounds.
fn medians(rounds: &[Figures]) -> Figures {
    let keys = rounds.first().into_iter().flatten().map(|(key, _)| key);
    keys.filter_map(|key| {
        let mut values: Vec<f64> = rounds.iter().filter_map(|figures| find(figures, key)).collect();
        Some((key.clone(), median(&mut values)?))
    })
    .collect()
}

/// What is asked of a scene's figures, those that there are.
fn verdicts(scene: &str, measured: &[(&str, Figures)]) -> Vec<Verdict> {
    let of = |program: &str| measured.iter().find(|(name, _)| *name == program).map(|(_, figures)| figures);
    let (Some(ours), Some(default), Some(robust)) = (of("Snell"), of(DEFAULT), of(ROBUST)) else { return Vec::new() };
    let ratio = |theirs: &Figures, key: &str| Some(find(ours, key)? / find(theirs, key)?);
    let mut verdicts = Vec::new();
    let mut ask = |what: &str, measured: Option<f64>, bar| {
        let what = format!("{scene}: {what}");
        verdicts.extend(measured.map(|measured| Verdict { what, measured, bar, unit: "" }));
    };
    if ["bunny-room", "dragon-room", "hall"].contains(&scene) {
        for (theirs, program, bar) in [(robust, "Embree's robust mode", 1.5), (default, "Embree's default mode", 1.1)] {
            for set in ["primary", "bounce1", "bounce2", "shadow"] {
                let key = format!("{set}_mrays_per_cpu_second");
                ask(&format!("{set} rays a second over {program}"), ratio(theirs, &key), Bar::AtLeast(bar));
            }
        }
        let packets = ratio(default, "primary_queue_mrays_per_cpu_second");
        ask("primary rays in packets a second over Embree", packets, Bar::AtLeast(1.0));
    }
    if scene == "landscape" {
        let queue = find(ours, "bounce2_queue_mrays_per_cpu_second");
        let single = find(default, "bounce2_mrays_per_cpu_second");
        let incoherent = queue.zip(single).map(|(queue, single)| queue / single);
        ask("incoherent rays a second over Embree", incoherent, Bar::AtLeast(2.5));
    }
    let build = ratio(default, "build_mtriangles_per_second_2_threads");
    ask("triangles built a second over Embree, two threads", build, Bar::AtLeast(0.9));
    ask("bytes a triangle over Embree", ratio(default, "bytes_per_triangle"), Bar::AtMost(1.0));
    verdicts
}

/// What a ray visits, and answers that are not those expected, where there are any.
fn is_worth_telling(key: &str, value: f64) -> bool {
    key.ends_with("_per_ray") || (key.ends_with("_different") && value > 0.0)
}

/// Runs our program: on the ray sets in files where there are such, else on its own.
fn measure_ours(mesh: &Path, prefix: &Path, from_files: bool) -> Result<Figures, String> {
    let mut command = process::cargo();
    command.args(["bench", "--quiet", "-p", "snell", "--bench", "kernels", "--", "--mesh"]).arg(mesh);
    command.args(["--rounds", "1", "--rays", &(EDGE * EDGE).to_string()]);
    if from_files {
        command.arg("--ray-files").arg(prefix);
    }
    Ok(figures(&process::output(&mut command)?))
}

/// The lines `key value` that a program printed, others left out.
pub fn figures(printed: &str) -> Figures {
    let lines = printed.lines().filter_map(|line| line.trim().split_once(' '));
    lines.filter_map(|(key, value)| Some((key.to_owned(), value.trim().parse().ok()?))).collect()
}

/// A mesh, or none where what it is made of cannot be had; the argument is where files may be kept.
type Make = fn(&Path) -> Option<Mesh>;

/// All scenes; those of scans have a generated one beside them.
fn scenes() -> [(&'static str, &'static View, Make); 6] {
    [
        ("bunny-room", &ROOM, |scratch| models::bunny(scratch).map(|mesh| models::in_a_room(&mesh))),
        ("dragon-room", &ROOM, |scratch| models::dragon(scratch).map(|mesh| models::in_a_room(&mesh))),
        ("blob-room", &ROOM, |_| Some(models::in_a_room(&small()))),
        ("large-blob-room", &ROOM, |_| Some(models::in_a_room(&large()))),
        ("hall", &HALL, |scratch| Some(models::hall(&models::bunny(scratch).unwrap_or_else(small)))),
        ("landscape", &LANDSCAPE, |scratch| {
            let (large, small) =
                (models::dragon(scratch).unwrap_or_else(large), models::bunny(scratch).unwrap_or_else(small));
            Some(models::landscape(1025, &large, &small))
        }),
    ]
}

fn small() -> Mesh {
    models::blob(models::rings_for(70_000))
}

fn large() -> Mesh {
    models::blob(models::rings_for(870_000))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bars_are_asked_of_the_median_of_the_rounds() {
        let rounds = [3.0, 9.0, 4.0].map(|value| vec![("bytes_per_triangle".to_owned(), value)]);
        let ours = medians(&rounds);
        assert_eq!(ours, [("bytes_per_triangle".to_owned(), 4.0)]);
        let measured = [("Snell", ours), (DEFAULT, rounds[1].clone()), (ROBUST, rounds[1].clone())];
        let [verdict] = &verdicts("hall", &measured)[..] else { panic!("one figure that both have") };
        assert!(verdict.is_met() && verdict.measured == 4.0 / 9.0, "{verdict:?}");
        // Without a peer nothing is asked.
        assert_eq!(verdicts("hall", &measured[..1]), []);
    }

    #[test]
    fn figures_are_the_lines_of_a_key_and_a_number() {
        let found = figures("warming up\nprimary_mrays_per_cpu_second 7.5\nnodes_per_ray  12\nscene bunny\n");
        assert_eq!(found, [("primary_mrays_per_cpu_second".to_owned(), 7.5), ("nodes_per_ray".to_owned(), 12.0)]);
        assert!(is_worth_telling("nodes_per_ray", 0.0) && is_worth_telling("shadow_different", 1.0));
        assert!(!is_worth_telling("shadow_different", 0.0));
    }
}

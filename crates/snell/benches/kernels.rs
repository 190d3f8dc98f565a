//! How fast rays find triangles, without a picture: million rays per CPU second on one thread, build rate, bytes a triangle.
//!
//!     cargo bench -p snell --bench kernels -- [--mesh FILE.ply | --triangles N] [--rays N] [--rounds N] [--ray-files PREFIX]
//!         [--quality medium|high]
//!
//! Without a file the mesh is a bumpy sphere of N triangles; without ray files the mesh is put into a room, so that rays that
//! bounce go on, and the rays are made by ourselves (see kernels/rays.rs): primary ones of a picture, in tiles; what they scatter
//! (bounce1), what that scatters (bounce2), and shadow rays to a square light. The ways of asking take turns, and the medians of
//! all rounds are printed as lines `key value`; `..._different` counts answers that are not those of the file, or of single rays.

#[path = "kernels/clock.rs"]
mod clock;
#[path = "kernels/meshes.rs"]
mod meshes;
#[path = "kernels/rays.rs"]
mod rays;

use std::path::PathBuf;
use std::process::ExitCode;
use std::time::Instant;

use clock::thread_seconds;
use rays::{Question, RaySet};
use snell::accel::BuildQuality;
use snell::math::Ray;
use snell::shape::triangle_mesh::{MeshHit, TriangleMesh};
use snell_scene::scene::Mesh;

/// What is asked for on the command line.
struct Options {
    mesh: Option<PathBuf>,
    triangles: usize,
    rays: usize,
    rounds: usize,
    ray_files: Option<PathBuf>,
    quality: BuildQuality,
}

impl Options {
    fn parse(mut words: impl Iterator<Item = String>) -> Result<Self, String> {
        let mut options = Self {
            mesh: None,
            triangles: 1_000_000,
            rays: 1 << 20,
            rounds: 5,
            ray_files: None,
            quality: BuildQuality::Medium,
        };
        while let Some(word) = words.next() {
            // What `cargo bench` says to every benchmark.
            if word == "--bench" {
                continue;
            }
            let value = words.next().ok_or_else(|| format!("{word} needs a value"))?;
            let number = || value.parse().map_err(|_| format!("{word} needs a number, not {value}"));
            match word.as_str() {
                "--mesh" => options.mesh = Some(value.into()),
                "--triangles" => options.triangles = number()?,
                "--rays" => options.rays = number()?,
                "--rounds" => options.rounds = number()?,
                "--ray-files" => options.ray_files = Some(value.into()),
                "--quality" => {
                    options.quality = match value.as_str() {
                        "medium" => BuildQuality::Medium,
                        "high" => BuildQuality::High,
                        _ => return Err(format!("{word} is medium or high, not {value}")),
                    }
                }
                _ => return Err(format!("there is no option {word}")),
            }
        }
        if options.rounds == 0 || options.rays == 0 {
            return Err("there must be a ray and a round at least".to_owned());
        }
        Ok(options)
    }
}

fn main() -> ExitCode {
    match Options::parse(std::env::args().skip(1)).and_then(|options| run(&options)) {
        Ok(()) => ExitCode::SUCCESS,
        Err(reason) => {
            eprintln!("error: {reason}");
            ExitCode::FAILURE
        }
    }
}

fn run(options: &Options) -> Result<(), String> {
    let mut mesh = match &options.mesh {
        Some(file) => meshes::read(file)?,
        None => meshes::bumpy_sphere(options.triangles),
    };
    if options.ray_files.is_none() {
        meshes::put_into_a_room(&mut mesh);
    }
    let count = mesh.triangles.len() as f64;
    println!("triangles {count}");
    for (threads, key) in [(1, "build_mtriangles_per_cpu_second"), (2, "build_mtriangles_per_second_2_threads")] {
        println!("{key} {:.3}", build_rate(&mesh, threads, options.quality)?);
    }
    let built = TriangleMesh::with_quality(&mesh, options.quality).map_err(|error| error.to_string())?;
    drop(mesh);
    println!("bytes_per_triangle {:.1}", built.bytes() as f64 / count);
    let sets = match &options.ray_files {
        Some(prefix) => rays::read_all(prefix, options.rays)?,
        None => rays::make_all(&built, options.rays),
    };
    measure(&built, &sets, options.rounds);
    Ok(())
}

/// How often a hierarchy is built by one and by two threads, at least and at most; in between until this many seconds are spent,
/// since a build of a small mesh takes a few milliseconds, of which single ones say little.
const BUILDS: [usize; 2] = [3, 25];
const BUILDING: f64 = 0.5;

/// Million triangles a second, the median of a few builds: of one thread's processor time, or of the clock's with several threads.
fn build_rate(mesh: &Mesh, threads: usize, quality: BuildQuality) -> Result<f64, String> {
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().map_err(|error| error.to_string())?;
    let (mut rates, mut sum) = (Vec::new(), 0.0);
    while rates.len() < BUILDS[0] || rates.len() < BUILDS[1] && sum < BUILDING {
        let start = Instant::now();
        let (built, seconds) = pool.install(|| {
            let start = thread_seconds();
            (TriangleMesh::with_quality(mesh, quality), thread_seconds() - start)
        });
        let seconds = if threads == 1 { seconds } else { start.elapsed().as_secs_f64() };
        sum += seconds;
        rates.push(built.map_err(|error| error.to_string())?.triangle_count() as f64 / seconds * 1e-6);
    }
    Ok(median(&mut rates))
}

/// One way to ask one set of rays.
struct Series<'a> {
    key: String,
    set: &'a RaySet,
    ask: fn(&TriangleMesh, &RaySet, &mut [f32]),
    rates: Vec<f64>,
}

fn measure(mesh: &TriangleMesh, sets: &[RaySet], rounds: usize) {
    let mut series = Vec::new();
    for set in sets {
        let mut add = |suffix: &str, ask| {
            series.push(Series { key: format!("{}{suffix}", set.name), set, ask, rates: Vec::new() });
        };
        match set.question {
            Question::Closest => {
                add("", closest);
                add("_queue", closest_many);
            }
            Question::Any => add("", any),
        }
    }
    for round in 0..=rounds {
        for Series { set, ask, rates, key } in &mut series {
            let mut answers = vec![0.0; set.rays.len()];
            let start = thread_seconds();
            ask(mesh, set, &mut answers);
            let rate = set.rays.len() as f64 / (thread_seconds() - start) * 1e-6;
            // The first round warms up, and is the one that is checked.
            if round > 0 {
                rates.push(rate);
            } else {
                println!("{key}_different {}", set.count_different(&answers));
            }
        }
    }
    for Series { key, rates, .. } in &mut series {
        println!("{key}_mrays_per_cpu_second {:.3}", median(rates));
    }
}

/// The distance of a hit, as it is compared: infinite where there is none.
fn distance(hit: Option<MeshHit>) -> f32 {
    hit.map_or(f32::INFINITY, |hit| hit.t as f32)
}

fn closest(mesh: &TriangleMesh, set: &RaySet, answers: &mut [f32]) {
    for ((ray, t_max), answer) in set.rays.iter().zip(&set.t_max).zip(answers) {
        *answer = distance(mesh.intersect(ray, 0.0, *t_max));
    }
}

fn closest_many(mesh: &TriangleMesh, set: &RaySet, answers: &mut [f32]) {
    /// As many as a queue of rays has.
    const QUEUE: usize = 1024;
    let mut hits = vec![None; QUEUE];
    let queues = set.rays.chunks(QUEUE).zip(set.t_max.chunks(QUEUE)).zip(answers.chunks_mut(QUEUE));
    for ((rays, t_max), answers) in queues {
        let hits = &mut hits[..rays.len()];
        mesh.intersect_many(rays, 0.0, t_max, hits);
        answers.iter_mut().zip(hits).for_each(|(answer, hit)| *answer = distance(*hit));
    }
}

fn any(mesh: &TriangleMesh, set: &RaySet, answers: &mut [f32]) {
    let is_blocked = |ray: &Ray, t_max: f64| mesh.any(ray, 0.0, t_max);
    for ((ray, t_max), answer) in set.rays.iter().zip(&set.t_max).zip(answers) {
        *answer = if is_blocked(ray, *t_max) { 0.0 } else { f32::INFINITY };
    }
}

fn median(numbers: &mut [f64]) -> f64 {
    numbers.sort_by(f64::total_cmp);
    numbers[numbers.len() / 2]
}

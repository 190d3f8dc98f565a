//! What one rendering took: the JSON object of `--json`, and advice where the counts are a reason to worry.

use std::time::{Duration, Instant};

use serde_json::{Value, json};
use snell::compile::SceneSize;
use snell::render::{PathSettings, RenderSettings};
use snell::scene::Diagnostic;
use snell::statistics::Statistics;

/// The share of the picture's light that may be cut off without a word.
const TOLERATED_CUT: f64 = 0.01;

/// Measures the parts of the work, one after the other.
#[derive(Debug)]
pub struct Stopwatch {
    begin: Instant,
    last: Instant,
}

impl Stopwatch {
    /// Begins now.
    pub fn start() -> Self {
        let begin = Instant::now();
        Self { begin, last: begin }
    }

    /// The time since the last lap, or the start.
    pub fn lap(&mut self) -> Duration {
        let now = Instant::now();
        now - std::mem::replace(&mut self.last, now)
    }

    /// The time since the start.
    pub fn total(&self) -> Duration {
        self.begin.elapsed()
    }
}

/// How long the parts of the work took.
#[derive(Clone, Copy, Debug, Default)]
pub struct Times {
    /// Reading the scene and its files.
    pub load: Duration,
    /// Compiling it.
    pub build: Duration,
    /// Tracing rays.
    pub render: Duration,
    /// Encoding and writing.
    pub write: Duration,
    /// All, from the start of the process.
    pub total: Duration,
}

/// All that is known after a rendering.
#[derive(Debug)]
pub struct Report<'a> {
    /// The scene's path or name.
    pub scene: &'a str,
    /// The picture's path, where one was written.
    pub output: Option<String>,
    /// How it was rendered.
    pub settings: &'a RenderSettings,
    /// How long it took.
    pub times: Times,
    /// What was counted.
    pub statistics: &'a Statistics,
    /// How much there is of the scene.
    pub size: SceneSize,
    /// Threads that rendered.
    pub threads: usize,
    /// Not interrupted.
    pub complete: bool,
    /// Warnings, each in one line.
    pub warnings: Vec<String>,
}

impl Report<'_> {
    /// The object of `--json`.
    pub fn json(&self) -> Value {
        let Self { settings, times, statistics, size, .. } = self;
        json!({
            "scene": self.scene,
            "output": self.output,
            "width": settings.width,
            "height": settings.height,
            "seconds": {
                "load": seconds(times.load),
                "build": seconds(times.build),
                "render": seconds(times.render),
                "write": seconds(times.write),
                "total": seconds(times.total),
            },
            "rays": {
                "camera": statistics.camera_rays,
                "reflected": statistics.reflected_rays,
                "refracted": statistics.refracted_rays,
                "shadow": statistics.shadow_rays,
            },
            "max_depth": statistics.max_depth,
            "total_internal_reflections": statistics.total_internal_reflections,
            "cut_weight": statistics.cut_weight(),
            "nonfinite_samples": statistics.nonfinite_samples,
            "triangles": size.triangles,
            "primitives": size.primitives,
            "peak_bytes": peak_bytes(),
            "threads": self.threads,
            "complete": self.complete,
            "warnings": self.warnings,
        })
    }
}

/// Seconds, in whole microseconds: no clock here is better.
fn seconds(duration: Duration) -> f64 {
    duration.as_micros() as f64 / 1e6
}

/// What a user should know about the counts, and what to do; `replay` is the command that explains the first sample that is no number.
pub fn advice(
    statistics: &Statistics,
    settings: &RenderSettings,
    paths: Option<&PathSettings>,
    replay: &str,
) -> Vec<Diagnostic> {
    let mut list = Vec::new();
    let cut = statistics.cut_weight();
    if cut > TOLERATED_CUT {
        let message = format!(
            "up to {:.1} % of the picture's light is missing: rays were not followed to their end",
            cut * 100.0
        );
        // Rays that could have been deeper were cut for their weight, which paths are not.
        let depth = u32::from(paths.map_or(settings.depth, |paths| paths.depth));
        let help = if paths.is_some() || statistics.max_depth >= depth {
            format!("use --depth {} or more, at the price of time", depth * 2)
        } else {
            format!("use a --min-weight below {}, at the price of time", settings.min_weight)
        };
        list.push(Diagnostic::warning(message).help(help));
    }
    if statistics.nonfinite_samples > 0 {
        let message = format!(
            "{} of the picture's samples are infinite or not a number, and count as black",
            statistics.nonfinite_samples
        );
        let help = format!(
            "look for extreme values in the scene, such as an intensity of 1e38; a smaller --depth tells whether many \
             reflections multiply them. If there are none, this is a bug worth a report. `{replay}` shows how the first of \
             them came about"
        );
        list.push(Diagnostic::warning(message).help(help));
    }
    list
}

/// The most memory that the process ever had, in bytes.
#[cfg(target_os = "linux")]
fn peak_bytes() -> Option<u64> {
    let status = std::fs::read_to_string("/proc/self/status").ok()?;
    let line = status.lines().find_map(|line| line.strip_prefix("VmHWM:"))?;
    let kibibytes: u64 = line.trim().strip_suffix("kB")?.trim().parse().ok()?;
    Some(kibibytes * 1024)
}

/// The most memory that the process ever had, in bytes.
#[cfg(all(unix, not(target_os = "linux")))]
fn peak_bytes() -> Option<u64> {
    let mut usage = std::mem::MaybeUninit::<libc::rusage>::zeroed();
    // SAFETY: the pointer leads to a whole `rusage`, all of whose bytes may be zero.
    let usage = unsafe { (libc::getrusage(libc::RUSAGE_SELF, usage.as_mut_ptr()) == 0).then(|| usage.assume_init()) }?;
    // Apple counts bytes, all others kibibytes.
    let unit = if cfg!(target_vendor = "apple") { 1 } else { 1024 };
    u64::try_from(usage.ru_maxrss).ok().map(|peak| peak * unit)
}

/// Not known here.
#[cfg(not(unix))]
fn peak_bytes() -> Option<u64> {
    None
}

/// Seconds in about three digits.
pub fn seconds_text(duration: Duration) -> String {
    match duration.as_secs_f64() {
        seconds if seconds < 9.995 => format!("{seconds:.2} s"),
        seconds if seconds < 99.95 => format!("{seconds:.1} s"),
        seconds => format!("{seconds:.0} s"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn seconds_are_short() {
        for (seconds, text) in [(0.2149, "0.21 s"), (9.999, "10.0 s"), (12.34, "12.3 s"), (1234.5, "1234 s")] {
            assert_eq!(seconds_text(Duration::from_secs_f64(seconds)), text);
        }
    }
    use snell::math::Rgb;
    use snell::scene::scene::Settings;

    #[test]
    fn cut_light_is_worth_a_warning_above_one_percent() {
        let settings = RenderSettings { depth: 5, ..RenderSettings::from(&Settings::default()) };
        let mut statistics = Statistics::default();
        (statistics.camera_rays, statistics.max_depth) = (100, 5);
        statistics.add_cut_weight(Rgb::WHITE);
        assert!(advice(&statistics, &settings, None, "snell explain a").is_empty());
        statistics.add_cut_weight(Rgb::WHITE);
        let list = advice(&statistics, &settings, None, "snell explain a");
        assert!(list[0].message.starts_with("up to 2.0 %"), "{list:?}");
        assert!(list[0].help.as_ref().is_some_and(|help| help.contains("--depth 10")), "{list:?}");
        statistics.max_depth = 4;
        let list = advice(&statistics, &settings, None, "snell explain a");
        assert!(list[0].help.as_ref().is_some_and(|help| help.contains("--min-weight")), "{list:?}");
    }

    #[test]
    fn samples_that_are_no_numbers_are_worth_a_warning() {
        let settings = RenderSettings::from(&Settings::default());
        let mut statistics = Statistics::default();
        (statistics.camera_rays, statistics.nonfinite_samples) = (1, 1);
        let list = advice(&statistics, &settings, None, "snell explain a");
        assert!(list[0].help.as_ref().is_some_and(|help| help.contains("`snell explain a`")), "{list:?}");
    }

    #[cfg(unix)]
    #[test]
    fn peak_memory_is_plausible() {
        assert!(peak_bytes().is_some_and(|bytes| (100_000..1 << 40).contains(&bytes)));
    }
}

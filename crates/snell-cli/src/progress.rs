//! How far rendering is: counted by the rendering threads, shown by a thread of its own where somebody watches.

use std::io::IsTerminal;
use std::sync::Arc;
use std::sync::atomic::{AtomicU32, AtomicU64, Ordering};
use std::sync::mpsc::{self, Receiver, RecvTimeoutError, Sender};
use std::thread::{self, JoinHandle};
use std::time::{Duration, Instant};

use indicatif::{ProgressBar, ProgressStyle};
use snell::render::Progress;

use crate::interrupt::Interrupt;

/// Pictures that are there sooner need no bar.
const PATIENCE: Duration = Duration::from_millis(300);
/// Between two states of the bar.
const INTERVAL: Duration = Duration::from_millis(100);

/// Counts, and shows them in the terminal until it is dropped.
#[derive(Debug)]
pub struct RenderProgress {
    counts: Arc<Counts>,
    interrupt: Interrupt,
    end: Option<Instant>,
    painter: Option<(Sender<()>, JoinHandle<()>)>,
}

#[derive(Debug, Default)]
struct Counts {
    pass: AtomicU32,
    pixels: AtomicU64,
    pixels_done: AtomicU64,
    rays: AtomicU64,
}

impl RenderProgress {
    /// Begins; shown on standard error where that is a terminal and `visible`.
    /// No further pass is wanted once `time` is over.
    pub fn start(interrupt: Interrupt, visible: bool, time: Option<Duration>) -> Self {
        let end = time.and_then(|time| Instant::now().checked_add(time));
        let counts = Arc::new(Counts::default());
        let painter = (visible && std::io::stderr().is_terminal()).then(|| {
            let (sender, receiver) = mpsc::channel();
            let (counts, interrupt) = (counts.clone(), interrupt.clone());
            (sender, thread::spawn(move || paint(&counts, &interrupt, &receiver)))
        });
        Self { counts, interrupt, end, painter }
    }

    /// The share of the picture's pixels that have a sample, in percent.
    pub fn percent_covered(&self) -> u64 {
        match self.counts.pass.load(Ordering::Relaxed) {
            0 => {
                self.counts.pixels_done.load(Ordering::Relaxed) * 100
                    / self.counts.pixels.load(Ordering::Relaxed).max(1)
            }
            _ => 100,
        }
    }
}

impl Progress for RenderProgress {
    fn pass(&self, number: u32, pixels: u64) {
        self.counts.pixels_done.store(0, Ordering::Relaxed);
        self.counts.pixels.store(pixels, Ordering::Relaxed);
        self.counts.pass.store(number, Ordering::Relaxed);
    }

    fn advance(&self, pixels: u64, rays: u64) {
        self.counts.pixels_done.fetch_add(pixels, Ordering::Relaxed);
        self.counts.rays.fetch_add(rays, Ordering::Relaxed);
    }

    fn wants_more(&self) -> bool {
        self.end.is_none_or(|end| Instant::now() < end)
    }

    fn is_cancelled(&self) -> bool {
        self.interrupt.is_wanted()
    }
}

impl Drop for RenderProgress {
    fn drop(&mut self) {
        if let Some((sender, painter)) = self.painter.take() {
            drop(sender);
            // A bar that failed to be drawn is no reason to fail.
            let _ = painter.join();
        }
    }
}

/// Draws the bar again and again, until the other end of the channel is dropped, and takes it away.
fn paint(counts: &Counts, interrupt: &Interrupt, stop: &Receiver<()>) {
    let begin = Instant::now();
    if stop.recv_timeout(PATIENCE) != Err(RecvTimeoutError::Timeout) {
        return;
    }
    let bar = ProgressBar::new(0);
    if let Ok(style) = ProgressStyle::with_template("{prefix} {bar:32} {percent:>3} %  {msg}") {
        bar.set_style(style.progress_chars("━╸─"));
    }
    let mut pass = 0;
    let mut pass_begin = begin;
    loop {
        let current = counts.pass.load(Ordering::Relaxed);
        if current != pass {
            (pass, pass_begin) = (current, Instant::now());
        }
        let done = counts.pixels_done.load(Ordering::Relaxed);
        let pixels = counts.pixels.load(Ordering::Relaxed);
        bar.set_length(pixels);
        bar.set_position(done.min(pixels));
        bar.set_prefix(if pass == 0 { "rendering" } else { "antialiasing" });
        let rate = counts.rays.load(Ordering::Relaxed) as f64 / begin.elapsed().as_secs_f64();
        bar.set_message(if interrupt.is_wanted() {
            "stopping; Ctrl-C once more ends at once".to_owned()
        } else {
            format!("{}{}", rate_text(rate), left_text(pass_begin.elapsed(), done, pixels))
        });
        bar.tick();
        if stop.recv_timeout(INTERVAL) != Err(RecvTimeoutError::Timeout) {
            break;
        }
    }
    bar.finish_and_clear();
}

/// Rays per second in three digits.
fn rate_text(rate: f64) -> String {
    match rate {
        r if r >= 1e9 => format!("{:.2} G rays/s", r / 1e9),
        r if r >= 1e8 => format!("{:.0} M rays/s", r / 1e6),
        r if r >= 1e7 => format!("{:.1} M rays/s", r / 1e6),
        r if r >= 1e6 => format!("{:.2} M rays/s", r / 1e6),
        r => format!("{:.0} k rays/s", r / 1e3),
    }
}

/// The time that the rest takes, if it goes on as it went so far.
fn left_text(elapsed: Duration, done: u64, pixels: u64) -> String {
    if done == 0 || done > pixels {
        return String::new();
    }
    let left = elapsed.as_secs_f64() * (pixels - done) as f64 / done as f64;
    format!(", {} left", duration_text(Duration::try_from_secs_f64(left).unwrap_or(Duration::MAX)))
}

/// Whole seconds, minutes or hours: `12 s`, `3:07 min`, `5:12 h`.
fn duration_text(duration: Duration) -> String {
    match duration.as_secs() {
        seconds @ 0..=99 => format!("{seconds} s"),
        seconds @ 100..=5999 => format!("{}:{:02} min", seconds / 60, seconds % 60),
        seconds => format!("{}:{:02} h", seconds / 3600, seconds % 3600 / 60),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn pixels_and_rays_add_up() {
        let progress = RenderProgress::start(Interrupt::default(), false, None);
        assert_eq!(progress.percent_covered(), 0);
        progress.pass(0, 200);
        progress.advance(30, 90);
        progress.advance(20, 10);
        assert_eq!(progress.percent_covered(), 25);
        assert_eq!(progress.counts.rays.load(Ordering::Relaxed), 100);
        progress.pass(1, 7);
        assert_eq!(progress.percent_covered(), 100);
        assert!(!progress.is_cancelled());
    }

    #[test]
    fn numbers_are_short() {
        assert_eq!(rate_text(345_678.0), "346 k rays/s");
        assert_eq!(rate_text(3_456_789.0), "3.46 M rays/s");
        assert_eq!(rate_text(34_567_890.0), "34.6 M rays/s");
        assert_eq!(left_text(Duration::from_secs(10), 25, 100), ", 30 s left");
        assert_eq!(left_text(Duration::from_secs(10), 0, 100), "");
        assert_eq!(duration_text(Duration::from_secs(187)), "3:07 min");
        assert_eq!(duration_text(Duration::from_secs(18_720)), "5:12 h");
        assert!(left_text(Duration::MAX, 1, u64::MAX).ends_with(" h left"));
    }
}

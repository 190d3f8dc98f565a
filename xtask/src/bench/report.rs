//! What a benchmark says: a table in Markdown, and for each bar whether it is met; with the machine it was measured on.

use std::fmt::Write;
use std::process::Command;

use super::measure::Cost;
use super::statistics::Series;
use crate::process;

/// One benchmark's results.
#[derive(Clone, Debug, Default)]
pub struct Section {
    /// Markdown: how it was measured, and the table.
    pub text: String,
    pub verdicts: Vec<Verdict>,
}

/// What is asked of a figure, and what it was.
#[derive(Clone, Debug, PartialEq)]
pub struct Verdict {
    /// The figure in words.
    pub what: String,
    pub measured: f64,
    pub bar: Bar,
    pub unit: &'static str,
}

/// The side on which a figure has to be.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Bar {
    AtLeast(f64),
    AtMost(f64),
}

impl Verdict {
    /// Whether the figure is where it has to be; what is no number is not.
    pub fn is_met(&self) -> bool {
        match self.bar {
            Bar::AtLeast(bar) => self.measured >= bar,
            Bar::AtMost(bar) => self.measured <= bar,
        }
    }
}

/// The head of the table that [`bars`] fills.
pub const BARS_HEAD: &str = "| benchmark | figure | bar | measured | met |\n|---|---|---|---|---|\n";

/// A row for each bar of a benchmark.
pub fn bars(group: &str, verdicts: &[Verdict]) -> String {
    let mut text = String::new();
    for verdict in verdicts {
        let Verdict { what, measured, unit, .. } = verdict;
        let bar = match verdict.bar {
            Bar::AtLeast(bar) => format!("at least {}{unit}", significant(bar)),
            Bar::AtMost(bar) => format!("at most {}{unit}", significant(bar)),
        };
        let met = if verdict.is_met() { "yes" } else { "no" };
        // Writing into a String cannot fail.
        let _ = writeln!(text, "| {group} | {what} | {bar} | {}{unit} | {met} |", significant(*measured));
    }
    text
}

/// Three digits or so.
fn significant(value: f64) -> String {
    let decimals = match value.abs() {
        size if size >= 100.0 => 0,
        size if size >= 10.0 => 1,
        size if size >= 0.1 || size == 0.0 => 2,
        _ => 4,
    };
    format!("{value:.decimals$}")
}

/// The head of the table that [`rows`] fills.
pub const COSTS: &str = "| picture | renderer | CPU s (smallest to largest) | wall s | MiB | times Snell's CPU |\n|---|---|---|---|---|---|\n";

/// A row for each renderer of one picture, ours first.
pub fn rows(picture: &str, series: &[Series]) -> String {
    let ours = series.first().and_then(|series| series.median(|cost| cost.cpu));
    let mut text = String::new();
    for one in series {
        let ratio = one.median(|cost| cost.cpu).zip(ours).map(|(cpu, ours)| cpu / ours);
        let cells = [
            one.spread(|cost| cost.cpu),
            cell(one.median(|cost| cost.wall), 3),
            cell(one.median(|cost| cost.memory), 0),
            cell(ratio, 2),
        ];
        let _ = writeln!(text, "| {picture} | {} | {} |", one.name, cells.join(" | "));
    }
    text
}

/// How many times as much as ours another renderer took; `None` where it was not measured.
pub fn ratio(series: &[Series], other: &str, of: fn(&Cost) -> f64) -> Option<f64> {
    let ours = series.first()?.median(of)?;
    let theirs = series.iter().skip(1).find(|series| series.name == other)?.median(of)?;
    Some(theirs / ours)
}

/// A number with so many decimals, or a dash.
pub fn cell(value: Option<f64>, decimals: usize) -> String {
    value.map_or("-".to_owned(), |value| format!("{value:.decimals$}"))
}

/// The date as the operating system knows it, in words of ISO 8601: `2026-11-26`.
pub fn today() -> String {
    let now = std::time::SystemTime::now().duration_since(std::time::UNIX_EPOCH);
    date(now.map_or(0, |since| since.as_secs()) / 86_400)
}

/// The date so many days after 1 January 1970, in the Gregorian calendar.
fn date(mut days: u64) -> String {
    let mut year = 1970;
    let leap = |year: u64| year.is_multiple_of(4) && (!year.is_multiple_of(100) || year.is_multiple_of(400));
    while days >= 365 + u64::from(leap(year)) {
        days -= 365 + u64::from(leap(year));
        year += 1;
    }
    let mut month = 1;
    for length in [31, 28 + u64::from(leap(year)), 31, 30, 31, 30, 31, 31, 30, 31, 30, 31] {
        if days < length {
            break;
        }
        days -= length;
        month += 1;
    }
    format!("{year}-{month:02}-{:02}", days + 1)
}

/// Processor, cores, system and present load, as far as this system tells.
pub fn describe_machine() -> String {
    let mut parts = vec![processor().unwrap_or_else(|| "unknown processor".to_owned())];
    let cores = std::thread::available_parallelism().map_or(1, usize::from);
    parts.push(format!("{cores} logical processors"));
    parts.push(format!("{} {}", std::env::consts::OS, std::env::consts::ARCH));
    if let Some(load) = std::fs::read_to_string("/proc/loadavg").ok().as_deref().and_then(|text| text.split(' ').next())
    {
        parts.push(format!("load {load} at the end of the run"));
    }
    parts.join(", ")
}

fn processor() -> Option<String> {
    let named = std::fs::read_to_string("/proc/cpuinfo")
        .ok()
        .or_else(|| process::output(Command::new("sysctl").arg("machdep.cpu.brand_string")).ok())?;
    let line = named.lines().find(|line| line.starts_with("model name") || line.starts_with("machdep"))?;
    line.split_once(':').map(|(_, name)| name.trim().to_owned())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn series(name: &'static str, cpu: &[f64]) -> Series {
        Series { name, costs: cpu.iter().map(|&cpu| Cost { cpu, wall: cpu, memory: 10.0 }).collect() }
    }

    #[test]
    fn ratios_are_the_peer_over_ours_and_missing_runs_are_dashes() {
        let both = [series("Snell", &[0.5, 0.4, 0.6]), series("POV-Ray", &[2.0])];
        assert_eq!(ratio(&both, "POV-Ray", |cost| cost.cpu), Some(4.0));
        assert_eq!(ratio(&both, "Tachyon", |cost| cost.cpu), None);
        let text = rows("balls", &both);
        assert!(text.contains("| balls | POV-Ray | 2.000 (2.000 to 2.000) | 2.000 | 10 | 4.00 |"), "{text}");
        let text = rows("balls", &[series("Snell", &[])]);
        assert!(text.contains("| balls | Snell | - | - | - | - |"), "{text}");
    }

    #[test]
    fn dates_of_the_calendar() {
        assert_eq!(date(0), "1970-01-01");
        assert_eq!(date(19_782), "2024-02-29");
        assert_eq!(date(20_818), "2026-12-31");
        assert_eq!(date(20_819), "2027-01-01");
    }

    #[test]
    fn bars_are_met_on_their_side_only() {
        let verdict = |measured, bar| Verdict { what: "speed".to_owned(), measured, bar, unit: "x" };
        assert!(verdict(12.0, Bar::AtLeast(12.0)).is_met() && !verdict(11.9, Bar::AtLeast(12.0)).is_met());
        assert!(verdict(0.5, Bar::AtMost(0.5)).is_met() && !verdict(0.6, Bar::AtMost(0.5)).is_met());
        assert!(!verdict(f64::NAN, Bar::AtLeast(0.0)).is_met() && !verdict(f64::NAN, Bar::AtMost(0.0)).is_met());
        let text = bars("pictures", &[verdict(2.94, Bar::AtLeast(12.0))]);
        assert!(text.contains("| speed | at least 12.0x | 2.94x | no |"), "{text}");
        assert_eq!(bars("pictures", &[]), "");
    }
}

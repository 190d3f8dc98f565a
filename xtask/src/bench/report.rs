//! The table of a benchmark run, with what it was measured on.

use std::fmt::Write;
use std::process::Command;

use super::measure::Cost;
use crate::process;

/// One picture's counted runs; empty where a renderer was not measured.
pub struct Row {
    pub name: &'static str,
    pub ours: Vec<Cost>,
    pub theirs: Vec<Cost>,
}

/// The report in Markdown.
pub fn text(rows: &[Row], runs: usize, machine: &str, versions: &[String]) -> String {
    let mut text = format!(
        "Whole process, {}x{}, {} threads, no antialiasing; medians of {runs} alternating runs, CPU seconds with their \
         smallest and largest.\n\n",
        super::WIDTH,
        super::HEIGHT,
        super::THREADS
    );
    text += "| picture | Snell CPU s | POV-Ray CPU s | POV-Ray / Snell | Snell wall s | POV-Ray wall s | Snell MiB | POV-Ray MiB |\n";
    text += "|---|---|---|---|---|---|---|---|\n";
    for Row { name, ours, theirs } in rows {
        let ratio =
            median(ours, |cost| cost.cpu).zip(median(theirs, |cost| cost.cpu)).map(|(ours, theirs)| theirs / ours);
        let cells = [
            spread(ours),
            spread(theirs),
            ratio.map_or("-".to_owned(), |ratio| format!("{ratio:.2}")),
            cell(median(ours, |cost| cost.wall), 3),
            cell(median(theirs, |cost| cost.wall), 3),
            cell(median(ours, |cost| cost.memory), 0),
            cell(median(theirs, |cost| cost.memory), 0),
        ];
        // Writing into a String cannot fail.
        let _ = writeln!(text, "| {name} | {} |", cells.join(" | "));
    }
    let _ = writeln!(text, "\nMachine: {machine}");
    for version in versions {
        let _ = writeln!(text, "- {}", version.trim());
    }
    text
}

fn cell(value: Option<f64>, decimals: usize) -> String {
    value.map_or("-".to_owned(), |value| format!("{value:.decimals$}"))
}

/// `median (smallest to largest)` of the CPU seconds.
fn spread(costs: &[Cost]) -> String {
    let Some(middle) = median(costs, |cost| cost.cpu) else { return "-".to_owned() };
    let smallest = costs.iter().map(|cost| cost.cpu).fold(f64::INFINITY, f64::min);
    let largest = costs.iter().map(|cost| cost.cpu).fold(0.0, f64::max);
    format!("{middle:.3} ({smallest:.3} to {largest:.3})")
}

/// The middle value, or the mean of the two middle ones.
fn median(costs: &[Cost], of: fn(&Cost) -> f64) -> Option<f64> {
    let mut values: Vec<f64> = costs.iter().map(of).collect();
    values.sort_by(f64::total_cmp);
    let upper = *values.get(values.len() / 2)?;
    Some(if values.len() % 2 == 1 { upper } else { (values[values.len() / 2 - 1] + upper) / 2.0 })
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

    fn costs(cpu: &[f64]) -> Vec<Cost> {
        cpu.iter().map(|&cpu| Cost { cpu, wall: cpu, memory: 10.0 }).collect()
    }

    #[test]
    fn medians() {
        assert_eq!(median(&costs(&[3.0, 1.0, 2.0]), |cost| cost.cpu), Some(2.0));
        assert_eq!(median(&costs(&[4.0, 1.0, 2.0, 3.0]), |cost| cost.cpu), Some(2.5));
        assert_eq!(median(&[], |cost| cost.cpu), None);
    }

    #[test]
    fn the_ratio_is_the_peer_over_ours_and_missing_runs_are_dashes() {
        let rows = [
            Row { name: "both", ours: costs(&[0.5, 0.4, 0.6]), theirs: costs(&[2.0]) },
            Row { name: "one", ours: Vec::new(), theirs: costs(&[2.0]) },
        ];
        let text = text(&rows, 3, "a machine", &["snell 1".to_owned()]);
        assert!(text.contains("| both | 0.500 (0.400 to 0.600) | 2.000 (2.000 to 2.000) | 4.00 | 0.500 |"), "{text}");
        assert!(text.contains("| one | - | 2.000 (2.000 to 2.000) | - | - | 2.000 | - | 10 |"), "{text}");
        assert!(text.contains("a machine") && text.contains("- snell 1"), "{text}");
    }
}

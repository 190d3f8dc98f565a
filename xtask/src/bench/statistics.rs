//! Alternating runs and what is said of them: medians with the smallest and the largest.
//!
//! Runs alternate, so that a machine that slows down slows all; a warm-up run of each is not counted.

use std::process::Command;

use super::measure::{Cost, measure};

/// One program's counted runs.
#[derive(Clone, Debug, Default)]
pub struct Series {
    /// Whose, as the tables name it.
    pub name: &'static str,
    pub costs: Vec<Cost>,
}

impl Series {
    /// The median of one of the costs; `None` without runs.
    pub fn median(&self, of: fn(&Cost) -> f64) -> Option<f64> {
        let mut values: Vec<f64> = self.costs.iter().map(of).collect();
        median(&mut values)
    }

    /// `median (smallest to largest)` of one of the costs.
    pub fn spread(&self, of: fn(&Cost) -> f64) -> String {
        let Some(middle) = self.median(of) else { return "-".to_owned() };
        let smallest = self.costs.iter().map(of).fold(f64::INFINITY, f64::min);
        let largest = self.costs.iter().map(of).fold(0.0, f64::max);
        format!("{middle:.3} ({smallest:.3} to {largest:.3})")
    }
}

/// The middle value, or the mean of the two middle ones; sorts.
pub fn median(values: &mut [f64]) -> Option<f64> {
    values.sort_by(f64::total_cmp);
    let upper = *values.get(values.len() / 2)?;
    Some(if values.len() % 2 == 1 { upper } else { (values[values.len() / 2 - 1] + upper) / 2.0 })
}

/// Runs the commands in turn, once to warm up and `runs` times to count.
pub fn alternate(commands: Vec<(&'static str, Command)>, runs: usize) -> Result<Vec<Series>, String> {
    alternate_by(measure, commands, runs)
}

fn alternate_by(
    measure: fn(&mut Command) -> Result<Cost, String>,
    commands: Vec<(&'static str, Command)>,
    runs: usize,
) -> Result<Vec<Series>, String> {
    let (names, mut commands): (Vec<_>, Vec<_>) = commands.into_iter().unzip();
    let mut series: Vec<Series> = names.into_iter().map(|name| Series { name, costs: Vec::new() }).collect();
    for round in 0..=runs {
        for (command, series) in commands.iter_mut().zip(&mut series) {
            let cost = measure(command)?;
            if round > 0 {
                series.costs.push(cost);
            }
        }
    }
    Ok(series)
}

#[cfg(test)]
mod tests {
    use super::super::measure::measure_here;
    use super::*;

    #[test]
    fn medians_and_spreads() {
        assert_eq!(median(&mut [3.0, 1.0, 2.0]), Some(2.0));
        assert_eq!(median(&mut [4.0, 1.0, 2.0, 3.0]), Some(2.5));
        assert_eq!(median(&mut []), None);
        let costs = [0.5, 0.4, 0.6].map(|cpu| Cost { cpu, wall: 1.0, memory: 10.0 }).to_vec();
        let series = Series { name: "", costs };
        assert_eq!(series.spread(|cost| cost.cpu), "0.500 (0.400 to 0.600)");
        assert_eq!(Series::default().spread(|cost| cost.cpu), "-");
    }

    #[cfg(unix)]
    #[test]
    fn the_warm_up_is_not_counted_and_a_failure_is_told() {
        let series = alternate_by(measure_here, vec![("a", Command::new("true")), ("b", Command::new("true"))], 3)
            .expect("`true` runs");
        assert_eq!(series.iter().map(|series| series.costs.len()).collect::<Vec<_>>(), [3, 3]);
        assert!(alternate_by(measure_here, vec![("a", Command::new("false"))], 1).is_err());
    }
}

//! Where an axis has ticks, and what is written there.
//!
//! Steps are 1, 2 or 5 times a power of ten, after P. Heckbert, "Nice Numbers for Graph Labels", *Graphics Gems*, 1990, or such
//! multiples of π. Places are whole multiples of the step, so that 0.1 + 0.2 is nowhere 0.30000000000000004.

use std::f64::consts::PI;

use snell_math::portable;
use snell_scene::scene::Ticks;

/// A tick: where on the axis, and its label with the markup of [`crate::vector::Text`].
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Tick {
    pub at: f64,
    pub label: String,
}

/// The most ticks that an axis has; where more are asked for, there are as many as fit.
const MOST: f64 = 500.0;

/// A step from tick to tick.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Round {
    /// A digit times a power of ten.
    Decimal { digit: f64, exponent: i32 },
    /// A whole number times π, over a whole number.
    Pi { times: f64, over: f64 },
    /// Of the author's choice.
    Any(f64),
}

impl Round {
    fn multiple(self, k: f64) -> f64 {
        match self {
            Self::Decimal { digit, exponent } => {
                if exponent < 0 {
                    k * digit / power_of_ten(-exponent)
                } else {
                    k * digit * power_of_ten(exponent)
                }
            }
            Self::Pi { times, over } => k * times * PI / over,
            Self::Any(step) => k * step,
        }
    }

    fn label(self, at: f64) -> String {
        match self {
            Self::Pi { .. } => multiple_of_pi(at).unwrap_or_else(|| number(at)),
            Self::Decimal { .. } | Self::Any(_) => number(at),
        }
    }
}

/// The ticks from `from` to `to`, at least `distance` apart where they are chosen here.
pub(super) fn ticks(ticks: &Ticks, pi: bool, from: f64, to: f64, distance: f64) -> Vec<Tick> {
    let name = |at: f64| multiple_of_pi(at).filter(|_| pi).unwrap_or_else(|| number(at));
    match ticks {
        Ticks::None => Vec::new(),
        Ticks::At(places) => {
            let inside = places.iter().filter(|(at, _)| from <= *at && *at <= to);
            let tick = |(at, label): &(f64, Option<String>)| Tick {
                at: *at,
                label: label.clone().unwrap_or_else(|| name(*at)),
            };
            inside.map(tick).collect()
        }
        Ticks::Every(step) if (to - from) / step <= MOST => {
            let mut found = multiples(Round::Any(*step), from, to);
            found.iter_mut().for_each(|tick| tick.label = name(tick.at));
            found
        }
        Ticks::Auto | Ticks::Every(_) => multiples(round(distance, pi), from, to),
    }
}

fn multiples(step: Round, from: f64, to: f64) -> Vec<Tick> {
    let unit = step.multiple(1.0);
    // What differs from the border by rounding only is on it.
    let slack = 1e-9;
    let (first, last) = ((from / unit - slack).ceil(), (to / unit + slack).floor());
    // Beyond 10^15, neighbouring numbers are too far apart to have ticks of this distance.
    if !(first - last).is_finite() || last - first > MOST || first.abs().max(last.abs()) > 1e15 {
        return Vec::new();
    }
    let mut found = Vec::new();
    let mut k = first;
    while k <= last {
        // Not −0.
        let at = step.multiple(k) + 0.0;
        found.push(Tick { at: at.clamp(from, to), label: step.label(at) });
        k += 1.0;
    }
    found
}

/// The smallest round step that is at least so long.
fn round(least: f64, pi: bool) -> Round {
    if pi {
        let fractions = [(1.0, 12.0), (1.0, 6.0), (1.0, 4.0), (1.0, 2.0), (1.0, 1.0), (2.0, 1.0)];
        if let Some((times, over)) =
            fractions.into_iter().find(|(times, over)| times * PI / over >= least * (1.0 - 1e-9))
        {
            return Round::Pi { times, over };
        }
        return match round(least / PI, false) {
            Round::Decimal { digit, exponent } => Round::Pi { times: digit * power_of_ten(exponent), over: 1.0 },
            other => other,
        };
    }
    let exponent = (portable::ln(least) / std::f64::consts::LN_10).floor().clamp(-300.0, 300.0) as i32 - 1;
    for exponent in exponent..exponent + 4 {
        for digit in [1.0, 2.0, 5.0] {
            let step = Round::Decimal { digit, exponent };
            if step.multiple(1.0) >= least * (1.0 - 1e-9) {
                return step;
            }
        }
    }
    Round::Any(least)
}

fn power_of_ten(exponent: i32) -> f64 {
    // Exact to 10^22, and read correctly rounded beyond.
    format!("1e{exponent}").parse().unwrap_or(f64::NAN)
}

/// A true minus sign in place of the hyphen.
fn minus(text: &str) -> String {
    text.replace('-', "−")
}

/// A number as people write it.
pub(super) fn number(at: f64) -> String {
    // Twelve digits: what is beyond comes from rounding.
    let rounded: f64 = format!("{at:.11e}").parse().unwrap_or(at);
    let size = rounded.abs();
    if rounded == 0.0 {
        "0".to_owned()
    } else if (1e-4..1e6).contains(&size) {
        minus(&format!("{rounded}"))
    } else {
        let text = format!("{rounded:e}");
        let (digits, exponent) = text.split_once('e').unwrap_or((&text, "0"));
        let power = format!("10^{{{exponent}}}");
        minus(&match digits {
            "1" => power,
            "-1" => format!("-{power}"),
            digits => format!("{digits}·{power}"),
        })
    }
}

/// A multiple of π by a fraction of small numbers, as "3π/2".
fn multiple_of_pi(at: f64) -> Option<String> {
    let over = (1..=12).map(f64::from).find(|over| {
        let times = at / PI * over;
        (times - times.round()).abs() < 1e-9 * times.abs().max(1.0)
    })?;
    let times = (at / PI * over).round();
    let letters = match times.abs() {
        0.0 => return Some("0".to_owned()),
        1.0 => "π".to_owned(),
        times => format!("{}π", number(times)),
    };
    let sign = if times < 0.0 { "−" } else { "" };
    Some(if over == 1.0 { format!("{sign}{letters}") } else { format!("{sign}{letters}/{over}") })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn auto(from: f64, to: f64, count: f64, pi: bool) -> Vec<String> {
        ticks(&Ticks::Auto, pi, from, to, (to - from) / count).into_iter().map(|tick| tick.label).collect()
    }

    #[test]
    fn ticks_are_round_numbers() {
        assert_eq!(auto(0.0, 1.0, 5.0, false), ["0", "0.2", "0.4", "0.6", "0.8", "1"]);
        assert_eq!(auto(-1.0, 1.0, 5.0, false), ["−1", "−0.5", "0", "0.5", "1"]);
        assert_eq!(auto(-7.3, 12.0, 5.0, false), ["−5", "0", "5", "10"]);
        assert_eq!(auto(0.0, 4e7, 4.0, false), ["0", "10^{7}", "2·10^{7}", "3·10^{7}", "4·10^{7}"]);
        assert_eq!(auto(-2e-9, 0.0, 2.0, false), ["−2·10^{−9}", "−10^{−9}", "0"]);
        assert_eq!(auto(0.0, 2.0 * PI, 4.0, true), ["0", "π/2", "π", "3π/2", "2π"]);
        assert_eq!(auto(-PI, PI, 8.0, true), ["−π", "−3π/4", "−π/2", "−π/4", "0", "π/4", "π/2", "3π/4", "π"]);
        assert_eq!(auto(0.0, 100.0 * PI, 5.0, true), ["0", "20π", "40π", "60π", "80π", "100π"]);
    }

    #[test]
    fn places_are_multiples_and_not_sums() {
        for (from, to) in [(0.0, 1.0), (-3.0, 3.0), (1e-7, 9e-7), (12345.0, 12346.0), (-1e20, 1e20), (0.0, 1e-25)] {
            for count in 1..30 {
                let least = (to - from) / f64::from(count);
                let found = ticks(&Ticks::Auto, false, from, to, least);
                assert!(found.len() <= count as usize + 1);
                assert!(found.iter().all(|tick| from <= tick.at && tick.at <= to));
                for pair in found.windows(2) {
                    assert!(pair[1].at - pair[0].at >= least * (1.0 - 1e-6), "{from} {to} {count}");
                    assert_ne!(pair[0].label, pair[1].label);
                }
                if count >= 6 {
                    assert!(found.len() * 3 + 3 >= count as usize, "{from} {to} {count}: {}", found.len());
                }
            }
        }
        let third = ticks(&Ticks::Every(0.1), false, 0.0, 0.4, 0.2).remove(3);
        assert_eq!((third.at, &*third.label), (0.1 * 3.0, "0.3"));
    }

    #[test]
    fn absurd_wishes_end_soon() {
        assert!(ticks(&Ticks::Every(1e-30), false, 0.0, 1.0, 0.2).len() < 10);
        assert!(ticks(&Ticks::Auto, false, 1e15, 1e15 + 4.0, 1e-9).len() <= MOST as usize + 1);
        assert!(ticks(&Ticks::Auto, false, 1e29, 1e30, 1e-300).is_empty());
        assert!(ticks(&Ticks::Auto, true, -1e30, 1e30, 1e29).len() < 30);
        let own = Ticks::At(vec![(0.5, Some("half".to_owned())), (PI / 3.0, None), (9.0, None)]);
        let labels: Vec<String> = ticks(&own, true, 0.0, 2.0, 0.1).into_iter().map(|tick| tick.label).collect();
        assert_eq!(labels, ["half", "π/3"]);
    }
}

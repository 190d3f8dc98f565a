//! The loops that [`super::roofline`] times. Each is repeated, and the fastest run counts: what the machine can do, not what it did
//! while others used it.

use std::hint::black_box;
use std::time::Instant;

use super::measure::thread_seconds;
use super::vectors::Random;

/// How often each loop is timed.
const REPETITIONS: usize = 7;

/// The shortest of several runs by a clock that tells seconds.
fn fastest(clock: impl Fn() -> f64, mut run: impl FnMut()) -> f64 {
    let time = |run: &mut dyn FnMut()| {
        let start = clock();
        run();
        clock() - start
    };
    (0..REPETITIONS).map(|_| time(&mut run)).fold(f64::INFINITY, f64::min)
}

/// Reading 256 MiB in a row with so many threads, 10⁹ bytes a second of all together.
pub fn bandwidth(threads: usize) -> f64 {
    let memory = vec![1_u64; (256 << 20) / 8];
    let share = memory.len() / threads;
    // Several threads have no CPU time of their own together, so this one is by the clock on the wall.
    let start = Instant::now();
    let seconds = fastest(
        || start.elapsed().as_secs_f64(),
        || {
            std::thread::scope(|scope| {
                for part in memory.chunks_exact(share) {
                    scope.spawn(move || {
                        // Eight sums, so that no addition waits for the one before.
                        let mut sums = [0_u64; 8];
                        for eight in part.as_chunks::<8>().0 {
                            for (sum, value) in sums.iter_mut().zip(eight) {
                                *sum = sum.wrapping_add(*value);
                            }
                        }
                        black_box(sums);
                    });
                }
            });
        },
    );
    (share * threads * 8) as f64 / seconds * 1e-9
}

/// One load whose address is what the one before brought, within so much memory in a random order; nanoseconds.
pub fn latency(kibibytes: u32) -> f64 {
    // One number in each line of 64 bytes tells the next line; all lines are one cycle (Sattolo's algorithm).
    let lines = (kibibytes as usize) << 10 >> 6;
    let mut order: Vec<usize> = (0..lines).collect();
    let mut random = Random::new(1);
    for last in (1..lines).rev() {
        order.swap(last, random.between(0.0, last as f64) as usize);
    }
    let mut memory = vec![0_u64; lines * 8];
    for (from, to) in order.iter().enumerate() {
        memory[from * 8] = *to as u64 * 8;
    }
    let steps = (4 * lines).clamp(1 << 18, 1 << 22);
    let seconds = fastest(thread_seconds, || {
        let mut at = 0_u64;
        for _ in 0..steps {
            at = memory[at as usize];
        }
        black_box(at);
    });
    seconds / steps as f64 * 1e9
}

/// Numbers that are worked on side by side: enough for every register of the widest instructions to have its turn.
const NUMBERS: usize = 192;
const ROUNDS: usize = 1 << 18;

/// 10⁹ multiplications and additions of `f32` a second on one thread, by each kind of instructions that the processor has.
pub fn operations() -> Vec<(&'static str, f64)> {
    let rate = |run: &mut dyn FnMut()| (2 * NUMBERS * ROUNDS) as f64 / fastest(thread_seconds, run) * 1e-9;
    let mut rates = vec![("as compiled for any processor", rate(&mut || chains()))];
    #[cfg(target_arch = "x86_64")]
    {
        if is_x86_feature_detected!("avx2") {
            // SAFETY: the processor has AVX2, as was just asked.
            rates.push(("AVX2", rate(&mut || unsafe { chains_avx2() })));
        }
        if is_x86_feature_detected!("avx512f") {
            // SAFETY: the processor has AVX-512F, as was just asked.
            rates.push(("AVX-512", rate(&mut || unsafe { chains_avx512() })));
        }
    }
    rates
}

/// Each number is multiplied and added to again and again; those beside it do not wait for it.
#[inline(always)]
fn chains() {
    let mut numbers = [1.0_f32; NUMBERS];
    let (factor, summand) = (black_box(0.999_f32), black_box(0.001_f32));
    for _ in 0..ROUNDS {
        for number in &mut numbers {
            *number = *number * factor + summand;
        }
    }
    black_box(numbers);
}

#[cfg(target_arch = "x86_64")]
#[target_feature(enable = "avx2")]
fn chains_avx2() {
    chains();
}

#[cfg(target_arch = "x86_64")]
#[target_feature(enable = "avx512f")]
fn chains_avx512() {
    chains();
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn near_memory_is_faster_than_far() {
        let (near, far) = (latency(16), latency(8192));
        assert!(near > 0.1 && near < far, "{near} {far}");
    }
}

//! What one run of a program cost, as the operating system counted it: CPU seconds, wall seconds, peak memory.
//!
//! Linux counts into a process's peak memory that of the one which started it, up to the moment when the new program takes over
//! (`exec_mmap` keeps the old memory's mark). This one holds meshes of ten million triangles, so it does not start what it measures
//! itself: it starts itself anew, small, as `cargo xtask bench --measure PROGRAM ARGUMENT...`, and that does.

use std::process::{Command, Stdio};

use crate::process;

/// The cost of one process, with all its threads, from start to end.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Cost {
    /// User and system time of all threads together, seconds.
    pub cpu: f64,
    /// From start to end, seconds.
    pub wall: f64,
    /// The largest resident set, MiB.
    pub memory: f64,
}

/// Runs a program to its end and says what it cost; an error unless it succeeds. The program's output is thrown away.
pub fn measure(command: &mut Command) -> Result<Cost, String> {
    let own = std::env::current_exe().map_err(|error| format!("cannot find this program: {error}"))?;
    let mut small = Command::new(own);
    small.args(["bench", MEASURE]).arg(command.get_program()).args(command.get_args());
    if let Some(folder) = command.get_current_dir() {
        small.current_dir(folder);
    }
    let printed = process::output(&mut small)?;
    let numbers: Vec<f64> = printed.split_whitespace().filter_map(|word| word.parse().ok()).collect();
    match numbers.as_slice() {
        &[cpu, wall, memory] => Ok(Cost { cpu, wall, memory }),
        _ => Err(format!("{MEASURE} printed `{}`", printed.trim())),
    }
}

/// The option by which this program is asked to do what [`measure`] needs.
pub const MEASURE: &str = "--measure";

/// Runs `PROGRAM ARGUMENT...` and prints its cost.
pub fn print(words: &[String]) -> Result<(), String> {
    let (program, arguments) = words.split_first().ok_or_else(|| format!("{MEASURE} needs a program"))?;
    let mut command = Command::new(program);
    command.args(arguments).stdin(Stdio::null()).stdout(Stdio::null()).stderr(Stdio::null());
    let Cost { cpu, wall, memory } = measure_here(&mut command)?;
    println!("{cpu} {wall} {memory}");
    Ok(())
}

/// As [`measure`], but started by this very process.
#[cfg(unix)]
pub fn measure_here(command: &mut Command) -> Result<Cost, String> {
    let start = std::time::Instant::now();
    let mut child = command.spawn().map_err(|error| format!("cannot start {}: {error}", process::shown(command)))?;
    let (status, usage) = match wait(&child) {
        Ok(ended) => ended,
        Err(reason) => {
            // The child is still ours: leave no process behind. Both errors would only repeat the first.
            let _ = child.kill();
            let _ = child.wait();
            return Err(reason);
        }
    };
    let wall = start.elapsed().as_secs_f64();
    if status != 0 {
        return Err(format!("{} failed (wait status {status})", process::shown(command)));
    }
    // Linux counts in KiB, macOS in bytes.
    let units_per_mib = if cfg!(target_vendor = "apple") { 1024.0 * 1024.0 } else { 1024.0 };
    Ok(Cost {
        cpu: seconds(usage.ru_utime) + seconds(usage.ru_stime),
        wall,
        memory: usage.ru_maxrss as f64 / units_per_mib,
    })
}

/// Waits for one child; its wait status and its resources alone, not those of children before it.
#[cfg(unix)]
fn wait(child: &std::process::Child) -> Result<(i32, libc::rusage), String> {
    let pid = libc::pid_t::try_from(child.id()).map_err(|_| "a process id out of range".to_owned())?;
    let mut status = 0;
    loop {
        // SAFETY: `rusage` is a plain C structure of integers, for which all zeros is a value.
        let mut usage: libc::rusage = unsafe { std::mem::zeroed() };
        // SAFETY: both pointers are to live, exclusively borrowed locals of the types that wait4 writes, and `pid` is a
        // child of this process that nobody else has waited for, because its handle is borrowed here.
        let ended = unsafe { libc::wait4(pid, &raw mut status, 0, &raw mut usage) };
        if ended == pid {
            return Ok((status, usage));
        }
        let error = std::io::Error::last_os_error();
        if error.kind() != std::io::ErrorKind::Interrupted {
            return Err(format!("cannot wait for a process: {error}"));
        }
    }
}

#[cfg(unix)]
fn seconds(time: libc::timeval) -> f64 {
    time.tv_sec as f64 + time.tv_usec as f64 * 1e-6
}

/// CPU seconds of this thread alone, which others on the machine do not change; where the system cannot tell, seconds.
pub fn thread_seconds() -> f64 {
    #[cfg(unix)]
    {
        // SAFETY: `timespec` is a plain C structure of integers, for which all zeros is a value.
        let mut time: libc::timespec = unsafe { std::mem::zeroed() };
        // SAFETY: the pointer is to a live, exclusively borrowed local of the type that clock_gettime writes.
        if unsafe { libc::clock_gettime(libc::CLOCK_THREAD_CPUTIME_ID, &raw mut time) } == 0 {
            return time.tv_sec as f64 + time.tv_nsec as f64 * 1e-9;
        }
    }
    let now = std::time::SystemTime::now().duration_since(std::time::UNIX_EPOCH);
    now.map_or(0.0, |since| since.as_secs_f64())
}

/// Elsewhere the standard library has no way to ask.
#[cfg(not(unix))]
pub fn measure_here(_: &mut Command) -> Result<Cost, String> {
    Err("benchmarks need an operating system that counts a process's CPU seconds by wait4 (any Unix)".to_owned())
}

#[cfg(all(test, unix))]
mod tests {
    use super::*;

    #[test]
    fn cpu_time_is_counted_and_sleep_is_not() {
        let mut busy = Command::new("sh");
        busy.args(["-c", "i=0; while [ $i -lt 100000 ]; do i=$((i+1)); done"]);
        let busy = measure_here(&mut busy).expect("sh runs");
        assert!(busy.cpu > 0.005 && busy.memory > 0.1, "{busy:?}");
        let idle = measure_here(Command::new("sleep").arg("0.2")).expect("sleep runs");
        assert!(idle.wall >= 0.2 && idle.cpu < 0.1, "{idle:?}");
    }

    #[test]
    fn a_thread_that_sleeps_takes_no_time() {
        let start = thread_seconds();
        std::thread::sleep(std::time::Duration::from_millis(50));
        let slept = thread_seconds() - start;
        assert!((0.0..0.04).contains(&slept), "{slept}");
    }

    #[test]
    fn a_program_that_fails_has_no_cost() {
        assert!(measure_here(&mut Command::new("false")).is_err());
        assert!(measure_here(&mut Command::new("no-such-program-anywhere")).is_err());
    }
}

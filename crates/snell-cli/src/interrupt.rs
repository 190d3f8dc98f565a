//! Ctrl-C and termination: the first signal asks to stop, the second one ends the process at once.

use std::io;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};

use signal_hook::consts::{SIGINT, SIGTERM};
use signal_hook::flag;

/// The signals with the exit codes that shells give them: 128 and the signal's number.
const SIGNALS: [(i32, u8); 2] = [(SIGINT, 130), (SIGTERM, 143)];

/// Whether somebody wants to stop. Copies know the same.
#[derive(Clone, Debug, Default)]
pub struct Interrupt {
    wanted: Arc<AtomicBool>,
    code: Arc<AtomicUsize>,
}

impl Interrupt {
    /// Listens from now on. Before, signals end the process as they do by default, for nothing would be lost.
    ///
    /// # Errors
    /// Where the operating system refuses.
    pub fn listen() -> io::Result<Self> {
        let interrupt = Self::default();
        for (signal, code) in SIGNALS {
            // In this order, the first signal finds the flag still down.
            flag::register_conditional_shutdown(signal, i32::from(code), interrupt.wanted.clone())?;
            flag::register_usize(signal, interrupt.code.clone(), usize::from(code))?;
            flag::register(signal, interrupt.wanted.clone())?;
        }
        Ok(interrupt)
    }

    /// True from the first signal on.
    pub fn is_wanted(&self) -> bool {
        self.wanted.load(Ordering::Relaxed)
    }

    /// The exit code that belongs to the signal that came.
    pub fn code(&self) -> Option<u8> {
        self.is_wanted().then(|| self.code.load(Ordering::Relaxed) as u8)
    }
}

//! Interrupting: the first signal writes what is done, a second one ends at once.

use std::process::{Child, Command, Stdio};
use std::thread::sleep;
use std::time::{Duration, Instant};

use crate::support::{Folder, Run};

/// Hours of work, in tiles of which each takes a moment.
const SLOW: &str = "render nine-red-balls --width 1600 --aa 1024 --tile 4 -o slow.png --json";
/// A single tile that takes hours, so that nobody looks whether to go on.
const STUCK: &str = "render nine-red-balls --width 1600 --aa 1024 --tile 65536 -o slow.png";

/// How long the command may take to begin rendering, and to end after a signal.
const PATIENCE: Duration = Duration::from_secs(60);

fn signal(child: &Child, name: &str) {
    let status = Command::new("kill").args([name, &child.id().to_string()]).status().unwrap();
    assert!(status.success());
}

fn start(folder: &Folder, line: &str) -> Child {
    folder.command(line).stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().unwrap()
}

/// Starts the command and signals it as soon as it renders. Signals before that end it by themselves, as they should: then
/// it is started again and given more time.
fn interrupted(folder: &Folder, line: &str, name: &str) -> Run {
    let mut delay = Duration::from_millis(100);
    loop {
        let child = start(folder, line);
        sleep(delay);
        signal(&child, name);
        let run = Run::new(line, child.wait_with_output().unwrap());
        if run.code.is_some() || delay > PATIENCE {
            return run;
        }
        delay *= 2;
    }
}

#[test]
fn an_interrupted_picture_is_written() {
    for (name, code) in [("-INT", 130), ("-TERM", 143)] {
        let folder = Folder::new();
        let run = interrupted(&folder, SLOW, name);
        assert_eq!(run.code, Some(code), "{run:?}");
        assert_eq!(folder.picture("slow.png").size(), (1600, 1200));
        assert_eq!(folder.names(), ["slow.png"]);
        assert_eq!(run.json()["complete"], false);
        assert!(run.stderr.contains(", interrupted: ") && run.stderr.contains(" % of it is black"), "{run:?}");
    }
}

#[test]
fn a_second_signal_ends_at_once() {
    let folder = Folder::new();
    let mut child = start(&folder, STUCK);
    let begin = Instant::now();
    while child.try_wait().unwrap().is_none() {
        assert!(begin.elapsed() < PATIENCE, "it does not end");
        signal(&child, "-INT");
        sleep(Duration::from_millis(200));
    }
    // Ended by the first signal itself, had it not yet begun; by our exit code otherwise.
    assert!(matches!(child.wait().unwrap().code(), Some(130) | None));
    assert!(folder.names().is_empty());
}

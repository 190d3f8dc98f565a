//! Interrupting: the first signal writes what is done, a second one ends at once.

use std::process::{Child, Command, Stdio};
use std::thread::sleep;
use std::time::Duration;

use crate::support::{Folder, Run};

/// Hours of work, in tiles of which each takes a moment.
const SLOW: &str = "render nine-red-balls --width 1600 --aa 1024 --tile 4 -o slow.png --json";
/// Inside a mirroring ball every ray is reflected a thousand times: one pixel alone takes minutes, and nobody looks whether to
/// go on before it is done.
const STUCK_SCENE: &str = "[render]\ndepth = 1000\nmin_weight = 0\n[camera]\neye = [0, 0, 0.5]\n\
    [[object]]\nsphere = {}\nmaterial = { mirror = 1 }\n";
const STUCK: &str = "render stuck.toml --width 64 --aa 65536 -o slow.png";

/// How long the command may take to begin rendering.
const PATIENCE: Duration = Duration::from_secs(60);

fn signal(child: &Child, name: &str) {
    let status = Command::new("kill").args([name, &child.id().to_string()]).status().unwrap();
    assert!(status.success());
}

fn start(folder: &Folder, line: &str) -> Child {
    folder.command(line).stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().unwrap()
}

/// Starts the command and signals it as soon as it renders. A signal before that ends it by itself, as it should: then it is
/// started again and given more time. `after` has the process once it has lived through the first signal, or ended.
fn interrupted(folder: &Folder, line: &str, name: &str, after: impl Fn(&mut Child)) -> Run {
    let mut delay = Duration::from_millis(100);
    loop {
        let mut child = start(folder, line);
        sleep(delay);
        signal(&child, name);
        after(&mut child);
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
        let run = interrupted(&folder, SLOW, name, |_| ());
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
    folder.write("stuck.toml", STUCK_SCENE);
    let run = interrupted(&folder, STUCK, "-INT", |child| {
        sleep(Duration::from_millis(100));
        if child.try_wait().unwrap().is_none() {
            signal(child, "-INT");
        }
    });
    assert_eq!(run.code, Some(130), "{run:?}");
    assert!(folder.names() == ["stuck.toml"] && run.stderr.is_empty(), "nothing is written: {run:?}");
}

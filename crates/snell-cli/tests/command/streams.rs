//! Standard output: what programs read from it, and readers that go away.

use std::process::Stdio;

use crate::support::Folder;

#[test]
fn the_schema_is_json() {
    let run = Folder::new().good("schema");
    assert_eq!(run.json()["$schema"], "https://json-schema.org/draft/2020-12/schema");
}

#[test]
fn completions_and_manual_pages_are_there() {
    let folder = Folder::new();
    for shell in ["bash", "zsh", "fish", "powershell", "elvish"] {
        assert!(folder.good(&format!("completions {shell}")).text().contains("min-weight"), "{shell}");
    }
    assert!(folder.good("man").text().contains(".TH snell 1"));
    assert!(folder.good("man render").text().contains("min\\-weight"));
    assert!(!folder.good("--help").text().contains("completions"), "what is for installers is not in the way");
}

#[test]
fn help_tells_the_exit_codes_and_gives_examples() {
    let help = Folder::new().good("render --help");
    for part in ["Examples:", "Exit codes:", "130", "snell render"] {
        assert!(help.text().contains(part), "{part}");
    }
}

#[test]
fn a_reader_that_goes_away_is_no_bug() {
    let folder = Folder::new();
    for line in [
        "schema",
        "scenes",
        "scenes lens",
        "completions bash",
        "man",
        "check lens",
        "render --width 64 -o -",
        "render --width 8 --json",
    ] {
        let mut command = folder.command(line);
        let mut child = command.stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().unwrap();
        drop(child.stdout.take());
        let output = child.wait_with_output().unwrap();
        let stderr = String::from_utf8(output.stderr).unwrap();
        assert_eq!(output.status.code(), Some(0), "{line}: {stderr}");
        assert!(!stderr.contains("panic") && !stderr.contains("bug"), "{line}: {stderr}");
    }
}

#[test]
fn nobody_listening_to_messages_is_no_bug() {
    let folder = Folder::new();
    let mut command = folder.command("render --width 8");
    let mut child = command.stderr(Stdio::piped()).spawn().unwrap();
    drop(child.stderr.take());
    assert_eq!(child.wait().unwrap().code(), Some(0));
    assert_eq!(folder.picture("nine-red-balls.png").size(), (8, 6));
}

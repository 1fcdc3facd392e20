//! Runs the program in a folder of its own, and examines the files that it leaves there.

use std::fs;
use std::path::{Path, PathBuf};
#[cfg(unix)]
use std::process::Child;
use std::process::{Command, Output};

use serde_json::Value;
use tempfile::TempDir;

pub(crate) use crate::support::picture::Png;
pub(crate) use crate::support::workspace::names_in;
use crate::support::workspace::root;

/// A temporary folder in which the program runs.
///
/// Words for the program are separated by spaces. `''` is an empty one, `data:house.obj` a file of `tests/data`.
pub(crate) struct Folder(TempDir);

impl Folder {
    pub(crate) fn new() -> Folder {
        Folder(tempfile::tempdir().expect("a folder"))
    }

    pub(crate) fn path(&self, name: impl AsRef<Path>) -> PathBuf {
        self.0.path().join(name)
    }

    pub(crate) fn put(&self, name: &str, contents: impl AsRef<[u8]>) {
        fs::write(self.path(name), contents).expect("written");
    }

    #[track_caller]
    pub(crate) fn read(&self, name: &str) -> Vec<u8> {
        fs::read(self.path(name)).expect(name)
    }

    /// The names in it, sorted.
    pub(crate) fn names(&self) -> Vec<String> {
        names_in(self.0.path())
    }

    /// The program with these arguments, without a display and without preferences from the environment.
    pub(crate) fn program(&self, words: &str) -> Command {
        let mut command = program();
        command.current_dir(&self.0).args(words.split_whitespace().map(|word| match word.strip_prefix("data:") {
            Some(name) => root().join("tests/data").join(name),
            None => if word == "''" { "" } else { word }.into(),
        }));
        command
    }

    pub(crate) fn run(&self, words: &str) -> Output {
        self.program(words).output().expect("started")
    }

    /// The program's standard output; it must succeed and print nothing to standard error.
    #[track_caller]
    pub(crate) fn printed(&self, words: &str) -> String {
        printed(self.run(words))
    }

    /// The program's standard error; it must succeed.
    #[track_caller]
    pub(crate) fn said(&self, words: &str) -> String {
        let output = self.run(words);
        assert!(output.status.success(), "{words}: {output:?}");
        String::from_utf8(output.stderr).expect("text")
    }

    /// Runs a command that must succeed and print nothing.
    #[track_caller]
    pub(crate) fn succeed(&self, words: &str) {
        assert_eq!(self.printed(words), "", "{words}");
    }

    /// The JSON that the program prints. It may give warnings, and exit with status 1.
    #[track_caller]
    pub(crate) fn json(&self, words: &str) -> Value {
        let output = self.run(words);
        serde_json::from_slice(&output.stdout).unwrap_or_else(|error| panic!("{words}: {error}: {output:?}"))
    }

    /// Decodes a picture in the folder.
    #[track_caller]
    pub(crate) fn png(&self, name: &str) -> Png {
        Png::decode(&self.read(name))
    }

    /// The bytes of the picture that `render` writes, without printing anything.
    #[track_caller]
    pub(crate) fn picture(&self, words: &str) -> Vec<u8> {
        self.succeed(&format!("render {words} -o x.png"));
        self.read("x.png")
    }

    /// Runs the program where files can only grow to this many blocks, of 512 or 1,024 bytes.
    #[cfg(target_os = "linux")]
    pub(crate) fn run_with_room(&self, blocks: usize, words: &str) -> Output {
        Command::new("sh")
            .args(["-c", "ulimit -f $1; shift; trap '' XFSZ; exec \"$0\" \"$@\"", env!("CARGO_BIN_EXE_mode13h")])
            .arg(blocks.to_string())
            .args(words.split_whitespace())
            .current_dir(self)
            .output()
            .expect("started")
    }

    /// Runs a command that must fail with this status and one line that contains `says`. Returns the line.
    #[track_caller]
    pub(crate) fn fails(&self, words: &str, status: i32, says: &str) -> String {
        failed(&self.run(words), status, says)
    }
}

impl AsRef<Path> for Folder {
    fn as_ref(&self) -> &Path {
        self.0.path()
    }
}

/// The program without a display and without preferences from the environment.
pub(crate) fn program() -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_mode13h"));
    command.env_remove("DISPLAY").env_remove("WAYLAND_DISPLAY").env_remove("MODE13H_KERNEL");
    command
}

#[track_caller]
pub(crate) fn printed(output: Output) -> String {
    assert!(output.status.success() && output.stderr.is_empty(), "{output:?}");
    String::from_utf8(output.stdout).expect("text")
}

/// Checks that the program failed with this status, reported one line that contains `says`, and printed nothing.
/// Returns the line.
#[track_caller]
pub(crate) fn failed(output: &Output, status: i32, says: &str) -> String {
    let line = String::from_utf8(output.stderr.clone()).expect("text");
    assert_eq!(output.status.code(), Some(status), "{line}");
    assert!(line.starts_with("mode13h: ") && line.contains(says), "{line}\nhas not: {says}");
    assert_eq!(line.find('\n'), Some(line.len() - 1), "more than one line: {line}");
    assert!(output.stdout.is_empty(), "{output:?}");
    line
}

/// Sends a signal such as `-INT`, and waits for the program to end.
#[cfg(unix)]
pub(crate) fn signalled(child: Child, signal: &str) -> Output {
    let killed = Command::new("kill").args([signal, &child.id().to_string()]).status().expect("started");
    assert!(killed.success());
    child.wait_with_output().expect("waited")
}

/// Size, colour type and density of a picture: pixels per unit, across and down.
pub(crate) type Shape = ((u32, u32), png::ColorType, Option<(u32, u32)>);

/// The shape of a frame as the VGA shows it.
pub(crate) const MODE_13H: Shape = ((320, 200), png::ColorType::Indexed, Some((6, 5)));

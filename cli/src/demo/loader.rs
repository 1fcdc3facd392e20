//! The inputs named on the command line, loaded in the background: the first one, another on request, and the current
//! one again when one of its files has changed.

use std::ffi::OsString;
use std::fs;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::mpsc::{Receiver, RecvTimeoutError, Sender, channel};
use std::thread;
use std::time::{Duration, SystemTime};

use crate::failure::Failure;
use crate::options::{Drawing, Moment, ShadingOptions};
use crate::turntable::Turntable;
use crate::{input, read_files};

/// Time between two checks of the files.
const PERIOD: Duration = Duration::from_millis(250);
/// Number of checks for which files must stay the same before a change counts, as one may be half written. A missing
/// file gets longer, because some editors replace it with a new one.
const REST: u32 = 1;
const REST_GONE: u32 = 4;
/// Greatest lag of a file's modification time behind the clock.
const LAG: Duration = Duration::from_millis(20);

/// Inputs to be loaded, and how they are to be drawn.
pub(super) struct Inputs {
    pub(super) moment: Moment,
    pub(super) drawing: Drawing,
    pub(super) shading: ShadingOptions,
    pub(super) words: Vec<OsString>,
}

impl Inputs {
    /// Name of an input, whether it can be loaded or not.
    pub(super) fn name(&self, at: usize) -> String {
        input::name_of(&self.words[at])
    }
}

/// An input that was loaded, or the reason why it was not, and the files that it depends on.
pub(super) struct Loading {
    /// Its index in the list of inputs.
    pub(super) at: usize,
    /// True if it was loaded because a file changed.
    pub(super) is_again: bool,
    pub(super) result: Result<Box<Turntable>, Failure>,
    watch: Watch,
}

/// Loads an input. `known` are the files that it depended on before; if it cannot be loaded, it still does.
pub(super) fn load(inputs: &Inputs, at: usize, known: &[PathBuf]) -> Loading {
    let begun = SystemTime::now();
    let words = &inputs.words[at];
    let (result, mut files) = read_files::noting(|| {
        let stage = inputs.drawing.stage(inputs.drawing.input(words)?)?;
        Ok(Box::new(stage))
    });
    files.extend(inputs.drawing.palette_file());
    files.push(PathBuf::from(words));
    if result.is_err() {
        files.extend_from_slice(known);
        // A missing file may appear.
        let folders: Vec<PathBuf> = files.iter().filter_map(|file| file.parent().map(Path::to_path_buf)).collect();
        let folders = folders.into_iter().map(|folder| if folder.as_os_str().is_empty() { ".".into() } else { folder });
        files.extend(folders);
    }
    files.sort();
    files.dedup();
    Loading { at, is_again: false, result, watch: Watch::new(files, begun) }
}

/// The thread that loads. It ends when this is dropped.
pub(super) struct Loader {
    wanted: Sender<usize>,
    loaded: Receiver<Loading>,
}

impl Loader {
    /// Starts loading the first input, then watches its files.
    pub(super) fn start(inputs: Arc<Inputs>) -> Result<Loader, Failure> {
        let (wanted, asked) = channel();
        let (answers, loaded) = channel();
        let work = move || {
            let (mut at, mut watch) = (0, Watch::new(Vec::new(), SystemTime::now()));
            loop {
                let wanted = match asked.recv_timeout(PERIOD) {
                    // Inputs that were skipped meanwhile are not loaded.
                    Ok(next) => Some(asked.try_iter().last().unwrap_or(next)),
                    Err(RecvTimeoutError::Timeout) => None,
                    Err(RecvTimeoutError::Disconnected) => return,
                };
                let is_again = wanted.is_none();
                if is_again && !watch.has_changed() {
                    continue;
                }
                let known = if is_again { std::mem::take(&mut watch.files) } else { Vec::new() };
                at = wanted.unwrap_or(at);
                let loading = Loading { is_again, ..load(&inputs, at, &known) };
                watch = loading.watch.clone();
                if answers.send(loading).is_err() {
                    return;
                }
            }
        };
        thread::Builder::new().name("loader".to_string()).spawn(work)?;
        let loader = Loader { wanted, loaded };
        loader.ask(0);
        Ok(loader)
    }

    /// Asks for the input at this index to be loaded.
    pub(super) fn ask(&self, at: usize) {
        // The thread ends after this.
        let _ = self.wanted.send(at);
    }

    /// Waits until an input has been loaded, for at most this long.
    pub(super) fn wait(&self, most: Duration) -> Option<Loading> {
        self.loaded.recv_timeout(most).ok()
    }

    /// Takes the input that was loaded since the last call.
    pub(super) fn loaded(&self) -> Option<Loading> {
        self.loaded.try_iter().last()
    }
}

/// Time of a file's last change, and its length; `None` while there is none.
type Stamp = Option<(SystemTime, u64)>;

fn stamp(file: &Path) -> Stamp {
    let metadata = fs::metadata(file).ok()?;
    Some((metadata.modified().ok()?, metadata.len()))
}

/// Notices when files have changed.
#[derive(Clone)]
struct Watch {
    files: Vec<PathBuf>,
    /// The stamp of each file as it was loaded; `None` if the file changed meanwhile.
    loaded: Vec<Option<Stamp>>,
    seen: Vec<Stamp>,
    /// Number of checks in which nothing has changed.
    rested: u32,
}

impl Watch {
    /// Watches files that were loaded after the time `begun`.
    fn new(files: Vec<PathBuf>, begun: SystemTime) -> Watch {
        let seen: Vec<Stamp> = files.iter().map(|file| stamp(file)).collect();
        let is_older = |stamp: &Stamp| stamp.is_none_or(|(changed, _)| changed + LAG < begun);
        let loaded = seen.iter().map(|stamp| Some(*stamp).filter(is_older)).collect();
        Watch { files, loaded, seen, rested: 0 }
    }

    /// Checks all files. Returns whether they differ from those that were loaded, and have rested for a while.
    fn has_changed(&mut self) -> bool {
        let now: Vec<Stamp> = self.files.iter().map(|file| stamp(file)).collect();
        self.rested = if now == self.seen { self.rested + 1 } else { 0 };
        self.seen = now;
        let pairs = || self.loaded.iter().zip(&self.seen);
        let is_gone = pairs().any(|(loaded, seen)| seen.is_none() && *loaded != Some(None));
        let is_other = pairs().any(|(loaded, seen)| *loaded != Some(*seen));
        is_other && self.rested >= if is_gone { REST_GONE } else { REST }
    }
}

#[cfg(test)]
pub(super) mod tests {
    use super::*;
    use clap::Parser;
    use std::process::Command;

    #[derive(Parser)]
    struct Words {
        #[command(flatten)]
        drawing: Drawing,
        #[command(flatten)]
        shading: ShadingOptions,
    }

    /// These inputs, without any option.
    pub(in super::super) fn inputs(words: &[&Path]) -> Arc<Inputs> {
        let Words { drawing, shading } = Words::parse_from(["mode13h"]);
        let words = words.iter().map(|path| path.as_os_str().to_os_string()).collect();
        Arc::new(Inputs { moment: Moment::default(), drawing, shading, words })
    }

    /// The loader's next result, which takes a second or so.
    fn next(loader: &Loader) -> Loading {
        loader.wait(Duration::from_secs(60)).expect("nothing was loaded")
    }

    fn triangles(loading: &Loading) -> usize {
        let stage = loading.result.as_ref().expect("it was loaded");
        stage.scene.objects().iter().map(|object| object.mesh().triangles().len()).sum()
    }

    fn reason(loading: &Loading) -> String {
        loading.result.as_ref().err().map(ToString::to_string).unwrap_or_default()
    }

    /// Loads the first input, none of whose files has just changed.
    fn start_at_rest(inputs: &Arc<Inputs>) -> (Loader, Loading) {
        thread::sleep(2 * LAG);
        let loader = Loader::start(Arc::clone(inputs)).expect("a thread");
        let first = next(&loader);
        assert_eq!((first.at, first.is_again), (0, false));
        (loader, first)
    }

    const TRIANGLE: &str = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";

    #[test]
    fn a_model_is_loaded_again_when_it_changes_and_errors_name_the_line() {
        let folder = tempfile::tempdir().expect("a folder");
        let model = folder.path().join("model.obj");
        fs::write(&model, TRIANGLE).expect("written");
        let inputs = inputs(&[&model]);
        let (loader, first) = start_at_rest(&inputs);
        assert_eq!(triangles(&first), 1);

        fs::write(&model, format!("{TRIANGLE}f 1 2 9\n")).expect("written");
        let wrong = next(&loader);
        assert!(wrong.is_again && reason(&wrong).contains("model.obj:5"), "{}", reason(&wrong));
        // Many editors write a new file beside the old one, and then give it the old name.
        let beside = folder.path().join("model.obj~");
        fs::write(&beside, format!("{TRIANGLE}v 1 1 1\nf 1 2 4\nf 2 3 4\n")).expect("written");
        fs::rename(&beside, &model).expect("renamed");
        assert_eq!(triangles(&next(&loader)), 3);
        // Others leave no file for a moment.
        fs::remove_file(&model).expect("removed");
        thread::sleep(PERIOD * 2);
        fs::write(&model, TRIANGLE.replace("1 2 3", "3 2 1 2")).expect("written");
        let back = next(&loader);
        assert!(back.result.is_ok(), "{}", reason(&back));
    }

    /// A pipe is a model that takes as long as its writer does.
    #[cfg(unix)]
    #[test]
    fn a_model_that_takes_long_is_waited_for_no_longer_than_said() {
        let folder = tempfile::tempdir().expect("a folder");
        let model = folder.path().join("slow.obj");
        assert!(Command::new("mkfifo").arg(&model).status().expect("started").success());
        let loader = Loader::start(inputs(&[&model])).expect("a thread");
        assert!(loader.wait(Duration::from_millis(50)).is_none() && loader.loaded().is_none());
        fs::write(&model, TRIANGLE).expect("written");
        assert_eq!(triangles(&next(&loader)), 1);
    }

    #[test]
    fn a_scene_is_loaded_again_when_what_it_names_changes_or_comes() {
        let folder = tempfile::tempdir().expect("a folder");
        let in_folder = |name: &str| folder.path().join(name);
        fs::write(in_folder("a.obj"), format!("mtllib a.mtl\nusemtl a\n{TRIANGLE}")).expect("written");
        fs::write(in_folder("a.mtl"), "newmtl a\nKd 1 0 0\n").expect("written");
        let scene = in_folder("scene.toml");
        fs::write(&scene, "[[objects]]\nmodel = \"a.obj\"\n").expect("written");
        let inputs = inputs(&[&scene]);
        let (loader, first) = start_at_rest(&inputs);
        assert_eq!(triangles(&first), 1);

        let diffuse = |loading: &Loading| {
            let stage = loading.result.as_ref().expect("it was loaded");
            stage.scene.objects()[0].mesh().surfaces()[0].diffuse
        };
        fs::write(in_folder("a.mtl"), "newmtl a\nKd 0 0.5 0\n").expect("written");
        assert_eq!(diffuse(&next(&loader)), [0.0, 0.5, 0.0]);
        fs::write(&scene, "[[objects]]\nmodel = \"missing.obj\"\n").expect("written");
        let wrong = next(&loader);
        assert!(reason(&wrong).contains("scene.toml:2"), "{}", reason(&wrong));
        fs::write(in_folder("missing.obj"), TRIANGLE).expect("written");
        assert_eq!(triangles(&next(&loader)), 1);
    }

    #[test]
    fn the_last_that_was_asked_for_is_loaded_and_watched() {
        let folder = tempfile::tempdir().expect("a folder");
        let in_folder = |name: &str| folder.path().join(name);
        let (a, b, c) = (in_folder("a.obj"), in_folder("b.obj"), in_folder("c.obj"));
        fs::write(&a, TRIANGLE).expect("written");
        fs::write(&c, format!("{TRIANGLE}f 1 3 2\n")).expect("written");
        let inputs = inputs(&[&a, &b, &c]);
        let (loader, _) = start_at_rest(&inputs);
        loader.ask(1);
        let missing = next(&loader);
        assert_eq!((missing.at, missing.is_again), (1, false));
        assert!(reason(&missing).contains("b.obj"), "{}", reason(&missing));
        loader.ask(2);
        let third = next(&loader);
        assert_eq!((third.at, triangles(&third)), (2, 2));
        // The first is not watched any more.
        fs::write(&a, "v").expect("written");
        thread::sleep(PERIOD * 4);
        assert!(loader.loaded().is_none());
    }

    #[test]
    fn a_change_is_believed_when_it_rests() {
        let folder = tempfile::tempdir().expect("a folder");
        let file = folder.path().join("file");
        fs::write(&file, "a").expect("written");
        let mut watch = Watch::new(vec![file.clone()], SystemTime::now() + 2 * LAG);
        assert!(!watch.has_changed() && !watch.has_changed());
        for length in 2..5 {
            fs::write(&file, "a".repeat(length)).expect("written");
            assert!(!watch.has_changed(), "it is still being written");
        }
        assert!(watch.has_changed());
        fs::remove_file(&file).expect("removed");
        assert!((0..REST_GONE).all(|_| !watch.has_changed()), "a new one may come");
        assert!(watch.has_changed());
        // One that changed while it was being loaded.
        fs::write(&file, "a").expect("written");
        let mut watch = Watch::new(vec![file], SystemTime::now() - 2 * LAG);
        assert!(watch.has_changed());
    }
}

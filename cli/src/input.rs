//! Input: from the arguments INPUT and FILE|NAME to a scene or a mesh, and to a palette.

use std::ffi::OsStr;
use std::fmt::Display;
use std::fs::File;
use std::io::{self, BufRead, BufReader, Read};
use std::path::{Path, PathBuf};
use std::sync::OnceLock;
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::mpsc::{self, RecvTimeoutError};
use std::thread;
use std::time::Duration;

use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};
use mode13h::light::Light;
use mode13h::mesh::{Mesh, Weight, shapes};
use mode13h::palette::{Palette, builtin};
use mode13h::scene::{Camera, Object, Scene, UpAxis};
use mode13h_assets::look::Look;
use mode13h_assets::model::{self, Playback, with_textures};
use mode13h_assets::model_file::{self, Embedded, Format, ModelFileError, Options, Rig};
use mode13h_assets::palette_file::{self, LoadErrorKind};
use mode13h_assets::shipped::Shipped;
use mode13h_assets::{SceneExt, scene_file};

use crate::failure::{Failure, on_one_line};
use crate::turntable::{Colors, Turntable};
use crate::{output, read_files, typo};

/// A mesh, and what to call it.
pub(crate) struct Model {
    pub(crate) name: String,
    pub(crate) mesh: Mesh,
    /// The textures in its file.
    textures: Embedded,
    /// The axis that points up, if its file says so.
    up: Option<UpAxis>,
    /// The lights, the camera and the animations in its file.
    lights: Vec<Light>,
    camera: Option<Camera>,
    rig: Option<Rig>,
    /// The animation that it plays.
    clip: usize,
    /// One of the engine's shapes, not from a file.
    pub(crate) is_shape: bool,
}

impl Model {
    /// Makes it play an animation by its name or number.
    pub(crate) fn choose(&mut self, clip: &str) -> Result<(), Failure> {
        let found = match &self.rig {
            Some(rig) => rig.find_clip(clip).map_err(|unknown| unknown.to_string()),
            None => Err("it has no animation".to_string()),
        };
        self.clip = found.map_err(|what| Failure::words(format!("--clip: {}: {what}", self.name)))?;
        Ok(())
    }

    /// The stage on which it is shown, in greys. If the user gives an axis, the file's lights and camera are left out;
    /// if the user gives a camera, the file's camera is.
    pub(crate) fn stage(self, up: Option<UpAxis>, has_camera: bool) -> Result<Turntable, Failure> {
        if self.is_shape {
            return Ok(Turntable::of_shape(self.mesh, up));
        }
        let (textures, warnings) = model::textures(&self.mesh, &self.textures);
        warnings.iter().for_each(warn);
        let object = with_textures(Object::new(self.mesh), &textures);
        let (lights, camera) = if up.is_none() { (self.lights, self.camera) } else { (Vec::new(), None) };
        let camera = camera.filter(|_| !has_camera);
        let moving = self.rig.map(|rig| (rig, self.clip));
        let stage = match lights.is_empty() && camera.is_none() {
            true => Turntable::of_model(object, up.or(self.up), moving),
            false => Turntable::of_composed(object, &lights, camera, moving),
        };
        stage.map_err(Failure::from)
    }
}

/// Scene or model that INPUT names.
pub(crate) enum Input {
    Model(Box<Model>),
    Scene { name: String, scene: Box<Scene>, look: Option<(Look, Box<Scene>)>, playbacks: Vec<Playback> },
}

impl Input {
    /// Its name.
    pub(crate) fn name(&self) -> &str {
        match self {
            Self::Model(model) => &model.name,
            Self::Scene { name, .. } => name,
        }
    }
}

/// Meaning of INPUT, for the help.
pub(crate) const HELP: &str =
    "A scene (.toml), a model (.obj, .stl, .ply, .gltf, .glb), a name, or - for standard input";

/// Meaning of INPUT, for the long help.
pub(crate) fn long_help() -> String {
    format!(
        "{HELP}. `mode13h list scenes` shows the names; if a scene and a shape share a name, it means the scene. Files may be \
         gzipped. In a scene on standard input, file names are relative to the current directory."
    )
}

/// An INPUT that is not a plain file: standard input, or a compressed file. Holds its bytes, the name to call it by,
/// and whether it is a scene.
struct Stream {
    bytes: Box<dyn BufRead>,
    path: PathBuf,
    is_scene: bool,
}

/// Returns whether an INPUT is standard input.
pub(crate) fn is_standard(words: &OsStr) -> bool {
    words == "-" || words == "/dev/stdin"
}

/// The stream that an INPUT names, if it names one.
fn stream(words: &OsStr) -> Result<Option<Stream>, Failure> {
    let path = Path::new(words);
    let failed = |error: io::Error| Failure::work(format!("{}: {error}", path.display()));
    let (bytes, name): (Box<dyn BufRead>, _) = if is_standard(words) {
        (Box::new(standard_input().map_err(failed)?), PathBuf::from("standard input"))
    } else if output::has_extension(path, "gz") {
        (Box::new(BufReader::new(File::open(path).map_err(failed)?)), path.to_owned())
    } else {
        return Ok(None);
    };
    let mut bytes = model_file::unpacked(bytes).map_err(failed)?;
    let is_toml = output::has_extension(unpacked_name(&name), "toml");
    let is_scene = match is_toml || Format::of_path(&name).is_some() {
        true => is_toml,
        false => {
            let mut all = Vec::new();
            bytes.read_to_end(&mut all).map_err(failed)?;
            let is_scene = is_scene(&all);
            bytes = Box::new(io::Cursor::new(all));
            is_scene
        }
    };
    if path.is_file() {
        read_files::add(path);
    }
    Ok(Some(Stream { bytes, path: name, is_scene }))
}

/// Returns whether bytes are a scene rather than a model: text with a list of objects.
fn is_scene(bytes: &[u8]) -> bool {
    let has_objects = |text: &str| {
        let mut lines = text.lines().map(str::trim_start);
        lines.any(|line| line.starts_with("[[objects]]") || line.starts_with("objects"))
    };
    str::from_utf8(bytes).is_ok_and(has_objects)
}

/// Returns whether a file without an extension is a scene.
fn is_scene_file(words: &OsStr) -> bool {
    let path = Path::new(words);
    if path.extension().is_some() || words.to_str().is_some_and(|name| shapes::NAMES.contains(&name)) {
        return false;
    }
    let mut text = Vec::new();
    let file = model_file::open_named(path).ok();
    file.is_some_and(|file| file.take(LONGEST_SCENE).read_to_end(&mut text).is_ok() && is_scene(&text))
}

/// All of standard input, read when first asked for, because a pipe gives its bytes only once.
fn standard_input() -> io::Result<&'static [u8]> {
    static BYTES: OnceLock<Vec<u8>> = OnceLock::new();
    // The thread that holds the lock reads; others find the bytes already read.
    let mut input = io::stdin().lock();
    if BYTES.get().is_none() {
        let mut bytes = Vec::new();
        input.read_to_end(&mut bytes)?;
        BYTES.get_or_init(|| bytes);
    }
    Ok(BYTES.get().map(Vec::as_slice).unwrap_or_default())
}

/// Name of an INPUT, whether it can be loaded or not.
pub(crate) fn name_of(words: &OsStr) -> String {
    if is_standard(words) {
        return "stdin".into();
    }
    let words = unpacked_name(Path::new(words));
    words.file_stem().unwrap_or(words.as_os_str()).to_string_lossy().into_owned()
}

/// The name of what a file contains: without `.gz`, if it ends so.
fn unpacked_name(path: &Path) -> &Path {
    path.file_stem().filter(|_| output::has_extension(path, "gz")).map_or(path, Path::new)
}

/// The scene or the model in a file or with a name; if both have that name, the scene. Warnings go to standard error, a
/// line each.
pub(crate) fn input(words: &OsStr, options: &Options) -> Result<Input, Failure> {
    let stream = stream(words)?;
    let loaded = if let Some(Stream { mut bytes, path, is_scene: true }) = stream {
        let mut text = Vec::new();
        let failed = |error| Failure::work(format!("{}: {error}", path.display()));
        bytes.by_ref().take(LONGEST_SCENE).read_to_end(&mut text).map_err(failed)?;
        Scene::from_toml_bytes(&text, &path, model_file::open_named)
    } else if let Some(stream) = stream {
        return model_of(stream, options).map(|model| Input::Model(Box::new(model)));
    } else if let Some(shipped) = words.to_str().and_then(|name| name.parse::<Shipped>().ok()) {
        shipped.load()
    } else if output::has_extension(Path::new(words), "toml") || is_scene_file(words) {
        scene_file::load(words)
    } else {
        let known = || typo::no_input(&words.to_string_lossy());
        return model_or(words, options, &format!("models are {} files, scenes .toml", Format::extensions()), &known)
            .map(|model| Input::Model(Box::new(model)));
    };
    let scene_file::Loaded { scene, look, without_look, warnings, files, playbacks, .. } = loaded?;
    files.iter().for_each(|file| read_files::add(file));
    for warning in warnings {
        warn(warning);
    }
    let look = look.zip(without_look.map(Box::new));
    Ok(Input::Scene { name: name_of(words), scene: Box::new(scene), look, playbacks })
}

/// No scene is longer. Longer input is not read to its end, and is rejected as too long.
const LONGEST_SCENE: u64 = 1 << 25;

/// The model of a stream. Warnings go to standard error, one per line.
fn model_of(stream: Stream, options: &Options) -> Result<Model, Failure> {
    let loaded = model_file::parse(stream.bytes, &stream.path, model_file::read_named, options)?;
    Ok(of_file(name_of(stream.path.as_os_str()), loaded))
}

/// The model of a file that was read. Warnings go to standard error, one per line.
fn of_file(name: String, loaded: model_file::Loaded) -> Model {
    let model_file::Loaded { mesh, textures, up, warnings, files, lights, camera, rig, .. } = loaded;
    files.iter().for_each(|file| read_files::add(file));
    warnings.iter().for_each(warn);
    Model { name, mesh, textures, up, lights, camera, rig, clip: 0, is_shape: false }
}

/// Prints a line on standard error.
fn warn(warning: impl Display) {
    output::note(on_one_line(&warning.to_string()));
}

/// The model in a file or the shape with a name. Warnings go to standard error, one per line.
pub(crate) fn model(words: &OsStr, options: &Options) -> Result<Model, Failure> {
    model_or(words, options, &format!("models are {} files", Format::extensions()), &|| {
        format!("no such file or shape; shapes are {}", shapes::NAMES.join(", "))
    })
}

/// Loads INPUT as a model; otherwise says which files and names exist.
fn model_or(words: &OsStr, options: &Options, kinds: &str, known: &dyn Fn() -> String) -> Result<Model, Failure> {
    match stream(words)? {
        Some(stream) if stream.is_scene => {
            return Err(Failure::words(format!("{}: a scene, where a model is needed", stream.path.display())));
        }
        Some(stream) => return model_of(stream, options),
        None => {}
    }
    let path = Path::new(words);
    if let Some(mut mesh) = words.to_str().and_then(shapes::by_name) {
        if options.crease.is_some() {
            mesh.smooth(Weight::Angle, options.crease);
        }
        let name = words.to_string_lossy().into_owned();
        let (textures, lights) = (Embedded::new(), Vec::new());
        Ok(Model { name, mesh, textures, up: None, lights, camera: None, rig: None, clip: 0, is_shape: true })
    } else if Format::of_path(path).is_some() || (path.extension().is_none() && format_of_contents(path).is_some()) {
        load(path, options).map(|loaded| of_file(name_of(words), loaded)).map_err(Failure::from)
    } else {
        let shown = path.display();
        Err(match path.metadata() {
            Ok(metadata) if metadata.is_dir() => Failure::work(format!("{shown}: is a directory, not a model")),
            Ok(metadata) if !metadata.is_file() => {
                Failure::words(format!("{shown}: not a file; a model or scene in a pipe is read as -"))
            }
            Ok(_) => Failure::words(format!("{shown}: unknown kind of file: {kinds}")),
            Err(error) if error.kind() == io::ErrorKind::NotFound => Failure::words(format!("{shown}: {}", known())),
            Err(error) => Failure::work(format!("{shown}: {error}")),
        })
    }
}

/// The format of a file by its contents; `None` if it is in none, or cannot be read.
fn format_of_contents(path: &Path) -> Option<Format> {
    let mut bytes = Vec::new();
    model_file::unpacked(model_file::open_named(path).ok()?).ok()?.read_to_end(&mut bytes).ok()?;
    Format::of_bytes(&bytes)
}

/// Loads a model, with a progress bar if that takes longer than a moment and standard error is a terminal.
fn load(path: &Path, options: &Options) -> Result<model_file::Loaded, ModelFileError> {
    const MOMENT: Duration = Duration::from_millis(300);
    let bar = ProgressBar::with_draw_target(None, ProgressDrawTarget::hidden()).with_style(reading());
    let (done, waits) = mpsc::channel::<()>();
    let loaded = thread::scope(|scope| {
        // In a thread of its own, as making the mesh may take most of the time and reports nothing meanwhile.
        let bar = &bar;
        scope.spawn(move || {
            if waits.recv_timeout(MOMENT) == Err(RecvTimeoutError::Timeout) && !output::is_quiet() {
                bar.set_draw_target(ProgressDrawTarget::stderr());
                bar.enable_steady_tick(Duration::from_millis(100));
            }
        });
        let loaded = model_file::load_with(path, options, |read, total| {
            PERCENT
                .store((100 * read).checked_div(total).map_or(UNKNOWN, |percent| percent.min(100)), Ordering::Relaxed);
            bar.set_length(total);
            bar.set_position(read);
            // The last call is the one that finds the end of the file.
            if read >= total {
                bar.set_message(", making the mesh");
            }
        });
        drop(done);
        loaded
    });
    PERCENT.store(UNKNOWN, Ordering::Relaxed);
    bar.finish_and_clear();
    loaded
}

/// How much has been read of the model that is being loaded, in percent.
static PERCENT: AtomicU64 = AtomicU64::new(UNKNOWN);
const UNKNOWN: u64 = u64::MAX;

/// How much has been read of the model that is being loaded by any thread, in percent; `None` if none is, or if its
/// length is unknown. After 100 the mesh is made.
pub(crate) fn percent_read() -> Option<u64> {
    Some(PERCENT.load(Ordering::Relaxed)).filter(|percent| *percent != UNKNOWN)
}

/// The progress bar of a model that is being read.
fn reading() -> ProgressStyle {
    ProgressStyle::with_template("{spinner} {bar:40} {bytes} of {total_bytes} read{msg}")
        .unwrap_or_else(|_| ProgressStyle::default_bar())
}

/// The extensions of palette files.
pub(crate) fn palette_extensions() -> String {
    let mut extensions: Vec<String> = Vec::new();
    for extension in palette_file::FORMATS.iter().flat_map(|format| format.extensions) {
        let extension = format!(".{extension}");
        if !extensions.contains(&extension) {
            extensions.push(extension);
        }
    }
    extensions.join(", ")
}

/// The name of the palette that is made for what is visible.
pub(crate) const AUTO: &str = "auto";

/// The palette with a name or in a file, and what to call it; or the one that is made for what is seen.
pub(crate) fn colors(words: &OsStr) -> Result<(String, Colors), Failure> {
    if words == AUTO {
        return Ok((AUTO.to_string(), Colors::Auto));
    }
    palette(words).map(|(name, palette)| (name, palette.into()))
}

/// The palette with a name or in a file, and what to call it.
pub(crate) fn palette(words: &OsStr) -> Result<(String, Palette), Failure> {
    if let Some(builtin) = words.to_str().and_then(builtin::by_name) {
        return Ok((builtin.name.to_string(), builtin.palette.clone()));
    }
    let path = Path::new(words);
    let shown = path.display();
    if words == AUTO && !path.exists() {
        return Err(Failure::words("auto is a palette made for a model; mode13h palette --from MODEL shows it"));
    }
    let palette = palette_file::load(path).map_err(|error| match &error.kind {
        LoadErrorKind::Read(read) if read.kind() == io::ErrorKind::NotFound => {
            let names: Vec<&str> = builtin::ALL.iter().map(|builtin| builtin.name).collect();
            let near = words.to_str().and_then(|word| typo::nearest(word, names.iter().copied().chain([AUTO])));
            let known = near.map_or_else(
                || format!("built-in palettes are {}", names.join(", ")),
                |name| format!("did you mean {name}? (mode13h list palettes shows them)"),
            );
            let reason = format!("{shown}: no such file or built-in palette; {known}");
            // A word without an extension is an unknown name.
            if path.extension().is_some() { Failure::work(reason) } else { Failure::words(reason) }
        }
        LoadErrorKind::Read(read) if read.kind() == io::ErrorKind::IsADirectory => {
            Failure::work(format!("{shown}: is a directory, not a palette"))
        }
        LoadErrorKind::Palette(_) | LoadErrorKind::Picture(_) => Failure::words(error.to_string()),
        _ => Failure::work(error.to_string()),
    })?;
    read_files::add(path);
    Ok((name_of(words), palette))
}

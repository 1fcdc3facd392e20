//! The engine of the page, over linear memory.
//!
//! Every export takes numbers. Text and files go into the [`room`], and an export returns text, JSON or bytes as its
//! [`answer`]. An export that can fail returns whether it succeeded; if not, its answer is the reason.
//!
//! | file | what |
//! |---|---|
//! | `stage` | an opened scene: moment, settings, frame, truth, film |
//! | `settings` | settings as lines of text |
//! | `report` | plan, counts and the explanation of a pixel as JSON |
//! | `kit` | the span loop and triangles, for the figures of the text |
//! | `turntable` | the program's own file: a scene at a given time, seen as the user turned it |

mod kit;
mod report;
mod settings;
mod stage;
#[path = "../../../cli/src/turntable.rs"]
#[allow(dead_code, reason = "the program has more use for it")]
mod turntable;

use std::cell::RefCell;
use std::collections::BTreeMap;
use std::panic;
use std::sync::Arc;

use mode13h_assets::shipped;
use mode13h_lab::cost::error_levels;
use serde_json::{Value, json};
use stage::Stage;
use turntable::Pose;

/// The state of an instance.
#[derive(Default)]
struct State {
    room: Vec<u8>,
    /// Files that scenes may name.
    files: BTreeMap<String, Arc<[u8]>>,
    stages: Vec<Option<Stage>>,
}

thread_local! {
    static STATE: RefCell<State> = RefCell::default();
    /// The answer of the last call. It is separate, so that a trap can leave its reason while a scene is borrowed.
    static ANSWER: RefCell<Vec<u8>> = RefCell::default();
}

fn say(answer: Vec<u8>) {
    ANSWER.with(|said| said.try_borrow_mut().map(|mut said| *said = answer).ok());
}

fn with<Result>(work: impl FnOnce(&mut State) -> Result) -> Result {
    STATE.with_borrow_mut(work)
}

/// Answers with what `work` returns for a scene, or with the reason why it failed.
fn on(stage: usize, work: impl FnOnce(&mut Stage) -> Result<Vec<u8>, String>) -> bool {
    let result = with(|state| match state.stages.get_mut(stage) {
        Some(Some(stage)) => work(stage),
        _ => Err("there is no such scene".into()),
    });
    let is_done = result.is_ok();
    say(result.unwrap_or_else(String::into_bytes));
    is_done
}

fn as_text(json: &Value) -> Vec<u8> {
    json.to_string().into_bytes()
}

/// Makes a trap leave its reason as the answer.
#[unsafe(no_mangle)]
extern "C" fn start() {
    panic::set_hook(Box::new(|info| say(info.to_string().into_bytes())));
}

/// The address of room for this many bytes, which the next call reads.
#[unsafe(no_mangle)]
extern "C" fn room(bytes: usize) -> *mut u8 {
    with(|state| {
        state.room.clear();
        state.room.resize(bytes, 0);
        state.room.as_mut_ptr()
    })
}

/// The address of the last answer.
#[unsafe(no_mangle)]
extern "C" fn answer() -> *const u8 {
    ANSWER.with_borrow(|said| said.as_ptr())
}

/// The length of the last answer, in bytes.
#[unsafe(no_mangle)]
extern "C" fn answer_length() -> usize {
    ANSWER.with_borrow(Vec::len)
}

/// Answers with constant data: the shipped scenes, the shadings, the levels of an error map.
#[unsafe(no_mangle)]
extern "C" fn about() {
    let shipped = shipped::ALL.iter();
    let shipped = shipped.map(|scene| json!({ "name": scene.name, "toml": scene.text, "shows": scene.shows() }));
    let levels = error_levels::ALL.iter();
    let levels = levels.map(|level| json!({ "label": level.label, "color": format!("#{:06x}", level.color) }));
    let about = json!({
        "shipped": shipped.collect::<Value>(),
        "shadings": mode13h::settings::Shading::ALL.map(mode13h::settings::Shading::name),
        "effects": mode13h::plan::Effect::ALL.map(mode13h::plan::Effect::name),
        "levels": levels.collect::<Value>(),
        "notTaken": format!("#{:06x}", error_levels::NOT_TAKEN),
        "kernel": mode13h::span::Kernel::default().name(),
        "version": env!("CARGO_PKG_VERSION"),
    });
    say(as_text(&about));
}

/// Keeps the room as a file that scenes may name. It holds the file's name, of this many bytes, then its contents.
#[unsafe(no_mangle)]
extern "C" fn file(name: usize) {
    with(|state| {
        let (name, contents) = state.room.split_at(name.min(state.room.len()));
        state.files.insert(String::from_utf8_lossy(name).into_owned(), contents.into());
    });
}

/// Forgets the files.
#[unsafe(no_mangle)]
extern "C" fn forget_files() {
    with(|state| state.files.clear());
}

/// Opens the scene whose TOML is in the room. Returns its number, or −1; the answer is JSON either way: a description
/// of the scene, or the error with its line and column.
#[unsafe(no_mangle)]
extern "C" fn open() -> i32 {
    with(|state| match Stage::open(&state.room, &state.files) {
        Ok(stage) => {
            say(as_text(&stage.about()));
            let free = state.stages.iter().position(Option::is_none).unwrap_or(state.stages.len());
            state.stages.resize_with(state.stages.len().max(free + 1), || None);
            state.stages[free] = Some(stage);
            // Far below 2³¹: each takes more than a byte of 4 GiB.
            free as i32
        }
        Err(error) => {
            say(as_text(&error));
            -1
        }
    })
}

/// Closes a scene.
#[unsafe(no_mangle)]
extern "C" fn close(stage: usize) {
    with(|state| state.stages.get_mut(stage).and_then(Option::take));
}

/// Sets how a scene is drawn, by the lines in the room.
#[unsafe(no_mangle)]
extern "C" fn set(stage: usize) -> bool {
    let lines = with(|state| String::from_utf8_lossy(&state.room).into_owned());
    on(stage, |stage| stage.set(&lines).map(|()| Vec::new()))
}

/// Moves a scene to a time in seconds, turned and tilted by these angles in radians, and enlarged.
#[unsafe(no_mangle)]
extern "C" fn show(stage: usize, seconds: f64, turn: f64, tilt: f64, zoom: f64) -> bool {
    on(stage, |stage| stage.show(seconds, Pose { turn, tilt, zoom }).map(|()| Vec::new()))
}

/// Draws a frame; with `again`, even if nothing has changed since the last one.
#[unsafe(no_mangle)]
extern "C" fn draw(stage: usize, again: bool) -> bool {
    on(stage, |stage| stage.draw(again).map(|()| Vec::new()))
}

/// Answers with the frame: 64,000 bytes, and 768 of its palette.
#[unsafe(no_mangle)]
extern "C" fn frame(stage: usize) -> bool {
    on(stage, |stage| Ok(stage.frame()))
}

/// Answers with the counts of the frame that was drawn last.
#[unsafe(no_mangle)]
extern "C" fn counts(stage: usize) -> bool {
    on(stage, |stage| Ok(as_text(&stage.counts())))
}

/// Answers with the plan of the frame that was drawn last.
#[unsafe(no_mangle)]
extern "C" fn plan(stage: usize) -> bool {
    on(stage, |stage| Ok(as_text(&stage.plan())))
}

/// Answers with the explanation of a pixel.
#[unsafe(no_mangle)]
extern "C" fn explain(stage: usize, x: u32, y: u32) -> bool {
    on(stage, |stage| stage.explain(x, y).map(|account| as_text(&account)))
}

/// Answers with the true picture in the format of a frame, by the standard with this index.
#[unsafe(no_mangle)]
extern "C" fn exact(stage: usize, standard: usize) -> bool {
    on(stage, |stage| stage.exact(standard))
}

/// Answers with the figures of the frame's errors. The map itself is in [`error_map`].
#[unsafe(no_mangle)]
extern "C" fn judge(stage: usize) -> bool {
    on(stage, |stage| stage.judge().map(|figures| as_text(&figures)))
}

/// Answers with the level of each pixel's error, 64,000 bytes: an index into the levels; the next index where no error
/// was measured; the one after it where a face is seen edge-on; 255 where there is no face and should be none.
#[unsafe(no_mangle)]
extern "C" fn error_map(stage: usize) -> bool {
    on(stage, |stage| Ok(stage.error_map().to_vec()))
}

/// Answers with the frame as a PNG file.
#[unsafe(no_mangle)]
extern "C" fn png(stage: usize) -> bool {
    on(stage, |stage| stage.png())
}

/// Adds frame `number` of an animation of `frames`, which is one loop. The answer to the last one is the GIF file.
#[unsafe(no_mangle)]
extern "C" fn film(stage: usize, number: u32, frames: u32) -> bool {
    on(stage, |stage| stage.film(number, frames))
}

/// Answers with a span: `count` bytes of the 8.8 loop from `shade` by `step`.
#[unsafe(no_mangle)]
extern "C" fn span(shade: u16, step: u16, count: usize) {
    say(kit::span(shade, step, count));
}

/// Answers with a frame of the triangles in the room: nine f64 each, x, y and shade of three corners.
#[unsafe(no_mangle)]
extern "C" fn triangles() {
    say(with(|state| kit::triangles(&state.room)));
}

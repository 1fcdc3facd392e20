//! A window that shows a [`Vga`] or any other picture, and its user input.
//!
//! [`run`] is the whole frame loop of a game in mode 13h; [`Window`] is for programs with their own loop, or with
//! frames of another size. Without a display, both return a [`WindowError`] and do not panic.

mod area;
mod canvas;
mod fit;
mod input;
mod key;
mod screen;

use std::fmt;
use std::thread;
use std::time::{Duration, Instant};

pub use area::Area;
pub use canvas::Canvas;
pub use input::{Buttons, Input};
pub use key::Key;

use crate::export::{MAX_SIDE, Picture, PictureError};
use crate::vga::Vga;
use fit::Stretched;
use input::Events;

/// A frame of the VGA: 800 clocks × 449 lines at 25.175 MHz, 70.086 Hz.
const FRAME: Duration = Duration::from_nanos(800 * 449 * 1_000_000 / 25_175);

/// The interval at which [`Window::rest`] checks for input, so that a key press is answered within
/// a twentieth of a second.
const LOOK: Duration = Duration::from_millis(25);
/// The interval at which [`Window::rest`] resends the picture.
const RESEND: Duration = Duration::from_millis(500);

/// Whether the window stays open after a frame.
#[derive(Clone, Copy, Hash, Debug, PartialEq, Eq)]
pub enum Flow {
    /// The next frame follows.
    Continue,
    /// The window closes, and [`run`] returns.
    Close,
}

/// The result of a frame function of [`run`]: nothing (the window stays open), a [`Flow`], or a `Result` with either,
/// whose error ends the loop and is returned.
pub trait FrameResult {
    /// The error type of [`run`].
    type Error: From<WindowError>;

    /// Returns whether the window stays open.
    ///
    /// # Errors
    ///
    /// The error of the frame function.
    fn flow(self) -> Result<Flow, Self::Error>;
}

impl FrameResult for () {
    type Error = WindowError;

    fn flow(self) -> Result<Flow, WindowError> {
        Ok(Flow::Continue)
    }
}

impl FrameResult for Flow {
    type Error = WindowError;

    fn flow(self) -> Result<Flow, WindowError> {
        Ok(self)
    }
}

impl<E: From<WindowError>> FrameResult for Result<(), E> {
    type Error = E;

    fn flow(self) -> Result<Flow, E> {
        self.map(|()| Flow::Continue)
    }
}

impl<E: From<WindowError>> FrameResult for Result<Flow, E> {
    type Error = E;

    fn flow(self) -> Result<Flow, E> {
        self
    }
}

/// Opens a window and calls `frame` for every frame, at most 70 times per second, until it returns [`Flow::Close`] or
/// an error, or the user closes the window.
///
/// `frame` receives the machine to draw on, the user's input since the last frame, and the seconds since the window
/// opened. This time is absolute: after a pause the next frame is drawn for the current time, and missed frames are not
/// made up for. The machine's own clock, which port 3DAh shows, advances with it. To change the title or the window's
/// size, use [`Window`] and a loop of your own.
///
/// # Errors
///
/// [`WindowError`] if there is no display, or if it goes away; the error that `frame` returns.
///
/// ```no_run
/// use mode13h::render::Renderer;
/// use mode13h::scene::Scene;
/// use mode13h::mesh::shapes;
/// use mode13h::window::{self, Flow, Key};
///
/// let mut scene = Scene::showing(shapes::teapot(8));
/// let mut renderer = Renderer::new();
/// window::run("teapot", |vga, input, seconds| -> Result<Flow, Box<dyn std::error::Error>> {
///     scene.set_time(seconds);
///     renderer.draw(&scene, vga)?;
///     Ok(if input.pressed(Key::Escape) { Flow::Close } else { Flow::Continue })
/// })?;
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn run<R: FrameResult>(title: &str, mut frame: impl FnMut(&mut Vga, &Input, f64) -> R) -> Result<(), R::Error> {
    let mut window = Window::open(title)?;
    let mut vga = Vga::new();
    loop {
        let flow = frame(&mut vga, window.input(), window.seconds()).flow()?;
        let before = window.now;
        if flow == Flow::Close || window.show(&vga)? == Flow::Close {
            return Ok(());
        }
        // 2⁶⁴ nanoseconds are 584 years.
        vga.advance(window.now.duration_since(before).as_nanos() as u64);
    }
}

/// An open window, for programs with a loop of their own. Most need only [`run`].
///
/// It shows pictures of any size, in the colours of any palette:
///
/// ```no_run
/// use mode13h::export::{Picture, PixelShape};
/// use mode13h::mesh::shapes;
/// use mode13h::raster::Frame;
/// use mode13h::render::Renderer;
/// use mode13h::scene::Scene;
/// use mode13h::window::{Flow, Window};
///
/// const WIDTH: u32 = 640;
/// const HEIGHT: u32 = 480;
/// let mut scene = Scene::showing(shapes::teapot(8));
/// let (mut renderer, mut window) = (Renderer::new(), Window::open("teapot")?);
/// let palette = scene.palette.clone().unwrap_or_default();
/// let mut pixels = vec![0; (WIDTH * HEIGHT) as usize];
/// loop {
///     scene.set_time(window.seconds());
///     renderer.draw_frame(&scene, Frame::new(&mut pixels, WIDTH, HEIGHT, WIDTH as usize)?, (1, 1))?;
///     let picture = Picture::of(&pixels, WIDTH as usize, &palette);
///     if window.show_picture(&picture)? == Flow::Close {
///         break;
///     }
/// }
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub struct Window {
    window: minifb::Window,
    events: Events,
    input: Input,
    /// Whether the user did something in the frame of `input`.
    has_input: bool,
    picture: Stretched,
    opened: Instant,
    /// The time that the current frame is drawn for.
    now: Instant,
    /// The time that the frame before it was drawn for.
    before: Instant,
    /// The time when the last frame was due, or when it came if it was late.
    begun: Instant,
    /// The time when the picture was last sent to the display.
    sent: Instant,
}

impl Window {
    /// Opens a window: the largest 4:3 window that fits the screen, at most 960 × 720. The user may
    /// resize it; the picture stays 4:3, with black bars beside it.
    ///
    /// The size of the screen is only known on X11. Elsewhere the window opens at 960 × 720.
    ///
    /// # Errors
    ///
    /// [`WindowError`] if there is no display to open it on.
    pub fn open(title: &str) -> Result<Window, WindowError> {
        screen::open(&printable(title)).map(Window::of).map_err(WindowError::new)
    }

    /// Opens a window of this size in screen pixels. The user may resize it.
    ///
    /// # Errors
    ///
    /// [`WindowError`] if there is no display to open it on, or if a side is 0 or above 16,384.
    pub fn open_of_size(title: &str, width: usize, height: usize) -> Result<Window, WindowError> {
        let sides = 1..=usize::from(MAX_SIDE);
        if !sides.contains(&width) || !sides.contains(&height) {
            return Err(WindowError { reason: Reason::Picture(PictureError::Size { width, height }) });
        }
        screen::open_of_size(&printable(title), width, height).map(Window::of).map_err(WindowError::new)
    }

    fn of(mut window: minifb::Window) -> Window {
        // `wait` does the waiting, so that a late frame delays those after it.
        window.set_target_fps(0);
        let events = Events::default();
        window.set_input_callback(Box::new(events.clone()));
        let now = Instant::now();
        let (input, picture) = (Input::default(), Stretched::default());
        Self { window, events, input, has_input: false, picture, opened: now, now, before: now, begun: now, sent: now }
    }

    /// Sets the title.
    pub fn set_title(&mut self, title: &str) {
        self.window.set_title(&printable(title));
    }

    /// The user's input between the last two frames.
    pub fn input(&self) -> &Input {
        &self.input
    }

    /// The time that the current frame is drawn for: seconds since the window opened.
    pub fn seconds(&self) -> f64 {
        self.now.duration_since(self.opened).as_secs_f64()
    }

    /// Shows the picture of `vga`, waits until the next frame is due, 1/70 s after the last, and collects the user's
    /// input in the meantime. Returns [`Flow::Close`] if the user has closed the window.
    ///
    /// # Errors
    ///
    /// [`WindowError`] if the display went away.
    pub fn show(&mut self, vga: &Vga) -> Result<Flow, WindowError> {
        self.before = self.now;
        self.wait(FRAME);
        self.picture.vga(vga, self.window.get_size());
        self.send()
    }

    /// Shows a picture of any size, like [`show`](Self::show): as large as fits, with its pixel
    /// aspect ratio, and black bars beside it.
    ///
    /// # Errors
    ///
    /// [`WindowError`] if the picture's sizes do not fit its bytes, or if the display went away.
    pub fn show_picture(&mut self, picture: &Picture<'_>) -> Result<Flow, WindowError> {
        picture.check().map_err(|error| WindowError { reason: Reason::Picture(error) })?;
        self.before = self.now;
        self.wait(FRAME);
        self.picture.picture(picture, self.window.get_size());
        self.send()
    }

    /// Shows the picture like [`show`](Self::show), and lets `over` draw on top at the window's own
    /// resolution: text that stays readable, panels that leave the frame itself unchanged.
    ///
    /// # Errors
    ///
    /// [`WindowError`] if the display went away.
    pub fn show_over(&mut self, vga: &Vga, over: impl FnOnce(&mut Canvas<'_>)) -> Result<Flow, WindowError> {
        self.before = self.now;
        self.wait(FRAME);
        self.picture.vga(vga, self.window.get_size());
        over(&mut self.picture.canvas());
        self.send()
    }

    /// Leaves the last picture on the screen, and waits for user input, at most for `longest`, so a still picture costs
    /// next to nothing. Input is checked every 25 ms.
    ///
    /// A display may forget the contents of a covered window, so the picture is resent twice a second.
    ///
    /// # Errors
    ///
    /// [`WindowError`] if the display went away.
    pub fn rest(&mut self, longest: Duration) -> Result<Flow, WindowError> {
        self.before = self.now;
        let (size, end) = (self.size(), self.begun.checked_add(longest));
        loop {
            self.wait(LOOK.min(longest));
            let flow = if self.now.duration_since(self.sent) >= RESEND {
                self.send()?
            } else {
                self.window.update();
                self.collect()
            };
            if flow == Flow::Close
                || self.has_input
                || self.size() != size
                || end.is_some_and(|end| self.begun + LOOK > end)
            {
                return Ok(flow);
            }
        }
    }

    /// The window's size in pixels, which the next picture is stretched to.
    pub fn size(&self) -> (usize, usize) {
        self.window.get_size()
    }

    /// Sends the last stretched picture to the display.
    fn send(&mut self) -> Result<Flow, WindowError> {
        let (width, height) = self.size();
        match self.picture.last(width, height) {
            Some(pixels) => self.window.update_with_buffer(pixels, width, height).map_err(WindowError::new)?,
            // A window of size zero, which a tiling desktop can make, or one that was resized since.
            None => self.window.update(),
        }
        self.sent = Instant::now();
        Ok(self.collect())
    }

    fn collect(&mut self) -> Flow {
        self.now = Instant::now();
        let mut input = self.events.collect(&self.window, self.picture.place, self.picture.picture_size());
        input.elapsed = self.now.duration_since(self.before).as_secs_f64();
        self.has_input = input.differs(&self.input);
        self.input = input;
        if self.window.is_open() { Flow::Continue } else { Flow::Close }
    }

    /// Waits until `period` has passed since the last frame began. A late frame delays those after it: missed frames
    /// are not made up for.
    fn wait(&mut self, period: Duration) {
        let (now, due) = (Instant::now(), self.begun + period);
        self.begun = due.max(now);
        thread::sleep(due.saturating_duration_since(now));
    }
}

/// Display systems accept no NUL in a title, and minifb prints to standard output when given one.
fn printable(title: &str) -> String {
    title.replace('\0', " ")
}

/// The error for a missing or lost display, or for a picture that no window can show.
pub struct WindowError {
    reason: Reason,
}

enum Reason {
    Display(minifb::Error),
    Picture(PictureError),
}

impl WindowError {
    fn new(reason: minifb::Error) -> WindowError {
        WindowError { reason: Reason::Display(reason) }
    }
}

/// The first line of another library's message, without a trailing struct printed with its fields,
/// and without a full stop at its end.
fn first_line(said: &str) -> &str {
    let line = said.lines().next().unwrap_or_default();
    let clause = match line.split_once(" { ") {
        Some((before, _)) => before.rsplit_once(": ").map_or(before, |(clause, _)| clause),
        None => line,
    };
    clause.trim_end_matches('.')
}

impl fmt::Display for WindowError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        use minifb::Error::{MenuExists, UpdateFailed, WindowCreate};
        let reason = match &self.reason {
            Reason::Picture(error) => return write!(f, "{error}"),
            Reason::Display(reason) => reason,
        };
        match reason {
            WindowCreate(why) | UpdateFailed(why) | MenuExists(why) => write!(f, "no display: {}", first_line(why)),
            reason => write!(f, "no display: {}", first_line(&reason.to_string())),
        }
    }
}

crate::errors::error_type!(WindowError);

#[cfg(test)]
mod tests {
    use super::WindowError;

    /// The messages of minifb on X11 without a server, and without the library.
    #[test]
    fn a_missing_display_is_one_short_line() {
        for (why, due) in [
            ("XOpenDisplay failed", "no display: XOpenDisplay failed"),
            (
                "failed to load Xlib: OpenError { kind: Library, detail: \"opening library failed (libX11.so.6: cannot open)\" }",
                "no display: failed to load Xlib",
            ),
            ("Failed.\nTry again", "no display: Failed"),
        ] {
            assert_eq!(WindowError::new(minifb::Error::WindowCreate(why.into())).to_string(), due);
        }
    }
}

//! `mode13h demo --terminal`: one INPUT in a terminal that shows pictures, for example over ssh.
//!
//! The terminal is restored however this ends: by a key, after the last frame, by an error, or by a signal.

use std::ffi::OsStr;
use std::io::{self, ErrorKind, IsTerminal, Write};
use std::mem;
use std::time::{Duration, Instant};

use mode13h::export::{Picture, Scale};
use mode13h::render::Renderer;
use mode13h::vga::Vga;
use mode13h_assets::terminal::Protocol;

use super::motion::{ARROW_TAP, Motion, NOTCH};
use crate::failure::Failure;
use crate::output;
use crate::turntable::Turntable;

/// The time from one frame to the next: 35 a second.
const PERIOD: Duration = Duration::from_nanos(1_000_000_000 / 35);

/// The sizes of a frame in square pixels, the larger first; sending an even larger one would take too long.
const SIZES: [(u16, u16); 2] = [(640, 480), (320, 240)];

/// How a frame is sent, and how many are.
pub(super) struct Sending {
    /// The terminal's protocol, if it was given.
    pub(super) to: Option<Protocol>,
    pub(super) scale: Option<Scale>,
    /// The number of frames; without one, a key ends it.
    pub(super) frames: Option<u32>,
}

impl Sending {
    /// Fails if there would be no way to quit.
    pub(super) fn check(&self, inputs: &[impl AsRef<OsStr>]) -> Result<(), Failure> {
        if inputs.len() > 1 {
            return Err(Failure::words("--terminal shows one INPUT, not several"));
        }
        if self.frames.is_none() && !(cfg!(unix) && io::stdin().is_terminal()) {
            return Err(Failure::words(
                "--terminal: standard input is not a terminal, so no key can quit; --frames N quits after N frames",
            ));
        }
        Ok(())
    }

    /// Shows a stage from the time `seconds` on.
    pub(super) fn run(&self, stage: Turntable, renderer: Renderer, seconds: f64) -> Result<(), Failure> {
        // A termination signal waits until the terminal is restored.
        output::to_its_end(|| {
            let protocol = self.to.unwrap_or_else(|| Protocol::of_environment(|name| std::env::var_os(name)));
            let scale = self.scale.unwrap_or_else(scale_that_fits);
            let screen = Screen::open(protocol)?;
            let result = self.show(&screen, scale, stage, renderer, seconds);
            drop(screen);
            result
        })
    }

    fn show(
        &self,
        screen: &Screen,
        scale: Scale,
        mut stage: Turntable,
        mut renderer: Renderer,
        seconds: f64,
    ) -> Result<(), Failure> {
        let mut motion = Motion::new();
        motion.go_to(seconds);
        let begun = Instant::now();
        let (mut vga, mut shown) = (Vga::new(), None);
        let mut due = Instant::now();
        let mut begun_key = Vec::new();
        for number in 1_u32.. {
            let typed = screen.keys.read().map_err(|error| Failure::work(format!("standard input: {error}")))?;
            motion.now = begun.elapsed().as_secs_f64();
            for key in keys(&whole_keys(&mut begun_key, &typed)) {
                match key {
                    Key::End => return Ok(()),
                    Key::Stop => motion.toggle(),
                    Key::Turn(turn, tilt) => {
                        motion.pose.turn += turn;
                        motion.pose.tilt += tilt;
                    }
                    Key::Zoom(factor) => motion.zoom(factor),
                }
            }
            if output::is_interrupted() {
                return Ok(());
            }
            stage.show(motion.seconds(), motion.pose);
            renderer.draw(&stage.scene, &mut vga)?;
            let frame = (vga.pixels().to_vec(), vga.palette());
            // A still picture is sent once.
            if shown.as_ref() != Some(&frame) {
                let picture = Picture::mode_13h(&frame.0, &frame.1);
                match send(&screen.protocol.frame(&picture, scale)?) {
                    Err(error) if error.kind() == ErrorKind::BrokenPipe => return Ok(()),
                    sent => sent.map_err(output::not_printed)?,
                }
                shown = Some(frame);
            }
            if self.frames.is_some_and(|frames| number >= frames) {
                return Ok(());
            }
            // Lost time is not made up: on a slow line, fewer frames are sent.
            due = (due + PERIOD).max(Instant::now());
            std::thread::sleep(due - Instant::now());
        }
        Ok(())
    }
}

fn send(text: &str) -> io::Result<()> {
    let mut out = io::stdout().lock();
    out.write_all(text.as_bytes())?;
    out.flush()
}

/// The largest size that leaves the terminal a line; the smallest if the terminal does not say how large it is.
fn scale_that_fits() -> Scale {
    let [.., least] = SIZES;
    let (across, down) = room().unwrap_or_default();
    let (width, height) = SIZES.into_iter().find(|&(w, h)| w <= across && h <= down).unwrap_or(least);
    Scale::To { width, height }
}

/// The terminal's width and height in pixels, without one line of text.
#[cfg(unix)]
fn room() -> Option<(u16, u16)> {
    let size = rustix::termios::tcgetwinsize(io::stdout()).ok()?;
    Some((size.ws_xpixel, size.ws_ypixel - size.ws_ypixel.checked_div(size.ws_row)?))
}

#[cfg(not(unix))]
fn room() -> Option<(u16, u16)> {
    None
}

/// The alternate screen without a cursor, as long as this lives.
struct Screen {
    protocol: Protocol,
    keys: Keys,
}

impl Screen {
    fn open(protocol: Protocol) -> io::Result<Screen> {
        let screen = Screen { protocol, keys: Keys::open()? };
        send("\x1b[?1049h\x1b[?25l\x1b[2J")?;
        Ok(screen)
    }
}

impl Drop for Screen {
    fn drop(&mut self) {
        // A picture cut off by an error is ended first. If the terminal is gone, none of this matters.
        let _ = send(&format!("\x1b\\\x1b[?2026l{}\x1b[?25h\x1b[?1049l", self.protocol.after_frames()));
    }
}

/// Standard input, if it is a terminal, one key at a time and without an echo, as long as this lives.
struct Keys {
    #[cfg(unix)]
    before: Option<rustix::termios::Termios>,
}

#[cfg(unix)]
impl Keys {
    fn open() -> io::Result<Keys> {
        use rustix::termios::{OptionalActions, SpecialCodeIndex, tcgetattr, tcsetattr};
        if !io::stdin().is_terminal() {
            return Ok(Keys { before: None });
        }
        let before = tcgetattr(io::stdin())?;
        let mut raw = before.clone();
        raw.make_raw();
        // Reading does not wait.
        raw.special_codes[SpecialCodeIndex::VMIN] = 0;
        raw.special_codes[SpecialCodeIndex::VTIME] = 0;
        tcsetattr(io::stdin(), OptionalActions::Now, &raw)?;
        Ok(Keys { before: Some(before) })
    }

    /// The bytes that were typed since the last call.
    fn read(&self) -> io::Result<Vec<u8>> {
        use std::io::Read;
        let mut bytes = [0; 256];
        let count = if self.before.is_some() { io::stdin().lock().read(&mut bytes)? } else { 0 };
        Ok(bytes[..count].to_vec())
    }
}

#[cfg(unix)]
impl Drop for Keys {
    fn drop(&mut self) {
        use rustix::termios::{OptionalActions, tcsetattr};
        if let Some(before) = &self.before {
            // Keys typed meanwhile are not for the shell. A terminal that is gone needs no restoring.
            let _ = tcsetattr(io::stdin(), OptionalActions::Flush, before);
        }
    }
}

#[cfg(not(unix))]
impl Keys {
    fn open() -> io::Result<Keys> {
        Ok(Keys {})
    }

    fn read(&self) -> io::Result<Vec<u8>> {
        Ok(Vec::new())
    }
}

/// A key's request.
#[derive(Clone, Copy, PartialEq, Debug)]
enum Key {
    End,
    /// Pause or resume.
    Stop,
    /// Turn and tilt, in radians.
    Turn(f64, f64),
    /// Enlarge by a factor.
    Zoom(f64),
}

const ESCAPE: u8 = 0x1b;

/// The bytes to decode now: the pending ones in `begun`, and new ones. What may be the beginning of an arrow key waits
/// in `begun` until its rest arrives, or nothing does: over a slow line a key may come in two parts.
fn whole_keys(begun: &mut Vec<u8>, new: &[u8]) -> Vec<u8> {
    let mut bytes = mem::take(begun);
    bytes.extend_from_slice(new);
    let length = match bytes.as_slice() {
        _ if new.is_empty() => 0,
        [.., ESCAPE] => 1,
        [.., ESCAPE, b'[' | b'O'] => 2,
        _ => 0,
    };
    *begun = bytes.split_off(bytes.len() - length);
    bytes
}

/// The keys that a terminal's bytes stand for, without unknown ones.
fn keys(mut bytes: &[u8]) -> Vec<Key> {
    const CTRL_C: u8 = 3;
    let mut keys = Vec::new();
    loop {
        let (key, rest) = match bytes {
            [] => return keys,
            [ESCAPE, b'[' | b'O', b'A', rest @ ..] => (Some(Key::Turn(0.0, -ARROW_TAP)), rest),
            [ESCAPE, b'[' | b'O', b'B', rest @ ..] => (Some(Key::Turn(0.0, ARROW_TAP)), rest),
            [ESCAPE, b'[' | b'O', b'C', rest @ ..] => (Some(Key::Turn(ARROW_TAP, 0.0)), rest),
            [ESCAPE, b'[' | b'O', b'D', rest @ ..] => (Some(Key::Turn(-ARROW_TAP, 0.0)), rest),
            // Other keys with a name: F1 to F4, and those that end in a letter or a ~.
            [ESCAPE, b'O', _, rest @ ..] => (None, rest),
            [ESCAPE, b'[', rest @ ..] => {
                let end = rest.iter().position(|byte| (0x40..0x7f).contains(byte)).map_or(rest.len(), |end| end + 1);
                (None, &rest[end..])
            }
            [ESCAPE] | [b'q' | b'Q' | CTRL_C, ..] => (Some(Key::End), &bytes[1..]),
            [b' ', rest @ ..] => (Some(Key::Stop), rest),
            [b'+' | b'=', rest @ ..] => (Some(Key::Zoom(NOTCH)), rest),
            [b'-' | b'_', rest @ ..] => (Some(Key::Zoom(1.0 / NOTCH)), rest),
            [_, rest @ ..] => (None, rest),
        };
        keys.extend(key);
        bytes = rest;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn keys_are_told_from_the_terminals_own_sequences() {
        assert_eq!(keys(b"q"), [Key::End]);
        assert_eq!(keys(b"\x03"), [Key::End]);
        assert_eq!(keys(b"\x1b"), [Key::End]);
        assert_eq!(keys(b" +"), [Key::Stop, Key::Zoom(NOTCH)]);
        assert_eq!(keys(b"\x1b[C\x1bOD"), [Key::Turn(ARROW_TAP, 0.0), Key::Turn(-ARROW_TAP, 0.0)]);
        // Page up, F5 with Shift, a key with Alt, a letter: none of them ends anything.
        assert_eq!(keys(b"\x1b[5~\x1b[15;2~\x1bxa"), []);
        assert_eq!(keys(b"\x1bOP\x1bOQ\x1bOR\x1bOS"), []);
        assert_eq!(keys(b"\x1b[5~q"), [Key::End]);
        assert_eq!(keys(b"\x1b["), []);
    }

    #[test]
    fn a_key_may_arrive_in_parts() {
        let right = [Key::Turn(ARROW_TAP, 0.0)];
        for parts in [["\x1b", "[C", ""], ["\x1b[", "C", ""], [" \x1b", "[C", ""], ["", "\x1b[C", ""]] {
            let mut begun = Vec::new();
            let pressed: Vec<Key> =
                parts.iter().flat_map(|part| keys(&whole_keys(&mut begun, part.as_bytes()))).collect();
            assert!(pressed.ends_with(&right) && !pressed.contains(&Key::End), "{parts:?}: {pressed:?}");
        }
        // Alone, it is the key itself.
        let mut begun = Vec::new();
        assert_eq!(keys(&whole_keys(&mut begun, b"\x1b")), []);
        assert_eq!(keys(&whole_keys(&mut begun, b"")), [Key::End]);
        assert_eq!(keys(&whole_keys(&mut begun, b"\x1b")), []);
        assert_eq!(keys(&whole_keys(&mut begun, b"\x1b")), [Key::End]);
    }
}

//! Pictures for terminals that show them: DEC sixel and kitty's graphics protocol.
//!
//! A picture is text, which a program prints: [`Protocol::picture`]. The terminal shows it at the cursor.

mod kitty;
mod sixel;

use std::ffi::OsString;
use std::fmt;
use std::str::FromStr;

use mode13h::UnknownName;
use mode13h::export::{Picture, PictureError, Scale};

/// A protocol for showing pictures in a terminal.
///
/// ```
/// use mode13h::export::{Picture, Scale};
/// use mode13h::palette::builtin::GREY;
/// use mode13h_assets::terminal::Protocol;
///
/// let picture = Picture::of(&[7; 3 * 2], 3, &GREY);
/// assert_eq!(Protocol::Sixel.picture(&picture, Scale::One)?, "\x1bP7;0;0q\"1;1;3;2#7;2;3;3;3#7BBB\x1b\\");
/// assert!(Protocol::Kitty.picture(&picture, Scale::One)?.starts_with("\x1b_Ga=T,f=100,q=2,m=0;iVBORw0KGgo"));
/// # Ok::<(), mode13h::export::PictureError>(())
/// ```
#[derive(Clone, Copy, PartialEq, Eq, Hash, Debug)]
#[non_exhaustive]
pub enum Protocol {
    /// DEC's sixels (VT340, 1987), in xterm, foot, mlterm, `WezTerm`, Windows Terminal and others: palette indices as they
    /// are. Its colours are whole percentages, so a channel is off by at most 1.3 of 255.
    Sixel,
    /// The graphics protocol of kitty, also in Ghostty, Konsole and `WezTerm`: an indexed PNG in base64. Its colours are
    /// exact.
    Kitty,
}

impl Protocol {
    /// All protocols.
    pub const ALL: [Protocol; 2] = [Protocol::Sixel, Protocol::Kitty];

    /// Its name, as users type it.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Protocol::Sixel => "sixel",
            Protocol::Kitty => "kitty",
        }
    }

    /// The protocol that the terminal probably supports, by environment variables, which `variable` returns: kitty's if
    /// `KITTY_WINDOW_ID` is set, or if `TERM` or `TERM_PROGRAM` names kitty or Ghostty; otherwise sixel. It is always
    /// sixel in tmux and screen, which do not pass kitty's pictures on.
    #[must_use]
    pub fn of_environment(variable: impl Fn(&str) -> Option<OsString>) -> Protocol {
        let text = |name: &str| variable(name).map(|value| value.to_string_lossy().to_ascii_lowercase());
        let is_set = |name: &str| text(name).is_some_and(|value| !value.is_empty());
        let term = text("TERM").unwrap_or_default();
        // In both `TERM` may be set to another terminal's name.
        if term.starts_with("tmux") || term.starts_with("screen") || is_set("TMUX") || is_set("STY") {
            return Protocol::Sixel;
        }
        let program = text("TERM_PROGRAM").unwrap_or_default();
        let is_named = ["kitty", "ghostty"].into_iter().any(|name| term.contains(name) || program == name);
        let has_window = is_set("KITTY_WINDOW_ID");
        if is_named || has_window { Protocol::Kitty } else { Protocol::Sixel }
    }

    /// A picture at the cursor, which the terminal leaves in the picture's last line.
    ///
    /// # Errors
    /// A picture that is invalid, or too large when enlarged.
    pub fn picture(self, picture: &Picture<'_>, scale: Scale) -> Result<String, PictureError> {
        match self {
            Protocol::Sixel => sixel::picture(picture, scale),
            Protocol::Kitty => kitty::picture(picture, scale, ""),
        }
    }

    /// A frame of an animation, in the upper left corner of the screen, in place of the frame before it.
    ///
    /// A terminal that supports synchronized output shows it only when it has all of it.
    ///
    /// # Errors
    /// Those of [`picture`](Self::picture).
    pub fn frame(self, picture: &Picture<'_>, scale: Scale) -> Result<String, PictureError> {
        let shown = match self {
            Protocol::Sixel => sixel::picture(picture, scale)?,
            // The image with this number replaces the one before it, and the cursor stays.
            Protocol::Kitty => kitty::picture(picture, scale, ",i=13,p=1,C=1")?,
        };
        Ok(format!("\x1b[?2026h\x1b[H{shown}\x1b[?2026l"))
    }

    /// Text to print after the last [`frame`](Self::frame), so that the terminal frees its memory.
    #[must_use]
    pub const fn after_frames(self) -> &'static str {
        match self {
            Protocol::Sixel => "",
            Protocol::Kitty => "\x1b_Ga=d,d=I,i=13,q=2\x1b\\",
        }
    }
}

impl fmt::Display for Protocol {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(self.name())
    }
}

impl FromStr for Protocol {
    type Err = UnknownName;

    fn from_str(name: &str) -> Result<Self, Self::Err> {
        let unknown = UnknownName::of("protocol", &["sixel", "kitty"]);
        Self::ALL.into_iter().find(|protocol| protocol.name() == name).ok_or(unknown)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_environment_names_the_terminal() {
        let of = |variables: &[(&str, &str)]| {
            Protocol::of_environment(|name| {
                variables.iter().find(|(of, _)| *of == name).map(|(_, value)| OsString::from(value))
            })
        };
        assert_eq!(of(&[]), Protocol::Sixel);
        assert_eq!(of(&[("TERM", "xterm-256color")]), Protocol::Sixel);
        assert_eq!(of(&[("TERM", "xterm-kitty")]), Protocol::Kitty);
        assert_eq!(of(&[("TERM", "xterm-ghostty")]), Protocol::Kitty);
        assert_eq!(of(&[("TERM", "xterm-256color"), ("TERM_PROGRAM", "ghostty")]), Protocol::Kitty);
        assert_eq!(of(&[("TERM", "xterm"), ("KITTY_WINDOW_ID", "1")]), Protocol::Kitty);
        assert_eq!(of(&[("KITTY_WINDOW_ID", "")]), Protocol::Sixel);
        assert_eq!(of(&[("TERM", "tmux-256color"), ("KITTY_WINDOW_ID", "1")]), Protocol::Sixel);
        assert_eq!(of(&[("TERM", "xterm-kitty"), ("TMUX", "/tmp/tmux-0/default,1,0")]), Protocol::Sixel);
        assert_eq!(of(&[("TERM", "xterm-kitty"), ("STY", "1.pts-0")]), Protocol::Sixel);
    }
}

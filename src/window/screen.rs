//! The window's initial size: the largest 4:3 that fits the screen, at most 960 × 720.

use minifb::{Result, Scale, ScaleMode, Window, WindowOptions};

/// The largest initial size, in screen pixels: 4:3, every pixel of the frame 3 wide and 3.6 high.
const LARGEST: (usize, usize) = (960, 720);

pub(super) fn open(title: &str) -> Result<Window> {
    let options = WindowOptions { resize: true, scale_mode: ScaleMode::Stretch, ..WindowOptions::default() };
    // Kept open until the window exists: when its last window closes, an X server without a desktop resets, and refuses
    // connections meanwhile.
    let probe = probe()?;
    let fits = |[wide, high]: &[Window; 2]| wide.get_size().0 >= LARGEST.0 && high.get_size().1 >= LARGEST.1;
    if probe.as_ref().is_none_or(fits) {
        Window::new(title, LARGEST.0, LARGEST.1, options)
    } else {
        // The largest multiple of 4 × 3 on this screen, which is smaller than LARGEST.
        Window::new(title, 4, 3, WindowOptions { scale: Scale::FitScreen, ..options })
    }
}

/// A window of this size.
pub(super) fn open_of_size(title: &str, width: usize, height: usize) -> Result<Window> {
    let options = WindowOptions { resize: true, scale_mode: ScaleMode::Stretch, ..WindowOptions::default() };
    Window::new(title, width, height, options)
}

/// Opens two windows whose sizes tell whether the screen is large enough. minifb does not report the size of the screen,
/// but it can open a window at the largest multiple of a size that fits, and reports that: a strip one pixel wide and half
/// as high as the size in question is doubled if the screen is that high. Two such strips, a few pixels thin and gone at
/// once, are less visible than opening a window that does not fit.
fn probe() -> Result<Option<[Window; 2]>> {
    // Strips do not work where windows have a minimum size. There the desktop crops a window that is too large.
    if !cfg!(all(unix, not(target_os = "macos"))) {
        return Ok(None);
    }
    let strip = |width, height| {
        let options = WindowOptions { scale: Scale::FitScreen, none: true, ..WindowOptions::default() };
        Window::new("", width, height, options)
    };
    Ok(Some([strip(LARGEST.0 / 2, 1)?, strip(1, LARGEST.1 / 2)?]))
}

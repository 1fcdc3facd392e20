//! The window's first size: the largest 4:3 that fits the screen, at most 960 × 720.

use minifb::{Result, Scale, ScaleMode, Window, WindowOptions};

/// The largest window that is opened, in screen pixels: 4:3, every pixel of the frame 3 wide and 3.6 high.
const LARGEST: (usize, usize) = (960, 720);

pub(super) fn open(title: &str) -> Result<Window> {
    let options = WindowOptions { resize: true, scale_mode: ScaleMode::Stretch, ..WindowOptions::default() };
    // Kept until the window is there: a display without a desktop begins anew, refusing others meanwhile, whenever the
    // last window on it goes.
    let probe = Probe::new()?;
    if probe.fits_largest() {
        Window::new(title, LARGEST.0, LARGEST.1, options)
    } else {
        // The largest multiple of 4 × 3 on this screen, which is below LARGEST.
        Window::new(title, 4, 3, WindowOptions { scale: Scale::FitScreen, ..options })
    }
}

/// A window of this size.
pub(super) fn open_of_size(title: &str, width: usize, height: usize) -> Result<Window> {
    let options = WindowOptions { resize: true, scale_mode: ScaleMode::Stretch, ..WindowOptions::default() };
    Window::new(title, width, height, options)
}

/// minifb tells nobody the size of the screen. But it opens a window at the largest multiple of a size that the screen
/// holds, and says which: a strip one pixel wide and half as high as the question is doubled if the screen is that
/// high. Two such strips, a few pixels thin and gone at once, tell what opening a window that does not fit would show.
#[cfg(all(unix, not(target_os = "macos")))]
struct Probe {
    wide: Window,
    high: Window,
}

#[cfg(all(unix, not(target_os = "macos")))]
impl Probe {
    fn new() -> Result<Probe> {
        let strip = |width, height| {
            let options = WindowOptions { scale: Scale::FitScreen, none: true, ..WindowOptions::default() };
            Window::new("", width, height, options)
        };
        Ok(Probe { wide: strip(LARGEST.0 / 2, 1)?, high: strip(1, LARGEST.1 / 2)? })
    }

    fn fits_largest(&self) -> bool {
        self.wide.get_size().0 >= LARGEST.0 && self.high.get_size().1 >= LARGEST.1
    }
}

/// Strips are of no use where windows have a least size. There a window that is too large is cut by the desktop.
#[cfg(not(all(unix, not(target_os = "macos"))))]
struct Probe;

#[cfg(not(all(unix, not(target_os = "macos"))))]
impl Probe {
    fn new() -> Result<Probe> {
        Ok(Probe)
    }

    fn fits_largest(&self) -> bool {
        true
    }
}

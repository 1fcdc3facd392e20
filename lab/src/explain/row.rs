//! A row of the frame: its intensity and the slope of that, as drawn and as it should be.
//!
//! Where the slope changes abruptly, as on every edge between two linearly shaded faces, the eye sees a line: a Mach
//! band, though the intensity itself has no step there.

use super::{ExplainError, check};
use crate::cost::Probe;
use crate::truth::{Face, Standard, Truth, TruthFrame};
use mode13h::render::{Renderer, Screen};
use mode13h::scene::Scene;

/// A row of the frame.
#[derive(Clone, PartialEq, Debug)]
pub struct Row {
    /// Index of the row.
    pub y: u32,
    /// Its pixels, from left to right.
    pub columns: Vec<Column>,
}

/// A pixel of a row. Intensities are in shades of 1/255 of full intensity, before texture, fog, dither and blending;
/// for three channels they are the mean.
#[derive(Clone, Copy, PartialEq, Debug, Default)]
pub struct Column {
    /// The face drawn.
    pub face: Option<Face>,
    /// Value drawn; `None` where there is no face.
    pub drawn: Option<f64>,
    /// True value by [`Standard::Gouraud`].
    pub gouraud: Option<f64>,
    /// True value by [`Standard::Lit`].
    pub lit: Option<f64>,
}

/// Row `y` of the frame that `renderer`, with its current settings, draws of `scene`. Draws the whole frame and two of
/// the truth.
///
/// # Errors
/// A row outside the screen; a scene or a screen that cannot be drawn.
pub fn row(renderer: Renderer, scene: &Scene, screen: Screen, y: u32) -> Result<Row, ExplainError> {
    check(screen)?;
    if y >= screen.height {
        return Err(ExplainError::OutsideRow { y, height: screen.height });
    }
    let shown = Probe::new(renderer).look(scene, screen).map_err(ExplainError::Probe)?;
    let truth = Truth::new(scene, screen).map_err(ExplainError::Truth)?;
    let [gouraud, lit] = [Standard::Gouraud, Standard::Lit].map(|standard| truth.draw(standard));
    let mean = |shades: [f64; 3]| (shades[0] + shades[1] + shades[2]) / 3.0;
    let right = |frame: &TruthFrame, x: u32| frame.at(x, y).map(|pixel| 255.0 * mean(pixel.intensity));
    let column = |x: u32| {
        let place = y as usize * screen.width as usize + x as usize;
        let face = shown.faces.get(place).copied().flatten();
        let drawn = face.and_then(|_| shown.shades.get(place).copied().map(mean));
        Column { face, drawn, gouraud: right(&gouraud, x), lit: right(&lit, x) }
    };
    Ok(Row { y, columns: (0..screen.width).map(column).collect() })
}

impl Row {
    /// The slope of an intensity at each pixel, in shades per pixel: half the difference between its left and right
    /// neighbours, both of which must show something.
    pub fn slope(&self, of: impl Fn(&Column) -> Option<f64>) -> Vec<Option<f64>> {
        let values: Vec<Option<f64>> = self.columns.iter().map(of).collect();
        let at = |x: usize| {
            values.get(x).copied().flatten()?;
            let (before, after) = (*values.get(x.checked_sub(1)?)?, *values.get(x + 1)?);
            Some((after? - before?) / 2.0)
        };
        (0..values.len()).map(at).collect()
    }
}

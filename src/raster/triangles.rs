//! Many triangles, batch by batch.

use super::batch::Batch;
use super::depth::Cell;
use super::draw_stats::DrawStats;
use super::interpolation::Interpolation;
use super::triangle::Raster;
use super::vertex::Vertex;

impl<D: Cell> Raster<'_, D> {
    /// Draws triangles in the order in which they come: bytes, depths and counts are those of
    /// [`triangle`](Self::triangle) called for each. Flat triangles and those in 8.8 are culled and set up 128 at a time,
    /// which is several times as fast where they are small.
    ///
    /// ```
    /// use mode13h::fixed::{I24F8, U8F8};
    /// use mode13h::raster::{Frame, Interpolation, Raster, Vertex};
    ///
    /// let at = |x, y| Vertex::new(I24F8::from(x), I24F8::from(y), U8F8::from(9), 0);
    /// let [a, b, c, d] = [at(0, 0)?, at(8, 0)?, at(8, 4)?, at(0, 4)?];
    /// let mut bytes = [0_u8; 8 * 4];
    /// let drawn = Raster::new(Frame::new(&mut bytes, 8, 4, 8)?)
    ///     .triangles([[a, b, c], [a, c, d]].iter().map(|corners| (corners, Interpolation::Gouraud)));
    /// assert_eq!(drawn.pixels, 32);
    /// assert_eq!(bytes, [9; 32]);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn triangles<'t>(
        &mut self,
        triangles: impl IntoIterator<Item = (&'t [Vertex; 3], Interpolation)>,
    ) -> DrawStats {
        let (mut drawn, mut batch) = (DrawStats::default(), Batch::new());
        for (vertices, interpolation) in triangles {
            if batch.push(vertices, interpolation) {
                continue;
            }
            drawn += self.batch(&batch);
            batch.clear();
            if !batch.push(vertices, interpolation) {
                drawn += self.triangle(vertices, interpolation);
            }
        }
        drawn += self.batch(&batch);
        drawn
    }
}

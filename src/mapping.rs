//! Texture mappings, as named by scenes, renderers and the raster.

use crate::names::named;

named! {
    /// The interpolation of texture coordinates over a face.
    #[derive(Default)]
    pub enum Mapping, "mapping" {
        /// Linear on the screen, which is exact for a face seen straight on.
        #[default]
        Affine = "affine",
        /// Exact at every sixteenth pixel, linear in between.
        Every16 = "every-16",
        /// Exact at every pixel: two divisions each.
        Perspective = "perspective",
    }
}

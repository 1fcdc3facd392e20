//! The mapping of textures, as a scene, a renderer and the raster name it.

use crate::names::named;

named! {
    /// The interpolation of a texture's coordinates over a face.
    #[derive(Default)]
    pub enum Mapping, "mapping" {
        /// Linear on the screen, as for a face that is seen straight on.
        #[default]
        Affine = "affine",
        /// Right at every sixteenth pixel, linear between.
        Every16 = "every-16",
        /// Right at every pixel: two quotients each.
        Perspective = "perspective",
    }
}

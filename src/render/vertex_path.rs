//! The two ways from a mesh to projected vertices.

use crate::names::named;

named! {
    /// A way from a mesh to projected vertices. From there on both are drawn by the same raster.
    #[derive(Default)]
    pub enum VertexPath, "vertex path" {
        /// Vertices in f32.
        #[default]
        Float = "float",
        /// Vertices in 16.16, by [`integer`](crate::integer). The scene's own numbers are floats, so they are
        /// converted: a mesh when it is first seen, angles to the nearest 65,536th of a turn.
        Integer = "fixed",
    }
}

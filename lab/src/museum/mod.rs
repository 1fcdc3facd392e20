//! How it was done: methods of the sources that the engine has replaced, as the books give them.
//!
//! | module | draws |
//! |---|---|
//! | [`polygon`] | convex polygons with the Hungarian tutorial's table of rows |

pub mod polygon;

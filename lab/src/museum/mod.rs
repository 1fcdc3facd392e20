//! How it was done: methods of the sources that the engine has left behind, as they are in the books.
//!
//! | module | draws |
//! |---|---|
//! | [`polygon`] | convex polygons by the Hungarian tutorial's table of rows |

pub mod polygon;

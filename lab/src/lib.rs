//! The laboratory of [mode13h], which measures, checks and explains the engine.
//!
//! | module | holds |
//! |---|---|
//! | [`truth`] | what a picture should be: the scene in f64, slow and plain |
//! | [`cost`] | accuracy against time: the study, its statistics and its report |
//! | [`explain`] | why a pixel has its byte; a row's intensity and slope |
//! | [`museum`] | methods of the sources that the engine has replaced |
//! | [`hard_cases`] | hard cases as pictures: the right way beside the fault |

pub mod cost;
pub mod explain;
pub mod hard_cases;
pub mod lines;
pub mod museum;

pub mod truth;

//! The laboratory: truth, the study, explanations, hard cases, state kept between frames, the parsers' corpora.

mod support;

mod budget;
mod budget_net;
mod explain;
mod fuzz_corpus;
mod hard_cases;
mod light;
mod polygons;
mod report;
mod sources;
mod time;
mod truth;
mod truth_engine;

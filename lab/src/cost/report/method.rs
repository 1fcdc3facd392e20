//! How the figures were measured.

use maud::{Markup, html};

use super::figures::{count, time};
use crate::cost::Study;

/// The machine, the program and the method.
pub(super) fn section(study: &Study) -> Markup {
    let host = &study.host;
    html! {
        section {
            h2 { "How it was measured" }
            dl {
                dt { "input" } dd { (study.input) }
                dt { "processor" } dd { (host.processor) }
                dt { "span kernel" } dd { (study.kernel) }
                dt { "compiler" } dd { (host.compiler) }
                dt { "flags" } dd { (host.flags) }
                dt { "clock" } dd { (host.clock) ", steps of " (time(host.clock_step)) }
                dt { "frames" } dd { (count(study.frames)) " in a round, spread over one turn or the scene’s duration" }
                dt { "rounds" } dd { (count(study.rounds)) ", after a warm-up" }
            }
            p {
                "In every round each shading and each budget draws the same frames, in an order that is shuffled again for each round, so that none is always first or always after the "
                "same one; much slower ones sit out some rounds. One thread draws, and every frame is drawn, even one that shows nothing new. A time is the median over the rounds; "
                "a quarter of the rounds are below the lower quartile, a quarter above the upper. A ratio is the median of the ratios within rounds, and its interval holds "
                "95 % of what resampling the rounds gives (bootstrap). Where it contains 1, the two may well be equal."
            }
            p {
                "All shadings share one path, so set-up is the same work for each: faces are culled, set up and listed as spans by the same code, and they differ in what they do at pixels "
                "and in their planes. Two take a path of their own: gouraud-vintage is drawn triangle by triangle, and gouraud-tessellated splits faces first; phong-table and phong pass "
                "their spans through the stages of effects. Spans are separated from set-up by a frame of the same scene that is twice as wide."
            }
            p {
                "The truth is computed in 64-bit floating point by code that shares nothing with the engine but scene and mesh. Errors are taken where frame and truth show the same triangle; "
                "all other pixels are counted as cover errors. Every time that was taken is in samples.csv."
            }
        }
    }
}

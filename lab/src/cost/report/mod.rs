//! A study as one HTML file that opens without a network, with its charts as SVG.
//!
//! | file | what |
//! |---|---|
//! | `first` | the first screen: two pictures, the ratio of their times, the curve |
//! | `summary` | two sentences |
//! | `text` | the study in a terminal |
//! | `table` | a table, for the page and for a terminal |
//! | `figures` | numbers and ratios as text |
//! | `chart`, `labels` | error against time |
//! | `pictures` | frames and error maps as PNG inside the file |
//! | `page` | the file, section by section |
//! | `shadings`, `budgets`, `times`, `choices`, `method` | the sections |

mod budgets;
mod chart;
mod choices;
mod figures;
mod first;
mod labels;
mod method;
mod page;
mod pictures;
mod shadings;
mod summary;
mod table;
#[cfg(test)]
mod tests;
mod text;
mod times;

pub use chart::chart_svg;
pub use page::html;
pub use summary::summary;
pub use text::text;

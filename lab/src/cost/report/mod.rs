//! A study as one HTML file that opens without a network, its charts as SVG.
//!
//! | file | what |
//! |---|---|
//! | `first` | the first screen: two pictures, how many times the time, the curve |
//! | `summary` | two sentences |
//! | `text` | the study in a terminal |
//! | `table` | a table, for the page and for a terminal |
//! | `figures` | numbers and ratios as text |
//! | `chart`, `budget_chart`, `time_chart`, `labels` | error against time, time against budget, error against a time that is given |
//! | `pictures` | frames and error maps as PNG inside the file |
//! | `page` | the file, section by section |
//! | `shadings`, `budgets`, `times`, `choices`, `method` | the sections |

mod budget_chart;
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
mod time_chart;
mod times;

pub use budget_chart::budget_svg;
pub use chart::chart_svg;
pub use page::html;
pub use summary::summary;
pub use text::text;
pub use time_chart::time_svg;

//! Text broken into lines.

use textwrap::{Options, WordSeparator, WordSplitter};

/// Breaks a text into lines of at most `columns` characters, only at spaces.
#[must_use]
pub fn lines(text: &str, columns: usize) -> Vec<String> {
    let options = Options::new(columns)
        .word_separator(WordSeparator::AsciiSpace)
        .word_splitter(WordSplitter::NoHyphenation)
        .break_words(false);
    textwrap::wrap(text, options).into_iter().map(Into::into).collect()
}

//! Text in lines.

use alloc::string::String;
use alloc::vec::Vec;

use textwrap::{Options, WordSeparator, WordSplitter};

/// A text in lines of at most `columns` letters, broken at spaces alone.
pub(crate) fn lines(text: &str, columns: usize) -> Vec<String> {
    let options = Options::new(columns)
        .word_separator(WordSeparator::AsciiSpace)
        .word_splitter(WordSplitter::NoHyphenation)
        .break_words(false);
    textwrap::wrap(text, options).into_iter().map(Into::into).collect()
}

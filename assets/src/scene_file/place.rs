//! Conversion from bytes of a text to lines, columns and keys.

use core::ops::Range;

use toml::Spanned;
use toml::de::{DeTable, DeValue};

/// A position in a text.
#[derive(Clone, Copy, PartialEq, Eq, Hash, Debug)]
pub struct Place {
    /// The line, counted from 1.
    pub line: usize,
    /// The column in characters, counted from 1.
    pub column: usize,
}

impl Place {
    /// The position of a byte; the end of the text if there is no such byte.
    pub(super) fn of(text: &str, byte: usize) -> Self {
        let mut byte = byte.min(text.len());
        while !text.is_char_boundary(byte) {
            byte -= 1;
        }
        let before = &text[..byte];
        let line_start = before.rfind('\n').map_or(0, |newline| newline + 1);
        // A byte order mark is in no column.
        let column = before[line_start..].trim_start_matches('\u{FEFF}').chars().count() + 1;
        Self { line: before.matches('\n').count() + 1, column }
    }
}

/// The key whose name or value these bytes are part of, with its parents: `objects[0].material.ramp`. `None` if the
/// text is not TOML, or has no key there.
pub(super) fn key_at(text: &str, span: &Range<usize>) -> Option<String> {
    in_table(DeTable::parse(text).ok()?.get_ref(), span, "")
}

/// The maximum number of characters shown of a key. Every known key is shorter.
const LONGEST_KEY: usize = 60;

// The span of a table or list is that of the header that opened it, so several nested ones may have the same span: the
// innermost is the right one. The parser limits the nesting.

fn in_table(table: &DeTable<'_>, span: &Range<usize>, path: &str) -> Option<String> {
    table.iter().find_map(|(key, value)| {
        let dot = if path.is_empty() { "" } else { "." };
        let key_name: String = key.get_ref().chars().take(LONGEST_KEY).collect();
        let path = format!("{path}{dot}{key_name}");
        in_value(value, span, &path).or_else(|| (key.span() == *span).then_some(path))
    })
}

fn in_value(value: &Spanned<DeValue<'_>>, span: &Range<usize>, path: &str) -> Option<String> {
    let inside = match value.get_ref() {
        DeValue::Table(table) => in_table(table, span, path),
        DeValue::Array(list) => {
            list.iter().enumerate().find_map(|(i, value)| in_value(value, span, &format!("{path}[{i}]")))
        }
        _ => None,
    };
    inside.or_else(|| (value.span() == *span).then(|| path.to_string()))
}

//! How errors print: `Debug` prints like `Display`, because a `main` that returns an error prints it with `Debug`. Also
//! how messages of other libraries are quoted.

/// Implements `Debug` as `Display`.
macro_rules! debug_as_display {
    ($Error:ty) => {
        impl core::fmt::Debug for $Error {
            fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
                core::fmt::Display::fmt(self, f)
            }
        }
    };
}

pub(crate) use debug_as_display;

/// The message of another library's error as a clause for our own sentence: its first sentence, on one line and without
/// a full stop at its end. A value printed with its fields is named by the first of these.
pub(crate) fn clause(said: &str) -> String {
    let words: Vec<&str> = said.split_whitespace().collect();
    let line = words.join(" ");
    let mut rest = line.split(". ").next().unwrap_or_default();
    let mut clause = String::new();
    while let Some((before, value)) = rest.split_once(" { ")
        && let Some((fields, after)) = value.split_once(" }")
    {
        clause += &before[..before.rfind(' ').map_or(0, |space| space + 1)];
        let field = fields.split(", ").next().unwrap_or_default();
        clause += field.split_once(": ").map_or(field, |(_, value)| value).trim();
        rest = after;
    }
    clause += rest;
    clause.trim_end_matches(['.', ':', ';', ',', '!', ' ']).into()
}

#[cfg(test)]
mod tests {
    use super::clause;

    #[test]
    fn other_libraries_say_one_clause() {
        for (said, clause_of_it) in [
            ("Invalid PNG signature.", "Invalid PNG signature"),
            ("unexpected end of file", "unexpected end of file"),
            ("Bad value 3. It must be less.\nReally.", "Bad value 3"),
            ("The input is broken:\n  a cause", "The input is broken: a cause"),
            (
                "CRC error: expected 0x1 have 0x2 while decoding ChunkType { type: IDAT, critical: true } chunk.",
                "CRC error: expected 0x1 have 0x2 while decoding IDAT chunk",
            ),
            ("Chunk { type: tEXt } appeared before Chunk { type: IHDR }", "tEXt appeared before IHDR"),
            ("a { that stays open", "a { that stays open"),
            ("1.5 of 2.5 bytes", "1.5 of 2.5 bytes"),
            ("", ""),
        ] {
            assert_eq!(clause(said), clause_of_it);
        }
    }
}

//! Words of text formats.

use std::path::Path;
use std::str::FromStr;

use super::ModelFileErrorKind;

/// The words, up to a comment.
pub(super) fn words(rest: &[u8]) -> impl Iterator<Item = &[u8]> {
    rest.split(u8::is_ascii_whitespace).filter(|word| !word.is_empty()).take_while(|word| word[0] != b'#')
}

/// A name or a path: the rest of the line, which may contain spaces.
pub(super) fn name(rest: &[u8]) -> String {
    String::from_utf8_lossy(rest.trim_ascii()).into_owned()
}

/// The path of a file named in another, relative to its folder. If there is no such file, Windows' separators and comments,
/// which are hardly ever intended as parts of a name, are taken for what they are.
pub(super) fn sibling_path(path: &Path, file: &str) -> String {
    let folder = path.parent().unwrap_or(Path::new(""));
    let slashed = file.replace('\\', "/");
    let uncommented = slashed.split(" #").next().unwrap_or_default().trim_end();
    let found = [file, &slashed, uncommented].into_iter().find(|file| folder.join(file).exists());
    folder.join(found.unwrap_or(&slashed)).to_string_lossy().into_owned()
}

/// Parses a word as a number, which must be finite.
pub(super) fn parsed<T: FromStr + Copy>(word: &[u8], is_finite: fn(T) -> bool) -> Result<T, ModelFileErrorKind> {
    match str::from_utf8(word).ok().and_then(|word| word.parse().ok()) {
        None => Err(ModelFileErrorKind::NotNumber(shown(word))),
        Some(value) if !is_finite(value) => Err(ModelFileErrorKind::NotFinite(shown(word))),
        Some(value) => Ok(value),
    }
}

/// A word as shown in an error: on one line, and short, since words may be a megabyte long.
pub(super) fn shown(word: &[u8]) -> String {
    shortened(word, 40)
}

/// A name or a path as shown in an error or a warning: on one line, with at most the 255 bytes that a file's name may have.
pub(super) fn shown_name(name: &str) -> String {
    shortened(name.as_bytes(), 255)
}

/// The first `most` bytes of a text, on one line, with an ellipsis if there are more.
fn shortened(text: &[u8], most: usize) -> String {
    let begin = String::from_utf8_lossy(&text[..text.len().min(most)]);
    let mut shown = begin.replace(char::is_control, "\u{FFFD}");
    if text.len() > most {
        shown.push('…');
    }
    shown
}

/// The bytes without the byte order mark that some editors put first.
pub(crate) fn without_mark(bytes: &[u8]) -> &[u8] {
    bytes.strip_prefix(b"\xEF\xBB\xBF").unwrap_or(bytes)
}

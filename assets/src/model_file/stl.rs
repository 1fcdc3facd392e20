//! Models from STL files, text and binary.
//!
//! | read | as |
//! |---|---|
//! | the corners of each facet | a face; in a text file it may have more than three |
//! | normals of facets | ignored: the corners determine them, and half the programs write zeros |
//! | corners at the same position, to the bit | one vertex, with −0 as 0 |
//! | names of solids, up to the end of the line or a `facet normal` in it; the header and the attributes of a binary file | ignored; colours there with a warning |
//!
//! A file is binary if its length matches the number of triangles it declares, whatever it begins with, since some
//! binary files begin with `solid`, too. z points up, as is usual in 3-D printing.

use std::collections::HashMap;
use std::path::Path;

use mode13h::scene::UpAxis;

use crate::model_file::lists::{Corner, Lists, Wide, push};
use crate::model_file::tokens::{Tokens, expected};
use crate::model_file::word::without_mark;
use crate::model_file::{Draft, ModelFileError, ModelFileErrorKind, Place};

/// The number of bytes before the triangles of a binary file: 80 arbitrary ones, and the triangle count.
const HEADER: usize = 84;

/// The number of bytes of a triangle: a normal and three corners in f32, and two bytes of attributes.
const TRIANGLE: usize = 50;

/// Returns whether a file is an STL, by its length or its first words.
pub(crate) fn recognizes(bytes: &[u8]) -> bool {
    if has_length_of_binary(bytes) {
        return true;
    }
    let mut words = Tokens::new(bytes, 1);
    if !is(words.next(), &["solid"]) {
        return false;
    }
    skip_name(&mut words);
    is(words.next(), &["facet", "endsolid"])
}

/// Returns whether a word is one of these keywords.
fn is(word: Option<&[u8]>, keywords: &[&str]) -> bool {
    word.is_some_and(|word| keywords.iter().any(|keyword| word.eq_ignore_ascii_case(keyword.as_bytes())))
}

/// Skips the name of a solid, of any number of words: the rest of the line, or all before `facet normal` there.
fn skip_name(words: &mut Tokens<'_>) {
    let line = words.word_line;
    let mut ahead = words.clone();
    while let word @ Some(_) = ahead.next() {
        let begins_facet = is(word, &["facet"]) && is(ahead.clone().next(), &["normal"]);
        if ahead.word_line != line || begins_facet {
            return;
        }
        words.clone_from(&ahead);
    }
}

/// Skips what is between `normal` and the next keyword: three numbers, which may be NaN.
fn skip_normal(words: &mut Tokens<'_>) {
    let mut ahead = words.clone();
    while let word @ Some(_) = ahead.next() {
        if is(word, &["outer", "loop", "vertex", "endloop", "endfacet", "facet", "endsolid", "solid"]) {
            return;
        }
        words.clone_from(&ahead);
    }
}

/// The number of triangles that a binary file declares.
fn announced(bytes: &[u8]) -> Option<u32> {
    bytes.get(HEADER - 4..)?.first_chunk().map(|count| u32::from_le_bytes(*count))
}

fn has_length_of_binary(bytes: &[u8]) -> bool {
    let length = |count| HEADER as u64 + TRIANGLE as u64 * u64::from(count);
    announced(bytes).is_some_and(|count| length(count) == bytes.len() as u64)
}

/// Reads a file.
pub(crate) fn draft(bytes: &[u8], path: &Path) -> Result<Draft, ModelFileError> {
    let text = without_mark(bytes).trim_ascii_start();
    let begins_as_text = text.get(..5).is_some_and(|word| word.eq_ignore_ascii_case(b"solid"));
    // The triangle count of a binary file contains a zero byte, unless it is 2²⁴ or more.
    let is_text = begins_as_text && !bytes[..bytes.len().min(HEADER)].contains(&0);
    let mut draft = Draft { up: Some(UpAxis::Z), ..Draft::default() };
    let mut corners = Merged::default();
    if is_text && !has_length_of_binary(bytes) {
        read_text(bytes, path, &mut draft.lists, &mut corners)?;
    } else {
        read_binary(bytes, path, &mut draft, &mut corners)?;
    }
    Ok(draft)
}

/// The vertices, each once.
#[derive(Default)]
struct Merged {
    known: HashMap<[u64; 3], u32>,
}

impl Merged {
    fn add(&mut self, lists: &mut Lists, position: [f64; 3]) -> Result<(), ModelFileErrorKind> {
        // −0 and 0 are the same position.
        let key = position.map(|c| (c + 0.0).to_bits());
        // Fewer than 2³², see `push`.
        let next = lists.positions.len() as u32;
        let index = *self.known.entry(key).or_insert(next);
        if index == next {
            push(&mut lists.positions, Wide::new(position))?;
        }
        lists.corners.push(Corner { position: index, texcoord: Corner::NONE, normal: Corner::NONE });
        Ok(())
    }
}

fn read_text(bytes: &[u8], path: &Path, lists: &mut Lists, merged: &mut Merged) -> Result<(), ModelFileError> {
    let bytes = without_mark(bytes);
    let mut words = Tokens::new(bytes, 1);
    // The index of the current facet's first corner, and the facet's line.
    let mut facet: Option<(usize, u64)> = None;
    while let Some(word) = words.next() {
        let keyword = word.to_ascii_lowercase();
        let result = match &keyword[..] {
            b"solid" | b"endsolid" => {
                skip_name(&mut words);
                match facet {
                    None => Ok(()),
                    Some(_) => Err(expected("vertex, endloop or endfacet", word)),
                }
            }
            b"facet" if facet.is_none() => {
                facet = Some((lists.corners.len(), words.word_line));
                Ok(())
            }
            b"facet" => Err(expected("vertex, endloop or endfacet", word)),
            b"vertex" if facet.is_some() => vertex(&mut words, lists, merged),
            b"endfacet" => match facet.take() {
                Some((first, line)) => lists.end_face(first, Place::Line(line)),
                None => Err(expected("facet or endsolid", word)),
            },
            b"normal" if facet.is_some() => {
                skip_normal(&mut words);
                Ok(())
            }
            b"outer" | b"loop" | b"endloop" if facet.is_some() => Ok(()),
            _ => Err(expected(if facet.is_some() { "vertex, endloop or endfacet" } else { "facet or endsolid" }, word)),
        };
        result.map_err(|kind| words.error(path, kind))?;
    }
    match facet {
        Some(_) => Err(words.error(path, ModelFileErrorKind::Ends("endfacet"))),
        None => Ok(()),
    }
}

fn vertex(words: &mut Tokens<'_>, lists: &mut Lists, merged: &mut Merged) -> Result<(), ModelFileErrorKind> {
    let mut position = [0.0; 3];
    for coordinate in &mut position {
        *coordinate = words.number("a vertex (3 numbers)")?;
    }
    merged.add(lists, position)
}

fn read_binary(bytes: &[u8], path: &Path, draft: &mut Draft, merged: &mut Merged) -> Result<(), ModelFileError> {
    let at = |offset: usize, kind| ModelFileError::at(path, Place::Offset(offset as u64), kind);
    let Some(count) = announced(bytes) else {
        return Err(at(bytes.len(), ModelFileErrorKind::Ends("the header of a binary STL")));
    };
    let (triangles, behind) = bytes[HEADER..].as_chunks::<TRIANGLE>();
    if (triangles.len() as u64) < u64::from(count) {
        let what = format!("the file ends in triangle {} of {count}", triangles.len() + 1);
        return Err(at(bytes.len(), ModelFileErrorKind::Fault(what)));
    }
    // No more than are present.
    let count = count as usize;
    let mut colored = bytes[..HEADER].windows(6).any(|word| word == b"COLOR=");
    for (i, triangle) in triangles[..count].iter().enumerate() {
        let first = draft.lists.corners.len();
        let offset = HEADER + i * TRIANGLE;
        let (numbers, attributes) = triangle[12..].as_chunks::<4>();
        for (corner, coordinates) in numbers.as_chunks::<3>().0.iter().enumerate() {
            let position = coordinates.map(f32::from_le_bytes);
            if let Some(axis) = position.iter().position(|c| !c.is_finite()) {
                let kind = ModelFileErrorKind::NotFinite(position[axis].to_string());
                return Err(at(offset + 12 + 12 * corner + 4 * axis, kind));
            }
            merged.add(&mut draft.lists, position.map(f64::from)).map_err(|kind| at(offset, kind))?;
        }
        colored |= matches!(attributes, [_, high] if high & 0x80 != 0);
        draft.lists.end_face(first, Place::Offset(offset as u64)).map_err(|kind| at(offset, kind))?;
    }
    let shown = path.display();
    let left = (triangles.len() - count) * TRIANGLE + behind.len();
    if left > 0 {
        draft
            .warnings
            .push(|| format!("{shown}: byte {}: ignored {left} bytes after the triangles", bytes.len() - left));
    }
    if colored {
        draft.warnings.push(|| format!("{shown}: triangle colours left out"));
    }
    Ok(())
}

//! Reading a record: line by line, each field checked where it stands.

use std::io::{self, BufRead, Read};
use std::str::{FromStr, SplitAsciiWhitespace};

use super::{Record, RecordError, RecordErrorKind, VERSION};
use mode13h::fixed::{I24F8, U8F8};
use mode13h::palette::{Palette, Rgb};
use mode13h::raster::{Interpolation, Rect, Vertex};
use mode13h::settings::HiddenSurfaces;

/// No line of a record is longer; what comes of one that is, is not kept.
const LONGEST_LINE: u64 = 1024;

pub(super) fn read(reader: impl BufRead) -> Result<Record, RecordError> {
    let mut lines = Lines::new(reader);
    let result = record(&mut lines);
    result.map_err(|kind| RecordError { line: lines.number, kind })
}

fn record(lines: &mut Lines<impl BufRead>) -> Result<Record, RecordErrorKind> {
    match lines.next() {
        Err(RecordErrorKind::NoText) => return Err(RecordErrorKind::NoRecord),
        other => other?,
    };
    let Some(version) = lines.text.trim().strip_prefix("mode13h record") else {
        return Err(RecordErrorKind::NoRecord);
    };
    if version.trim().parse() != Ok(VERSION) {
        return Err(RecordErrorKind::Version { found: excerpt(version.trim()) });
    }

    lines.need("\"frame\"")?;
    let mut fields = lines.after("frame", "\"frame\"")?;
    let (width, height) = (fields.number("a width")?, fields.number("a height")?);
    fields.end()?;
    let mut record = Record::new(width, height).map_err(RecordErrorKind::Raster)?;

    lines.need("\"background\"")?;
    if lines.begins_with("clip") {
        let mut fields = lines.after("clip", "\"clip\"")?;
        let mut column_or_row = || fields.number("a column or row");
        let (x0, y0, x1, y1) = (column_or_row()?, column_or_row()?, column_or_row()?, column_or_row()?);
        fields.end()?;
        let clip = Rect { x0, y0, x1, y1 };
        if x0 > x1 || y0 > y1 || x1 > width || y1 > height {
            return Err(RecordErrorKind::Clip);
        }
        record = record.with_clip(Some(clip));
        lines.need("\"background\"")?;
    }
    let mut fields = lines.after("background", "\"background\" or \"clip\"")?;
    record.background = fields.number("a palette index")?;
    fields.end()?;

    lines.need("\"hidden-surfaces\"")?;
    let mut fields = lines.after("hidden-surfaces", "\"hidden-surfaces\"")?;
    record.hidden_surfaces = fields.number::<HiddenSurfaces>("a way to leave out hidden surfaces")?;
    fields.end()?;

    lines.need("\"triangles\"")?;
    if lines.begins_with("palette") {
        record.palette = Some(palette(lines)?);
        lines.need("\"triangles\"")?;
    }
    lines.after("triangles", "\"triangles\" or \"palette\"")?.end()?;
    loop {
        lines.need("a triangle or \"end\"")?;
        if lines.begins_with("end") {
            lines.after("end", "\"end\"")?.end()?;
            break;
        }
        let triangle = triangle(&mut lines.fields())?;
        record.triangles.push(triangle);
    }
    if lines.next()? {
        return Err(RecordErrorKind::Expected { expected: "nothing after \"end\"", found: excerpt(lines.text.trim()) });
    }
    Ok(record)
}

fn palette(lines: &mut Lines<impl BufRead>) -> Result<Palette, RecordErrorKind> {
    let mut fields = lines.after("palette", "\"palette\"")?;
    let ramps: u16 = fields.number("a number of ramps")?;
    fields.end()?;
    let line = lines.number;
    let mut colors = [Rgb::BLACK; 256];
    for eight in colors.chunks_mut(8) {
        lines.need("eight colours")?;
        let mut fields = lines.fields();
        for color in eight {
            let hex = fields.next("a colour rrggbb")?;
            *color = match u32::from_str_radix(hex, 16) {
                Ok(rgb) if hex.len() == 6 && !hex.starts_with('+') => Rgb::from(rgb),
                _ => return Err(fields.not("a colour rrggbb")),
            };
        }
        fields.end()?;
    }
    Palette::from_colors(colors).with_ramps(ramps).ok_or_else(|| {
        lines.number = line;
        RecordErrorKind::Ramps { found: ramps }
    })
}

fn triangle(fields: &mut Fields<'_>) -> Result<([Vertex; 3], Interpolation), RecordErrorKind> {
    const SHADINGS: &str = "a shading (\"flat\", \"gouraud-reseeded\" …) or \"end\"";
    let interpolation = match fields.next(SHADINGS)? {
        "flat" => Interpolation::Flat(fields.number("a palette index")?),
        name => *Interpolation::INTERPOLATED
            .iter()
            .find(|interpolation| interpolation.name() == name)
            .ok_or_else(|| fields.not(SHADINGS))?,
    };
    let mut vertices = [Vertex::default(); 3];
    for vertex in &mut vertices {
        let (x, y) = (fields.number("an x in 1/256 pixel")?, fields.number("a y in 1/256 pixel")?);
        let (shade, depth) = (fields.number("a shade in 1/256")?, fields.number("a depth")?);
        *vertex = Vertex::new(I24F8::from_bits(x), I24F8::from_bits(y), U8F8::from_bits(shade), depth)
            .map_err(RecordErrorKind::Raster)?;
    }
    fields.end()?;
    Ok((vertices, interpolation))
}

/// The lines that count.
pub(super) struct Lines<R> {
    reader: R,
    /// The number of the line at hand, from 1.
    number: u64,
    text: String,
}

impl<R: BufRead> Lines<R> {
    pub(super) fn new(reader: R) -> Self {
        Self { reader, number: 0, text: String::new() }
    }

    /// Number of the line, counted from 1.
    pub(super) fn number(&self) -> u64 {
        self.number
    }

    /// The line without blanks before and after it.
    pub(super) fn text(&self) -> &str {
        self.text.trim()
    }

    /// Steps to the next line; `false` if there is none.
    pub(super) fn next(&mut self) -> Result<bool, RecordErrorKind> {
        loop {
            self.number += 1;
            self.text.clear();
            let mut limited = Read::take(&mut self.reader, LONGEST_LINE);
            match limited.read_line(&mut self.text) {
                Ok(0) => return Ok(false),
                Ok(_) if limited.limit() == 0 && !self.text.ends_with('\n') => return Err(RecordErrorKind::NoText),
                Ok(_) => {}
                Err(error) if error.kind() == io::ErrorKind::InvalidData => return Err(RecordErrorKind::NoText),
                Err(error) => return Err(RecordErrorKind::Read(error)),
            }
            let text = self.text.trim();
            if !text.is_empty() && !text.starts_with('#') {
                return Ok(true);
            }
        }
    }

    /// Steps to the next line, which there must be.
    pub(super) fn need(&mut self, expected: &'static str) -> Result<(), RecordErrorKind> {
        if self.next()? { Ok(()) } else { Err(RecordErrorKind::BrokenOff { expected }) }
    }

    fn fields(&self) -> Fields<'_> {
        Fields { rest: self.text.split_ascii_whitespace(), last: "" }
    }

    fn begins_with(&self, word: &str) -> bool {
        self.text.split_ascii_whitespace().next() == Some(word)
    }

    /// Returns the fields after the line's first word, which must be `word`.
    fn after(&self, word: &str, expected: &'static str) -> Result<Fields<'_>, RecordErrorKind> {
        let mut fields = self.fields();
        if fields.next(expected)? == word { Ok(fields) } else { Err(fields.not(expected)) }
    }
}

/// The fields of a line.
struct Fields<'a> {
    rest: SplitAsciiWhitespace<'a>,
    last: &'a str,
}

impl<'a> Fields<'a> {
    fn next(&mut self, expected: &'static str) -> Result<&'a str, RecordErrorKind> {
        self.last = self.rest.next().unwrap_or("");
        if self.last.is_empty() { Err(self.not(expected)) } else { Ok(self.last) }
    }

    /// A number, or whatever else is read from one word.
    fn number<T: FromStr>(&mut self, expected: &'static str) -> Result<T, RecordErrorKind> {
        let word = self.next(expected)?;
        word.parse().map_err(|_| self.not(expected))
    }

    fn end(&mut self) -> Result<(), RecordErrorKind> {
        match self.rest.next() {
            None => Ok(()),
            Some(more) => Err(RecordErrorKind::Expected { expected: "the end of the line", found: excerpt(more) }),
        }
    }

    /// The last field is not what it should be.
    fn not(&self, expected: &'static str) -> RecordErrorKind {
        RecordErrorKind::Expected { expected, found: excerpt(self.last) }
    }
}

/// Excerpt of a line, as far as a person wants to read it.
pub(super) fn excerpt(text: &str) -> String {
    let mut found: String = text.chars().take(32).collect();
    if found.len() < text.len() {
        found.push('…');
    }
    found
}

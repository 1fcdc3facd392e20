//! Models from PLY files, text and binary, little and big endian.
//!
//! | read | as |
//! |---|---|
//! | `x`, `y`, `z` of `vertex` | positions; NaN where no face uses the vertex, as scans have it for missing points |
//! | `nx`, `ny`, `nz` | normals; one of length 0 counts as missing |
//! | `s t`, `u v` or `texture_u texture_v` of `vertex`, or a list `texcoord` of `face` | texture coordinates, if a comment `TextureFile` names the texture; infinite ones and NaN count as 0 |
//! | `texnumber` of `face` | which of several textures, in the order of their comments; without it, the first, with a warning |
//! | a list `vertex_indices` or `vertex_index` of `face` | a face of three corners or more, fewer are dropped with a warning |
//! | a list `vertex_indices` of `tristrips` | triangle strips; a negative index ends one |
//! | `red`, `green`, `blue` of `vertex` or `face` | a colour for each face, up to 256 in all: the mean over its corners |
//! | all other elements and properties | ignored |
//!
//! Colours are numbers up to the greatest of their type, or up to 1 in `float` and `double`. A texture takes precedence
//! over colours, and face colours over vertex colours. Vertex colours are averaged over each face, since triangles have
//! a single colour in this engine; in a scan they are small.

mod header;
mod value;

use std::collections::HashMap;
use std::path::Path;

use mode13h::glam::{Vec2, Vec3};
use mode13h::mesh::Surface;
use mode13h::palette::Rgb;

use crate::model_file::colors::of_faces;
use crate::model_file::lists::{Corner, Lists, Wide, push};
use crate::model_file::word::{sibling_path, without_mark};
use crate::model_file::{Draft, ModelFileError, ModelFileErrorKind, Place, paint};
use header::{Element, Header, Kind};
use value::Values;

/// Returns whether a file begins like a PLY.
pub(crate) fn recognizes(bytes: &[u8]) -> bool {
    let bytes = without_mark(bytes);
    matches!(bytes, [b'p', b'l', b'y', b'\n' | b'\r', ..])
}

/// Reads a file.
pub(crate) fn draft(bytes: &[u8], path: &Path) -> Result<Draft, ModelFileError> {
    let header = Header::read(bytes, path)?;
    let mut draft = Draft::default();
    let mut values = Values::new(&header, bytes);
    let mut reading = Reading::new(&header, path)?;
    for element in &header.elements {
        // An empty row takes no bytes, and a header may announce 2⁶⁴ of them.
        if element.properties.is_empty() {
            continue;
        }
        let result = match element.name.as_str() {
            "vertex" => reading.vertices(element, &mut values, &mut draft.lists),
            "face" => reading.faces(element, &mut values, &mut draft.lists),
            "tristrips" => reading.strips(element, &mut values, &mut draft.lists),
            _ => (0..element.count).try_for_each(|_| values.skip(element)),
        };
        result.map_err(|kind| ModelFileError::at(path, values.place(), kind))?;
    }
    reading.check(&draft.lists).map_err(|(place, kind)| ModelFileError::at(path, place, kind))?;
    reading.finish(&header, path, &mut draft);
    Ok(draft)
}

/// The outcome of reading an element.
type Done = Result<(), ModelFileErrorKind>;

/// Data of the elements in addition to positions, normals and faces.
#[derive(Default)]
struct Reading {
    /// The number of vertices that the header declares.
    vertices: u64,
    /// The vertices without a position, and their places.
    missing: HashMap<u32, Place>,
    /// The colour of each vertex, or empty.
    of_vertices: Vec<Rgb>,
    /// The colour of each face, or empty.
    of_faces: Vec<Rgb>,
    /// True if each vertex has texture coordinates, with the same index.
    has_texcoords: bool,
    /// True if corners of faces have their own texture coordinates.
    has_pairs: bool,
    /// The number of textures.
    textures: usize,
    /// True if faces have the numbers of their textures.
    has_numbers: bool,
}

impl Reading {
    fn new(header: &Header, path: &Path) -> Result<Self, ModelFileError> {
        let vertex = header.elements.iter().find(|element| element.name == "vertex");
        let has_place = vertex.is_some_and(|v| ["x", "y", "z"].iter().all(|axis| v.scalar(&[axis]).is_some()));
        if !has_place {
            let what = "no positions: an element `vertex` needs x, y and z".into();
            return Err(ModelFileError::of_file(path, ModelFileErrorKind::Fault(what)));
        }
        Ok(Self {
            vertices: vertex.map_or(0, |vertex| vertex.count),
            textures: header.textures.len(),
            ..Self::default()
        })
    }

    fn vertices(&mut self, element: &Element, values: &mut Values<'_>, lists: &mut Lists) -> Done {
        let place = ["x", "y", "z"].map(|name| element.scalar(&[name]));
        let normal = ["nx", "ny", "nz"].map(|name| element.scalar(&[name]));
        let colors = element.colors();
        let pair = [["s", "u", "texture_u"], ["t", "v", "texture_v"]].map(|names| element.scalar(&names));
        self.has_texcoords = self.textures > 0 && pair.iter().all(Option::is_some);
        let mut row = Vec::new();
        for _ in 0..element.count {
            values.row(element, &mut row, |_, _| Ok(()))?;
            let position = place.map(|property| property.map_or(0.0, |property| row[property]));
            if let Some(value) = position.iter().find(|value| (**value as f32).is_infinite()) {
                return Err(ModelFileErrorKind::NotFinite(value.to_string()));
            }
            if position.iter().any(|value| value.is_nan()) {
                // Fewer than 2³², see `push`.
                self.missing.insert(lists.positions.len() as u32, values.place());
            }
            push(&mut lists.positions, Wide::new(position))?;
            if let [Some(x), Some(y), Some(z)] = normal {
                // A scan has NaN where no surface was found.
                let normal = Vec3::from_array([x, y, z].map(|axis| row[axis] as f32));
                lists.normals.push(if normal.is_finite() { normal } else { Vec3::ZERO });
            }
            if let Some(colors) = colors {
                self.of_vertices.push(element.color(colors, &row));
            }
            if self.has_texcoords {
                let [u, v] = pair.map(|property| property.map_or(0.0, |property| finite_or_zero(row[property])));
                lists.texcoords.push(Vec2::new(u, v));
            }
        }
        Ok(())
    }

    /// Checks and converts a vertex index.
    fn vertex(&self, index: f64) -> Result<u32, ModelFileErrorKind> {
        if index >= 0.0 && index < self.vertices as f64 && index < f64::from(u32::MAX) && index.fract() == 0.0 {
            return Ok(index as u32);
        }
        match index.fract() == 0.0 && index.abs() < 1e18 {
            true => Err(ModelFileErrorKind::IndexOutOfRange {
                what: "vertex",
                index: index as i64,
                count: usize::try_from(self.vertices).unwrap_or(usize::MAX),
            }),
            false => Err(ModelFileErrorKind::Fault(format!("`{index}` is not a vertex index"))),
        }
    }

    /// The corner at a vertex, with all attributes of the vertex.
    fn corner(&self, vertex: u32, has_normals: bool) -> Corner {
        let or_none = |has: bool| if has { vertex } else { Corner::NONE };
        Corner { position: vertex, texcoord: or_none(self.has_texcoords), normal: or_none(has_normals) }
    }

    fn faces(&mut self, element: &Element, values: &mut Values<'_>, lists: &mut Lists) -> Done {
        let Some(indices) = element.list(&["vertex_indices", "vertex_index"]) else {
            let what = "an element `face` needs a list vertex_indices";
            return Err(ModelFileErrorKind::Fault(what.into()));
        };
        let pairs = element.list(&["texcoord"]).filter(|_| self.textures > 0);
        let texture = element.scalar(&["texnumber"]).filter(|_| self.textures > 1);
        let (colors, has_normals) = (element.colors(), has_normals(lists, self.vertices));
        let (mut row, mut corners, mut texcoords) = (Vec::new(), Vec::new(), Vec::new());
        for _ in 0..element.count {
            corners.clear();
            texcoords.clear();
            let place = values.place_of_next();
            values.row(element, &mut row, |property, value| {
                if property == indices {
                    corners.push(self.corner(self.vertex(value)?, has_normals));
                } else if Some(property) == pairs {
                    texcoords.push(finite_or_zero(value));
                }
                Ok(())
            })?;
            let first = lists.corners.len();
            if pairs.is_some() && texcoords.len() == 2 * corners.len() {
                for (corner, pair) in corners.iter_mut().zip(texcoords.chunks_exact(2)) {
                    // Fewer than 2³², see `push`.
                    corner.texcoord = lists.texcoords.len() as u32;
                    push(&mut lists.texcoords, Vec2::new(pair[0], pair[1]))?;
                }
            }
            lists.corners.extend(&corners);
            let before = lists.sizes.len();
            lists.end_face(first, place)?;
            if let Some(colors) = colors.filter(|_| lists.sizes.len() > before) {
                self.of_faces.push(element.color(colors, &row));
            }
            if let Some(texture) = texture.filter(|_| lists.sizes.len() > before) {
                push(&mut lists.runs, (before, self.surface(row[texture])))?;
            }
        }
        self.has_pairs |= pairs.is_some();
        self.has_numbers |= texture.is_some();
        Ok(())
    }

    /// The surface for a `texnumber`. The last surface, after those of the textures, has no texture.
    fn surface(&self, number: f64) -> usize {
        let is_texture = number >= 0.0 && number < self.textures as f64 && number.fract() == 0.0;
        if is_texture { number as usize } else { self.textures }
    }

    fn strips(&mut self, element: &Element, values: &mut Values<'_>, lists: &mut Lists) -> Done {
        let Some(indices) = element.list(&["vertex_indices", "vertex_index"]) else {
            return (0..element.count).try_for_each(|_| values.skip(element));
        };
        let has_normals = has_normals(lists, self.vertices);
        if self.has_numbers {
            push(&mut lists.runs, (lists.sizes.len(), 0))?;
        }
        let mut row = Vec::new();
        for _ in 0..element.count {
            let place = values.place_of_next();
            // The last two corners, and the number of corners of the strip so far.
            let (mut last, mut length) = ([None; 2], 0_u64);
            values.row(element, &mut row, |property, value| {
                if property != indices {
                    return Ok(());
                }
                if value < 0.0 {
                    (last, length) = ([None; 2], 0);
                    return Ok(());
                }
                let corner = self.corner(self.vertex(value)?, has_normals);
                if let [Some(a), Some(b)] = last {
                    let first = lists.corners.len();
                    lists.corners.extend(if length.is_multiple_of(2) { [a, b, corner] } else { [b, a, corner] });
                    lists.end_face(first, place)?;
                }
                last = [last[1], Some(corner)];
                length += 1;
                Ok(())
            })?;
        }
        Ok(())
    }

    /// Checks that no face has a vertex without a position.
    fn check(&self, lists: &Lists) -> Result<(), (Place, ModelFileErrorKind)> {
        if self.missing.is_empty() {
            return Ok(());
        }
        match lists.corners.iter().find_map(|corner| self.missing.get(&corner.position)) {
            Some(&place) => Err((place, ModelFileErrorKind::NotFinite(f64::NAN.to_string()))),
            None => Ok(()),
        }
    }

    /// Adds the texture, or the colours.
    fn finish(self, header: &Header, path: &Path, draft: &mut Draft) {
        if self.textures > 0 && (self.has_texcoords || self.has_pairs) {
            return self.add_textures(header, path, draft);
        }
        // There is no surface for each texture then.
        draft.lists.runs.clear();
        if let Some((line, _)) = header.textures.first() {
            let shown = path.display();
            draft.warnings.push(|| format!("{shown}:{line}: no texture coordinates; drawn without the texture"));
        }
        let lists = &draft.lists;
        let colors = if self.of_faces.len() == lists.sizes.len() {
            self.of_faces
        } else if self.of_vertices.len() == lists.positions.len() {
            of_faces(lists, &self.of_vertices)
        } else {
            return;
        };
        if !colors.is_empty() {
            let colors: Vec<(usize, Rgb)> = colors.into_iter().enumerate().collect();
            let surface = paint(draft, &colors, format!("{}#colours", path.display()));
            draft.surfaces.push(surface);
        }
    }

    /// Adds a surface for each texture, and one without a texture for faces whose `texnumber` names none.
    fn add_textures(&self, header: &Header, path: &Path, draft: &mut Draft) {
        let with_texture = |(_, name): &(u64, String)| Surface {
            name: name.clone(),
            texture: Some(sibling_path(path, name)),
            ..Surface::default()
        };
        if self.has_numbers {
            draft.surfaces.extend(header.textures.iter().map(with_texture));
            draft.surfaces.push(Surface::default());
            return;
        }
        draft.surfaces.extend(header.textures.first().map(with_texture));
        if let Some((line, _)) = header.textures.first().filter(|_| self.textures > 1) {
            let (shown, count) = (path.display(), self.textures);
            draft
                .warnings
                .push(|| format!("{shown}:{line}: faces have no texnumber; drawn with the first of {count} textures"));
        }
    }
}

/// A texture coordinate.
fn finite_or_zero(value: f64) -> f32 {
    let narrow = value as f32;
    if narrow.is_finite() { narrow } else { 0.0 }
}

/// Returns whether each vertex has a normal. If the vertices follow the faces, the faces have none.
fn has_normals(lists: &Lists, vertices: u64) -> bool {
    !lists.normals.is_empty() && lists.normals.len() as u64 == vertices
}

impl Element {
    /// The properties for red, green and blue.
    fn colors(&self) -> Option<[usize; 3]> {
        let [red, green, blue] =
            [["red", "diffuse_red", "r"], ["green", "diffuse_green", "g"], ["blue", "diffuse_blue", "b"]]
                .map(|names| self.scalar(&names));
        Some([red?, green?, blue?])
    }

    /// The colour of a row.
    fn color(&self, colors: [usize; 3], row: &[f64]) -> Rgb {
        let [r, g, b] = colors.map(|property| {
            let full = match self.properties[property].kind {
                Kind::Scalar(number) => number.full(),
                Kind::List { .. } => 255.0,
            };
            // 0 to 255.5: the cast truncates after 0.5 is added, and turns NaN into 0.
            ((row[property] / full).clamp(0.0, 1.0) * 255.0 + 0.5) as u8
        });
        Rgb::new(r, g, b)
    }
}

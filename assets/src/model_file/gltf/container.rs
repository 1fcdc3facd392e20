//! The two containers: plain JSON, and the binary one with JSON and bytes in chunks.

use std::collections::BTreeSet;
use std::path::Path;

use ::gltf::json::validation::{self, Validate};
use ::gltf::{Document, json};

use crate::errors::clause;
use crate::model_file::word::without_mark;
use crate::model_file::{ModelFileError, ModelFileErrorKind, Place};

/// The extensions without which a mesh would be misread.
const NEEDED: [&str; 3] = ["KHR_draco_mesh_compression", "EXT_meshopt_compression", "KHR_meshopt_compression"];

/// The extensions that are read, or need nothing.
const KNOWN: [&str; 6] = [
    "KHR_lights_punctual",
    "KHR_materials_emissive_strength",
    "KHR_materials_unlit",
    "KHR_mesh_quantization",
    "KHR_texture_transform",
    "KHR_xmp_json_ld",
];

/// The extensions whose loss changes the model even if they are not required.
const MISSED: [&str; 3] = ["EXT_mesh_gpu_instancing", "KHR_materials_pbrSpecularGlossiness", "KHR_node_visibility"];

/// Returns whether a file is a binary container, or JSON with an `asset`.
pub(crate) fn recognizes(bytes: &[u8]) -> bool {
    let is_json = without_mark(bytes).trim_ascii_start().starts_with(b"{");
    bytes.starts_with(b"glTF") || (is_json && bytes.windows(7).any(|word| word == b"\"asset\""))
}

/// A document, the binary chunk if there is one, and the extensions that are ignored but change the model.
type Opened<'b> = (Document, Option<&'b [u8]>, BTreeSet<String>);

/// Opens a file.
pub(super) fn open<'b>(bytes: &'b [u8], path: &Path) -> Result<Opened<'b>, ModelFileError> {
    let (text, start, binary) = match bytes.starts_with(b"glTF") {
        true => chunks(bytes, path)?,
        false => (without_mark(bytes), None, None),
    };
    let mut root = parsed(text).map_err(|error| {
        let kind = ModelFileErrorKind::Fault(format!("not glTF: {}", without_place(&error.to_string())));
        let place = match start {
            // A truncated file ends on its last line, not on one that a final line break would begin.
            None => {
                Place::Line(error.line().min(text.trim_ascii_end().split(|byte| *byte == b'\n').count()).max(1) as u64)
            }
            Some(start) => Place::Offset((start + offset(text, error.line(), error.column())) as u64),
        };
        ModelFileError::at(path, place, kind)
    })?;
    let fault = |what: String| ModelFileError::of_file(path, ModelFileErrorKind::Fault(what));
    if let Some(needed) = root.extensions_required.iter().find(|name| NEEDED.contains(&name.as_str())) {
        return Err(fault(format!("needs {needed}, which is not supported")));
    }
    if root.asset.version.split('.').next() != Some("2") {
        return Err(fault(String::from("only glTF 2 is supported")));
    }
    // `gltf` uses these before it has checked them.
    let positions = json::validation::Checked::Valid(json::mesh::Semantic::Positions);
    for (i, mesh) in root.meshes.iter().enumerate() {
        let mut named = mesh.primitives.iter().filter_map(|primitive| primitive.attributes.get(&positions));
        if named.any(|accessor| accessor.value() >= root.accessors.len()) {
            return Err(fault(format!("meshes[{i}]: its positions do not exist")));
        }
    }
    // It does not check the targets of animations, either.
    for (i, animation) in root.animations.iter_mut().enumerate() {
        let beyond = |channel: &json::animation::Channel| channel.target.node.value() >= root.nodes.len();
        if let Some(channel) = animation.channels.iter().position(beyond) {
            return Err(fault(format!("animations[{i}].channels[{channel}]: its node does not exist")));
        }
        // Properties of extensions.
        animation.channels.retain(|channel| matches!(channel.target.path, json::validation::Checked::Valid(_)));
    }
    // It does not check whether an image has bytes, either. Their type follows from the bytes themselves.
    for (i, image) in root.images.iter_mut().enumerate() {
        if image.buffer_view.is_none() && image.uri.is_none() {
            return Err(fault(format!("images[{i}]: has neither a uri nor a bufferView")));
        }
        image.mime_type.get_or_insert_with(|| json::image::MimeType(String::new()));
    }
    // Whatever other extensions are required, the rest can be drawn.
    let mut ignored = BTreeSet::from_iter(core::mem::take(&mut root.extensions_required));
    ignored.retain(|name| !KNOWN.contains(&name.as_str()));
    ignored.extend(root.extensions_used.iter().filter(|name| MISSED.contains(&name.as_str())).cloned());
    forget_unused(&mut root);
    if let Some((part, what)) = first_fault(&root) {
        // The crate names the field of its own struct.
        let part = part.replace("khrLightsPunctual", "KHR_lights_punctual");
        return Err(fault(format!("{part}: {}", clause(&what.to_string()))));
    }
    Ok((Document::from_json_without_validation(root), binary, ignored))
}

/// Removes what is faulty but never read, so that it makes no file unreadable.
fn forget_unused(root: &mut json::Root) {
    use validation::Checked::{Invalid, Valid};
    for primitive in root.meshes.iter_mut().flat_map(|mesh| &mut mesh.primitives) {
        // Names without an underscore that the specification does not know.
        primitive.attributes.retain(|semantic, _| matches!(semantic, Valid(_)));
    }
    for sampler in &mut root.samplers {
        sampler.mag_filter.take_if(|filter| matches!(filter, Invalid));
        sampler.min_filter.take_if(|filter| matches!(filter, Invalid));
        for wrap in [&mut sampler.wrap_s, &mut sampler.wrap_t] {
            if matches!(wrap, Invalid) {
                *wrap = Valid(json::texture::WrappingMode::default());
            }
        }
    }
    for view in &mut root.buffer_views {
        view.target.take_if(|target| matches!(target, Invalid));
    }
}

/// Parses JSON. `gltf` requires each channel of an animation to name a node, and each scene to list nodes, which the
/// specification does not. Channels without a node, whose target only an extension gives, are left out.
fn parsed(text: &[u8]) -> Result<json::Root, json::Error> {
    let error = match json::Root::from_slice(text) {
        Err(error) if error.to_string().starts_with("missing field `node") => error,
        result => return result,
    };
    let again = || {
        let mut all: json::Value = json::deserialize::from_slice(text).ok()?;
        let no_nodes = || json::Value::Array(Vec::new());
        for scene in all.get_mut("scenes").and_then(json::Value::as_array_mut).into_iter().flatten() {
            scene.as_object_mut()?.entry("nodes").or_insert_with(no_nodes);
        }
        for animation in all.get_mut("animations").and_then(json::Value::as_array_mut).into_iter().flatten() {
            let channels = animation.get_mut("channels").and_then(json::Value::as_array_mut);
            let has_node = |channel: &json::Value| channel.pointer("/target/node").is_some();
            channels.into_iter().for_each(|channels| channels.retain(has_node));
        }
        json::deserialize::from_value(all).ok()
    };
    again().ok_or(error)
}

/// The first part of a file that `gltf` finds faulty, and its fault.
///
/// `gltf` wants every accessor to have a buffer view or sparse values; by the specification an accessor without them is
/// all zeros. A primitive without positions is left out, and the bounds of positions are not read.
fn first_fault(root: &json::Root) -> Option<(String, validation::Error)> {
    let mut first = None;
    root.validate(root, json::Path::new, &mut |path, error| {
        let part = path().to_string();
        let is_zeros = part.starts_with("accessors[") && part.ends_with("].bufferView");
        let is_unplaced = part.ends_with(".attributes[\"POSITION\"]");
        let is_bound = [".min", ".max"].iter().any(|end| part.ends_with(&format!(".attributes[\"POSITION\"]{end}")));
        if !(is_bound || (is_zeros || is_unplaced) && error == validation::Error::Missing) {
            first.get_or_insert((part, error));
        }
    });
    first
}

/// The JSON of a binary file, the offset where it begins, and the binary chunk.
type Chunks<'b> = (&'b [u8], Option<usize>, Option<&'b [u8]>);

fn chunks<'b>(bytes: &'b [u8], path: &Path) -> Result<Chunks<'b>, ModelFileError> {
    let at = |offset: usize, kind| ModelFileError::at(path, Place::Offset(offset as u64), kind);
    let ends = |what| at(bytes.len(), ModelFileErrorKind::Ends(what));
    let word = |offset: usize| bytes.get(offset..)?.first_chunk().map(|word| u32::from_le_bytes(*word));
    let version = word(4).ok_or_else(|| ends("the header of a glb"))?;
    if version != 2 {
        return Err(at(4, ModelFileErrorKind::Fault(format!("only glTF 2 is supported, this is {version}"))));
    }
    let chunk = |offset: usize, what: &'static str| -> Result<(&'b [u8], u32), ModelFileError> {
        let (Some(length), Some(kind)) = (word(offset), word(offset + 4)) else { return Err(ends(what)) };
        let body = &bytes[offset + 8..];
        usize::try_from(length)
            .ok()
            .and_then(|length| body.get(..length))
            .map(|body| (body, kind))
            .ok_or_else(|| ends(what))
    };
    const JSON: u32 = u32::from_le_bytes(*b"JSON");
    const BINARY: u32 = u32::from_le_bytes(*b"BIN\0");
    const FIRST: usize = 12;
    let (text, kind) = chunk(FIRST, "a JSON chunk")?;
    if kind != JSON {
        return Err(at(FIRST + 4, ModelFileErrorKind::Fault("the first chunk is not JSON".into())));
    }
    let next = FIRST + 8 + text.len();
    // What is behind the container is not a chunk.
    let length = word(8).and_then(|length| usize::try_from(length).ok()).filter(|length| *length >= next);
    let binary = match next < length.unwrap_or(bytes.len()).min(bytes.len()) {
        true => Some(chunk(next, "a binary chunk")?).filter(|(_, kind)| *kind == BINARY).map(|(bytes, _)| bytes),
        false => None,
    };
    Ok((text, Some(FIRST + 8), binary))
}

/// The offset of a line and a column, both counted from 1.
fn offset(text: &[u8], line: usize, column: usize) -> usize {
    let before: usize = text.split(|byte| *byte == b'\n').take(line.saturating_sub(1)).map(|line| line.len() + 1).sum();
    (before + column.saturating_sub(1)).min(text.len())
}

/// A message of the JSON parser without the position at its end, which our error already gives; on one line, and not
/// too long.
fn without_place(message: &str) -> String {
    let end = message.rfind(" at line ").unwrap_or(message.len());
    let line: String = message[..end].chars().map(|c| if c.is_control() { ' ' } else { c }).collect();
    line.chars().take(200).collect()
}

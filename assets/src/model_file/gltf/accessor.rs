//! Buffers, and the numbers in them.

use core::ops::Range;
use std::collections::HashMap;
use std::io;
use std::path::Path;
use std::rc::Rc;

use ::gltf::accessor::{DataType, sparse};
use ::gltf::buffer::{self, Source};
use ::gltf::{Accessor, Document};
use base64::Engine;
use base64::engine::general_purpose::GeneralPurpose;
use base64::engine::{DecodePaddingMode, GeneralPurposeConfig};

use crate::model_file::word::shown_name;

/// An image used by the file.
enum Image {
    /// The bytes of a picture file.
    Bytes(Vec<u8>),
    /// The buffer that contains a picture file, and where.
    Part(usize, Range<usize>),
    /// The path of a picture file.
    File(String),
}

/// The bytes of all buffers, and of the images outside them.
pub(super) struct Buffers {
    /// Many may share the bytes of one file or chunk.
    buffers: Vec<Rc<[u8]>>,
    images: Vec<Image>,
}

/// The maximum number of rows of an accessor without a buffer view: all zeros, so a short file may ask for any number.
const MAX_ZEROS: usize = 1 << 20;

impl Buffers {
    /// Reads all buffers and images.
    pub(super) fn read(
        document: &Document,
        binary: Option<&[u8]>,
        path: &Path,
        mut file: impl FnMut(&Path) -> io::Result<Vec<u8>>,
    ) -> Result<Self, String> {
        let folder = path.parent().unwrap_or(Path::new(""));
        let binary: Option<Rc<[u8]>> = binary.map(Rc::from);
        let (mut buffers, mut files) = (Vec::new(), HashMap::new());
        for buffer in document.buffers() {
            let part = format!("buffers[{}]", buffer.index());
            let bytes = match buffer.source() {
                Source::Bin => binary.clone().ok_or_else(|| format!("{part}: the file has no binary chunk"))?,
                Source::Uri(uri) => match data(uri) {
                    Some(bytes) => bytes.map_err(|what| format!("{part}: {what}"))?.into(),
                    None => {
                        let name = decoded(uri);
                        let shown = || folder.join(shown_name(&name));
                        if !files.contains_key(&name) {
                            let bytes = file(&folder.join(&name));
                            let bytes = bytes.map_err(|error| format!("{part}: {}: {error}", shown().display()))?;
                            files.insert(name.clone(), Rc::from(bytes));
                        }
                        Rc::clone(&files[&name])
                    }
                },
            };
            if bytes.len() < buffer.length() {
                return Err(format!("{part}: {} bytes, but byteLength is {}", bytes.len(), buffer.length()));
            }
            buffers.push(bytes);
        }
        let mut own = Self { buffers, images: Vec::new() };
        for image in document.images() {
            let image = match image.source() {
                ::gltf::image::Source::View { view, .. } => match own.view(&view) {
                    Ok(bytes) => Image::Part(view.buffer().index(), view.offset()..view.offset() + bytes.len()),
                    Err(what) => return Err(format!("images[{}]: {what}", image.index())),
                },
                ::gltf::image::Source::Uri { uri, .. } => match data(uri) {
                    Some(Ok(bytes)) => Image::Bytes(bytes),
                    Some(Err(what)) => return Err(format!("images[{}]: {what}", image.index())),
                    None => Image::File(folder.join(decoded(uri)).to_string_lossy().into_owned()),
                },
            };
            own.images.push(image);
        }
        Ok(own)
    }

    /// The picture file of an image: its bytes, or its path.
    pub(super) fn image(&self, index: usize) -> Option<Result<&[u8], &str>> {
        Some(match self.images.get(index)? {
            Image::Bytes(bytes) => Ok(bytes),
            Image::Part(buffer, part) => Ok(self.buffers.get(*buffer)?.get(part.clone())?),
            Image::File(path) => Err(path),
        })
    }

    fn view(&self, view: &buffer::View<'_>) -> Result<&[u8], String> {
        let bytes = self.buffers.get(view.buffer().index()).map(|bytes| &**bytes).unwrap_or_default();
        let end = view.offset().checked_add(view.length());
        end.and_then(|end| bytes.get(view.offset()..end))
            .ok_or_else(|| format!("bufferViews[{}] ends beyond its buffer", view.index()))
    }

    /// The rows of an accessor, the first `N` numbers of each.
    pub(super) fn rows<const N: usize>(&self, accessor: &Accessor<'_>) -> Result<Vec<[f64; N]>, String> {
        self.picked(accessor, None)
    }

    /// The rows of an accessor at these indices, which must be below its count.
    pub(super) fn rows_at<const N: usize>(&self, accessor: &Accessor<'_>, at: &[u32]) -> Result<Vec<[f64; N]>, String> {
        self.picked(accessor, Some(at))
    }

    /// The rows of an accessor: all of them, or those at some indices.
    fn picked<const N: usize>(&self, accessor: &Accessor<'_>, at: Option<&[u32]>) -> Result<Vec<[f64; N]>, String> {
        let part = format!("accessors[{}]", accessor.index());
        if accessor.dimensions().multiplicity() < N {
            return Err(format!("{part} has fewer than {N} components"));
        }
        let (kind, size) = (accessor.data_type(), accessor.size());
        let row = |bytes: &[u8]| row::<N>(bytes, kind, accessor.normalized());
        let mut rows: Vec<[f64; N]> = match accessor.view() {
            Some(view) => {
                let bytes = self.view(&view)?;
                let slice = slices(bytes, accessor.offset(), view.stride(), size, accessor.count());
                let slice = slice.ok_or_else(|| format!("{part} ends beyond bufferViews[{}]", view.index()))?;
                match at {
                    Some(at) => at.iter().map(|&index| row(slice(index as usize))).collect(),
                    None => (0..accessor.count()).map(|index| row(slice(index))).collect(),
                }
            }
            None if accessor.count() > MAX_ZEROS => {
                return Err(format!("{part}: more than 1,048,576 elements without a bufferView"));
            }
            // The allocator gives zeros that take no memory until they are used.
            None => vec![[0.0; N]; at.map_or(accessor.count(), <[u32]>::len)],
        };
        if let Some(sparse) = accessor.sparse() {
            let beyond = || format!("{part}.sparse ends beyond its bufferView");
            let (indices, values) = (sparse.indices(), sparse.values());
            let (kind, width) = match indices.index_type() {
                sparse::IndexType::U8 => (DataType::U8, 1),
                sparse::IndexType::U16 => (DataType::U16, 2),
                sparse::IndexType::U32 => (DataType::U32, 4),
            };
            let view = indices.view();
            let bytes = self.view(&view)?;
            let index = slices(bytes, indices.offset(), view.stride(), width, sparse.count()).ok_or_else(beyond)?;
            let view = values.view();
            let bytes = self.view(&view)?;
            let value = slices(bytes, values.offset(), view.stride(), size, sparse.count()).ok_or_else(beyond)?;
            let mut replaced = HashMap::new();
            for i in 0..sparse.count() {
                let [index] = self::row::<1>(index(i), kind, false);
                if index as usize >= accessor.count() {
                    return Err(format!("{part}.sparse: there is no element {index}"));
                }
                replaced.insert(index as u32, i);
            }
            for (place, to) in rows.iter_mut().enumerate() {
                // Fewer than 2³², as indices have 32 bits.
                let index = at.map_or(place as u32, |at| at[place]);
                if let Some(&i) = replaced.get(&index) {
                    *to = row(value(i));
                }
            }
        }
        Ok(rows)
    }

    /// The integers of an accessor.
    pub(super) fn read_indices(&self, accessor: &Accessor<'_>) -> Result<Vec<u32>, String> {
        if !matches!(accessor.data_type(), DataType::U8 | DataType::U16 | DataType::U32) || accessor.normalized() {
            return Err(format!("accessors[{}] does not hold indices", accessor.index()));
        }
        Ok(self.rows::<1>(accessor)?.into_iter().map(|[index]| index as u32).collect())
    }
}

/// Gives each of `count` slices of `size` bytes, `stride` apart, or one after another; `None` if they end beyond
/// `bytes`.
fn slices<'a>(
    bytes: &'a [u8],
    offset: usize,
    stride: Option<usize>,
    size: usize,
    count: usize,
) -> Option<impl Fn(usize) -> &'a [u8]> {
    let stride = stride.filter(|stride| *stride > 0).unwrap_or(size);
    let last = count.checked_sub(1).map_or(Some(0), |last| last.checked_mul(stride)?.checked_add(size));
    let end = last?.checked_add(offset)?;
    let bytes = bytes.get(offset.min(bytes.len())..).filter(|_| end <= bytes.len())?;
    Some(move |i| &bytes[i * stride..][..size])
}

/// The first `N` numbers of a row, which must have at least that many.
fn row<const N: usize>(bytes: &[u8], kind: DataType, normalized: bool) -> [f64; N] {
    core::array::from_fn(|i| {
        fn own<const B: usize>(bytes: &[u8], i: usize) -> [u8; B] {
            bytes.as_chunks().0.get(i).copied().unwrap_or([0; B])
        }
        let (value, full): (f64, f64) = match kind {
            DataType::I8 => (i8::from_le_bytes(own(bytes, i)).into(), i8::MAX.into()),
            DataType::U8 => (u8::from_le_bytes(own(bytes, i)).into(), u8::MAX.into()),
            DataType::I16 => (i16::from_le_bytes(own(bytes, i)).into(), i16::MAX.into()),
            DataType::U16 => (u16::from_le_bytes(own(bytes, i)).into(), u16::MAX.into()),
            DataType::U32 => (u32::from_le_bytes(own(bytes, i)).into(), u32::MAX.into()),
            DataType::F32 => (f32::from_le_bytes(own(bytes, i)).into(), 1.0),
        };
        if normalized { (value / full).max(-1.0) } else { value }
    })
}

/// The bytes of a data URI; `None` for any other URI.
fn data(uri: &str) -> Option<Result<Vec<u8>, String>> {
    let Some((head, body)) = uri.strip_prefix("data:")?.split_once(',') else {
        return Some(Err(String::from("a data URI without a comma")));
    };
    if !head.ends_with(";base64") {
        return Some(Ok(decoded_bytes(body)));
    }
    const BASE64: GeneralPurpose = GeneralPurpose::new(
        &base64::alphabet::STANDARD,
        // As browsers decode it.
        GeneralPurposeConfig::new()
            .with_decode_padding_mode(DecodePaddingMode::Indifferent)
            .with_decode_allow_trailing_bits(true),
    );
    Some(BASE64.decode(decoded_bytes(body)).map_err(|_| String::from("invalid base64")))
}

/// A URI's path with percent escapes such as `%20` decoded.
fn decoded(uri: &str) -> String {
    String::from_utf8_lossy(&decoded_bytes(uri)).into_owned()
}

fn decoded_bytes(uri: &str) -> Vec<u8> {
    let mut bytes = Vec::with_capacity(uri.len());
    let mut rest = uri.as_bytes();
    while let [first, behind @ ..] = rest {
        let digits = behind.get(..2).filter(|_| *first == b'%').and_then(|digits| str::from_utf8(digits).ok());
        match digits.and_then(|digits| u8::from_str_radix(digits, 16).ok()) {
            Some(byte) => {
                bytes.push(byte);
                rest = &behind[2..];
            }
            None => {
                bytes.push(*first);
                rest = behind;
            }
        }
    }
    bytes
}

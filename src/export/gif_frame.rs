//! A frame of a film, made ready to be written: cropped to what it changes, enlarged and compressed.

use gif::Frame;

use super::scale::Scaled;
use super::{Picture, PictureError, PixelShape, Scale};
use crate::palette::Rgb;

/// A frame of a [film](super::GifWriter) and what of it is written. It is made from the frame and the one before it alone,
/// so several can be made at a time, on any threads, and then be [added](super::GifWriter::add_frame) in their order.
///
/// ```
/// use mode13h::export::{FrameRate, GifFrame, GifWriter, Picture, Scale};
/// use mode13h::palette::builtin::GREY;
///
/// let (dark, light) = ([0; 64_000], [255; 64_000]);
/// let (dark, light) = (Picture::mode_13h(&dark, &GREY), Picture::mode_13h(&light, &GREY));
/// let second = GifFrame::after(&dark, &light, Scale::One, GREY.colors())?; // before the first, or at the same time
/// let first = GifFrame::first(&dark, Scale::One)?;
/// let mut film = GifWriter::new(Vec::new(), Scale::One, FrameRate::default());
/// film.add_frame(first)?;
/// film.add_frame(second)?;
/// assert_eq!(film.finish()?.1.images, 2);
/// # Ok::<(), mode13h::export::GifError>(())
/// ```
pub struct GifFrame {
    /// As they were given, without gaps between the rows.
    pixels: Vec<u8>,
    width: usize,
    height: usize,
    palette: Box<[Rgb; 256]>,
    /// Of the film.
    size: (u16, u16),
    /// Nothing where it changes nothing.
    image: Option<Image>,
}

/// What is written of a frame.
pub(super) struct Image {
    pub(super) area: Area,
    /// A palette of its own, where it shows a colour that the film's has otherwise.
    pub(super) palette: Option<Vec<u8>>,
    /// Its palette indices, row by row, compressed.
    pub(super) data: Vec<u8>,
}

impl GifFrame {
    /// The first frame of a film: all of it is written, and its colours are the film's.
    ///
    /// # Errors
    ///
    /// Sizes that do not fit the bytes, or are too large when enlarged; no memory.
    pub fn first(picture: &Picture<'_>, scale: Scale) -> Result<GifFrame, PictureError> {
        let scaled = Scaled::new(picture, scale)?;
        let image = Image::new(&scaled, Area::whole(&scaled), picture.palette)?;
        GifFrame::new(&scaled, Some(image))
    }

    /// A frame that follows `before`: what it shows otherwise is written. `film`: the colours of the first frame.
    ///
    /// # Errors
    ///
    /// As [`first`](Self::first); another size than that of `before`.
    pub fn after(
        before: &Picture<'_>,
        picture: &Picture<'_>,
        scale: Scale,
        film: &[Rgb; 256],
    ) -> Result<GifFrame, PictureError> {
        before.check()?;
        let scaled = Scaled::new(picture, scale)?;
        let image = changed(before, &scaled)?.map(|area| Image::new(&scaled, area, film)).transpose()?;
        GifFrame::new(&scaled, image)
    }

    fn new(scaled: &Scaled<'_>, image: Option<Image>) -> Result<GifFrame, PictureError> {
        let (picture, ..) = scaled.sources();
        let &Picture { width, height, palette, .. } = picture;
        // The picture has been checked: so many are there.
        let bytes = width * height;
        let mut pixels = Vec::new();
        pixels.try_reserve_exact(bytes).map_err(|_| PictureError::Memory { bytes })?;
        (0..height).for_each(|y| pixels.extend_from_slice(picture.row(y)));
        // All sides are at most MAX_SIDE, 16,384.
        let size = (scaled.width as u16, scaled.height as u16);
        Ok(GifFrame { pixels, width, height, palette: Box::new(*palette), size, image })
    }

    /// What it shows.
    pub(super) fn picture(&self) -> Picture<'_> {
        let GifFrame { pixels, width, height, palette, .. } = self;
        Picture { pixels, width: *width, height: *height, pitch: *width, palette, shape: PixelShape::SQUARE }
    }

    pub(super) fn palette(&self) -> &[Rgb; 256] {
        &self.palette
    }

    /// Of the film, in pixels.
    pub(super) fn size(&self) -> (u16, u16) {
        self.size
    }

    /// Whether it shows anything otherwise than the frame before it.
    pub(super) fn changes(&self) -> bool {
        self.image.is_some()
    }

    /// Whether all of it is written.
    pub(super) fn is_whole(&self) -> bool {
        let all = |area: Area| (area.right - area.left, area.bottom - area.top);
        let size = (usize::from(self.size.0), usize::from(self.size.1));
        self.image.as_ref().is_some_and(|image| all(image.area) == size)
    }

    pub(super) fn into_image(self) -> Option<Image> {
        self.image
    }

    /// Its first pixel, for a frame that changes nothing and yet must be written.
    pub(super) fn first_pixel(&self, scale: Scale, film: &[Rgb; 256]) -> Result<Image, PictureError> {
        Image::new(&Scaled::new(&self.picture(), scale)?, Area::FIRST_PIXEL, film)
    }
}

impl Image {
    fn new(scaled: &Scaled<'_>, area: Area, film: &[Rgb; 256]) -> Result<Image, PictureError> {
        let part = scaled.part(area.left..area.right, area.top..area.bottom)?;
        let palette = scaled.sources().0.palette;
        let own = shows_otherwise(&part, palette, film).then(|| table(palette));
        // The compressor asks for this much at first, and for an image larger than memory says so by a panic.
        let bytes = part.len() / 2;
        Vec::<u8>::new().try_reserve_exact(bytes).map_err(|_| PictureError::Memory { bytes })?;
        let mut frame = Frame { buffer: part.into(), ..Frame::default() };
        frame.make_lzw_pre_encoded();
        Ok(Image { area, palette: own, data: frame.buffer.into_owned() })
    }
}

/// Whether any of these pixels has another colour in one palette than in the other.
fn shows_otherwise(pixels: &[u8], palette: &[Rgb; 256], other: &[Rgb; 256]) -> bool {
    palette != other && pixels.iter().any(|&pixel| palette[usize::from(pixel)] != other[usize::from(pixel)])
}

/// A colour table of GIF: red, green and blue of each entry.
pub(super) fn table(palette: &[Rgb; 256]) -> Vec<u8> {
    palette.iter().flat_map(|color| [color.r, color.g, color.b]).collect()
}

/// A rectangle of the film, in its pixels: from `left` and `top` to before `right` and `bottom`.
#[derive(Clone, Copy)]
pub(super) struct Area {
    pub(super) left: usize,
    pub(super) top: usize,
    pub(super) right: usize,
    pub(super) bottom: usize,
}

impl Area {
    const FIRST_PIXEL: Area = Area { left: 0, top: 0, right: 1, bottom: 1 };

    fn whole(scaled: &Scaled<'_>) -> Area {
        Area { left: 0, top: 0, right: scaled.width as usize, bottom: scaled.height as usize }
    }

    /// The least that holds this one, if there is one, and a row from `left` to before `right`.
    fn with_row(area: Option<Area>, y: usize, left: usize, right: usize) -> Area {
        match area {
            Some(area) => {
                Area { left: area.left.min(left), top: area.top, right: area.right.max(right), bottom: y + 1 }
            }
            None => Area { left, top: y, right, bottom: y + 1 },
        }
    }
}

/// What the frame `now` shows otherwise than `before`: the least rectangle with all pixels that it shows in another colour,
/// whether the index or the palette is the reason; nothing if there is none. An index that stands for the same
/// colour as before changes nothing.
fn changed(before: &Picture<'_>, now: &Scaled<'_>) -> Result<Option<Area>, PictureError> {
    let (picture, columns, rows) = now.sources();
    let (first, size) = ((before.width, before.height), (picture.width, picture.height));
    if first != size {
        return Err(PictureError::OtherSize { first, now: size });
    }
    let same_palette = before.palette == picture.palette;
    let changed = |y: usize| {
        let (old, new) = (before.row(y), picture.row(y));
        if same_palette && old == new {
            return None;
        }
        let differs = |&x: &usize| before.palette[usize::from(old[x])] != picture.palette[usize::from(new[x])];
        let left = columns.iter().position(differs)?;
        let right = columns.iter().rposition(differs)? + 1;
        Some((left, right))
    };
    let mut area = None;
    // Rows of the film that are one row of the frame are compared once.
    let mut last = None;
    for (y, &row) in rows.iter().enumerate() {
        let ends = match last {
            Some((of, ends)) if of == row => ends,
            _ => changed(row),
        };
        last = Some((row, ends));
        if let Some((left, right)) = ends {
            area = Some(Area::with_row(area, y, left, right));
        }
    }
    Ok(area)
}

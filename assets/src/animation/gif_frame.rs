//! Frames of GIF animations, prepared for writing: cropped to what they change, enlarged and compressed.

use gif::Frame;
use mode13h::export::Scaled;
use mode13h::export::{Picture, PictureError, PixelShape, Scale};
use mode13h::palette::Rgb;

use super::AnimationError;
use super::color_table::ColorTable;
use super::difference::{Area, changed, kept};

/// A frame of an [animation](super::GifWriter) and its compressed image. It depends only on the frame and the one
/// before it, so several can be made at a time, on any threads, and then [added](super::GifWriter::add_frame) in order.
///
/// ```
/// use mode13h::export::{Picture, Scale};
/// use mode13h_assets::animation::{FrameRate, GifFrame, GifWriter};
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
/// # Ok::<(), mode13h_assets::animation::AnimationError>(())
/// ```
pub struct GifFrame {
    /// The given pixels, without gaps between the rows.
    pixels: Vec<u8>,
    width: usize,
    height: usize,
    palette: Box<[Rgb; 256]>,
    /// The animation's size in pixels: width and height.
    size: (u16, u16),
    /// The image to write; `None` if the frame changes nothing.
    image: Option<Image>,
}

/// The image written for a frame.
pub(super) struct Image {
    pub(super) area: Area,
    /// A palette of its own, if it shows a colour that the animation's palette lacks.
    pub(super) palette: Option<Vec<u8>>,
    /// The index of unchanged pixels.
    pub(super) transparent: Option<u8>,
    /// Its colour table indices, row by row, compressed.
    pub(super) data: Vec<u8>,
}

impl GifFrame {
    /// Makes the first frame of an animation: all of it is written, and its colours are the animation's.
    ///
    /// # Errors
    ///
    /// Sizes that do not fit the bytes, or are too large when enlarged; not enough memory.
    pub fn first(picture: &Picture<'_>, scale: Scale) -> Result<GifFrame, AnimationError> {
        let scaled = Scaled::new(picture, scale)?;
        let image = Image::new(None, &scaled, Area::whole(&scaled), picture.palette)?;
        GifFrame::new(&scaled, Some(image))
    }

    /// Makes a frame that follows `before`: only the differences are written. `film` has the colours of the first
    /// frame.
    ///
    /// # Errors
    ///
    /// Those of [`first`](Self::first); another size than that of `before`.
    pub fn after(
        before: &Picture<'_>,
        picture: &Picture<'_>,
        scale: Scale,
        film: &[Rgb; 256],
    ) -> Result<GifFrame, AnimationError> {
        before.check()?;
        let scaled = Scaled::new(picture, scale)?;
        let image = match changed(before, &scaled)? {
            Some(area) => Some(Image::new(Some(&Scaled::new(before, scale)?), &scaled, area, film)?),
            None => None,
        };
        GifFrame::new(&scaled, image)
    }

    fn new(scaled: &Scaled<'_>, image: Option<Image>) -> Result<GifFrame, AnimationError> {
        let (picture, ..) = scaled.sources();
        let &Picture { width, height, palette, .. } = picture;
        // The picture has been checked, so it has this many.
        let bytes = width * height;
        let mut pixels = Vec::new();
        pixels.try_reserve_exact(bytes).map_err(|_| PictureError::Memory { bytes })?;
        (0..height).for_each(|y| pixels.extend_from_slice(picture.row(y)));
        // All sides are at most MAX_SIDE, 16,384.
        let size = (scaled.width as u16, scaled.height as u16);
        Ok(GifFrame { pixels, width, height, palette: Box::new(*palette), size, image })
    }

    /// The frame as a picture.
    pub(super) fn picture(&self) -> Picture<'_> {
        let GifFrame { pixels, width, height, palette, .. } = self;
        Picture { pixels, width: *width, height: *height, pitch: *width, palette, shape: PixelShape::default() }
    }

    pub(super) fn palette(&self) -> &[Rgb; 256] {
        &self.palette
    }

    /// The animation's size in pixels: width and height.
    pub(super) fn size(&self) -> (u16, u16) {
        self.size
    }

    /// Returns whether the frame differs from the one before it.
    pub(super) fn changes(&self) -> bool {
        self.image.is_some()
    }

    /// Returns whether all of it is written, regardless of the frame before it.
    pub(super) fn is_whole(&self) -> bool {
        let pixels = usize::from(self.size.0) * usize::from(self.size.1);
        self.image.as_ref().is_some_and(|image| image.area.pixels() == pixels && image.transparent.is_none())
    }

    pub(super) fn into_image(self) -> Option<Image> {
        self.image
    }

    /// Its first pixel, for a frame that changes nothing but has to be written.
    pub(super) fn first_pixel(&self, scale: Scale, film: &[Rgb; 256]) -> Result<Image, PictureError> {
        Image::new(None, &Scaled::new(&self.picture(), scale)?, Area::FIRST_PIXEL, film)
    }
}

/// The minimum length of a run of unchanged pixels that become transparent. Shorter runs would break up the pixels
/// around them, which costs more than it saves: on the torus 16 gave smaller files than 1, 4, 8 and 32.
const TRANSPARENT_RUN: usize = 16;

impl Image {
    /// A part of a frame, compressed as it is and, if there is a frame before it, with transparent pixels; whichever
    /// is shorter.
    fn new(
        before: Option<&Scaled<'_>>,
        scaled: &Scaled<'_>,
        area: Area,
        film: &[Rgb; 256],
    ) -> Result<Image, PictureError> {
        let (columns, rows) = (area.left..area.right, area.top..area.bottom);
        let mut indices = scaled.part(columns.clone(), rows.clone())?;
        let picture = scaled.sources().0;
        let kept: Option<Vec<bool>> = match before {
            None => None,
            Some(before) => {
                let was = before.part(columns.clone(), rows)?;
                let mut all = Vec::new();
                all.try_reserve_exact(was.len()).map_err(|_| PictureError::Memory { bytes: was.len() })?;
                all.extend(kept(before.sources().0, &was, picture, &indices));
                Some(all)
            }
        };
        let film = ColorTable::of_all(film);
        let (own, places) = match film.places(picture.palette, &indices) {
            Some(places) => (None, places),
            None => {
                let own = ColorTable::of_used(picture.palette, &indices);
                // The table contains every colour in use.
                let places = own.places(picture.palette, &indices).unwrap_or([0; 256]);
                (Some(own), places)
            }
        };
        indices.iter_mut().for_each(|index| *index = places[usize::from(*index)]);
        let table = own.as_ref().unwrap_or(&film);
        let mut image = Image { area, palette: None, transparent: None, data: compressed(&indices)? };
        if let (Some(kept), Some(free)) = (kept, table.free(&indices))
            && leave_out(&mut indices, &kept, columns.len(), free)
        {
            let data = compressed(&indices)?;
            if data.len() < image.data.len() {
                (image.data, image.transparent) = (data, Some(free));
            }
        }
        image.palette = own.map(|own| own.bytes());
        Ok(image)
    }
}

/// Makes long runs of unchanged pixels transparent. Returns whether there are any.
fn leave_out(indices: &mut [u8], kept: &[bool], width: usize, transparent: u8) -> bool {
    let mut any = false;
    for (indices, kept) in indices.chunks_mut(width).zip(kept.chunks(width)) {
        let mut rest = indices;
        for run in kept.chunk_by(|a, b| a == b) {
            let (of_run, behind) = std::mem::take(&mut rest).split_at_mut(run.len());
            if run[0] && run.len() >= TRANSPARENT_RUN {
                of_run.fill(transparent);
                any = true;
            }
            rest = behind;
        }
    }
    any
}

/// Compresses indices as in GIF.
fn compressed(indices: &[u8]) -> Result<Vec<u8>, PictureError> {
    // The compressor allocates this much at first, and panics if that fails.
    let bytes = indices.len() / 2;
    Vec::<u8>::new().try_reserve_exact(bytes).map_err(|_| PictureError::Memory { bytes })?;
    let mut frame = Frame { buffer: indices.into(), ..Frame::default() };
    frame.make_lzw_pre_encoded();
    Ok(frame.buffer.into_owned())
}

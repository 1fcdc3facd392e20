//! GIF films as a decoder reads them, put together without regard to speed.

use gif::{ColorOutput, DecodeOptions, DisposalMethod, Repeat};
use mode13h::palette::Rgb;

/// One image of the file: its rectangle, what is visible once it is drawn, and for how long.
pub struct Image {
    pub left: usize,
    pub top: usize,
    pub width: usize,
    pub height: usize,
    /// In 1/100 s.
    pub delay: u64,
    pub has_palette: bool,
    /// Number of pixels left unchanged.
    pub transparent: usize,
    pub indices: Vec<u8>,
    pub shown: Vec<Rgb>,
}

/// A film, put together image by image.
pub struct Decoded {
    pub width: usize,
    pub height: usize,
    pub palette: Vec<Rgb>,
    pub images: Vec<Image>,
}

fn colors_of(table: &[u8]) -> Vec<Rgb> {
    table.chunks_exact(3).map(|color| Rgb::new(color[0], color[1], color[2])).collect()
}

/// Reads a film that repeats forever, and whose images stay.
pub fn decode(file: &[u8]) -> Decoded {
    assert!(file.starts_with(b"GIF89a") && file.ends_with(&[0x3B]));
    let mut options = DecodeOptions::new();
    options.set_color_output(ColorOutput::Indexed);
    options.check_frame_consistency(true);
    let mut decoder = options.read_info(file).expect("a GIF");
    let (width, height) = (usize::from(decoder.width()), usize::from(decoder.height()));
    let palette = colors_of(decoder.global_palette().expect("a palette of the film"));
    let mut canvas: Vec<Option<Rgb>> = vec![None; width * height];
    let mut images = Vec::new();
    while let Some(frame) = decoder.read_next_frame().expect("an image") {
        assert_eq!(frame.dispose, DisposalMethod::Keep);
        assert!(!frame.needs_user_input);
        let [left, top, w, h] = [frame.left, frame.top, frame.width, frame.height].map(usize::from);
        let own = frame.palette.as_deref().map(colors_of);
        let is_drawn = |index: &u8| Some(*index) != frame.transparent;
        for (i, &index) in frame.buffer.iter().enumerate().filter(|(_, index)| is_drawn(index)) {
            canvas[(top + i / w) * width + left + i % w] = Some(own.as_ref().unwrap_or(&palette)[usize::from(index)]);
        }
        images.push(Image {
            left,
            top,
            width: w,
            height: h,
            delay: frame.delay.into(),
            has_palette: own.is_some(),
            transparent: frame.buffer.iter().filter(|index| !is_drawn(index)).count(),
            indices: frame.buffer.to_vec(),
            shown: canvas.iter().map(|color| color.expect("the first image covers the film")).collect(),
        });
    }
    assert_eq!(decoder.repeat(), Repeat::Infinite);
    Decoded { width, height, palette, images }
}

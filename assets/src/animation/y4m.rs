//! A YUV4MPEG2 stream of frames, which `ffmpeg` reads from a pipe: a line with size and rate, then each frame as three
//! planes of bytes, the luma and two colour differences, all at full resolution.

use mode13h::export::Scaled;
use mode13h::export::{Picture, PictureError, Scale};
use mode13h::palette::Rgb;

use super::AnimationError;

/// The header line of a stream of frames like this one. `rate` is the number of frames per second, as a fraction.
///
/// ```
/// use mode13h::export::{Picture, Scale};
/// use mode13h_assets::animation::y4m_header;
/// use mode13h::palette::builtin::GREY;
/// let frame = Picture::mode_13h(&[0; 64_000], &GREY);
/// assert_eq!(y4m_header(&frame, Scale::One, (35, 1))?, "YUV4MPEG2 W320 H200 F35:1 Ip A5:6 C444\n");
/// # Ok::<(), mode13h_assets::animation::AnimationError>(())
/// ```
///
/// # Errors
///
/// [`AnimationErrorKind::Picture`](super::AnimationErrorKind::Picture) if the picture's sizes do not fit its bytes or
/// are too large when enlarged.
pub fn y4m_header(picture: &Picture<'_>, scale: Scale, rate: (u16, u16)) -> Result<String, AnimationError> {
    let scaled = Scaled::new(picture, scale)?;
    // Pixels per unit of length: the more across, the narrower each is.
    let (across, down) = scaled.density();
    let Scaled { width, height, .. } = scaled;
    Ok(format!("YUV4MPEG2 W{width} H{height} F{}:{} Ip A{down}:{across} C444\n", rate.0, rate.1))
}

/// A frame of a Y4M stream, to follow [`y4m_header`].
///
/// # Errors
///
/// Those of [`y4m_header`]; not enough memory.
pub fn y4m_frame(picture: &Picture<'_>, scale: Scale) -> Result<Vec<u8>, AnimationError> {
    const HEADING: &[u8] = b"FRAME\n";
    let scaled = Scaled::new(picture, scale)?;
    let pixels = scaled.width as usize * scaled.height as usize;
    let bytes = HEADING.len() + 3 * pixels;
    let mut frame = Vec::new();
    frame.try_reserve_exact(bytes).map_err(|_| PictureError::Memory { bytes })?;
    frame.extend(HEADING);
    let colors = picture.palette.map(luma_and_differences);
    for plane in [0, 1, 2].map(|plane| colors.map(|color| color[plane])) {
        for row in scaled.rows() {
            frame.extend(row.iter().map(|&index| plane[usize::from(index)]));
        }
    }
    Ok(frame)
}

/// Y, Cb and Cr of a colour after ITU-R BT.601 in 8 bits, Y from 16 to 235 and the others from 16 to 240, rounded to
/// the nearest.
fn luma_and_differences(Rgb { r, g, b }: Rgb) -> [u8; 3] {
    let (r, g, b) = (i32::from(r), i32::from(g), i32::from(b));
    // In 1/255,000: each sum of weights is 219,000, or 112,000 on either side of zero.
    let nearest = |zero: i32, sum: i32| (zero + (sum + 127_500).div_euclid(255_000)) as u8;
    [
        nearest(16, 65_481 * r + 128_553 * g + 24_966 * b),
        nearest(128, -37_797 * r - 74_203 * g + 112_000 * b),
        nearest(128, 112_000 * r - 93_786 * g - 18_214 * b),
    ]
}

#[cfg(test)]
mod tests {
    use super::*;
    use mode13h::export::PixelShape;

    /// Against the standard's definition: E'Y = 0.299 R + 0.587 G + 0.114 B; the differences are (B − Y) / 1.772 and (R
    /// − Y) / 1.402.
    #[test]
    fn colors_are_those_of_the_standard() {
        for color in (0..4096).map(|i| [i >> 8, (i >> 4) & 15, i & 15].map(|nibble| (nibble * 17) as u8)) {
            let [r, g, b] = color.map(|channel| f64::from(channel) / 255.0);
            let y = 0.299 * r + 0.587 * g + 0.114 * b;
            let exact = [16.0 + 219.0 * y, 128.0 + 224.0 * (b - y) / 1.772, 128.0 + 224.0 * (r - y) / 1.402];
            let bytes = luma_and_differences(Rgb::new(color[0], color[1], color[2]));
            for (byte, exact) in bytes.into_iter().zip(exact) {
                // One half, plus the error of five-digit weights: below 3 · 255 · ½ / 255,000.
                assert!((f64::from(byte) - exact).abs() <= 0.5 + 0.0015, "{color:?}: {byte}, {exact}");
            }
        }
    }

    #[test]
    fn a_frame_is_three_planes() {
        let palette = std::array::from_fn(|i| if i == 1 { Rgb::WHITE } else { Rgb::BLACK });
        let pixels = [0, 1];
        let picture =
            Picture { pixels: &pixels, width: 2, height: 1, pitch: 2, palette: &palette, shape: PixelShape::default() };
        let frame = y4m_frame(&picture, Scale::Double).expect("a frame");
        assert_eq!(frame[..6], *b"FRAME\n");
        assert_eq!(frame[6..14], [16, 16, 235, 235, 16, 16, 235, 235]);
        assert_eq!(frame[14..], [128; 16]);
        let header = y4m_header(&picture, Scale::Double, (2997, 100)).expect("a header");
        assert_eq!(header, "YUV4MPEG2 W4 H2 F2997:100 Ip A1:1 C444\n");
    }
}

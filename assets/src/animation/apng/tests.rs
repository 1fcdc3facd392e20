use std::io::Cursor;

use mode13h::export::PixelShape;
use mode13h::palette::builtin::GREY;
use png::{BlendOp, Decoder, DisposeOp, Transformations};

use super::*;

/// Frames of a small animation: palette indices and their colours.
type Frames = Vec<(Vec<u8>, [Rgb; 256])>;

const WIDTH: usize = 37;
const HEIGHT: usize = 11;

fn picture((pixels, palette): &(Vec<u8>, [Rgb; 256])) -> Picture<'_> {
    Picture { pixels, width: WIDTH, height: HEIGHT, pitch: WIDTH, palette, shape: PixelShape::MODE_13H }
}

/// Pseudo-random numbers (Knuth's generator).
fn random(seed: &mut u64) -> u64 {
    *seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
    *seed >> 33
}

/// Frames that change nothing, a pixel, a rectangle with many unchanged pixels, or everything.
fn film(palette: [Rgb; 256], frames: usize, seed: &mut u64) -> Frames {
    // Noise does not compress, so leaving out unchanged pixels is shorter.
    let mut pixels: Vec<u8> = (0..WIDTH * HEIGHT).map(|_| random(seed) as u8).collect();
    let mut all = Vec::new();
    for _ in 0..frames {
        all.push((pixels.clone(), palette));
        match random(seed) % 5 {
            0 => {}
            1 => pixels[random(seed) as usize % (WIDTH * HEIGHT)] = random(seed) as u8,
            2 => pixels.iter_mut().for_each(|pixel| *pixel = random(seed) as u8),
            _ => {
                for _ in 0..2 {
                    let at = random(seed) as usize % (WIDTH * HEIGHT);
                    pixels[at] ^= 64;
                }
            }
        }
    }
    all
}

fn written<W: Write>(frames: &Frames, scale: Scale, colors: &FilmColors, out: W) -> Result<(W, u64), AnimationError> {
    written_at(FrameRate::default(), frames, scale, colors, out)
}

fn written_at<W: Write>(
    rate: FrameRate,
    frames: &Frames,
    scale: Scale,
    colors: &FilmColors,
    out: W,
) -> Result<(W, u64), AnimationError> {
    let promised = frames.len() as u32;
    let mut film = Writer { out, rate, frames: promised, given: 0, sequence: 0, first: None, bytes: 0, failed: None };
    for (i, frame) in frames.iter().enumerate() {
        let before = i.checked_sub(1).map(|before| picture(&frames[before]));
        let made = ApngFrame::new(before.as_ref(), &picture(frame), scale, colors).expect("a frame");
        film.add(&made)?;
    }
    film.finish()
}

/// The red, green and blue of each pixel.
type Colors = Vec<[u8; 3]>;

/// The pictures that a reader shows, one for each frame; the number of frames that blend; and each frame's delay.
fn shown(file: &[u8]) -> (Vec<Colors>, usize, Vec<(u16, u16)>) {
    let mut decoder = Decoder::new(Cursor::new(file));
    decoder.set_transformations(Transformations::EXPAND);
    let mut reader = decoder.read_info().expect("a PNG");
    let count = reader.info().animation_control.expect("an animation").num_frames;
    assert_eq!(reader.info().animation_control.expect("an animation").num_plays, 0);
    let (width, height) = (reader.info().width as usize, reader.info().height as usize);
    let channels = reader.output_color_type().0.samples();
    let mut canvas = vec![None; width * height];
    let (mut all, mut blending, mut delays) = (Vec::new(), 0, Vec::new());
    let mut buffer = vec![0; width * height * 4];
    for _ in 0..count {
        reader.next_frame(&mut buffer).expect("a frame");
        let control = *reader.info().frame_control().expect("a frame's control");
        assert_eq!(control.dispose_op, DisposeOp::None);
        delays.push((control.delay_num, control.delay_den));
        blending += usize::from(control.blend_op == BlendOp::Over);
        for (i, pixel) in buffer.chunks(channels).take((control.width * control.height) as usize).enumerate() {
            let (x, y) = (i as u32 % control.width + control.x_offset, i as u32 / control.width + control.y_offset);
            let place = &mut canvas[y as usize * width + x as usize];
            match pixel.get(3) {
                Some(0) if control.blend_op == BlendOp::Over => {}
                Some(alpha) if *alpha != 255 => panic!("a pixel that is neither there nor not"),
                _ => *place = Some([pixel[0], pixel[1], pixel[2]]),
            }
        }
        all.push(canvas.iter().map(|color| color.expect("the first frame is whole")).collect());
    }
    assert!(reader.next_frame(&mut buffer).is_err(), "one frame more than is said");
    (all, blending, delays)
}

/// The colours of a frame as it was given, at an integer scale.
fn given(frame: &(Vec<u8>, [Rgb; 256]), across: usize, down: usize) -> Vec<[u8; 3]> {
    let mut colors = Vec::new();
    for y in 0..HEIGHT * down {
        for x in 0..WIDTH * across {
            let Rgb { r, g, b } = frame.1[usize::from(frame.0[y / down * WIDTH + x / across])];
            colors.push([r, g, b]);
        }
    }
    colors
}

#[test]
fn a_film_shows_what_was_given() {
    let mut seed = 13;
    let distinct: [Rgb; 256] = std::array::from_fn(|i| Rgb::new(i as u8, 255 - i as u8, 7));
    let mut blended = 0;
    // 64 greys, which leave room for an unused entry; and 256 colours.
    for palette in [*GREY.on_dac().colors(), distinct] {
        let frames = film(palette, 40, &mut seed);
        for (scale, across, down) in [(Scale::One, 1, 1), (Scale::FiveBySix, 5, 6)] {
            for colors in [FilmColors::Palette(Box::new(palette)), FilmColors::True] {
                let (file, bytes) = written(&frames, scale, &colors, Vec::new()).expect("a film");
                assert_eq!(file.len() as u64, bytes);
                let (shown, blending, delays) = shown(&file);
                let expected: Vec<_> = frames.iter().map(|frame| given(frame, across, down)).collect();
                assert!(shown == expected, "{colors:?} at {scale}");
                assert_eq!(delays, [(1, 35); 40]);
                // Without a free entry, nothing is transparent.
                assert!(blending == 0 || (colors != FilmColors::True && palette != distinct));
                blended += blending;
            }
        }
    }
    assert!(blended > 10, "{blended} frames blend");
}

#[test]
fn a_palette_that_changes_is_for_true_color() {
    let mut light = *GREY.colors();
    light[0] = Rgb::new(1, 2, 3);
    let pixels = vec![0; WIDTH * HEIGHT];
    let frames = vec![(pixels.clone(), *GREY.colors()), (pixels, light)];
    let (file, _) = written(&frames, Scale::One, &FilmColors::True, Vec::new()).expect("a film");
    let expected: Vec<_> = frames.iter().map(|frame| given(frame, 1, 1)).collect();
    assert!(shown(&file).0 == expected);
    let fixed = FilmColors::Palette(Box::new(*GREY.colors()));
    let refused = ApngFrame::new(Some(&picture(&frames[0])), &picture(&frames[1]), Scale::One, &fixed);
    assert!(matches!(refused.err().expect("refused").kind, AnimationErrorKind::OtherColors));
}

#[test]
fn the_head_says_shape_and_rate() {
    let frames = film(*GREY.colors(), 2, &mut 1);
    let colors = FilmColors::Palette(Box::new(*GREY.colors()));
    for (scale, size, density) in [(Scale::One, (37, 11), (6, 5)), (Scale::FiveBySix, (185, 66), (1, 1))] {
        // The duration of a frame in seconds, as a fraction.
        for (rate, delay) in [(0.1, (10, 1)), (12.5, (2, 25)), (35.0, (1, 35)), (50.0, (1, 50))] {
            let rate = FrameRate::try_from(rate).expect("a legal rate");
            let (file, _) = written_at(rate, &frames, scale, &colors, Vec::new()).expect("a film");
            let mut reader = Decoder::new(Cursor::new(&file)).read_info().expect("a PNG");
            let info = reader.info();
            assert_eq!((info.width, info.height), size);
            let dims = info.pixel_dims.expect("pHYs");
            assert_eq!((dims.xppu, dims.yppu), density);
            let control = info.animation_control.expect("acTL");
            assert_eq!((control.num_frames, control.num_plays), (2, 0));
            let mut buffer = vec![0; 185 * 66 * 4];
            for _ in 0..2 {
                reader.next_frame(&mut buffer).expect("a frame");
                let control = reader.info().frame_control().expect("fcTL");
                let (num, den) = (u64::from(control.delay_num), u64::from(control.delay_den));
                assert_eq!(num * delay.1, den * delay.0, "{rate:?}: {num} / {den} s");
            }
        }
    }
}

#[test]
fn a_film_that_runs_out_of_room_at_any_byte_never_ends_well() {
    let frames = film(*GREY.colors(), 4, &mut 3);
    let colors = FilmColors::Palette(Box::new(*GREY.colors()));
    let whole = written(&frames, Scale::One, &colors, Vec::new()).expect("a film").0.len();
    for room in 0..=whole {
        let mut disk = vec![0; room];
        match written(&frames, Scale::One, &colors, &mut disk[..]) {
            Ok(_) => assert_eq!(room, whole),
            Err(error) => {
                // A slice without room reports this kind.
                let full =
                    matches!(&error.kind, AnimationErrorKind::Io(error) if error.kind() == io::ErrorKind::WriteZero);
                assert!(room < whole && full, "{room}: {error}");
            }
        }
    }
}

#[test]
fn a_film_has_as_many_frames_as_it_says() {
    let directory = tempfile::tempdir().expect("a directory");
    let path = directory.path().join("film.apng");
    let frames = film(*GREY.colors(), 2, &mut 4);
    let made = ApngFrame::new(None, &picture(&frames[0]), Scale::One, &FilmColors::True).expect("a frame");
    let create = |frames| ApngFile::create(&path, FrameRate::default(), frames).expect("created");
    let mut film = create(2);
    film.add(&made).expect("added");
    let error = film.finish().expect_err("one is missing");
    assert_eq!(error.to_string(), format!("{}: an animation of 2 frames was given 1", path.display()));
    let mut film = create(1);
    film.add(&made).expect("added");
    let error = film.add(&made).expect_err("one too many");
    assert_eq!(error.to_string(), format!("{}: an animation of 1 frames was given 2", path.display()));
    drop(film);
    let larger = ApngFrame::new(None, &picture(&frames[0]), Scale::Double, &FilmColors::True).expect("a frame");
    let mut film = create(2);
    film.add(&made).expect("added");
    let error = film.add(&larger).expect_err("another size");
    assert!(matches!(error.kind, AnimationErrorKind::OtherSize { .. }), "{error}");
    let fixed = FilmColors::Palette(Box::new(*GREY.colors()));
    let other = ApngFrame::new(None, &picture(&frames[0]), Scale::One, &fixed).expect("a frame");
    let error = film.add(&other).expect_err("other colours");
    assert!(matches!(error.kind, AnimationErrorKind::OtherColors), "{error}");
    drop(film);
    let error = create(0).finish().expect_err("no frame");
    assert_eq!(error.to_string(), format!("{}: an animation without frames", path.display()));
    assert_eq!(std::fs::read_dir(directory.path()).expect("a directory").count(), 0, "nothing is left");
}

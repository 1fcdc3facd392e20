//! Pictures for terminals: the output is decoded by decoders written from the formats' specifications, and compared
//! with the picture pixel by pixel.

use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use std::process::{Output, Stdio};

use mode13h::export::{Picture, Scale, Scaled};
use mode13h::palette::{Palette, Rgb};
use mode13h_assets::terminal::Protocol;
use mode13h_conformance::random::Random;

use crate::folder::{Folder, Png, failed};
use crate::support::tried::Tried;

fn program(folder: &Folder, words: &str) -> Output {
    let mut command = folder.program(words);
    for variable in ["TERM", "TERM_PROGRAM", "KITTY_WINDOW_ID"] {
        command.env_remove(variable);
    }
    command.stdin(Stdio::null()).output().expect("started")
}

/// A picture of palette indices, and the colours that were sent for them.
struct Decoded {
    width: usize,
    height: usize,
    /// `None` where nothing was drawn.
    pixels: Vec<Option<u8>>,
    /// In percent.
    colors: [Option<[u32; 3]>; 256],
}

/// Takes a whole number from the front.
fn number(text: &mut &[u8]) -> u32 {
    let digits = text.iter().take_while(|byte| byte.is_ascii_digit()).count();
    let value = str::from_utf8(&text[..digits]).expect("digits").parse().expect("a number");
    *text = &text[digits..];
    value
}

/// Takes numbers with semicolons between them.
fn numbers(text: &mut &[u8]) -> Vec<u32> {
    let mut all = vec![number(text)];
    while let Some(rest) = text.strip_prefix(b";") {
        *text = rest;
        all.push(number(text));
    }
    all
}

/// Decodes one sixel picture, after chapter 14 of the VT330/VT340 Programmer Reference Manual. Anything that the writer
/// has no reason to send is a failure. Also returns the bytes that follow.
fn decode_sixel(text: &[u8]) -> (Decoded, &[u8]) {
    let mut rest = text.strip_prefix(b"\x1bP").expect("a device control string");
    assert_eq!(numbers(&mut rest), [7, 0, 0], "square pixels on a background");
    rest = rest.strip_prefix(b"q\"").expect("sixels with their size");
    let size = numbers(&mut rest);
    let [1, 1, width, height] = size[..] else { panic!("{size:?}") };
    let (width, height) = (width as usize, height as usize);
    let mut decoded = Decoded { width, height, pixels: vec![None; width * height], colors: [None; 256] };
    let (mut x, mut y, mut color, mut times) = (0, 0, None, 1);
    loop {
        let (&byte, behind) = rest.split_first().expect("an end");
        rest = behind;
        match byte {
            b'#' => {
                let words = numbers(&mut rest);
                let index = u8::try_from(words[0]).expect("a colour register");
                match words[1..] {
                    [] => color = Some(index),
                    [2, r, g, b] => {
                        assert!(r.max(g).max(b) <= 100, "percents");
                        let old = decoded.colors[usize::from(index)].replace([r, g, b]);
                        assert!(old.is_none(), "colour {index} is defined twice");
                    }
                    _ => panic!("{words:?}"),
                }
            }
            b'!' => times = number(&mut rest) as usize,
            b'$' => x = 0,
            b'-' => (x, y) = (0, y + 6),
            0x1b => {
                rest = rest.strip_prefix(b"\\").expect("the end of the string");
                return (decoded, rest);
            }
            b'?'..=b'~' => {
                for _ in 0..times {
                    for bit in (0..6).filter(|bit| (byte - b'?') >> bit & 1 == 1) {
                        let index = color.expect("a colour");
                        assert!(x < width && y + bit < height, "a pixel beside the picture");
                        let old = decoded.pixels[(y + bit) * width + x].replace(index);
                        assert_eq!(old, None, "a pixel is drawn once");
                    }
                    x += 1;
                }
                times = 1;
            }
            _ => panic!("{byte:#x}"),
        }
    }
}

/// The payload of kitty's chunks, and the keys of the first. Also returns the bytes that follow.
fn decode_kitty(mut text: &[u8]) -> (String, Vec<u8>, &[u8]) {
    let (mut first, mut bytes) = (None, Vec::new());
    loop {
        text = text.strip_prefix(b"\x1b_G").expect("a chunk");
        let end = text.windows(2).position(|two| two == b"\x1b\\").expect("its end");
        let chunk = str::from_utf8(&text[..end]).expect("ASCII");
        text = &text[end + 2..];
        let (keys, base64) = chunk.split_once(';').expect("keys");
        assert!(base64.len() <= 4096 && !base64.is_empty(), "{}", base64.len());
        let (keys, more) = keys.rsplit_once("m=").expect("whether there are more");
        match &first {
            None => first = Some(keys.to_string()),
            Some(_) => assert_eq!(keys, "", "the keys stand in the first chunk alone"),
        }
        assert!(more == "0" || base64.len().is_multiple_of(4));
        bytes.extend(STANDARD.decode(base64).expect("base64"));
        if more == "0" {
            return (first.unwrap_or_default(), bytes, text);
        }
        assert_eq!(more, "1");
    }
}

/// Asserts that a decoded picture has these pixels, with the colours of their entries to the nearest percent.
#[track_caller]
fn assert_shows(decoded: &Decoded, rows: &[Vec<u8>], palette: &[Rgb; 256]) {
    assert_eq!((decoded.width, decoded.height), (rows[0].len(), rows.len()));
    let wanted: Vec<Option<u8>> = rows.iter().flatten().copied().map(Some).collect();
    assert!(decoded.pixels == wanted, "other pixels");
    for index in rows.iter().flatten().map(|&index| usize::from(index)) {
        let (Rgb { r, g, b }, percents) = (palette[index], decoded.colors[index].expect("it is defined"));
        for (channel, percent) in [r, g, b].into_iter().zip(percents) {
            // Half of a percent is 1.275 of 255.
            assert!((f64::from(percent) * 2.55 - f64::from(channel)).abs() <= 1.275, "{channel}: {percent} %");
        }
    }
}

/// A picture of random size whose rows are partly runs and partly noise, in few colours or many.
fn picture(random: &mut Random) -> (usize, Vec<u8>, Palette) {
    let (width, height) = (1 + random.below(70), 1 + random.below(40));
    let colors = 1 + random.below(256);
    let mut index = 0;
    let noise = random.below(9);
    let pixels = (0..width * height).map(|_| {
        if random.below(8) < noise {
            index = random.below(colors) as u8;
        }
        index
    });
    let pixels = pixels.collect();
    let palette = Palette::from_colors(core::array::from_fn(|_| {
        let [r, g, b] = core::array::from_fn(|_| random.below(256) as u8);
        Rgb::new(r, g, b)
    }));
    (width, pixels, palette)
}

#[test]
fn pictures_are_the_same_once_decoded() {
    let mut tried = Tried::new("pictures_are_the_same_once_decoded", 1_000);
    let mut random = Random::named("pictures_are_the_same_once_decoded");
    for _ in 0..500 {
        let (width, pixels, palette) = picture(&mut random);
        let picture = Picture::of(&pixels, width, &palette);
        let larger = Scale::To { width: 1 + random.below(150) as u16, height: 1 + random.below(90) as u16 };
        for scale in [Scale::One, Scale::Double, Scale::FiveBySix, larger] {
            let rows: Vec<Vec<u8>> = Scaled::new(&picture, scale).expect("a size").rows().collect();
            let sixel = Protocol::Sixel.picture(&picture, scale).expect("a picture");
            let (decoded, rest) = decode_sixel(sixel.as_bytes());
            assert!(rest.is_empty());
            assert_shows(&decoded, &rows, palette.colors());

            let kitty = Protocol::Kitty.picture(&picture, scale).expect("a picture");
            let (keys, bytes, rest) = decode_kitty(kitty.as_bytes());
            assert!(keys == "a=T,f=100,q=2," && rest.is_empty(), "{keys}");
            let png = Png::decode(&bytes);
            assert!(png.size == (rows[0].len() as u32, rows.len() as u32) && png.pixels == rows.concat());
            assert!(png.palette == palette.colors());
            tried.add(1);
        }
    }
}

/// The DAC's 64 levels are 64 different percents.
#[test]
fn the_levels_of_the_dac_stay_different_in_percent() {
    let colors = core::array::from_fn(|i| Rgb::from_dac([(i % 64) as u8; 3]));
    let pixels: Vec<u8> = (0..64).collect();
    let palette = Palette::from_colors(colors);
    let text = Protocol::Sixel.picture(&Picture::of(&pixels, 64, &palette), Scale::One).expect("a picture");
    let (decoded, _) = decode_sixel(text.as_bytes());
    let mut levels: Vec<[u32; 3]> = decoded.colors.into_iter().flatten().collect();
    assert_eq!(levels.len(), 64);
    levels.dedup();
    assert_eq!(levels.len(), 64);
}

/// `render` shows the same picture in a terminal as it saves.
#[test]
fn render_shows_the_picture_that_it_saves() {
    let folder = Folder::new();
    folder.succeed("render crate -o crate.png --scale 640x480");
    let png = folder.png("crate.png");
    assert_eq!(png.size, (640, 480));

    let kitty = program(&folder, "render crate --to kitty");
    assert!(kitty.status.success() && kitty.stderr.is_empty(), "{:?}", String::from_utf8_lossy(&kitty.stderr));
    let (_, shown, rest) = decode_kitty(&kitty.stdout);
    let shown = Png::decode(&shown);
    assert!(rest == b"\n" && (shown.size, &shown.pixels, &shown.palette) == (png.size, &png.pixels, &png.palette));

    let sixel = program(&folder, "render crate -o - --to sixel");
    let (decoded, rest) = decode_sixel(&sixel.stdout);
    let palette = png.palette.as_slice().try_into().expect("256 colours");
    assert_eq!(rest, b"\n");
    assert_shows(&decoded, &png.pixels.chunks(640).map(<[u8]>::to_vec).collect::<Vec<_>>(), palette);
    let small = program(&folder, "render crate --to sixel --scale 1");
    assert_eq!(decode_sixel(&small.stdout).0.width, 320);
}

/// Frames begin at the screen's corner, and the screen and the cursor are restored at the end.
#[test]
fn the_demo_in_a_terminal_ends_as_it_began() {
    let (begin, end) = ("\x1b[?1049h\x1b[?25l\x1b[2J", "\x1b[?25h\x1b[?1049l");
    for (protocol, after) in [("sixel", ""), ("kitty", "\x1b_Ga=d,d=I,i=13,q=2\x1b\\")] {
        let output = program(&Folder::new(), &format!("demo torus --terminal --to {protocol} --frames 3"));
        assert!(output.status.success() && output.stderr.is_empty(), "{output:?}");
        let mut rest = output.stdout.strip_prefix(begin.as_bytes()).expect("the alternate screen");
        for _ in 0..3 {
            rest = rest.strip_prefix(b"\x1b[?2026h\x1b[H").expect("a frame");
            let size;
            (size, rest) = match protocol {
                "sixel" => {
                    let (decoded, rest) = decode_sixel(rest);
                    assert!(decoded.pixels.iter().all(Option::is_some));
                    ((decoded.width, decoded.height), rest)
                }
                _ => {
                    let (keys, bytes, rest) = decode_kitty(rest);
                    assert_eq!(keys, "a=T,f=100,q=2,i=13,p=1,C=1,");
                    let (width, height) = Png::decode(&bytes).size;
                    ((width as usize, height as usize), rest)
                }
            };
            assert_eq!(size, (320, 240));
            rest = rest.strip_prefix(b"\x1b[?2026l").expect("the frame's end");
        }
        assert_eq!(String::from_utf8_lossy(rest), format!("\x1b\\\x1b[?2026l{after}{end}"));
    }
}

/// A signal ends it, too.
#[cfg(unix)]
#[test]
fn the_demo_in_a_terminal_ends_when_told() {
    use std::io::Read;
    let folder = Folder::new();
    let mut child = folder.program("demo torus --terminal --to kitty --frames 1000000");
    let mut child = child.stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().expect("started");
    let mut out = child.stdout.take().expect("a pipe");
    // Frames are shown.
    out.read_exact(&mut [0; 4096]).expect("frames");
    let kill = std::process::Command::new("kill").args(["-TERM", &child.id().to_string()]).status();
    assert!(kill.expect("started").success());
    let mut rest = Vec::new();
    out.read_to_end(&mut rest).expect("read");
    let end = "\x1b\\\x1b[?2026l\x1b_Ga=d,d=I,i=13,q=2\x1b\\\x1b[?25h\x1b[?1049l";
    assert!(rest.ends_with(end.as_bytes()));
    assert_eq!(child.wait().expect("waited").code(), Some(130));
}

#[test]
fn a_terminal_is_asked_for_what_it_can_do() {
    for (words, said) in [
        (
            "demo torus --terminal",
            "--terminal: standard input is not a terminal, so no key can quit; --frames N quits after N frames",
        ),
        ("demo a b --terminal --frames 1", "--terminal shows one INPUT, not several"),
        ("demo no-such --terminal --frames 1", "no-such: "),
        ("render torus --to sixel -o a.png", "a.png: --to shows the picture in the terminal, so -o can only be -"),
        ("render torus --to kitty --frames 2", "a terminal shows one picture; `mode13h demo --terminal` shows motion"),
        ("render torus --to vt52", "invalid value 'vt52' for '--to <PROTOCOL>'"),
    ] {
        failed(&program(&Folder::new(), words), 2, &format!("mode13h: {said}"));
    }
}

//! `mode13h dos`: a scene as a program for DOS, which draws it in the mode 13h of a real VGA.
//!
//! The program is a DOS header, a 16-bit stub, a flat image of the engine for a 386, and a film: one loop of the scene
//! in 16.16 ([`player`]), packed ([`unpack`]). Stub and image are included as bytes, so no assembler is needed here;
//! their source is in `machines/dos`, whose `build` rebuilds the bytes.

mod film;
mod player;
mod unpack;

use std::ffi::OsString;
use std::path::PathBuf;

use clap::Args;
use miniz_oxide::deflate::{CompressionLevel, compress_to_vec};
use mode13h::internals;
use mode13h::palette::{BIOS, Palette};
use mode13h::plan::Effect;
use mode13h::render::{Renderer, Screen};
use mode13h::settings::{HiddenSurfaces, Shading, VertexPath};
use mode13h_conformance::hash::{START, fnv_1a};

use self::player::{Film, PIXELS, Player};
use self::unpack::unpack;
use crate::failure::Failure;
use crate::input;
use crate::options::{Drawing, shading_of};
use crate::turntable::{Pose, Turntable};
use crate::{output, read_files};

/// Stub and image, as `machines/dos/build` makes them.
static PLAYER: &[u8] = include_bytes!("player.bin");

/// The first sector of a floppy, and the offset in it of the number of sectors that follow.
static BOOT: &[u8; 512] = include_bytes!("boot.bin");
const SECTORS: usize = 4;
/// Bytes of a floppy.
const FLOPPY: usize = 2 * 80 * 18 * 512;

/// Bytes of the stub's table in `PLAYER`: offset and length of the film, the stack's top, the extended memory in KB.
const TABLE: usize = 4;
/// Maximum size of a program, in bytes, as DOS loads it below 640 KB.
const MAX_SIZE: usize = 500_000;
/// Bytes of stack behind the program, half of it for real mode.
const STACK: usize = 0x1_0000;

#[derive(Args)]
pub(crate) struct Options {
    #[arg(help = input::HELP, long_help = input::long_help())]
    input: OsString,
    /// Write to FILE: .exe for a program, .img for a floppy
    ///
    /// The 1.44 MB floppy starts the program without DOS. An existing file is overwritten.
    ///
    /// [default: INPUT.EXE in the current directory, never overwritten without --force]
    #[arg(short, long, value_name = "FILE")]
    out: Option<PathBuf>,
    /// Overwrite INPUT.EXE
    #[arg(long)]
    force: bool,
    /// Render one loop of the scene as N frames
    #[arg(long, value_name = "N", default_value_t = 128, value_parser = clap::value_parser!(u16).range(1..=1024))]
    frames: u16,
    /// Shade every face by one of the integer methods
    #[arg(long, value_name = "NAME", value_parser = shading_of(SHADINGS))]
    shading: Option<Shading>,
    #[command(flatten)]
    drawing: Drawing,
}

/// The shadings that a film may have.
const SHADINGS: [Shading; 6] = [
    Shading::Flat,
    Shading::GouraudVintage,
    Shading::Gouraud88,
    Shading::Gouraud88Reseeded,
    Shading::Gouraud1616,
    Shading::GouraudHyperbolic,
];

pub(crate) fn run(options: &Options) -> Result<(), Failure> {
    let Options { input, out, force, frames, shading, drawing } = options;
    let kernel = drawing.kernel()?;
    let name = input::name_of(input);
    let out = output::path_or(out.as_ref(), format!("{}.EXE", short_name(&name)), *force)?;
    if !["exe", "img"].iter().any(|extension| output::has_extension(&out, extension)) {
        let reason = "the name of a DOS program must end in .exe, that of a floppy in .img";
        return Err(Failure::words(format!("{}: {reason}", out.display())));
    }
    let mut stage = drawing.stage(drawing.input(input)?)?;
    read_files::spare(&out)?;
    let mut renderer = Renderer::new();
    renderer.kernel = kernel;
    renderer.settings.accuracy = shading.map(Into::into);
    if let Some(losses) = losses(&mut stage, &renderer)? {
        output::note(losses);
    }
    stage.draw_in_integers()?;
    let ignored = drawing.ignored_by_dos();
    if !ignored.is_empty() {
        output::note(format_args!("ignored, because the program computes in 16.16: {}", ignored.join(", ")));
    }
    let (film, vertices) = film_of(&mut stage, &mut renderer, *frames)?;
    let packed = pack(&film);
    let body = body(&packed, film.len(), vertices)?;
    let program = if output::has_extension(&out, "img") { floppy(&body) } else { program(&body) };
    // The frames are drawn from what the program unpacks.
    let sum = unpack(&packed)
        .and_then(|film| hash_of(&film))
        .ok_or_else(|| Failure::words("a mesh of the scene cannot be drawn in 16.16"))?;
    output::bytes(&out, &program)?;
    let frames = output::counted((*frames).into(), "frame");
    output::say(&format!("{}: {} bytes; {frames}, {sum:016x}\n", out.display(), program.len()))
}

/// Describes what the film leaves out of a scene, if anything: effects that it needs and the 16.16 path lacks.
fn losses(stage: &mut Turntable, like: &Renderer) -> Result<Option<String>, Failure> {
    let mut renderer = like.with_same_settings();
    stage.show(0.0, Pose::FIRST);
    let called_for = |path: VertexPath, renderer: &mut Renderer| -> Result<Vec<Effect>, Failure> {
        renderer.settings.vertex_path = Some(path);
        let plan = renderer.make_plan(&stage.scene, Screen::MODE_13H)?;
        Ok(Effect::ALL.into_iter().filter(|effect| plan.is_on_anywhere(*effect)).collect())
    };
    let (float, fixed) =
        (called_for(VertexPath::Float, &mut renderer)?, called_for(VertexPath::Integer, &mut renderer)?);
    let lost: Vec<&str> = float.into_iter().filter(|effect| !fixed.contains(effect)).map(Effect::name).collect();
    Ok((!lost.is_empty()).then(|| format!("left out, because the program computes in 16.16: {}", lost.join(", "))))
}

/// A name that DOS allows: at most eight characters, each a letter, a digit or one of a few symbols.
fn short_name(name: &str) -> String {
    let fits = |c: &char| c.is_ascii_alphanumeric() || "_-".contains(*c);
    let short: String = name.chars().filter(fits).take(8).collect::<String>().to_ascii_uppercase();
    if short.is_empty() { "SCENE".into() } else { short }
}

/// One loop of a scene as a film, and the largest number of vertices in a mesh.
fn film_of(stage: &mut Turntable, renderer: &mut Renderer, frames: u16) -> Result<(Vec<u8>, usize), Failure> {
    let mut writer = film::Writer::new();
    for number in 0..frames {
        show(stage, renderer, number, frames);
        let frame = internals::integer_frame(renderer, &stage.scene, Screen::MODE_13H)?;
        writer.push(&frame).map_err(Failure::words)?;
    }
    let vertices = writer.vertices;
    let palette: &Palette = stage.scene.palette.as_ref().unwrap_or(&BIOS);
    Ok((writer.finish(palette).map_err(Failure::words)?, vertices))
}

/// Moves a scene to a frame of its loop. A film cannot draw in painter's order, so it uses a depth buffer instead.
fn show(stage: &mut Turntable, renderer: &mut Renderer, number: u16, frames: u16) {
    let (seconds, pose) = stage.turned(0.0, 360.0 * f64::from(number) / f64::from(frames));
    stage.show(seconds, pose);
    renderer.settings.vertex_path = Some(VertexPath::Integer);
    if stage.scene.settings.hidden_surfaces == Some(HiddenSurfaces::PainterOrder) {
        stage.scene.settings.hidden_surfaces = Some(HiddenSurfaces::DepthBuffer);
    }
}

/// Packs less than 4 GB of bytes in the format of [`unpack`](unpack()).
fn pack(bytes: &[u8]) -> Vec<u8> {
    let mut packed = (bytes.len() as u32).to_le_bytes().to_vec();
    packed.extend(compress_to_vec(bytes, CompressionLevel::UberCompression as u8));
    packed
}

/// Stub, image and packed film, as they are in memory. `unpacked` is the film's length in bytes when unpacked.
fn body(film: &[u8], unpacked: usize, vertices: usize) -> Result<Vec<u8>, Failure> {
    let mut body = PLAYER.to_vec();
    body.resize(body.len().next_multiple_of(16), 0);
    let start = body.len();
    body.extend(film);
    body.resize(body.len().next_multiple_of(16), 0);
    // For the unpacked film, and for its meshes with two copies of their indices. A vertex takes less than 64 bytes.
    let heap = 4 * unpacked + 5 * PIXELS + 64 * vertices + 65_536;
    if body.len() > MAX_SIZE {
        let line = format!("the program would take {} bytes, but DOS has room for {MAX_SIZE}", body.len());
        return Err(Failure::words(line));
    }
    // All below 2³².
    let table = [start, film.len(), body.len() + STACK, heap.div_ceil(1024)];
    for (to, value) in body[TABLE..].as_chunks_mut::<4>().0.iter_mut().zip(table) {
        *to = (value as u32).to_le_bytes();
    }
    Ok(body)
}

/// A bootable floppy with the program.
fn floppy(body: &[u8]) -> Vec<u8> {
    let mut floppy = BOOT.to_vec();
    floppy[SECTORS..SECTORS + 2].copy_from_slice(&(body.len().div_ceil(512) as u16).to_le_bytes()); // at most 977
    floppy.extend(body);
    floppy.resize(FLOPPY, 0);
    floppy
}

/// The program for DOS.
fn program(body: &[u8]) -> Vec<u8> {
    const HEADER: usize = 32;
    let (size, paragraphs) = (HEADER + body.len(), |bytes: usize| (bytes / 16) as u16); // below 2²⁰ bytes
    let header = [
        u16::from_le_bytes(*b"MZ"),
        (size % 512) as u16,
        size.div_ceil(512) as u16, // at most 978
        0,                         // relocations
        paragraphs(HEADER),
        paragraphs(STACK), // memory behind the program, at least and at most
        paragraphs(STACK),
        paragraphs(body.len()), // SS:SP
        (STACK / 2) as u16,
        0, // sum
        0, // CS:IP, 0:0
        0,
        HEADER as u16 - 4, // the table of relocations
        0,
        0,
        0,
    ];
    let mut program: Vec<u8> = header.iter().flat_map(|word| word.to_le_bytes()).collect();
    program.extend(body);
    program
}

/// The hash that the program prints: of all frames' bytes, then of the DAC.
fn hash_of(film: &[u8]) -> Option<u64> {
    let film = Film::read(film)?;
    let mut player = Player::new(&film, mode13h::span::Kernel::PORTABLE)?;
    let mut pixels = vec![0; PIXELS];
    let mut sum = START;
    for number in 0..film.frames() {
        player.draw(number, &mut pixels)?;
        sum = fnv_1a(sum, &pixels);
    }
    Some(fnv_1a(sum, film.dac))
}

#[cfg(test)]
mod tests {
    use mode13h::vga::Vga;
    use mode13h_assets::shipped;

    use super::*;

    /// A film draws every shipped scene as the renderer does, and a truncated film is rejected.
    #[test]
    fn a_film_is_drawn_as_the_scene_is() {
        for shipped in &shipped::ALL {
            let Ok(loaded) = shipped.load() else { panic!("{}", shipped.name) };
            let mut stage = Turntable::of_scene(loaded.scene);
            let mut renderer = Renderer::new();
            let (film, _) = film_of(&mut stage, &mut renderer, 5).unwrap();
            let read = Film::read(&film).unwrap();
            assert_eq!(read.frames(), 5);
            let mut player = Player::new(&read, mode13h::span::Kernel::PORTABLE).unwrap();
            let (mut pixels, mut vga) = (vec![0; PIXELS], Vga::new());
            for number in 0..5 {
                show(&mut stage, &mut renderer, number, 5);
                renderer.draw(&stage.scene, &mut vga).unwrap();
                player.draw(number.into(), &mut pixels).unwrap();
                assert!(pixels == *vga.pixels(), "{} frame {number}", shipped.name);
            }
            assert!(Film::read(&film[..film.len() - 1]).is_none(), "{}", shipped.name);
        }
    }

    /// Every shipped scene makes a program of at most 250 kB, whose film unpacks to the same bytes.
    #[test]
    fn shipped_scenes_are_small() {
        for shipped in &shipped::ALL {
            let Ok(loaded) = shipped.load() else { panic!("{}", shipped.name) };
            let (film, vertices) = film_of(&mut Turntable::of_scene(loaded.scene), &mut Renderer::new(), 128).unwrap();
            let packed = pack(&film);
            assert!(unpack(&packed) == Some(film.clone()), "{}", shipped.name);
            let size = program(&body(&packed, film.len(), vertices).unwrap()).len();
            assert!(size <= 250_000, "{}: {size} bytes", shipped.name);
        }
    }

    /// A packed film that is truncated, extended or altered is rejected or unpacks to as many other bytes, without a
    /// panic.
    #[test]
    fn broken_films_are_refused() {
        let words = (0..4000_u32).flat_map(|i| (i * i / 7).to_le_bytes());
        for bytes in [Vec::new(), vec![7; 70_000], words.chain((0..90_000).map(|i| (i % 251) as u8)).collect()] {
            let packed = pack(&bytes);
            assert!(unpack(&packed) == Some(bytes.clone()) && packed.len() <= bytes.len() + 16);
            assert!((0..packed.len()).step_by(1 + packed.len() / 200).all(|end| unpack(&packed[..end]).is_none()));
            assert!(unpack(&packed[..packed.len() - 1]).is_none());
            assert!(unpack(&[&packed[..], &[0]].concat()).is_none());
            for at in (0..packed.len()).step_by(1 + packed.len() / 50) {
                let mut other = packed.clone();
                // The largest length, which is zeroed, is 16 MB.
                other[at] ^= if at == 3 { 0x01 } else { 0x10 };
                assert!(unpack(&other).is_none_or(|unpacked| unpacked.len() == bytes.len()));
            }
        }
        assert!(unpack(&[&[0xFF, 0xFF, 0xFF, 0][..], &[0xFF; 96]].concat()).is_none());
    }

    /// DOS and the boot sector load the whole program, and one that DOS cannot load is rejected.
    #[test]
    fn headers_say_what_follows() {
        let bytes = body(b"a film", 6, 3).unwrap();
        let table = |i: usize| u32::from_le_bytes(bytes[TABLE + 4 * i..][..4].try_into().unwrap()) as usize;
        assert_eq!(bytes[table(0)..][..table(1)], *b"a film");
        assert!(table(2) == bytes.len() + STACK && table(3) * 1024 > 5 * PIXELS);

        let program = program(&bytes);
        let word = |at: usize| usize::from(u16::from_le_bytes([program[at], program[at + 1]]));
        assert_eq!((word(4) - 1) * 512 + word(2), program.len());
        assert_eq!(program[word(8) * 16..], bytes);
        assert_eq!((word(14) * 16, word(16)), (bytes.len(), STACK / 2));

        let floppy = floppy(&bytes);
        assert_eq!((floppy.len(), &floppy[510..512]), (1_474_560, &[0x55, 0xAA][..]));
        assert!(floppy[512..].starts_with(&bytes));
        assert_eq!(usize::from(u16::from_le_bytes([floppy[4], floppy[5]])), bytes.len().div_ceil(512));
        assert!(body(&vec![0; MAX_SIZE], 0, 0).is_err());
    }

    /// A film supports each of its shadings, and the integer path draws no others.
    #[test]
    fn every_shading_of_integers_is_drawn() {
        assert!(Shading::ALL.into_iter().filter(|shading| shading.in_integers() == *shading).eq(SHADINGS));
        let mut stage = Turntable::of_scene(shipped::ALL[0].load().unwrap().scene);
        let (mut pixels, mut vga) = (vec![0; PIXELS], Vga::new());
        let mut hashes = Vec::new();
        for shading in SHADINGS {
            let mut renderer = Renderer::new();
            renderer.settings.accuracy = Some(shading.into());
            let (film, _) = film_of(&mut stage, &mut renderer, 1).unwrap();
            let read = Film::read(&film).unwrap();
            Player::new(&read, mode13h::span::Kernel::PORTABLE).unwrap().draw(0, &mut pixels).unwrap();
            renderer.draw(&stage.scene, &mut vga).unwrap();
            assert!(pixels == *vga.pixels(), "{shading}");
            hashes.push(fnv_1a(START, &pixels));
        }
        // On this torus, spans are too short for 8.8 to drift and to be reseeded.
        hashes.dedup();
        assert_eq!(hashes.len(), 5, "{hashes:x?}");
    }

    #[test]
    fn names_are_those_of_dos() {
        assert_eq!(short_name("a long.name"), "ALONGNAM");
        assert_eq!(short_name("é"), "SCENE");
    }
}

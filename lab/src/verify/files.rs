//! Group F: files, in memory.

use super::Group;
use super::drawing;
use super::random::Random;
use super::triangles::{any_clip, any_shading, any_triangle};
use crate::record::Record;
use mode13h::palette::file::{self, FORMATS, Format};
use mode13h::palette::{Palette, Rgb, builtin};
use mode13h::render::HiddenSurfaces;

/// Checks that written files are read again: palettes in every format, records, and with the features `obj` and
/// `scene-files` models and scenes. A file that is broken off or changed is refused or read, and never more
/// than that (P5, F1, F3, F5).
///
/// ```
/// let group = mode13h_lab::verify::files(13);
/// assert!(group.passed(), "{:?}", group.failures);
/// ```
#[must_use]
pub fn files(seed: u64) -> Group {
    check(seed, &|format, palette| format.write(palette, "any"))
}

/// A palette as a file.
type Write<'a> = &'a dyn Fn(&Format, &Palette) -> Vec<u8>;

fn check(seed: u64, write: Write<'_>) -> Group {
    let mut group = Group::new("files");
    let mut random = Random::new(seed, "files");
    palettes(&mut group, &mut random, write);
    records(&mut group, &mut random);
    models(&mut group, &mut random);
    scenes(&mut group, &mut random);
    group
}

fn palettes(group: &mut Group, random: &mut Random, write: Write<'_>) {
    for _ in 0..40 {
        // The DAC's own colours, which no format rounds.
        let mut any = || Rgb::from_dac([0; 3].map(|_| random.below(64) as u8));
        let palette = Palette::from_colors([(); 256].map(|()| any()));
        for format in &FORMATS {
            let bytes = write(format, &palette);
            let read = format.read(&bytes);
            let same = read.as_ref().is_ok_and(|read| read.colors() == palette.colors());
            group.check(same, || match read {
                Ok(_) => format!("f {}: not the colours that were written", format.name),
                Err(error) => format!("f {}: what was written is refused: {error}", format.name),
            });
            // P5, F5: no panic, and of what lacks a byte nothing.
            let half = random.below(bytes.len() as u32) as usize;
            let short = file::parse(&bytes[..half]);
            let fixed = matches!(format.name, "act" | "act-772" | "vga");
            group.check(!fixed || short.is_err(), || format!("p5 {} of {half} bytes is read", format.name));
            let mut spoilt = bytes;
            let place = random.below(spoilt.len() as u32) as usize;
            spoilt[place] = random.below(256) as u8;
            let _ = (file::parse(&spoilt), format.read(&spoilt));
            group.check(true, String::new);
        }
    }
    for format in &FORMATS {
        group.check(format.read(b"").is_err(), || format!("p5 an empty {} is read", format.name));
    }
}

fn records(group: &mut Group, random: &mut Random) {
    for _ in 0..100 {
        let (width, height) = (1 + random.below(4096), 1 + random.below(4096));
        let Ok(record) = Record::new(width, height) else { continue };
        let clip = (random.below(2) == 0).then(|| any_clip(random, width, height));
        let mut record = record.with_clip(clip);
        record.background = random.below(256) as u8;
        record.hidden_surfaces = random.one_of(&HiddenSurfaces::ALL);
        record.palette = (random.below(4) == 0).then(|| builtin::COPPER.clone());
        for _ in 0..random.below(20) {
            let vertices = any_triangle(random, width, height);
            record.triangles.push((vertices, any_shading(random)));
        }
        let text = record.to_string();
        let read = Record::read(text.as_bytes());
        group.check(read.as_ref().is_ok_and(|read| *read == record), || format!("f a record is read as {read:?}"));
        // Without its end it is refused wherever it is broken off.
        let half = random.below(text.trim_end().len() as u32) as usize;
        let short = Record::read(&text.as_bytes()[..half]);
        group.check(short.is_err(), || format!("f5 {half} bytes of a record are read"));
        let mut spoilt = text.into_bytes();
        let place = random.below(spoilt.len() as u32) as usize;
        spoilt[place] = random.below(256) as u8;
        if let Ok(read) = Record::read(&spoilt[..])
            && read.width() < 100
            && read.height() < 100
        {
            let way = drawing::Configuration::new(HiddenSurfaces::DepthBuffer, mode13h::span::Kernel::PORTABLE);
            let drawn = drawing::draw(&read, way);
            group.check(drawn.is_ok(), || format!("f5 a record that was read cannot be drawn: {drawn:?}"));
        }
    }
}

/// Every shape as text and back: the same positions and triangles, and each broken line refused by its
/// number.
fn models(group: &mut Group, random: &mut Random) {
    use mode13h::mesh::{obj, shapes};
    use std::fmt::Write as _;

    let none = |_: &std::path::Path| Err(std::io::ErrorKind::NotFound.into());
    for name in shapes::NAMES {
        let Some(mesh) = shapes::by_name(name) else { continue };
        let mut text = String::new();
        // Writing to a string cannot fail. An f32 is printed so that it is read as the same.
        for p in mesh.positions() {
            let _ = writeln!(text, "v {} {} {}", p.x, p.y, p.z);
        }
        for n in mesh.normals() {
            let _ = writeln!(text, "vn {} {} {}", n.x, n.y, n.z);
        }
        for [a, b, c] in mesh.triangles().iter().map(|t| t.map(|i| i + 1)) {
            let _ = writeln!(text, "f {a}//{a} {b}//{b} {c}//{c}");
        }
        let corners = |mesh: &mode13h::mesh::Mesh| -> Vec<[u32; 3]> {
            let at = |i: &u32| mesh.positions()[*i as usize].to_array().map(f32::to_bits);
            mesh.triangles().iter().flatten().map(at).collect()
        };
        let read = obj::parse(text.as_bytes(), "memory", none).map(|loaded| corners(&loaded.mesh));
        group.check(read.as_ref().is_ok_and(|read| *read == corners(&mesh)), || match read {
            Ok(_) => format!("f {name}: other triangles than were written"),
            Err(error) => format!("f {name}: refused: {error}"),
        });

        let lines: Vec<&str> = text.lines().collect();
        for broken in ["v 0 NaN 0", "f 1 x", "f 1 0 2", "f 1 2 99999999", "v 1 2", "f a b c"] {
            let line = random.below(lines.len() as u32) as usize;
            let mut spoilt = lines.clone();
            spoilt.insert(line, broken);
            let refused = obj::parse(spoilt.join("\n").as_bytes(), "memory", none).err().map(|error| error.to_string());
            let right = refused.as_ref().is_some_and(|said| said.starts_with(&format!("memory:{}:", line + 1)));
            group.check(right, || format!("f1 {name} with {broken:?} in line {}: {refused:?}", line + 1));
        }
    }
}

/// Every shipped scene loads; one with a key or a value that it may not have is refused by its line (F3).
fn scenes(group: &mut Group, random: &mut Random) {
    use mode13h::scene::{Scene, shipped};

    let load = |text: &str| {
        let none = |_: &std::path::Path| Err(std::io::ErrorKind::NotFound.into());
        Scene::from_toml(text, "memory", none).err().map(|error| error.to_string())
    };
    for shipped in &shipped::ALL {
        let refused = load(shipped.text);
        group.check(refused.is_none(), || format!("f3 {}: {refused:?}", shipped.name));
        let lines: Vec<&str> = shipped.text.lines().collect();
        // Before the first table a line may stand anywhere.
        let tables = lines.iter().position(|line| line.starts_with('[')).unwrap_or_default();
        for (broken, key) in [("shap = 1", "shap"), ("ambient = 'much'", "ambient"), ("duration = 0", "duration")] {
            let line = random.below(tables as u32 + 1) as usize;
            let mut spoilt = lines.clone();
            spoilt.insert(line, broken);
            // A key that the scene has already is there twice.
            spoilt.retain(|line| !line.starts_with(&format!("{key} =")) || *line == broken);
            let refused = load(&spoilt.join("\n"));
            let at = spoilt.iter().position(|line| *line == broken).unwrap_or_default() + 1;
            let right =
                refused.as_ref().is_some_and(|said| said.starts_with(&format!("memory:{at}:")) && said.contains(key));
            group.check(right, || format!("f3 {} with {broken:?} in line {at}: {refused:?}", shipped.name));
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn files_are_right() {
        let group = files(1);
        assert_eq!(group.failures, [""; 0]);
        assert!(group.cases > 900);
    }

    #[test]
    fn a_format_that_is_written_wrongly_is_told() {
        let dark = |format: &Format, palette: &Palette| {
            let mut bytes = format.write(palette, "dark");
            if format.name == "act" {
                bytes[9] ^= 0x80;
            }
            bytes
        };
        assert_eq!(check(1, &dark).failures[0], "f act: not the colours that were written");
        let short = |format: &Format, palette: &Palette| format.write(palette, "short")[..100].to_vec();
        let group = check(1, &short);
        assert!(group.failures[0].starts_with("f "), "{:?}", group.failures);
    }
}

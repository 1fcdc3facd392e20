//! Palettes made for scenes: whether what is shown has the colours that light, materials, fog and glass give it.
//!
//! The scenes are walls that face the eye more or less, each with one normal, under one sun, so each has one colour,
//! which is computed here from the formulas alone.

use mode13h::Angle;
use mode13h::glam::Vec3;
use mode13h::light::{Blend, Light, Material, RampChoice};
use mode13h::mesh::{Surface, shapes};
use mode13h::palette::cube::CUBE;
use mode13h::palette::{Palette, Ramp, Rgb};
use mode13h::render::Renderer;
use mode13h::scene::{Fog, Object, Scene, Shared};
use mode13h::settings::DitherPattern;
use mode13h::texture::Texture;
use mode13h::vga::Vga;
use mode13h_assets::auto_palette::Entries;
use mode13h_assets::auto_palette::{self, AutomaticPalette};
use mode13h_conformance::Random;

use crate::support::tried::Tried;

/// Direction toward the sun.
const SUN: [f32; 3] = [0.3, 0.5, 0.9];

/// Rounding to 8 bits, and twice to the card's 6: the colour's and the entry's.
const ROUNDING: f64 = 0.5 + 2.0 * 2.03;

type Color = [f64; 3];

/// Twelve walls side by side in these materials, at random angles.
fn walls(random: &mut Random, mut material: impl FnMut(&mut Random) -> Material) -> Scene {
    let mut scene = Scene::new();
    scene.camera.eye = Vec3::new(0.0, 0.0, 10.0);
    for i in 0..12_u8 {
        let mut wall = Object::new(shapes::wall(1, 1));
        wall.position = Vec3::new(f32::from(i % 4) * 2.0 - 3.0, f32::from(i / 4) * 2.0 - 2.0, 0.0);
        wall.scale = 0.9;
        let mut angle = || random.unit() - 0.5;
        wall.angles = [angle(), angle(), 0.0].map(Angle::from_radians);
        wall.materials = vec![material(random)];
        scene.add(wall);
    }
    scene.add_light(Light::sun(SUN));
    scene
}

fn random_material(random: &mut Random) -> Material {
    let mut share = |least: f64, most: f64| (least + (most - least) * random.unit()) as f32;
    Material {
        ambient: share(0.05, 0.3),
        diffuse: share(0.3, 0.7),
        color: [share(0.1, 1.0), share(0.1, 1.0), share(0.0, 1.0)],
        ..Material::default()
    }
}

/// n·l of a wall.
fn cosine(wall: &Object) -> f64 {
    f64::from((wall.rotation() * Vec3::Z).dot(Vec3::from_array(SUN).normalize()).max(0.0))
}

/// What a matt wall shows, 0 to 255.
fn lit(wall: &Object, light: [f32; 3]) -> Color {
    let Material { ambient, diffuse, color, .. } = wall.materials[0];
    [0, 1, 2].map(|i| {
        let body = f64::from(ambient) + f64::from(diffuse) * cosine(wall) * f64::from(light[i]);
        (f64::from(color[i]) * body).min(1.0) * 255.0
    })
}

fn mixed(a: Color, b: Color, share: f64) -> Color {
    [0, 1, 2].map(|i| a[i] * (1.0 - share) + b[i] * share)
}

fn off(a: Color, b: Rgb) -> f64 {
    let b = [b.r, b.g, b.b].map(f64::from);
    (0..3).map(|i| (a[i] - b[i]).abs()).fold(0.0, f64::max)
}

/// The colours shown, and for each pixel the object it shows, if any.
fn shown(scene: &Scene) -> (Vec<Rgb>, Vec<Option<usize>>) {
    let mut vga = Vga::new();
    Renderer::new().draw(scene, &mut vga).expect("a legal scene");
    let palette = vga.palette();
    let colors = vga.pixels().iter().map(|&index| palette[index]).collect();
    let mut numbered = scene.clone();
    numbered.clear_lights();
    (numbered.fog, numbered.palette, numbered.background) = (None, None, 0);
    for (number, object) in (1..).zip(numbered.objects_mut()) {
        let ramp = RampChoice::Entries(Ramp::single(number));
        object.materials.fill(Material { ramp, ..Material::default() });
    }
    Renderer::new().draw(&numbered, &mut vga).expect("a legal scene");
    (colors, vga.pixels().iter().map(|&number| usize::from(number).checked_sub(1)).collect())
}

/// Gives a scene the palette made for it.
fn made(scene: &mut Scene) -> AutomaticPalette {
    let made = auto_palette::of_scene(scene).expect("a legal scene");
    made.apply(scene);
    made
}

/// Checks that every pixel of object i is within `allowed(i)` of `expected(i)`. Counts the pixels, and records the
/// largest difference.
#[track_caller]
fn assert_shown(
    scene: &Scene,
    expected: impl Fn(usize) -> Option<Color>,
    allowed: impl Fn(usize) -> f64,
    tried: &mut Tried,
) {
    let (colors, objects) = shown(scene);
    for (place, (&color, object)) in colors.iter().zip(objects).enumerate() {
        let Some((object, expected)) = object.and_then(|object| Some((object, expected(object)?))) else { continue };
        let (off, allowed) = (off(expected, color), allowed(object));
        assert!(off <= allowed, "object {object} at {place}: {color:?}, expected {expected:?}, off {off}, {allowed}");
        tried.add(1);
        tried.worst("off, in 255ths of a channel", off);
    }
}

/// Half a step of the ramp, on the channel where steps are widest, plus rounding.
fn half_a_step(palette: &Palette, entries: Entries) -> f64 {
    let Entries::Ramp { ramp, .. } = entries else { panic!("{entries:?}") };
    let Rgb { r, g, b } = palette[ramp.last()];
    f64::from(r.max(g).max(b)) / f64::from(ramp.entries() - 1) / 2.0 + ROUNDING
}

#[test]
fn materials_are_shown_in_their_colours() {
    let mut tried = Tried::new("materials_are_shown_in_their_colours", 100_000);
    let mut random = Random::named("materials");
    while tried.more() {
        let mut scene = walls(&mut random, random_material);
        let expected: Vec<Color> = scene.objects().iter().map(|wall| lit(wall, [1.0; 3])).collect();
        let made = made(&mut scene);
        let allowed = |i: usize| half_a_step(&made.palette, made.entries[i][0]);
        assert_shown(&scene, |i| Some(expected[i]), allowed, &mut tried);
        assert!(scene.objects().iter().all(|wall| !wall.materials[0].takes_channels()));
    }
}

/// The model of an MTL file: no material names a colour, the surfaces do.
#[test]
fn surfaces_are_shown_in_their_colours() {
    let mut tried = Tried::new("surfaces_are_shown_in_their_colours", 50_000);
    let mut random = Random::named("surfaces");
    while tried.more() {
        let mut scene = walls(&mut random, random_material);
        let mut expected = Vec::new();
        for wall in scene.objects_mut() {
            let surface = Surface { diffuse: wall.materials[0].color, ..Surface::default() };
            let body = 0.15 + 0.85 * cosine(wall);
            expected.push(surface.diffuse.map(|channel| f64::from(channel) * body * 255.0));
            let mesh = wall.mesh().clone().with_surfaces(vec![surface], vec![0; 2]).expect("one surface");
            let mut new = Object::new(mesh);
            (new.position, new.scale) = (wall.position, wall.scale);
            new.angles = wall.angles;
            *wall = new;
        }
        let mut own = scene.clone();
        let made = made(&mut scene);
        let allowed = |i: usize| half_a_step(&made.palette, made.entries[i][0]);
        assert_shown(&scene, |i| Some(expected[i]), allowed, &mut tried);

        // In a palette without ramps, the nearest entry: the cube's channels are 51 apart.
        own.palette = Some(CUBE.clone());
        for wall in own.objects_mut() {
            wall.materials = vec![wall.materials[0].in_own_colors(&wall.mesh().surfaces()[0])];
        }
        assert_shown(&own, |i| Some(expected[i]), |_| 25.5 + 1.0, &mut tried);
    }
}

/// Textures of one texel: there is room for 16 brightnesses of each of twelve, so each has an entry.
#[test]
fn textures_are_shown_in_their_colours() {
    let mut tried = Tried::new("textures_are_shown_in_their_colours", 20_000);
    let mut random = Random::named("textures");
    while tried.more() {
        let mut scene = walls(&mut random, random_material);
        let mut expected = Vec::new();
        for wall in scene.objects_mut() {
            let texel = Rgb::new(random.within(100, 255) as u8, random.within(100, 255) as u8, 200);
            let [r, g, b] = lit(wall, [1.0; 3]);
            expected.push([r * f64::from(texel.r), g * f64::from(texel.g), b * f64::from(texel.b)].map(|c| c / 255.0));
            wall.materials[0].texture = Some(Shared::new(Texture::plain(texel)));
        }
        let made = made(&mut scene);
        assert!(made.entries.iter().all(|own| matches!(own[..], [Entries::Textures { .. }])));
        // A wall with a single brightness gets entries over a quarter of full light. The tint is rounded to 8 bits.
        let half_a_step = 0.25 * 255.0 / 15.0 / 2.0;
        let allowed = |_| 3.0_f64.sqrt() * (half_a_step + ROUNDING + 0.5);
        assert_shown(&scene, |i| Some(expected[i]), allowed, &mut tried);
    }
}

/// Rounding to 8 bits and to the card's 6, of each part of a mixture and of the mixture; the parts of a sum count in
/// full.
fn rounded(parts: u32) -> f64 {
    f64::from(parts + 1) * (0.5 + 2.03)
}

/// Checks that the palette has each of these colours, within rounding.
#[track_caller]
fn assert_has(palette: &Palette, expected: &[Color], rounding: f64) {
    for &color in expected {
        let off = palette.colors().iter().map(|&entry| off(color, entry)).fold(f64::INFINITY, f64::min);
        assert!(off <= rounding, "{color:?}: the nearest entry is off by {off}");
    }
}

/// How far off a pixel may be whose colour is mixed from others that are off by `parts`, with a palette that has the
/// mixture up to `rounding`: the entry chosen is no farther from the mixture of the parts' own entries than the right
/// one is.
fn nearest_to_mixture(parts: f64, rounding: f64) -> f64 {
    3.0_f64.sqrt() * (rounding + parts) + parts
}

#[test]
fn fog_is_shown_in_its_colours() {
    let mut tried = Tried::new("fog_is_shown_in_its_colours", 50_000);
    let mut random = Random::named("fog");
    while tried.more() {
        let mut scene = walls(&mut random, random_material);
        let haze = Rgb::from(random.next_u64() as u32);
        let fog = Fog { color: haze, start: 8.0, end: 20.0 };
        (scene.fog, scene.background_color) = (Some(fog), Some(haze));
        let mut expected = Vec::new();
        for wall in scene.objects_mut() {
            // All of it is at the same distance.
            wall.angles = [Angle::default(); 3];
            wall.position.z = (random.unit() * 9.0 - 8.0) as f32;
            let level = fog.level(10.0 - f64::from(wall.position.z));
            expected.push(mixed(lit(wall, [1.0; 3]), [haze.r, haze.g, haze.b].map(f64::from), level));
        }
        let made = made(&mut scene);
        assert_has(&made.palette, &expected, rounded(1));
        assert_eq!(made.palette[scene.background], haze.nearest_on_dac());
        let allowed = |i: usize| nearest_to_mixture(half_a_step(&made.palette, made.entries[i][0]), rounded(1));
        assert_shown(&scene, |i| Some(expected[i]), allowed, &mut tried);
    }
}

#[test]
fn what_shines_through_is_shown_in_its_colours() {
    let mut tried = Tried::new("what_shines_through_is_shown_in_its_colours", 50_000);
    let mut random = Random::named("glass");
    while tried.more() {
        let mut scene = walls(&mut random, random_material);
        let mut expected = Vec::new();
        let walls: Vec<Object> = scene.objects().to_vec();
        for (i, mut pane) in walls.into_iter().enumerate() {
            scene.objects_mut()[i].angles = [Angle::default(); 3];
            let wall = &scene.objects()[i];
            // In front of the middle of the wall.
            pane.angles = [Angle::default(); 3];
            (pane.scale, pane.position) = (0.4, wall.position * 0.99 + Vec3::Z * 0.1);
            let opacity = random.within(64, 192) as u8;
            let blend = if i % 2 == 0 { Blend::Mix(opacity) } else { Blend::Add };
            pane.materials = vec![Material { blend, ..random_material(&mut random) }];
            let (behind, own) = (lit(wall, [1.0; 3]), lit(&pane, [1.0; 3]));
            expected.push(match blend {
                Blend::Mix(opacity) => mixed(behind, own, f64::from(opacity) / 255.0),
                _ => [0, 1, 2].map(|i| (behind[i] + own[i]).min(255.0)),
            });
            scene.add(pane);
        }
        let made = made(&mut scene);
        assert_has(&made.palette, &expected, rounded(2));
        let half_a_step = |i: usize| half_a_step(&made.palette, made.entries[i][0]);
        // For the panes alone; in a sum both parts count in full.
        let allowed = |i: usize| nearest_to_mixture(half_a_step(i) + half_a_step(i - 12), rounded(2));
        let of = |i: usize| i.checked_sub(12).map(|pane| expected[pane]);
        assert_shown(&scene, of, allowed, &mut tried);
    }
}

#[test]
fn colored_light_is_shown_in_its_colours() {
    let mut tried = Tried::new("colored_light_is_shown_in_its_colours", 50_000);
    let mut random = Random::named("light");
    while tried.more() {
        let mut scene = walls(&mut random, random_material);
        let light = [random.unit() as f32, random.unit() as f32, 0.5];
        scene.lights_mut()[0] = Light::sun(SUN).with_color(light);
        let expected: Vec<Color> = scene.objects().iter().map(|wall| lit(wall, light)).collect();
        let made = made(&mut scene);
        assert_has(&made.palette, &expected, rounded(0));
        for (own, wall) in made.entries.iter().zip(scene.objects()) {
            assert!(matches!(own[..], [Entries::Textures { .. }]));
            assert_eq!(wall.materials[0].ramp, RampChoice::Nearest);
        }
        // The nearest of a box of 8 in each channel: within half of that.
        assert_shown(&scene, |i| Some(expected[i]), |_| nearest_to_mixture(4.0 + 1.0, rounded(0)), &mut tried);
    }
}

/// The sun is behind the eye and mirrored into it: ambient, diffuse and specular light are all full.
#[test]
fn highlights_are_shown_in_their_colours() {
    let mut tried = Tried::new("highlights_are_shown_in_their_colours", 200);
    let mut random = Random::named("highlights");
    while tried.more() {
        let mut scene = walls(&mut random, |random| Material {
            specular: 0.1 + 0.4 * random.unit() as f32,
            shininess: 8.0,
            highlight: [1.0, random.unit() as f32, random.unit() as f32],
            ..random_material(random)
        });
        // Where it is visible, it is seen straight on.
        scene.lights_mut()[0] = Light::sun([0.0, 0.0, 1.0]);
        scene.objects_mut()[0].angles = [Angle::default(); 3];
        scene.objects_mut()[0].position = Vec3::Z;
        let material = scene.objects()[0].materials[0].clone();
        let expected = [0, 1, 2].map(|i| {
            let body = material.color[i] * (material.ambient + material.diffuse);
            f64::from((body + material.highlight[i] * material.specular).min(1.0)) * 255.0
        });
        scene.settings.accuracy = Some(mode13h::settings::Shading::Phong.into());
        let middle = 100 * Vga::WIDTH + 160;
        let mut own = scene.clone();
        let made = made(&mut scene);
        let (colors, objects) = shown(&scene);
        assert_eq!(objects[middle], Some(0));
        // The pixel's centre is half a pixel from where the light is full; it fades by 8 times the square of that.
        let allowed = half_a_step(&made.palette, made.entries[0][0]) + 1.0;
        assert!(off(expected, colors[middle]) <= allowed, "{:?}, expected {expected:?}", colors[middle]);
        own.palette = Some(CUBE.clone());
        let (colors, _) = shown(&own);
        assert!(off(expected, colors[middle]) <= 25.5 + 2.0, "{:?}, expected {expected:?}", colors[middle]);
    }
}

/// A surface that is never visible during a loop is not measured; one that becomes visible later in it is.
#[test]
fn a_loop_is_seen_and_not_its_beginning() {
    let mut random = Random::named("round");
    let mut scene = walls(&mut random, random_material);
    let id = scene.add(Object::new(shapes::sphere(16, 8)));
    scene[id].position = Vec3::new(0.0, 100.0, 0.0);
    let unseen = auto_palette::seen(&scene).expect("a scene");
    assert_eq!(unseen[12][0].area, 0.0);
    let path = mode13h::scene::Path::Line { from: Vec3::Y * 100.0, to: Vec3::ZERO, period: 4.0, back: true };
    scene.motions.push(mode13h::scene::Motion::Path { what: mode13h::scene::Moving::Object(id), path });
    let seen = auto_palette::seen(&scene).expect("a scene");
    assert!(seen[12][0].area > 0.01 && seen[12][0].brightest > 0.9, "{:?}", seen[12]);
    let all: f32 = seen.iter().flatten().map(|seen| seen.area).sum();
    assert!((all - 1.0).abs() < 1e-5);
    // Intensities are measured whatever the scene is drawn with.
    scene.settings.channels = Some(true);
    assert_eq!(auto_palette::seen(&scene).expect("a scene"), seen);
}

/// Surfaces seen for a part of each loop of a motion are seen by the palette, too, however many there are.
#[test]
fn a_loop_is_seen_whatever_moves_how_often_in_it() {
    use mode13h::mesh::Mesh;
    use mode13h::scene::{Motion, Moving, Path};

    let seen = |mesh: Mesh, motion: &dyn Fn(mode13h::scene::ObjectId, f64) -> Motion| {
        let mut scene = Scene::new();
        let id = scene.add(Object::new(mesh));
        let motion = motion(id, scene.duration);
        scene.motions.push(motion);
        auto_palette::seen(&scene).expect("a scene")[0][0].area > 0.0
    };
    for rounds in [1.0, 2.0, 7.0, 8.0, 15.0, 16.0, 24.0, 32.0, 272.0, 1000.0, 1e9] {
        // In sight about a quarter of the way down.
        let path = |id, duration| Motion::Path {
            what: Moving::Object(id),
            path: Path::Line { from: Vec3::Y * 8.0, to: Vec3::Y * -24.0, period: duration / rounds, back: false },
        };
        assert!(seen(shapes::sphere(16, 8), &path), "{rounds} times along a path");
        // Edge-on at the beginning and after half a turn.
        let sheet = shapes::wall(1, 1);
        let start = [0.0, 90.0, 0.0].map(mode13h::Angle::from_degrees);
        let spin = |object, duration: f64| Motion::Spin { object, start, turns: [0.0, -rounds / duration, 0.0] };
        assert!(seen(sheet, &spin), "{rounds} turns");
    }
}

/// A distant image of two colours shows their mean, and so the palette made for it contains that.
#[test]
fn an_automatic_palette_has_the_colours_of_mipmaps() {
    use mode13h::scene::Shared;
    use mode13h::texture::Texture;

    let (red, green) = (Rgb::new(255, 0, 0), Rgb::new(0, 255, 0));
    let texture = Texture::from_rgb(2, 2, &[red, green, green, red]).expect("a texture");
    let mut scene = crate::support::scenes::floor("checker", 24.0 * 32.0);
    scene.objects_mut()[0].materials[0].texture = Some(Shared::new(texture));
    let farthest = |scene: &Scene| {
        let palette = auto_palette::of_scene(scene).expect("a legal scene").palette.on_dac();
        let mean = Rgb::new(128, 128, 0);
        palette[palette.nearest(mean)].distance_squared(mean)
    };
    // A level of the DAC is 4 units, and three channels may be off by one level.
    assert!(farthest(&scene) <= 3 * 16, "{}", farthest(&scene));
    scene.settings.mipmaps = Some(false);
    assert!(farthest(&scene) > 3 * 64 * 64, "{}", farthest(&scene));
}

/// With a palette of few colours and no ramps, a material that names a ramp is drawn in the nearest entries, dithered.
#[test]
fn a_palette_without_ramps_means_the_nearest_entries_dithered() {
    let mut colors = [Rgb::BLACK; 256];
    let rgb = |color: u32| Rgb::new((color >> 16) as u8, (color >> 8) as u8, color as u8);
    let ega = [0x0000aa, 0x00aa00, 0x00aaaa, 0xaa0000, 0xaa00aa, 0xaa5500, 0xaaaaaa, 0x555555, 0xffffff];
    ega.iter().zip(&mut colors[1..]).for_each(|(color, entry)| *entry = rgb(*color));
    let palette = Palette::from_colors(colors);
    assert_eq!(palette.ramps(), 0);
    let yellow = Surface { diffuse: [0.9, 0.8, 0.1], ..Surface::default() };
    for surface in [Surface::default(), yellow] {
        let torus = shapes::torus(24, 12);
        let faces = torus.triangles().len();
        let mut scene = Scene::showing(torus.with_surfaces(vec![surface.clone()], vec![0; faces]).expect("a surface"));
        scene.palette = Some(palette.clone());
        let draw = |scene: &Scene| {
            let mut vga = Vga::new();
            Renderer::new().draw(scene, &mut vga).expect("a legal scene");
            vga.pixels().to_vec()
        };
        let bytes = draw(&scene);
        let used: std::collections::BTreeSet<u8> = bytes.iter().copied().collect();
        assert!(used.len() > 3 && used.iter().all(|entry| *entry < 10), "{used:?}");
        let material = &mut scene.objects_mut()[0].materials[0];
        *material = material.in_own_colors(&surface);
        assert_eq!(material.ramp, RampChoice::Nearest);
        scene.settings.dither = Some(DitherPattern::Ordered);
        assert!(draw(&scene) == bytes, "as asked for by hand");
    }
}

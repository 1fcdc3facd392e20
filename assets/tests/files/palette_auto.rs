//! Palettes made for what will be visible: how entries are shared out, and what is visible of a model.

use mode13h::Angle;
use mode13h::glam::Vec3;
use mode13h::light::{Light, RampChoice};
use mode13h::mesh::{Mesh, Surface, shapes};
use mode13h::palette::{NearestColors, Palette, Ramp, Rgb, builtin};
use mode13h::render::Renderer;
use mode13h::scene::{Camera, Motion, Object, ObjectId, Scene, UpAxis};
use mode13h::texture::Texture;
use mode13h::vga::Vga;
use mode13h_assets::auto_palette::{self, Seen, seen};
use mode13h_assets::auto_palette::{Automatic, Entries, Use, share};
use mode13h_conformance::Random;

use crate::support::tried::Tried;

fn random_color(random: &mut Random) -> Rgb {
    Rgb::from(random.next_u64() as u32)
}

fn matt(color: Rgb, area: f32) -> Use<'static> {
    Use { color, highlight: None, area, darkest: 0.15, brightest: 1.0, texels: None, along: None }
}

fn random_use(random: &mut Random) -> Use<'static> {
    let color = random_color(random);
    Use {
        color,
        highlight: (random.unit() < 0.3).then(|| color.saturating_add(random_color(random))),
        area: (random.unit() * random.unit()) as f32,
        darkest: random.unit() as f32,
        brightest: random.unit() as f32,
        texels: None,
        along: None,
    }
}

#[track_caller]
fn ramp(entries: Entries) -> Ramp {
    match entries {
        Entries::Ramp { ramp, .. } => ramp,
        other => panic!("{other:?}"),
    }
}

fn block(automatic: &Automatic) -> Option<Ramp> {
    automatic.entries.iter().find_map(|entries| match entries {
        Entries::Textures { block } => Some(*block),
        _ => None,
    })
}

/// The different ramps, in the order of their entries.
fn ramps(automatic: &Automatic) -> Vec<Ramp> {
    let is_ramp = |entries: &&Entries| matches!(entries, Entries::Ramp { .. });
    let mut ramps: Vec<Ramp> = automatic.entries.iter().filter(is_ramp).map(|entries| ramp(*entries)).collect();
    ramps.sort_by_key(|ramp| (ramp.first(), ramp.entries()));
    ramps.dedup();
    ramps
}

/// Properties of every automatic palette, whatever it was made for.
#[track_caller]
fn assert_sound(uses: &[Use<'_>], automatic: &Automatic) {
    let palette = &automatic.palette;
    assert_eq!(automatic.entries.len(), uses.len());
    assert_eq!((palette[0], palette[255]), (Rgb::BLACK, Rgb::WHITE));
    assert_eq!(palette.on_dac().colors(), palette.colors(), "colours that the card shows exactly");
    assert_eq!(palette.ramps(), 0);
    let mut taken = [false; 256];
    (taken[0], taken[255]) = (true, true);
    let has_texels = uses.iter().any(|of| of.texels.is_some_and(|texels| texels.iter().any(|(_, count)| *count > 0)));
    for ramp in ramps(automatic).into_iter().chain(block(automatic).filter(|_| has_texels)) {
        for entry in ramp.range() {
            assert!(!taken[usize::from(entry)], "entry {entry} twice");
            taken[usize::from(entry)] = true;
        }
    }
    for (of, entries) in uses.iter().zip(&automatic.entries) {
        assert_eq!(of.texels.is_some(), matches!(entries, Entries::Textures { .. }));
        if let Entries::Ramp { ramp, full_light } = entries {
            assert_eq!(palette[ramp.first()], Rgb::BLACK);
            assert!((0.0..=1.0).contains(full_light));
            let rises = |a: u8, b: u8| palette[a].brightness() <= palette[b].brightness();
            assert!((ramp.first()..ramp.last()).all(|i| rises(i, i + 1)), "{ramp:?}");
        }
    }
}

// Ramps

#[test]
fn p2_automatic_ramps_share_no_entry() {
    let mut tried = Tried::new("p2_automatic_ramps_share_no_entry", 400);
    let mut random = Random::named("p2_automatic");
    let texels: Vec<(Rgb, u32)> = (0..256).map(|i| (random_color(&mut random), i % 7)).collect();
    while tried.more() {
        let count = random.log_uniform(9);
        let mut uses: Vec<Use<'_>> = (0..count).map(|_| random_use(&mut random)).collect();
        if random.unit() < 0.5 {
            let textured = random.within(0, count as i64 - 1) as usize;
            uses[textured].texels = Some(&texels);
        }
        let automatic = share(&uses);
        assert_sound(&uses, &automatic);
        // At least four entries, unless the card shows fewer colours between black and the ramp's last.
        for ramp in ramps(&automatic).into_iter().filter(|ramp| ramp.entries() < 4) {
            let [r, g, b] = automatic.palette[ramp.last()].to_dac();
            assert!(u16::from(r.max(g).max(b)) < ramp.entries(), "{ramp:?}");
        }
    }
}

/// Entry i of a matt material's ramp of n is its colour at i/(n − 1): in exact fractions to 8 bits, then to the nearest
/// that the card shows.
#[test]
fn a_ramp_runs_from_black_to_the_colour_in_full_light() {
    let mut tried = Tried::new("a_ramp_runs_from_black_to_the_colour_in_full_light", 300);
    let mut random = Random::named("ramp");
    while tried.more() {
        let uses: Vec<_> = (0..random.within(1, 20)).map(|_| matt(random_color(&mut random), 1.0)).collect();
        let automatic = share(&uses);
        for (of, entries) in uses.iter().zip(&automatic.entries) {
            let Entries::Ramp { ramp, full_light } = *entries else { panic!("{entries:?}") };
            assert_eq!(full_light, 1.0);
            let steps = u32::from(ramp.entries()) - 1;
            // The material's colour is rounded to the nearest that the card shows, too.
            let full = of.color.nearest_on_dac();
            for i in 0..=steps {
                let at = |v: u8| ((2 * u32::from(v) * i + steps) / (2 * steps)) as u8;
                let expected = Rgb::new(at(full.r), at(full.g), at(full.b)).nearest_on_dac();
                assert_eq!(automatic.palette[ramp.index(i as u16)], expected, "{of:?}, {i} of {steps}");
            }
        }
    }
}

/// The two lines of a ramp with a highlight meet in the material's own colour, at `full_light`; the steps before and
/// after it are equally wide.
#[test]
fn a_highlight_goes_on_from_the_colour_at_the_same_pace() {
    let mut tried = Tried::new("a_highlight_goes_on_from_the_colour_at_the_same_pace", 300);
    let mut random = Random::named("highlight");
    while tried.more() {
        let of = Use { highlight: Some(Rgb::WHITE), ..matt(random_color(&mut random), 1.0) };
        let automatic = share(&[of]);
        let Entries::Ramp { ramp, full_light } = automatic.entries[0] else { panic!("a ramp") };
        assert_eq!(automatic.palette[ramp.last()], Rgb::WHITE);
        let distance = |a: Rgb, b: Rgb| f64::from(a.distance_squared(b)).sqrt();
        let (up, on) = (distance(Rgb::BLACK, of.color), distance(of.color, Rgb::WHITE));
        let share = up / (up + on);
        // Half a 255th of rounding, and each of the two lengths off by what the card rounds: 2 per channel.
        let rounding = 2.0 * 3_f64.sqrt();
        assert!((f64::from(full_light) - share).abs() <= 0.5 / 255.0 + 2.0 * rounding / (up + on), "{of:?}");
        let step = (up + on) / f64::from(ramp.entries() - 1);
        let nearest = (f64::from(full_light) * f64::from(ramp.entries() - 1)).round() as u16;
        let off = distance(automatic.palette[ramp.index(nearest)], of.color);
        // Half a step, a 255th of the length, and three roundings: the colour's own, to 8 and to 6 bits.
        assert!(off <= step / 2.0 + (up + on) / 510.0 + 3.0 * rounding, "{of:?}: off by {off}");
    }
}

// How entries are shared out

/// Σ area·length²/(12·(n − 1)²).
fn cost(uses: &[Use<'_>], entries: &[u16]) -> f64 {
    let one = |(of, n): (&Use<'_>, &u16)| {
        let length = f64::from(of.color.distance_squared(Rgb::BLACK)).sqrt();
        let seen = f64::from(of.brightest) - f64::from(of.darkest);
        f64::from(of.area) * (length * seen).powi(2) / (12.0 * f64::from(n - 1).powi(2))
    };
    uses.iter().zip(entries).map(one).sum()
}

/// Three materials whose ramps hold more colours than there is room for: no other way to share the 254 entries costs
/// less.
#[test]
fn no_other_shares_cost_less() {
    let mut tried = Tried::new("no_other_shares_cost_less", 20);
    let mut random = Random::named("cost");
    while tried.more() {
        // Each has 121 to 124 colours that the card can show, since their channels step at different places.
        let colors = [Rgb::from_dac([63, 40, 22]), Rgb::from_dac([23, 63, 41]), Rgb::from_dac([41, 22, 63])];
        let uses = colors.map(|color| Use {
            area: 1.0 + 0.4 * random.unit() as f32,
            darkest: 0.2 * random.unit() as f32,
            brightest: 1.0 - 0.2 * random.unit() as f32,
            ..matt(color, 0.0)
        });
        let automatic = share(&uses);
        let given: Vec<u16> = automatic.entries.iter().map(|entries| ramp(*entries).entries()).collect();
        assert_eq!(given.iter().sum::<u16>(), 254);
        let own = cost(&uses, &given);
        for a in 4..=246 {
            for b in 4..=250 - a {
                let other = cost(&uses, &[a, b, 254 - a - b]);
                // Equal up to the rounding of a few sums.
                assert!(own <= other * (1.0 + 1e-12), "{given:?} cost {own}, {a}, {b} and the rest {other}");
            }
        }
    }
}

#[test]
fn more_area_or_range_is_never_fewer_entries() {
    let mut tried = Tried::new("more_area_or_range_is_never_fewer_entries", 300);
    let mut random = Random::named("monotone");
    while tried.more() {
        let mut uses: Vec<_> = (0..random.within(2, 30)).map(|_| matt(random_color(&mut random), 1.0)).collect();
        for of in &mut uses {
            of.area = 0.1 + random.unit() as f32;
            of.brightest = 0.5 + 0.25 * random.unit() as f32;
        }
        let before = ramp(share(&uses).entries[0]).entries();
        uses[0].area *= 3.0;
        let larger = ramp(share(&uses).entries[0]).entries();
        uses[0].brightest = 1.0;
        let wider = ramp(share(&uses).entries[0]).entries();
        assert!(before <= larger && larger <= wider, "{before}, {larger}, {wider}");
    }
}

/// A dark material has few colours on the card: entries that it cannot use go to the others.
#[test]
fn entries_that_would_look_alike_go_to_others() {
    let dark = matt(Rgb::from_dac([5, 0, 0]), 1000.0);
    let light = [[63, 40, 22], [23, 63, 41], [41, 22, 63]].map(|six| matt(Rgb::from_dac(six), 1.0));
    let automatic = share(&[dark, light[0], light[1], light[2]]);
    let given = |i: usize| ramp(automatic.entries[i]);
    let mut colors: Vec<Rgb> = given(0).range().map(|i| automatic.palette[i]).collect();
    colors.dedup();
    assert_eq!((given(0).entries(), colors.len()), (6, 6), "as many as it has colours");
    assert_eq!((1..4).map(|i| given(i).entries()).sum::<u16>(), 248);
    // Alone it gets all the room, as nothing else competes for it.
    let alone = share(&[dark]);
    assert_eq!(ramp(alone.entries[0]).entries(), 254);
    // Black has one colour.
    let black = share(&[matt(Rgb::BLACK, 9.0), light[0], light[1], light[2]]);
    assert_eq!(ramp(black.entries[0]).entries(), 1);
}

#[test]
fn what_is_never_in_sight_has_a_colour() {
    let red = Rgb::from_dac([63, 0, 0]);
    let light = [[63, 40, 22], [23, 63, 41], [41, 22, 63]].map(|six| matt(Rgb::from_dac(six), 1.0));
    let automatic = share(&[matt(red, 0.0), light[0], light[1], light[2]]);
    let hidden = ramp(automatic.entries[0]);
    assert_eq!((hidden.entries(), automatic.palette[hidden.last()]), (4, red));
    let nothing_seen = share(&[matt(Rgb::WHITE, 0.0), matt(red, 0.0)]);
    assert_eq!(nothing_seen.palette[ramp(nothing_seen.entries[1]).last()], red);
}

// More materials than room

#[test]
fn the_materials_without_a_ramp_share_the_nearest() {
    let mut tried = Tried::new("the_materials_without_a_ramp_share_the_nearest", 64 + 200 + 256 + 1000);
    let mut random = Random::named("nearest");
    for count in [64, 200, 256, 1000] {
        let uses: Vec<_> = (0..count).map(|_| matt(random_color(&mut random), random.unit() as f32)).collect();
        let automatic = share(&uses);
        assert_sound(&uses, &automatic);
        assert_eq!(ramps(&automatic).len(), 63);
        for (of, own) in uses.iter().zip(&automatic.entries) {
            // A matt ramp ends in the colour it was made for.
            let color = of.color.nearest_on_dac();
            let off = |ramp: Ramp| automatic.palette[ramp.last()].distance_squared(color);
            let least = ramps(&automatic).into_iter().map(off).min();
            assert_eq!(Some(off(ramp(*own))), least, "{of:?}");
            tried.add(1);
        }
    }
}

#[test]
fn materials_of_one_colour_share_a_ramp() {
    let mut random = Random::named("same");
    let few: Vec<Rgb> = (0..10).map(|_| random_color(&mut random)).collect();
    let uses: Vec<Use<'_>> = (0..65_536).map(|i| matt(few[i % 10], 1.0)).collect();
    let automatic = share(&uses);
    assert_eq!(ramps(&automatic).len(), 10);
    for (i, entries) in automatic.entries.iter().enumerate() {
        assert_eq!(entries, &automatic.entries[i % 10]);
    }
}

/// A small material with a unique colour loses more without a ramp than the hundredth shade of what covers the picture.
#[test]
fn a_rare_colour_is_kept() {
    let mut uses: Vec<Use<'_>> = (0..200).map(|i| matt(Rgb::new(20 + i, 140, 30), 1.0)).collect();
    uses.push(matt(Rgb::from_dac([50, 0, 63]), 0.01));
    let automatic = share(&uses);
    assert_eq!(automatic.palette[ramp(automatic.entries[200]).last()], Rgb::from_dac([50, 0, 63]));
}

#[test]
fn anything_may_be_asked_for() {
    let mut tried = Tried::new("anything_may_be_asked_for", 300);
    let mut random = Random::named("anything");
    let odd = [0.0, -1.0, 1.0, f32::NAN, f32::INFINITY, f32::NEG_INFINITY, f32::MAX, f32::MIN_POSITIVE, 0.5];
    let texels = [(Rgb::WHITE, u32::MAX), (Rgb::BLACK, u32::MAX), (Rgb::new(9, 99, 199), 1)];
    let texels: [&[(Rgb, u32)]; 4] = [&[], &[(Rgb::WHITE, 0)], &texels, &[(Rgb::BLACK, 1)]];
    assert_sound(&[], &share(&[]));
    while tried.more() {
        let uses: Vec<Use<'_>> = (0..random.within(1, 90))
            .map(|_| Use {
                color: random.one_of(&[Rgb::BLACK, Rgb::WHITE, Rgb::new(1, 2, 3), Rgb::new(255, 0, 0)]),
                highlight: random.one_of(&[None, Some(Rgb::WHITE), Some(Rgb::new(255, 0, 0))]),
                area: random.one_of(&odd),
                darkest: random.one_of(&odd),
                brightest: random.one_of(&odd),
                texels: (random.unit() < 0.2).then(|| random.one_of(&texels)),
                along: None,
            })
            .map(|of| Use { highlight: of.highlight.map(|light| light.saturating_add(of.color)), ..of })
            .collect();
        assert_sound(&uses, &share(&uses));
    }
}

// Textures

/// The mean squared distance between texels in all lights that occur and the entries that represent them.
fn off(palette: &Palette, texels: &[(Rgb, u32)], darkest: u8, brightest: u8) -> f64 {
    let search = NearestColors::of_shown(palette);
    let shown = palette.on_dac();
    let (mut sum, mut weight) = (0.0, 0.0);
    for shade in darkest..=brightest {
        for &(color, count) in texels {
            let wanted = Rgb::BLACK.mix(color, shade);
            sum += f64::from(count) * f64::from(wanted.distance_squared(shown[search.nearest(wanted)]));
            weight += f64::from(count);
        }
    }
    sum / weight
}

#[test]
fn textures_are_shown_better_than_in_any_palette_made_for_all() {
    for name in ["crate", "bricks", "sky"] {
        let texture = name.parse::<Texture>().expect("built in");
        let texels: Vec<(Rgb, u32)> = texture.colors().iter().copied().zip(texture.histogram()).collect();
        let of = Use { texels: Some(&texels), ..matt(Rgb::WHITE, 1.0) };
        let automatic = share(&[of]);
        assert_sound(&[of], &automatic);
        let own = off(&automatic.palette, &texels, 38, 255);
        // Rounding to the card's 64 levels alone is off by a twelfth of 4.05² in each channel.
        println!("{name}: {own:.1}; no less than {:.1} with all colours of the card", 3.0 * 4.05 * 4.05 / 12.0);
        for other in &builtin::ALL {
            let others = off(other.palette, &texels, 38, 255);
            println!("    in {}: {others:.1}", other.name);
            assert!(own < others / 4.0, "{name} in {}: {own} against {others}", other.name);
        }
    }
}

#[test]
fn a_texture_of_few_colours_leaves_the_rest_to_the_ramps() {
    let grass = matt(Rgb::from_dac([10, 40, 8]), 0.5);
    let texels = [(Rgb::from_dac([60, 20, 10]), 10)];
    let automatic = share(&[grass, Use { texels: Some(&texels), ..grass }]);
    let (ramp, block) = (ramp(automatic.entries[0]), block(&automatic).expect("a block"));
    // No duplicate colours, and none that the ramp has.
    let mut colors: Vec<Rgb> = block.range().map(|i| automatic.palette[i]).collect();
    let count = colors.len();
    colors.sort();
    colors.dedup();
    assert_eq!(colors.len(), count);
    assert!(ramp.range().all(|i| !colors.contains(&automatic.palette[i])));
    assert!(u32::from(ramp.entries()) + u32::from(block.entries()) <= 254);
    // 16 brightnesses are considered; all of them are there, as there is room.
    assert!((12..=16).contains(&count), "{count}");
}

// What is seen

/// A model that turns once around its upward axis, leaning toward the eye.
fn turning(object: Object) -> (Scene, ObjectId) {
    let mut scene = Scene::new();
    let id = scene.add(object.centred());
    scene.camera = Camera::framing(Vec3::ZERO, scene[id].mesh().bounds().radius);
    scene.add_light(Light::sun([0.4, 0.6, 1.0]));
    scene.motions.push(Motion::Spin {
        object: id,
        start: [0.35, 0.0, 0.0].map(Angle::from_radians),
        turns: [0.0, 0.25, 0.0],
    });
    (scene, id)
}

fn seen_turning(mesh: Mesh, up_axis: UpAxis) -> Vec<Seen> {
    let mut object = Object::new(mesh);
    object.up_axis = up_axis;
    seen(&turning(object).0).expect("a mesh").remove(0)
}

/// `mesh` with `surfaces` surfaces, where face i has surface `number(i)`.
fn numbered(mesh: &Mesh, surfaces: usize, number: impl Fn(usize) -> usize) -> Mesh {
    let numbers = (0..mesh.triangles().len()).map(|i| number(i) as u16).collect();
    mesh.clone().with_surfaces(vec![Surface::default(); surfaces], numbers).expect("numbers below")
}

/// Surfaces counted by one, two or three bytes of their numbers add up to what the same faces give when counted as ten
/// surfaces.
#[test]
fn any_number_of_surfaces_is_counted() {
    let mut tried = Tried::new("any_number_of_surfaces_is_counted", 250 + 260 + 1000 + 1024);
    let mesh = shapes::torus(48, 24);
    // This many numbers, this far apart, out of this many.
    for (count, apart, surfaces) in [(250, 1, 250), (260, 1, 260), (1000, 1, 1000), (1024, 64, 65_536)] {
        let of_ten = seen_turning(numbered(&mesh, 10, |i| i % count % 10), UpAxis::Y);
        let each = seen_turning(numbered(&mesh, surfaces, |i| i % count * apart + apart - 1), UpAxis::Y);
        let one_by_one: Vec<Seen> = each.iter().skip(apart - 1).step_by(apart).copied().collect();
        assert_eq!(one_by_one.len(), count);
        for (i, whole) in of_ten.iter().enumerate() {
            let parts: Vec<&Seen> = one_by_one.iter().skip(i).step_by(10).collect();
            let area: f64 = parts.iter().map(|part| f64::from(part.area)).sum();
            // Each of a hundred parts, and the whole, is rounded to f32.
            assert!((area - f64::from(whole.area)).abs() < 1e-6, "{area}, {whole:?}");
            let in_sight = || parts.iter().filter(|part| part.area > 0.0);
            let darkest = in_sight().map(|part| part.darkest).fold(1.0, f32::min);
            let brightest = in_sight().map(|part| part.brightest).fold(0.0, f32::max);
            assert_eq!((darkest, brightest), (whole.darkest, whole.brightest));
            tried.add(parts.len() as u64);
        }
        let all: f64 = of_ten.iter().map(|seen| f64::from(seen.area)).sum();
        assert!((all - 1.0).abs() < 1e-6);
    }
}

/// Two meshes in one, with the second's surfaces after those of the first.
fn joined(a: &Mesh, b: &Mesh) -> Mesh {
    let count = a.positions().len() as u32;
    let positions = [a.positions(), b.positions()].concat();
    let normals = [a.normals(), b.normals()].concat();
    let mut triangles = a.triangles().to_vec();
    triangles.extend(b.triangles().iter().map(|triangle| triangle.map(|i| i + count)));
    let mut surfaces = vec![0; a.triangles().len()];
    surfaces.resize(triangles.len(), 1);
    let mesh = Mesh::with_normals(positions, normals, triangles).expect("a mesh");
    mesh.with_surfaces(vec![Surface::default(); 2], surfaces).expect("two surfaces")
}

fn scaled(mesh: &Mesh, by: f32) -> Mesh {
    let positions = mesh.positions().iter().map(|&p| p * by).collect();
    Mesh::with_normals(positions, mesh.normals().to_vec(), mesh.triangles().to_vec()).expect("a mesh")
}

#[test]
fn what_is_hidden_is_not_seen() {
    let sphere = shapes::sphere(32, 16);
    let within = joined(&sphere, &scaled(&sphere, 0.5));
    let [outer, inner] = seen_turning(within, UpAxis::Y)[..] else { panic!("two") };
    assert_eq!((outer.area, inner.area), (1.0, 0.0));
    assert_eq!((inner.darkest, inner.brightest), (0.0, 0.0));
    // Lit from the upper right behind the eye, so that the sphere's darkest and brightest spots are visible.
    assert!((0.14..0.16).contains(&outer.darkest) && outer.brightest > 0.99, "{outer:?}");
}

/// A level floor leans toward the eye by 0.35 whatever the turn: its intensity is that of its normal.
#[test]
fn a_floor_has_one_brightness() {
    let corners = [[-1.0, 0.0, 1.0], [1.0, 0.0, 1.0], [1.0, 0.0, -1.0], [-1.0, 0.0, -1.0]];
    let up = |axis: UpAxis| {
        corners.map(|[x, y, z]| if axis == UpAxis::Z { Vec3::new(x, -z, y) } else { Vec3::new(x, y, z) })
    };
    for axis in [UpAxis::Y, UpAxis::Z] {
        let mesh = Mesh::new(up(axis).to_vec(), vec![[0, 1, 2], [0, 2, 3]]).expect("a mesh");
        let [floor] = seen_turning(mesh, axis)[..] else { panic!("one") };
        let (sine, cosine) = 0.35_f64.sin_cos();
        let expected = 0.15 + 0.85 * (0.6 * cosine + 1.0 * sine) / (0.16_f64 + 0.36 + 1.0).sqrt();
        // Half a shade of 255, and f32.
        assert!((f64::from(floor.darkest) - expected).abs() < 0.51 / 255.0, "{floor:?}, {expected}");
        assert_eq!((floor.darkest, floor.area), (floor.brightest, 1.0));
    }
}

// All together

#[test]
fn p2_no_pixel_has_an_index_of_another_ramp() {
    let mut tried = Tried::new("p2_no_pixel_has_an_index_of_another_ramp", 4 * 5_000);
    let mesh = numbered(&shapes::torus(48, 24), 12, |i| i % 12);
    let surfaces: Vec<Surface> = (0..12_u8)
        .map(|i| Surface {
            diffuse: [f32::from(i % 3) * 0.4 + 0.1, f32::from(i % 4) * 0.3, f32::from(i) / 12.0],
            specular: if i % 5 == 0 { [0.7; 3] } else { [0.0; 3] },
            shininess: 30.0,
            ..Surface::default()
        })
        .collect();
    let mesh = mesh.clone().with_surfaces(surfaces, mesh.triangle_surfaces().to_vec()).expect("as many");
    let (mut scene, id) = turning(Object::new(mesh));
    let made = auto_palette::of_scene(&scene).expect("a scene");
    scene.motions.clear();
    made.apply(&mut scene);
    let materials = scene[id].materials.clone();
    let (mut renderer, mut vga) = (Renderer::new(), Vga::new());
    for turn in 0..4 {
        scene[id].angles = [0.35, f64::from(turn), 0.0].map(Angle::from_radians);
        for (number, material) in (1..).zip(&mut scene[id].materials) {
            material.ramp = RampChoice::Entries(Ramp::single(number));
        }
        renderer.draw(&scene, &mut vga).expect("a scene");
        let numbers = vga.pixels().to_vec();
        scene[id].materials.clone_from(&materials);
        for material in &mut scene[id].materials {
            // Brighter than white in places.
            (material.ambient, material.diffuse) = (0.1, 1.5);
        }
        renderer.draw(&scene, &mut vga).expect("a scene");
        for (&number, &pixel) in numbers.iter().zip(vga.pixels()).filter(|(number, _)| **number > 0) {
            let ramp = ramp(made.entries[0][usize::from(number) - 1]);
            assert!(ramp.contains(pixel), "surface {number} has entry {pixel}");
            tried.add(1);
        }
    }
}

#[test]
fn the_house_has_two_ramps_and_bricks() {
    let folder = crate::support::workspace::root().join("tests/data");
    let house = mode13h_assets::model_file::load(folder.join("house.obj")).expect("a model");
    assert!(house.warnings.is_empty(), "{:?}", house.warnings);
    let surfaces = house.mesh.surfaces().to_vec();
    let names: Vec<&str> = surfaces.iter().map(|surface| &*surface.name).collect();
    assert_eq!(names, ["grass", "bricks", "tiles"]);
    let bricks = mode13h_assets::texture::load(surfaces[1].texture.as_ref().expect("a texture")).expect("a picture");
    let mut object = Object::new(house.mesh);
    let bricks = mode13h::scene::Shared::new(bricks);
    object.materials[1] = object.materials[1].clone().with_map(&surfaces[1], &bricks);
    let made = auto_palette::of_scene(&turning(object).0).expect("a mesh");
    let [grass, walls, tiles] = made.entries[0][..] else { panic!("three") };
    let color = |entries, place: f32| {
        let ramp = ramp(entries);
        made.palette[ramp.index((place * f32::from(ramp.entries() - 1)).round() as u16)]
    };
    assert_eq!(color(grass, 1.0), surfaces[0].color().nearest_on_dac());
    let Entries::Ramp { full_light, .. } = tiles else { panic!("a ramp") };
    assert!(full_light < 0.6 && color(tiles, full_light).distance_squared(surfaces[2].color()) < 6 * 6);
    assert_eq!(color(tiles, 1.0), surfaces[2].highlight().expect("a highlight").nearest_on_dac());
    assert!(matches!(walls, Entries::Textures { block } if block.entries() > 64), "{walls:?}");
    // Texels in full light: on average off by less than a step of the card, 4.05 per channel.
    let colors = bricks.tinted(surfaces[1].color());
    let table = mode13h::palette::Lut64K::shades(&made.palette, &colors);
    let off: u32 = bricks
        .texels()
        .iter()
        .map(|&texel| {
            made.palette[table.get(198, texel)].distance_squared(Rgb::BLACK.mix(colors[usize::from(texel)], 198))
        })
        .sum();
    let mean = f64::from(off) / bricks.texels().len() as f64;
    println!("bricks are off by {:.2}", mean.sqrt());
    assert!(mean < 3.0 * 4.05 * 4.05, "{mean}");
}

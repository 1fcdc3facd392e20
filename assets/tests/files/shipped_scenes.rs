//! The compiled-in scenes: each loads, loops seamlessly, calls for what it should show, and looks as it did.

use std::fs;
use std::path::PathBuf;

use mode13h::export;
use mode13h::palette::Rgb;
use mode13h::plan::Effect;
use mode13h::render::Renderer;
use mode13h::scene::Scene;
use mode13h::settings::{HiddenSurfaces, Mapping, Shading};
use mode13h::vga::Vga;
use mode13h_assets::auto_palette;
use mode13h_assets::scene_file::Loaded;
use mode13h_assets::shipped::{self, Shipped};

use crate::support::golden::{Indexed, read};
use crate::support::tried::Tried;
use crate::support::workspace::names_in;

fn scene(name: &str) -> Scene {
    load(&name.parse().unwrap_or_else(|error| panic!("{name}: {error}")))
}

fn load(shipped: &Shipped) -> Scene {
    let Loaded { mut scene, warnings, .. } = shipped.load().unwrap_or_else(|error| panic!("{error}"));
    assert!(warnings.is_empty(), "{warnings:?}");
    if scene.auto_palette {
        auto_palette::of_scene(&scene).expect("a legal scene").apply(&mut scene);
    }
    scene
}

impl Indexed {
    /// Pixel by pixel, the colours that a person sees.
    fn seen(&self) -> impl Iterator<Item = Rgb> {
        self.pixels.iter().map(|&pixel| self.colors[usize::from(pixel)])
    }

    fn at(&self, x: usize, y: usize) -> u32 {
        self.colors[usize::from(self.pixels[320 * y + x])].brightness()
    }
}

/// Drawn by a fresh renderer.
fn draw(scene: &Scene) -> (Indexed, Renderer) {
    let (mut renderer, mut vga) = (Renderer::new(), Vga::new());
    renderer.draw(scene, &mut vga).unwrap_or_else(|error| panic!("{}: {error}", scene.name));
    (Indexed::of(&vga), renderer)
}

fn draw_at(scene: &mut Scene, seconds: f64) -> Indexed {
    scene.set_time(seconds);
    draw(scene).0
}

#[test]
fn every_scene_loads_and_says_what_it_shows() {
    let folder = crate::support::workspace::root().join("assets/scenes");
    let mut files: Vec<String> =
        names_in(&folder).iter().filter_map(|name| name.strip_suffix(".toml").map(String::from)).collect();
    files.sort();
    let mut names: Vec<&str> = shipped::ALL.iter().map(|shipped| shipped.name).collect();
    names.sort_unstable();
    assert_eq!(names, files, "those compiled in and those in the folder");
    let readme = fs::read_to_string(folder.join("README.md")).expect("a README");
    for shipped in &shipped::ALL {
        let scene = load(shipped);
        assert_eq!(scene.name, shipped.name);
        assert!(shipped.text.starts_with("# ") && shipped.shows().len() > 20, "{}: {}", shipped.name, shipped.shows());
        assert!(shipped.shows().ends_with('.') && shipped.shows().len() <= 120, "{}", shipped.shows());
        // Someone who edits it should see lines that fit.
        assert!(shipped.text.lines().all(|line| line.chars().count() <= 120), "{}", shipped.name);
        let row = format!("alt=\"{0}\"> | **`{0}`** ", shipped.name);
        assert_eq!(readme.matches(&row).count(), 1, "{} in the README", shipped.name);
    }
}

#[test]
fn a_round_has_no_seam_and_something_happens_in_it() {
    for shipped in &shipped::ALL {
        let mut scene = load(shipped);
        let begin = draw_at(&mut scene, 0.0);
        let duration = scene.duration;
        assert!(draw_at(&mut scene, duration) == begin, "{}: a seam", shipped.name);
        assert!(draw_at(&mut scene, -2.0 * duration) == begin, "{}: a seam", shipped.name);
        // The moment before. Anything that has a millionth of its way to go is rounded to neighbouring shades, at most
        // two steps of the DAC apart, and to other pixels along edges; cycling colours move in steps.
        scene.palette_animation = None;
        let (begin, end) = (draw_at(&mut scene, 0.0), draw_at(&mut scene, duration * (1.0 - 1e-6)));
        let is_apart = |a: Rgb, b: Rgb| a.r.abs_diff(b.r).max(a.g.abs_diff(b.g)).max(a.b.abs_diff(b.b)) > 8;
        let off = end.seen().zip(begin.seen()).filter(|(a, b)| is_apart(*a, *b)).count();
        assert!(off < 100, "{}: {off} pixels jump", shipped.name);
        let mut scene = load(shipped);
        let changes = (1..4).any(|third| draw_at(&mut scene, duration * f64::from(third) / 3.7) != begin);
        assert_eq!(changes, shipped.name != "still", "{}", shipped.name);
    }
}

/// Each scene calls for the effect that it should show, and at least one other scene does not.
#[test]
fn scenes_call_for_what_they_show() {
    for (name, effect) in [
        ("torus", Effect::Gouraud),
        ("torus", Effect::HiddenSurfaces),
        ("cube", Effect::BackFaceCulling),
        ("teapot", Effect::Specular),
        ("cone", Effect::Gouraud),
        ("phong", Effect::Phong),
        ("phong-table", Effect::Phong),
        ("flash", Effect::PositionalLights),
        ("flash", Effect::NearClipping),
        ("flash", Effect::ScreenClipping),
        ("flash-tessellated", Effect::Tessellation),
        ("two-lights", Effect::PositionalLights),
        ("fog", Effect::Fog),
        ("rgb", Effect::RgbChannels),
        ("rgb", Effect::Dither),
        ("crate", Effect::Texture),
        ("crate", Effect::Perspective),
        ("mirror", Effect::EnvironmentMap),
        ("interlock", Effect::HiddenSurfaces),
        ("glenz", Effect::Transparency),
        ("fade", Effect::PaletteAnimation),
        ("cycle", Effect::PaletteAnimation),
        ("still", Effect::Lighting),
    ] {
        let mut scene = scene(name);
        scene.set_time(0.37 * scene.duration);
        let (_, renderer) = draw(&scene);
        assert!(renderer.plan().is_on_anywhere(effect), "{name} does not call for {effect}");
    }
    let (_, renderer) = draw(&scene("cube"));
    assert_eq!(renderer.plan().hidden_surfaces(), HiddenSurfaces::BackFaces);
    let (_, renderer) = draw(&scene("interlock"));
    assert_eq!(renderer.plan().hidden_surfaces(), HiddenSurfaces::DepthBuffer);
}

#[test]
fn what_does_not_change_is_not_drawn_again() {
    for (name, palette_changes) in [("still", false), ("fade", true), ("cycle", true)] {
        let mut scene = scene(name);
        let (mut renderer, mut vga) = (Renderer::new(), Vga::new());
        scene.set_time(0.0);
        assert!(renderer.draw(&scene, &mut vga).expect("a legal scene").redrawn);
        let begin = Indexed::of(&vga);
        scene.set_time(0.3 * scene.duration);
        let stats = renderer.draw(&scene, &mut vga).expect("a legal scene");
        assert!(!stats.redrawn && stats.vertices == 0 && stats.raster.pixels == 0, "{name}: {stats}");
        let now = Indexed::of(&vga);
        assert!(now.pixels == begin.pixels, "{name}");
        assert_eq!(now.colors != begin.colors, palette_changes, "{name}");
        assert!(now == draw(&scene).0, "{name}: another picture than a fresh renderer's");
    }
}

#[test]
fn coarse_faces_lose_the_flash_and_split_ones_do_not() {
    let (mut coarse, mut split) = (scene("flash"), scene("flash-tessellated"));
    let mut darker = 0;
    for i in 0..20 {
        let seconds = f64::from(i) / 20.0 * coarse.duration;
        let (coarse, split) = (draw_at(&mut coarse, seconds), draw_at(&mut split, seconds));
        let brightest = |shown: &Indexed| shown.seen().map(Rgb::brightness).max().expect("pixels");
        darker += i32::from(2 * brightest(&coarse) < brightest(&split));
    }
    assert!(darker >= 4, "the flash is lost in {darker} of 20 frames");
}

#[test]
fn a_face_between_two_lamps_shines_in_its_middle() {
    let mut scene = scene("two-lights");
    let shown = draw_at(&mut scene, 0.0);
    // The middles and the left ends of the upper and lower walls.
    let [coarse, cut_up] = [46, 152].map(|y| (shown.at(24, y), shown.at(160, y)));
    assert!(coarse.1 * 10 > coarse.0 * 9, "above: {coarse:?}");
    assert!(cut_up.1 * 3 < cut_up.0, "below: {cut_up:?}");
    // For both, the right values are those of light at every pixel.
    scene.settings.accuracy = Some(Shading::Phong.into());
    let shown = draw(&scene).0;
    assert!(shown.at(160, 46).abs_diff(shown.at(160, 152)) <= 3 && shown.at(160, 46) * 3 < shown.at(24, 46));
}

#[test]
fn painters_order_and_affine_mapping_show_their_faults() {
    let mut scene = self::scene("interlock");
    let right = draw(&scene).0;
    scene.settings.hidden_surfaces = Some(HiddenSurfaces::PainterOrder);
    assert!(draw(&scene).0 != right, "painter's order is right");
    scene.settings.hidden_surfaces = Some(HiddenSurfaces::ScanLine);
    assert!(draw(&scene).0 == right, "the scan-line method is not");

    let mut scene = self::scene("crate");
    scene.set_time(0.06 * scene.duration);
    let right = draw(&scene).0;
    for (mapping, least) in [(Mapping::Affine, 2_000), (Mapping::Every16, 1)] {
        scene.settings.mapping = Some(mapping);
        let wrong = draw(&scene).0.pixels.iter().zip(&right.pixels).filter(|(a, b)| a != b).count();
        assert!(wrong >= least && wrong < 25_000, "{mapping}: {wrong} pixels differ");
    }
}

fn kept(shipped: &Shipped) -> PathBuf {
    crate::support::workspace::root().join(format!("assets/scenes/pictures/{}.png", shipped.name))
}

/// `MODE13H_PICTURES=write` regenerates them and always fails, so that such a run never passes.
#[test]
fn the_pictures_of_the_readme_are_those_that_are_drawn() {
    let mut tried = Tried::new("the_pictures_of_the_readme_are_those_that_are_drawn", 18);
    let write = std::env::var_os("MODE13H_PICTURES").is_some_and(|value| value == "write");
    for shipped in &shipped::ALL {
        let mut scene = load(shipped);
        scene.set_time(scene.picture);
        let (mut renderer, mut vga) = (Renderer::new(), Vga::new());
        renderer.draw(&scene, &mut vga).expect("a legal scene");
        if write {
            fs::create_dir_all(kept(shipped).parent().expect("a folder")).expect("made");
            export::png(&vga, kept(shipped)).expect("written");
        }
        assert!(read(&kept(shipped)) == Indexed::of(&vga), "{}: another picture than is kept", shipped.name);
        tried.add(1);
    }
    assert!(!write, "pictures written: look at them, then run without MODE13H_PICTURES");
}

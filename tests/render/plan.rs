//! The plan: only what a scene calls for is computed, and that changes no picture.

use crate::support::scenes;
use crate::support::tried::Tried;
use mode13h::Angle;
use mode13h::glam::Vec3;
use mode13h::light::{Light, LightResponse};
use mode13h::mesh::{Mesh, Surface, shapes};
use mode13h::palette::BIOS;
use mode13h::plan::{Effect, Reason};
use mode13h::raster::Frame;
use mode13h::render::{RenderError, Renderer, Screen, Stats};
use mode13h::scene::{Object, PaletteAnimation, Scene, Shared};
use mode13h::settings::{Accuracy, DitherPattern, HiddenSurfaces, Mapping, Shading, VertexPath};
use mode13h::texture::Texture;
use mode13h::vga::Vga;
use mode13h_conformance::Random;

/// The effects that save work: always doing the full work gives the same bytes. The others change the picture where a
/// scene calls for them.
const SAVES_WORK: [Effect; 10] = [
    Effect::Transform,
    Effect::NearClipping,
    Effect::ScreenClipping,
    Effect::BackFaceCulling,
    Effect::HiddenSurfaces,
    Effect::Lighting,
    Effect::PositionalLights,
    Effect::Specular,
    Effect::Gouraud,
    Effect::Fog,
];

/// The frame of a new renderer set up by `prepare`.
fn draw(scene: &Scene, prepare: impl FnOnce(&mut Renderer)) -> (Vec<u8>, Stats, Renderer) {
    let mut renderer = Renderer::new();
    prepare(&mut renderer);
    let (bytes, stats) = scenes::frame_by(&mut renderer, scene);
    (bytes, stats, renderer)
}

fn differing(a: &[u8], b: &[u8]) -> usize {
    a.iter().zip(b).filter(|(a, b)| a != b).count()
}

/// Whether any of a scene's objects call for an effect.
fn called_for(renderer: &Renderer, effect: Effect) -> bool {
    renderer.plan().is_on_anywhere(effect)
}

/// The state left from the last frame is not mixed with a mesh that has changed since.
#[test]
fn a_mesh_that_has_changed_since_the_last_frame_has_no_linear_error() {
    let cube = shapes::cube();
    let of_triangle = (0..cube.triangles().len()).map(|i| (i % 2) as u16).collect();
    let surfaces = vec![Surface::default(); 2];
    let two = cube.clone().with_surfaces(surfaces, of_triangle).expect("a surface for each triangle");
    let mut scene = scenes::framed(cube);
    let (_, _, mut renderer) = draw(&scene, |_| ());
    assert!(renderer.linear_error(&scene, 0).is_some());
    renderer.force(Effect::Specular, Some(true));
    renderer.make_plan(&scene, Screen::MODE_13H).expect("a legal scene");
    assert_eq!(renderer.linear_error(&scene, 0), None, "its materials are those of another plan");
    renderer.force(Effect::Specular, None);
    renderer.make_plan(&scene, Screen::MODE_13H).expect("a legal scene");
    assert!(renderer.linear_error(&scene, 0).is_some());
    let id = scene.object_ids()[0];
    scene[id].set_mesh(two);
    assert_eq!(renderer.linear_error(&scene, 0), None);
    renderer.make_plan(&scene, Screen::MODE_13H).expect("a legal scene");
    assert_eq!(renderer.linear_error(&scene, 0), None);
    assert!(!renderer.rows(&scene).is_empty());
}

#[test]
fn every_effect_is_called_for_by_a_scene_and_not_by_another() {
    let mut tried = Tried::new("every_effect_is_called_for_by_a_scene_and_not_by_another", 20);
    let plans: Vec<_> = scenes::all().iter().map(|(_, scene)| draw(scene, |_| ()).2).collect();
    for effect in Effect::ALL {
        let on = plans.iter().filter(|renderer| called_for(renderer, effect)).count();
        if effect == Effect::Transform {
            assert_eq!(on, plans.len(), "every first frame is transformed");
        } else {
            assert!(on > 0 && on < plans.len(), "{effect}: on in {on} of {} scenes", plans.len());
        }
        tried.add(1);
    }
}

/// Proof (a) for effects that save work: always doing the full work changes no byte.
#[test]
fn the_full_work_gives_the_same_bytes() {
    let mut tried = Tried::new("the_full_work_gives_the_same_bytes", 200);
    for (name, scene) in scenes::all() {
        let (expected, stats, chosen) = draw(&scene, |_| ());
        // Effects that save work by being on: culling, and hidden surfaces without depths.
        let (full, _, _) =
            draw(&scene, |renderer| renderer.settings.hidden_surfaces = Some(HiddenSurfaces::DepthBuffer));
        let covered_twice = differing(&expected, &full);
        assert!(covered_twice == 0, "{name}, depth buffer: {covered_twice} pixels differ");
        for effect in SAVES_WORK {
            let on = effect != Effect::BackFaceCulling;
            if !on && called_for(&chosen, Effect::NearClipping) {
                // The near plane cuts the object open, and its inside, which is never drawn, would show.
                continue;
            }
            let (bytes, forced, renderer) = draw(&scene, |renderer| {
                renderer.force(effect, Some(on));
                if !on {
                    renderer.settings.hidden_surfaces = Some(HiddenSurfaces::DepthBuffer);
                }
            });
            assert!(
                renderer.plan().objects().iter().all(|plan| plan.is_on(effect) == on),
                "{name}: {effect} is forced"
            );
            let differ = differing(&expected, &bytes);
            // For a face that is edge-on within rounding, neither side is nearer: with equal depths the first submitted
            // is drawn, and that may be a back face.
            let allowed = if on { 0 } else { forced.faces as usize / 100 };
            assert!(differ <= allowed, "{name}, {effect} forced: {differ} pixels differ");
            tried.add(1);
        }
        assert_eq!(stats.hidden_surfaces, chosen.plan().hidden_surfaces());
    }
}

/// Also within an error budget: what is out of range, such as a lamp, changes no decision on a face.
#[test]
fn the_full_work_gives_the_same_bytes_within_a_budget() {
    let mut tried = Tried::new("the_full_work_gives_the_same_bytes_within_a_budget", 1_000);
    let mut random = Random::named("full work within a budget");
    let random_scenes = (0..20).map(|i| (format!("random scene {i}"), scenes::random(&mut random)));
    let all: Vec<_> = scenes::all().into_iter().chain(random_scenes).collect();
    for (name, mut scene) in all {
        for _ in 0..random.within(1, 3) {
            // As strong as possible, and out of everyone's range.
            let place = Vec3::from([0; 3].map(|_| 300.0 + 50.0 * random.unit() as f32));
            scene.add_light(Light::lamp(place, 20.0).with_intensity(10.0_f32.powf(8.0 * random.unit() as f32 - 4.0)));
        }
        for max_error in [0.6, 1.0, 2.0, 4.0, 8.0] {
            let frame = |force: Option<(Effect, bool)>| {
                draw(&scene, |renderer| {
                    renderer.settings.accuracy = Some(Accuracy::WithinError(max_error));
                    if let Some((effect, on)) = force {
                        renderer.force(effect, Some(on));
                        renderer.settings.hidden_surfaces = (!on).then_some(HiddenSurfaces::DepthBuffer);
                    }
                })
            };
            let (expected, _, chosen) = frame(None);
            for effect in SAVES_WORK {
                let on = effect != Effect::BackFaceCulling;
                if !on && called_for(&chosen, Effect::NearClipping) {
                    // As without a budget: the inside of an object that is cut open would show.
                    continue;
                }
                let (bytes, forced, _) = frame(Some((effect, on)));
                let differ = differing(&expected, &bytes);
                let allowed = if on { 0 } else { forced.faces as usize / 100 };
                assert!(differ <= allowed, "{name}, {effect} forced, within {max_error}: {differ} pixels differ");
                tried.add(1);
            }
        }
    }
}

/// Proof (a) for effects that change the picture: on neutral input they change no byte.
#[test]
fn neutral_input_gives_the_same_bytes() {
    let mut tried = Tried::new("neutral_input_gives_the_same_bytes", 80);
    for (name, scene) in scenes::all() {
        let (expected, _, chosen) = draw(&scene, |_| ());
        for effect in
            [Effect::Texture, Effect::EnvironmentMap, Effect::Transparency, Effect::Dither, Effect::PaletteAnimation]
        {
            if called_for(&chosen, effect) {
                continue;
            }
            let (bytes, stats, renderer) = draw(&scene, |renderer| renderer.force(effect, Some(true)));
            assert!(called_for(&renderer, effect), "{name}: {effect} is forced");
            let differ = differing(&expected, &bytes);
            assert!(differ == 0, "{name}, {effect} on neutral input: {differ} pixels differ");
            let ran = match effect {
                // Mixing an image from channels gives the channels themselves.
                Effect::Texture | Effect::EnvironmentMap => stats.raster.textured + stats.raster.mixed,
                Effect::Transparency => stats.raster.blended,
                Effect::Dither => stats.raster.dithered,
                _ => 1,
            };
            assert!(ran > 0, "{name}, {effect}: it ran");
            tried.add(1);
        }
    }
}

/// Proof (b): the counters of disabled effects are zero, and those of enabled effects are not.
#[test]
fn counters_of_what_is_off_are_zero() {
    let mut tried = Tried::new("counters_of_what_is_off_are_zero", 20);
    for (name, scene) in scenes::all() {
        let (_, stats, renderer) = draw(&scene, |_| ());
        let raster = stats.raster;
        let on = |effect| called_for(&renderer, effect);
        let counters = [
            (Effect::Transform, stats.vertices),
            (Effect::Texture, if on(Effect::EnvironmentMap) { 0 } else { u64::from(raster.textured) }),
            (Effect::EnvironmentMap, if on(Effect::Texture) { 0 } else { u64::from(raster.textured) }),
            (Effect::Mipmaps, u64::from(raster.mipmapped)),
            (Effect::Fog, u64::from(raster.fogged)),
            (Effect::Transparency, u64::from(raster.blended)),
            (Effect::RgbChannels, u64::from(raster.mixed)),
            (Effect::Dither, u64::from(raster.dithered)),
            (Effect::Phong, u64::from(raster.lit)),
        ];
        for (effect, count) in counters {
            assert_eq!(count > 0, on(effect), "{name}, {effect}: {count}, in {stats}");
        }
        let depth = renderer.plan().hidden_surfaces() == HiddenSurfaces::DepthBuffer;
        assert_eq!(raster.tested > 0, depth, "{name}: {stats}");
        if !on(Effect::Lighting) {
            assert_eq!(stats.lit, 0, "{name}: {stats}");
        }
        if !on(Effect::NearClipping) && !on(Effect::ScreenClipping) {
            assert_eq!(stats.clipped, 0, "{name}: {stats}");
        }
        tried.add(1);
    }
}

/// Proof (d): where an effect that changes the picture is called for, leaving it out changes the picture.
/// Effects with tests of their own: cached vertices, hidden objects, and clipping, which cannot be switched off.
fn is_elsewhere(effect: Effect) -> bool {
    matches!(effect, Effect::Transform | Effect::HiddenSurfaces | Effect::NearClipping | Effect::ScreenClipping)
}

#[test]
fn leaving_out_what_is_called_for_changes_the_picture() {
    let mut tried = Tried::new("leaving_out_what_is_called_for_changes_the_picture", 15);
    let mut changed = [false; Effect::COUNT];
    for (_, mut scene) in scenes::all() {
        // For a cycle, a moment at which it has moved.
        scene.set_time(0.3);
        let frame = |force: Option<Effect>| {
            let mut renderer = Renderer::new();
            if let Some(effect) = force {
                renderer.force(effect, Some(effect == Effect::BackFaceCulling));
            }
            let mut vga = Vga::new();
            renderer.draw(&scene, &mut vga).expect("a legal scene");
            let called = Effect::ALL.map(|effect| called_for(&renderer, effect));
            (vga.pixels().to_vec(), vga.palette(), called)
        };
        let (bytes, palette, called) = frame(None);
        for (i, effect) in Effect::ALL.into_iter().enumerate() {
            let needed = if effect == Effect::BackFaceCulling { !called[i] } else { called[i] };
            if needed && !is_elsewhere(effect) {
                let (without, other_palette, _) = frame(Some(effect));
                changed[i] |= differing(&bytes, &without) > 0 || palette != other_palette;
                tried.add(1);
            }
        }
    }
    for (i, effect) in Effect::ALL.into_iter().enumerate() {
        assert!(changed[i] || is_elsewhere(effect), "no scene needs {effect}");
    }
}

/// D1: the plan never picks painter's order where objects overlap in depth.
#[test]
fn d1_the_plan_never_picks_painters_order_for_what_overlaps() {
    let mut tried = Tried::new("d1_the_plan_never_picks_painters_order_for_what_overlaps", 20);
    for (name, scene) in scenes::all() {
        let (_, stats, _) = draw(&scene, |_| ());
        if stats.hidden_surfaces == HiddenSurfaces::PainterOrder {
            let (depth, _, _) =
                draw(&scene, |renderer| renderer.settings.hidden_surfaces = Some(HiddenSurfaces::DepthBuffer));
            assert_eq!(differing(&draw(&scene, |_| ()).0, &depth), 0, "{name}");
        }
        tried.add(1);
    }
}

/// E1: where nothing changes nothing is drawn, and whatever changes is drawn.
#[test]
fn e1_what_stays_is_not_drawn_again() {
    let mut tried = Tried::new("e1_what_stays_is_not_drawn_again", 40);
    for (name, mut scene) in scenes::all() {
        let (mut renderer, mut vga) = (Renderer::new(), Vga::new());
        let first = renderer.draw(&scene, &mut vga).expect("a legal scene");
        let bytes = vga.pixels().to_vec();
        let second = renderer.draw(&scene, &mut vga).expect("a legal scene");
        assert!(first.redrawn && !second.redrawn, "{name}: {second}");
        assert_eq!((second.vertices, second.raster.pixels), (0, 0), "{name}");
        // The frame is modified from outside.
        vga.pixels_mut()[5000] ^= 1;
        let third = renderer.draw(&scene, &mut vga).expect("a legal scene");
        assert!(third.redrawn && third.vertices == 0, "{name}: the vertices are kept: {third}");
        assert_eq!(vga.pixels(), bytes, "{name}");
        // Something moves.
        scene.objects_mut()[0].rotate_y(Angle::from_radians(0.3));
        let moved = renderer.draw(&scene, &mut vga).expect("a legal scene");
        let is_seen = renderer.plan().objects()[0][Effect::Transform].reason != Reason::OutOfSight;
        assert_eq!((moved.redrawn, moved.vertices > 0), (is_seen, is_seen), "{name}: {moved}");
        assert_eq!(vga.pixels(), draw(&scene, |_| ()).0, "{name}: as a new renderer draws it");
        tried.add(2);
    }
}

/// A plan made without drawing is the next frame's plan, and does not affect that frame.
#[test]
fn a_plan_alone_is_that_of_the_next_frame() {
    let mut tried = Tried::new("a_plan_alone_is_that_of_the_next_frame", 60);
    for (name, mut scene) in scenes::all() {
        let (mut renderer, mut vga) = (Renderer::new(), Vga::new());
        let (mut plain, mut plain_vga) = (Renderer::new(), Vga::new());
        // The first frame, one that moves, and one that does not.
        for turn in [0.0, 0.1, 0.0] {
            scene.objects_mut()[0].rotate_y(Angle::from_radians(turn));
            for _ in 0..2 {
                renderer.make_plan(&scene, Screen::MODE_13H).expect("a legal scene");
            }
            let plan = renderer.plan().clone();
            let stats = renderer.draw(&scene, &mut vga).expect("a legal scene");
            let plain_stats = plain.draw(&scene, &mut plain_vga).expect("a legal scene");
            assert_eq!(&plan, plain.plan(), "{name}");
            assert_eq!(renderer.plan(), plain.plan(), "{name}");
            assert_eq!(stats, plain_stats, "{name}");
            assert_eq!(differing(vga.pixels(), plain_vga.pixels()), 0, "{name}");
            tried.add(1);
        }
    }
}

/// Vertices kept by force while the object moved are recomputed as soon as that is no longer forced.
#[test]
fn vertices_that_were_kept_by_force_are_made_when_they_are_let_go() {
    let mut tried = Tried::new("vertices_that_were_kept_by_force_are_made_when_they_are_let_go", 20);
    for (name, mut scene) in scenes::all() {
        let (mut renderer, mut vga) = (Renderer::new(), Vga::new());
        let first = renderer.draw(&scene, &mut vga).expect("a legal scene");
        let before = vga.pixels().to_vec();
        scene.objects_mut()[0].rotate_y(Angle::from_radians(0.01));
        renderer.force(Effect::Transform, Some(false));
        let kept = renderer.draw(&scene, &mut vga).expect("a legal scene");
        assert_eq!(kept.vertices, 0, "{name}");
        assert_eq!(differing(vga.pixels(), &before), 0, "{name}");
        // A card of its own has no frame that could be left as it is. Light and culling are those of the new pose, so not
        // all pixels are equal.
        let mut other = Vga::new();
        let kept = renderer.draw(&scene, &mut other).expect("a legal scene");
        assert!(kept.vertices == 0 && kept.raster.pixels > first.raster.pixels / 2, "{name}");
        renderer.force(Effect::Transform, None);
        renderer.draw(&scene, &mut vga).expect("a legal scene");
        assert_eq!(differing(vga.pixels(), &draw(&scene, |_| ()).0), 0, "{name}");
        // Vertices of another mesh are not kept.
        renderer.force(Effect::Transform, Some(false));
        scene.objects_mut()[0].set_mesh(shapes::cube());
        renderer.draw(&scene, &mut vga).expect("a legal scene");
        assert_eq!(differing(vga.pixels(), &draw(&scene, |_| ()).0), 0, "{name}");
        tried.add(1);
    }
}

/// A material with a response of its own is lit at every pixel within any budget, and its plan says why.
#[test]
fn an_own_response_has_no_budget() {
    for mesh in [shapes::torus(24, 12), shapes::cube()] {
        let mut scene = Scene::showing(mesh);
        scene.objects_mut()[0].materials[0].response = Some(LightResponse::new(|intensity| intensity * intensity));
        let lit = draw(&scene, |renderer| renderer.settings.accuracy = Some(Shading::Phong.into())).0;
        let (bytes, _, renderer) =
            draw(&scene, |renderer| renderer.settings.accuracy = Some(Accuracy::WithinError(2.0)));
        assert_eq!(differing(&bytes, &lit), 0);
        let plan = &renderer.plan().objects()[0];
        assert_eq!((plan.shading(), plan.max_error()), (Shading::Phong, None));
        for (effect, on) in [(Effect::Gouraud, false), (Effect::Phong, true)] {
            assert_eq!((plan[effect].on, plan[effect].reason), (on, Reason::OwnResponse));
        }
    }
}

/// A mesh whose normals are nearly those of its faces is not flat-shaded in light that makes the difference visible.
#[test]
fn nearly_faceted_meshes_are_not_flat_in_strong_light() {
    let wall = shapes::wall(1, 1);
    let tilted = |at: &Vec3| Vec3::new(-9e-6 * at.x, 0.0, 1.0);
    let normals = wall.positions().iter().map(tilted).collect();
    let mesh = Mesh::with_normals(wall.positions().to_vec(), normals, wall.triangles().to_vec()).expect("a wall");
    let mut scene = Scene::new();
    scene.add(Object::new(mesh));
    scene.settings.accuracy = Some(Accuracy::WithinError(1.0));
    for (intensity, is_flat) in [(1.0, true), (10_000.0, false)] {
        scene.clear_lights();
        scene.add_light(Light::sun([1.0, 0.0, 4e-5]).with_intensity(intensity));
        let plan = draw(&scene, |_| ()).2.plan().objects()[0].shading();
        assert_eq!(plan == Shading::Flat, is_flat, "{intensity}");
    }
}

/// Vertices that are kept by force have what their shading needs: others are computed again.
#[test]
fn vertices_kept_by_force_are_those_of_the_shading() {
    let within = |shades| Some(Accuracy::WithinError(shades));
    let keep = |renderer: &mut Renderer| renderer.force(Effect::Transform, Some(false));
    let fresh = |scene: &Scene, shades: f32| {
        let prepare = |renderer: &mut Renderer| {
            renderer.force(Effect::Phong, Some(false));
            renderer.settings.accuracy = within(shades);
        };
        draw(scene, prepare).0
    };
    let mut vga = Vga::new();
    // A budget after none, for faces that are clipped.
    let mut scene = Scene::showing(shapes::torus(24, 12));
    scene.camera.eye.z *= 0.2;
    let mut renderer = Renderer::new();
    renderer.force(Effect::Phong, Some(false));
    keep(&mut renderer);
    for accuracy in [None, within(2.0)] {
        renderer.settings.accuracy = accuracy;
        renderer.draw(&scene, &mut vga).expect("a legal scene");
    }
    assert_eq!(differing(vga.pixels(), &fresh(&scene, 2.0)), 0);
    // A budget that was made for a smaller mesh.
    let mut scene = Scene::showing(shapes::sphere(8, 4));
    let mut renderer = Renderer::new();
    renderer.force(Effect::Phong, Some(false));
    renderer.settings.accuracy = within(16.0);
    renderer.draw(&scene, &mut vga).expect("a legal scene");
    renderer.settings.accuracy = None;
    scene.objects_mut()[0].set_mesh(shapes::torus(48, 24));
    renderer.draw(&scene, &mut vga).expect("a legal scene");
    keep(&mut renderer);
    renderer.settings.accuracy = within(16.0);
    renderer.draw(&scene, &mut vga).expect("a legal scene");
    assert_eq!(differing(vga.pixels(), &fresh(&scene, 16.0)), 0);
    // A table of normals after light at every pixel.
    let mut renderer = Renderer::new();
    for (shading, keeps) in [(Shading::PhongTable, false), (Shading::Phong, false), (Shading::PhongTable, true)] {
        renderer.settings.accuracy = Some(shading.into());
        renderer.force(Effect::Transform, keeps.then_some(false));
        renderer.draw(&scene, &mut vga).expect("a legal scene");
    }
    let table = draw(&scene, |renderer| renderer.settings.accuracy = Some(Shading::PhongTable.into()));
    assert_eq!(differing(vga.pixels(), &table.0), 0);
}

/// An object that is drawn where it was leaves no depths that later frames miss.
#[test]
fn depths_of_vertices_kept_by_force_are_cleared() {
    let mut tried = Tried::new("depths_of_vertices_kept_by_force_are_cleared", 12);
    let mut scene = Scene::showing(shapes::torus(24, 12));
    scene.objects_mut()[0].scale = 0.3;
    let mut renderer = Renderer::new();
    for i in 0..12 {
        let is_kept = (3..6).contains(&i);
        renderer.force(Effect::Transform, is_kept.then_some(false));
        scene.objects_mut()[0].position.x = if is_kept { 0.6 } else { -0.6 } + i as f32 / 1000.0;
        let (bytes, _) = scenes::frame_by(&mut renderer, &scene);
        if !is_kept {
            assert_eq!(differing(&bytes, &draw(&scene, |_| ()).0), 0, "frame {i}");
        }
        tried.add(1);
    }
}

/// A palette without ramps makes materials draw in their own colours; without a palette in the scene they do not.
#[test]
fn a_palette_without_ramps_is_another_than_none() {
    let mesh = shapes::torus(24, 12);
    let count = mesh.triangles().len();
    let surface = Surface { diffuse: [1.0, 0.4, 0.1], ..Surface::default() };
    let mut scene = Scene::showing(mesh.with_surfaces(vec![surface], vec![0; count]).expect("a surface"));
    scene.add_light(Light::sun([1.0, 0.0, 0.0]).with_color([0.2, 0.2, 1.0]));
    (scene.settings.channels, scene.settings.dither) = (Some(true), Some(DitherPattern::Ordered));
    let (mut renderer, mut vga) = (Renderer::new(), Vga::new());
    for palette in [Some(BIOS), None, Some(BIOS)] {
        scene.palette = palette;
        renderer.draw(&scene, &mut vga).expect("a legal scene");
        let mut fresh = vga.clone();
        Renderer::new().draw(&scene, &mut fresh).expect("a legal scene");
        assert_eq!(differing(vga.pixels(), fresh.pixels()), 0, "{:?}", scene.palette.is_some());
    }
}

/// A palette is animated whatever is visible.
#[test]
fn a_palette_is_animated_without_a_visible_object() {
    let mut scene = Scene::showing(shapes::cube());
    scene.palette = Some(BIOS);
    let palette = |scene: &Scene| {
        let mut vga = Vga::new();
        Renderer::new().draw(scene, &mut vga).expect("a legal scene");
        vga.palette()
    };
    let still = palette(&scene);
    scene.palette_animation = Some(PaletteAnimation::Cycle { range: 1..=99, period: 4.0 });
    scene.set_time(1.0);
    let moved = palette(&scene);
    assert_ne!(moved, still);
    scene.objects_mut()[0].visible = false;
    assert_eq!(palette(&scene), moved);
    let (mut renderer, mut vga) = (Renderer::new(), Vga::new());
    renderer.force(Effect::PaletteAnimation, Some(false));
    renderer.draw(&scene, &mut vga).expect("a legal scene");
    assert_eq!(vga.palette(), still);
}

/// Whatever the unit of a mesh, its bound on the error of affine mapping is a number.
#[test]
fn the_mapping_does_not_depend_on_the_unit_of_the_mesh() {
    for size in [1.0, 1e-24, 2e19] {
        let mesh = shapes::wall(1, 1).stretched(Vec3::splat(size)).expect("a factor");
        let mut scene = Scene::showing(Object::new(mesh).scaled(size.recip()));
        scene.objects_mut()[0].materials[0].texture = "crate".parse::<Texture>().ok().map(Shared::new);
        let mut renderer = Renderer::new();
        let plan = renderer.make_plan(&scene, Screen::MODE_13H).expect("a legal scene");
        assert!(plan.objects()[0].is_on(Effect::Perspective), "{size}");
    }
}

#[test]
fn an_effect_is_switched_for_one_object_or_for_all() {
    let scenes = scenes::all();
    let (_, scene) = scenes.iter().find(|(name, _)| *name == "fog").expect("listed");
    let is_on = |prepare: &dyn Fn(&mut Renderer)| -> Vec<bool> {
        let (_, _, renderer) = draw(scene, prepare);
        renderer.plan().objects().iter().map(|plan| plan.is_on(Effect::Fog)).collect()
    };
    let [_, second, third, ..] = *scene.object_ids() else { panic!("fewer than three objects") };
    assert_eq!(is_on(&|_| ()), [true; 5]);
    assert_eq!(is_on(&|r| r.force_for(third, Effect::Fog, Some(false))), [true, true, false, true, true]);
    let one_of_all = |r: &mut Renderer| {
        r.force(Effect::Fog, Some(false));
        r.force_for(third, Effect::Fog, Some(true));
    };
    assert_eq!(is_on(&one_of_all), [false, false, true, false, false]);
    let taken_back = |r: &mut Renderer| {
        one_of_all(r);
        r.force_for(third, Effect::Fog, None);
        r.force_for(second, Effect::Dither, Some(true));
    };
    assert_eq!(is_on(&taken_back), [false; 5]);
    // The objects behind a removed one have other indices and the same overrides.
    let mut fewer = scene.clone();
    fewer.remove(second);
    let (_, _, renderer) = draw(&fewer, |r| r.force_for(third, Effect::Fog, Some(false)));
    let on: Vec<bool> = renderer.plan().objects().iter().map(|plan| plan.is_on(Effect::Fog)).collect();
    assert_eq!(on, [true, false, true, true]);
}

/// The plan has text for every decision, and the same text every time.
#[test]
fn every_decision_has_a_reason() {
    let mut tried = Tried::new("every_decision_has_a_reason", 300);
    for (name, scene) in scenes::all() {
        let rows = draw(&scene, |_| ()).2.plan().rows(&scene);
        assert_eq!(rows, draw(&scene, |_| ()).2.plan().rows(&scene), "{name}");
        assert_eq!(rows.len(), scene.objects().len() * Effect::COUNT);
        for row in rows {
            assert!(!row.reason.is_empty() && !row.reason.contains('\n') && !row.object.is_empty(), "{name}: {row:?}");
            tried.add(1);
        }
    }
}

/// A shininess of 0 means no highlight, however the frame is drawn, and the plan says so.
#[test]
fn a_shininess_of_0_is_no_highlight() {
    let mut tried = Tried::new("a_shininess_of_0_is_no_highlight", 60);
    let accuracies = Shading::ALL.map(Accuracy::from).into_iter().chain([8.0, 1.0].map(Accuracy::WithinError));
    for (accuracy, colored) in accuracies.flat_map(|accuracy| [(accuracy, false), (accuracy, true)]) {
        let mut matt = scenes::showing("sphere");
        matt.objects_mut()[0].materials[0].diffuse = 0.5;
        matt.add_light(Light::lamp([1.0, 1.0, 2.0], 5.0));
        if colored {
            matt.objects_mut()[0].materials[0].color = [0.9, 0.5, 0.2];
        }
        let mut unshiny = matt.clone();
        (unshiny.objects_mut()[0].materials[0].specular, unshiny.objects_mut()[0].materials[0].shininess) = (0.8, 0.0);
        for path in VertexPath::ALL {
            for force in [None, Some(true)] {
                let frame = |scene: &Scene| {
                    draw(scene, |renderer| {
                        renderer.settings.accuracy = Some(accuracy);
                        renderer.settings.vertex_path = Some(path);
                        renderer.force(Effect::Specular, force);
                    })
                };
                let ((expected, ..), (bytes, _, renderer)) = (frame(&matt), frame(&unshiny));
                let differ = differing(&expected, &bytes);
                assert!(differ == 0, "{accuracy:?}, {path}, {force:?}: {differ} pixels differ");
                if force.is_none() && path == VertexPath::Float {
                    let rows = renderer.rows(&unshiny);
                    let row = rows.iter().find(|row| row.effect == Effect::Specular).expect("listed");
                    assert_eq!((row.on, row.reason.as_str()), (false, "material 0 has a shininess of 0"));
                }
                tried.add(1);
            }
        }
    }
    // Without a diffuse share it responds to no light.
    let mut dark = scenes::showing("sphere");
    (dark.objects_mut()[0].materials[0].specular, dark.objects_mut()[0].materials[0].diffuse) = (0.8, 0.0);
    assert!(!called_for(&draw(&dark, |_| ()).2, Effect::Lighting));
}

/// Any shininess that is a number of at least 0 is accepted. Anything else is rejected.
#[test]
fn a_shininess_below_0_is_refused() {
    let draw_with = |shininess: f32| {
        let mut scene = scenes::showing("sphere");
        let material = &mut scene.objects_mut()[0].materials[0];
        (material.specular, material.shininess) = (0.5, shininess);
        Renderer::new().draw(&scene, &mut Vga::new()).map(drop)
    };
    for shininess in [-0.0, 0.0, 1e-40, 1e-30, f32::MAX] {
        assert_eq!(draw_with(shininess), Ok(()), "{shininess}");
    }
    for shininess in [-1.0, -1e-40, f32::NAN, f32::INFINITY] {
        assert!(matches!(draw_with(shininess), Err(RenderError::Object { index: 0, .. })), "{shininess}");
    }
}

/// Proof (a) for light at every pixel and for splitting: switched on, they change no pixel by more than the error that
/// the plan stated.
#[test]
fn light_at_every_pixel_changes_no_more_than_the_plan_says() {
    // The shipped scenes are files.
    let stated = 40;
    let mut tried = Tried::new("light_at_every_pixel_changes_no_more_than_the_plan_says", stated);
    let mut bounds = Vec::new();
    for (name, scene) in scenes::all() {
        let (expected, _, chosen) = draw(&scene, |_| ());
        // Bytes are shades only if no later stage changes them.
        let more = [
            Effect::Texture,
            Effect::EnvironmentMap,
            Effect::Fog,
            Effect::RgbChannels,
            Effect::Transparency,
            Effect::Dither,
            Effect::Phong,
            Effect::Tessellation,
        ];
        if more.iter().any(|effect| called_for(&chosen, *effect)) {
            continue;
        }
        let Some(bound) = (0..scene.objects().len())
            .map(|object| chosen.linear_error(&scene, object))
            .try_fold(0.0_f64, |most, error| Some(most.max(error?)))
        else {
            continue;
        };
        let printed = chosen.rows(&scene);
        assert!(printed.iter().any(|row| row.reason.contains("linear shades are off by at most")), "{name}");
        // A linear shade is off by three quarters, or over a row by 1.75, light at a pixel by a half, in entries of the
        // ramp, of which there are at most 256.
        let allowed = bound + 1.75 + 0.5;
        for (effect, shading) in [(Effect::Phong, Some(Shading::Phong)), (Effect::Tessellation, None)] {
            let (bytes, stats, _) = draw(&scene, |renderer| match shading {
                Some(shading) => {
                    renderer.settings.accuracy = Some(shading.into());
                }
                None => renderer.force(effect, Some(true)),
            });
            assert!(shading.is_none() || stats.raster.lit > 0 || stats.lit == 0, "{name}: {stats}");
            // A vertex created by splitting is itself rounded to 1/256 pixel, so a pixel may come or go along a
            // silhouette.
            let shows = |byte: u8| byte != scene.background;
            let (both, one): (Vec<_>, Vec<_>) =
                expected.iter().zip(&bytes).filter(|(a, b)| a != b).partition(|(a, b)| shows(**a) && shows(**b));
            assert!(one.len() <= if effect == Effect::Tessellation { 8 } else { 0 }, "{name}, {effect}: {one:?}");
            let off = both.iter().map(|(a, b)| a.abs_diff(**b)).max().unwrap_or(0);
            assert!(f64::from(off) <= allowed, "{name}, {effect}: off by {off}, {bound:.2} printed");
            bounds.push((bound, off));
            tried.add(1);
        }
    }
    let useful = bounds.iter().filter(|(bound, _)| *bound < 64.0).count();
    assert!(useful * 2 > bounds.len(), "most bounds say something: {bounds:?}");
}

/// Proof (a) for the perspective of textures: switched on, it moves no texel farther than the plan stated.
#[test]
fn perspective_moves_no_texel_farther_than_the_plan_says() {
    let mut tried = Tried::new("perspective_moves_no_texel_farther_than_the_plan_says", 30);
    // Column u of the image is grey 4·u, which the card shows as its level u.
    let colors = core::array::from_fn(|i| mode13h::palette::Rgb::from_dac([(i % 64) as u8; 3]));
    let texture = mode13h::texture::Texture::new(64, 1, (0..64).collect(), colors).expect("sound");
    let texture = mode13h::scene::Shared::new(texture);
    let mut random = mode13h_conformance::Random::named("perspective");
    // The greatest observed share of the stated distance.
    let mut seen = 0.0_f64;
    while tried.more() {
        let pieces = random.within(1, 24) as u32;
        let mut scene = crate::support::scenes::framed(mode13h::mesh::shapes::wall(pieces, pieces));
        let object = &mut scene.objects_mut()[0];
        object.angles = [random.unit() - 0.5, 2.4 * random.unit() - 1.2, random.unit()].map(Angle::from_radians);
        let material = &mut object.materials[0];
        (material.ambient, material.diffuse) = (1.0, 0.0);
        material.texture = Some(mode13h::scene::Shared::clone(&texture));
        let frame = |on| draw(&scene, |renderer| renderer.force(Effect::Perspective, Some(on)));
        let (affine, _, renderer) = frame(false);
        let (perspective, _, _) = frame(true);
        let free = draw(&scene, |_| ()).2;
        let mode13h::plan::Reason::AffineError { texels } = free.plan().objects()[0][Effect::Perspective].reason else {
            panic!("the plan prints the error");
        };
        assert!(!called_for(&renderer, Effect::Perspective));
        assert_eq!(called_for(&free, Effect::Perspective), texels > 0.5);
        for (a, b) in affine.iter().zip(&perspective).filter(|(a, b)| (**a, **b) != (0, 0)) {
            // Four entries of the palette show as one level. The image's far end repeats next to its near one.
            let apart = (a >> 2).abs_diff(b >> 2);
            let apart = f64::from(apart.min(64 - apart));
            // The coordinates are this far apart, and the texels that contain them by less than one more.
            assert!(apart < texels + 1.0, "{apart} texels apart, {texels:.3} printed");
            seen = seen.max((apart - 1.0) / texels);
        }
    }
    assert!(seen > 0.3, "the bound says little: at most {seen:.2} of it was seen");
}

/// Proof (a) for mipmaps: with at most one texel per pixel they change no byte, although levels are chosen.
#[test]
fn mipmaps_change_nothing_of_what_is_near() {
    let mut tried = Tried::new("mipmaps_change_nothing_of_what_is_near", 60);
    for name in mode13h::texture::Texture::NAMES {
        let texture = mode13h::scene::Shared::new(name.parse::<mode13h::texture::Texture>().expect("listed"));
        for (angle, mapping) in
            [0.0, 0.3, -0.6].into_iter().flat_map(|angle| Mapping::ALL.map(|mapping| (angle, mapping)))
        {
            for channels in [false, true] {
                let mut scene = crate::support::scenes::framed(mode13h::mesh::shapes::wall(3, 3));
                let object = &mut scene.objects_mut()[0];
                object.materials[0].texture = Some(mode13h::scene::Shared::clone(&texture));
                object.angles = [angle, angle, angle].map(Angle::from_radians);
                // 128 texels on √2 units: even the far corners of the tilted wall have fewer than √2 texels per pixel.
                scene.camera.eye = mode13h::glam::Vec3::new(0.0, 0.0, 0.8);
                if channels {
                    scene.add_light(mode13h::light::Light::sun([1.0, 0.2, 1.0]).with_color([1.0, 0.5, 0.2]));
                }
                let frame = |mipmaps| {
                    draw(&scene, |renderer| {
                        renderer.settings.mapping = Some(mapping);
                        renderer.settings.mipmaps = Some(mipmaps);
                    })
                };
                let ((without, off, _), (with, on, _)) = (frame(false), frame(true));
                assert!(off.raster.mipmapped == 0 && on.raster.mipmapped == on.raster.textured, "{name}: {on}");
                assert!(on.raster.textured > 10_000, "{name}: {on}");
                assert_eq!(differing(&with, &without), 0, "{name}, turned by {angle}, {mapping}");
                tried.add(1);
            }
        }
    }
}

/// The plan's figure against what is drawn: a wall parallel to the screen shows level 0 everywhere as long as the
/// figure is below √2, and nowhere when it is above.
#[test]
fn mipmaps_are_called_for_by_texels_to_a_pixel() {
    let mut tried = Tried::new("mipmaps_are_called_for_by_texels_to_a_pixel", 40);
    let texture = mode13h::scene::Shared::new("bricks".parse::<mode13h::texture::Texture>().expect("listed"));
    for step in 0..40 {
        let mut scene = crate::support::scenes::framed(mode13h::mesh::shapes::wall(1, 1));
        let object = &mut scene.objects_mut()[0];
        object.materials[0].texture = Some(mode13h::scene::Shared::clone(&texture));
        let distance = 0.4 * 1.12_f32.powi(step);
        scene.camera.eye = mode13h::glam::Vec3::new(0.0, 0.0, distance);
        let (bytes, _, renderer) = draw(&scene, |_| ());
        let decision = renderer.plan().objects()[0][Effect::Mipmaps];
        let mode13h::plan::Reason::TexelsToPixel { texels } = decision.reason else { panic!("the plan says how many") };
        // 128 texels on √2 units; a pixel is taller than it is wide, and half of the screen's rows lie within half the
        // angle.
        let expected =
            8192.0_f64.sqrt() * f64::from(distance) * (scene.camera.field_of_view.to_radians() / 2.0).tan() / 100.0;
        assert!((expected..expected * 1.01).contains(&texels), "{texels} texels to a pixel, not {expected}");
        assert_eq!(decision.on, texels > core::f64::consts::FRAC_1_SQRT_2);
        let without = draw(&scene, |renderer| renderer.settings.mipmaps = Some(false)).0;
        // The corners' coordinates and positions are rounded.
        if texels < 1.40 {
            assert_eq!(differing(&bytes, &without), 0, "{texels} texels to a pixel");
        } else if texels > 1.44 {
            assert!(differing(&bytes, &without) > 0, "{texels} texels to a pixel");
        }
        tried.add(1);
    }
}

/// An explicit setting has the last word, the renderer's before the scene's; without a texture there is nothing to set.
#[test]
fn mipmaps_are_asked_for() {
    let mut floor = scenes::floor("bricks", 8.0);
    let is_on = |scene: &Scene, asked| {
        let (_, _, renderer) = draw(scene, |renderer| renderer.settings.mipmaps = asked);
        called_for(&renderer, Effect::Mipmaps)
    };
    assert_eq!([None, Some(true), Some(false)].map(|asked| is_on(&floor, asked)), [true, true, false]);
    floor.settings.mipmaps = Some(false);
    assert_eq!([None, Some(true), Some(false)].map(|asked| is_on(&floor, asked)), [false, true, false]);
    let mut plain = scenes::showing("torus");
    plain.settings.mipmaps = Some(true);
    assert!(!is_on(&plain, Some(true)));
    let reason = draw(&floor, |_| ()).2.plan().rows(&floor);
    let reason = reason.iter().find(|row| row.effect == Effect::Mipmaps).expect("a row");
    assert_eq!((reason.on, reason.reason.as_str()), (false, "asked for"));
}

/// Red, green and blue of each pixel.
type Picture = Vec<[f64; 3]>;

/// The colours of a frame as the card shows them.
fn shown(scene: &Scene, bytes: &[u8]) -> Picture {
    let palette = scene.palette.as_ref().unwrap_or(&mode13h::palette::BIOS).on_dac();
    let color = |byte: &u8| palette[*byte];
    bytes.iter().map(color).map(|c| [c.r, c.g, c.b].map(f64::from)).collect()
}

/// Distance between two pictures: the root mean square over the pixels and their channels.
fn apart(a: &[[f64; 3]], b: &[[f64; 3]]) -> f64 {
    let squares: f64 = a.iter().flatten().zip(b.iter().flatten()).map(|(a, b)| (a - b) * (a - b)).sum();
    (squares / (3 * a.len()) as f64).sqrt()
}

/// What mipmaps are for. The reference is the mean of what is drawn in perspective where each pixel is 16 × 16 smaller
/// ones. Over small steps of the camera every frame is nearer to that with mipmaps than without, and so is its change
/// from the frame before: it sparkles less. The improvement is printed.
#[test]
fn mipmaps_lessen_sparkle_on_every_frame() {
    const SIZE: (usize, usize) = (128, 80);
    const PART: usize = 16;
    const FRAMES: u8 = 4;
    let mut tried = Tried::new("mipmaps_lessen_sparkle_on_every_frame", 4 * 3 * u64::from(FRAMES));
    let ramp = core::array::from_fn(|i| mode13h::palette::Rgb::from_dac([(i / 4) as u8; 3]));
    let grey = mode13h::palette::Palette::from_colors(ramp);
    let palettes = [&grey, mode13h::palette::builtin::by_name("cube").expect("built in").palette];
    let picture = |scene: &Scene, part: usize, mapping: Mapping, mipmaps: bool| {
        let (width, height) = (SIZE.0 * part, SIZE.1 * part);
        let mut bytes = vec![0; width * height];
        let frame = Frame::new(&mut bytes, width as u32, height as u32, width).expect("a legal frame");
        let mut renderer = Renderer::new();
        renderer.settings.mapping = Some(mapping);
        renderer.settings.mipmaps = Some(mipmaps);
        renderer.draw_frame(scene, frame, (5, 6)).expect("a legal scene");
        shown(scene, &bytes)
    };
    for (image, palette) in ["checker", "bricks"].into_iter().flat_map(|image| palettes.map(|palette| (image, palette)))
    {
        let mut scene = scenes::floor(image, 24.0);
        scene.palette = Some(palette.clone());
        let (mut errors, mut sparkles) = ([[0.0; 2]; 3], [[0.0; 2]; 3]);
        // The reference, and for each mapping what is drawn without and with mipmaps.
        let mut before: Option<(Picture, [[Picture; 2]; 3])> = None;
        for frame in 0..FRAMES {
            let moved = f32::from(frame) * 0.01;
            scene.camera.eye.x = moved;
            scene.camera.target.x = moved;
            let fine = picture(&scene, PART, Mapping::Perspective, false);
            let mean = |i: usize| {
                let (x, y) = (i % SIZE.0 * PART, i / SIZE.0 * PART);
                let rows = (y..y + PART).flat_map(|y| &fine[y * SIZE.0 * PART + x..][..PART]);
                let sums = rows.fold([0.0; 3], |sums, color| [0, 1, 2].map(|i| sums[i] + color[i]));
                sums.map(|sum| sum / (PART * PART) as f64)
            };
            let right: Picture = (0..SIZE.0 * SIZE.1).map(mean).collect();
            let drawn = Mapping::ALL.map(|mapping| [false, true].map(|on| picture(&scene, 1, mapping, on)));
            for (i, mapping) in Mapping::ALL.into_iter().enumerate() {
                let error = drawn[i].each_ref().map(|picture| apart(picture, &right));
                assert!(error[1] < error[0], "{image}, {mapping}, frame {frame}: {error:?}");
                errors[i] = [0, 1].map(|on| errors[i][on] + error[on] / f64::from(FRAMES));
                if let Some((old_right, old_drawn)) = &before {
                    let change = |new: &[[f64; 3]], old: &[[f64; 3]]| -> Picture {
                        new.iter().zip(old).map(|(new, old)| [0, 1, 2].map(|i| new[i] - old[i])).collect()
                    };
                    let right = change(&right, old_right);
                    let sparkle = [0, 1].map(|on| apart(&change(&drawn[i][on], &old_drawn[i][on]), &right));
                    assert!(sparkle[1] < sparkle[0], "{image}, {mapping}, frame {frame}: {sparkle:?}");
                    sparkles[i] = [0, 1].map(|on| sparkles[i][on] + sparkle[on] / f64::from(FRAMES - 1));
                }
                tried.add(1);
            }
            before = Some((right, drawn));
        }
        for (i, mapping) in Mapping::ALL.into_iter().enumerate() {
            println!("{image}, {mapping}: error {:.1?}, sparkle {:.1?}", errors[i], sparkles[i]);
        }
    }
}

/// Clipping that is needed stays on: without it triangles would extend beyond what the raster can draw.
#[test]
fn clipping_that_is_needed_cannot_be_switched_off() {
    let mut tried = Tried::new("clipping_that_is_needed_cannot_be_switched_off", 2 * 40);
    for z in [1.2_f32, 0.2] {
        let mut scene = Scene::showing(shapes::torus(24, 12));
        scene.camera.eye.z *= z;
        (scene.objects_mut()[0].materials[0].specular, scene.objects_mut()[0].materials[0].shininess) = (0.4, 8.0);
        for shading in Shading::ALL {
            for way in HiddenSurfaces::ALL {
                let [forced, free] = [true, false].map(|forced| {
                    let mut renderer = scenes::shaded(shading);
                    renderer.settings.hidden_surfaces = Some(way);
                    if forced {
                        renderer.force(Effect::NearClipping, Some(false));
                        renderer.force(Effect::ScreenClipping, Some(false));
                    }
                    scenes::frame_by(&mut renderer, &scene).0
                });
                assert!(forced == free, "{shading}, {way}, {z}");
                tried.add(1);
            }
        }
    }
}

/// Each hidden-surface method is chosen for the right objects: none, a convex one, one that is not, two of which one
/// lies behind the other, and two in the same place.
#[test]
fn the_way_to_hidden_surfaces_follows_the_objects() {
    let mut tried = Tried::new("the_way_to_hidden_surfaces_follows_the_objects", 5);
    let at = |z: f32, mesh: Mesh| {
        let mut object = Object::new(mesh);
        object.position = Vec3::new(0.0, 0.0, z);
        object
    };
    let cube = shapes::cube;
    for (objects, expected) in [
        (vec![], HiddenSurfaces::BackFaces),
        (vec![at(-8.0, cube())], HiddenSurfaces::BackFaces),
        (vec![at(-8.0, shapes::torus(24, 12))], HiddenSurfaces::DepthBuffer),
        (vec![at(-8.0, cube()), at(-20.0, cube())], HiddenSurfaces::PainterOrder),
        (vec![at(-8.0, cube()), at(-8.5, cube())], HiddenSurfaces::DepthBuffer),
    ] {
        let mut scene = Scene::new();
        let count = objects.len();
        objects.into_iter().for_each(|object| {
            scene.add(object);
        });
        let (_, stats, renderer) = draw(&scene, |_| ());
        assert_eq!(renderer.plan().hidden_surfaces(), expected, "{count} objects");
        assert_eq!(stats.hidden_surfaces, expected);
        tried.add(1);
    }
}

/// The plan suggests a sufficient near distance if the camera's is too small, and only then.
#[test]
fn a_near_distance_that_depths_cannot_take_is_told() {
    let mut scene = Scene::showing(shapes::torus(24, 12));
    let needed = |scene: &Scene| draw(scene, |_| ()).2.plan().near_needed();
    assert_eq!(needed(&scene), None);
    scene.camera.near = 1e-9;
    let near = needed(&scene).expect("too near");
    // The farthest vertex is nearer than the far side of the box.
    let farthest = scene.camera.eye.z + 2.0;
    assert!(near > 1e-7 && near <= farthest / 1_048_576.0 * 1.01, "{near}");
    scene.camera.near = near;
    assert_eq!(needed(&scene), None);
    scene.camera.near = near * 0.9;
    assert_eq!(needed(&scene), Some(near));
    scene.objects_mut()[0].visible = false;
    assert_eq!(needed(&scene), None, "nothing is seen");
    let (_, _, renderer) = draw(&scene, |_| ());
    let of_hidden = Effect::ALL.map(|effect| renderer.plan().objects()[0][effect].reason);
    assert_eq!(of_hidden, [Reason::Hidden; Effect::COUNT]);
}

//! Objects that are hidden, removed, or move with others.

use mode13h::Angle;
use mode13h::glam::{Vec2, Vec3};
use mode13h::light::{Light, LightResponse};
use mode13h::mesh::{Mesh, Surface, shapes};
use mode13h::palette::Rgb;
use mode13h::plan::Effect;
use mode13h::raster::Frame;
use mode13h::render::{RenderError, Renderer, Screen};
use mode13h::scene::Motion;
use mode13h::scene::{Moving, Object, ObjectId, Path, Scene, Shared};
use mode13h::settings::Settings;
use mode13h::settings::{Accuracy, Shading, VertexPath};
use mode13h::texture::Texture;
use mode13h::vga::Vga;

use crate::support::scenes::frame as drawn;
use crate::support::tried::Tried;

/// A torus, a cube in front of it, and a cone beside them.
fn three() -> (Scene, [ObjectId; 3]) {
    let mut scene = Scene::new();
    scene.camera.eye.z *= 2.0;
    scene.add_light(Light::sun([0.4, 0.6, 1.0]));
    let at = [(shapes::torus(24, 12), Vec3::ZERO), (shapes::cube(), Vec3::Z), (shapes::cone(12, 4), Vec3::X)];
    let ids = at.map(|(mesh, position)| {
        let id = scene.add(Object::new(mesh));
        scene[id].position = position;
        scene[id].angles = [0.3, 0.4, 0.0].map(Angle::from_radians);
        id
    });
    (scene, ids)
}

#[test]
fn a_hidden_object_is_as_one_that_was_removed() {
    let mut tried = Tried::new("a_hidden_object_is_as_one_that_was_removed", 3 * 4);
    for way in [None].into_iter().chain(mode13h::settings::HiddenSurfaces::ALL.into_iter().skip(1).map(Some)) {
        for i in 0..3 {
            let (mut hidden, ids) = three();
            hidden.settings = Settings { hidden_surfaces: way, ..Settings::default() };
            let all = drawn(&hidden);
            let mut removed = hidden.clone();
            hidden[ids[i]].visible = false;
            removed.remove(ids[i]).expect("there");
            assert_eq!((hidden.is_visible(i), removed.objects().len()), (false, 2));
            let frame = drawn(&hidden);
            assert!(frame == drawn(&removed) && frame != all, "{way:?}, object {i}");
            tried.add(1);
        }
    }
}

/// With one renderer, shown and hidden repeatedly.
#[test]
fn a_kept_renderer_hides_and_shows() {
    let (mut scene, [torus, ..]) = three();
    let (mut renderer, mut vga) = (Renderer::new(), Vga::new());
    for turn in 0..6 {
        scene[torus].visible = turn % 2 == 0;
        renderer.draw(&scene, &mut vga).expect("a legal scene");
        assert!(vga.pixels() == drawn(&scene), "{turn}");
        assert_eq!(renderer.plan().objects()[0].is_on(Effect::Gouraud), turn % 2 == 0);
    }
}

/// Numbers that f32 and f64 represent exactly, so that the frame is that of the object placed by hand.
#[test]
fn a_child_stands_where_its_parent_puts_it() {
    let (mut scene, [torus, cube, cone]) = three();
    (scene[torus].position, scene[torus].scale) = (Vec3::new(1.0, 0.0, -2.0), 2.0);
    scene[torus].pivot = Vec3::new(0.5, 0.0, 0.0);
    scene[torus].angles = [Angle::default(); 3];
    let mut by_hand = scene.clone();
    // (0.75, 0.25, 1) is (0.25, 0.25, 1) from the pivot, twice that from (1, 0, −2).
    (by_hand[cube].position, by_hand[cube].scale) = (Vec3::new(1.5, 0.5, 0.0), 0.5);
    (by_hand[cone].position, by_hand[cone].scale) = (Vec3::new(2.0, 0.5, 0.0), 0.25);
    (scene[cube].position, scene[cube].scale, scene[cube].parent) = (Vec3::new(0.75, 0.25, 1.0), 0.25, Some(torus));
    // And a child of that. It would turn with the cube, which the cone placed by hand does not, so the cube is not
    // turned.
    scene[cube].angles = [Angle::default(); 3];
    by_hand[cube].angles = [Angle::default(); 3];
    (scene[cone].position, scene[cone].scale, scene[cone].parent) = (Vec3::new(1.0, 0.0, 0.0), 0.5, Some(cube));
    let frame = drawn(&scene);
    assert!(frame == drawn(&by_hand));

    // Children of a hidden object are hidden.
    scene[cube].visible = false;
    by_hand[cube].visible = false;
    by_hand[cone].visible = false;
    assert!(drawn(&scene) == drawn(&by_hand) && drawn(&scene) != frame);

    // Without its parent a child stands alone.
    scene.remove(torus);
    by_hand.remove(torus);
    (by_hand[cube], by_hand[cone]) = (scene[cube].clone(), scene[cone].clone());
    by_hand[cube].parent = None;
    assert!(drawn(&scene) == drawn(&by_hand));
}

#[test]
fn parents_in_a_circle_and_on_the_integer_path_are_refused() {
    let (mut scene, [torus, cube, cone]) = three();
    scene[cube].parent = Some(torus);
    let mut vga = Vga::new();
    let mut integer = Renderer::new();
    integer.settings.vertex_path = Some(VertexPath::Integer);
    let refused = |result| matches!(result, Err(RenderError::Object { .. }));
    assert!(refused(integer.draw(&scene, &mut vga)));
    scene[torus].parent = Some(cone);
    assert!(Renderer::new().draw(&scene, &mut vga).is_ok());
    scene[cone].parent = Some(cube);
    assert!(refused(Renderer::new().draw(&scene, &mut vga)));
    scene[cone].parent = Some(cone);
    assert!(refused(Renderer::new().draw(&scene, &mut vga)));
    scene[cone].parent = None;
    scene[cone].scale = f32::MAX;
    scene[torus].scale = f32::MAX;
    // 10⁷⁷ overflows f32, but not f64.
    assert!(Renderer::new().draw(&scene, &mut vga).is_ok());
}

#[test]
fn ids_outlive_removals_and_name_nothing_afterwards() {
    let (mut scene, [torus, cube, cone]) = three();
    let lamp = scene.add_light(Light::lamp([0.0; 3], 4.0));
    let path = Path::Line { from: Vec3::X, to: Vec3::Y, period: 1.0, back: false };
    for what in [Moving::Object(cube), Moving::Object(cone), Moving::Light(lamp)] {
        scene.motions.push(Motion::Path { what, path });
    }
    assert_eq!(scene.remove(cube).map(|object| object.mesh().triangles().len()), Some(12));
    assert_eq!((scene.index_of(torus), scene.index_of(cube), scene.index_of(cone)), (Some(0), None, Some(1)));
    assert!(scene.get(cube).is_none() && scene.remove(cube).is_none() && scene.get_mut(cube).is_none());
    assert!(scene.remove_light(lamp).is_some() && scene.remove_light(lamp).is_none());
    scene.set_time(0.5);
    assert_eq!((scene[cone].position, scene[torus].position), (Vec3::new(0.5, 0.5, 0.0), Vec3::ZERO));
    let again = scene.add(Object::new(shapes::cube()));
    assert!(again != cube && scene.object_ids() == [torus, cone, again]);
    scene.clear_lights();
    assert!(scene.lights().is_empty() && scene.light_ids().is_empty());
}

#[test]
fn a_path_whose_period_is_not_above_0_stays_where_it_begins() {
    for period in [-2.0, -0.0, 0.0, f64::NAN, f64::INFINITY] {
        let line = Path::Line { from: Vec3::X, to: Vec3::Y, period, back: true };
        let circle = Path::Circle { centre: Vec3::ZERO, from: Vec3::X, towards: Vec3::Y, period };
        for seconds in [0.0, 0.5, -0.5, f64::INFINITY] {
            assert_eq!((line.at(seconds), circle.at(seconds)), (Vec3::X, Vec3::X), "{seconds} s of {period}");
        }
    }
}

/// A step at half the light: anything darker than 127 becomes black, anything lighter than 128 white. A byte is the
/// nearest to its shade, so nothing is said about the two in between.
#[test]
fn a_response_to_light_is_asked_at_vertices_faces_and_pixels() {
    let step = LightResponse::new(|intensity| if intensity < 0.5 { 0.0 } else { 1.0 });
    let mut tried = Tried::new("a_response_to_light_is_asked_at_vertices_faces_and_pixels", 40_000);
    for (shading, budget) in
        [(Shading::Flat, None), (Shading::Phong, None), (Shading::PhongTable, None), (Shading::default(), Some(4.0))]
    {
        let mut scene = Scene::showing(shapes::sphere(48, 24));
        scene.background = 77;
        // With a budget such an object is lit at every pixel, since no bound is known for it.
        scene.settings.accuracy = Some(if budget.is_some() { Shading::Phong } else { shading }.into());
        let plain = drawn(&scene);
        scene.settings =
            Settings { accuracy: Some(budget.map_or(shading.into(), Accuracy::WithinError)), ..Settings::default() };
        scene.objects_mut()[0].materials[0].response = Some(step.clone());
        let stepped = drawn(&scene);
        let (mut black, mut white) = (0, 0);
        for (&plain, &stepped) in plain.iter().zip(&stepped).filter(|(plain, stepped)| **plain != 77 || **stepped != 77)
        {
            black += u32::from(stepped == 0);
            white += u32::from(stepped == 255);
            match plain {
                77 => assert_eq!(stepped, 0, "{shading}"),
                127 | 128 => assert!(stepped == 0 || stepped == 255, "{shading}"),
                _ => assert_eq!(stepped, if plain > 128 { 255 } else { 0 }, "{shading}: {plain}"),
            }
            tried.add(1);
        }
        assert!(black > 3_000 && white > 3_000, "{shading}: {black}, {white}");
    }
}

/// At the vertices, and linear in between: a constant response leaves one shade, on one channel and on three.
#[test]
fn a_constant_response_is_one_shade() {
    for (colored, constant, shown) in
        [(false, 1.0, Rgb::WHITE), (true, 1.0, Rgb::WHITE), (false, f32::NAN, Rgb::BLACK), (true, f32::NAN, Rgb::BLACK)]
    {
        let mut scene = Scene::showing(shapes::torus(24, 12));
        scene.background = 7;
        let material = &mut scene.objects_mut()[0].materials[0];
        material.response = Some(LightResponse::new(move |_| constant));
        if colored {
            material.color = [1.0, 1.0, 0.999];
        }
        let palette = scene.palette.clone().expect("greys");
        let frame = drawn(&scene);
        let mut seen = frame.into_iter().filter(|byte| *byte != 7).peekable();
        assert!(seen.peek().is_some());
        // A colour on three channels is looked up by the upper five bits of each: within 8.
        let room = if colored { 8 } else { 0 };
        let near = |a: Rgb, b: Rgb| [(a.r, b.r), (a.g, b.g), (a.b, b.b)].iter().all(|(a, b)| a.abs_diff(*b) <= room);
        let wrong = seen.find(|byte| !near(palette[*byte], shown));
        assert_eq!(wrong.map(|byte| palette[byte]), None, "{colored}, {constant}");
    }
}

/// A texture that is replaced in every frame, as procedural ones are, is freed with its tables.
#[test]
fn tables_of_textures_that_nobody_holds_are_freed() {
    for colored in [false, true] {
        let mut scene = Scene::showing(shapes::wall(1, 1).with_texcoords(vec![Vec2::ZERO; 4]).expect("four vertices"));
        scene.settings.mipmaps = Some(true);
        scene.objects_mut()[0].materials[0].color = if colored { [1.0, 0.5, 0.5] } else { [1.0; 3] };
        let (mut renderer, mut vga) = (Renderer::new(), Vga::new());
        let mut textures = Vec::new();
        for frame in 0..6_u8 {
            let texture = Shared::new(Texture::from_rgb(2, 2, &[Rgb::new(40 * frame, 0, 9); 4]).expect("a texture"));
            textures.push(Shared::downgrade(&texture));
            scene.objects_mut()[0].materials[0].texture = Some(texture);
            let stats = renderer.draw(&scene, &mut vga).expect("a legal scene");
            assert!(stats.redrawn);
            // Wherever the allocator put it: no table of an earlier one is taken for its own.
            assert!(vga.pixels() == drawn(&scene).as_slice(), "frame {frame}, colored: {colored}");
        }
        let held = textures.iter().filter(|texture| texture.strong_count() > 0).count();
        assert_eq!(held, 1, "only the last is in use, colored: {colored}");
    }
}

/// On the integer path only suns count towards the limit of lights, as lamps are left out.
#[test]
fn lamps_do_not_use_up_the_suns_of_the_integer_path() {
    let (mut scene, _) = three();
    scene.settings.vertex_path = Some(VertexPath::Integer);
    scene.clear_lights();
    for _ in 0..4096 {
        scene.add_light(Light::lamp([0.0, 0.0, 5.0], 8.0));
    }
    scene.add_light(Light::sun([0.4, 0.6, 1.0]));
    let mut suns = scene.clone();
    suns.clear_lights();
    suns.add_light(Light::sun([0.4, 0.6, 1.0]));
    assert!(drawn(&scene) == drawn(&suns));
}

/// Only frames within a budget tell what the budget gave the faces.
#[test]
fn rows_of_a_frame_without_a_budget_count_no_faces() {
    let (mut scene, _) = three();
    let mut renderer = Renderer::new();
    scene.settings.accuracy = Some(Accuracy::WithinError(2.0));
    renderer.draw(&scene, &mut Vga::new()).expect("a legal scene");
    let counts = |renderer: &Renderer, scene: &Scene| {
        renderer.rows(scene).iter().filter(|row| row.reason.contains("not drawn")).count()
    };
    assert!(counts(&renderer, &scene) > 0);
    scene.settings.accuracy = Some(Shading::Flat.into());
    scene.settings.vertex_path = Some(VertexPath::Integer);
    renderer.draw(&scene, &mut Vga::new()).expect("a legal scene");
    assert_eq!(counts(&renderer, &scene), 0);
}

/// A screen or a pixel without a size is refused on both paths, and nothing is projected on it. So is a screen larger than
/// any frame.
#[test]
fn screens_and_pixels_need_a_size() {
    let (mut scene, _) = three();
    for vertex_path in VertexPath::ALL {
        scene.settings.vertex_path = Some(vertex_path);
        for pixel_aspect in [(0, 1), (1, 0), (0, 0)] {
            let mut bytes = [7; 64 * 40];
            let frame = Frame::new(&mut bytes, 64, 40, 64).expect("a frame");
            let error = Renderer::new().draw_frame(&scene, frame, pixel_aspect).expect_err("no shape");
            assert!(matches!(error, RenderError::Screen(_)), "{error}");
            assert_eq!(bytes, [7; 64 * 40]);
            let screen = Screen { pixel_aspect, ..Screen::MODE_13H };
            assert_eq!(scene.camera.project(Vec3::ZERO, screen), None);
            assert_eq!(scene.camera.ray([1.0, 1.0], screen), None);
        }
        for (width, height) in [(0, 200), (320, 0), (4_097, 200), (320, u32::MAX)] {
            let screen = Screen { width, height, ..Screen::MODE_13H };
            let error = Renderer::new().make_plan(&scene, screen).expect_err("no pixels, or too many");
            assert!(matches!(error, RenderError::Screen(_)), "{error}");
        }
    }
}

#[test]
fn a_mesh_with_more_surfaces_brings_their_materials() {
    let (mut scene, [torus, ..]) = three();
    scene[torus].materials[0].diffuse = 0.25;
    let cube = shapes::cube();
    let surfaces = vec![Surface::default(); 2];
    let of_triangle = (0..12).map(|triangle| triangle / 6).collect();
    let mesh = cube.with_surfaces(surfaces, of_triangle).expect("a surface for each triangle");
    scene[torus].set_mesh(mesh.clone());
    assert_eq!(scene[torus].materials[1..], Object::new(mesh).materials[1..]);
    assert_eq!((scene[torus].materials.len(), scene[torus].materials[0].diffuse), (2, 0.25));
    drawn(&scene);
}

#[test]
fn vertices_with_more_fraction_bits_than_there_are_are_refused() {
    let (mut scene, _) = three();
    scene.settings.vertex_bits = Some(8);
    drawn(&scene);
    scene.settings.vertex_bits = Some(9);
    let refused = Renderer::new().draw(&scene, &mut Vga::new());
    assert!(matches!(refused, Err(RenderError::Settings(_))));
}

/// However great the shininess, a highlight of one colour leaves the light of the other channels: the power of a rounded
/// cosine just above 1 is finite.
#[test]
fn a_great_shininess_leaves_the_ambient_light() {
    let towards = Vec3::new(0.6, 0.0, 0.8);
    let mesh = Mesh::with_normals(
        [[-1.0, -1.0], [1.0, -1.0], [0.0, 1.0]].map(|[x, y]| Vec3::new(0.8 * x, y, -0.6 * x)).to_vec(),
        vec![towards; 3],
        vec![[0, 1, 2]],
    );
    let mut scene = Scene::new();
    let id = scene.add(Object::new(mesh.expect("a triangle")));
    (scene[id].materials[0].color, scene[id].materials[0].specular) = ([1.0, 0.9, 0.9], 1.0);
    scene.camera.eye = towards * 1e4;
    scene.camera.field_of_view = Angle::from_degrees(0.02);
    scene.ambient = 1.0;
    scene.add_light(Light::sun(towards).with_color([1.0, 0.0, 0.0]));
    scene.settings.accuracy = Some(Shading::Phong.into());
    let mut with = |shininess: f32| {
        scene[id].materials[0].shininess = shininess;
        drawn(&scene)
    };
    let expected = with(1e9);
    assert!([1e11, 1e12, 1e20, f32::MAX].into_iter().all(|shininess| with(shininess) == expected));
}

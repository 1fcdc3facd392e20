//! The list of frames.

use alloc::format;
use alloc::string::String;
use alloc::vec::Vec;

use mode13h::Angle;
use mode13h::glam::{Vec2, Vec3, vec3};
use mode13h::light::{Blend, Cone, Light, LightResponse, Material, RampChoice};
use mode13h::mesh::{Mesh, shapes};
use mode13h::palette::{Palette, Rgb, builtin};
use mode13h::scene::{Camera, Fog, Object, Scene, Shared, UpAxis};
use mode13h::settings::DitherPattern;
use mode13h::settings::{Accuracy, HiddenSurfaces, Mapping, Settings, Shading, VertexPath};

use super::shipped::{self, texture};
use super::{Frame, Picture, Shape};

/// Every frame, in a fixed order.
pub(super) fn all() -> Vec<Frame> {
    let mut list = List(Vec::new());
    list.shapes();
    list.effects();
    list.mappings();
    list.glass_and_fog();
    list.lights_and_palettes();
    list.budgets();
    list.near();
    list.objects();
    list.canvases();
    list.shipped();
    list.0
}

struct List(Vec<Frame>);

impl List {
    fn add(&mut self, name: String, make: impl Fn() -> Picture + 'static) {
        self.0.push(Frame::new(name, make));
    }

    /// Adds a frame on the VGA.
    fn vga(&mut self, name: String, settings: Settings, scene: impl Fn() -> Scene + 'static) {
        self.add(name, move || Picture { scene: scene(), settings, shape: Shape::Vga });
    }

    /// Every shape with every shading; the sphere, the cube and the torus in 16.16 as well.
    fn shapes(&mut self) {
        for (i, &name) in shapes::NAMES.iter().enumerate() {
            for (j, shading) in Shading::ALL.into_iter().enumerate() {
                let scene = move || {
                    let mut scene = showing(shapes::by_name(name).unwrap_or_else(shapes::cube));
                    let number = i + j;
                    scene.palette = Some(builtin::ALL[number % builtin::ALL.len()].palette.clone());
                    scene.objects_mut()[0].angles = [0.4, number as f64 * 1.7, 0.1].map(Angle::from_radians);
                    scene.background = j as u8;
                    scene
                };
                self.vga(format!("shape/{name}/{shading}"), with(shading), scene);
                if i < 3 {
                    let mut settings = with(shading);
                    settings.vertex_path = Some(VertexPath::Integer);
                    self.vga(format!("shape/{name}/{shading}/16.16"), settings, scene);
                }
            }
        }
    }

    /// Every effect with every shading. Hidden-surface methods alternate, so that each is combined with every effect
    /// and every shading.
    fn effects(&mut self) {
        for (i, &(name, change)) in EFFECTS.iter().enumerate() {
            for (j, shading) in Shading::ALL.into_iter().enumerate() {
                let method = HiddenSurfaces::ALL[(i + j + j / 4) % HiddenSurfaces::ALL.len()];
                let mut settings = with(shading);
                settings.hidden_surfaces = Some(method);
                self.vga(format!("effect/{name}/{shading}/{method}"), settings, move || {
                    let mut scene = pair((i + j) as f64);
                    change(&mut scene);
                    scene
                });
            }
        }
    }

    /// A floor that recedes from the eye, with every mapping, with and without mipmaps, from four heights, so that each
    /// of the eight levels is drawn somewhere.
    fn mappings(&mut self) {
        for mapping in Mapping::ALL {
            for mipmaps in [false, true] {
                for (height, repeat) in [(0.3_f32, 1.0_f32), (1.0, 4.0), (3.0, 16.0), (9.0, 64.0)] {
                    let mut settings = Settings::default();
                    (settings.mapping, settings.mipmaps) = (Some(mapping), Some(mipmaps));
                    let filter = if mipmaps { "mipmaps" } else { "texels" };
                    let is_lit = height != 1.0;
                    self.vga(format!("mapping/{mapping}/{filter}/{height}"), settings, move || {
                        floor(height, repeat, if is_lit { "bricks" } else { "checker" }, is_lit)
                    });
                }
            }
        }
    }

    fn glass_and_fog(&mut self) {
        let blends = [("mix", Blend::Mix(90)), ("add", Blend::Add), ("mostly", Blend::Mix(230))];
        for (front, first) in blends {
            for (behind, second) in blends {
                self.vga(format!("glass/{front}-over-{behind}"), Settings::default(), move || {
                    glass(first, second, None)
                });
            }
        }
        for (name, shading) in [("flat", Shading::Flat), ("phong", Shading::Phong)] {
            self.vga(format!("glass/textured/{name}"), with(shading), || {
                glass(Blend::Mix(128), Blend::Add, Some("bricks"))
            });
        }
        for (name, color, start, end) in [
            ("bright", [250, 250, 250], 1.0, 12.0),
            ("dark", [0, 0, 0], 1.0, 12.0),
            ("from-behind-the-eye", [140, 140, 140], -6.0, 9.0),
            ("dense", [90, 90, 90], 2.0, 2.5),
        ] {
            for (what, textured) in [("matt", None), ("textured", Some("bricks"))] {
                self.vga(format!("fog/{name}/{what}"), Settings::default(), move || {
                    let mut scene = floor(1.0, 8.0, textured.unwrap_or("checker"), true);
                    if textured.is_none() {
                        scene.objects_mut()[0].materials[0].texture = None;
                    }
                    scene.add(at(Object::new(shapes::cylinder(12, 2)), vec3(-0.8, 0.4, -2.0)));
                    scene.add(at(Object::new(shapes::torus(12, 8)), vec3(0.9, 0.2, -5.0)));
                    let [r, g, b] = color;
                    scene.fog = Some(Fog { color: Rgb::new(r, g, b), start, end });
                    scene
                });
            }
        }
    }

    fn lights_and_palettes(&mut self) {
        let (ordered, blue_noise) = (Some(DitherPattern::Ordered), Some(DitherPattern::BlueNoise));
        for (name, dither) in [("plain", None), ("dithered", ordered), ("blue-noise", blue_noise)] {
            for shading in [Shading::Flat, Shading::Gouraud88Reseeded, Shading::Phong, Shading::GouraudFloat] {
                self.vga(format!("light/coloured-lamps/{name}/{shading}"), with(shading), move || {
                    let mut scene = pair(1.0);
                    scene.palette = colors();
                    scene.settings.dither = dither;
                    colored_lamps(&mut scene);
                    scene
                });
            }
        }
        for (name, dither, last) in
            [("dithered", ordered, Shading::PhongTable), ("blue-noise", blue_noise, Shading::Phong)]
        {
            for shading in [Shading::Gouraud88, Shading::Gouraud1616, Shading::GouraudFloat, last] {
                self.vga(format!("light/{name}-ramps/{shading}"), with(shading), move || {
                    let mut scene = pair(2.0);
                    scene.palette = Some(builtin::MATERIALS_16X16.clone());
                    scene.settings.dither = dither;
                    scene
                });
            }
        }
        for (name, color) in [("white", None), ("coloured", Some([1.0, 0.7, 0.2]))] {
            for shading in [Shading::Flat, Shading::Gouraud88Reseeded, Shading::Phong, Shading::PhongTable] {
                self.vga(format!("light/spot/{name}/{shading}"), with(shading), move || spots(color));
            }
            let settings = Settings { accuracy: Some(Accuracy::WithinError(2.0)), ..Settings::default() };
            self.vga(format!("light/spot/{name}/within-2"), settings, move || spots(color));
        }
        self.vga("light/ten-lamps".into(), Settings::default(), || {
            let mut scene = pair(0.5);
            for i in 0..10_u8 {
                let angle = f32::from(i) * 0.6;
                let place = [2.0 * libm::cosf(angle), f32::from(i) * 0.3 - 1.5, 2.0 * libm::cosf(angle - 1.5)];
                scene.add_light(Light::lamp(place, 2.5).with_intensity(0.4));
            }
            scene
        });
        for builtin in &builtin::ALL {
            let palette = builtin.palette;
            self.vga(format!("palette/{}", builtin.name), Settings::default(), move || {
                let mut scene = showing(shapes::teapot(6));
                scene.palette = Some(palette.clone());
                scene
            });
        }
        // Sixteen colours without ramps.
        for shading in [Shading::Flat, Shading::Gouraud88Reseeded, Shading::Phong] {
            self.vga(format!("palette/sixteen-colours/{shading}"), with(shading), || {
                let mut scene = pair(0.0);
                scene.palette = Some(sixteen());
                scene
            });
        }
    }

    /// Five budgets on six scenes.
    fn budgets(&mut self) {
        for name in ["torus", "cube", "phong", "fog", "flash", "still"] {
            for shades in [16.0_f32, 4.0, 2.0, 1.0, 0.5] {
                let settings = Settings { accuracy: Some(Accuracy::WithinError(shades)), ..Settings::default() };
                self.vga(format!("budget/{name}/{shades}"), settings, move || by_name(name, 0.4));
            }
        }
    }

    /// Two interpenetrating tori that extend through the near plane and beyond the guard band.
    fn near(&mut self) {
        for method in HiddenSurfaces::ALL {
            for (i, shading) in Shading::ALL.into_iter().enumerate() {
                let mut settings = with(shading);
                settings.hidden_surfaces = Some(method);
                settings.vertex_path = (i % 4 == 3).then_some(VertexPath::Integer);
                let path = if i % 4 == 3 { "/16.16" } else { "" };
                self.vga(format!("near/{method}/{shading}{path}"), settings, move || close_up(i as f64 * 0.7));
            }
        }
    }

    fn objects(&mut self) {
        let mut add = |name: &str, change: fn(&mut Scene)| {
            self.vga(format!("object/{name}"), Settings::default(), move || {
                let mut scene = pair(0.0);
                change(&mut scene);
                scene
            });
        };
        add("child", |scene| {
            let ids = scene.object_ids().to_vec();
            scene.objects_mut()[1].parent = Some(ids[0]);
            scene.objects_mut()[1].scale = 0.5;
        });
        add("grandchild-of-a-hidden-one", |scene| {
            let mut third = at(Object::new(shapes::cube()), vec3(0.0, 1.0, 0.5));
            third.scale = 0.6;
            third.parent = Some(scene.object_ids()[1]);
            scene.add(third);
            let ids = scene.object_ids().to_vec();
            scene.objects_mut()[1].parent = Some(ids[0]);
            scene.objects_mut()[1].visible = false;
            // Beside the others, without a parent.
            scene.add(at(Object::new(shapes::cone(7, 2)), vec3(-1.0, -0.8, 0.6)));
        });
        add("z-up", |scene| scene.objects_mut()[0].up_axis = UpAxis::Z);
        add("tiny", |scene| scene.objects_mut()[0].scale = 1e-4);
        add("size-0", |scene| scene.objects_mut()[0].scale = 0.0);
        add("toon", |scene| {
            let toon = LightResponse::new(|intensity| {
                if intensity < 0.3 {
                    0.2
                } else if intensity < 0.7 {
                    0.5
                } else {
                    1.0
                }
            });
            scene.objects_mut()[0].materials[0].response = Some(toon);
        });
        add("dark", |scene| scene.clear_lights());
        add("many-small-faces", |scene| {
            scene.add(at(Object::new(shapes::sphere(90, 45)), vec3(-0.6, 0.4, 0.8)));
        });
        add("tall-thin-faces", |scene| {
            let wall = shapes::wall(120, 1);
            scene.add(at(Object::new(wall), vec3(0.3, 0.2, 1.0)));
        });
        add("wide-thin-faces", |scene| {
            let wall = shapes::wall(1, 120);
            scene.add(turned(at(Object::new(wall), vec3(0.3, 0.2, 1.0)), 0.3));
        });
        add("facets", |scene| {
            let mut mesh = shapes::sphere(12, 6);
            mesh.flat();
            scene.add(at(Object::new(mesh), vec3(-0.6, 0.4, 0.8)));
        });
        add("upside-down-camera", |scene| scene.camera.up = vec3(0.3, -1.0, 0.0));
        add("far-from-the-origin", |scene| {
            for object in scene.objects_mut() {
                object.position += vec3(4096.0, -8192.0, 2048.0);
            }
            scene.camera.eye += vec3(4096.0, -8192.0, 2048.0);
            scene.camera.target += vec3(4096.0, -8192.0, 2048.0);
        });
        self.vga("object/none".into(), Settings::default(), Scene::new);
    }

    /// Frames of shapes other than the VGA's. Effects extend beyond column 320, next to padding between rows, and
    /// across bands.
    fn canvases(&mut self) {
        let shapes = [
            ("pitch", Shape::Canvas { width: 1_021, height: 97, pitch: 1_100, band: 97 }),
            ("wide", Shape::Canvas { width: 2_500, height: 33, pitch: 2_500, band: 33 }),
            ("tall", Shape::Canvas { width: 61, height: 700, pitch: 64, band: 700 }),
            ("bands", Shape::Canvas { width: 320, height: 200, pitch: 333, band: 13 }),
        ];
        for (name, shape) in shapes {
            for (effects, change, shading) in CANVASES {
                self.add(format!("canvas/{name}/{effects}"), move || {
                    let mut scene = pair(3.0);
                    change(&mut scene);
                    // The scene fills the height or the width.
                    scene.camera.eye.z = if name == "tall" { 2.2 } else { 1.6 };
                    Picture { scene, settings: with(shading), shape }
                });
            }
        }
    }

    /// The program's scenes at the moment that shows them best, and at another one.
    fn shipped(&mut self) {
        for (name, make) in shipped::ALL {
            for (moment, part) in [("picture", None), ("later", Some(0.8))] {
                // An automatic palette takes longer than all other frames together.
                if part.is_some() && ["rgb", "crate", "mirror"].contains(&name) {
                    continue;
                }
                self.vga(format!("shipped/{name}/{moment}"), Settings::default(), move || {
                    let scene = make();
                    let seconds = part.map_or(scene.picture, |part| part * scene.duration);
                    shipped::at(scene, seconds)
                });
            }
        }
    }
}

fn with(shading: Shading) -> Settings {
    Settings { accuracy: Some(shading.into()), ..Settings::default() }
}

/// One of the program's scenes, at a fraction of its duration.
fn by_name(name: &str, part: f64) -> Scene {
    let make =
        shipped::ALL.iter().find(|(other, _)| *other == name).map_or(Scene::new as fn() -> Scene, |(_, make)| *make);
    let scene = make();
    let seconds = part * scene.duration;
    shipped::at(scene, seconds)
}

/// A mesh in the centre, under one sun.
fn showing(mesh: impl Into<Shared<Mesh>>) -> Scene {
    let mut scene = Scene::new();
    scene.add(Object::new(mesh));
    scene.add_light(Light::sun([0.4, 0.6, 1.0]));
    scene
}

fn at(mut object: Object, position: Vec3) -> Object {
    object.position = position;
    object
}

fn turned(mut object: Object, radians: f64) -> Object {
    object.angles = [0.7 * radians, radians, 0.3].map(Angle::from_radians);
    object
}

/// A torus, with a sphere behind it and to the side.
fn pair(turn: f64) -> Scene {
    let mut scene = Scene::new();
    scene.palette = Some(builtin::MATERIALS_4X64.clone());
    scene.add(turned(at(Object::new(shapes::torus(16, 8)), vec3(-0.3, 0.0, 0.0)), turn));
    let mut sphere = at(Object::new(shapes::sphere(14, 7)), vec3(0.55, 0.15, -0.45));
    sphere.materials[0].ramp = RampChoice::Number(1);
    scene.add(turned(sphere, turn + 1.0));
    scene.add_light(Light::sun([0.4, 0.6, 1.0]).with_intensity(0.9));
    scene
}

/// A change to the two objects of [`pair`].
type Change = fn(&mut Scene);

/// The effects, each applied to both objects.
const EFFECTS: [(&str, Change); 18] = [
    ("fog", |scene| scene.fog = Some(Fog { color: Rgb::new(120, 130, 150), start: 1.5, end: 4.0 })),
    ("highlight", |scene| {
        each(scene, |material| {
            (material.diffuse, material.specular, material.shininess) = (0.5, 0.5, 18.0);
        });
    }),
    ("lamp", |scene| {
        scene.add_light(Light::lamp([0.3, 0.8, 1.2], 3.0).with_intensity(0.9));
    }),
    ("coloured-lamps", colored_lamps),
    ("colours", |scene| {
        each(scene, |material| (material.color, material.highlight) = ([0.9, 0.4, 0.2], [0.5, 0.6, 1.0]));
        each(scene, |material| (material.specular, material.shininess) = (0.3, 9.0));
    }),
    ("nearest", |scene| each(scene, |material| material.ramp = RampChoice::Nearest)),
    ("dither", |scene| {
        scene.palette = Some(builtin::MATERIALS_8X32.clone());
        scene.settings.dither = Some(DitherPattern::Ordered);
    }),
    ("tessellation", |scene| scene.settings.tessellation = Some(2.0)),
    ("texture", |scene| textured(scene, "checker", Mapping::Affine, false)),
    ("texture-every-16", |scene| textured(scene, "bricks", Mapping::Every16, false)),
    ("texture-perspective", |scene| textured(scene, "crate", Mapping::Perspective, false)),
    ("mipmaps", |scene| textured(scene, "crate", Mapping::Perspective, true)),
    ("texture-unlit", |scene| {
        textured(scene, "bricks", Mapping::Affine, false);
        each(scene, |material| (material.ambient, material.diffuse) = (1.0, 0.0));
    }),
    ("texture-in-fog", |scene| {
        textured(scene, "bricks", Mapping::Perspective, true);
        scene.fog = Some(Fog { color: Rgb::new(120, 130, 150), start: 1.5, end: 4.0 });
    }),
    ("environment", |scene| {
        scene.palette = colors();
        let sky = texture("sky");
        each(scene, |material| material.environment.clone_from(&sky));
    }),
    ("glass", |scene| scene.objects_mut()[0].materials[0].blend = Blend::Mix(128)),
    ("glenz", |scene| scene.objects_mut()[0].materials[0].blend = Blend::Add),
    ("everything", |scene| {
        textured(scene, "bricks", Mapping::Perspective, true);
        scene.objects_mut()[0].materials[0].blend = Blend::Mix(170);
        scene.objects_mut()[1].materials[0].texture = None;
        each(scene, |material| (material.diffuse, material.specular, material.shininess) = (0.5, 0.4, 12.0));
        scene.fog = Some(Fog { color: Rgb::new(60, 60, 90), start: 1.0, end: 6.0 });
        scene.settings.dither = Some(DitherPattern::Ordered);
        colored_lamps(scene);
    }),
];

/// Scenes for frames of shapes other than the VGA's.
const CANVASES: [(&str, Change, Shading); 10] = [
    ("plain", |_| {}, Shading::Gouraud88Reseeded),
    ("float", |_| {}, Shading::GouraudFloat),
    ("hyperbolic", |_| {}, Shading::GouraudHyperbolic),
    ("phong-in-fog", |scene| (EFFECTS[0].1)(scene), Shading::Phong),
    ("dither", |scene| (EFFECTS[6].1)(scene), Shading::Gouraud88Reseeded),
    ("texture", |scene| (EFFECTS[8].1)(scene), Shading::Gouraud88Reseeded),
    ("mipmaps", |scene| (EFFECTS[11].1)(scene), Shading::GouraudFloat),
    ("glass", |scene| (EFFECTS[15].1)(scene), Shading::Gouraud88),
    ("everything", |scene| (EFFECTS[17].1)(scene), Shading::Gouraud88Reseeded),
    (
        "blue-noise",
        |scene| {
            (EFFECTS[6].1)(scene);
            scene.settings.dither = Some(DitherPattern::BlueNoise);
        },
        Shading::Gouraud88Reseeded,
    ),
];

fn each(scene: &mut Scene, change: impl Fn(&mut Material)) {
    scene.objects_mut().iter_mut().flat_map(|object| &mut object.materials).for_each(change);
}

/// A palette of all kinds of colours, without ramps.
fn colors() -> Option<Palette> {
    builtin::by_name("cube").map(|builtin| builtin.palette.clone())
}

fn textured(scene: &mut Scene, name: &str, mapping: Mapping, mipmaps: bool) {
    let texture = texture(name);
    each(scene, |material| material.texture.clone_from(&texture));
    scene.palette.clone_from(&colors());
    (scene.settings.mapping, scene.settings.mipmaps) = (Some(mapping), Some(mipmaps));
}

fn colored_lamps(scene: &mut Scene) {
    scene.add_light(Light::lamp([-1.2, 0.6, 1.0], 3.5).with_color([1.0, 0.2, 0.1]));
    scene.add_light(Light::lamp([1.4, -0.4, 0.8], 3.0).with_color([0.1, 0.3, 1.0]).with_intensity(1.2));
}

/// A wall with few faces and a torus in front of it, crossed by the edges of two spot lights: a soft one, and a narrow
/// sharp one.
fn spots(color: Option<[f32; 3]>) -> Scene {
    let mut scene = Scene::new();
    scene.palette = if color.is_some() { colors() } else { Some(builtin::GREY.clone()) };
    let mut wall = at(Object::new(shapes::wall(9, 7)), vec3(0.0, 0.0, -1.0));
    wall.scale = 2.0;
    scene.add(wall);
    scene.add(turned(at(Object::new(shapes::torus(24, 12)), vec3(-0.4, 0.1, 0.2)), 0.8));
    let cone = |direction: Vec3, inner, outer| {
        let [inner, outer] = [inner, outer].map(Angle::from_degrees);
        Cone { direction, inner, outer }
    };
    let soft = Light::spot([1.0, 1.2, 2.5], 8.0, cone(vec3(-1.3, -1.2, -3.0), 6.0, 19.0));
    let sharp = Light::spot([1.4, -0.6, 1.5], 7.0, cone(vec3(-0.4, 0.3, -2.5), 11.0, 11.0));
    scene.add_light(soft.with_color(color.unwrap_or([1.0; 3])).with_intensity(1.5));
    scene.add_light(sharp.with_intensity(0.8));
    scene
}

/// A floor that recedes from the eye, with a repeating texture.
fn floor(height: f32, repeat: f32, name: &str, is_lit: bool) -> Scene {
    let mut scene = Scene::new();
    scene.palette = colors();
    let mesh = shapes::wall(2, 6);
    let texcoords: Vec<Vec2> = mesh.texcoords().unwrap_or_default().iter().map(|t| *t * repeat).collect();
    let mesh = mesh.clone().with_texcoords(texcoords).unwrap_or(mesh);
    let mut floor = Object::new(mesh);
    floor.scale = 12.0;
    floor.angles[0] = Angle::from_degrees(-90.0);
    floor.position = vec3(0.0, -0.5, -4.0);
    let material = &mut floor.materials[0];
    material.texture = texture(name);
    (material.ambient, material.diffuse) = if is_lit { (0.3, 0.7) } else { (1.0, 0.0) };
    scene.add(floor);
    scene.add_light(Light::sun([0.5, 0.8, 0.3]));
    scene.camera =
        Camera { eye: vec3(0.4, height - 0.5, 3.0), target: vec3(0.0, -0.5, -4.0), near: 0.1, ..Camera::default() };
    scene
}

/// Three objects, one behind another; the first two are translucent.
fn glass(front: Blend, behind: Blend, name: Option<&str>) -> Scene {
    let mut scene = Scene::new();
    scene.palette = colors();
    let mut wall = at(Object::new(shapes::wall(4, 4)), vec3(0.0, 0.0, -1.0));
    wall.scale = 2.0;
    wall.materials[0].texture = texture("checker");
    scene.add(wall);
    for (blend, position, color) in
        [(front, vec3(-0.3, 0.1, 0.8), [1.0, 0.5, 0.2]), (behind, vec3(0.3, -0.1, 0.0), [0.3, 0.8, 1.0])]
    {
        let mut body = turned(at(Object::new(shapes::torus(12, 8)), position), 0.9);
        body.scale = 0.8;
        (body.materials[0].blend, body.materials[0].color) = (blend, color);
        body.materials[0].texture = name.and_then(texture);
        scene.add(body);
    }
    scene.add_light(Light::sun([0.4, 0.6, 1.0]));
    scene
}

/// Two interpenetrating tori that extend beyond the near plane and the guard band.
fn close_up(turn: f64) -> Scene {
    let torus = Shared::new(shapes::torus(24, 12));
    let mut scene = showing(torus.clone());
    scene.palette = Some(builtin::COPPER.clone());
    let mut second = at(Object::new(torus), vec3(0.5, 0.0, 0.0));
    second.angles = [1.5, turn, 0.0].map(Angle::from_radians);
    scene.add(second);
    scene.objects_mut()[0].angles = [0.2, 0.1, turn].map(Angle::from_radians);
    scene.camera.near = 0.3;
    scene.camera.eye.z = 1.1;
    scene.add_light(Light::sun([-1.0, 0.2, 0.3]).with_intensity(0.4));
    scene
}

/// The colours of the EGA, which have no ramps.
fn sixteen() -> Palette {
    let mut colors = [Rgb::BLACK; 256];
    for (i, color) in (0..16_u8).zip(&mut colors) {
        let level = |bit: u8| if i & bit != 0 { 170 } else { 0 } + if i & 8 != 0 { 85 } else { 0 };
        let green = if i == 6 { 85 } else { level(2) };
        *color = Rgb::new(level(4), green, level(1));
    }
    Palette::from_colors(colors)
}

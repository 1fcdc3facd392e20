//! Nothing is allocated after the first frame of a plan, as counted by an allocator.
//!
//! A frame's plan consists of the decisions for each object and the hidden-surface method. A frame may allocate only if
//! no frame before it had its plan, so the second frame of a scene with an unchanged plan may not, no matter how many
//! more faces come into view as it turns. Two things have no bound known in advance that would not waste memory, and
//! grow with what is seen: triangles split by tessellation, and parts of those cut by clip planes. A frame that has
//! more of them than any before may allocate for them; a second turn, which has no more than the first, may not.

use allocation_counter::measure;
use mode13h::Angle;
use mode13h::glam::Vec3;
use mode13h::light::Light;
use mode13h::mesh::{Mesh, shapes};
use mode13h::plan::{Choice, Decision, Effect};
use mode13h::render::{Renderer, Stats};
use mode13h::scene::{Motion, Object, Scene};
use mode13h::settings::DitherPattern;
use mode13h::settings::{Accuracy, HiddenSurfaces, Mapping, Shading, VertexPath};
use mode13h::vga::Vga;
use mode13h_assets::shipped;

use crate::support::tried::Tried;

/// Frames per turn.
const FRAMES: u32 = 6;

/// The decisions without the reasons: for each object each effect and which of several methods it uses, and the
/// hidden-surface method.
type Decided = (Vec<Vec<(bool, Choice)>>, HiddenSurfaces);

fn decided(renderer: &Renderer) -> Decided {
    let plan = renderer.plan();
    let decision = |&Decision { on, choice, .. }: &Decision| (on, choice);
    let objects = plan.objects().iter().map(|object| {
        let others = Effect::ALL.into_iter().filter(|effect| *effect != Effect::Transform);
        others.map(|effect| decision(&object[effect])).collect()
    });
    (objects.collect(), plan.hidden_surfaces())
}

/// The number of one frame's allocations, and its statistics.
fn draw(renderer: &mut Renderer, scene: &mut Scene, vga: &mut Vga, seconds: f64) -> (u64, Stats) {
    let mut drawn = None;
    let counted = measure(|| {
        scene.set_time(seconds);
        drawn = Some(renderer.draw(scene, vga));
    });
    let stats = drawn.expect("it was called").expect("a legal scene");
    (counted.count_total, stats)
}

/// Draws two turns, and reports what is wrong.
fn turns(what: &str, scene: &mut Scene, renderer: &mut Renderer) -> Vec<String> {
    let mut vga = Vga::new();
    let mut wrong = Vec::new();
    let (mut plans, mut most) = (Vec::new(), [0; 4]);
    for frame in 0..2 * FRAMES {
        // Six poses of a turn that takes 10 s, then the same again.
        let seconds = f64::from(frame % FRAMES) * 10.0 / f64::from(FRAMES);
        let (count, stats) = draw(renderer, scene, &mut vga, seconds);
        let plan = decided(renderer);
        let is_new = !plans.contains(&plan);
        if is_new {
            plans.push(plan);
        }
        let grows = renderer.plan().is_on_anywhere(Effect::Tessellation) || stats.clipped > 0;
        let counts = [stats.vertices, stats.faces, stats.drawn, stats.clipped];
        let more = grows && counts.iter().zip(most).any(|(count, most)| *count > most);
        most = [0, 1, 2, 3].map(|i| most[i].max(counts[i]));
        if count > 0 && !is_new && !more {
            wrong.push(format!("{what}, frame {frame}: {count} allocations"));
        }
    }
    wrong
}

#[test]
fn nothing_is_allocated_after_the_first_frame_of_a_plan() {
    let mut tried = Tried::new("nothing_is_allocated_after_the_first_frame_of_a_plan", 18 * 40 * 12);
    let mut wrong = Vec::new();
    let mut try_one = |what: String, scene: &Scene, set: &dyn Fn(&mut Scene, &mut Renderer)| {
        let (mut scene, mut renderer) = (scene.clone(), Renderer::new());
        set(&mut scene, &mut renderer);
        wrong.extend(turns(&what, &mut scene, &mut renderer));
        tried.add(u64::from(2 * FRAMES));
    };
    for shipped in &shipped::ALL {
        let name = shipped.name;
        let scene = shipped.load().expect("it is shipped").scene;
        try_one(name.to_string(), &scene, &|_, _| ());
        for way in HiddenSurfaces::ALL {
            try_one(format!("{name}, {way}"), &scene, &|_, renderer| renderer.settings.hidden_surfaces = Some(way));
        }
        for shading in Shading::ALL {
            try_one(format!("{name}, {shading}"), &scene, &|_, renderer| {
                renderer.settings.accuracy = Some(shading.into());
            });
        }
        for mapping in Mapping::ALL {
            try_one(format!("{name}, {mapping}"), &scene, &|_, renderer| renderer.settings.mapping = Some(mapping));
        }
        for shades in [0.8, 2.0] {
            try_one(format!("{name}, within {shades}"), &scene, &|_, renderer| {
                renderer.settings.accuracy = Some(Accuracy::WithinError(shades));
            });
        }
        try_one(format!("{name}, in integers"), &scene, &|_, renderer| {
            renderer.settings.vertex_path = Some(VertexPath::Integer)
        });
        try_one(format!("{name}, dithered"), &scene, &|scene, _| scene.settings.dither = Some(DitherPattern::Ordered));
        for effect in Effect::ALL {
            try_one(format!("{name}, {effect} forced"), &scene, &|_, renderer| renderer.force(effect, Some(true)));
        }
    }
    assert!(wrong.is_empty(), "{} frames:\n{}", wrong.len(), wrong.join("\n"));
}

/// An object that turns about its axis once in 10 s.
fn turning(mesh: Mesh) -> Scene {
    let mut scene = Scene::new();
    let object = scene.add(Object::new(mesh));
    scene.add_light(Light::sun([0.4, 0.6, 1.0]));
    scene.motions.push(Motion::Spin { object, start: [Angle::default(); 3], turns: [0.0, 0.1, 0.0] });
    scene
}

#[test]
fn nor_of_a_fine_body_or_one_that_is_cut() {
    let mut tried = Tried::new("nor_of_a_fine_body_or_one_that_is_cut", 2 * 4 * 12);
    let mut wrong = Vec::new();
    let fine = turning(shapes::sphere(200, 100));
    // Half of the torus is behind the eye.
    let mut cut = turning(shapes::torus(48, 24));
    cut.camera.eye = Vec3::new(0.7, 0.1, 0.2);
    let clipped = Renderer::new().draw(&cut, &mut Vga::new()).expect("a legal scene").clipped;
    assert!(clipped > 100, "{clipped} faces are cut");
    for (name, scene) in [("a sphere", fine), ("a torus around the eye", cut)] {
        for way in HiddenSurfaces::ALL {
            let (mut scene, mut renderer) = (scene.clone(), Renderer::new());
            renderer.settings.hidden_surfaces = Some(way);
            wrong.extend(turns(&format!("{name}, {way}"), &mut scene, &mut renderer));
            tried.add(u64::from(2 * FRAMES));
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

#[test]
fn an_allocation_is_counted() {
    assert_eq!(measure(|| drop(std::hint::black_box(vec![1_u8]))).count_total, 1);
    // The first frame of a renderer allocates, the second does not.
    let mut scene = "torus".parse::<shipped::Shipped>().expect("it is shipped").load().expect("it loads").scene;
    let (mut renderer, mut vga) = (Renderer::new(), Vga::new());
    let (first, _) = draw(&mut renderer, &mut scene, &mut vga, 0.0);
    let (second, _) = draw(&mut renderer, &mut scene, &mut vga, 1.0);
    assert!(first > 0 && second == 0, "{first} and {second}");
}

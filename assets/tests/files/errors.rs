//! The messages of the library's errors and panics.

use std::error::Error;
use std::panic::{AssertUnwindSafe, catch_unwind};

use mode13h::light::Light;
use mode13h::mesh::{Mesh, shapes};
use mode13h::render::Renderer;
use mode13h::scene::{Object, Scene};
use mode13h::settings::Shading;
use mode13h::texture::Texture;
use mode13h::vga::Vga;
use mode13h_assets::SceneExt;
use mode13h_assets::palette_file;

use crate::support::workspace;

/// A `main` that returns an error prints it with `Debug`.
#[test]
fn errors_print_what_they_display() {
    let mut scene = Scene::showing(shapes::cube());
    scene.camera.eye = scene.camera.target;
    let errors: [Box<dyn Error>; 6] = [
        Box::new(Mesh::new(Vec::new(), vec![[0, 1, 2]]).unwrap_err()),
        Box::new(palette_file::parse_named("a.gpl", b"nothing").unwrap_err()),
        Box::new(Renderer::new().draw(&scene, &mut Vga::new()).unwrap_err()),
        Box::new(Texture::from_rgb(0, 1, &[]).unwrap_err()),
        Box::new("round".parse::<Shading>().unwrap_err()),
        Box::new(Scene::from_model("none.obj").unwrap_err()),
    ];
    for error in errors {
        assert_eq!(format!("{error:?}"), error.to_string());
    }
    let error = Scene::from_model("none.obj").unwrap_err();
    assert!(error.to_string().starts_with("none.obj: "), "{error}");
}

/// Every error of the library prints this way, through one macro or through the other, which uses it.
#[test]
fn every_error_prints_what_it_displays() {
    let mut errors = 0;
    for (path, text) in ["src", "assets/src"].into_iter().flat_map(workspace::sources) {
        for (_, rest) in text.match_indices("Error for ").map(|(at, start)| text.split_at(at + start.len())) {
            let name = rest.split(|c: char| !c.is_alphanumeric()).next().expect("a name");
            // The other macro's has none.
            if !name.is_empty() {
                assert!(text.contains(&format!("debug_as_display!({name});")), "{path}: {name}");
                errors += 1;
            }
        }
        errors += text.matches("::error_type!(").count();
    }
    assert!(errors >= 18, "{errors}");
}

#[test]
fn an_id_that_was_removed_panics_in_plain_words() {
    let mut scene = Scene::new();
    let object = scene.add(Object::new(shapes::cube()));
    let light = scene.add_light(Light::sun([0.0, 1.0, 0.0]));
    assert!(scene.remove(object).is_some() && scene.remove_light(light).is_some());
    let said = |index: &mut dyn FnMut()| {
        let panic = catch_unwind(AssertUnwindSafe(index)).unwrap_err();
        panic.downcast_ref::<String>().cloned().unwrap_or_default()
    };
    let words = |what: &str| format!("this {what} was removed from the scene, or its id is from another scene");
    assert_eq!(said(&mut || scene[object].visible = false), words("object"));
    assert_eq!(said(&mut || _ = &scene[object]), words("object"));
    assert_eq!(said(&mut || scene[light] = Light::sun([0.0, 1.0, 0.0])), words("light"));
    assert_eq!(said(&mut || _ = &scene[light]), words("light"));
}

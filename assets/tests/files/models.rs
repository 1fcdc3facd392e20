//! Model files as scenes: in one call, and nothing is left out silently.

use std::fs;

use mode13h::scene::Scene;
use mode13h_assets::SceneExt;

/// A model of one square whose material names this texture.
fn with_texture(name: &str, bytes: &[u8]) -> (tempfile::TempDir, Scene, Vec<String>) {
    let folder = tempfile::tempdir().expect("a folder");
    let put = |name: &str, bytes: &[u8]| fs::write(folder.path().join(name), bytes).expect("written");
    let corners = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\n";
    let faces = "usemtl a\nf 1/1 2/2 3/3 4/4\nusemtl b\nf 4/4 3/3 2/2 1/1\n";
    put("a.obj", format!("mtllib a.mtl\n{corners}{faces}").as_bytes());
    put("a.mtl", format!("newmtl a\nmap_Kd {name}\nnewmtl b\nmap_Kd {name}\n").as_bytes());
    if !bytes.is_empty() {
        put(name, bytes);
    }
    let (scene, warnings) = Scene::from_model(folder.path().join("a.obj")).expect("a model");
    (folder, scene, warnings)
}

/// A PNG of two pixels, the second with this opacity.
fn png(color: png::ColorType, opacity: u8) -> Vec<u8> {
    let mut bytes = Vec::new();
    let mut encoder = png::Encoder::new(&mut bytes, 2, 1);
    encoder.set_color(color);
    encoder.set_depth(png::BitDepth::Eight);
    let data: &[u8] = match color {
        png::ColorType::Indexed => {
            encoder.set_palette(vec![1, 2, 3, 4, 5, 6, 7, 8, 9]);
            // The third entry is translucent, and no pixel uses it.
            encoder.set_trns(vec![255, opacity, 0]);
            &[0, 1]
        }
        _ => &[9, 9, 9, 255, 7, 7, 7, opacity],
    };
    encoder.write_header().expect("a header").write_image_data(data).expect("a picture");
    bytes
}

#[test]
fn what_a_model_lacks_is_said_beside_the_scene() {
    let is_textured = |scene: &Scene| scene.objects()[0].materials.iter().all(|material| material.texture.is_some());
    for color in [png::ColorType::Rgba, png::ColorType::Indexed] {
        let (_folder, scene, warnings) = with_texture("a.png", &png(color, 255));
        assert_eq!((is_textured(&scene), warnings), (true, vec![]));
        for opacity in [0, 254] {
            let (folder, scene, warnings) = with_texture("a.png", &png(color, opacity));
            let path = folder.path().join("a.png");
            assert!(is_textured(&scene));
            assert_eq!(warnings, [format!("{}: transparency ignored", path.display())], "{color:?}");
        }
    }
    let (folder, scene, warnings) = with_texture("a.jpg", b"\xFF\xD8\xFF\xE0");
    let path = folder.path().join("a.jpg");
    assert!(!is_textured(&scene));
    let [warning] = warnings.as_slice() else { panic!("{warnings:?}") };
    assert!(warning.starts_with(&format!("{}: not a picture that can be read: ", path.display())), "{warning}");
    assert!(warning.ends_with("; the material is drawn without this texture"), "{warning}");
    let (_folder, scene, warnings) = with_texture("a.png", b"");
    assert!(!is_textured(&scene));
    assert!(warnings.len() == 2 && warnings[0].contains("a.png: no such texture"), "{warnings:?}");
}

/// Other file formats can be translucent, too.
#[test]
fn transparency_of_other_kinds_is_said_beside_the_scene() {
    use image::ImageFormat::{Gif, Tga, WebP};

    for (format, name) in [(Tga, "a.tga"), (WebP, "a.webp"), (Gif, "a.gif")] {
        for opacity in [255, 0] {
            let picture =
                image::RgbaImage::from_fn(4, 4, |x, _| image::Rgba([200, 9, 9, if x < 2 { 255 } else { opacity }]));
            let mut bytes = std::io::Cursor::new(Vec::new());
            picture.write_to(&mut bytes, format).expect("written");
            let (folder, _scene, warnings) = with_texture(name, &bytes.into_inner());
            let note = format!("{}: transparency ignored", folder.path().join(name).display());
            assert_eq!(warnings, if opacity == 0 { vec![note] } else { vec![] }, "{name}, {opacity}");
        }
    }
}

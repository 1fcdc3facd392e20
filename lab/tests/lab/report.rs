//! The report of a real study.

use std::fs;
use std::path::Path;

use mode13h::mesh::shapes;
use mode13h::render::Renderer;
use mode13h::scene::Scene;
use mode13h::settings::Shading;
use mode13h_lab::cost::{Settings, Subject, measure, report};

/// Also writes a report to look at: `report.html` among the test's files.
#[test]
fn what_was_measured_is_reported() {
    let frames = [Scene::showing(shapes::torus(24, 12))];
    let subject = Subject { name: "torus", frames: &frames, steps: &[], renderer: &Renderer::new };
    let mut settings = Settings::default();
    (settings.shadings, settings.seconds) =
        (vec![Shading::Flat, Shading::Gouraud88, Shading::Gouraud1616, Shading::Phong], 0.2);
    let (study, _) = measure(&subject, &settings, &|_, _| {}).expect("a torus can be measured");

    let page = report::html(&study);
    let directory = Path::new(env!("CARGO_TARGET_TMPDIR"));
    fs::write(directory.join("report.html"), &page).expect("a file");
    for row in &study.shadings {
        assert!(page.contains(&format!("frame of {}", row.shading)), "{}", row.shading);
    }
    // Each shading's picture and error map, and the first screen's two pictures.
    assert_eq!(page.matches("data:image/png;base64,").count(), 2 * study.shadings.len() + 2);
    assert_eq!(
        (page.matches("<svg").count(), page.matches("data-points").count()),
        (1, 4),
        "three charts, and a script"
    );
}

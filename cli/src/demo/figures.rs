//! The figures that I shows, and the keys that H shows.

use mode13h::plan::{Choice, Effect};
use mode13h::render::{Shares, Stats};

use super::Demo;
use crate::overlay::Row;

/// The keys, and what each does.
const KEYS: [(&str, &str); 23] = [
    ("Esc", "quit"),
    ("H", "these keys"),
    ("I", "figures of the picture"),
    ("Space", "stop, go on"),
    ("arrows", "turn; the mouse too"),
    ("+ -", "zoom; the wheel too"),
    ("1 to 9", "shade by this shading"),
    ("[ ]", "the shading before, the next"),
    ("0", "shade by a budget of error"),
    ("B", "a smaller budget"),
    ("Shift-B", "a greater one"),
    ("F", "a time; Shift-F longer"),
    ("E", "error map"),
    ("C", "side by side, at the mouse"),
    ("Shift", "[ ] 1 to 9: the right side"),
    ("X", "swap the sides"),
    ("K", "next kernel"),
    ("P", "next palette"),
    ("M", "next mapping of textures"),
    ("L O", "lights, fog"),
    ("T D", "texture, dither"),
    ("S", "save the picture"),
    ("N", "next input, Shift-N back"),
];

/// The rows of the panel of keys.
pub(super) fn help() -> Vec<Row> {
    KEYS.iter().map(|&(key, does)| Row::new(key, does)).collect()
}

/// Formats a number of things, in words.
fn counted(number: usize, thing: &str) -> String {
    format!("{number} {thing}{}", if number == 1 { "" } else { "s" })
}

impl Demo {
    /// The rows of the panel of figures.
    pub(super) fn figures(&self) -> Vec<Row> {
        let objects = self.stage.scene.objects().len();
        let mut rows = vec![
            Row::new("scene", &self.name),
            Row::new("", format!("{}, {}", counted(objects, "object"), counted(self.triangles, "triangle"))),
            Row::new("zoom", format!("{:.2}", self.motion.pose.zoom)),
            Row::new("shading", self.shading.to_string()),
            Row::new("time", self.drawn()),
            Row::new("plan", format!("{:.1} µs", self.planning.frame * 1e6)),
            Row::new("error", self.map.figures(self.number, self.seconds, self.shading.budget(self.stats.as_ref()))),
        ];
        if let (Some(Stats { max_error: Some(error), .. }), Some(fits)) = (&self.stats, self.pacing.fits()) {
            let late = if fits { "" } else { ", takes longer" };
            rows.push(Row::new("within", format!("{error} {}{late}", if *error == 1.0 { "shade" } else { "shades" })));
        }
        if let Some(Stats { hidden_surfaces, vertices, drawn, raster, shares, .. }) = &self.stats {
            let mut head = "shadings";
            for share in of_shadings(shares) {
                rows.push(Row::new(std::mem::take(&mut head), share));
            }
            let (vertices, drawn) = (counted(*vertices as usize, "vertex").replace("vertexs", "vertices"), *drawn);
            rows.push(Row::new("hidden", format!("{hidden_surfaces}")));
            rows.push(Row::new("drawn", format!("{drawn} of {}, {vertices}", counted(self.triangles, "triangle"))));
            let (spans, pixels) = (raster.spans as usize, raster.pixels as usize);
            rows.push(Row::new("", format!("{}, {}", counted(spans, "span"), counted(pixels, "pixel"))));
        }
        rows.push(Row::new("kernel", self.kernels.chosen().to_string()));
        rows.push(Row::new("palette", &self.palettes.chosen().0));
        let mapping = self.mappings.chosen().map_or("by plan", |mapping| mapping.name());
        rows.push(Row::new("mapping", mapping));
        let on = self.effects_on();
        rows.push(Row::new("effects", format!("{} of {} on:", on.len(), Effect::COUNT)));
        rows.push(Row::new("", on.join(", ")));
        rows
    }

    /// The effects that are on: each with its choice, unless the rows above say that, and, if not for all objects, for
    /// how many.
    fn effects_on(&self) -> Vec<String> {
        let objects = self.renderer.plan().objects();
        let entry = |effect: Effect| {
            let on: Vec<_> = objects.iter().map(|plan| &plan[effect]).filter(|decision| decision.on).collect();
            let mut entry = effect.name().to_string();
            let is_said = matches!(effect, Effect::HiddenSurfaces | Effect::Gouraud | Effect::Phong);
            let first = on.first()?;
            if !is_said && first.choice != Choice::Only {
                entry += &format!(" {}", first.choice.name());
            }
            if on.len() < objects.len() {
                entry += &format!(" {}/{}", on.len(), objects.len());
            }
            Some(entry)
        };
        Effect::ALL.into_iter().filter_map(entry).collect()
    }
}

/// Words on the shares of the shadings.
fn of_shadings(shares: &Shares) -> Vec<String> {
    shares.into_iter().map(|(shading, triangles)| format!("{shading} {triangles}")).collect()
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use clap::Parser;
    use mode13h::span::Kernel;
    use mode13h::window::Input;
    use mode13h_assets::shipped;

    use super::*;
    use crate::demo::loader::{self, Inputs};
    use crate::demo::shading::ShadingChoice;
    use crate::options::{Drawing, Moment, ShadingOptions};
    use crate::overlay::tests::WINDOWS;

    #[derive(Parser)]
    struct Words {
        #[command(flatten)]
        drawing: Drawing,
        #[command(flatten)]
        shading: ShadingOptions,
    }

    /// The demo of a scene after its first frame.
    fn demo(name: &str) -> Demo {
        let Words { drawing, shading } = Words::parse_from(["mode13h"]);
        let inputs = Arc::new(Inputs { moment: Moment::default(), drawing, shading, words: vec![name.into()] });
        let first = loader::load(&inputs, 0, &[]);
        let mut demo = Demo::new(inputs, Kernel::default());
        demo.put_on(first).expect("a shipped scene");
        demo.draw().expect("a legal scene");
        demo
    }

    /// While something else is said, too.
    #[test]
    fn a_stopped_picture_says_so_as_long_as_it_is_stopped() {
        let mut demo = demo("torus");
        let says = |demo: &mut Demo, seconds| {
            demo.follow(&Input::default(), seconds).expect("a legal scene");
            demo.sheet((960, 720)).words().iter().any(|word| word.contains("stopped"))
        };
        assert!(!says(&mut demo, 0.0));
        demo.motion.stop();
        for seconds in [0.1, 1.5, 3600.0] {
            assert!(says(&mut demo, seconds), "after {seconds} s");
        }
        demo.say("palette copper".to_string());
        assert!(says(&mut demo, 3600.1));
    }

    /// Tests that in every scene, window and page, with one panel open or both, no letter is cut, missing from the
    /// font, or over another, and that every word of a panel stands on one of its pages.
    #[test]
    fn text_is_never_cut_in_any_scene() {
        for scene in shipped::ALL {
            let mut demo = demo(scene.name);
            for budget in [None, Some(1.0)] {
                let shading = demo.renderer.settings.accuracy.unwrap_or_default().shading();
                demo.shading = ShadingChoice::new(shading, budget);
                demo.draw().expect("a legal scene");
                for size in WINDOWS {
                    for (help, figures) in [(true, false), (false, true), (true, true)] {
                        (demo.help.is_open, demo.figures.is_open) = (help, figures);
                        for message in
                            ["palette the scene's", "gouraud-8.8-reseeded", "a-long-name.toml:12:3: ".repeat(9).trim()]
                        {
                            demo.say(message.to_string());
                            let mut words = Vec::new();
                            let mut pages = 1;
                            for page in (0..).take_while(|page| *page < 9) {
                                if page >= pages {
                                    break;
                                }
                                (demo.help.page, demo.figures.page) = (page, page);
                                let sheet = demo.sheet(size);
                                let what = format!("{} in {size:?}, page {page}", scene.name);
                                assert_eq!(sheet.faults(), [""; 0], "{what}");
                                let open = [(help, demo.help.pages), (figures, demo.figures.pages)];
                                assert!(open.iter().all(|(is_open, pages)| !is_open || *pages > 0), "{what}");
                                pages = open
                                    .iter()
                                    .filter(|(is_open, _)| *is_open)
                                    .map(|(_, pages)| *pages)
                                    .max()
                                    .unwrap_or(1);
                                words.extend(sheet.words());
                            }
                            assert!(!help || words.iter().any(|word| word == "Shift-N"), "{} in {size:?}", scene.name);
                            assert!(
                                !figures || words.iter().any(|word| word == "effects"),
                                "{} in {size:?}",
                                scene.name
                            );
                        }
                    }
                }
            }
        }
    }

    #[test]
    fn one_is_not_said_in_the_plural() {
        assert_eq!(counted(1, "object"), "1 object");
        assert_eq!(counted(0, "object"), "0 objects");
        let rows = demo("torus").figures();
        assert!(rows.iter().any(|row| format!("{row:?}").contains("1 object, 2304 triangles")), "{rows:?}");
    }

    #[test]
    fn the_title_has_the_time_of_the_shading_that_it_names() {
        let mut demo = demo("torus");
        let times: Vec<f64> = ["flat", "phong"]
            .map(|shading| {
                demo.shading = ShadingChoice::new(shading.parse().expect("a shading"), None);
                demo.forget_times();
                demo.draw().expect("a legal scene");
                assert_eq!(demo.title(), format!("torus - {shading} - {} - mode13h", demo.timing));
                demo.timing.frame
            })
            .into();
        assert!(times[0] != times[1] && times[0] > 0.0, "{times:?}");
        // The same again is the same picture.
        demo.draw().expect("a legal scene");
        assert!(demo.title().contains("not drawn again"), "{}", demo.title());
        assert_eq!(demo.timing.frame, times[1]);
    }
}

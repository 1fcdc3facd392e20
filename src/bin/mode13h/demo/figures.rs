//! The figures that I shows, and the keys that H shows.

use mode13h::plan::Effect;
use mode13h::render::{Shares, Stats};

use super::Demo;
use crate::overlay::Row;

/// The keys, and what each does.
const KEYS: [(&str, &str); 24] = [
    ("Esc", "quit"),
    ("H", "these keys"),
    ("I", "figures of the picture"),
    ("Space", "stop, go on"),
    ("arrows", "turn; the mouse too"),
    ("+ -", "zoom; the wheel too"),
    ("1 to 9", "shade by this rung"),
    ("[ ]", "the rung before, the next"),
    ("0", "shade by a budget of error"),
    ("B", "a smaller budget"),
    ("Shift-B", "a greater one"),
    ("E", "error map"),
    ("C", "side by side, at the mouse"),
    ("Shift", "[ ] 1 to 9: the right side"),
    ("X", "swap the sides"),
    ("Z", "magnify at the mouse"),
    (". ,", "there: step, Shift a row"),
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

/// So many of something, in words.
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
            Row::new("error", self.map.figures(self.number, self.seconds, self.shading.budget())),
        ];
        if let Some(Stats { hidden_surfaces, vertices, drawn, raster, shares, .. }) = &self.stats {
            let mut head = "rungs";
            for share in of_rungs(shares) {
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
            let on: Vec<_> = objects.iter().map(|plan| plan.decision(effect)).filter(|decision| decision.on).collect();
            let mut entry = effect.name().to_string();
            let is_said = matches!(effect, Effect::HiddenSurfaces | Effect::Gouraud | Effect::Phong);
            let first = on.first()?;
            if !is_said && !first.choice.is_empty() {
                entry += &format!(" {}", first.choice);
            }
            if on.len() < objects.len() {
                entry += &format!(" {}/{}", on.len(), objects.len());
            }
            Some(entry)
        };
        Effect::ALL.into_iter().filter_map(entry).collect()
    }
}

/// How the triangles were shared out among the rungs.
fn of_rungs(shares: &Shares) -> Vec<String> {
    shares.iter().map(|(rung, triangles)| format!("{rung} {triangles}")).collect()
}

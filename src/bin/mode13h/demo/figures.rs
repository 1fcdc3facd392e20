//! The figures and the help that H shows.

use mode13h::plan::Effect;
use mode13h::render::{Shares, Stats};

use super::Demo;

/// The characters of a line that fits on the frame.
const LINE: usize = 52;

pub(super) const HELP: [&str; 6] = [
    "1-9 [ ] rung   0 budget   B shift-B its error",
    "E error map    Z magnify  H hide this",
    "Esc quit   Space stop   S save     ",
    "K kernel   P palette    M mapping",
    "L lights   O fog        T texture  D dither",
    "arrows, mouse turn      wheel, + - zoom",
];

impl Demo {
    pub(super) fn figures(&self) -> Vec<String> {
        let mapping = self.mappings.chosen().map_or("by plan", |mapping| mapping.name());
        let mut lines = vec![
            format!("{}: {} triangles, zoom {:.2}", self.name, self.triangles, self.motion.pose.zoom),
            format!("{}, {:.0} a second, plan {:.1} us", self.timing, self.timing.rate, self.planning.frame * 1e6),
            self.map.figures(self.number, self.seconds, self.shading.budget()),
            format!("{}, mapping {mapping}", self.shading),
        ];
        if let Some(Stats { hidden_surfaces, vertices, drawn, raster, shares, .. }) = &self.stats {
            lines.extend(wrapped(&of_rungs(shares)));
            lines.push(format!("{hidden_surfaces}: {vertices} vertices, {drawn} drawn"));
            lines.push(format!("{} spans, {} pixels", raster.spans, raster.pixels));
        }
        lines.push(format!("kernel {}, palette {}", self.kernels.chosen(), self.palettes.chosen().0));
        let on = in_columns(&self.effects_on());
        lines.push(format!("on, of {} effects and {} objects:", Effect::COUNT, self.stage.scene.objects().len()));
        lines.extend(on);
        lines
    }

    /// The effects that are on: each with its choice, unless the lines above say that, and, if not for all objects, for
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

/// Entries in lines that fit.
fn wrapped(entries: &[String]) -> Vec<String> {
    let mut lines: Vec<String> = Vec::new();
    for entry in entries {
        match lines.last_mut() {
            Some(line) if line.len() + 2 + entry.len() <= LINE => {
                line.push_str(", ");
                line.push_str(entry);
            }
            _ => lines.push(entry.clone()),
        }
    }
    lines
}

/// Entries in two columns, down the first and then the second.
fn in_columns(entries: &[String]) -> Vec<String> {
    let half = LINE / 2;
    let (left, right) = entries.split_at(entries.len().div_ceil(2));
    let right = right.iter().map(String::as_str).chain([""]);
    left.iter().zip(right).map(|(left, right)| format!("{left:half$.half$}{right}")).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lines_fit_and_hold_every_entry() {
        let entries: Vec<String> = (0..10).map(|i| format!("gouraud-8.8-reseeded {}", 10_u32.pow(i))).collect();
        for some in 0..entries.len() {
            let lines = wrapped(&entries[..some]);
            assert!(lines.iter().all(|line| line.len() <= LINE), "{lines:?}");
            let all: Vec<&str> = lines.iter().flat_map(|line| line.split(", ")).collect();
            assert_eq!(all, entries[..some]);
        }
        assert!(HELP.iter().all(|line| line.len() <= LINE - 7), "beside the legend of the error map");
    }
}

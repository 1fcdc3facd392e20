//! Settings as lines of text: `shading NAME`, `max-error SHADES`, `effect NAME on|off`.
//!
//! Anything that no line names is left to the scene and the plan.

use mode13h::plan::Effect;
use mode13h::render::Renderer;
use mode13h::settings::Accuracy;

/// Applies the lines to a renderer, and resets what was set before.
pub(crate) fn apply(renderer: &mut Renderer, lines: &str) -> Result<(), String> {
    let mut accuracy = None;
    let mut effects = Vec::new();
    for line in lines.lines().filter(|line| !line.trim().is_empty()) {
        let words: Vec<&str> = line.split_whitespace().collect();
        match words.as_slice() {
            ["shading", name] => {
                accuracy = Some(Accuracy::Shading(name.parse().map_err(|error| format!("{name}: {error}"))?));
            }
            ["max-error", shades] => {
                accuracy = Some(Accuracy::WithinError(shades.parse().map_err(|_| format!("{shades}: not a number"))?));
            }
            ["effect", name, state @ ("on" | "off")] => {
                let effect: Effect = name.parse().map_err(|error| format!("{name}: {error}"))?;
                effects.push((effect, *state == "on"));
            }
            _ => return Err(format!("{line}: no setting")),
        }
    }
    renderer.settings.accuracy = accuracy;
    for effect in Effect::ALL {
        let on = effects.iter().find(|(name, _)| *name == effect).map(|(_, on)| *on);
        renderer.force(effect, on);
    }
    Ok(())
}

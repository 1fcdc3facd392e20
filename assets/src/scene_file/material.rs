//! Materials: the changes that a file makes to a default material.

use mode13h::light::{Material, RampChoice};
use mode13h::palette::Ramp;

use super::error::Fault;
use super::layout::{MaterialLayout, RampLayout};
use super::named::Named;

/// The default shininess: neither broad nor a point.
const SHININESS: f32 = 20.0;

/// Applies the layout's keys to `material`. `has_texcoords`: whether the mesh can have a texture.
pub(super) fn apply(
    layout: &MaterialLayout,
    material: &mut Material,
    has_texcoords: bool,
    named: &mut Named<'_>,
) -> Result<(), Fault> {
    let set = |number: &mut f32, given: Option<f32>| *number = given.unwrap_or(*number);
    set(&mut material.ambient, layout.ambient.map(|share| share.0));
    set(&mut material.diffuse, layout.diffuse.map(|share| share.0));
    set(&mut material.specular, layout.specular.map(|share| share.0));
    // A highlight requested here needs an exponent.
    let given = layout.specular.is_some() && material.shininess == 0.0;
    set(&mut material.shininess, layout.shininess.map(|exponent| exponent.0).or(given.then_some(SHININESS)));
    if let Some(color) = layout.color {
        material.color = color.0;
    }
    if let Some(ramp) = &layout.ramp {
        material.ramp = match ramp.get_ref() {
            RampLayout::Number(number) => RampChoice::Number(u16::from(*number)),
            RampLayout::Entries(entries) => {
                let (first, entries) = (entries.first.index(), entries.entries.count());
                let ramp = Ramp::new(first, entries).ok_or_else(|| {
                    Fault::value(ramp.span(), format_args!("{entries} entries starting at {first} run past entry 255"))
                })?;
                RampChoice::Entries(ramp)
            }
        };
    }
    if let Some(name) = &layout.texture {
        if !has_texcoords {
            return Err(Fault::value(name.span(), "the object has no texture coordinates"));
        }
        material.texture = Some(named.texture(name)?);
    }
    if let Some(name) = &layout.environment {
        material.environment = Some(named.texture(name)?);
    }
    if let Some(blend) = &layout.blend {
        material.blend = blend.0;
    }
    Ok(())
}

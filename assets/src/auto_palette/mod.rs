//! Palettes made for a scene: each of its materials is measured over one loop, and the entries follow from that.
//!

// | file | what |
// |---|---|
// | `seen` | area and brightness of every material, from pictures whose shades are intensities or material numbers |
// | `mixed` | colours that are on no ramp, from pictures in true colour |

mod mixed;
mod seen;
mod share;

use alloc::vec;
use alloc::vec::Vec;

use mixed::OwnColors;
use mode13h::light::{Material, RampChoice};
use mode13h::mesh::Surface;
use mode13h::palette::{Palette, Rgb};
use mode13h::plan::Effect;
use mode13h::render::{RenderError, Renderer, Screen};
use mode13h::scene::{Object, Scene, Shared};
use mode13h::texture::{Mipmap, Texture};
use seen::{Round, full_light, seen_in};
pub use seen::{Seen, seen};
pub use share::{Automatic, Entries, Use, share, share_beside};

/// A palette for a scene, and the scene's materials in it.
///
/// [`Automatic`] is one for surfaces, which need not belong to a scene.
#[derive(Clone, PartialEq, Debug)]
#[non_exhaustive]
pub struct AutomaticPalette {
    /// The colours.
    pub palette: Palette,
    /// The entries of each material, object by object.
    pub entries: Vec<Vec<Entries>>,
    materials: Vec<Vec<Material>>,
}

impl AutomaticPalette {
    /// Sets the scene's palette, and its objects' materials for it. The scene must be the one that the palette was made
    /// for, or one with the same objects. Objects with a different number of materials are left unchanged. The scene's
    /// preference for such a palette is cleared. The materials' own ramps are lost: to go back, keep a copy of the scene.
    pub fn apply(&self, scene: &mut Scene) {
        scene.auto_palette = false;
        scene.set_palette(self.palette.clone());
        for (object, materials) in scene.objects_mut().iter_mut().zip(&self.materials) {
            if object.materials.len() == materials.len() {
                object.materials.clone_from(materials);
            }
        }
    }
}

/// Makes a palette for a scene, by [`share_beside`], and its materials for it.
///
/// Area and brightness are measured from what is visible over one loop. A material without a colour of its own and
/// without an image that names a coloured ramp of the scene's palette keeps the colours of that ramp. Any other
/// material's colour is its [own](Material::own_colors), as it reflects full light, ambient and diffuse together; its
/// highlight adds to that. On its ramp that colour is at the intensity `full_light` of [`Entries::Ramp`]. So its
/// ambient and diffuse shares are scaled to add up to that, in the same proportion, and the highlight gets the rest.
/// The material then no longer needs channels, because its colour is in the ramp, and a `ramp` that it named is
/// replaced. A material with an image keeps its shares. The image's colours, tinted by the material's, are the base of
/// entries at the visible brightnesses. If its plan calls for mipmaps, their colours count as well, each level half as
/// much as the one before.
///
/// Colours that are mixed on the screen are on no ramp: those in fog and behind transparent surfaces, and all colours
/// under a coloured light. They are measured in true colour, and share the block of the textures. This holds for the
/// final colours only: what is seen through glass in fog is rounded to an entry before it is mixed. Under coloured
/// light there are no ramps: materials keep their own colours, are lit on three channels, and are drawn in the nearest
/// of the measured colours. The same holds if the scene's settings ask for three channels.
///
/// ```
/// use mode13h::mesh::shapes;
/// use mode13h_assets::auto_palette::Entries;
/// use mode13h_assets::auto_palette;
/// use mode13h::scene::Scene;
///
/// let mut scene = Scene::new();
/// let torus = scene.show(shapes::torus(48, 24));
/// scene[torus].materials[0].color = [0.9, 0.5, 0.2];
/// let made = auto_palette::of_scene(&scene)?;
/// let Entries::Ramp { ramp, full_light: 1.0, .. } = made.entries[0][0] else { unreachable!("it is matt") };
/// made.apply(&mut scene);
/// assert_eq!(scene.palette, Some(made.palette));
/// assert_eq!(scene[torus].materials[0].ramp, mode13h::light::RampChoice::Entries(ramp));
/// # Ok::<(), mode13h::render::RenderError>(())
/// ```
///
/// # Errors
/// Those of [`Renderer::draw`].
pub fn of_scene(scene: &Scene) -> Result<AutomaticPalette, RenderError> {
    of_round(scene, &Round::of(scene))
}

/// Makes a palette for a scene in which more moves than its [motions](Scene::motions), such as a model that plays an
/// animation.
///
/// `pose` moves the rest to where it is at a time, in seconds, in a copy of the scene whose time is already set. Its
/// motion repeats after each of the `periods`, in seconds. Otherwise like [`of_scene`].
///
/// ```
/// # use mode13h::scene::Scene;
/// use mode13h_assets::{SceneExt, auto_palette};
///
/// # let text = "objects = [{ shape = 'torus' }]";
/// # let no_files = |_: &std::path::Path| Err(std::io::ErrorKind::NotFound.into());
/// let mut loaded = Scene::from_toml(text, "scene.toml", no_files)?;
/// let periods: Vec<f64> = loaded.playbacks.iter().map(|playback| playback.clip().duration()).collect();
/// let made = auto_palette::of_moving_scene(&loaded.scene, &periods, |scene, seconds| {
///     loaded.playbacks.iter().for_each(|playback| playback.show_in(scene, seconds));
/// })?;
/// made.apply(&mut loaded.scene);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
/// Those of [`Renderer::draw`].
pub fn of_moving_scene(
    scene: &Scene,
    periods: &[f64],
    pose: impl Fn(&mut Scene, f64),
) -> Result<AutomaticPalette, RenderError> {
    of_round(scene, &Round::moved(scene, periods, &pose))
}

fn of_round(scene: &Scene, round: &Round<'_>) -> Result<AutomaticPalette, RenderError> {
    let in_channels = mixed::has_colored_light(scene) || scene.settings.channels == Some(true);
    let mut tints = Tints::default();
    let bodies: Vec<Vec<Body>> = scene.objects().iter().map(|object| bodies(object, scene, &mut tints)).collect();
    let mut texels: Vec<Option<Vec<(Rgb, u32)>>> = Vec::new();
    for (object, (bodies, has_levels)) in scene.objects().iter().zip(bodies.iter().zip(have_mipmaps(scene, round)?)) {
        for (material, body) in object.materials.iter().zip(bodies) {
            texels.push(match &body.image {
                _ if in_channels => Some(Vec::new()),
                Some(image) if has_levels && material.texture.is_some() => Some(Mipmap::new(image).weights(image)),
                Some(image) => Some(image.colors().iter().copied().zip(image.histogram()).collect()),
                None => None,
            });
        }
    }
    let seen = seen_in(scene, round)?;
    let mut uses: Vec<Use<'_>> = Vec::new();
    for ((body, seen), texels) in bodies.iter().flatten().zip(seen.iter().flatten()).zip(&texels) {
        // The shades of an image, or of a ramp that is kept, are not rescaled.
        let part = if body.image.is_some() || body.along.is_some() { body.full } else { 1.0 };
        uses.push(Use {
            color: body.color,
            highlight: body.highlight,
            area: seen.area,
            darkest: seen.darkest * part,
            brightest: seen.brightest * part,
            texels: texels.as_deref(),
            along: body.along.as_deref(),
        });
    }
    let own: Vec<OwnColors> = bodies.iter().flatten().map(|body| body.own).collect();
    let Automatic { palette, entries } =
        share_beside(&uses, &mixed::colors(scene, round, &own, in_channels || scene.fog.is_some())?);

    let mut entries = entries.into_iter();
    let mut automatic = AutomaticPalette { palette, entries: Vec::new(), materials: Vec::new() };
    for (object, bodies) in scene.objects().iter().zip(&bodies) {
        // One for each of the object's materials.
        let own: Vec<Entries> = entries.by_ref().take(bodies.len()).collect();
        let materials = object.materials.iter().zip(bodies).zip(&own);
        automatic.materials.push(materials.map(|((m, body), own)| body.material(m, *own, in_channels)).collect());
        automatic.entries.push(own);
    }
    Ok(automatic)
}

/// The colours that a scene without a chosen background shows over a loop, as the card shows them, independent of any
/// palette: each with its area as a fraction of all covered pixels.
///
/// # Errors
/// Those of [`Renderer::draw`].
#[cfg(feature = "std")]
pub(crate) fn colors_seen(scene: &Scene) -> Result<Vec<(Rgb, f32)>, RenderError> {
    let plain = Surface::default();
    let own = scene.objects().iter().flat_map(|object| {
        let surfaces = object.mesh().surfaces().iter().chain(core::iter::repeat(&plain));
        object.materials.iter().zip(surfaces).map(|(material, surface)| material.own_colors(surface))
    });
    mixed::colors(scene, &Round::of(scene), &own.collect::<Vec<_>>(), true)
}

/// Returns for each object whether its plan ever calls for mipmaps.
fn have_mipmaps(scene: &Scene, round: &Round<'_>) -> Result<Vec<bool>, RenderError> {
    let mut any = vec![false; scene.objects().len()];
    if scene.objects().iter().flat_map(|object| &object.materials).any(|material| material.texture.is_some()) {
        let (mut moved, mut renderer) = (scene.clone(), Renderer::new());
        for moment in round.moments() {
            moment.show(&mut moved);
            let plan = renderer.make_plan(&moved, Screen::MODE_13H)?;
            any.iter_mut().enumerate().for_each(|(object, any)| *any |= plan.objects()[object].is_on(Effect::Mipmaps));
        }
    }
    Ok(any)
}

/// The target colours of one material of an object.
struct Body {
    /// The share of full light that it reflects, ambient and diffuse together; at most 1.
    full: f32,
    /// Its colours on three channels.
    own: OwnColors,
    /// The colours of a ramp that is kept.
    along: Option<Vec<Rgb>>,
    color: Rgb,
    highlight: Option<Rgb>,
    /// Its texture or environment map, in its colour.
    image: Option<Shared<Texture>>,
}

/// The target colours of each material.
fn bodies(object: &Object, scene: &Scene, tints: &mut Tints) -> Vec<Body> {
    let plain = Surface::default();
    let surfaces = object.mesh().surfaces().iter().chain(core::iter::repeat(&plain));
    object
        .materials
        .iter()
        .zip(surfaces)
        .map(|(material, surface)| Body::new(material, surface, scene, tints))
        .collect()
}

impl Body {
    fn new(material: &Material, surface: &Surface, scene: &Scene, tints: &mut Tints) -> Self {
        let full = full_light(material, scene.ambient);
        let image = material.texture.as_ref().or(material.environment.as_ref());
        let mut own = material.own_colors(surface);
        let is_plain = own == ([1.0; 3], [1.0; 3]) && image.is_none();
        let along = scene.palette.as_ref().filter(|_| is_plain).and_then(|palette| colors_of_ramp(material, palette));
        if let Some(along) = &along {
            own = own_colors_on(along, material, full);
        }
        let color = Rgb::from_intensities(own.0.map(|channel| channel * full));
        let is_shiny = material.specular > 0.0 && material.is_specular();
        let light = Rgb::from_intensities(own.1.map(|channel| channel * material.specular));
        Self {
            full,
            own,
            along,
            color,
            highlight: (is_shiny && light != Rgb::BLACK).then(|| color.saturating_add(light)),
            image: image.map(|image| tints.tinted(image, Rgb::from_intensities(own.0))),
        }
    }

    fn material(&self, material: &Material, entries: Entries, in_channels: bool) -> Material {
        let (color, highlight) = self.own;
        if in_channels {
            return Material { ramp: RampChoice::Nearest, color, highlight, ..material.clone() };
        }
        let plain = Material { color: [1.0; 3], highlight: [1.0; 3], ..material.clone() };
        match (entries, &self.image) {
            (Entries::Ramp { ramp, .. }, None) if self.along.is_some() => {
                Material { ramp: RampChoice::Entries(ramp), ..plain }
            }
            (Entries::Ramp { ramp, full_light }, None) => Material {
                ramp: RampChoice::Entries(ramp),
                ambient: material.ambient / self.full * full_light,
                diffuse: material.diffuse / self.full * full_light,
                specular: if self.highlight.is_some() { 1.0 - full_light } else { 0.0 },
                ..plain
            },
            (_, Some(image)) if material.texture.is_some() => Material { texture: Some(Shared::clone(image)), ..plain },
            (_, image) => Material { environment: image.clone(), ..plain },
        }
    }
}

/// The colours of the ramp that a material names in a palette; `None` if they are grey, or if the palette has no ramps.
fn colors_of_ramp(material: &Material, palette: &Palette) -> Option<Vec<Rgb>> {
    let ramp = material.ramp.in_palette(Some(palette));
    let is_named = matches!(material.ramp, RampChoice::Entries(_)) || palette.ramps() > 0;
    let colors: Vec<Rgb> = ramp.range().map(|entry| palette[entry]).collect();
    let has_color = colors.iter().any(|color| color.r != color.g || color.g != color.b);
    (is_named && material.ramp != RampChoice::Nearest && has_color && colors.len() > 1).then_some(colors)
}

/// The two colours that represent a ramp where light is mixed: the one in full light, and what the highlight adds to
/// it.
fn own_colors_on(along: &[Rgb], material: &Material, full: f32) -> OwnColors {
    let shown = |intensity: f32| {
        // From the first to the last.
        <[f32; 3]>::from(along[libm::roundf(intensity.clamp(0.0, 1.0) * (along.len() - 1) as f32) as usize])
    };
    let (color, brightest) = (shown(full), shown(full + material.specular));
    let added = |i: usize| (brightest[i] - color[i]).max(0.0) / material.specular;
    let highlight = if material.is_specular() { core::array::from_fn(added) } else { [1.0; 3] };
    (color.map(|channel| channel / full), highlight)
}

/// An object's materials for a palette without ramps. Each that names a ramp by its number gets its [own
/// colours](Material::own_colors) or, if it has none and no image, the colour at half light on that ramp of `palette`,
/// which it was made for. (A ramp often ends in white, for highlights.)
#[must_use]
pub fn without_ramps(object: &Object, palette: Option<&Palette>) -> Vec<Material> {
    let plain = Surface::default();
    let surfaces = object.mesh().surfaces().iter().chain(core::iter::repeat(&plain));
    let of = |(material, surface): (&Material, &Surface)| {
        let has_image = material.texture.is_some() || material.environment.is_some();
        let is_plain = !has_image && material.own_colors(surface) == ([1.0; 3], [1.0; 3]);
        let is_numbered = is_plain && matches!(material.ramp, RampChoice::Number(_));
        match palette.filter(|_| is_numbered).and_then(|palette| colors_of_ramp(material, palette)) {
            Some(along) => {
                let color = <[f32; 3]>::from(along[along.len() / 2]).map(|channel| 2.0 * channel);
                Material { ramp: RampChoice::Nearest, color, ..material.clone() }
            }
            None => material.in_own_colors(surface),
        }
    };
    object.materials.iter().zip(surfaces).map(of).collect()
}

/// Images tinted with the colours of their materials, each once.
#[derive(Default)]
struct Tints(Vec<(Shared<Texture>, Rgb, Shared<Texture>)>);

impl Tints {
    fn tinted(&mut self, image: &Shared<Texture>, tint: Rgb) -> Shared<Texture> {
        if tint == Rgb::WHITE {
            return Shared::clone(image);
        }
        let known = self.0.iter().find(|(of, by, _)| Shared::ptr_eq(of, image) && *by == tint);
        if let Some((_, _, tinted)) = known {
            return Shared::clone(tinted);
        }
        let tinted = Shared::new(image.modulated(tint));
        self.0.push((Shared::clone(image), tint, Shared::clone(&tinted)));
        tinted
    }
}

//! The reasons for decisions, stored as small values and turned into text on demand.

use alloc::format;
use alloc::string::{String, ToString};

use crate::scene::{Object, Scene};

/// The reason why an effect is on or off for an object.
#[derive(Clone, Copy, PartialEq, Debug)]
#[non_exhaustive]
pub enum Reason {
    /// It was overridden.
    Overrides,
    /// The first frame.
    FirstFrame,
    /// The object, the camera or its light changed since the last frame.
    Changed,
    /// Nothing that it depends on changed since the last frame.
    Unchanged,
    /// Vertices are not cached between frames.
    NotKept,
    /// The object or one that it belongs to is hidden.
    Hidden,
    /// Its bounds are off the screen, or nearer than the near plane.
    OutOfSight,
    /// This build does not contain the effect.
    LeftOut,
    /// The distances of the object and of the near plane.
    Nearest {
        /// The least distance of its bounds along the view.
        nearest: f64,
        /// The near plane's distance.
        near: f64,
    },
    /// Its bounds reach the near plane, so they may project anywhere on the screen.
    CrossesNear,
    /// Its bounds reach an edge of the screen.
    LeavesScreen,
    /// Its bounds lie within the screen.
    OnScreen,
    /// Only a part of the screen is drawn.
    Band,
    /// The mesh is closed: none of its back faces can be seen from outside.
    Closed,
    /// The mesh is not closed: both sides of its faces may be visible.
    Open,
    /// The mesh is closed, but parts of it are inside out: their back faces may be visible.
    InsideOut,
    /// A transparent object shows its own far side as well.
    SeenThrough,
    /// The scene's only object is convex.
    OneConvex,
    /// There is nothing to draw.
    Empty,
    /// All objects are convex, and their depths do not overlap.
    ConvexApart,
    /// An object of the scene is not convex.
    NotConvex {
        /// Its index in the scene.
        object: usize,
    },
    /// There are two or more objects, all convex, but their depths overlap.
    Overlap,
    /// Transparent objects are drawn last, far to near.
    TransparentLast,
    /// Every object is transparent, so all are drawn far to near.
    AllTransparent,
    /// It was requested, by the scene or by hand.
    Asked,
    /// A material's response to light is its own, and the error of shades between the vertices is not known.
    OwnResponse,
    /// It was not requested.
    NotAsked,
    /// The scan-line method was requested, which handles one face per pixel, but some surface is transparent.
    ScanLineShowsOneFace,
    /// Lights whose intensity is not 0.
    Lights {
        /// The number of lights.
        count: usize,
    },
    /// There is no light, or all are dark.
    NoLight,
    /// No material reflects anything but ambient light.
    NoResponse,
    /// Lamps in range.
    LampsInRange {
        /// The number of lamps.
        count: usize,
    },
    /// There is no lamp.
    NoLamp,
    /// Lamps, none of which reaches the object.
    LampsOutOfRange {
        /// The number of lamps.
        count: usize,
    },
    /// A material has it.
    MaterialHas {
        /// Its index among the object's materials.
        material: usize,
    },
    /// A material is specular, but no such material has a shininess above 0.
    NoShininess {
        /// Its index among the object's materials.
        material: usize,
    },
    /// No material of the object has it.
    NoMaterialHas,
    /// The shades of the vertices differ.
    ShadesDiffer,
    /// An error budget is met face by face.
    Budget {
        /// The accepted error in shades.
        max_error: f32,
    },
    /// An error budget already limits the error, face by face.
    LeftToBudget,
    /// Every normal is that of its face, and the lights are distant: one shade per face is exact.
    Faceted,
    /// One shade per face was requested.
    FlatAsked,
    /// Every vertex has the same shade.
    OneShade,
    /// The scene has none.
    SceneHasNone,
    /// The object reaches into the fog.
    ReachesInto {
        /// The farthest distance of the object along the view.
        farthest: f64,
        /// The distance at which the fog begins.
        start: f64,
    },
    /// The object is nearer than the fog.
    NearerThan {
        /// The farthest distance of the object along the view.
        farthest: f64,
        /// The distance at which the fog begins.
        start: f64,
    },
    /// The bound on the affine mapping's error over any triangle, in texels.
    AffineError {
        /// The error in texels.
        texels: f64,
    },
    /// There is no texture, so nothing needs perspective correction.
    NoTexture,
    /// No material has a texture.
    NoImage,
    /// The max number of texels per pixel, on a face parallel to the screen.
    TexelsToPixel {
        /// The number along a pixel's side.
        texels: f64,
    },
    /// A light is coloured.
    ColoredLight {
        /// Its index in the scene.
        light: usize,
    },
    /// A material is coloured, or drawn in the nearest palette entries.
    ColoredMaterial {
        /// Its index among the object's materials.
        material: usize,
    },
    /// No light and no material is coloured.
    NoColor,
    /// A material names a ramp, but the palette has none.
    NoRamps,
    /// Shades come from a table of whole shades, with nothing in between.
    WholeShades,
    /// The 16.16 vertex path does not support it.
    NotInIntegers,
}

impl Reason {
    /// The reason as text, for `object` of `scene`.
    #[must_use]
    pub fn text(&self, scene: &Scene, object: usize) -> String {
        let material = |i: usize| {
            let name = scene.objects().get(object).and_then(|o| o.materials.get(i)).map_or("", |m| m.name.as_str());
            if name.is_empty() { format!("material {i}") } else { format!("material `{name}`") }
        };
        let none = || match scene.objects().get(object).map(|object| object.materials.as_slice()) {
            Some([only]) if !only.name.is_empty() => format!("material `{}` has none", only.name),
            _ => "no material has it".to_string(),
        };
        match *self {
            Self::Overrides => "switched by hand".to_string(),
            Self::FirstFrame => "the first frame".to_string(),
            Self::Changed => "it, the camera or its light changed since the last frame".to_string(),
            Self::Unchanged => "nothing it depends on changed since the last frame".to_string(),
            Self::NotKept => "vertices are not cached".to_string(),
            Self::OutOfSight => "its bounds are out of sight".to_string(),
            Self::LeftOut => "this build leaves it out".to_string(),
            Self::Nearest { nearest, near } if nearest > near => {
                format!("its bounds come no nearer than {nearest:.3}; the near plane is at {near:.3}")
            }
            Self::Nearest { nearest, near } => {
                format!("its bounds come as near as {nearest:.3}; the near plane is at {near:.3}")
            }
            Self::Hidden => "it is hidden".to_string(),
            Self::CrossesNear => "its bounds reach the near plane".to_string(),
            Self::LeavesScreen => "its bounds reach the screen's edge".to_string(),
            Self::OnScreen => "its bounds lie on the screen".to_string(),
            Self::Band => "only a part of the screen is drawn".to_string(),
            Self::Closed => "its mesh is closed".to_string(),
            Self::Open => "its mesh is open, so both sides may be seen".to_string(),
            Self::InsideOut => "its mesh does not face outward everywhere, so both sides may be seen".to_string(),
            Self::SeenThrough => "its far side shows through".to_string(),
            Self::OneConvex => "the only object is convex".to_string(),
            Self::Empty => "there is nothing to draw".to_string(),
            Self::ConvexApart => "all objects are convex and lie one behind the other".to_string(),
            Self::NotConvex { object } => format!("{} is not convex", name_of(scene, object)),
            Self::Overlap => "the depths of the objects overlap".to_string(),
            Self::TransparentLast => "transparent objects are drawn last, far to near".to_string(),
            Self::AllTransparent => "every object is transparent, so all are drawn far to near".to_string(),
            Self::Asked => "asked for".to_string(),
            Self::OwnResponse => "a material has a response of its own, whose error is not known".to_string(),
            Self::NotAsked => "not asked for".to_string(),
            Self::ScanLineShowsOneFace => "scan-line was asked for, but something is transparent".to_string(),
            Self::Lights { count: 1 } => "one light".to_string(),
            Self::Lights { count } => format!("{count} lights"),
            Self::NoLight => "the scene has no light".to_string(),
            Self::NoResponse => "no material responds to light".to_string(),
            Self::LampsInRange { count: 1 } => "one lamp reaches it".to_string(),
            Self::LampsInRange { count } => format!("{count} lamps reach it"),
            Self::NoLamp => "the scene has no lamp".to_string(),
            Self::LampsOutOfRange { count: 1 } => "the lamp does not reach it".to_string(),
            Self::LampsOutOfRange { count } => format!("none of {count} lamps reaches it"),
            Self::MaterialHas { material: i } => format!("{} has it", material(i)),
            Self::NoShininess { material: i } => format!("{} has a shininess of 0", material(i)),
            Self::NoMaterialHas => none(),
            Self::ShadesDiffer => "shades differ from vertex to vertex".to_string(),
            Self::Budget { max_error } => format!("within an error budget of {max_error} shades, face by face"),
            Self::LeftToBudget => "the error budget decides, face by face".into(),
            Self::Faceted => {
                "every normal is that of its face, and the light is far away: one shade a face is right".to_string()
            }
            Self::FlatAsked => "one shade a face was asked for".to_string(),
            Self::OneShade => "every vertex has the same shade".to_string(),
            Self::SceneHasNone => "the scene has none".to_string(),
            Self::ReachesInto { farthest, start } => {
                format!("it begins at {start:.3}, the object reaches {farthest:.3}")
            }
            Self::NearerThan { farthest, start } => {
                format!("it begins at {start:.3}, the object ends at {farthest:.3}")
            }
            // Bounds are rounded up.
            Self::AffineError { texels } => {
                format!("linear mapping would be off by up to {:.2} texels", libm::ceil(texels * 100.0) / 100.0)
            }
            Self::NoTexture => "nothing needs perspective correction".to_string(),
            Self::NoImage => "no material has a texture".to_string(),
            Self::TexelsToPixel { texels } => {
                format!("up to {:.2} texels to a pixel, seen straight on", libm::ceil(texels * 100.0) / 100.0)
            }
            Self::ColoredLight { light } => format!("light {light} is coloured"),
            Self::ColoredMaterial { material: i } => format!("{} is drawn in its own colours", material(i)),
            Self::WholeShades => "the table of normals holds whole shades".to_string(),
            Self::NoRamps => "the palette has no ramps: colours are the nearest entries, dithered".to_string(),
            Self::NotInIntegers => "the 16.16 vertex path has none".to_string(),
            Self::NoColor => "neither light nor material is coloured".to_string(),
        }
    }
}

/// The object's name, or its index.
#[must_use]
pub fn name_of(scene: &Scene, object: usize) -> String {
    match scene.objects().get(object).map(|Object { name, .. }| name) {
        Some(name) if !name.is_empty() => name.clone(),
        _ => format!("object {object}"),
    }
}

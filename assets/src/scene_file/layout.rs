//! The layout of a scene file: its tables and keys, as serde reads them. `assets/scenes/README.md` gives the meaning,
//! unit and default of each; a test ensures that both list the same keys.

use std::collections::BTreeMap;

use mode13h::light::Blend;
use mode13h::scene::UpAxis;
use mode13h::settings::{DitherPattern, HiddenSurfaces, Mapping, Shading};
use serde::Deserialize;
use serde::de::value::MapAccessDeserializer;
use serde::de::{Error, MapAccess, SeqAccess, Unexpected};
use toml::Spanned;

use crate::look::Look;

use super::shape::Shape;
use super::value::{
    Background, Color, Crease, Entries, Entry, FieldOfView, FileName, Finite, HalfAngle, List, Name, NotNegative,
    Number, OffOr, OneOrThree, Plain, Positive, Rounds, Seconds, Share, Shininess, Times, Vector, VertexBits,
    not_in_range, visitor,
};

/// The whole file.
#[derive(Deserialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case", expecting = "a table")]
pub(super) struct SceneLayout {
    pub(super) name: Option<String>,
    pub(super) duration: Option<Seconds>,
    pub(super) ambient: Option<NotNegative>,
    pub(super) background: Option<Background>,
    pub(super) palette: Option<Spanned<FileName>>,
    pub(super) look: Option<Name<Look>>,
    pub(super) animation: Option<Spanned<AnimationLayout>>,
    pub(super) fog: Option<Spanned<FogLayout>>,
    pub(super) camera: Option<Spanned<CameraLayout>>,
    pub(super) render: Option<RenderLayout>,
    pub(super) picture: Option<Finite>,
    #[serde(default)]
    pub(super) objects: Vec<Spanned<ObjectLayout>>,
    #[serde(default)]
    pub(super) lights: Vec<Spanned<LightLayout>>,
}

/// `[camera]`
#[derive(Deserialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case", expecting = "a table")]
pub(super) struct CameraLayout {
    pub(super) eye: Option<Vector>,
    pub(super) target: Option<Vector>,
    pub(super) from: Option<Spanned<Vector>>,
    pub(super) up: Option<Spanned<Vector>>,
    pub(super) field_of_view: Option<FieldOfView>,
    pub(super) near: Option<Positive>,
    pub(super) eye_path: Option<Spanned<PathLayout>>,
    pub(super) target_path: Option<Spanned<PathLayout>>,
}

/// `[[objects]]`
#[derive(Deserialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case", expecting = "a table")]
pub(super) struct ObjectLayout {
    pub(super) name: Option<String>,
    pub(super) shape: Option<Name<Shape>>,
    pub(super) subdivisions: Option<Spanned<Subdivisions>>,
    pub(super) model: Option<Spanned<FileName>>,
    pub(super) clip: Option<Spanned<ClipLayout>>,
    pub(super) crease: Option<Spanned<Crease>>,
    pub(super) position: Option<Spanned<Vector>>,
    pub(super) positions: Option<Spanned<Vec<Vector>>>,
    pub(super) scale: Option<Spanned<OneOrThree<Positive>>>,
    pub(super) repeat: Option<Spanned<List<Positive, 2>>>,
    pub(super) angles: Option<List<Finite, 3>>,
    pub(super) up_axis: Option<Name<Up>>,
    pub(super) pivot: Option<Vector>,
    pub(super) spin: Option<OneOrThree<Finite>>,
    pub(super) path: Option<Spanned<PathLayout>>,
    pub(super) material: Option<MaterialLayout>,
    pub(super) materials: Option<BTreeMap<Spanned<String>, MaterialLayout>>,
}

/// `material`, and the tables in `materials`
#[derive(Deserialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case", expecting = "a table")]
pub(super) struct MaterialLayout {
    pub(super) ambient: Option<Share>,
    pub(super) diffuse: Option<Share>,
    pub(super) specular: Option<Share>,
    pub(super) shininess: Option<Shininess>,
    pub(super) ramp: Option<Spanned<RampLayout>>,
    pub(super) color: Option<Color>,
    pub(super) texture: Option<Spanned<FileName>>,
    pub(super) environment: Option<Spanned<FileName>>,
    pub(super) blend: Option<BlendLayout>,
}

/// `[[lights]]`
#[derive(Deserialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case", expecting = "a table")]
pub(super) struct LightLayout {
    pub(super) sun: Option<Spanned<Vector>>,
    pub(super) lamp: Option<Spanned<Vector>>,
    pub(super) range: Option<Spanned<Positive>>,
    pub(super) direction: Option<Spanned<Vector>>,
    pub(super) outer: Option<Spanned<HalfAngle>>,
    pub(super) inner: Option<Spanned<HalfAngle>>,
    pub(super) intensity: Option<Plain>,
    pub(super) color: Option<Color>,
    pub(super) path: Option<Spanned<PathLayout>>,
}

/// `path`, `eye-path`, `target-path`
#[derive(Deserialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case", expecting = "a table")]
pub(super) struct PathLayout {
    pub(super) line: Option<List<Vector, 2>>,
    pub(super) back: Option<Spanned<bool>>,
    pub(super) circle: Option<Spanned<CircleLayout>>,
    pub(super) rounds: Option<Rounds>,
}

/// `circle` of a path
#[derive(Deserialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case", expecting = "a table")]
pub(super) struct CircleLayout {
    pub(super) centre: Option<Vector>,
    pub(super) radius: Option<Positive>,
    pub(super) axis: Option<Name<Axis>>,
    pub(super) start: Option<Finite>,
    pub(super) from: Option<Vector>,
    pub(super) towards: Option<Vector>,
}

/// `fog`
#[derive(Deserialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case", expecting = "a table")]
pub(super) struct FogLayout {
    pub(super) color: Option<Color>,
    pub(super) start: Option<NotNegative>,
    pub(super) end: Spanned<Positive>,
}

/// `animation`
#[derive(Deserialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case", expecting = "a table")]
pub(super) struct AnimationLayout {
    pub(super) fade: Option<Spanned<FileName>>,
    pub(super) cycle: Option<Spanned<List<Entry, 2>>>,
    pub(super) rounds: Option<Times>,
}

/// `[render]`
#[derive(Deserialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case", expecting = "a table")]
pub(super) struct RenderLayout {
    pub(super) shading: Option<Name<Shading>>,
    pub(super) hidden_surfaces: Option<Name<HiddenSurfaces>>,
    pub(super) mapping: Option<Name<Mapping>>,
    pub(super) mipmaps: Option<bool>,
    pub(super) tessellation: Option<Positive>,
    pub(super) dither: Option<OffOr<DitherPattern>>,
    pub(super) vertex_bits: Option<VertexBits>,
    pub(super) max_error: Option<Positive>,
}

/// `subdivisions`: an integer, or a list of several.
pub(super) struct Subdivisions(pub(super) Vec<i64>);

visitor! { SubdivisionsVisitor of Subdivisions: "a whole number, or two in a list"
    fn visit_i64<E: Error>(self, number: i64) -> Result<Subdivisions, E> {
        Ok(Subdivisions([number].into()))
    }

    fn visit_seq<A: SeqAccess<'de>>(self, mut list: A) -> Result<Subdivisions, A::Error> {
        let mut numbers = Vec::new();
        while let Some(number) = list.next_element()? {
            numbers.push(number);
        }
        Ok(Subdivisions(numbers))
    }
}

/// `ramp`: a number, or a range of palette entries.
pub(super) enum RampLayout {
    Number(u8),
    Entries(EntriesLayout),
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case", expecting = "a table")]
pub(super) struct EntriesLayout {
    pub(super) first: Entry,
    pub(super) entries: Entries,
}

visitor! { RampLayoutVisitor of RampLayout: "the number of a ramp, 0 to 255, or { first = 0, entries = 256 }"
    fn visit_i64<E: Error>(self, number: i64) -> Result<RampLayout, E> {
        u8::try_from(number).map(RampLayout::Number).map_err(|_| not_in_range(number, &self))
    }

    fn visit_map<A: MapAccess<'de>>(self, map: A) -> Result<RampLayout, A::Error> {
        EntriesLayout::deserialize(MapAccessDeserializer::new(map)).map(RampLayout::Entries)
    }
}

/// `clip`: a name, or a number.
pub(super) enum ClipLayout {
    Name(String),
    Index(usize),
}

visitor! { ClipLayoutVisitor of ClipLayout: "the name of an animation, or its number, from 0"
    fn visit_str<E: Error>(self, name: &str) -> Result<ClipLayout, E> {
        Ok(ClipLayout::Name(name.into()))
    }

    fn visit_i64<E: Error>(self, number: i64) -> Result<ClipLayout, E> {
        usize::try_from(number).map(ClipLayout::Index).map_err(|_| not_in_range(number, &self))
    }
}

/// `blend`: the name of a mode, or the opacity.
pub(super) struct BlendLayout(pub(super) Blend);

visitor! { BlendLayoutVisitor of BlendLayout: "\"opaque\", \"add\", or how opaque it is, a number from 0 to 1"
    fn visit_str<E: Error>(self, name: &str) -> Result<BlendLayout, E> {
        match name {
            "opaque" => Ok(BlendLayout(Blend::Opaque)),
            "add" => Ok(BlendLayout(Blend::Add)),
            _ => Err(E::invalid_value(Unexpected::Str(name), &self)),
        }
    }

    fn visit_i64<E: Error>(self, number: i64) -> Result<BlendLayout, E> {
        match number {
            0 | 1 => self.visit_f64(number as f64),
            _ => Err(not_in_range(number, &self)),
        }
    }

    fn visit_f64<E: Error>(self, number: f64) -> Result<BlendLayout, E> {
        match Share::of(number) {
            // 0 to 255.5; the cast truncates after 0.5 is added.
            Some(Share(share)) => Ok(BlendLayout(Blend::Mix((share * 255.0 + 0.5) as u8))),
            None => Err(not_in_range(number, &self)),
        }
    }
}

/// The axis of a circle.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(super) enum Axis {
    X,
    Y,
    Z,
}

impl core::str::FromStr for Axis {
    type Err = &'static str;

    fn from_str(name: &str) -> Result<Self, Self::Err> {
        match name {
            "x" => Ok(Self::X),
            "y" => Ok(Self::Y),
            "z" => Ok(Self::Z),
            _ => Err("unknown axis; there are x, y, z"),
        }
    }
}

/// The axis of a mesh that points up.
pub(super) struct Up(pub(super) UpAxis);

impl core::str::FromStr for Up {
    type Err = &'static str;

    fn from_str(name: &str) -> Result<Self, Self::Err> {
        match name {
            "y" => Ok(Self(UpAxis::Y)),
            "z" => Ok(Self(UpAxis::Z)),
            _ => Err("unknown axis; there are y, z"),
        }
    }
}

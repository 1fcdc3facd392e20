//! Decides which effects each object of a scene calls for, and why.
//!
//! A plan is made once per frame: a few comparisons and products per object, nothing per vertex.
//! The renderer follows [`ObjectPlan::is_on`]; [`Plan::rows`] reports the decisions as text. A
//! disabled effect costs nothing per vertex, triangle, span or pixel, and no memory, except that
//! memory allocated while it was on is retained for reuse.

// | file | what |
// |---|---|
// | `effect` | `Effect`: the list |
// | `reason` | `Reason`: the reasons |
// | `stages` | the work for an object, as values; `Choice` |
// | `face_shading` | `FaceShading`: how a face is shaded |
// | `findings` | facts found while drawing, as text |
// | `decide` | the rules, a function per effect |
// | `hidden` | which hidden-surface method to use |

mod decide;
mod effect;
mod face_shading;
mod findings;
mod hidden;
pub(crate) mod reason;
pub(crate) mod stages;

use alloc::format;
use alloc::string::String;
use alloc::vec::Vec;
use core::fmt;
use core::ops::Index;

pub use effect::Effect;
pub use face_shading::FaceShading;
pub(crate) use findings::{FaceCounts, Findings};
pub use reason::Reason;
pub use stages::Choice;

pub(crate) use decide::{Change, Inputs, decide, has_custom_response};
pub(crate) use hidden::far_to_near;

use self::stages::Stages;
use crate::raster::Rect;
use crate::scene::{ObjectId, Scene};
use crate::settings::{HiddenSurfaces, Shading};

/// The decision on an effect.
#[derive(Clone, Copy, PartialEq, Debug)]
#[non_exhaustive]
pub struct Decision {
    /// Whether the effect is on.
    pub on: bool,
    /// The variant of the effect, if there are several.
    pub choice: Choice,
    /// The reason.
    pub reason: Reason,
}

impl Decision {
    pub(crate) const fn on(reason: Reason) -> Self {
        Self { on: true, choice: Choice::Only, reason }
    }

    pub(crate) const fn off(reason: Reason) -> Self {
        Self { on: false, choice: Choice::Only, reason }
    }

    pub(crate) const fn choosing(self, choice: Choice) -> Self {
        Self { choice, ..self }
    }
}

/// The decisions for one object.
#[derive(Clone, Copy, PartialEq, Debug)]
pub struct ObjectPlan {
    decisions: [Decision; Effect::COUNT],
    shading: Shading,
    max_error: Option<f32>,
    stages: Stages,
}

/// The decision on an effect.
impl Index<Effect> for ObjectPlan {
    type Output = Decision;

    fn index(&self, effect: Effect) -> &Decision {
        // There is one decision per effect.
        &self.decisions[effect as usize]
    }
}

impl ObjectPlan {
    /// The plan of a hidden object, for which nothing else is decided.
    fn new(shading: Shading) -> Self {
        let decisions = [Decision::off(Reason::Hidden); Effect::COUNT];
        Self { decisions, shading, max_error: None, stages: Stages::default() }
    }

    /// The stages that the object goes through.
    pub(crate) fn stages(&self) -> &Stages {
        &self.stages
    }

    /// Returns whether an effect is on.
    #[inline]
    #[must_use]
    pub fn is_on(&self, effect: Effect) -> bool {
        !effect.is_left_out() && self[effect].on
    }

    /// The shading of the object.
    #[must_use]
    pub fn shading(&self) -> Shading {
        self.shading
    }

    /// The error budget, in shades, within which each of its triangles gets the cheapest shading.
    /// `None` if there is no budget, or if one shading is known to be the cheapest for all.
    #[must_use]
    pub fn max_error(&self) -> Option<f32> {
        self.max_error
    }
}

/// Manual overrides of effects: `None` leaves an effect to the plan.
#[derive(Clone, PartialEq, Eq, Debug, Default)]
pub(crate) struct Overrides {
    /// `None` stands for every object without an override of its own.
    all: Vec<(Option<ObjectId>, Effect, bool)>,
}

impl Overrides {
    /// Switches an effect on or off for one object, or for every other object; `None` removes the override.
    pub(crate) fn set(&mut self, object: Option<ObjectId>, effect: Effect, on: Option<bool>) {
        self.all.retain(|(place, of, _)| (*place, *of) != (object, effect));
        self.all.extend(on.map(|on| (object, effect, on)));
    }

    /// Returns how an effect is overridden for an object, or for every object without an override of its own.
    #[must_use]
    pub(crate) fn get(&self, object: Option<ObjectId>, effect: Effect) -> Option<bool> {
        let find = |object| self.all.iter().find(|(place, of, _)| (*place, *of) == (object, effect));
        find(object).or_else(|| find(None)).map(|(_, _, on)| *on)
    }
}

/// The decisions for a frame of a scene.
#[derive(Clone, PartialEq, Debug)]
pub struct Plan {
    /// The hidden-surface method.
    pub(crate) hidden_surfaces: HiddenSurfaces,
    /// Whether the plan chose the method, rather than the settings.
    pub(crate) chosen: bool,
    pub(crate) objects: Vec<ObjectPlan>,
    /// The indices of the objects in drawing order, without those out of sight.
    pub(crate) order: Vec<usize>,
    /// The part of the screen where any of them may be visible.
    pub(crate) seen: Rect,
    /// Whether vertices are transformed in 16.16.
    pub(crate) is_integer: bool,
    /// See [`Plan::near_needed`].
    pub(crate) near_needed: Option<f32>,
}

impl Default for Plan {
    fn default() -> Self {
        Self {
            hidden_surfaces: HiddenSurfaces::BackFaces,
            chosen: true,
            objects: Vec::new(),
            order: Vec::new(),
            seen: Rect::NOWHERE,
            is_integer: false,
            near_needed: None,
        }
    }
}

impl Plan {
    /// The near distance that the camera needs, if its own is too small: 2⁻²⁰ of the greatest distance that any visible
    /// object reaches.
    ///
    /// Depths are near / w in steps of 2⁻³⁰. With a smaller near distance, depths of distant surfaces have fewer than
    /// ten bits, so such surfaces hide each other at random; perspective-correct shades and textures and the error
    /// budget are wrong there, too.
    #[must_use]
    pub fn near_needed(&self) -> Option<f32> {
        self.near_needed
    }

    /// The hidden-surface method.
    #[must_use]
    pub fn hidden_surfaces(&self) -> HiddenSurfaces {
        if Effect::HiddenSurfaces.is_left_out() { HiddenSurfaces::BackFaces } else { self.hidden_surfaces }
    }

    /// Returns whether the plan chose the hidden-surface method itself, rather than on request. If
    /// so, any object painted far to near is convex, and its faces are drawn in any order.
    #[must_use]
    pub fn is_chosen(&self) -> bool {
        self.chosen
    }

    /// The decisions for each object of the scene, in its order.
    #[must_use]
    pub fn objects(&self) -> &[ObjectPlan] {
        &self.objects
    }

    /// Returns whether an effect is on for any object.
    #[must_use]
    pub fn is_on_anywhere(&self, effect: Effect) -> bool {
        self.objects.iter().any(|plan| plan.is_on(effect))
    }

    /// Every decision as text: object by object, in the order of [`Effect::ALL`].
    #[must_use]
    pub fn rows(&self, scene: &Scene) -> Vec<Row> {
        self.rows_with(scene, |_| Findings::default())
    }

    /// Every decision as text, with the facts found out about each object while drawing.
    #[must_use]
    pub(crate) fn rows_with(&self, scene: &Scene, findings: impl Fn(usize) -> Findings) -> Vec<Row> {
        let mut rows = Vec::with_capacity(self.objects.len() * Effect::COUNT);
        for (index, plan) in self.objects.iter().enumerate() {
            let findings = findings(index);
            for effect in Effect::ALL {
                let Decision { on, choice, reason } = plan[effect];
                let reason = reason.text(scene, index) + &findings.text(effect, on);
                let (object, choice) = (reason::name_of(scene, index), choice.name());
                rows.push(Row { index, object, effect, on, choice, reason });
            }
        }
        rows
    }
}

/// A decision as text.
#[derive(Clone, PartialEq, Eq, Debug)]
#[non_exhaustive]
pub struct Row {
    /// The object's index in the scene.
    pub index: usize,
    /// The object's name.
    pub object: String,
    /// The effect.
    pub effect: Effect,
    /// Whether the effect is on.
    pub on: bool,
    /// The variant of the effect; empty if there is only one.
    pub choice: &'static str,
    /// The reason.
    pub reason: String,
}

/// One line: `torus: fog off, the scene has none`.
///
/// ```
/// use mode13h::mesh::shapes;
/// use mode13h::render::{Renderer, Screen};
/// use mode13h::scene::Scene;
///
/// let scene = Scene::showing(shapes::cube());
/// let rows = Renderer::new().make_plan(&scene, Screen::MODE_13H)?.rows(&scene);
/// assert_eq!(rows[0].to_string(), "object 0: transform on, the first frame");
/// # Ok::<(), mode13h::render::RenderError>(())
/// ```
impl fmt::Display for Row {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { object, effect, on, choice, reason, .. } = self;
        let state = if *on { "on" } else { "off" };
        let choice = if choice.is_empty() { String::new() } else { format!(" ({choice})") };
        write!(f, "{object}: {effect} {state}{choice}, {reason}")
    }
}

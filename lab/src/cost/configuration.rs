//! Configurations of the renderer that are measured against each other.

use core::fmt;

use super::Aspect;
use mode13h::render::Renderer;
use mode13h::settings::DitherPattern;
use mode13h::settings::{Accuracy, HiddenSurfaces, Shading, VertexPath};
use mode13h::span::Kernel;

/// The budgets that are measured, in shades, largest error first.
pub const BUDGETS: [f64; 6] = [16.0, 8.0, 4.0, 2.0, 1.0, 0.5];

/// The shading that times are relative to.
pub(super) const REFERENCE: Shading = Shading::Gouraud88;

/// The reason why a configuration is measured.
#[derive(Clone, Copy, PartialEq, Debug)]
pub(super) enum Kind {
    Shading(Shading),
    /// An error budget, in shades.
    Budget(f64),
    Choice(Aspect),
}

impl Kind {
    /// Its name in a list of samples.
    pub(super) const fn name(self) -> &'static str {
        match self {
            Self::Shading(_) => "shading",
            Self::Budget(_) => "budget",
            Self::Choice(aspect) => aspect.name(),
        }
    }
}

/// A configuration of the renderer.
pub(super) struct Configuration<'a> {
    pub(super) kind: Kind,
    pub(super) name: String,
    set: Box<dyn Fn(&mut Renderer) + Sync + 'a>,
    /// Dither or none, overriding what the scene asks for.
    pub(super) dither: Option<Option<DitherPattern>>,
}

impl fmt::Debug for Configuration<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} {}", self.kind.name(), self.name)
    }
}

impl<'a> Configuration<'a> {
    pub(super) fn new(kind: Kind, name: impl ToString, set: impl Fn(&mut Renderer) + Sync + 'a) -> Self {
        Self { kind, name: name.to_string(), set: Box::new(set), dither: None }
    }

    fn accurate(kind: Kind, name: impl ToString, accuracy: Accuracy) -> Self {
        Self::new(kind, name, move |renderer| {
            renderer.settings.accuracy = Some(accuracy);
        })
    }

    pub(super) fn shading(shading: Shading) -> Self {
        Self::accurate(Kind::Shading(shading), shading, Accuracy::Shading(shading))
    }

    pub(super) fn budget(shades: f64) -> Self {
        // Budgets are powers of two, exact in f32.
        Self::accurate(Kind::Budget(shades), shades, Accuracy::WithinError(shades as f32))
    }

    /// All budgets and all shadings of a list, with the reference added.
    pub(super) fn shadings_and_budgets(shadings: &[Shading]) -> Vec<Self> {
        let listed = |shading: &Shading| *shading == REFERENCE || shadings.contains(shading);
        let shadings = Shading::ALL.into_iter().filter(listed).map(Self::shading);
        shadings.chain(BUDGETS.into_iter().map(Self::budget)).collect()
    }

    /// The configuration with vertices rounded to `bits` fractional bits.
    pub(super) fn with_vertex_bits(self, bits: u8) -> Self {
        let set = self.set;
        let set = Box::new(move |renderer: &mut Renderer| {
            set(renderer);
            renderer.settings.vertex_bits = Some(bits);
        });
        Self { set, ..self }
    }

    /// The configuration with this dither or none.
    pub(super) fn dithered(mut self, dither: Option<DitherPattern>) -> Self {
        self.dither = Some(dither);
        self
    }

    /// Lists the other choices aspect by aspect, the default first, all with the default shading; then each of these
    /// shadings with the portable kernel, the reference first.
    ///
    /// Vertices are rounded to 8 bits and then again to fewer, so these times say nothing about a machine that has
    /// fewer bits.
    pub(super) fn choices(shadings: &[Shading]) -> Vec<Self> {
        let with_shading = |aspect, name: &dyn fmt::Display, set: Box<dyn Fn(&mut Renderer) + Sync>| {
            Self::new(Kind::Choice(aspect), name, move |renderer| {
                renderer.settings.accuracy = Some(Shading::default().into());
                set(renderer);
            })
        };
        let mut ways = Vec::new();
        for path in VertexPath::ALL {
            ways.push(with_shading(Aspect::VertexPath, &path, Box::new(move |r| r.settings.vertex_path = Some(path))));
        }
        for (bits, name) in [(8, "1/256 pixel"), (4, "1/16 pixel"), (0, "whole pixels")] {
            ways.push(with_shading(
                Aspect::VertexRounding,
                &name,
                Box::new(move |r| r.settings.vertex_bits = Some(bits)),
            ));
        }
        let fastest = Kernel::default();
        let others = Kernel::available().filter(|kernel| kernel.level() != fastest.level());
        for kernel in core::iter::once(fastest).chain(others) {
            ways.push(with_shading(Aspect::Kernel, &kernel, Box::new(move |r| r.kernel = kernel)));
        }
        for dither in core::iter::once(None).chain(DitherPattern::ALL.map(Some)) {
            let name = dither.map_or("none", DitherPattern::name);
            ways.push(with_shading(Aspect::Dither, &name, Box::new(|_| {})).dithered(dither));
        }
        let called_for = core::iter::once((None, "as called for"));
        for (way, name) in called_for.chain(HiddenSurfaces::ALL.into_iter().map(|way| (Some(way), way.name()))) {
            ways.push(with_shading(Aspect::HiddenSurfaces, &name, Box::new(move |r| r.settings.hidden_surfaces = way)));
        }
        let others = Shading::ALL.into_iter().filter(|shading| *shading != REFERENCE && shadings.contains(shading));
        for shading in core::iter::once(REFERENCE).chain(others) {
            ways.push(Self::new(Kind::Choice(Aspect::PortableShading), shading, move |renderer| {
                renderer.settings.accuracy = Some(shading.into());
                renderer.kernel = Kernel::PORTABLE;
            }));
        }
        ways
    }

    /// Applies this configuration to a renderer, whose other settings stay as they are.
    pub(super) fn apply(&self, mut renderer: Renderer) -> Renderer {
        (self.set)(&mut renderer);
        renderer
    }
}

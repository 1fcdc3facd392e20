//! Ways to draw a scene: what is measured against each other.

use alloc::boxed::Box;
use alloc::string::{String, ToString};
use alloc::vec::Vec;
use core::fmt;

use super::Aspect;
use mode13h::hooks;
use mode13h::render::{HiddenSurfaces, Renderer, Rung, VertexPath};
use mode13h::span::Kernel;

/// The budgets that are measured, in shades, the greatest error first.
pub const BUDGETS: [f64; 5] = [16.0, 8.0, 4.0, 2.0, 1.0];

/// The rung whose time is 1.
pub(super) const REFERENCE: Rung = Rung::Gouraud88;

/// What a way to draw is measured for.
#[derive(Clone, Copy, PartialEq, Debug)]
pub(super) enum Kind {
    Rung(Rung),
    /// In shades.
    Budget(f64),
    Choice(Aspect),
}

impl Kind {
    /// Its name in a list of samples.
    pub(super) const fn name(self) -> &'static str {
        match self {
            Self::Rung(_) => "rung",
            Self::Budget(_) => "budget",
            Self::Choice(aspect) => aspect.name(),
        }
    }
}

/// A way to draw.
pub(super) struct Way<'a> {
    pub(super) kind: Kind,
    pub(super) name: String,
    set: Box<dyn Fn(&mut Renderer) + Sync + 'a>,
    /// Whether dither is asked for, whatever the scene does.
    pub(super) dither: Option<bool>,
}

impl fmt::Debug for Way<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} {}", self.kind.name(), self.name)
    }
}

impl<'a> Way<'a> {
    pub(super) fn new(kind: Kind, name: impl ToString, set: impl Fn(&mut Renderer) + Sync + 'a) -> Self {
        Self { kind, name: name.to_string(), set: Box::new(set), dither: None }
    }

    pub(super) fn rung(rung: Rung) -> Self {
        Self::new(Kind::Rung(rung), rung, move |renderer| renderer.set_rung(rung))
    }

    pub(super) fn budget(shades: f64) -> Self {
        // Whole numbers up to 16.
        Self::new(Kind::Budget(shades), shades, move |renderer| renderer.set_max_error(Some(shades as f32)))
    }

    /// All rungs of a list, the reference among them, and all budgets.
    pub(super) fn rungs_and_budgets(rungs: &[Rung]) -> Vec<Self> {
        let listed = |rung: &Rung| *rung == REFERENCE || rungs.contains(rung);
        let rungs = Rung::ALL.into_iter().filter(listed).map(Self::rung);
        rungs.chain(BUDGETS.into_iter().map(Self::budget)).collect()
    }

    /// The same with vertices rounded to so many bits after the point.
    pub(super) fn with_vertex_bits(self, bits: u32) -> Self {
        let set = self.set;
        let set = Box::new(move |renderer: &mut Renderer| {
            set(renderer);
            hooks::set_vertex_bits(renderer, bits);
        });
        Self { set, ..self }
    }

    /// The same with or without dither.
    pub(super) fn dithered(mut self, dither: bool) -> Self {
        self.dither = Some(dither);
        self
    }

    /// What else may be chosen, aspect by aspect, the default first; all with the default rung, and at the end each of
    /// these rungs, and the reference first, by the portable kernel.
    ///
    /// Vertices are rounded to fewer bits after they have been to 8: what that takes is no gain of time that a machine
    /// with fewer bits would have, and no loss either.
    pub(super) fn choices(rungs: &[Rung]) -> Vec<Self> {
        let with_rung = |aspect, name: &dyn fmt::Display, set: Box<dyn Fn(&mut Renderer) + Sync>| {
            Self::new(Kind::Choice(aspect), name, move |renderer| {
                renderer.set_rung(Rung::default());
                set(renderer);
            })
        };
        let mut ways = Vec::new();
        for path in VertexPath::ALL {
            ways.push(with_rung(Aspect::VertexPath, &path, Box::new(move |r| r.set_vertex_path(path))));
        }
        for (bits, name) in [(8, "1/256 pixel"), (4, "1/16 pixel"), (0, "whole pixels")] {
            ways.push(with_rung(Aspect::VertexRounding, &name, Box::new(move |r| hooks::set_vertex_bits(r, bits))));
        }
        let fastest = Kernel::fastest();
        let others = Kernel::available().filter(|kernel| kernel.level() != fastest.level());
        for kernel in core::iter::once(fastest).chain(others) {
            ways.push(with_rung(Aspect::Kernel, &kernel, Box::new(move |r| r.set_kernel(kernel))));
        }
        for (dither, name) in [(false, "none"), (true, "ordered")] {
            ways.push(with_rung(Aspect::Dither, &name, Box::new(|_| {})).dithered(dither));
        }
        let called_for = core::iter::once((None, "as called for"));
        for (way, name) in called_for.chain(HiddenSurfaces::ALL.into_iter().map(|way| (Some(way), way.name()))) {
            ways.push(with_rung(Aspect::HiddenSurfaces, &name, Box::new(move |r| r.set_hidden_surfaces(way))));
        }
        let others = Rung::ALL.into_iter().filter(|rung| *rung != REFERENCE && rungs.contains(rung));
        for rung in core::iter::once(REFERENCE).chain(others) {
            ways.push(Self::new(Kind::Choice(Aspect::PortableRung), rung, move |renderer| {
                renderer.set_rung(rung);
                renderer.set_kernel(Kernel::PORTABLE);
            }));
        }
        ways
    }

    /// A renderer that draws this way, and as it is set besides.
    pub(super) fn apply(&self, mut renderer: Renderer) -> Renderer {
        (self.set)(&mut renderer);
        renderer
    }
}

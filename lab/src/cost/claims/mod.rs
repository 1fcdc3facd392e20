//! The old texts' claims, measured on scenes made for them, whatever the input is.
//!
//! A claim is a sentence, and measuring it means defining what its words mean. `verdict` defines them in numbers, and
//! every verdict is computed from the figures alone.
//!
//! | file | what |
//! |---|---|
//! | `scenes` | spheres with few and with many faces, a torus, a floor that recedes from the eye |
//! | `figures` | everything that is measured, and the text that reports it |
//! | `verdict` | the words of a claim in numbers |

mod figures;
mod scenes;
mod verdict;

use self::figures::{Figures, Sphere};
use self::scenes::SLICES;
use super::accuracy::{against, between};
use super::configuration::Configuration;
use super::interleaved::{Outcome, Spent, run_interleaved};
use super::statistics::{Ratio, quartiles};
use super::{Claim, CostError};
use crate::truth::Standard;
use mode13h::render::Renderer;
use mode13h::scene::Scene;
use mode13h::settings::Shading;
use mode13h_conformance::Random;

/// The scenes, and each shading that the claims about a scene need, with the scene's index.
fn entrants() -> (Vec<Vec<Scene>>, Vec<(Shading, usize)>) {
    use Shading::{
        Flat, Gouraud88, Gouraud88Reseeded, Gouraud1616, GouraudFloat, GouraudHyperbolic, Phong, PhongTable,
    };
    let all = [Gouraud88, Gouraud88Reseeded, Gouraud1616, GouraudHyperbolic, Flat, GouraudFloat, Phong, PhongTable];
    let of_spheres = [Flat, Gouraud88, Gouraud88Reseeded, Phong, PhongTable];
    let mut scenes = vec![scenes::torus()];
    scenes.extend(SLICES.map(|slices| scenes::sphere(slices, true)));
    let shadings = |scene: usize| if scene == TORUS { &all[..] } else { &of_spheres[..] };
    let each = |scene: usize| shadings(scene).iter().map(move |shading| (*shading, scene));
    let list = (0..scenes.len()).flat_map(each).collect();
    (scenes, list)
}

/// Index of the torus among the scenes; the spheres follow it.
const TORUS: usize = 0;

/// Times of all entrants.
struct Times {
    list: Vec<(Shading, usize)>,
    /// Time per frame, round by round.
    times: Vec<Vec<f64>>,
    seed: u64,
}

impl Times {
    fn place(&self, shading: Shading, scene: usize) -> usize {
        // Every requested pair was drawn.
        self.list.iter().position(|entrant| *entrant == (shading, scene)).unwrap_or(0)
    }

    fn ratio(&self, shading: Shading, to: Shading, scene: usize) -> f64 {
        let (one, other) = (self.place(shading, scene), self.place(to, scene));
        Ratio::new(&self.times[one], &self.times[other], &mut Random::again(self.seed)).median
    }

    fn median(&self, shading: Shading, scene: usize) -> f64 {
        quartiles(&self.times[self.place(shading, scene)]).median
    }
}

/// Measures all claims, timing for about as long as `spent` says; errors take extra time. `progress` is told the share
/// done.
pub(super) fn claims(
    base: &(dyn Fn() -> Renderer + Sync),
    spent: &Spent,
    progress: &dyn Fn(f64),
) -> Result<Vec<Claim>, CostError> {
    let (scenes, list) = entrants();
    let ways: Vec<Configuration<'_>> = list.iter().map(|(shading, _)| Configuration::shading(*shading)).collect();
    let entrants: Vec<(&Configuration<'_>, &[Scene])> =
        ways.iter().zip(&list).map(|(way, (_, scene))| (way, scenes[*scene].as_slice())).collect();
    let Outcome { samples, .. } = run_interleaved(&entrants, base, spent, &|share| progress(share / 2.0))?;
    let times = Times { times: (0..list.len()).map(|way| samples.of(way)).collect(), list, seed: spent.seed };

    let mut spheres = Vec::new();
    for (number, slices) in SLICES.into_iter().enumerate() {
        progress(0.5 + number as f64 / (2 * SLICES.len()) as f64);
        spheres.push(sphere(slices, TORUS + 1 + number, &scenes, &times, base)?);
    }
    let floor = scenes::floor();
    let torus = &scenes[TORUS];
    let everywhere: Vec<Scene> = torus.iter().chain(&floor).cloned().collect();
    let fixed = [Shading::Gouraud88, Shading::Gouraud88Reseeded, Shading::Gouraud1616].map(Configuration::shading);
    let fixed = against(Standard::Gouraud, &everywhere, &fixed, base)?;
    let float = [Configuration::shading(Shading::GouraudFloat)];
    let float = against(Standard::GouraudPerspective, &everywhere, &float, base)?;
    let linear = [Standard::Gouraud, Standard::GouraudPerspective];
    let figures = Figures {
        spheres,
        fixed: [0, 1, 2].map(|i| fixed[i].errors()),
        float: float[0].errors(),
        of_default: [Shading::Gouraud88, Shading::Gouraud1616, Shading::GouraudFloat]
            .map(|shading| times.ratio(shading, Shading::Gouraud88Reseeded, TORUS)),
        linear_on_torus: between(linear, torus)?,
        linear_on_floor: between(linear, &floor)?,
        hyperbolic_to_linear: times.ratio(Shading::GouraudHyperbolic, Shading::Gouraud88Reseeded, TORUS),
    };
    Ok(figures.claims())
}

/// All figures of one sphere.
fn sphere(
    slices: u32,
    scene: usize,
    scenes: &[Vec<Scene>],
    times: &Times,
    base: &dyn Fn() -> Renderer,
) -> Result<Sphere, CostError> {
    let (matt, shiny) = (scenes::sphere(slices, false), &scenes[scene]);
    let linear = || Configuration::shading(Shading::Gouraud88Reseeded);
    let off = against(Standard::GouraudUnrounded, &matt, &[linear(), linear().with_vertex_bits(0)], base)?;
    let model = against(Standard::Lit, shiny, &[linear(), Configuration::shading(Shading::Phong)], base)?;
    let triangles = matt[0].objects()[0].mesh().triangles().len();
    let seen = (off[0].pixels() + off[0].cover_errors) as f64 / matt.len() as f64;
    Ok(Sphere {
        triangles,
        // Half of a closed mesh's faces are turned toward the eye.
        pixels_of_each: seen / (triangles as f64 / 2.0),
        fine: off[0].errors(),
        whole: off[1].errors(),
        wrong_faces: [0, 1].map(|of: usize| off[of].share_not_compared()),
        linear: model[0].errors(),
        phong: model[1].errors(),
        linear_time: times.median(Shading::Gouraud88Reseeded, scene),
        phong_time: times.median(Shading::Phong, scene),
        to_flat: times.ratio(Shading::Gouraud88, Shading::Flat, scene),
        phong_to_linear: times.ratio(Shading::Phong, Shading::Gouraud88, scene),
        table_to_linear: times.ratio(Shading::PhongTable, Shading::Gouraud88, scene),
    })
}

//! A palette made for the visible surfaces: a ramp for each material, a block for the textures.
//!
//! Entry 0 is black, for the background, and entry 255 white, for text and graphics drawn over the picture. The 254 in
//! between are handed out so that each lowers the sum, over all visible pixels, of the squared distance between wanted
//! and displayed colour as much as possible:
//!
//! - A ramp of n entries has n − 1 steps. Rounding to its entries has a mean squared error of a twelfth of the squared
//!   step, so with a share `area` of the pixels, and colours `length` apart between the darkest and the brightest
//!   visible, it costs `area·length²/(12·(n − 1)²)`.
//! - The textures' colours at all visible brightnesses are reduced by median cut, whose cuts have known gains. All
//!   textures share one block: their shades use the nearest entry of the whole palette
//!   ([`Lut64K::shades`](mode13h::palette::Lut64K::shades)), so they use the ramps' entries, too.
//! - Colours that are mixed on the screen and on no ramp (in fog, behind glass, under coloured light) are points of the
//!   same cloud, without change of brightness.
//!
//! The gain of a ramp's next entry shrinks with each entry, so a greedy choice is optimal for the ramps: one entry at a
//! time to the one that gains most. A ramp never gets more entries than it has colours that the card can show.
//!
//! **Ramps.** Entry i of n is the colour at intensity i/(n − 1): black at 0, the material's own colour at full light,
//! on a straight line. Ramps begin at black, not at the darkest visible shade: a shade is an index into the ramp and 0
//! its first entry, whatever the light, and a moving light needs the darker ones. On the ramp of a material with a
//! highlight a second line leads from the colour to the highlight's. The two share the ramp in proportion to their
//! lengths, so that all its steps are equally wide: [`Entries::Ramp`] says where they meet.
//!
//! **More materials than room.** 63 ramps of 4 entries fill the palette. The materials that lose most without a ramp
//! get one: first the one with the largest area; then always the one for which area × squared distance to the nearest
//! colour chosen so far is largest. All others share the nearest ramp; two of one colour always share it.

use alloc::vec;
use alloc::vec::Vec;

use mode13h::palette::MedianCut;
use mode13h::palette::gradient::{Stop, color_at, fill};
use mode13h::palette::{Palette, Ramp, Rgb};

/// A surface's needs from a palette.
#[derive(Clone, Copy, PartialEq, Debug)]
pub struct Use<'a> {
    /// The colour in full light.
    pub color: Rgb,
    /// The colour in the middle of a highlight in full light; `None` if it is matt.
    pub highlight: Option<Rgb>,
    /// The share of the visible pixels: any unit, not negative. A surface that is never visible counts as a millionth
    /// of everything, so that it has a colour when it does become visible.
    pub area: f32,
    /// The least visible intensity, 0 to 1, without highlights.
    pub darkest: f32,
    /// The greatest visible intensity, 0 to 1, without highlights.
    pub brightest: f32,
    /// The colours of its texture in full light, if it has one, each with its number of texels. Then `color` and
    /// `highlight` are ignored.
    pub texels: Option<&'a [(Rgb, u32)]>,
    /// The colours at equal steps of intensity from 0 to 1, at least two and at most 256, if they are not on a straight
    /// line. Then the ramp runs through them, full light is 1, and `color` is ignored.
    pub along: Option<&'a [Rgb]>,
}

/// The entries that a surface gets.
#[derive(Clone, Copy, PartialEq, Debug)]
#[non_exhaustive]
pub enum Entries {
    /// A ramp, perhaps shared with others. No two ramps overlap.
    Ramp {
        /// The ramp, from black through the surface's colour in full light to that of its highlight.
        ramp: Ramp,
        /// The intensity, 0 to 1, of the entry for the colour in full light. A material's ambient and diffuse light add
        /// up to this, and its highlight to the rest; for a matt one it is 1.
        full_light: f32,
    },
    /// The block of entries shared by all textures. Shades go through a table, which may use nearer entries elsewhere.
    Textures {
        /// The block's entries, in no particular order.
        block: Ramp,
    },
}

/// A palette for surfaces, with the entries of each, as [`share`] distributes them.
///
/// [`AutomaticPalette`](super::AutomaticPalette) is one for a scene, with its materials.
#[derive(Clone, PartialEq, Debug)]
pub struct Automatic {
    /// The colours, all of which the card shows exactly. The palette declares no ramps: they are not equal, so
    /// materials name their entries.
    pub palette: Palette,
    /// The entries of each use.
    pub entries: Vec<Entries>,
}

/// The number of entries to distribute: all except the first and the last.
const CAPACITY: usize = 254;
/// The minimum length of a ramp, unless it has fewer colours.
const MIN_ENTRIES: usize = 4;
/// The number of entries reserved for textures before the ramps get theirs.
const MIN_FOR_TEXTURES: usize = 16;
/// The share of the area assumed for a surface that is never visible.
const UNSEEN: f64 = 1e-6;
/// The narrowest range of intensities to make entries for, since a light may move.
const NARROWEST: f64 = 0.25;
/// The number of brightness levels tested for a texture's colours.
const LEVELS: u8 = 16;
/// The maximum number of textured uses that are considered: those with the largest areas.
const MAX_TEXTURED: usize = 64;
/// The weight of the whole area in median cut.
const WHOLE: f64 = 16_777_216.0;
/// More than any sum of the squared distances between two colours and between two highlights: 2 · 195,075.
const FARTHER_THAN_ANY: u32 = 400_000;

/// Distributes the palette among surfaces.
///
/// ```
/// use mode13h::palette::Rgb;
/// use mode13h_assets::auto_palette;
/// let roof = auto_palette::Use {
///     color: Rgb::new(190, 50, 30), highlight: None, area: 0.75, darkest: 0.25, brightest: 1.0, texels: None,
///     along: None,
/// };
/// let ground = auto_palette::Use { color: Rgb::new(40, 130, 40), area: 0.25, ..roof };
/// let automatic = auto_palette::share(&[roof, ground]);
/// use auto_palette::Entries::Ramp;
/// let [Ramp { ramp, .. }, Ramp { ramp: other, .. }] = automatic.entries[..] else {
///     unreachable!("two ramps");
/// };
/// assert!(ramp.entries() > other.entries());
/// assert_eq!(automatic.palette[ramp.last()], roof.color.nearest_on_dac());
/// ```
#[must_use]
pub fn share(uses: &[Use<'_>]) -> Automatic {
    share_beside(uses, &[])
}

/// Distributes the palette with room for mixtures: colours that are on no ramp and appear on the screen unchanged, each
/// with the area that it covers there, in the unit of [`Use::area`]. They go into the block of the textures.
///
/// ```
/// use mode13h::palette::Rgb;
/// use mode13h_assets::auto_palette;
/// let haze = Rgb::from_dac([40, 42, 45]);
/// let automatic = auto_palette::share_beside(&[], &[(haze, 1.0)]);
/// assert!(automatic.palette.colors().contains(&haze));
/// ```
#[must_use]
pub fn share_beside(uses: &[Use<'_>], mixtures: &[(Rgb, f32)]) -> Automatic {
    let (areas, mixed) = areas(uses, mixtures);
    let mut textures = MedianCut::new(cloud(uses, &areas, &mixed));
    let is_needed = !mixed.is_empty() || uses.iter().any(|of| of.texels.is_some());
    let kept = if is_needed { MIN_FOR_TEXTURES } else { 0 };
    textures.cut_to(kept);
    let (mut ramps, ramp_of) = choose(uses, &areas, (CAPACITY - kept) / MIN_ENTRIES);
    give(&mut ramps, &mut textures);

    let mut colors = [Rgb::BLACK; 256];
    colors[255] = Rgb::WHITE;
    let mut first = 1;
    let placed: Vec<Entries> = ramps
        .iter()
        .map(|ramp| {
            let place = entries(first, ramp.entries);
            first += ramp.entries;
            ramp.fill(place, &mut colors);
            Entries::Ramp { ramp: place, full_light: f32::from(ramp.full_light) / 255.0 }
        })
        .collect();
    let own = colors_beside(&mut textures, &colors[..first]);
    colors[first..].iter_mut().zip(&own).for_each(|(entry, color)| *entry = *color);
    let block = Entries::Textures { block: entries(first, own.len().max(1)) };
    Automatic {
        palette: Palette::from_colors(colors).with_ramps(0).unwrap_or_default(),
        entries: ramp_of.into_iter().map(|ramp| ramp.map_or(block, |ramp| placed[ramp])).collect(),
    }
}

/// The ramp of `count` entries starting at `first`; together at most 256.
fn entries(first: usize, count: usize) -> Ramp {
    let ramp = u8::try_from(first).ok().zip(u16::try_from(count).ok());
    ramp.and_then(|(first, count)| Ramp::new(first, count)).unwrap_or(Ramp::WHOLE)
}

/// Hands out the free entries one at a time, each to the ramp or block that gains most.
fn give(ramps: &mut [Wanted], textures: &mut MedianCut) {
    let mut room = CAPACITY.saturating_sub(ramps.iter().map(|ramp| ramp.entries).sum::<usize>() + textures.boxes());
    while room > 0 {
        let best = best(ramps, Wanted::gain);
        let by_ramp = best.map_or(0.0, |best| ramps[best].gain());
        if textures.gain().is_some_and(|gain| gain / WHOLE > by_ramp) {
            textures.cut();
        } else {
            match best {
                Some(best) if by_ramp > 0.0 => ramps[best].entries += 1,
                // No ramp gains any more: each shows all its colours. The remaining entries make them finer than the
                // card can show, which costs nothing.
                Some(_) => break,
                None => return,
            }
        }
        room -= 1;
    }
    for _ in 0..room {
        if let Some(best) = self::best(ramps, Wanted::gain_unbounded) {
            ramps[best].entries += 1;
        }
    }
}

/// The ramp that gains most; the first if several do.
fn best(ramps: &[Wanted], gain: impl Fn(&Wanted) -> f64) -> Option<usize> {
    (0..ramps.len()).reduce(|best, next| if gain(&ramps[next]) > gain(&ramps[best]) { next } else { best })
}

/// Finds one colour for each box, or fewer if colours run out. No colour occurs twice, and none is in `beside`.
/// For each colour dropped, another box is cut.
fn colors_beside(textures: &mut MedianCut, beside: &[Rgb]) -> Vec<Rgb> {
    let wanted = textures.boxes();
    let mut found = Vec::new();
    loop {
        let mut colors: Vec<Rgb> = textures.means().map(Rgb::nearest_on_dac).collect();
        colors.sort_unstable_by_key(|color| (color.brightness(), *color));
        colors.dedup();
        colors.retain(|color| !beside.contains(color));
        // Both halves of a dropped box may remain, which is one more than wanted.
        if colors.len() > wanted {
            return found;
        }
        found = colors;
        if found.len() == wanted || !textures.cut() {
            return found;
        }
    }
}

/// A ramp being planned, and the number of its entries so far.
struct Wanted {
    keys: Vec<Stop>,
    /// The position on the ramp of the colour in full light, in 1/255.
    full_light: u8,
    /// The length from key to key, in 1/255 of a channel.
    length: f64,
    area: f64,
    /// The visible range of the ramp, 0 to 1.
    darkest: f64,
    brightest: f64,
    /// The number of its colours that the card can show.
    colors: usize,
    entries: usize,
}

impl Wanted {
    fn new(of: &Use<'_>) -> Self {
        let distance = |a: Rgb, b: Rgb| libm::sqrt(f64::from(a.distance_squared(b)));
        let (keys, full_light) = match of.bent() {
            Some(colors) => {
                let last = colors.len() - 1;
                // 0 to 255.
                let key =
                    |(i, color): (usize, &Rgb)| Stop { at: (255 * i / last) as u8, color: color.nearest_on_dac() };
                (colors.iter().enumerate().map(key).collect(), 255)
            }
            None => {
                let (color, highlight) = of.shown();
                let (up, on) = (distance(Rgb::BLACK, color), distance(color, highlight));
                // 0 to 255; NaN, from a black that stays black, becomes 0.
                let full_light = if on == 0.0 { 255 } else { (up / (up + on) * 255.0 + 0.5) as u8 };
                let keys = [(0, Rgb::BLACK), (full_light, color), (255, highlight)];
                (keys.map(|(at, color)| Stop { at, color }).to_vec(), full_light)
            }
        };
        let mut ramp = Self {
            full_light,
            length: keys.windows(2).map(|ends| distance(ends[0].color, ends[1].color)).sum(),
            keys,
            area: 0.0,
            darkest: 1.0,
            brightest: 0.0,
            colors: 0,
            entries: 0,
        };
        // Sixteen positions for every step of one channel, so that hardly any colour is missed.
        let places = (0..=1024).filter_map(|i| color_at(i, 1025, &ramp.keys)).map(Rgb::nearest_on_dac);
        let mut before = None;
        ramp.colors = places.filter(|&color| before.replace(color) != Some(color)).count();
        ramp.entries = ramp.colors.min(MIN_ENTRIES);
        ramp
    }

    /// Adds a use to the ramp.
    fn add(&mut self, of: &Use<'_>, area: f64) {
        let (darkest, brightest) = of.range();
        let full_light = f64::from(self.full_light) / 255.0;
        self.area += area;
        self.darkest = self.darkest.min(darkest * full_light);
        self.brightest = self.brightest.max(if of.highlight.is_some() { 1.0 } else { brightest * full_light });
    }

    fn fill(&self, ramp: Ramp, colors: &mut [Rgb; 256]) {
        fill(colors, ramp, &self.keys);
        for i in ramp.range() {
            let color = &mut colors[usize::from(i)];
            *color = color.nearest_on_dac();
        }
    }

    /// The gain of one more entry; 0 once there are as many entries as colours that the card can show.
    fn gain(&self) -> f64 {
        if self.entries < self.colors { self.gain_unbounded() } else { 0.0 }
    }

    /// The gain without that limit: area·length²/12 · (1/(n − 1)² − 1/n²).
    fn gain_unbounded(&self) -> f64 {
        let length = (self.brightest - self.darkest).max(0.0) * self.length;
        // A ramp of one entry has a single colour, black.
        let steps = self.entries.saturating_sub(1).max(1) as f64;
        let next = steps + 1.0;
        self.area * length * length / 12.0 * (1.0 / (steps * steps) - 1.0 / (next * next))
    }
}

impl Use<'_> {
    /// The colours of a ramp that is not straight.
    fn bent(&self) -> Option<&[Rgb]> {
        self.along.filter(|along| (2..=256).contains(&along.len()))
    }

    /// The colours in full light and of the highlight as the card can show them. In a ramp that is not straight, those
    /// in the middle and at the end.
    fn shown(&self) -> (Rgb, Rgb) {
        if let Some(along) = self.bent() {
            return (along[along.len() / 2].nearest_on_dac(), along[along.len() - 1].nearest_on_dac());
        }
        (self.color.nearest_on_dac(), self.highlight.unwrap_or(self.color).nearest_on_dac())
    }

    /// The least and the greatest intensity, at least [`NARROWEST`] apart.
    fn range(&self) -> (f64, f64) {
        let [a, b] = [self.darkest, self.brightest].map(|v| not_negative(v).min(1.0));
        let brightest = a.max(b).max(NARROWEST);
        (a.min(b).min(brightest - NARROWEST), brightest)
    }
}

/// The value, at least 0; NaN counts as 0.
fn not_negative(v: f32) -> f64 {
    f64::from(v.max(0.0))
}

/// The share of each use in the total area, at least [`UNSEEN`], and that of each mixture.
fn areas(uses: &[Use<'_>], mixtures: &[(Rgb, f32)]) -> (Vec<f64>, Vec<(Rgb, f64)>) {
    // An infinite area counts as a very large one.
    let area = |area: f32| not_negative(area).min(1e30);
    let of_uses: f64 = uses.iter().map(|of| area(of.area)).sum();
    let whole = of_uses + mixtures.iter().map(|mixture| area(mixture.1)).sum::<f64>();
    let share = |of: f32| (area(of) / whole.max(f64::MIN_POSITIVE)).max(UNSEEN);
    let mixed = mixtures.iter().map(|&(color, of)| (color, share(of))).collect();
    (uses.iter().map(|of| share(of.area)).collect(), mixed)
}

/// Chooses at most `most` ramps, and one of them for each use without a texture.
fn choose(uses: &[Use<'_>], areas: &[f64], most: usize) -> (Vec<Wanted>, Vec<Option<usize>>) {
    let plain: Vec<usize> = (0..uses.len()).filter(|&i| uses[i].texels.is_none()).collect();
    let colors: Vec<(Rgb, Rgb)> = uses.iter().map(Use::shown).collect();
    // The squared distance to the nearest chosen one, and which one that is.
    let mut nearest = vec![(FARTHER_THAN_ANY, 0); uses.len()];
    let mut chosen = Vec::new();
    while chosen.len() < most {
        let loss = |i: usize| areas[i] * f64::from(nearest[i].0);
        let worst = plain.iter().copied().reduce(|worst, i| if loss(i) > loss(worst) { i } else { worst });
        let Some(next) = worst.filter(|&i| nearest[i].0 > 0) else { break };
        for &i in &plain {
            let distance = colors[i].0.distance_squared(colors[next].0) + colors[i].1.distance_squared(colors[next].1);
            if distance < nearest[i].0 {
                nearest[i] = (distance, next);
            }
        }
        chosen.push(next);
    }
    // In the order of the uses.
    chosen.sort_unstable();
    let mut ramps: Vec<Wanted> = chosen.iter().map(|&i| Wanted::new(&uses[i])).collect();
    let mut ramp_of = vec![None; uses.len()];
    for &i in &plain {
        ramp_of[i] = chosen.binary_search(&nearest[i].1).ok();
        if let Some(ramp) = ramp_of[i] {
            ramps[ramp].add(&uses[i], areas[i]);
        }
    }
    (ramps, ramp_of)
}

/// The colours of the textures at their visible brightnesses, as the card can show them, with their shares of the area;
/// and the mixtures.
fn cloud(uses: &[Use<'_>], areas: &[f64], mixed: &[(Rgb, f64)]) -> Vec<(Rgb, u32)> {
    let mut textured: Vec<usize> = (0..uses.len()).filter(|&i| uses[i].texels.is_some()).collect();
    textured.sort_by(|&a, &b| areas[b].total_cmp(&areas[a]));
    textured.truncate(MAX_TEXTURED);
    let mut points: Vec<(Rgb, u32)> = Vec::new();
    for (of, area) in textured.into_iter().map(|i| (&uses[i], areas[i])) {
        let texels = of.texels.unwrap_or_default();
        let count: f64 = texels.iter().map(|&(_, count)| f64::from(count)).sum();
        let (darkest, brightest) = of.range();
        for level in 0..LEVELS {
            let intensity = darkest + (brightest - darkest) * f64::from(level) / f64::from(LEVELS - 1);
            // 0 to 255.
            let shade = (intensity * 255.0 + 0.5) as u8;
            for &(color, texels) in texels.iter().filter(|(_, texels)| *texels > 0) {
                let weight = area * WHOLE * f64::from(texels) / (count * f64::from(LEVELS));
                // At most 2²⁴.
                points.push((Rgb::BLACK.mix(color, shade).nearest_on_dac(), (weight + 0.5) as u32));
            }
        }
    }
    // At most 2²⁴.
    points.extend(mixed.iter().map(|&(color, share)| (color.nearest_on_dac(), (share * WHOLE + 0.5) as u32)));
    points.sort_unstable();
    let same = points.chunk_by(|a, b| a.0 == b.0);
    same.map(|same| (same[0].0, same.iter().map(|(_, weight)| weight).sum::<u32>().max(1))).collect()
}

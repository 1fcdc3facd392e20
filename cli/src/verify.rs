//! `mode13h verify`: whether this machine draws the same frames as every other.

use std::fmt::Write as _;
use std::path::{Path, PathBuf};

use clap::Args;
use mode13h::export::{Picture, Png, Scale};
use mode13h::palette::Rgb;
use mode13h::render::Renderer;
use mode13h::span::Kernel;
use mode13h_conformance::frames::{self, Difference, Drawn, Frame};
use mode13h_conformance::hash::START;
use mode13h_conformance::loops::{self, Cases, Outcome};
use rayon::iter::{IntoParallelIterator, ParallelIterator};
use serde_json::{Value, json};

use crate::failure::Failure;
use crate::{output, typo};

#[derive(Args)]
pub(crate) struct Options {
    /// Print the result as JSON
    #[arg(long)]
    json: bool,
    /// Random seed for the loop checks
    #[arg(long, value_name = "N", default_value_t = 13)]
    seed: u64,
    /// Check only the frame NAME, or all whose names begin with NAME/
    ///
    /// For example effect/fog or shipped/torus/picture. The pixel loops are then not checked.
    #[arg(long, value_name = "NAME", conflicts_with = "seed")]
    frame: Option<String>,
    /// List the names of the frames without checking them
    #[arg(long, conflicts_with_all = ["json", "seed", "out"])]
    list: bool,
    /// Write a picture of the first wrong frame to FILE, which ends in .png
    ///
    /// It shows the frame as drawn, as it should be, and which pixels differ. If nothing is wrong, it shows the first frame.
    ///
    /// [default: verify-NAME.png, if frame NAME is wrong]
    #[arg(short, long, value_name = "FILE")]
    out: Option<PathBuf>,
}

fn kernels() -> Vec<&'static str> {
    Kernel::available().map(Kernel::name).collect()
}

/// A frame that differs from the one on every other machine.
struct Wrong {
    name: String,
    /// The difference from the portable kernel's frame; `None` if that kernel draws the same.
    difference: Option<Difference>,
    /// The error of a frame that could not be drawn.
    error: Option<String>,
}

impl std::fmt::Display for Wrong {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match (&self.error, &self.difference) {
            (Some(error), _) => write!(f, "{}: {error}", self.name),
            (None, Some(difference)) => write!(f, "{}: {difference}", self.name),
            (None, None) => {
                write!(f, "{}: equals the portable kernel's frame, but not that of other machines", self.name)
            }
        }
    }
}

/// The frames drawn by one kernel.
struct ByKernel {
    kernel: Kernel,
    count: usize,
    /// Hash of all frame hashes.
    hash: u64,
    wrong: Vec<Wrong>,
}

/// The frames whose names begin with `prefix`, or all.
fn chosen(prefix: Option<&str>) -> Vec<Frame> {
    let mut all = frames::all();
    if let Some(prefix) = prefix {
        let prefix = prefix.trim_end_matches('/');
        all.retain(|frame| {
            frame.name.strip_prefix(prefix).is_some_and(|rest| rest.is_empty() || rest.starts_with('/'))
        });
    }
    all
}

/// A frame whose scene is built, once for all kernels, and its hash on every machine.
struct Built {
    name: String,
    expected: Option<u32>,
    picture: frames::Picture,
}

fn draw(kernel: Kernel, frames: &[Built]) -> ByKernel {
    let mut drawn = ByKernel { kernel, count: frames.len(), hash: START, wrong: Vec::new() };
    // One renderer for all frames: what it caches from one to the next must not show.
    let mut renderer = Renderer::new();
    for Built { name, expected, picture } in frames {
        let (difference, error) = match picture.draw_by(&mut renderer, kernel) {
            Ok(is) => {
                drawn.hash = frames::combined(drawn.hash, &is);
                if *expected == Some(is.hash) {
                    continue;
                }
                let right = picture.draw_by(&mut Renderer::new(), Kernel::PORTABLE).ok();
                (right.and_then(|right| is.difference(&right)), None)
            }
            Err(error) => (None, Some(error.to_string())),
        };
        drawn.wrong.push(Wrong { name: name.clone(), difference, error });
    }
    drawn
}

pub(crate) fn run(options: &Options) -> Result<(), Failure> {
    let prefix = options.frame.as_deref();
    let chosen = chosen(prefix);
    if let Some(name) = prefix.filter(|_| chosen.is_empty()) {
        let all = frames::all();
        let near = typo::nearest(name, all.iter().map(|frame| frame.name.as_str()));
        let near = near.map_or_else(|| "; --list shows them".into(), |near| format!("; did you mean {near}?"));
        return Err(Failure::words(format!("{name}: there is no such frame{near}")));
    }
    options.out.as_deref().map_or(Ok(()), |out| output::check_extension(out, "png", "a picture"))?;
    if options.list {
        return output::print(&chosen.iter().fold(String::new(), |list, frame| list + &frame.name + "\n"));
    }
    let check_loops = || -> Vec<Outcome> {
        match prefix {
            None => loops::all(Cases::quick(options.seed)).collect(),
            Some(_) => Vec::new(),
        }
    };
    let kernels: Vec<Kernel> = Kernel::available().collect();
    let build =
        |frame: &Frame| Built { name: frame.name.clone(), expected: frame.expected(), picture: frame.picture() };
    // A list for each thread, as frames are not shared between them; the list alone takes no time.
    let each = (0..chosen.len()).into_par_iter();
    let built: Vec<Built> = each.map_init(|| self::chosen(prefix), |frames, i| build(&frames[i])).collect();
    let draw_all = || -> Vec<ByKernel> { kernels.into_par_iter().map(|kernel| draw(kernel, &built)).collect() };
    let (loops, by_kernel) = rayon::join(check_loops, draw_all);
    let failed = loops.iter().filter(|outcome| outcome.wrong.is_some()).count()
        + by_kernel.iter().map(|drawn| drawn.wrong.len()).sum::<usize>();
    let picture = picture(options, &chosen, &by_kernel);
    // What was found is shown even if its picture cannot be written.
    let path = picture.as_ref().ok().and_then(Option::as_deref);
    match options.json {
        true => output::print(&as_json(options, &loops, &by_kernel, path)),
        false => output::say(&as_text(options, &loops, &by_kernel, path)),
    }?;
    picture?;
    verdict(failed)
}

fn verdict(failed: usize) -> Result<(), Failure> {
    match failed {
        0 => Ok(()),
        1 => Err(Failure::work("1 check failed")),
        _ => Err(Failure::work(format!("{failed} checks failed"))),
    }
}

/// Writes the picture of the first frame that is wrong, or with `-o` of the first of all. Returns its path.
fn picture(options: &Options, chosen: &[Frame], by_kernel: &[ByKernel]) -> Result<Option<PathBuf>, Failure> {
    let wrong = by_kernel.iter().find_map(|drawn| Some((drawn.kernel, drawn.wrong.first()?.name.as_str())));
    let (kernel, name) = match (wrong, &options.out) {
        (Some(wrong), _) => wrong,
        (None, Some(_)) => (Kernel::default(), chosen[0].name.as_str()),
        (None, None) => return Ok(None),
    };
    let path = options.out.clone().unwrap_or_else(|| format!("verify-{}.png", name.replace('/', "-")).into());
    if options.out.is_none() && path.symlink_metadata().is_ok() {
        // The file exists, perhaps from an earlier run; that is not worth a second failure.
        return Ok(None);
    }
    let Some(frame) = chosen.iter().find(|frame| frame.name == name) else { return Ok(None) };
    let (Ok(is), Ok(right)) = (frame.draw(kernel), frame.draw(Kernel::PORTABLE)) else { return Ok(None) };
    let panels = if is == right {
        vec![is.pixels.clone()]
    } else {
        vec![is.pixels.clone(), right.pixels.clone(), differing(&is, &right)]
    };
    let width = is.width as usize;
    let rows =
        (0..is.height as usize).flat_map(|y| panels.iter().flat_map(move |panel| &panel[y * width..(y + 1) * width]));
    let pixels: Vec<u8> = rows.copied().collect();
    let picture = Picture::of(&pixels, width * panels.len(), &is.palette);
    output::file(&path, || Png { scale: Scale::One, rgb: false }.save(&picture, &path))?;
    Ok(Some(path))
}

/// White where two drawings differ, black elsewhere, as near as the palette comes to it.
fn differing(is: &Drawn, right: &Drawn) -> Vec<u8> {
    let [black, white] = [Rgb::BLACK, Rgb::new(255, 255, 255)].map(|color| is.palette.nearest(color));
    is.pixels.iter().zip(&right.pixels).map(|(is, right)| if is == right { black } else { white }).collect()
}

/// The expected hash over the frames.
fn expected_hash(prefix: Option<&str>) -> u64 {
    chosen(prefix).iter().fold(START, |hash, frame| frames::combined_hash(hash, frame.expected().unwrap_or_default()))
}

fn as_text(options: &Options, loops: &[Outcome], by_kernel: &[ByKernel], picture: Option<&Path>) -> String {
    let mut text = format!("kernels {}; seed {}\n", kernels().join(", "), options.seed);
    let failed = |wrong: usize| if wrong == 0 { "ok".to_string() } else { format!("FAILED, {wrong} of them") };
    // Writing to a string cannot fail.
    if !loops.is_empty() {
        let wrong: Vec<&Outcome> = loops.iter().filter(|outcome| outcome.wrong.is_some()).collect();
        let cases: u64 = loops.iter().map(|outcome| outcome.cases).sum();
        let _ = writeln!(text, "loops: {} in {cases} cases, {}", loops.len(), failed(wrong.len()));
        for outcome in wrong {
            let _ = writeln!(text, "    {outcome}: {}", outcome.wrong.as_deref().unwrap_or_default());
        }
    }
    let cases: usize = by_kernel.iter().map(|drawn| drawn.count).sum();
    let wrong: usize = by_kernel.iter().map(|drawn| drawn.wrong.len()).sum();
    let count = by_kernel.first().map_or(0, |drawn| drawn.count);
    let _ = writeln!(text, "frames: {count} with each kernel, {cases} in all, {}", failed(wrong));
    for ByKernel { kernel, wrong, .. } in by_kernel {
        for one in wrong.iter().take(MOST_NAMED) {
            let _ = writeln!(text, "    {kernel}: {one}");
        }
        if wrong.len() > MOST_NAMED {
            let _ = writeln!(text, "    {kernel}: and {} more", wrong.len() - MOST_NAMED);
        }
    }
    if let Some(path) = picture {
        let _ = writeln!(text, "picture: {}", path.display());
    }
    if wrong == 0 {
        let _ = writeln!(text, "hash {:016x}, as on every machine", expected_hash(options.frame.as_deref()));
    }
    text
}

/// The maximum number of frames named in text for each kernel, since one fault shows in many.
const MOST_NAMED: usize = 8;

fn as_json(options: &Options, loops: &[Outcome], by_kernel: &[ByKernel], picture: Option<&Path>) -> String {
    let outcomes: Vec<Value> = loops
        .iter()
        .map(|Outcome { name, kernel, cases, wrong, .. }| {
            json!({ "name": name, "kernel": kernel.map(Kernel::name), "cases": cases, "wrong": wrong })
        })
        .collect();
    let hex = |hash: u64| format!("{hash:016x}");
    let wrong = |Wrong { name, difference, error }: &Wrong| {
        let pixel = difference.map(|Difference { x, y, is, should, pixels }| {
            json!({ "x": x, "y": y, "is": is, "should": should, "pixels": pixels })
        });
        json!({ "name": name, "first_pixel": pixel, "error": error })
    };
    let by_kernel: Vec<Value> = by_kernel
        .iter()
        .map(|drawn| {
            json!({
                "kernel": drawn.kernel.name(), "frames": drawn.count, "hash": hex(drawn.hash),
                "wrong": drawn.wrong.iter().map(wrong).collect::<Vec<_>>(),
            })
        })
        .collect();
    let passed = loops.iter().all(|outcome| outcome.wrong.is_none())
        && by_kernel.iter().all(|kernel| kernel["wrong"].as_array().is_some_and(Vec::is_empty));
    let all = json!({
        "schema": output::SCHEMA, "passed": passed, "seed": options.seed, "kernels": kernels(), "loops": outcomes,
        "frames": { "hash": hex(expected_hash(options.frame.as_deref())), "by_kernel": by_kernel },
        "picture": picture.map(|path| path.display().to_string()),
    });
    format!("{all:#}\n")
}

#[cfg(test)]
mod tests {
    use super::*;

    fn options() -> Options {
        let frame = Some("canvas/bands".into());
        Options { json: false, seed: 13, frame, list: false, out: None }
    }

    #[test]
    fn a_check_that_failed_is_a_finding() {
        assert_eq!(verdict(0), Ok(()));
        let failure = verdict(2).expect_err("two failed");
        assert_eq!((failure.status(), failure.to_string().as_str()), (1, "2 checks failed"));
    }

    /// A wrong byte is reported with its kernel, frame and pixel, in text and as JSON.
    #[test]
    fn a_wrong_frame_is_named_with_its_pixel() {
        let frames = chosen(Some("canvas/bands/plain"));
        let right = frames[0].draw(Kernel::PORTABLE).expect("it is legal");
        let mut is = right.clone();
        is.pixels[2 * 320 + 5] ^= 1;
        let wrong = vec![Wrong { name: frames[0].name.clone(), difference: is.difference(&right), error: None }];
        let by_kernel = [ByKernel { kernel: Kernel::PORTABLE, count: 1, hash: 0, wrong }];
        let byte = right.pixels[2 * 320 + 5];
        let expected =
            format!("    portable: canvas/bands/plain: pixel (5, 2) is {:#04x}, not {byte:#04x}; 1 differ\n", byte ^ 1);
        let text = as_text(&options(), &[], &by_kernel, None);
        assert!(text.contains("FAILED, 1 of them\n") && text.contains(&expected) && !text.contains("hash"), "{text}");
        let json: Value = serde_json::from_str(&as_json(&options(), &[], &by_kernel, None)).expect("JSON");
        assert_eq!(json["passed"], false);
        assert_eq!(json["frames"]["by_kernel"][0]["wrong"][0]["first_pixel"]["x"], 5);
        let panel = differing(&is, &right);
        assert_eq!(panel.iter().filter(|byte| **byte != panel[0]).count(), 1);
    }

    #[test]
    fn names_are_chosen_by_their_parts() {
        let of_bands = frames::all().iter().filter(|frame| frame.name.starts_with("canvas/bands/")).count();
        assert!(of_bands > 8);
        assert_eq!(chosen(Some("canvas/bands")).len(), of_bands);
        assert_eq!(chosen(Some("canvas/bands/")).len(), of_bands);
        assert_eq!((chosen(Some("canvas/ban")).len(), chosen(Some("object/tiny")).len()), (0, 1));
        assert_eq!(chosen(None).len(), frames::all().len());
    }
}

//! `mode13h cost` from its user's point of view, and the study that it makes.

use std::collections::BTreeSet;
use std::fs;
use std::process::{Command, Stdio};
use std::thread::sleep;
use std::time::Duration;

#[cfg(unix)]
use crate::folder::signalled;
use crate::folder::{Folder, failed, names_in};
use crate::support::tried::is_here;
use mode13h::light::Material;
use mode13h::mesh::shapes;
use mode13h::render::Renderer;
use mode13h::scene::{Object, Scene};
use mode13h::settings::Shading;
use mode13h_lab::cost::{BUDGETS, Settings, Subject, measure};
use serde_json::Value;

#[track_caller]
fn number(value: &Value) -> f64 {
    value.as_f64().unwrap_or_else(|| panic!("{value} is no number"))
}

#[track_caller]
fn assert_errors(errors: &Value) {
    let [max, mean, rms, share] = ["max", "mean", "rms", "off_by_one"].map(|key| number(&errors[key]));
    assert!(0.0 <= mean && mean <= rms && rms <= max && max <= 255.0 && (0.0..=1.0).contains(&share), "{errors}");
}

/// Checks that the median lies between the quartiles, and a ratio within its interval.
#[track_caller]
fn assert_time(row: &Value) {
    let [low, time, high] = ["lower_quartile", "median", "upper_quartile"].map(|of| number(&row["ns_per_frame"][of]));
    assert!(0.0 < low && low <= time && time <= high, "{row}");
    // A shading has its ratio and its interval in two fields, other rows have both in one list.
    let (ratio, interval) = match row.get("ratio_interval") {
        Some(interval) => (&row["ratio"], interval),
        None => (&row["ratio"][0], &row["ratio"][1]),
    };
    if let Some(ratio) = ratio.as_f64() {
        let [low, high] = [0, 1].map(|i| number(&interval[i]));
        assert!(0.0 < low && low <= ratio && ratio <= high, "{row}");
    }
}

#[test]
fn everything_is_measured_and_written() {
    let folder = Folder::new();
    let words = "cost torus --frames 3 --seconds 0 --json -o out";
    let output = folder.run(words);
    let json: Value = serde_json::from_slice(&output.stdout).unwrap_or_else(|_| panic!("{output:?}"));
    // Times depend on the machine; the exit status reflects only the warnings about accuracy.
    let warnings: Vec<&str> = json["warnings"].as_array().expect("a list").iter().filter_map(Value::as_str).collect();
    assert!(
        !warnings.iter().any(|warning| warning.contains(" keeps ") || warning.contains("its bound")),
        "{warnings:?}"
    );
    assert_eq!(output.status.code(), Some(0), "{output:?}");
    assert_eq!((&json["schema"], &json["input"], &json["frames"]), (&1.into(), &"torus".into(), &3.into()));
    for named in [&json["kernel"], &json["host"]["processor"], &json["host"]["flags"], &json["host"]["clock"]] {
        assert!(named.as_str().is_some_and(|name| !name.is_empty()), "{json}");
    }
    assert!(json["host"]["compiler"].as_str().is_some_and(|compiler| compiler.contains("rustc ")), "{json}");
    assert!(number(&json["host"]["clock_step_ns"]) > 0.0);

    let shadings = json["shadings"].as_array().expect("a list");
    assert!(shadings.iter().map(|row| row["shading"].as_str()).eq(Shading::ALL.map(|shading| Some(shading.name()))));
    for row in shadings {
        assert_time(row);
        assert_errors(&row["error_gouraud"]);
        assert_errors(&row["error_lit"]);
        // A ramp of 256.
        assert_eq!(number(&row["error_palette"]), 0.0);
        let exact = row["shading"] != "gouraud-vintage";
        assert!(!exact || number(&row["not_compared"]) < 0.005, "{row}");
        assert!(number(&row["swim"]) > 0.0 && row["cover_errors"].is_u64() && row["instructions_per_frame"].is_null());
        let parts = ["plan", "vertices", "setup", "spans", "scan_out"].map(|part| number(&row["split_ns"][part]));
        assert!(parts.iter().all(|part| *part >= 0.0), "{row}");
        assert!(number(&row["ns_per_pixel"]) < number(&row["ns_per_triangle"]), "some 20 pixels each: {row}");
        let itself = row["shading"] == "gouraud-8.8";
        assert_eq!(itself, row["ratio"] == 1.0 && row["ratio_interval"][0] == 1.0 && row["ratio_interval"][1] == 1.0);
    }
    let of = |shading: Shading| &shadings[Shading::ALL.iter().position(|of| *of == shading).expect("listed")];
    // Some shadings promise a bound, some do not.
    assert!(number(&of(Shading::Gouraud88Reseeded)["error_gouraud"]["max"]) < 1.0);
    assert!(number(&of(Shading::Phong)["error_lit"]["rms"]) < number(&of(Shading::Flat)["error_lit"]["rms"]));
    // Where cover is exact, a pixel shows a face other than the true one only if two depths differ by no more than
    // rounding: in the same pixels, whatever the shading.
    let cover_errors = |shading| of(shading)["cover_errors"].as_u64().expect("a count");
    for shading in [
        Shading::Gouraud88Reseeded,
        Shading::Gouraud1616,
        Shading::GouraudHyperbolic,
        Shading::Phong,
        Shading::GouraudFloat,
    ] {
        assert_eq!(cover_errors(shading), cover_errors(Shading::Gouraud88), "{shading}");
    }
    assert!(cover_errors(Shading::GouraudVintage) > 1_000 * cover_errors(Shading::Gouraud88).max(1));
    // No shading is nearer to `lit`.
    assert_eq!(of(Shading::Phong)["efficient"], true);

    let budgets = json["budget"].as_array().expect("a list");
    assert!(budgets.iter().map(|row| number(&row["max_error"])).eq(BUDGETS));
    for row in budgets {
        assert_time(row);
        assert!((0.0..=1.0).contains(&number(&row["within"])) && number(&row["largest"]) > 0.0, "{row}");
        assert!(number(&row["swim"]) > 0.0 && number(&row["not_compared"]) < 0.005, "{row}");
        let triangles = row["triangles"].as_object().expect("numbers by shading");
        assert!(!triangles.is_empty() && triangles.values().all(|count| count.as_u64() > Some(0)), "{row}");
        // Phong is within a shade of its own model.
        assert!(row["best_single_shading"].is_string() && number(&row["best_single_ns"]["median"]) > 0.0, "{row}");
    }

    let times = json["times"].as_array().expect("a list");
    assert_eq!(times.len(), 5);
    for (i, row) in times.iter().enumerate() {
        assert!(number(&row["frames"]) >= 200.0 && (0.0..=1.0).contains(&number(&row["within"])), "{row}");
        let [mean, max] = ["mean_error", "max_error"].map(|key| number(&row[key]));
        assert!((0.5..=16.0).contains(&mean) && mean <= max && BUDGETS.contains(&max), "{row}");
        // Every frame stays within the error that was chosen for it, or within what rounding needs.
        assert!(number(&row["largest"]) > 0.0 && number(&row["largest"]) <= max.max(0.52), "{row}");
        assert!(i == 0 || number(&times[i - 1]["max_time_ns"]) < number(&row["max_time_ns"]), "{row}");
    }
    // Shadings that are linear on the screen have a bound, and keep it.
    for row in shadings {
        let is_linear = ["gouraud-8.8", "gouraud-8.8-reseeded", "gouraud-16.16"]
            .contains(&row["shading"].as_str().expect("a name"));
        assert_eq!(row["beyond_bound"].as_f64().is_some_and(|beyond| beyond <= 0.0), is_linear, "{row}");
    }

    let options = json["options"].as_array().expect("a list");
    options.iter().for_each(assert_time);
    options.iter().for_each(|row| assert_errors(&row["error_gouraud_unrounded"]));
    let aspects: BTreeSet<&str> = options.iter().filter_map(|row| row["aspect"].as_str()).collect();
    assert!(aspects.iter().eq(
        ["arithmetic", "dither", "hidden surfaces", "kernel", "shading, portable kernel", "vertex rounding"].iter()
    ));
    let option = |name: &str| options.iter().find(|row| row["name"] == name).expect("a choice");
    let rms = |name: &str, of: &str| number(&option(name)["error_gouraud_unrounded"][of]);
    assert!(rms("whole pixels", "rms") > rms("1/256 pixel", "rms"));
    // Dither pays off in the means of blocks.
    assert!(rms("ordered", "rms_of_blocks") < rms("none", "rms_of_blocks"));
    assert!(option("back-faces")["cover_errors"].as_u64() > option("scan-line")["cover_errors"].as_u64());

    let claims = json["claims"].as_array().expect("a list");
    assert_eq!(claims.len(), 6);
    for claim in claims {
        assert!(["holds", "holds in part", "does not hold"].iter().any(|verdict| claim["verdict"] == *verdict));
        assert!(claim["measured"].as_str().is_some_and(|text| text.contains(|c: char| c.is_ascii_digit())), "{claim}");
    }

    let written = |name: &str| fs::read_to_string(folder.path("out").join(name)).expect("a file");
    assert_eq!(written("cost.json").as_bytes(), output.stdout);
    assert_eq!(names_in(&folder.path("out")), ["chart.svg", "cost.json", "report.html", "samples.csv"]);
    let samples = written("samples.csv");
    let mut lines = samples.lines();
    assert_eq!(lines.next(), Some("round,order,kind,name,frames,ns"));
    let rounds = json["rounds"].as_u64().expect("a number");
    let times = |kind: &str, name: &str| {
        samples.lines().filter(|line| line.contains(&format!(",{kind},{name},3,"))).count() as u64
    };
    assert!(rounds >= 7 && times("shading", "gouraud-8.8") == rounds && times("budget", "4") == rounds, "{rounds}");
    // A slow shading sits out some rounds, but not all.
    assert!((rounds / 4..=rounds).contains(&times("shading", "gouraud-tessellated")));
    assert!(
        lines.all(|line| line.rsplit(',').next().is_some_and(|time| time.parse::<u64>().is_ok_and(|time| time > 0)))
    );
}

#[test]
fn rungs_that_are_asked_for_are_the_rungs_there_are() {
    let folder = Folder::new();
    let json = folder.json("cost cube --frames 1 --seconds 0 --json --shadings phong,flat");
    let shadings: Vec<&Value> =
        json["shadings"].as_array().expect("a list").iter().map(|row| &row["shading"]).collect();
    assert_eq!(shadings, ["flat", "phong"]);
    assert!(number(&json["shadings"][1]["ratio"]) > 1.0, "to gouraud-8.8, which was drawn all the same");
    assert!(folder.names().is_empty(), "without -o nothing is written");
}

/// With ambient light alone there is one shade, which every shading must give.
#[test]
fn where_the_picture_is_the_truth_nothing_is_off() {
    let mut scene = Scene::new();
    let mut wall = Object::new(shapes::wall(3, 2));
    // A fifth of full intensity is the shade 51; 0.2 in f32 is off by 3·10⁻⁹.
    wall.materials = vec![Material { ambient: 0.2, ..Material::default() }];
    scene.add(wall);
    scene.ambient = 1.0;
    let (frames, steps) = ([scene.clone()], [scene.clone(), scene]);
    let subject = Subject { name: "wall", frames: &frames, steps: &steps, renderer: &Renderer::new };
    let mut settings = Settings::default();
    (settings.choices, settings.claims, settings.seconds) = (false, false, 0.0);
    let (study, samples) = measure(&subject, &settings, &|_, _| {}).expect("a legal scene");
    assert_eq!((study.shadings.len(), study.budget.len()), (Shading::ALL.len(), BUDGETS.len()));
    for row in &study.shadings {
        assert!(row.error_gouraud.max < 1e-6 && row.error_lit.max < 1e-6 && row.swim < 1e-6, "{}", row.shading);
        assert_eq!(row.error_palette, 0.0);
        assert!(!row.shading.has_exact_cover() || row.cover_errors == 0, "{}", row.shading);
        assert!(row.picture.contains(&51) && row.picture.iter().all(|byte| [0, 51].contains(byte)));
        assert_eq!((row.picture.len(), row.error_map.len()), (64_000, 64_000));
    }
    let exact = study.shadings.iter().filter(|row| row.shading.has_exact_cover());
    let cheapest = exact.min_by(|a, b| a.per_frame.median.total_cmp(&b.per_frame.median)).expect("there are some");
    for row in &study.budget {
        assert!(row.within == 1.0 && row.patch == 0 && row.largest < 1e-6, "{row:?}");
        assert_eq!(row.best_single_shading, Some(cheapest.shading), "all keep it");
    }
    let (samples, all) = (samples.to_csv().lines().count() - 1, study.rounds * (Shading::ALL.len() + BUDGETS.len()));
    assert!((all / 4..=all).contains(&samples), "{samples} of {all}");
}

/// The text begins with the summary and has the page's contents; 16.16 vertices have no budgets, so no table of them.
#[test]
fn the_text_begins_with_what_a_newcomer_wants_to_know() {
    let folder = Folder::new();
    for (words, has_budgets) in [("", true), ("--arithmetic fixed", false)] {
        let output = folder.run(&format!("cost cube --frames 1 --seconds 0 -o out {words}"));
        let text = String::from_utf8(output.stdout).expect("text");
        let page = fs::read_to_string(folder.path("out/report.html")).expect("written");
        let first = text.lines().next().expect("a line");
        assert!(first.starts_with("On cube the old loop, done right, is within "), "{text}");
        assert!(page.contains(first) && text.ends_with("written to out\n"), "{text}");
        for part in ["gouraud-8.8-reseeded (default)", "not compared"] {
            assert!(text.contains(part) && page.contains(part), "{part}");
        }
        assert_eq!(text.contains("best single shading"), has_budgets, "{text}");
        assert_eq!(page.contains("<h2>The budget</h2>"), has_budgets);
        // Nor have they light at every pixel, which the default shading would replace.
        assert_eq!(text.contains("\n  phong "), has_budgets, "{text}");
    }
    let words = "cost cube --frames 1 --seconds 0 --arithmetic fixed --shadings flat,phong";
    folder.fails(words, 2, "--shadings phong: not with --arithmetic fixed, which lacks it");
}

/// A study that cannot be written when it is finished, although it could when it began, is saved elsewhere.
#[cfg(target_os = "linux")]
#[test]
fn a_study_is_not_lost_when_it_cannot_be_written() {
    let (folder, elsewhere) = (Folder::new(), Folder::new());
    fs::create_dir(folder.path("out")).expect("made");
    let mut command = folder.program("cost cube --frames 2 --seconds 0 -o out");
    let child = command.env("TMPDIR", elsewhere.as_ref()).stdout(Stdio::piped()).stderr(Stdio::piped()).spawn();
    sleep(Duration::from_millis(300));
    // A file takes the directory's place.
    fs::remove_dir(folder.path("out")).expect("removed");
    folder.put("out", "in the way");
    let output = child.expect("started").wait_with_output().expect("it ends");
    let lines = String::from_utf8(output.stderr).expect("text");
    assert_eq!(output.status.code(), Some(1), "{lines}");
    let [kept] = &elsewhere.names()[..] else { panic!("{:?}", elsewhere.names()) };
    assert!(kept.starts_with("mode13h-cost-cube-"), "{kept}");
    let kept = elsewhere.path(kept);
    assert!(
        lines.lines().last().is_some_and(
            |line| line.contains("out: ") && line.ends_with(&format!("the study is in {}", kept.display()))
        ),
        "{lines}"
    );
    assert!(fs::read_to_string(kept.join("cost.json")).expect("read").contains("\"schema\": 1"));
    let table = String::from_utf8(output.stdout).expect("text");
    assert!(
        table.contains("gouraud-8.8-reseeded") && table.contains(&format!("written to {}", kept.display())),
        "{table}"
    );
}

#[test]
fn what_is_wrong_is_said_in_one_line() {
    let folder = Folder::new();
    for (words, status, says) in [
        ("torus --shadings flat,best", 2, "[possible values: flat, "),
        ("torus --shading flat", 2, "did you mean --shadings?"),
        ("torus --max-error 2", 2, "unexpected argument '--max-error'"),
        ("torus --frames 0", 2, "--frames"),
        ("nothing.toml", 1, "nothing.toml"),
        ("torus -o /dev/null", 1, "/dev/null: is not a directory"),
        // Rejected before anything is measured.
        #[cfg(target_os = "linux")]
        ("torus -o /proc/a/b", 1, "/proc/a: no file can be created in the directory /proc"),
        ("torus --seconds -1", 2, "--seconds"),
    ] {
        folder.fails(&format!("cost {words}"), status, says);
    }
    let without = folder.program("cost torus --instructions").env("PATH", "").output().expect("started");
    failed(&without, 1, "needs valgrind, which was not found");
    assert!(folder.names().is_empty());
}

#[cfg(unix)]
#[test]
fn an_interrupted_study_leaves_nothing_behind() {
    let folder = Folder::new();
    let mut command = folder.program("cost torus --seconds 600");
    let child = command.stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().expect("started");
    sleep(Duration::from_secs(2));
    let output = signalled(child, "-INT");
    let lines = String::from_utf8(output.stderr).expect("text");
    assert_eq!(output.status.code(), Some(130), "{lines}");
    assert!(lines.lines().next().is_some_and(|line| line.ends_with("then timing for at most 600 s")), "{lines}");
    assert_eq!(lines.lines().last(), Some("mode13h: interrupted"));
    assert!(output.stdout.is_empty() && folder.names().is_empty());
}

/// With valgrind installed: each shading's instructions, and times taken with the kernel for which they were counted.
#[test]
fn instructions_are_counted_where_valgrind_is() {
    if !is_here("valgrind", Command::new("valgrind").arg("--version").output().is_ok()) {
        return;
    }
    let folder = Folder::new();
    let words = "cost cube --frames 2 --seconds 0 --json --instructions --shadings gouraud-8.8,phong";
    let json = folder.json(words);
    let of = |shading: usize| json["shadings"][shading]["instructions_per_frame"].as_u64().expect("a count");
    // 64,000 bytes are cleared, by 64 at a time at most; Phong has a square root and more at each of its pixels.
    assert!(of(0) > 1000 && of(1) > 4 * of(0), "{json}");
    let kernel = json["kernel"].as_str().expect("a name");
    assert!(!kernel.contains("avx512") && kernel != "simd", "{kernel}");
    let again = folder.json(words);
    let off = again["shadings"][1]["instructions_per_frame"].as_u64().expect("a count").abs_diff(of(1));
    assert!(off * 1000 <= of(1), "without noise: {off} of {}", of(1));
}

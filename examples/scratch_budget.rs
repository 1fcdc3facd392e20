use mode13h::cost::Probe;
use mode13h::plan::Effect;
use mode13h::render::{Renderer, Rung, Screen};
use mode13h::scene::shipped;
use mode13h::truth::{ErrorMap, Figures, Standard, Truth};
use mode13h::vga::Vga;
use std::time::Instant;

fn main() {
    let names: Vec<String> = std::env::args().skip(1).collect();
    let budgets = [16.0f32, 8.0, 4.0, 2.0, 1.0];
    for shipped in shipped::ALL.iter() {
        let name = shipped.name;
        if !names.is_empty() && !names.iter().any(|n| n == name) {
            continue;
        }
        let mut scene = mode13h::scene::shipped::by_name(name).unwrap().load().unwrap().scene;
        let frames: Vec<_> = (0..6)
            .map(|i| {
                scene.set_time(scene.duration * f64::from(i) / 6.0);
                scene.clone()
            })
            .collect();
        let truths: Vec<_> =
            frames.iter().map(|s| Truth::new(s, Screen::MODE_13H).unwrap().draw(Standard::Lit)).collect();
        println!("{name}: {} faces", frames[0].objects().iter().map(|o| o.mesh().triangles().len()).sum::<usize>());
        let mut techs: Vec<(String, Option<Rung>, Option<f32>)> =
            Rung::ALL.into_iter().map(|r| (r.to_string(), Some(r), None)).collect();
        for e in budgets {
            techs.push((format!("budget {e}"), None, Some(e)));
        }
        let make = |t: &(String, Option<Rung>, Option<f32>)| {
            let mut r = Renderer::new();
            r.force(Effect::Transform, Some(true));
            if let Some(rung) = t.1 {
                r.set_rung(rung);
            }
            if t.2.is_some() {
                r.set_max_error(t.2);
            }
            r
        };
        let mut renderers: Vec<_> = techs.iter().map(make).collect();
        let mut vga = Vga::new();
        let mut times = vec![Vec::new(); techs.len()];
        for round in 0..6 {
            for k in 0..techs.len() {
                let i = (k * 7 + round) % techs.len();
                let t = Instant::now();
                for s in &frames {
                    renderers[i].draw(s, &mut vga).unwrap();
                }
                times[i].push(t.elapsed().as_nanos() as f64 / frames.len() as f64);
            }
        }
        for (i, tech) in techs.iter().enumerate() {
            times[i].sort_by(f64::total_cmp);
            let mut probe = Probe::new(make(tech));
            let mut all = Figures::default();
            let mut within = [0.0; 5];
            let mut n = 0.0;
            for (s, t) in frames.iter().zip(&truths) {
                let map = ErrorMap::new(t, &probe.look(s, Screen::MODE_13H).unwrap()).unwrap();
                let f = map.figures();
                all.add(&f);
                for (w, e) in within.iter_mut().zip(budgets) {
                    *w += map.share_within(f64::from(e)) * f.count as f64;
                }
                n += f.count as f64;
            }
            let stats = renderers[i].draw(&frames[3], &mut vga).unwrap();
            let shares: Vec<String> =
                if tech.2.is_some() { stats.shares.iter().map(|(r, n)| format!("{r} {n}")).collect() } else { vec![] };
            println!(
                "  {:24} {:8.1} us (q1 {:8.1})  max {:6.1} rms {:5.2}  within {}  {}",
                tech.0,
                times[i][times[i].len() / 2] / 1000.0,
                times[i][times[i].len() / 10] / 1000.0,
                all.max,
                all.rms(),
                within.map(|w| format!("{:7.3}", 100.0 * w / n)).join(" "),
                shares.join(", ")
            );
        }
    }
}

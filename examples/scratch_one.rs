//! x
use mode13h::plan::Effect;
use mode13h::render::{Renderer, Rung};
use mode13h::vga::Vga;
fn main() {
    let a: Vec<String> = std::env::args().collect();
    let mut scene = mode13h::scene::shipped::by_name(&a[1]).unwrap().load().unwrap().scene;
    let mut r = Renderer::new();
    r.force(Effect::Transform, Some(true));
    if let Ok(e) = a[2].parse::<f32>() {
        r.set_max_error(Some(e));
    } else {
        r.set_rung(a[2].parse::<Rung>().unwrap());
    }
    let n: u32 = a[3].parse().unwrap();
    let mut vga = Vga::new();
    for i in 0..n {
        scene.set_time(scene.duration * f64::from(i) / f64::from(n));
        println!("{}", r.draw(&scene, &mut vga).unwrap().drawn);
    }
}

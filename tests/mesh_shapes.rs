//! The shapes.
#![cfg(feature = "alloc")]
use mode13h::mesh::{Mesh, shapes};
#[test]
fn look() {
    for name in shapes::NAMES {
        let m = shapes::by_name(name).unwrap();
        println!(
            "{name} v{} t{} {:?} closed {} convex {} vol {}",
            m.positions().len(),
            m.triangles().len(),
            m.bounds(),
            m.is_closed(),
            m.is_convex(),
            m.volume()
        );
        let r = m.positions().iter().map(|p| p.length()).fold(0.0, f32::max);
        println!("{r}");
    }
    let m: Mesh = shapes::teapot(200);
    println!("{:?}", m.bounds());
    let r = m.positions().iter().map(|p| p.length()).fold(0.0, f32::max);
    println!("{r}");
}

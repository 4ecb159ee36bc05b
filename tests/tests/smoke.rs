//! A first look: a quad covers what it should.
use multum::embedded_graphics::pixelcolor::Gray8;
use multum::embedded_graphics::prelude::*;
use multum::{
    depth::NoDepth, draw::Pipeline, fixed::types::*, perspective::*, project::ScreenVertex,
    sample::*, setup::Cull, sink::Band, texture::*,
};
#[test]
fn wall() {
    let texels: Vec<Gray8> = (0..256 * 256)
        .map(|i| Gray8::new((i % 256) as u8))
        .collect();
    let t = Texture::new(&texels, 256, 256).unwrap();
    let v = |x: i32, y: i32, w: f64, u: f64, v: f64| {
        ScreenVertex::new(
            I24F8::from_num(x),
            I24F8::from_num(y),
            I16F16::from_num(w),
            [I16F16::from_num(u), I16F16::from_num(v)],
        )
        .unwrap()
    };
    let q = [
        v(0, 0, 1., 0., 0.),
        v(0, 240, 1., 0., 0.9375),
        v(320, 240, 4., 4., 3.),
        v(320, 0, 4., 4., 0.),
    ];
    let mut px = vec![Gray8::new(7); 320 * 240];
    let mut b = Band::new(&mut px, 320, 240, 320, 0).unwrap();
    let mut p = Pipeline {
        strategy: PerPixel,
        sampler: Nearest::<_, Repeat>::new(t),
        depth: NoDepth,
        cull: Cull::Off,
    };
    p.draw_triangle(&mut b, &[q[0], q[1], q[2]]);
    p.draw_triangle(&mut b, &[q[0], q[2], q[3]]);
    let row: Vec<_> = (0..320)
        .step_by(20)
        .map(|x| {
            let s = (x as f64 + 0.5) / 320.;
            let q = 1. - s + s / 4.;
            let u = s * 4. / 4. / q;
            (px[120 * 320 + x].luma(), ((u * 256.).floor() as i64 % 256))
        })
        .collect();
    println!("{row:?}");
    assert!(row.iter().all(|r| i64::from(r.0) == r.1));
}

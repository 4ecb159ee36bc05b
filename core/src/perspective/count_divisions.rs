//! What strategies say of their divisions against those they make.

use fixed::types::{I16F16, I24F8};

use super::{
    Adaptive, Affine, AffineWithin, ConstantZ, Every, Extrapolated, PerPixel, Quadratic, Run,
    Strategy, Subdivided,
};
use crate::arith::count;
use crate::project::ScreenVertex;
use crate::setup::{Cull, TriangleSetup};
use crate::span::{Area, for_each_span};

/// A triangle across the screen with these depths, or a part of it.
fn triangle(w: [f32; 3], part: f32) -> [ScreenVertex; 3] {
    let corners = [[2.0, 1.0], [300.0, 40.0], [90.0, 230.0]];
    let uv = [[0.0, 0.0], [3.0, 0.5], [0.5, 2.0]];
    core::array::from_fn(|i| {
        let [x, y] = corners[i].map(|c: f32| I24F8::from_num(c * part));
        ScreenVertex::new(
            x,
            y,
            I16F16::from_num(w[i]),
            uv[i].map(|c: f32| I16F16::from_num(c * part)),
        )
        .expect("a vertex in range")
    })
}

fn check<S: Strategy>(name: &str, strategy: &S) {
    let area = Area {
        width: 320,
        top: 0,
        bottom: 240,
    };
    for part in [1.0, 1.0 / 20.0] {
        for w in [
            [1.0, 1.0, 1.0],
            [1.0, 1.02, 1.01],
            [1.0, 1.5, 2.0],
            [1.0, 20.0, 3.0],
            [900.0, 1.0, 1.0],
        ] {
            let vertices = triangle(w, part);
            let setup = TriangleSetup::new(&vertices, Cull::Off).expect("a triangle with an area");
            let planes = strategy.planes(&setup).expect("few repeats");
            let mut spans = 0;
            for_each_span(&setup, area, |span| {
                let said = strategy.divisions(&planes, span);
                _ = count::take();
                strategy.runs(&planes, span, |_: Run| {});
                let made = count::take();
                assert_eq!(said, made, "{name}, depths {w:?}, {span:?}, {part}");
                spans += 1;
            });
            assert!(spans > if part < 1.0 { 8 } else { 200 }, "{name}: {spans}");
        }
    }
}

#[test]
fn strategies_make_as_many_divisions_as_they_say() {
    const SIZE: (u32, u32) = (8, 8);
    check("affine", &Affine);
    let bound = AffineWithin::DEFAULT_BOUND;
    check("affine-within", &AffineWithin::new(Every::<16>, bound));
    check("every:4", &Every::<4>);
    check("every:16", &Every::<16>);
    check("every:64", &Every::<64>);
    check("exact", &PerPixel);
    check("adaptive", &Adaptive::new(Adaptive::DEFAULT_BOUND, SIZE));
    check("constant-z", &ConstantZ);
    check("extrapolated", &Extrapolated);
    check("quadratic:16", &Quadratic::<16>);
    check(
        "subdivided",
        &Subdivided::new(Subdivided::DEFAULT_BOUND, SIZE),
    );
}

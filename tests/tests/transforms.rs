//! Maps that are joined, and a camera's: every element is the nearest that its format has, found again with
//! 128 bits, or the map is refused.

use multum::camera::{Camera, Perspective};
use multum::clip::ClipVertex;
use multum::error::Error;
use multum::fixed::types::{I8F24, I16F16};
use multum::geometry::Vertex;
use multum::transform::Transform;
use rand::Rng as _;
use tests::random::{Rng, seeded};

/// Elements of all lengths.
fn any_bits(random: &mut Rng) -> i32 {
    random.random::<i32>() >> random.random_range(0..32)
}

/// Mostly small enough that products fit.
fn any_map(random: &mut Rng) -> Transform {
    let small = random.random_range(0..6);
    let mut element = || any_bits(random) >> small;
    Transform {
        rows: [[0; 3]; 3].map(|row| row.map(|_| I8F24::from_bits(element()))),
        translation: [0; 3].map(|_| I16F16::from_bits(element())),
    }
}

/// `n / 2^bits` to the nearest integer, halves up; `None` beyond 32 bits.
fn nearest(n: i128, bits: u32) -> Option<i32> {
    i32::try_from((n + (1 << (bits - 1))).div_euclid(1 << bits)).ok()
}

fn bits(map: &Transform) -> [[i128; 4]; 3] {
    [0, 1, 2].map(|i| {
        let [a, b, c] = map.rows[i].map(|e| i128::from(e.to_bits()));
        [a, b, c, i128::from(map.translation[i].to_bits())]
    })
}

/// The map that applies `inner` first, element by element.
fn joined(outer: &Transform, inner: &Transform) -> Option<[[i32; 4]; 3]> {
    let (outer, inner) = (bits(outer), bits(inner));
    let mut all = [[0; 4]; 3];
    for (to, row) in all.iter_mut().zip(outer) {
        for (column, to) in to.iter_mut().enumerate() {
            let sum = (0..3).map(|k| row[k] * inner[k][column]).sum();
            let moved = if column == 3 { row[3] as i32 } else { 0 };
            *to = nearest(sum, 24)?.checked_add(moved)?;
        }
    }
    Some(all)
}

/// A sum of products that leaves 64 bits is refused, even if it comes back.
fn leaves_64_bits(outer: &Transform, inner: &Transform) -> bool {
    let (outer, inner) = (bits(outer), bits(inner));
    let most = |row: [i128; 4], column: usize| {
        (0..3)
            .map(|k| (row[k] * inner[k][column]).abs())
            .sum::<i128>()
    };
    outer
        .iter()
        .any(|row| (0..4).any(|column| most(*row, column) >= (1 << 63) - (1 << 23)))
}

#[test]
fn joined_maps_are_rounded_to_nearest() {
    let mut random = seeded(920);
    let (mut fit, mut refused) = (0, 0);
    for _ in 0..200_000 {
        let (outer, inner) = (any_map(&mut random), any_map(&mut random));
        if leaves_64_bits(&outer, &inner) {
            continue;
        }
        match (joined(&outer, &inner), outer.after(&inner)) {
            (Some(expected), Ok(found)) => {
                let expected = expected.map(|row| row.map(i128::from));
                assert_eq!(bits(&found), expected, "{outer:?} {inner:?}");
                fit += 1;
            }
            (None, Err(Error::Overflow)) => refused += 1,
            (expected, found) => panic!("{outer:?} {inner:?}: {found:?} and not {expected:?}"),
        }
    }
    assert!(fit > 10_000 && refused > 10_000, "{fit} {refused}");
}

#[test]
fn a_cameras_matrix_is_rounded_to_nearest() {
    // So far out that a clip coordinate has all the bits of a matrix element: 2^8 of 2^24 in 2^16.
    const FAR: i32 = 256 << 16;
    let mut random = seeded(921);
    let mut seen = 0;
    for _ in 0..100_000 {
        let mut view = any_map(&mut random);
        view.translation = view.translation.map(|t| t / 256);
        let scales = [0; 2].map(|_| I16F16::from_bits((any_bits(&mut random) & i32::MAX).max(1)));
        let [x, y] = scales;
        let near = I16F16::ONE;
        let lens = Perspective::from_scales(x, y, near).expect("a lens");
        let factors = [x, y, I16F16::NEG_ONE].map(|f| i128::from(f.to_bits()));
        let expected: Option<Vec<[i32; 4]>> = bits(&view)
            .into_iter()
            .zip(factors)
            .map(|(row, factor)| {
                let [a, b, c, t] = row.map(|e| nearest(e * factor, 16));
                Some([a?, b?, c?, t?])
            })
            .collect();
        let found = Camera { view, lens }.to_clip(&Transform::IDENTITY);
        let (Some(expected), Ok(to_clip)) = (&expected, &found) else {
            assert_eq!(
                (expected.is_none(), found.err()),
                (true, Some(Error::Overflow)),
                "{view:?} {lens:?}"
            );
            continue;
        };
        for (axis, position) in [[FAR, 0, 0], [0, FAR, 0], [0, 0, FAR], [0; 3]]
            .into_iter()
            .enumerate()
        {
            let vertex = Vertex::from_bits(position, [0; 2]);
            let element = |row: &[i32; 4]| {
                let translation = i64::from(row[3]);
                let product = if axis < 3 { i64::from(row[axis]) } else { 0 };
                i32::try_from(product + translation).ok()
            };
            let of_clip = |v: ClipVertex| [v.x, v.y, v.w].map(|c| Some(c.to_bits()));
            let all = [0, 1, 2].map(|i| element(&expected[i]));
            match ClipVertex::new(&vertex, to_clip) {
                Ok(found) => {
                    assert_eq!(of_clip(found), all, "{view:?} {lens:?}");
                    seen += 1;
                }
                Err(error) => {
                    assert_eq!(error, Error::Overflow);
                    assert!(all.contains(&None), "{view:?} {lens:?}");
                }
            }
        }
    }
    assert!(seen > 50_000, "{seen}");
}

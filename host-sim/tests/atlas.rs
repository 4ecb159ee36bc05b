//! Several pictures in one, checked texel by texel and against their own mip levels.

use host_sim::atlas::{self, Rectangle};
use host_sim::picture::Picture;
use host_sim::reference::Beyond;

/// No two texels alike, as far as that goes.
fn picture(width: u32, height: u32, number: usize) -> Picture {
    let pixels = (0..width * height)
        .map(|i| [i as u8, (i >> 8) as u8 ^ (i * 37) as u8, number as u8 + 1])
        .collect();
    Picture::new(width, height, pixels).expect("powers of two")
}

fn pictures(sizes: &[(u32, u32)]) -> Vec<Picture> {
    let numbered = sizes.iter().enumerate();
    numbered.map(|(i, &(w, h))| picture(w, h, i)).collect()
}

fn mixtures() -> Vec<Vec<(u32, u32)>> {
    let every = (0..6).flat_map(|i| (0..6).map(move |j| (1 << i, 1 << j)));
    vec![
        vec![(1, 1)],
        vec![(4, 2)],
        vec![(8, 8), (8, 8), (8, 8), (8, 8)],
        vec![
            (1, 1),
            (64, 64),
            (2, 2),
            (16, 16),
            (32, 32),
            (16, 16),
            (1, 1),
        ],
        vec![(1, 32), (32, 1), (1, 32), (32, 1), (8, 4), (4, 8)],
        every.clone().collect(),
        every.clone().chain(every).collect(),
    ]
}

/// Box averages of 2x2 texels in 64-bit floats: exact sums of powers of two.
fn halved(texels: &[[f64; 3]], width: usize) -> Vec<[f64; 3]> {
    let rows = texels.len() / width;
    let at = |x: usize, y: usize| texels[y * width + x];
    let mut half = Vec::new();
    for y in 0..rows / 2 {
        for x in 0..width / 2 {
            let four = [(0, 0), (1, 0), (0, 1), (1, 1)].map(|(i, j)| at(2 * x + i, 2 * y + j));
            half.push([0, 1, 2].map(|c| four.iter().map(|t| t[c]).sum::<f64>() / 4.0));
        }
    }
    half
}

fn floats(picture: &Picture) -> Vec<[f64; 3]> {
    picture.pixels().iter().map(|p| p.map(f64::from)).collect()
}

#[test]
fn rectangles_are_aligned_and_hold_their_pictures_alone() {
    for sizes in mixtures() {
        let pictures = pictures(&sizes);
        let atlas = atlas::pack(&pictures.iter().collect::<Vec<_>>()).expect("it fits");
        let (width, height) = (atlas.picture.width(), atlas.picture.height());
        assert_eq!(atlas.rectangles.len(), pictures.len());
        let mut owner = vec![None; (width * height) as usize];
        for (number, (picture, r)) in pictures.iter().zip(&atlas.rectangles).enumerate() {
            assert_eq!((r.width, r.height), (picture.width(), picture.height()));
            assert_eq!((r.left % r.width, r.top % r.height), (0, 0), "{r:?}");
            for (i, &pixel) in picture.pixels().iter().enumerate() {
                let (x, y) = (r.left + i as u32 % r.width, r.top + i as u32 / r.width);
                assert!(x < width && y < height, "{r:?}");
                let at = (y * width + x) as usize;
                assert_eq!(owner[at].replace(number), None, "two at {x},{y}");
                assert_eq!(atlas.picture.pixels()[at], pixel);
            }
        }
        for (owner, pixel) in owner.iter().zip(atlas.picture.pixels()) {
            assert!(owner.is_some() || *pixel == [0; 3]);
        }
        assert_eq!(atlas.picture.alpha(), None);
    }
}

#[test]
fn squares_waste_no_more_than_the_next_power_of_two() {
    let sizes = [
        (1, 1),
        (64, 64),
        (2, 2),
        (16, 16),
        (32, 32),
        (16, 16),
        (1, 1),
    ];
    let mut many = sizes.to_vec();
    many.extend([(4, 4); 100]);
    for sizes in [sizes.to_vec(), many] {
        let pictures = pictures(&sizes);
        let area: u32 = sizes.iter().map(|(w, h)| w * h).sum();
        let atlas = atlas::pack(&pictures.iter().collect::<Vec<_>>()).expect("it fits");
        assert_eq!(
            atlas.picture.width() * atlas.picture.height(),
            area.next_power_of_two()
        );
    }
}

#[test]
fn large_pictures_go_first() {
    // In the order given, the two texels would lie in one row and leave no column.
    let pictures = pictures(&[(1, 1), (1, 1), (1, 2)]);
    let atlas = atlas::pack(&pictures.iter().collect::<Vec<_>>()).expect("it fits");
    assert_eq!((atlas.picture.width(), atlas.picture.height()), (2, 2));
}

#[test]
fn mip_levels_are_those_of_each_picture() {
    for sizes in mixtures() {
        let pictures = pictures(&sizes);
        let atlas = atlas::pack(&pictures.iter().collect::<Vec<_>>()).expect("it fits");
        for (picture, r) in pictures.iter().zip(&atlas.rectangles) {
            let (mut own, mut whole) = (floats(picture), floats(&atlas.picture));
            for level in 1..=r.width.min(r.height).ilog2() {
                let size = |side: u32| (side >> level) as usize;
                own = halved(&own, size(r.width) * 2);
                whole = halved(&whole, size(atlas.picture.width()) * 2);
                for (i, texel) in own.iter().enumerate() {
                    let x = size(r.left) + i % size(r.width);
                    let y = size(r.top) + i / size(r.width);
                    let at = y * size(atlas.picture.width()) + x;
                    assert_eq!(&whole[at], texel, "level {level} of {r:?}");
                }
            }
        }
    }
}

#[test]
fn alpha_goes_along() {
    let clear = picture(2, 2, 0)
        .with_alpha(vec![0, 10, 20, 255])
        .expect("2x2");
    let atlas = atlas::pack(&[&picture(2, 2, 1), &clear, &picture(1, 1, 2)]).expect("it fits");
    let alpha = atlas.picture.alpha().expect("alpha");
    let at = |r: &Rectangle, x: u32, y: u32| {
        alpha[((r.top + y) * atlas.picture.width() + r.left + x) as usize]
    };
    let [solid, clear, one] = &atlas.rectangles[..] else {
        panic!("three rectangles");
    };
    let four = |r| [at(r, 0, 0), at(r, 1, 0), at(r, 0, 1), at(r, 1, 1)];
    assert_eq!(four(solid), [255; 4]);
    assert_eq!(four(clear), [0, 10, 20, 255]);
    assert_eq!(at(one, 0, 0), 255);
    // 9 texels are covered, 2 of them are not opaque; all else is clear.
    let clear = alpha.iter().filter(|&&a| a == 0).count();
    assert_eq!(clear, alpha.len() - 8);
}

#[test]
fn what_does_not_fit_is_refused() {
    let said = |pictures: &[&Picture]| {
        let error = atlas::pack(pictures).expect_err("too much").to_string();
        assert!(
            error.starts_with("atlas: ") && !error.contains('\n'),
            "{error}"
        );
        error
    };
    said(&[]);
    let large = picture(4096, 4096, 0);
    assert!(said(&[&large, &picture(1, 1, 1)]).contains("4096x4096"));
    let atlas = atlas::pack(&[&large]).expect("just fits");
    assert_eq!(atlas.picture, large);
}

#[test]
fn padding_continues_the_picture() {
    // What lies at a place before and after 4 texels, written out.
    let rows = [
        (Beyond::Repeat, [2, 3, 0, 1, 2, 3, 0, 1]),
        (Beyond::Clamp, [0, 0, 0, 1, 2, 3, 3, 3]),
        (Beyond::Mirror, [1, 0, 0, 1, 2, 3, 3, 2]),
    ];
    let inner = picture(4, 4, 0);
    for (wrap, places) in rows {
        for padding in [1, 2] {
            let padded = atlas::padded(&inner, padding, wrap).expect("it fits");
            let inside = Rectangle {
                left: 2,
                top: 2,
                width: 4,
                height: 4,
            };
            assert_eq!(padded.inside, inside);
            assert_eq!((padded.picture.width(), padded.picture.height()), (8, 8));
            for (i, pixel) in padded.picture.pixels().iter().enumerate() {
                let from = 4 * places[i / 8] + places[i % 8];
                assert_eq!(pixel, &inner.pixels()[from], "{wrap:?} {i}");
            }
        }
    }
}

#[test]
fn padding_has_room_on_every_side() {
    for (width, height) in [(1, 1), (1, 8), (4, 2), (16, 16)] {
        let inner = picture(width, height, 3);
        for padding in [0, 1, 3, 8, 100] {
            let padded = atlas::padded(&inner, padding, Beyond::Repeat).expect("it fits");
            let (w, h) = (padded.picture.width(), padded.picture.height());
            assert_eq!(
                (w, h),
                (
                    (width + 2 * padding).next_power_of_two(),
                    (height + 2 * padding).next_power_of_two(),
                )
            );
            let r = padded.inside;
            let right = w - r.left - r.width;
            let below = h - r.top - r.height;
            assert!(
                [r.left, r.top, right, below]
                    .iter()
                    .all(|&side| side >= padding)
            );
            // In the middle, but for a texel.
            assert!(r.left.abs_diff(right) <= 1 && r.top.abs_diff(below) <= 1);
            if padding == 0 {
                assert_eq!(padded.picture, inner);
            }
        }
    }
    let clear = picture(2, 1, 0).with_alpha(vec![1, 2]).expect("2x1");
    let padded = atlas::padded(&clear, 1, Beyond::Repeat).expect("it fits");
    let row = [2, 1, 2, 1];
    assert_eq!(padded.picture.alpha(), Some(&[row; 4].concat()[..]));
    for padding in [2041, u32::MAX] {
        let error = atlas::padded(&picture(16, 1, 0), padding, Beyond::Clamp);
        assert!(error.expect_err("too large").to_string().contains("4096"));
    }
}

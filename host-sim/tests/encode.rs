//! Texel formats: each is read back by a decoder written here from the format's description, and
//! compared with the picture.

use std::path::Path;

use host_sim::encode::{self, Indexed};
use host_sim::picture::Picture;
use multum::embedded_graphics::image::{GetPixel as _, ImageRaw, ImageRawBE};
use multum::embedded_graphics::pixelcolor::{Gray4, GrayColor as _};
use multum::embedded_graphics::prelude::*;

/// Every pair of sides from 1 to 16.
fn small_sizes() -> impl Iterator<Item = (u32, u32)> {
    (0..5).flat_map(|i| (0..5).map(move |j| (1 << i, 1 << j)))
}

/// Numbers that look random (splitmix64).
fn random(state: &mut u64) -> u8 {
    *state = state.wrapping_add(0x9E37_79B9_7F4A_7C15);
    let z = (*state ^ (*state >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
    let z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
    (z >> 56) as u8
}

fn noise(width: u32, height: u32) -> Picture {
    let mut state = u64::from(width * 31 + height);
    let mut pixel = |_| [0; 3].map(|_: u8| random(&mut state));
    let pixels = (0..width * height).map(&mut pixel).collect();
    Picture::new(width, height, pixels).expect("powers of two")
}

fn with_noisy_alpha(picture: Picture) -> Picture {
    let mut state = 7;
    let alpha = picture
        .pixels()
        .iter()
        .map(|_| random(&mut state))
        .collect();
    picture.with_alpha(alpha).expect("as many as pixels")
}

fn painted(width: u32, height: u32, colour: impl Fn(u32, u32) -> [u8; 3]) -> Picture {
    let pixels = (0..height)
        .flat_map(|y| (0..width).map(move |x| (x, y)))
        .map(|(x, y)| colour(x, y))
        .collect();
    Picture::new(width, height, pixels).expect("powers of two")
}

fn photo() -> Picture {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("assets/photo/chelsea.png");
    Picture::load(&path).expect("a picture").0
}

fn psnr(a: &[[u8; 3]], b: &[[u8; 3]]) -> f64 {
    assert_eq!(a.len(), b.len());
    let squares = a.as_flattened().iter().zip(b.as_flattened());
    let sum: f64 = squares
        .map(|(&a, &b)| (f64::from(a) - f64::from(b)).powi(2))
        .sum();
    10.0 * (255.0f64.powi(2) * 3.0 * a.len() as f64 / sum).log10()
}

#[test]
fn gray_is_the_nearest_to_rec_709_luma() {
    for (width, height) in small_sizes().chain([(64, 64)]) {
        let picture = noise(width, height);
        let gray = encode::gray8(&picture);
        assert_eq!(gray.len(), picture.pixels().len());
        for (&[r, g, b], gray) in picture.pixels().iter().zip(gray) {
            let luma = 0.2126 * f64::from(r) + 0.7152 * f64::from(g) + 0.0722 * f64::from(b);
            // Half a step, and what the float sum may be off by.
            assert!((luma - f64::from(gray)).abs() <= 0.5 + 1e-9, "{r} {g} {b}");
        }
    }
    let primaries = [[255, 0, 0], [0, 255, 0], [0, 0, 255], [255; 3]];
    let picture = Picture::new(4, 1, primaries.to_vec()).expect("4x1");
    // 54.2, 182.4, 18.4, 255.
    assert_eq!(encode::gray8(&picture), [54, 182, 18, 255]);
}

#[test]
fn rgba5551_has_the_nearest_channels_and_one_bit_of_alpha() {
    for (width, height) in small_sizes().chain([(64, 64)]) {
        for picture in [noise(width, height), with_noisy_alpha(noise(width, height))] {
            let texels = encode::rgba5551(&picture);
            assert_eq!(texels.len(), picture.pixels().len());
            for (i, texel) in texels.iter().enumerate() {
                for (channel, shift) in [(0, 11), (1, 6), (2, 1)] {
                    let decoded = f64::from(texel >> shift & 31) * 255.0 / 31.0;
                    let given = f64::from(picture.pixels()[i][channel]);
                    // Half a step of five bits.
                    assert!((decoded - given).abs() <= 255.0 / 31.0 / 2.0, "{texel:04x}");
                }
                let opaque = picture.alpha().is_none_or(|alpha| alpha[i] >= 128);
                assert_eq!(texel & 1 == 1, opaque);
            }
        }
    }
    let picture = Picture::new(2, 2, vec![[255, 0, 0], [0, 255, 0], [0, 0, 255], [0; 3]])
        .and_then(|picture| picture.with_alpha(vec![0, 127, 128, 255]))
        .expect("2x2");
    assert_eq!(encode::rgba5551(&picture), [0xF800, 0x07C0, 0x003F, 0x0001]);
}

#[test]
fn rgba8888_keeps_all_bits() {
    for (width, height) in small_sizes() {
        let picture = with_noisy_alpha(noise(width, height));
        let alpha = picture.alpha().expect("alpha");
        for (i, texel) in encode::rgba8888(&picture).into_iter().enumerate() {
            let [r, g, b] = picture.pixels()[i];
            assert_eq!(texel, [r, g, b, alpha[i]]);
        }
        let opaque = encode::rgba8888(&noise(width, height));
        assert!(opaque.iter().all(|texel| texel[3] == 255));
    }
}

fn decoded(indexed: &Indexed) -> Vec<[u8; 3]> {
    let colour = |&i: &u8| indexed.palette[usize::from(i)];
    indexed.indices.iter().map(colour).collect()
}

#[test]
fn a_picture_of_few_colours_is_exact() {
    for colours in [16, 256] {
        for (width, height) in small_sizes() {
            let all = noise(width, height);
            let count = all.pixels().len().min(colours);
            // No colour twice, and no more than fit.
            let picture = painted(width, height, |x, y| {
                let number = (y * width + x) as usize % count;
                [number as u8, 255 - number as u8, (number * 7) as u8]
            });
            let indexed = encode::indexed(&picture, colours);
            assert_eq!(decoded(&indexed), picture.pixels());
            assert_eq!(indexed.palette.len(), count);
            assert_eq!(indexed.palette[0], picture.pixels()[0]);
        }
    }
}

#[test]
fn one_colour_too_many_costs_one_colour_little() {
    // 17 grays 15 apart and 257 greens 1 apart in green or blue: two must share one, and lose at
    // most half their distance.
    let grays = painted(32, 1, |x, _| [(x.min(16) * 15) as u8; 3]);
    let greens = painted(512, 1, |x, _| [0, x.min(255) as u8, u8::from(x > 255)]);
    for (picture, colours, distance) in [(grays, 16, 15.0), (greens, 256, 1.0)] {
        let indexed = encode::indexed(&picture, colours);
        assert_eq!(indexed.palette.len(), colours);
        let wrong = decoded(&indexed);
        let pairs = wrong.iter().zip(picture.pixels());
        let wrong = pairs.clone().filter(|(a, b)| a != b).count();
        assert!(wrong <= 2, "{wrong} texels changed");
        for (a, b) in pairs {
            for (a, b) in a.iter().zip(b) {
                assert!(f64::from(a.abs_diff(*b)) <= distance, "{a} {b}");
            }
        }
    }
}

#[test]
fn clusters_of_colours_are_found() {
    // Sixteen colours, each channel 40 or 200 or so, with noise of at most 3: a palette that gives
    // each its own is off by 6 at most, one that misses any by 80 somewhere.
    let mut state = 3;
    let mut pixels = Vec::new();
    for i in 0..64 * 64 {
        let i = i / 7 % 16;
        let base = [
            40 + (i & 1) * 80,
            40 + (i >> 1 & 1) * 80,
            40 + (i >> 2) * 60,
        ];
        pixels.push(base.map(|c: u32| c as u8 + random(&mut state) % 4));
    }
    let picture = Picture::new(64, 64, pixels).expect("64x64");
    let indexed = encode::indexed(&picture, 16);
    for (a, b) in decoded(&indexed).iter().zip(picture.pixels()) {
        assert!((0..3).all(|c| a[c].abs_diff(b[c]) <= 6), "{a:?} {b:?}");
    }
}

#[test]
fn palettes_beat_fixed_ones_and_are_the_same_each_time() {
    let photo = photo();
    // Palettes that know nothing of the picture: cells of 2x4x2 and of 8x8x4 colours, decoded to
    // the middle of each.
    for (colours, cells) in [(16, [2, 4, 2]), (256, [8, 8, 4])] {
        let fixed: Vec<[u8; 3]> = photo
            .pixels()
            .iter()
            .map(|rgb| {
                std::array::from_fn(|c| {
                    let cell = u32::from(rgb[c]) * cells[c] / 256;
                    ((2 * cell + 1) * 128 / cells[c]) as u8
                })
            })
            .collect();
        let indexed = encode::indexed(&photo, colours);
        let (ours, fixed) = (
            psnr(&decoded(&indexed), photo.pixels()),
            psnr(&fixed, photo.pixels()),
        );
        // A photograph of a cat fills a small part of the cube: at least twice as fine a grid on
        // each axis, 6 dB.
        assert!(ours > fixed + 6.0, "{colours}: {ours:.1} dB, {fixed:.1} dB");
        assert_eq!(indexed, encode::indexed(&photo, colours));
        // Colours are about the means of their texels, where the squared error is least.
        for (number, colour) in indexed.palette.iter().enumerate() {
            let chosen = indexed.indices.iter().zip(photo.pixels());
            let own = chosen.filter(|(i, _)| usize::from(**i) == number);
            let own: Vec<_> = own.map(|(_, rgb)| rgb.map(f64::from)).collect();
            for c in 0..3 {
                let mean = own.iter().map(|rgb| rgb[c]).sum::<f64>() / own.len() as f64;
                let away = (mean - f64::from(colour[c])).abs();
                assert!(
                    away < 2.0,
                    "{colour:?} of {colours} is {away:.2} from the mean {mean:.1}"
                );
            }
        }
        // Every texel has the palette's nearest colour.
        let distance = |a: [u8; 3], b: [u8; 3]| -> u32 {
            (0..3).map(|c| u32::from(a[c].abs_diff(b[c])).pow(2)).sum()
        };
        for (&a, &b) in decoded(&indexed).iter().zip(photo.pixels()).step_by(97) {
            let least = indexed.palette.iter().map(|&p| distance(p, b)).min();
            assert_eq!(Some(distance(a, b)), least);
        }
    }
}

#[test]
fn noise_of_any_size_gets_a_palette() {
    for (width, height) in small_sizes().chain([(64, 64)]) {
        let picture = noise(width, height);
        for colours in [16, 256] {
            let indexed = encode::indexed(&picture, colours);
            assert_eq!(indexed.indices.len(), picture.pixels().len());
            assert!(indexed.palette.len() <= colours);
            decoded(&indexed);
        }
    }
}

#[test]
fn packed_indices_are_an_image_of_embedded_graphics() {
    for (width, height) in small_sizes() {
        let indexed = encode::indexed(&noise(width, height), 16);
        let packed = encode::pack4(&indexed.indices, width);
        assert_eq!(packed.len() as u32, width.div_ceil(2) * height);
        let raw: ImageRawBE<'_, Gray4> = ImageRaw::new(&packed, width);
        for (i, &index) in indexed.indices.iter().enumerate() {
            let at = Point::new(i as i32 % width as i32, i as i32 / width as i32);
            assert_eq!(raw.pixel(at).expect("inside").luma(), index, "{at}");
        }
    }
    assert_eq!(encode::pack4(&[1, 2, 3, 4], 4), [0x12, 0x34]);
    assert_eq!(encode::pack4(&[5, 6], 1), [0x50, 0x60]);
}

/// Blocks of BC1 as RGBA, by the Khronos Data Format Specification: two little-endian RGB565
/// colours, then two bits a texel from the lowest; the first colour above the second as a number
/// means four colours, else three and transparent black. `width` and `height` are of the result.
fn decoded_bc1(bytes: &[u8], width: u32, height: u32) -> Vec<[u8; 4]> {
    let expand = |value: u16| {
        let channel = |bits: u16, max: u16| f64::from(bits) * 255.0 / f64::from(max);
        [
            channel(value >> 11, 31),
            channel(value >> 5 & 63, 63),
            channel(value & 31, 31),
        ]
    };
    let columns = width.div_ceil(4);
    assert_eq!(bytes.len() as u32, columns * height.div_ceil(4) * 8);
    let mut texels = Vec::new();
    for y in 0..height {
        for x in 0..width {
            let block = &bytes[(8 * (y / 4 * columns + x / 4)) as usize..][..8];
            let first = u16::from_le_bytes([block[0], block[1]]);
            let second = u16::from_le_bytes([block[2], block[3]]);
            let code = block[4 + (y % 4) as usize] >> (2 * (x % 4)) & 3;
            let (weight, alpha) = match (first > second, code) {
                (_, 0) => (0.0, 255),
                (_, 1) => (1.0, 255),
                (true, 2) => (1.0 / 3.0, 255),
                (true, _) => (2.0 / 3.0, 255),
                (false, 2) => (0.5, 255),
                (false, _) => (f64::NAN, 0),
            };
            let (a, b) = (expand(first), expand(second));
            // A float NaN becomes 0: black.
            let rgb = [0, 1, 2].map(|c| (a[c] + (b[c] - a[c]) * weight).round() as u8);
            texels.push([rgb[0], rgb[1], rgb[2], alpha]);
        }
    }
    texels
}

fn colours(texels: &[[u8; 4]]) -> Vec<[u8; 3]> {
    texels.iter().map(|&[r, g, b, _]| [r, g, b]).collect()
}

#[test]
fn bc1_of_one_colour_is_within_a_step_of_rgb565() {
    for (width, height) in small_sizes() {
        for colour in [[0; 3], [255; 3], [1, 2, 3], [200, 100, 50], [13, 251, 128]] {
            let picture = painted(width, height, |_, _| colour);
            for texel in decoded_bc1(&encode::bc1(&picture), width, height) {
                assert_eq!(texel[3], 255);
                for (c, step) in [(0, 31.0), (1, 63.0), (2, 31.0)] {
                    // The colour itself rounded would be off by half a step of RGB565 at most, and
                    // one unit comes from rounding; a mixture may only be better.
                    let error = f64::from(texel[c].abs_diff(colour[c]));
                    assert!(error <= 255.0 / step / 2.0 + 1.0, "{colour:?} {texel:?}");
                }
            }
        }
    }
}

#[test]
fn bc1_of_a_ramp_is_off_by_its_step_at_most() {
    // A block spans 12 grays, so the four colours are 4 apart: 2, and the ends are off by half a
    // step of 5 bits, 4.1. (The best ends may lie within, so it is not more.)
    let (range, step) = (12.0, 255.0f64 / 31.0);
    let bound = range / 6.0 + step / 2.0;
    let ramp = painted(64, 64, |x, _| [(x * 4) as u8; 3]);
    let texels = decoded_bc1(&encode::bc1(&ramp), 64, 64);
    let least = 20.0 * (255.0 / bound).log10();
    let ours = psnr(&colours(&texels), ramp.pixels());
    assert!(ours >= least, "{ours:.1} dB, {least:.1} dB");
}

#[test]
fn bc1_of_a_photograph_is_good_and_opaque() {
    let photo = photo();
    let texels = decoded_bc1(&encode::bc1(&photo), photo.width(), photo.height());
    assert!(texels.iter().all(|texel| texel[3] == 255));
    let ours = psnr(&colours(&texels), photo.pixels());
    let plain = between_farthest(&photo);
    let plain = psnr(&plain, photo.pixels());
    // Least squares over the groupings of a block's colours against ends that are two of them:
    // a quarter less squared error at least. One wrong order of blocks, rows or indices costs ten
    // times that.
    assert!(ours > plain + 1.0, "{ours:.1} dB, {plain:.1} dB");
}

/// Each block with four colours between the two of its own that are farthest apart, not rounded to
/// RGB565: better than any encoder that does only that.
fn between_farthest(picture: &Picture) -> Vec<[u8; 3]> {
    let width = picture.width();
    let distance =
        |a: [f64; 3], b: [f64; 3]| -> f64 { a.iter().zip(b).map(|(a, b)| (a - b).powi(2)).sum() };
    let mut texels = picture.pixels().to_vec();
    for block in 0..width / 4 * (picture.height() / 4) {
        let (left, top) = (block % (width / 4) * 4, block / (width / 4) * 4);
        let places = (0..16).map(|i| ((top + i / 4) * width + left + i % 4) as usize);
        let own: Vec<_> = places
            .clone()
            .map(|at| picture.pixels()[at].map(f64::from))
            .collect();
        let pairs = own.iter().flat_map(|&a| own.iter().map(move |&b| (a, b)));
        let (a, b) = pairs
            .max_by(|p, q| distance(p.0, p.1).total_cmp(&distance(q.0, q.1)))
            .expect("16 by 16 pairs");
        for (at, texel) in places.zip(own) {
            let four =
                [0.0, 1.0, 2.0, 3.0].map(|i| [0, 1, 2].map(|c| a[c] + (b[c] - a[c]) * i / 3.0));
            let nearest = four
                .into_iter()
                .min_by(|p, q| distance(*p, texel).total_cmp(&distance(*q, texel)))
                .expect("four colours");
            texels[at] = nearest.map(|c| c.round() as u8);
        }
    }
    texels
}

#[test]
fn bc1_below_a_block_keeps_its_texels() {
    for (width, height) in small_sizes().filter(|&(w, h)| w < 4 || h < 4) {
        // Two colours of RGB565, so that they can be ends of a block.
        let picture = painted(width, height, |x, y| {
            if (x + y) % 2 == 0 {
                [255, 0, 0]
            } else {
                [0, 0, 255]
            }
        });
        let texels = decoded_bc1(&encode::bc1(&picture), width, height);
        assert_eq!(colours(&texels), picture.pixels(), "{width}x{height}");
        // The rest of the block is the edge again.
        let (w, h) = (width.max(4), height.max(4));
        let whole = decoded_bc1(&encode::bc1(&picture), w, h);
        for (i, texel) in whole.iter().enumerate() {
            let (x, y) = (i as u32 % w, i as u32 / w);
            let edge = y.min(height - 1) * width + x.min(width - 1);
            assert_eq!(texel, &texels[edge as usize]);
        }
    }
}

#[test]
fn bc1_cuts_alpha_at_half() {
    let sizes = small_sizes().chain([(64, 64)]);
    for picture in sizes
        .map(|(width, height)| with_noisy_alpha(noise(width, height)))
        .chain([noise(64, 64), painted(8, 8, |x, y| [(x * y) as u8; 3])])
        .chain([painted(4, 4, |_, _| [9; 3])
            .with_alpha(vec![0; 16])
            .expect("4x4")])
    {
        let texels = decoded_bc1(&encode::bc1(&picture), picture.width(), picture.height());
        for (i, texel) in texels.iter().enumerate() {
            let opaque = picture.alpha().is_none_or(|alpha| alpha[i] >= 128);
            assert_eq!(texel[3], if opaque { 255 } else { 0 });
        }
    }
}

//! Pyramids: every way to build one gives the box averages that a direct reading of the words
//! gives, and refuses buffers of any other length.

use multum::colour::{Rgba5551, Rgba8888};
use multum::embedded_graphics::pixelcolor::{Gray8, Rgb565, Rgb888};
use multum::error::Error;
use multum::pyramid::average::Average;
use multum::pyramid::build::{IndexedOrDirect, build, build_indexed, coarser_texels};
use multum::pyramid::{self, Pyramid, constant, level_size, levels};
use multum::texture::{Indexed, Indexed4, Texels, Texture};
use multum::uv::Uv;
use rand::Rng as _;
use tests::colours::Split;
use tests::random::{Rng, seeded};

const SIZES: [(u32, u32); 14] = [
    (1, 1),
    (2, 1),
    (1, 2),
    (2, 2),
    (8, 1),
    (1, 32),
    (4, 4),
    (8, 4),
    (2, 16),
    (32, 8),
    (16, 16),
    (64, 2),
    (64, 64),
    (256, 1),
];

/// The texels of a level that one of the next stands for: four, or two where a side is 1 already.
fn box_of<C: Copy>(level: &[C], (width, height): (u32, u32), column: u32, row: u32) -> Vec<C> {
    let columns = if width > 1 {
        2 * column..2 * column + 2
    } else {
        0..1
    };
    let rows = if height > 1 {
        2 * row..2 * row + 2
    } else {
        0..1
    };
    rows.flat_map(|y| columns.clone().map(move |x| (x, y)))
        .map(|(x, y)| level[(y * width + x) as usize])
        .collect()
}

/// The mean of the numbers, to the nearest, halves up.
fn stored_mean<C: Split>(texels: &[C]) -> C {
    let n = texels.len() as f64;
    C::join([0, 1, 2, 3].map(|k| {
        let sum: u32 = texels.iter().map(|t| t.split()[k]).sum();
        (f64::from(sum) / n + 0.5).floor() as u32
    }))
}

/// All levels, one after the other, from level 0.
fn box_averages<C: Split>(level0: &[C], width: u32, height: u32) -> Vec<C> {
    let mut all = level0.to_vec();
    let (mut size, mut level) = ((width, height), level0.to_vec());
    while size != (1, 1) {
        let next = ((size.0 / 2).max(1), (size.1 / 2).max(1));
        level = (0..next.1)
            .flat_map(|row| (0..next.0).map(move |column| (column, row)))
            .map(|(column, row)| stored_mean(&box_of(&level, size, column, row)))
            .collect();
        size = next;
        all.extend(&level);
    }
    all
}

/// Noise, and pictures of few colours, in which sums that end in one half are common.
fn picture<C: Split>(random: &mut Rng, count: usize) -> Vec<C> {
    if random.random() {
        (0..count).map(|_| C::random(random)).collect()
    } else {
        let colours = [0; 3].map(|_| C::random(random));
        (0..count)
            .map(|_| colours[random.random_range(0..3)])
            .collect()
    }
}

/// Level 0 and room for the others, filled with what must not stay.
fn buffer<C: Split>(level0: &[C], width: u32, height: u32) -> Vec<C> {
    let mut buffer = level0.to_vec();
    buffer.resize(
        pyramid::texels(width, height),
        C::join(C::BITS.map(|b| (1 << b) - 1)),
    );
    buffer
}

fn check_stored<C: Split>() {
    let mut random = seeded(501);
    for (width, height) in SIZES {
        for _ in 0..8 {
            let level0 = picture::<C>(&mut random, (width * height) as usize);
            let mut all = buffer(&level0, width, height);
            let expected = box_averages(&level0, width, height);
            let built = build(&mut all, width, height, Average::Stored).expect("that many texels");
            assert_eq!(built.last() + 1, levels(width, height));
            let mut rest = &expected[..];
            for (number, level) in (0..).zip(built.iter()) {
                let size = level_size(width, height, number);
                assert_eq!((level.width(), level.height()), size);
                let (now, after) = rest.split_at((size.0 * size.1) as usize);
                assert_eq!(level.texels(), now, "level {number} of {width}x{height}");
                rest = after;
            }
            assert!(rest.is_empty());
        }
    }
}

#[test]
fn means_of_stored_numbers_are_box_averages() {
    check_stored::<Gray8>();
    check_stored::<Rgb565>();
    check_stored::<Rgb888>();
    check_stored::<Rgba5551>();
    check_stored::<Rgba8888>();
}

/// The compiler's pyramid of this size is the one built at start-up.
macro_rules! check_constant {
    ($random:ident, $width:literal, $height:literal) => {
        for average in [Average::Stored, Average::Light] {
            const N: usize = pyramid::texels($width, $height);
            let base = $width * $height;
            let bytes: Vec<u8> = (0..3 * base).map(|_| $random.random()).collect();

            let level0: Vec<_> = (bytes[..2 * base].chunks(2))
                .map(|b| {
                    let bits = u32::from(b[0]) + 256 * u32::from(b[1]);
                    Rgb565::join([bits / 2048, bits / 32 % 64, bits % 32, 0])
                })
                .collect();
            let mut all = buffer(&level0, $width, $height);
            build(&mut all, $width, $height, average).expect("that many texels");
            let constant: [_; N] = constant::rgb565(&bytes[..2 * base], $width, $height, average);
            assert_eq!(constant, all[..], "Rgb565, {average:?}");

            let level0: Vec<_> = (bytes.chunks(3))
                .map(|b| Rgb888::new(b[0], b[1], b[2]))
                .collect();
            let mut all = buffer(&level0, $width, $height);
            build(&mut all, $width, $height, average).expect("that many texels");
            let constant: [_; N] = constant::rgb888(&bytes, $width, $height, average);
            assert_eq!(constant, all[..], "Rgb888, {average:?}");

            let level0: Vec<_> = bytes[..base].iter().map(|&b| Gray8::new(b)).collect();
            let mut all = buffer(&level0, $width, $height);
            build(&mut all, $width, $height, average).expect("that many texels");
            let constant: [_; N] = constant::gray8(&bytes[..base], $width, $height, average);
            assert_eq!(constant, all[..], "Gray8, {average:?}");
        }
    };
}

#[test]
fn the_compilers_pyramids_are_those_built_at_start_up() {
    let mut random = seeded(502);
    check_constant!(random, 1, 1);
    check_constant!(random, 2, 1);
    check_constant!(random, 1, 2);
    check_constant!(random, 2, 2);
    check_constant!(random, 1, 64);
    check_constant!(random, 32, 1);
    check_constant!(random, 16, 4);
    check_constant!(random, 4, 32);
    check_constant!(random, 32, 32);
}

/// Light of an sRGB value from 0 to 1 (IEC 61966-2-1).
fn light(value: f64) -> f64 {
    if value <= 0.04045 {
        value / 12.92
    } else {
        ((value + 0.055) / 1.055).powf(2.4)
    }
}

/// Whether `found` is the value of some bits whose light is nearest to the mean light of four, and
/// by how much the mean may lie beyond the middle between it and its neighbour.
///
/// In units of 16-bit light: the four lights and with them their mean are off by 1/2, the mean is
/// rounded by 1/2, and the middle of two lights is off by 1/2. Values of fewer than 8 bits are taken
/// for the nearest ones of 8 bits, which moves each light by what `moved` gives.
fn check_light(texels: &[u32], found: u32, bits: u32) -> bool {
    let most = (1u32 << bits) - 1;
    let exact = |v: u32| light(f64::from(v) / f64::from(most));
    let moved = |v: u32| {
        let nearest = (f64::from(v) * 255.0 / f64::from(most)).round() / 255.0;
        (light(nearest) - exact(v)).abs()
    };
    let n = texels.len() as f64;
    let mean = texels.iter().map(|&t| exact(t)).sum::<f64>() / n;
    let allowed = texels.iter().map(|&t| moved(t)).sum::<f64>() / n + 1.5 / 65535.0 + 1e-12;
    let middle = |v: u32| {
        let off = f64::midpoint(moved(v), moved(v + 1));
        (f64::midpoint(exact(v), exact(v + 1)), allowed + off)
    };
    let mut is_nearest = true;
    if found > 0 {
        let (middle, allowed) = middle(found - 1);
        assert!(
            mean >= middle - allowed,
            "{texels:?}: {found} is too bright"
        );
        is_nearest &= mean >= middle;
    }
    if found < most {
        let (middle, allowed) = middle(found);
        assert!(mean <= middle + allowed, "{texels:?}: {found} is too dark");
        is_nearest &= mean <= middle;
    }
    is_nearest
}

/// Texels checked, and how many of their channels of light are not the nearest ones.
fn check_lights<C: Split>(has_alpha: bool) -> (usize, usize) {
    let mut random = seeded(503);
    let (mut checked, mut off) = (0, 0);
    for (width, height) in SIZES {
        for _ in 0..16 {
            let level0 = picture::<C>(&mut random, (width * height) as usize);
            let mut all = buffer(&level0, width, height);
            let built = build(&mut all, width, height, Average::Light).expect("that many texels");
            assert_eq!(built.level(0).texels(), level0);
            let all: Vec<_> = built.iter().collect();
            for pair in all.windows(2) {
                let [fine, coarse] = [pair[0], pair[1]];
                for (i, texel) in (0..).zip(coarse.texels()) {
                    let (column, row) = (i % coarse.width(), i / coarse.width());
                    let size = (fine.width(), fine.height());
                    let four = box_of(fine.texels(), size, column, row);
                    for k in (0..4).filter(|&k| C::BITS[k] > 0) {
                        let found = texel.split()[k];
                        if has_alpha && k == 3 {
                            assert_eq!(found, stored_mean(&four).split()[k], "alpha");
                        } else {
                            let values: Vec<_> = four.iter().map(|t| t.split()[k]).collect();
                            off += usize::from(!check_light(&values, found, C::BITS[k]));
                            checked += 1;
                        }
                    }
                }
            }
        }
    }
    (checked, off)
}

#[test]
fn means_of_light_are_those_of_float64() {
    // 1.5 units on either side of a middle, where middles are 20 units apart in the dark and 380
    // on the average: a value of 8 bits is rarely another one.
    for (checked, off) in [
        check_lights::<Gray8>(false),
        check_lights::<Rgb888>(false),
        check_lights::<Rgba8888>(true),
    ] {
        assert!(checked > 20_000, "{checked}");
        assert!(off * 100 < checked, "{off} of {checked}");
    }
    // The nearest of 8 bits is up to 1/16 of a step of 5 bits away, and 1/8 of one of 6.
    for (checked, off) in [
        check_lights::<Rgb565>(false),
        check_lights::<Rgba5551>(true),
    ] {
        assert!(checked > 20_000, "{checked}");
        assert!(off * 8 < checked, "{off} of {checked}");
    }
}

fn check_indexed<const BITS: u32>() {
    let mut random = seeded(504);
    for (width, height) in SIZES {
        for average in [Average::Stored, Average::Light] {
            let bytes = Indexed::<Rgb565, BITS>::bytes(width, height);
            let indices: Vec<u8> = (0..bytes).map(|_| random.random()).collect();
            let palette: Vec<_> = (0..1 << BITS)
                .map(|_| Rgb565::random(&mut random))
                .collect();
            let indexed = Indexed::<_, BITS>::new(&indices, &palette, width, height)
                .expect("a complete palette");
            let texels: Vec<_> = (0..width * height)
                .map(|i| indexed.texel(i % width, i / width))
                .collect();
            let mut direct = buffer(&texels, width, height);
            let direct = build(&mut direct, width, height, average).expect("that many texels");
            let mut coarser = vec![Rgb565::default(); coarser_texels(width, height)];
            let built = build_indexed(indexed, &mut coarser, average).expect("that many texels");
            assert_eq!(built.last(), direct.last());
            for (number, (found, expected)) in built.iter().zip(direct.iter()).enumerate() {
                let is_indexed = matches!(found, IndexedOrDirect::Indexed(_));
                assert_eq!(is_indexed, number == 0, "level {number}");
                assert_eq!(found.log2_size(), expected.log2_size());
                let (width, height) = (expected.width(), expected.height());
                let texels: Vec<_> = (0..width * height)
                    .map(|i| found.texel(i % width, i / width))
                    .collect();
                assert_eq!(texels, expected.texels(), "level {number}");
                // And by runs, each texel or four at a time.
                let run = |seed: i32| Uv::from_bits(seed.wrapping_mul(0x0123_4567), seed << 19);
                let (uv, step) = (run(number as i32 + 3), run(1));
                let [mut runs, mut plain] = [[Rgb565::default(); 40]; 2];
                found.fill_repeating(uv, step, &mut runs);
                expected.fill_repeating(uv, step, &mut plain);
                assert_eq!(runs, plain, "level {number}");
                let mut fours = Vec::new();
                found.fours_repeating(uv, step, 0..40, |_, four, w| fours.push((four, w)));
                let mut at = 0;
                expected.fours_repeating(uv, step, 0..40, |i, four, w| {
                    assert_eq!((i, (four, w)), (at, fours[at]), "level {number}");
                    at += 1;
                });
                assert_eq!((at, fours.len()), (40, 40));
            }
        }
    }
}

#[test]
fn only_the_finest_level_of_an_indexed_pyramid_is_indexed() {
    check_indexed::<1>();
    check_indexed::<2>();
    check_indexed::<4>();
    check_indexed::<8>();
}

#[test]
fn a_square_pyramid_has_a_third_more_texels() {
    for k in 0..=12u32 {
        let side = 1 << k;
        assert_eq!(pyramid::texels(side, side), (4usize.pow(k + 1) - 1) / 3);
        assert_eq!(levels(side, side), k + 1);
        // A row of n: n, n/2 .. 1.
        assert_eq!(pyramid::texels(side, 1), 2 * side as usize - 1);
        assert_eq!(pyramid::texels(1, side), 2 * side as usize - 1);
        assert_eq!(levels(1, side), k + 1);
        let base = side as usize * side as usize;
        assert_eq!(
            coarser_texels(side, side),
            pyramid::texels(side, side) - base
        );
    }
}

#[test]
fn buffers_of_another_length_are_left_alone() {
    let mark = Gray8::new(77);
    for (width, height) in SIZES {
        let needed = pyramid::texels(width, height);
        let coarser = needed - (width * height) as usize;
        for given in [0, needed - 1, needed + 1, 2 * needed] {
            let mut all = vec![mark; given];
            let error = build(&mut all, width, height, Average::Stored).err();
            if given == needed {
                continue;
            }
            assert_eq!(error, Some(Error::BufferLength { needed, given }));
            assert!(all.iter().all(|&t| t == mark));
            let error = Pyramid::<Texture<'_, Gray8>>::new(&all, width, height).err();
            assert_eq!(error, Some(Error::BufferLength { needed, given }));
        }
        let indices = vec![0; Indexed4::<Gray8>::bytes(width, height)];
        let palette = [mark];
        let finest = Indexed4::new(&indices, &palette, width, height).expect("one colour");
        for given in [coarser.wrapping_sub(1), coarser + 1] {
            if given > needed {
                continue;
            }
            let mut room = vec![mark; given];
            let error = build_indexed(finest, &mut room, Average::Stored).err();
            let needed = coarser;
            assert_eq!(error, Some(Error::BufferLength { needed, given }));
            assert!(room.iter().all(|&t| t == mark));
        }
    }
    for (width, height) in [(0, 4), (4, 0), (3, 4), (4, 12), (8192, 1), (u32::MAX, 1)] {
        let mut all = [mark; 4];
        assert_eq!(
            build(&mut all, width, height, Average::Stored).err(),
            Some(Error::TextureSize { width, height })
        );
    }
}

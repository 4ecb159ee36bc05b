//! Filling a run gives the texels that sampling pixel by pixel gives, whatever the texture's size,
//! the wrap mode, the run's length, start and step.

use multum::embedded_graphics::pixelcolor::raw::RawU16;
use multum::embedded_graphics::pixelcolor::{Rgb565, RgbColor as _};
use multum::filter::{ImageFilter, LinearTexels, LinearTexels5};
use multum::sample::{Bilinear, Nearest, Sampler};
use multum::texture::{
    Clamp, Indexed, MAX_TEXTURE_SIZE, Mirror, Repeat, SizedTexture, Texels, Texture, Wrap,
};
use multum::uv::{Curve, Uv};
use rand::Rng as _;
use tests::random::{Rng, seeded};

/// Texels of the largest texture tried: 1024x1024, and 4096x256 with it.
const MOST: u32 = 1 << 20;

/// One repeat in 8.24.
const ONE: i32 = 1 << Uv::FRACTION_BITS;

/// Most runs: more than three packed pieces.
const LONGEST: usize = 200;

/// Every texel is its own number, so that no other can stand for it.
fn texels() -> Vec<u32> {
    (0..MOST).collect()
}

/// Every size that has at most [`MOST`] texels.
fn for_each_size(texels: &[u32], mut check: impl FnMut(Texture<'_, u32>)) {
    let sides = || (0..=MAX_TEXTURE_SIZE.ilog2()).map(|log2| 1u32 << log2);
    for (width, height) in sides().flat_map(|width| sides().map(move |height| (width, height))) {
        if let Some(texels) = texels.get(..width as usize * height as usize) {
            check(Texture::new(texels, width, height).expect("powers of two"));
        }
    }
}

/// A coordinate's column or row, by whole repeats and texels.
fn texel_along(coordinate: i32, size: u32) -> u32 {
    let texels = i64::from(coordinate) * i64::from(size);
    texels
        .div_euclid(i64::from(ONE))
        .rem_euclid(i64::from(size)) as u32
}

/// What a texture has where coordinates lie: any, and the first and last of a texel.
fn check_texels<T: Texels<Colour = u32>>(texture: T, random: &mut Rng) {
    let (log2_width, log2_height) = texture.log2_size();
    let (width, height) = (1u32 << log2_width, 1u32 << log2_height);
    let sampler = Nearest::<_, Repeat, Repeat>::new(texture);
    for case in 0..200 {
        let [u, v] = [width, height].map(|size| {
            let (any, last) = (random.random::<i32>(), ONE / size.cast_signed() - 1);
            match case % 3 {
                0 => any,
                1 => any & !last,
                _ => any | last,
            }
        });
        let (column, row) = (texel_along(u, width), texel_along(v, height));
        assert_eq!(
            sampler.sample(Uv::from_bits(u, v)),
            texture.texel(column, row),
            "{width}x{height}, u {u}, v {v}: column {column}, row {row}"
        );
    }
}

#[test]
fn a_texel_that_repeats_is_that_of_its_column_and_row() {
    let (texels, mut random) = (texels(), seeded(78));
    let indices: Vec<u8> = (0..MOST).map(|_| random.random()).collect();
    for_each_size(&texels, |texture| {
        // The numbers tell that `texel` is right.
        let (column, row) = (texture.width() - 1, texture.height() / 2);
        assert_eq!(texture.texel(column, row), row * texture.width() + column);
        check_texels(texture, &mut random);
        check_texels(indexed::<8>(&indices, &texels, texture), &mut random);
        check_texels(indexed::<4>(&indices, &texels, texture), &mut random);
    });
}

/// Of a texture's size, with the first of these as its colours.
fn indexed<'a, const BITS: u32>(
    indices: &'a [u8],
    colours: &'a [u32],
    of: Texture<'_, u32>,
) -> Indexed<'a, u32, BITS> {
    let (width, height) = (of.width(), of.height());
    let bytes = Indexed::<u32, BITS>::bytes(width, height);
    Indexed::new(&indices[..bytes], &colours[..1 << BITS], width, height).expect("all indices")
}

/// Runs of indices are their texels one by one, of every size, in bytes that are full or not.
fn check_indexed<const BITS: u32>(indices: &[u8], texels: &[u32], random: &mut Rng) {
    for_each_size(texels, |texture| {
        let indexed = indexed::<BITS>(indices, texels, texture);
        let sampler = Nearest::<_, Repeat, Repeat>::new(indexed);
        for len in [1, 2, 4, 5, 7, 16, 33, 64, 65, LONGEST] {
            let [u, v] = [0; 2].map(|_| random.random());
            let [du, dv] = [0; 2].map(|_| any(random) >> random.random_range(0..12));
            let (uv, step) = (Uv::from_bits(u, v), Uv::from_bits(du, dv));
            let mut run = vec![u32::MAX; len];
            sampler.fill(uv, step, &mut run);
            let mut at = uv;
            for (i, &pixel) in run.iter().enumerate() {
                let [column, row] = [(at.u, texture.width()), (at.v, texture.height())]
                    .map(|(c, size)| texel_along(c.to_bits(), size));
                assert_eq!(
                    pixel,
                    indexed.texel(column, row),
                    "{BITS} bits, {}x{}, pixel {i} of {len}, from {uv:?} by {step:?}",
                    texture.width(),
                    texture.height(),
                );
                at = at + step;
            }
            check_pieces(&sampler, uv, step);
        }
    });
}

#[test]
fn runs_of_indices_are_their_texels() {
    let (texels, mut random) = (texels(), seeded(79));
    let indices: Vec<u8> = (0..MOST).map(|_| random.random()).collect();
    check_indexed::<1>(&indices, &texels, &mut random);
    check_indexed::<2>(&indices, &texels, &mut random);
    check_indexed::<4>(&indices, &texels, &mut random);
    check_indexed::<8>(&indices, &texels, &mut random);
}

/// Compares runs of known length with their pixels one by one.
fn check_pieces<S: Sampler<Texel = u32>>(sampler: &S, uv: Uv, step: Uv) {
    fn check<S: Sampler<Texel = u32>, const N: usize>(sampler: &S, uv: Uv, step: Uv) {
        let mut piece = [u32::MAX; N];
        sampler.piece(uv, step, &mut piece);
        let mut at = uv;
        for (i, pixel) in piece.into_iter().enumerate() {
            let expected = sampler.sample(at);
            assert_eq!(pixel, expected, "{i} of {N}, from {uv:?} by {step:?}");
            at = at + step;
        }
    }
    check::<_, 4>(sampler, uv, step);
    check::<_, 8>(sampler, uv, step);
    check::<_, 16>(sampler, uv, step);
    check::<_, 64>(sampler, uv, step);
}

/// Compares one run with its pixels one by one.
fn check<U: Wrap, V: Wrap>(texture: Texture<'_, u32>, uv: Uv, step: Uv, len: usize) {
    let sampler = Nearest::<_, U, V>::new(texture);
    // No texel has this number: a pixel that is left out shows.
    let mut run = vec![u32::MAX; len];
    sampler.fill(uv, step, &mut run);
    let mut at = uv;
    for (i, &pixel) in run.iter().enumerate() {
        assert_eq!(
            pixel,
            sampler.sample(at),
            "{}x{}, pixel {i} of {len}, from {uv:?} by {step:?}",
            texture.width(),
            texture.height(),
        );
        at = at + step;
    }
    check_pieces(&sampler, uv, step);
}

fn check_all_wraps(texture: Texture<'_, u32>, uv: Uv, step: Uv, len: usize) {
    check::<Repeat, Repeat>(texture, uv, step, len);
    check::<Clamp, Clamp>(texture, uv, step, len);
    check::<Mirror, Mirror>(texture, uv, step, len);
    check::<Repeat, Clamp>(texture, uv, step, len);
    check::<Mirror, Repeat>(texture, uv, step, len);
}

/// Of either sign and any length in bits, zero among them.
fn any(random: &mut Rng) -> i32 {
    let bits = random.random_range(0..=32u32);
    (random.random::<u32>().checked_shr(32 - bits).unwrap_or(0))
        .cast_signed()
        .wrapping_mul(if random.random() { 1 } else { -1 })
}

#[test]
fn runs_of_every_length_from_any_start_by_any_step() {
    let (texels, mut random) = (texels(), seeded(71));
    for_each_size(&texels, |texture| {
        for len in 0..=LONGEST {
            let [u, v, du, dv] = [0; 4].map(|_| any(&mut random));
            check_all_wraps(texture, Uv::from_bits(u, v), Uv::from_bits(du, dv), len);
        }
    });
}

/// Steps of at most a few texels, as nearly all pixels have; from any repeat.
#[test]
fn runs_of_every_length_by_steps_as_in_scenes() {
    let (texels, mut random) = (texels(), seeded(72));
    for_each_size(&texels, |texture| {
        for len in 0..=LONGEST {
            let [u, v] = [0; 2].map(|_| random.random());
            let [du, dv] = [texture.width(), texture.height()].map(|size| {
                let most = (4 * ONE) >> size.ilog2();
                random.random_range(-most..=most)
            });
            check_all_wraps(texture, Uv::from_bits(u, v), Uv::from_bits(du, dv), len);
        }
    });
}

/// v passes 0 or 1 at some pixel of the run, on it or beside it, from above or below.
#[test]
fn runs_that_leave_the_repeat_within() {
    let (texels, mut random) = (texels(), seeded(73));
    for_each_size(&texels, |texture| {
        for len in 1..=LONGEST {
            let dv: i32 = any(&mut random) >> 7;
            let pixels = random.random_range(0..len) as i32;
            let edge = [0, 1, -1, 127][random.random_range(0..4)] * ONE;
            let v = edge
                .wrapping_sub(dv.wrapping_mul(pixels))
                .wrapping_add(random.random_range(-1..=1));
            let [u, du] = [0; 2].map(|_| any(&mut random));
            check_all_wraps(texture, Uv::from_bits(u, v), Uv::from_bits(du, dv), len);
        }
    });
}

/// The largest steps there are, and those around one repeat, where the whole part of a sum over
/// 64 pixels leaves 31 bits and can come back to zero.
#[test]
fn steps_of_whole_repeats_and_around() {
    let (texels, mut random) = (texels(), seeded(74));
    let ends = [i32::MIN, i32::MIN + 1, -1, 0, 1, i32::MAX];
    let around = [1, 2, 4, 64]
        .into_iter()
        .flat_map(|n| [-n * ONE, n * ONE])
        .flat_map(|step| [-1, 0, 1].map(|by| step.wrapping_add(by)));
    let steps: Vec<i32> = ends.into_iter().chain(around).collect();
    for_each_size(&texels, |texture| {
        for &dv in &steps {
            for len in [5, 63, 64, 65, 66, 127, 128, 129, 130, 200] {
                let v = [0, ONE - 1, random.random()][random.random_range(0..3)];
                let u = random.random();
                let du = steps[random.random_range(0..steps.len())];
                check_all_wraps(texture, Uv::from_bits(u, v), Uv::from_bits(du, dv), len);
            }
        }
    });
}

/// Rows of the widest frame and longer, in which v passes an edge anywhere, or slowly: by steps that are
/// the least to be packed or to be filled one by one, and less.
#[test]
fn runs_as_long_as_rows() {
    let (texels, mut random) = (texels(), seeded(77));
    for [width, height] in [[1, 1], [256, 256], [64, 32], [8, 512]] {
        let texture = Texture::new(&texels[..width * height], width as u32, height as u32);
        let texture = texture.expect("powers of two");
        for len in [1022, 1023, 1024, 1025, 1026, 2047, 2048, 2049, 20_000] {
            for _ in 0..40 {
                let steep = ONE >> random.random_range(2..=6);
                let dv = match random.random_range(0..4) {
                    0 => 0,
                    1 => steep + random.random_range(-1..=1),
                    2 => -steep + random.random_range(-1..=1),
                    _ => random.random_range(-steep..=steep) >> random.random_range(0..20),
                };
                let edge = random.random_range(0..len as i32);
                let v = random.random_range(-1..=1) - dv.wrapping_mul(edge);
                let (u, du) = (random.random(), random.random_range(-steep..=steep));
                check::<Repeat, Repeat>(texture, Uv::from_bits(u, v), Uv::from_bits(du, dv), len);
            }
        }
    }
}

/// Compares pixels along a parabola with those one by one.
fn check_curve<S: Sampler<Texel = u32>>(sampler: &S, curve: Curve, len: usize) {
    let mut pixels = vec![u32::MAX; len];
    sampler.curve(curve, &mut pixels);
    for (i, (&pixel, uv)) in pixels.iter().zip(curve).enumerate() {
        assert_eq!(pixel, sampler.sample(uv), "{i} of {len}, {curve:?}");
    }
}

/// Any parabola: from everywhere, with steps and changes of any size; as in scenes, where v mostly stays within a
/// repeat and turns around now and then; and beside the edge of a repeat.
fn curves(random: &mut Rng) -> [Curve; 3] {
    let [u, v] = [0; 2].map(|_| random.random());
    let mut uv = |shift: u32| {
        let [u, v] = [0; 2].map(|_| any(random) >> shift);
        Uv::from_bits(u, v)
    };
    let of_any = Curve {
        uv: Uv::from_bits(u, v),
        step: uv(0),
        change: uv(0),
    };
    let as_in_scenes = Curve {
        step: uv(13),
        change: uv(18),
        ..of_any
    };
    let beside_an_edge = Curve {
        uv: Uv::from_bits(u, (v & !(ONE - 1)).wrapping_add(uv(20).v.to_bits())),
        ..as_in_scenes
    };
    [of_any, as_in_scenes, beside_an_edge]
}

/// On the edges of texels, where a unit less of u is another texel, from beside the edge of a repeat in v: v turns
/// around beyond it and comes back to the last pixel, or steps or their changes are whole repeats that sum to none.
fn curves_that_come_back(random: &mut Rng, len: usize) -> [Curve; 3] {
    let mut bits = |up: u32| (any(random) >> 12) << up;
    let steps = (len as i32).max(2) - 1;
    let start = Uv::from_bits(bits(12), (bits(0) >> 8) & !(ONE - 1) | 5);
    let mut curve = |dv: i32, ddv: i32| Curve {
        uv: start,
        step: Uv::from_bits(bits(12), dv),
        change: Uv::from_bits(bits(12), ddv),
    };
    let turn = 1 + (steps & 7) * 40;
    // So often a repeat that as many steps are 256, where sums begin again.
    let whole = ONE.wrapping_mul(256 / (steps & steps.wrapping_neg()));
    [
        curve(-turn * (steps - 1) / 2, turn),
        curve(whole, 0),
        curve(0, whole.wrapping_mul(2)),
    ]
}

#[test]
fn curves_of_every_length() {
    let (texels, mut random) = (texels(), seeded(80));
    for_each_size(&texels, |texture| {
        for len in 0..=70 {
            for curve in curves(&mut random) {
                check_curve(&Nearest::<_, Repeat>::new(texture), curve, len);
                check_curve(&Nearest::<_, Clamp, Mirror>::new(texture), curve, len);
            }
            for curve in curves_that_come_back(&mut random, len) {
                check_curve(&Nearest::<_, Repeat>::new(texture), curve, len);
            }
        }
    });
}

#[test]
fn curves_are_the_same_with_a_size_in_the_type() {
    fn check<const WIDTH: u32, const TEXELS: usize>(texels: &[u32], random: &mut Rng) {
        let texels: &[u32; TEXELS] = texels.first_chunk().expect("enough texels");
        let sampler = Nearest::<_, Repeat>::new(SizedTexture::<_, WIDTH, TEXELS>::new(texels));
        for len in 0..=70 {
            for _ in 0..10 {
                for curve in curves(random) {
                    check_curve(&sampler, curve, len);
                }
                for curve in curves_that_come_back(random, len) {
                    check_curve(&sampler, curve, len);
                }
            }
        }
    }
    let (texels, mut random) = (texels(), seeded(81));
    check::<1, 1>(&texels, &mut random);
    check::<1, 256>(&texels, &mut random);
    check::<256, 256>(&texels, &mut random);
    check::<16, 2048>(&texels, &mut random);
    check::<256, 65_536>(&texels, &mut random);
    check::<64, 65_536>(&texels, &mut random);
}

/// Compares a texture with its size in its type with the same texels in one without.
fn check_sized<const WIDTH: u32, const TEXELS: usize>(texels: &[u32], random: &mut Rng) {
    let texels: &[u32; TEXELS] = texels.first_chunk().expect("enough texels");
    let plain = Texture::new(texels, WIDTH, TEXELS as u32 / WIDTH).expect("powers of two");
    let plain = Nearest::<_, Repeat>::new(plain);
    let sized = Nearest::<_, Repeat>::new(SizedTexture::<_, WIDTH, TEXELS>::new(texels));
    let mut all = [0u32; LONGEST];
    for len in 0..=LONGEST {
        let [u, v, du, dv] = [0; 4].map(|_| any(random));
        // Steps as they come, and so small that v seldom leaves the repeat.
        for shift in [0, 12] {
            let (uv, step) = (Uv::from_bits(u, v), Uv::from_bits(du >> shift, dv >> shift));
            let mut expected = [0u32; LONGEST];
            plain.fill(uv, step, &mut expected[..len]);
            sized.fill(uv, step, &mut all[..len]);
            assert_eq!(
                all[..len],
                expected[..len],
                "{WIDTH}, {len}: {uv:?} by {step:?}"
            );
            let mut piece = [0u32; 16];
            sized.piece(uv, step, &mut piece);
            plain.fill(uv, step, &mut expected[..16]);
            assert_eq!(piece, expected[..16], "{WIDTH}: {uv:?} by {step:?}");
        }
    }
}

/// The same of four texels a pixel.
fn check_sized_fours<F, const WIDTH: u32, const TEXELS: usize>(texels: &[u32], random: &mut Rng)
where
    F: ImageFilter + Default,
{
    let texels: Vec<Rgb565> = texels[..TEXELS]
        .iter()
        .map(|&number| RawU16::new((number.wrapping_mul(0x9e37_79b9) >> 16) as u16).into())
        .collect();
    let texels: &[Rgb565; TEXELS] = texels.first_chunk().expect("enough texels");
    let plain = Texture::new(texels, WIDTH, TEXELS as u32 / WIDTH).expect("powers of two");
    let plain = Bilinear::<_, Repeat, Repeat, F>::new(plain);
    let sized = SizedTexture::<_, WIDTH, TEXELS>::new(texels);
    let sized = Bilinear::<_, Repeat, Repeat, F>::new(sized);
    let empty = [Rgb565::BLACK; LONGEST];
    for len in 0..=LONGEST {
        let [u, v, du, dv] = [0; 4].map(|_| any(random));
        for shift in [0, 12] {
            let (mut uv, step) = (Uv::from_bits(u, v), Uv::from_bits(du >> shift, dv >> shift));
            let (mut all, mut expected) = (empty, empty);
            plain.fill(uv, step, &mut expected[..len]);
            sized.fill(uv, step, &mut all[..len]);
            assert_eq!(all, expected, "{WIDTH}, {len}: {uv:?} by {step:?}");
            let mut piece = [Rgb565::BLACK; 16];
            sized.piece(uv, step, &mut piece);
            for pixel in piece {
                assert_eq!(pixel, plain.sample(uv), "{WIDTH}: {uv:?} by {step:?}");
                uv = uv + step;
            }
        }
    }
}

#[test]
fn a_size_in_the_type_filters_the_same() {
    fn check<F: ImageFilter + Default>(seed: u64) {
        let (texels, mut random) = (texels(), seeded(seed));
        check_sized_fours::<F, 1, 1>(&texels, &mut random);
        check_sized_fours::<F, 1, 64>(&texels, &mut random);
        check_sized_fours::<F, 64, 2048>(&texels, &mut random);
        check_sized_fours::<F, 256, 65_536>(&texels, &mut random);
        // Rows beyond what is packed.
        check_sized_fours::<F, 32, 32_768>(&texels, &mut random);
    }
    check::<LinearTexels>(75);
    check::<LinearTexels5>(76);
}

#[test]
fn a_size_in_the_type_draws_the_same() {
    let (texels, mut random) = (texels(), seeded(72));
    check_sized::<1, 1>(&texels, &mut random);
    check_sized::<1, 64>(&texels, &mut random);
    check_sized::<64, 64>(&texels, &mut random);
    check_sized::<64, 2048>(&texels, &mut random);
    check_sized::<256, 65_536>(&texels, &mut random);
    // Rows beyond what is packed.
    check_sized::<32, 32_768>(&texels, &mut random);
    check_sized::<1024, 1_048_576>(&texels, &mut random);
}

//! Formats of texels: each gives the texel that a direct reading of its layout gives, and refuses
//! what it cannot read. Nothing panics (overflow checks are on in this profile).

use multum::embedded_graphics::image::{GetPixel, ImageRaw};
use multum::embedded_graphics::pixelcolor::raw::{BigEndian, LittleEndian, RawU16};
use multum::embedded_graphics::pixelcolor::{
    BinaryColor, Gray4, Gray8, IntoStorage, Rgb565, Rgb888,
};
use multum::embedded_graphics::prelude::{OriginDimensions, Point};
use multum::error::Error;
use multum::pyramid::{Pyramid, level_size, levels};
use multum::sample::{Nearest, Sampler};
use multum::texture::{
    Bc1, Clamp, ImageTexels, Indexed, MAX_TEXTURE_SIZE, Mirror, Morton, Repeat, Texels, Texture,
    Window, Wrap,
};
use multum::uv::Uv;
use proptest::prelude::*;
use rand::Rng as _;
use tests::colours::Split as _;
use tests::random::{Rng, seeded};

/// Every size with sides up to 64, and long ones.
fn sizes() -> impl Iterator<Item = (u32, u32)> {
    let sides = || (0..=6).map(|log2| 1u32 << log2);
    sides()
        .flat_map(move |width| sides().map(move |height| (width, height)))
        .chain([(4096, 1), (1, 4096), (2048, 2), (4, 1024)])
}

/// All columns and rows.
fn places(width: u32, height: u32) -> impl Iterator<Item = (u32, u32)> {
    (0..height).flat_map(move |row| (0..width).map(move |column| (column, row)))
}

fn bytes(random: &mut Rng, count: usize) -> Vec<u8> {
    (0..count).map(|_| random.random()).collect()
}

/// Bits of a row from its first byte's highest one on; every row begins with a byte.
fn packed(indices: &[u8], bits: u32, width: u32, column: u32, row: u32) -> usize {
    let row_bits = (width * bits).div_ceil(8) * 8;
    let first = row * row_bits + column * bits;
    (first..first + bits).fold(0, |index, bit| {
        let byte = indices[bit as usize / 8];
        2 * index + usize::from(byte & (128 >> (bit % 8)) != 0)
    })
}

fn check_indexed<const BITS: u32>() {
    let mut random = seeded(601);
    let palette: Vec<u32> = (1000..1000 + (1 << BITS)).collect();
    for (width, height) in sizes() {
        let indices = bytes(&mut random, Indexed::<u32, BITS>::bytes(width, height));
        let texture =
            Indexed::<_, BITS>::new(&indices, &palette, width, height).expect("a complete palette");
        assert_eq!(texture.log2_size(), (width.ilog2(), height.ilog2()));
        for (column, row) in places(width, height) {
            assert_eq!(
                texture.texel(column, row),
                palette[packed(&indices, BITS, width, column, row)],
                "{BITS} bits, {width}x{height}, column {column}, row {row}"
            );
        }
        // With a colour less, the first texel that names it is told.
        let shorter = &palette[..palette.len() - 1];
        let missing = places(width, height)
            .find(|&(column, row)| packed(&indices, BITS, width, column, row) == shorter.len());
        let error = Indexed::<_, BITS>::new(&indices, shorter, width, height).err();
        let expected = missing.map(|(column, row)| Error::PaletteIndex {
            column,
            row,
            index: shorter.len() as u32,
            colours: shorter.len(),
        });
        assert_eq!(error, expected);
        for given in [indices.len() - 1, indices.len() + 1] {
            let other = vec![0; given];
            let needed = indices.len();
            assert_eq!(
                Indexed::<_, BITS>::new(&other, &palette, width, height).err(),
                Some(Error::BufferLength { needed, given })
            );
        }
    }
}

#[test]
fn indices_of_every_width() {
    check_indexed::<1>();
    check_indexed::<2>();
    check_indexed::<4>();
    check_indexed::<8>();
}

/// The bits that fill up a row's last byte name no texel, so they may hold anything.
#[test]
fn what_fills_up_a_row_is_no_index() {
    let indices = [0b0111_1111, 0b0000_0001];
    assert!(Indexed::<u8, 1>::new(&indices, &[5], 1, 2).is_ok());
    assert!(Indexed::<u8, 2>::new(&[0b0001_1111], &[5, 6], 2, 1).is_ok());
    assert!(Indexed::<u8, 4>::new(&[0x0f], &[5], 1, 1).is_ok());
    assert_eq!(
        Indexed::<u8, 4>::new(&[0x0f], &[], 1, 1).err(),
        Some(Error::PaletteIndex {
            column: 0,
            row: 0,
            index: 0,
            colours: 0
        })
    );
}

fn check_image<I>(image: I, at: impl Fn(u32, u32) -> I::Color)
where
    I: GetPixel + OriginDimensions + Copy,
    I::Color: Copy + Default + PartialEq + std::fmt::Debug,
{
    let size = image.size();
    let texels = ImageTexels::new(image).expect("sides that are powers of two");
    assert_eq!(
        texels.log2_size(),
        (size.width.ilog2(), size.height.ilog2())
    );
    for (column, row) in places(size.width, size.height) {
        let point = Point::new(column as i32, row as i32);
        let found = texels.texel(column, row);
        assert_eq!(Some(found), image.pixel(point), "{column}, {row}");
        assert_eq!(found, at(column, row), "{column}, {row}");
    }
}

#[test]
fn images_of_embedded_graphics_are_read_in_place() {
    let mut random = seeded(602);
    for (width, height) in sizes() {
        let count = (width * height) as usize;
        let data = bytes(&mut random, 3 * count);
        let number = |column, row| (row * width + column) as usize;
        let pair = |column, row| {
            let at = 2 * number(column, row);
            [data[at], data[at + 1]]
        };
        let rgb565 = |bits| Rgb565::from(RawU16::new(bits));

        let image = ImageRaw::<Rgb565, BigEndian>::new(&data[..2 * count], width);
        check_image(image, |x, y| rgb565(u16::from_be_bytes(pair(x, y))));
        let image = ImageRaw::<Rgb565, LittleEndian>::new(&data[..2 * count], width);
        check_image(image, |x, y| rgb565(u16::from_le_bytes(pair(x, y))));
        let image = ImageRaw::<Rgb888>::new(&data, width);
        check_image(image, |x, y| {
            let at = 3 * number(x, y);
            Rgb888::new(data[at], data[at + 1], data[at + 2])
        });
        let row = |bits: u32| (width * bits).div_ceil(8) as usize * height as usize;
        let image = ImageRaw::<Gray4>::new(&data[..row(4)], width);
        check_image(
            image,
            |x, y| Gray4::new(packed(&data, 4, width, x, y) as u8),
        );
        let ones = bytes(&mut random, row(1));
        let image = ImageRaw::<BinaryColor>::new(&ones, width);
        check_image(image, |x, y| {
            BinaryColor::from(packed(&ones, 1, width, x, y) == 1)
        });
    }
    // A row and a half: embedded-graphics leaves the half out.
    let short = ImageRaw::<Gray8>::new(&[0; 12], 8);
    assert_eq!(
        ImageTexels::new(short).err(),
        None,
        "8x1 is a size for a texture"
    );
    let short = ImageRaw::<Gray8>::new(&[0; 31], 8);
    assert_eq!(
        ImageTexels::new(short).err(),
        Some(Error::TextureSize {
            width: 8,
            height: 3
        })
    );
}

/// Column and row of a place along the curve: its bits alternate as long as both sides have some.
fn unwind(place: u32, width: u32, height: u32) -> (u32, u32) {
    let (mut column, mut row) = (0, 0);
    let (mut column_bit, mut row_bit) = (1, 1);
    let mut rest = place;
    while column_bit < width || row_bit < height {
        if column_bit < width {
            column += rest % 2 * column_bit;
            column_bit *= 2;
            rest /= 2;
        }
        if row_bit < height {
            row += rest % 2 * row_bit;
            row_bit *= 2;
            rest /= 2;
        }
    }
    (column, row)
}

#[test]
fn the_morton_curve_visits_every_texel_in_its_order() {
    for (width, height) in sizes().chain([(512, 128)]) {
        let rows: Vec<u32> = (0..width * height).collect();
        let mut arranged = vec![u32::MAX; rows.len()];
        let texture =
            Morton::arrange(&rows, &mut arranged, width, height).expect("that many texels");
        assert_eq!(texture.log2_size(), (width.ilog2(), height.ilog2()));
        for (column, row) in places(width, height) {
            assert_eq!(texture.texel(column, row), row * width + column);
        }
        for (place, &number) in (0..).zip(&arranged) {
            let (column, row) = unwind(place, width, height);
            assert_eq!(number, row * width + column, "{width}x{height}, {place}");
        }
    }
    let rows = [1u8; 16];
    let mut to = [9u8; 15];
    let wrong = Morton::arrange(&rows, &mut to, 4, 4).err();
    let (needed, given) = (16, 15);
    assert_eq!(wrong, Some(Error::BufferLength { needed, given }));
    let wrong = Morton::arrange(&rows[..15], &mut to, 4, 4).err();
    assert_eq!(wrong, Some(Error::BufferLength { needed, given }));
    let (width, height) = (5, 3);
    let wrong = Morton::arrange(&rows[..15], &mut to, width, height).err();
    assert_eq!(wrong, Some(Error::TextureSize { width, height }));
    assert_eq!(to, [9; 15]);
}

fn check_window<U: Wrap, V: Wrap>(random: &mut Rng) {
    let (columns, rows) = (64u32, 32u32);
    let numbers: Vec<u32> = (0..columns * rows).collect();
    let atlas = Texture::new(&numbers, columns, rows).expect("that many texels");
    for _ in 0..200 {
        let [width, height] = [6, 5].map(|most| 1u32 << random.random_range(0..=most));
        let left = random.random_range(0..=columns - width);
        let top = random.random_range(0..=rows - height);
        let window = Window::new(atlas, left, top, width, height).expect("inside the atlas");
        // The same texels, cut out.
        let cut: Vec<u32> = places(width, height)
            .map(|(x, y)| (top + y) * columns + left + x)
            .collect();
        let cut = Texture::new(&cut, width, height).expect("that many texels");
        for (x, y) in places(width, height) {
            assert_eq!(window.texel(x, y), cut.texel(x, y));
        }
        let window = Nearest::<_, U, V>::new(window);
        let cut = Nearest::<_, U, V>::new(cut);
        for _ in 0..50 {
            // Up to 4 repeats beyond, on both sides.
            let [u, v] = [0; 2].map(|_| random.random_range(-4 << 24..5 << 24));
            let uv = Uv::from_bits(u, v);
            assert_eq!(window.sample(uv), cut.sample(uv), "{width}x{height} {uv:?}");
        }
        let mut runs = [[0u32; 70]; 2];
        let step = Uv::from_bits(random.random_range(-1 << 20..1 << 20), 12_345);
        window.fill(Uv::default(), step, &mut runs[0]);
        cut.fill(Uv::default(), step, &mut runs[1]);
        assert_eq!(runs[0], runs[1]);
    }
}

#[test]
fn windows_are_textures_of_their_own() {
    let mut random = seeded(603);
    check_window::<Repeat, Repeat>(&mut random);
    check_window::<Clamp, Mirror>(&mut random);
    check_window::<Mirror, Clamp>(&mut random);
    check_window::<Repeat, Mirror>(&mut random);

    let numbers = [0u8; 128];
    let atlas = Texture::new(&numbers, 16, 8).expect("that many texels");
    assert!(Window::new(atlas, 8, 4, 8, 4).is_ok());
    for (left, top) in [
        (9, 4),
        (8, 5),
        (16, 0),
        (u32::MAX, 0),
        (0, u32::MAX),
        (u32::MAX - 7, 4),
    ] {
        assert_eq!(
            Window::new(atlas, left, top, 8, 4).err(),
            Some(Error::WindowOutOfRange { left, top })
        );
    }
    let (left, top) = (0, 0);
    assert_eq!(
        Window::new(atlas, left, top, 32, 8).err(),
        Some(Error::WindowOutOfRange { left, top })
    );
    for (width, height) in [(0, 1), (3, 4), (4, 6)] {
        assert_eq!(
            Window::new(atlas, left, top, width, height).err(),
            Some(Error::TextureSize { width, height })
        );
    }
}

/// A texel of a block as the Khronos Data Format Specification has it (section 18.1): in float64,
/// rounded to the nearest value of each channel, halves up.
fn bc1_texel(block: [u8; 8], column: u32, row: u32) -> [u32; 3] {
    let [color0, color1] = [0, 2].map(|at| u32::from(block[at]) + 256 * u32::from(block[at + 1]));
    let rgb = |colour: u32| [colour / 2048, colour / 32 % 64, colour % 32].map(f64::from);
    let (first, second) = (rgb(color0), rgb(color1));
    // Texel (i, j) has the bits 2 (4 j + i) and up of the 32-bit number.
    let bits = (0..4)
        .map(|i| u64::from(block[4 + i]) << (8 * i))
        .sum::<u64>();
    let code = bits / 4u64.pow(4 * (row % 4) + column % 4) % 4;
    let weights = match (code, color0 > color1) {
        (0, _) => [1.0, 0.0],
        (1, _) => [0.0, 1.0],
        (2, true) => [2.0 / 3.0, 1.0 / 3.0],
        (3, true) => [1.0 / 3.0, 2.0 / 3.0],
        (2, false) => [0.5, 0.5],
        _ => [0.0, 0.0],
    };
    [0, 1, 2].map(|k| {
        // Thirds are never near a half.
        (first[k] * weights[0] + second[k] * weights[1] + 0.5 + 1e-9).floor() as u32
    })
}

/// Blocks of any colours, of either order, and of equal ones.
fn blocks(random: &mut Rng, count: usize) -> Vec<[u8; 8]> {
    (0..count)
        .map(|_| {
            let mut block = [0; 8].map(|_: u8| random.random());
            match random.random_range(0..4) {
                0 => block.copy_within(0..2, 2),
                1 => (block[0], block[2]) = (255, 0),
                _ => {}
            }
            block
        })
        .collect()
}

#[test]
fn blocks_are_decoded_as_specified() {
    let mut random = seeded(604);
    for (width, height) in sizes() {
        let across = width.div_ceil(4);
        let count = (across * height.div_ceil(4)) as usize;
        assert_eq!(Bc1::blocks(width, height), count);
        let blocks = blocks(&mut random, count);
        let texture = Bc1::new(&blocks, width, height).expect("that many blocks");
        assert_eq!(texture.log2_size(), (width.ilog2(), height.ilog2()));
        for (column, row) in places(width, height) {
            let block = blocks[(row / 4 * across + column / 4) as usize];
            let [r, g, b, _] = texture.texel(column, row).split();
            assert_eq!(
                [r, g, b],
                bc1_texel(block, column, row),
                "{width}x{height}, {column}, {row}: {block:?}"
            );
        }
        for given in [count - 1, count + 1] {
            let other = vec![[0; 8]; given];
            let needed = count;
            assert_eq!(
                Bc1::new(&other, width, height).err(),
                Some(Error::BufferLength { needed, given })
            );
        }
    }
}

#[test]
fn runs_over_blocks_are_their_texels_one_by_one() {
    let mut random = seeded(605);
    for (width, height) in sizes() {
        let blocks = blocks(&mut random, Bc1::blocks(width, height));
        let texture = Bc1::new(&blocks, width, height).expect("that many blocks");
        let sampler = Nearest::<_, Repeat>::new(texture);
        for length in (0..70).step_by(3) {
            let [u, v] = [0; 2].map(|_| random.random());
            // From a stand-still to leaps of many blocks.
            let [du, dv] = [0; 2].map(|_| random.random::<i32>() >> random.random_range(0..32));
            let (uv, step) = (Uv::from_bits(u, v), Uv::from_bits(du, dv));
            let mark = Rgb565::new(1, 2, 3);
            let [mut filled, mut blocks] = [[mark; 70]; 2];
            texture.fill_repeating(uv, step, &mut filled[..length]);
            texture.fill_block_by_block(uv, step, &mut blocks[..length]);
            assert_eq!(filled, blocks, "{width}x{height} from {uv:?} by {step:?}");
            let mut at = uv;
            for &pixel in &filled[..length] {
                assert_eq!(pixel, sampler.sample(at));
                at = at + step;
            }
        }
    }
}

/// Levels of one size after the other, each of its own colour.
fn check_pyramid<T: Texels>(
    make: impl Fn(u32, u32, usize) -> Result<Pyramid<T>, Error>,
    length: impl Fn(u32, u32) -> usize,
) {
    for (width, height) in sizes() {
        let needed: usize = (0..levels(width, height))
            .map(|level| level_size(width, height, level))
            .map(|(width, height)| length(width, height))
            .sum();
        let pyramid = make(width, height, needed).expect("all levels");
        assert_eq!(pyramid.iter().count() as u32, levels(width, height));
        for (number, level) in (0..).zip(pyramid.iter()) {
            let (width, height) = level_size(width, height, number);
            assert_eq!(level.log2_size(), (width.ilog2(), height.ilog2()));
        }
        for beyond in [pyramid.last(), pyramid.last() + 1, 12, 13, u32::MAX] {
            assert_eq!(pyramid.level(beyond).log2_size(), (0, 0));
        }
        for given in [0, needed - 1, needed + 1] {
            let error = make(width, height, given).err();
            assert_eq!(error, Some(Error::BufferLength { needed, given }));
        }
    }
    for (width, height) in [(0, 0), (1, 3), (8192, 1), (u32::MAX, u32::MAX)] {
        let error = make(width, height, 1).err();
        assert_eq!(error, Some(Error::TextureSize { width, height }));
    }
}

#[test]
fn pyramids_have_all_levels_and_not_a_texel_more() {
    let area = |width, height| width as usize * height as usize;
    let texels = vec![0u16; 3 << 12];
    check_pyramid(
        |w, h, n| Pyramid::<Texture<'_, u16>>::new(&texels[..n], w, h),
        area,
    );
    check_pyramid(
        |w, h, n| Pyramid::<Morton<'_, u16>>::new(&texels[..n], w, h),
        area,
    );
    let indices = vec![0u8; 3 << 12];
    check_pyramid(
        |w, h, n| Pyramid::<Indexed<'_, u16, 2>>::new(&indices[..n], &texels[..4], w, h),
        Indexed::<u16, 2>::bytes,
    );
    let blocks = vec![[0u8; 8]; 3 << 12];
    check_pyramid(
        |w, h, n| Pyramid::<Bc1<'_>>::new(&blocks[..n], w, h),
        Bc1::blocks,
    );
    // An index beyond the palette in the last level.
    let mut indices = [0u8; 8 * 2 + 4 + 2 + 1];
    indices[22] = 3;
    assert_eq!(
        Pyramid::<Indexed<'_, u16, 8>>::new(&indices, &[1, 2, 3], 8, 2).err(),
        Some(Error::PaletteIndex {
            column: 0,
            row: 0,
            index: 3,
            colours: 3
        })
    );
}

/// Every texel's number can be told apart, so that levels cannot have been swapped or shifted.
#[test]
fn levels_lie_one_after_the_other() {
    let numbers: Vec<u32> = (0..3 << 12).collect();
    for (width, height) in sizes() {
        let count = multum::pyramid::texels(width, height);
        let pyramid =
            Pyramid::<Texture<'_, u32>>::new(&numbers[..count], width, height).expect("all levels");
        let mut next = 0;
        for level in pyramid.iter() {
            for (column, row) in places(level.width(), level.height()) {
                assert_eq!(level.texel(column, row), next);
                next += 1;
            }
        }
        assert_eq!(next as usize, count);
    }
}

#[test]
fn levels_put_together_by_hand() {
    let texels = [0u8; 64];
    let level = |width: u32, height: u32| {
        Texture::new(&texels[..(width * height) as usize], width, height).expect("a size")
    };
    let all = [level(8, 2), level(4, 1), level(2, 1), level(1, 1)];
    assert_eq!(Pyramid::from_levels(&all).expect("all levels").last(), 3);
    assert_eq!(
        Pyramid::from_levels(&all[3..]).expect("one level").last(),
        0
    );
    let needed = 4;
    for given in [1, 2, 3] {
        let error = Pyramid::from_levels(&all[..given]).err();
        let given = given as u32;
        assert_eq!(error, Some(Error::LevelsMissing { needed, given }));
    }
    let (needed, given) = (1, 0);
    assert_eq!(
        Pyramid::<Texture<'_, u8>>::from_levels(&[]).err(),
        Some(Error::LevelsMissing { needed, given })
    );
    let (needed, given) = (4, 5);
    let beyond = [all[0], all[1], all[2], all[3], all[3]];
    assert_eq!(
        Pyramid::from_levels(&beyond).err(),
        Some(Error::LevelsMissing { needed, given })
    );
    let given = 300;
    assert_eq!(
        Pyramid::from_levels(&[all[0]; 300]).err(),
        Some(Error::LevelsMissing { needed, given })
    );
    for (number, width, height) in [(1, 4, 2), (1, 8, 2), (2, 1, 1), (2, 2, 2), (3, 2, 1)] {
        let mut wrong = all;
        wrong[number] = level(width, height);
        let level = number as u32;
        assert_eq!(
            Pyramid::from_levels(&wrong).err(),
            Some(Error::LevelSize {
                level,
                width,
                height
            })
        );
    }
}

/// Sides that are fit and unfit.
fn side() -> impl Strategy<Value = u32> {
    prop_oneof![
        4 => (0..=6u32).prop_map(|log2| 1 << log2),
        1 => (0..=31u32).prop_map(|log2| 1 << log2),
        1 => 0..=40u32,
        1 => any::<u32>(),
        1 => prop::sample::select(vec![0, 4095, 4096, 4097, 8192, u32::MAX]),
    ]
}

/// Reads every texel, and some coordinates.
fn read_all<T: Texels>(made: Result<T, Error>, uv: Uv, step: Uv) -> bool {
    let Ok(texels) = made else {
        return false;
    };
    let (log2_width, log2_height) = texels.log2_size();
    for (column, row) in places(1 << log2_width, 1 << log2_height) {
        _ = texels.texel(column, row);
    }
    let mut run = [T::Colour::default(); 9];
    Nearest::<_, Repeat>::new(texels).fill(uv, step, &mut run);
    Nearest::<_, Clamp, Mirror>::new(texels).fill(uv, step, &mut run);
    true
}

proptest! {
    #![proptest_config(ProptestConfig {
        cases: 4_000,
        failure_persistence: None,
        rng_seed: proptest::test_runner::RngSeed::Fixed(82),
        ..ProptestConfig::default()
    })]

    /// Whatever sides and lengths are claimed: an error or a texture that can be read everywhere.
    #[test]
    fn any_sizes_and_any_data(
        (width, height) in (side(), side()),
        off in prop_oneof![4 => Just(0isize), 1 => -2..=2isize],
        data in prop::collection::vec(any::<u8>(), 64),
        colours in 0..=300usize,
        (left, top) in (side(), side()),
        (window_width, window_height) in (side(), side()),
        [u, v, du, dv] in any::<[i32; 4]>(),
    ) {
        let (uv, step) = (Uv::from_bits(u, v), Uv::from_bits(du, dv));
        let is_side = |side: u32| side.is_power_of_two() && side <= MAX_TEXTURE_SIZE;
        let fit = is_side(width) && is_side(height);
        // No more memory than a small texture takes, whatever is claimed.
        let length = |needed: usize| needed.min(1 << 14).saturating_add_signed(off);
        let cells = |needed: usize| -> Vec<u8> {
            data.iter().copied().cycle().take(length(needed)).collect()
        };
        let area = width as usize * height as usize;
        let texels = cells(area);
        let good = fit && texels.len() == area;
        let texture = Texture::new(&texels, width, height);
        prop_assert_eq!(read_all(texture, uv, step), good);
        prop_assert_eq!(read_all(Morton::new(&texels, width, height), uv, step), good);
        if let Ok(texture) = texture {
            let window = Window::new(texture, left, top, window_width, window_height);
            let inside = |first: u32, side: u32, all: u32| {
                is_side(side) && u64::from(first) + u64::from(side) <= u64::from(all)
            };
            let good = inside(left, window_width, width) && inside(top, window_height, height);
            prop_assert_eq!(read_all(window, uv, step), good);
        }
        let blocks: Vec<[u8; 8]> = texels.iter().map(|&t| [t; 8]).collect();
        _ = read_all(Bc1::new(&blocks, width, height), uv, step);
        let palette = vec![Gray8::new(1); colours];
        macro_rules! indexed {
            ($bits:literal) => {
                let needed = Indexed::<Gray8, $bits>::bytes(width, height);
                let indices = cells(needed);
                let made = Indexed::<_, $bits>::new(&indices, &palette, width, height);
                let good = fit && indices.len() == needed && colours >= 1 << $bits;
                prop_assert!(read_all(made, uv, step) || !good);
                _ = Pyramid::<Indexed<'_, _, $bits>>::new(&indices, &palette, width, height);
            };
        }
        indexed!(1);
        indexed!(2);
        indexed!(4);
        indexed!(8);
        for given in [texels.len(), multum::pyramid::texels(width, height)] {
            let all = cells(given);
            _ = Pyramid::<Texture<'_, _>>::new(&all, width, height);
            _ = Pyramid::<Morton<'_, _>>::new(&all, width, height);
        }
        _ = Pyramid::<Bc1<'_>>::new(&blocks, width, height);
        if !texels.is_empty() {
            let image = ImageRaw::<Gray8>::new(&texels, width.clamp(1, 4096));
            _ = read_all(ImageTexels::new(image), uv, step);
        }
    }
}

/// The raw value is what a format without fractions has to keep.
#[test]
fn a_block_of_one_colour_is_that_colour() {
    for bits in (0..=u16::MAX).step_by(77) {
        let [low, high] = bits.to_le_bytes();
        let block = [[
            low,
            high,
            low,
            high,
            0b0001_0001,
            0b0101_0101,
            0,
            0b1010_1010,
        ]];
        let texture = Bc1::new(&block, 4, 4).expect("one block");
        for (column, row) in places(4, 4) {
            assert_eq!(texture.texel(column, row).into_storage(), bits);
        }
    }
}

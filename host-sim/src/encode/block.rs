//! One block of BC1. The crate `texpresso` fits the colours; where it fails, a plain fit between two
//! of the block's own colours takes its place.
//!
//! It looks for the main axis of the colours by powers of their covariance, starting from white.
//! Colours on an axis at right angles to that, red and blue for instance, then become one.

use texpresso::{Algorithm, COLOUR_WEIGHTS_UNIFORM, Format, Params};

use super::OPAQUE_FROM;

/// Red, green, blue and alpha of 4x4 texels, row by row.
type Block = [[u8; 4]; 16];

/// The better of two fits. No texel that is opaque is given a transparent index.
pub(super) fn encoded(block: &Block) -> [u8; 8] {
    // All channels alike: a texture may be any data, and plain PSNR judges it.
    let params = Params {
        algorithm: Algorithm::ClusterFit,
        weights: COLOUR_WEIGHTS_UNIFORM,
        weigh_colour_by_alpha: false,
    };
    let mut fitted = [0; 8];
    // Texels that are masked out get index 3, which may be transparent: mask none.
    Format::Bc1.compress_block_masked(*block, 0xFFFF, params, &mut fitted);
    let plain = between_farthest(block);
    if error(block, &plain) < error(block, &fitted) {
        plain
    } else {
        fitted
    }
}

fn is_opaque(texel: &[u8; 4]) -> bool {
    texel[3] >= OPAQUE_FROM
}

/// Squared distance of two colours.
fn distance(a: &[u8; 4], b: &[u8; 4]) -> u32 {
    (0..3).map(|c| u32::from(a[c].abs_diff(b[c])).pow(2)).sum()
}

/// Squared error over the opaque texels.
fn error(block: &Block, encoded: &[u8; 8]) -> u32 {
    let decoded = Format::Bc1.decompress_block(encoded);
    let pairs = block.iter().zip(&decoded);
    pairs
        .filter(|(texel, _)| is_opaque(texel))
        .map(|(a, b)| distance(a, b))
        .sum()
}

/// The block between the two of its colours that are farthest apart.
fn between_farthest(block: &Block) -> [u8; 8] {
    let opaque: Vec<_> = block.iter().filter(|texel| is_opaque(texel)).collect();
    let pairs = || {
        opaque
            .iter()
            .flat_map(|a| opaque.iter().map(move |b| (a, b)))
    };
    let ends = pairs().max_by_key(|(a, b)| distance(a, b));
    let ends = ends.map_or([0; 2], |(a, b)| [rgb565(a), rgb565(b)]);
    // The larger end first means four colours, the smaller first three and transparent.
    let [low, high] = [ends[0].min(ends[1]), ends[0].max(ends[1])];
    let [first, second] = if opaque.len() == block.len() {
        [high, low]
    } else {
        [low, high]
    };
    let mut encoded = [0; 8];
    encoded[..2].copy_from_slice(&first.to_le_bytes());
    encoded[2..4].copy_from_slice(&second.to_le_bytes());
    // The four colours by number, as the decoder has them.
    encoded[4..].fill(0b11_10_01_00);
    let colours = Format::Bc1.decompress_block(&encoded);
    let index = |texel: &[u8; 4]| {
        if !is_opaque(texel) {
            return 3;
        }
        let usable = (0u8..4).filter(|&i| is_opaque(&colours[usize::from(i)]));
        let nearest = usable.min_by_key(|&i| distance(&colours[usize::from(i)], texel));
        nearest.unwrap_or(0)
    };
    for (row, texels) in encoded[4..].iter_mut().zip(block.as_chunks::<4>().0) {
        *row = (0..4).fold(0, |row, x| row | index(&texels[x]) << (2 * x));
    }
    encoded
}

/// Each channel rounded to the nearest value.
fn rgb565([r, g, b, _]: &[u8; 4]) -> u16 {
    let channel = |&value: &u8, max: u32| ((u32::from(value) * max + 127) / 255) as u16;
    channel(r, 31) << 11 | channel(g, 63) << 5 | channel(b, 31)
}

//! 1/w of corners that are nearly equally far, in words.

use fixed::types::I16F16;

use crate::arith::{leading_zeros, leading_zeros_from};
use crate::setup::magnitudes;

/// 1/w of three corners of which the second's and third's w differ from the first's by less than an eighth of it,
/// but for a factor that all have in common.
///
/// Each is the product of the other two corners' w, of which 16 bits count.
#[derive(Clone, Copy, Debug)]
pub(crate) struct NearDepths {
    /// The corners' w, of which the largest has 31 bits.
    pub(crate) w: [i32; 3],
    /// 1/w of the first corner: 17 bits.
    pub(crate) first: u32,
    /// By how much those of the others exceed it, in an eighth of its unit: below 2^20 / 7, off by 2^-15.8 of
    /// `8 first`.
    pub(crate) beyond: [i32; 2],
    /// With w as it is here, `first` is `w_b w_c 2^(zeros - 45)`.
    pub(crate) zeros: u32,
}

impl NearDepths {
    /// `None` for corners of more than one depth.
    #[inline]
    pub(crate) fn new(w: [I16F16; 3]) -> Option<Self> {
        let [a, b, c] = w.map(I16F16::to_bits);
        let up = leading_zeros((a | b | c).cast_unsigned()).wrapping_sub(1);
        let [a, b, c] = [a, b, c].map(|w| w << (up & 31));
        let [nearer_b, nearer_c] = [a.wrapping_sub(b), a.wrapping_sub(c)];
        if magnitudes([nearer_b, nearer_c, 0, 0]) >= (a >> 3).cast_unsigned() {
            return None;
        }
        let [short_b, short_c] = [b >> 15, c >> 15];
        let product = short_b.wrapping_mul(short_c).cast_unsigned();
        let zeros = leading_zeros_from(0, product);
        // The products are below 2^31.
        let down = 14u32.wrapping_sub(zeros) & 31;
        Some(Self {
            w: [a, b, c],
            first: product << (zeros & 31) >> 15,
            beyond: [
                (nearer_b >> 13).wrapping_mul(short_c) >> down,
                (nearer_c >> 13).wrapping_mul(short_b) >> down,
            ],
            zeros,
        })
    }
}

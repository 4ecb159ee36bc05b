//! The mean of four texels, channel by channel, as it is stored or as light. Integers, and `const`,
//! so that the compiler, a chip and a PC build the same pyramid.

use crate::colour::{Channel, Colour};

/// How texels are averaged.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum Average {
    /// The mean of the numbers as they are stored, rounded to the nearest, halves up: what OpenGL
    /// implementations do for textures that are not sRGB.
    #[default]
    Stored,
    /// The mean of the light that the numbers stand for, if they are sRGB (IEC 61966-2-1), and of
    /// alpha as it is stored. Means of stored numbers are too dark where texels differ much.
    Light,
}

/// Linear light of 8-bit sRGB values, 16 bits: `((v / 255 + 0.055) / 1.055)^2.4`, or `v / 255 /
/// 12.92` up to 10, rounded to the nearest.
static LIGHT: [u16; 256] = {
    let mut table = [0; 256];
    let mut value = 0;
    while value < table.len() {
        table[value] = light(value as u128);
        value += 1;
    }
    table
};

/// The root is avoided: `y = x^(12/5)` where `y^5 = x^12`.
const fn light(value: u128) -> u16 {
    if value <= 10 {
        // 65535 v / (255 * 12.92)
        return ((65535 * 100 * value + 255 * 1292 / 2) / (255 * 1292)) as u16;
    }
    // x = (1000 v + 55 * 255) / (1055 * 255), and its powers, with 60 fraction bits.
    let x = ((1000 * value + 55 * 255) << 60) / (1055 * 255);
    let x2 = (x * x) >> 60;
    let x4 = (x2 * x2) >> 60;
    let x8 = (x4 * x4) >> 60;
    let x12 = (x8 * x4) >> 60;
    // The largest y with (y - 1/2)^5 <= 65535^5 x^12; both sides are taken 2^5 times, so that they
    // are whole.
    let limit = {
        let full: u128 = 65535;
        let five = full * full * full * full * full;
        ((five >> 30) * x12) >> 25
    };
    let (mut low, mut high) = (0u128, 65535u128);
    while low < high {
        let y = (low + high).div_ceil(2);
        let twice = 2 * y - 1;
        if twice * twice * twice * twice * twice <= limit {
            low = y;
        } else {
            high = y - 1;
        }
    }
    low as u16
}

/// An n-bit value as the nearest 8-bit one, n from 1 to 8.
const fn to_8_bits(value: u32, bits: u32) -> u32 {
    match bits {
        8 => value,
        // Without a division, which many chips lack; the same (see the test).
        6 => (value * 259 + 33) >> 6,
        5 => (value * 527 + 23) >> 6,
        _ => to_8_bits_by_division(value, bits),
    }
}

const fn to_8_bits_by_division(value: u32, bits: u32) -> u32 {
    let most = (1u32 << (bits & 31)).wrapping_sub(1);
    match (value * 510 + most).checked_div(2 * most) {
        Some(value) => value,
        None => 0,
    }
}

/// The light of an n-bit value.
const fn light_of(value: u32, bits: u32) -> u32 {
    let value = to_8_bits(value, bits);
    LIGHT[(value & 255) as usize] as u32
}

/// The mean of four values of a channel of some bits, 1 to 8.
#[must_use]
pub const fn mean(values: [u32; 4], channel: Channel, average: Average) -> u32 {
    let [a, b, c, d] = values;
    match average {
        Average::Light if !channel.is_alpha => {
            let bits = channel.bits;
            let sum = light_of(a, bits) + light_of(b, bits) + light_of(c, bits) + light_of(d, bits);
            stored((sum + 2) >> 2, bits)
        }
        _ => (a + b + c + d + 2) >> 2,
    }
}

/// The n-bit value whose light is nearest to `light`, of two equally near ones the larger.
const fn stored(light: u32, bits: u32) -> u32 {
    let (mut low, mut high) = (0, (1u32 << (bits & 31)).wrapping_sub(1));
    while low < high {
        // The largest value that is not farther than the one below it.
        let value = (low + high).div_ceil(2);
        if light_of(value - 1, bits) + light_of(value, bits) <= 2 * light {
            low = value;
        } else {
            high = value - 1;
        }
    }
    low
}

/// The mean of four texels.
#[must_use]
pub fn mean_colour<C: Colour>(texels: [C; 4], average: Average) -> C {
    C::by_channel(texels, |channel, values| mean(values, channel, average))
}

#[cfg(test)]
mod tests {
    extern crate std;

    use super::*;

    #[test]
    fn light_is_that_of_the_standard() {
        for (value, &light) in LIGHT.iter().enumerate() {
            let v = value as f64 / 255.0;
            let exact = if v <= 0.04045 {
                v / 12.92
            } else {
                ((v + 0.055) / 1.055).powf(2.4)
            };
            let off = f64::from(light) - exact * 65535.0;
            assert!(off.abs() <= 0.500_001, "{value}: {light}, off by {off}");
        }
    }

    #[test]
    fn eight_bits_without_division_are_the_same() {
        for bits in 1..=8 {
            for value in 0..1u32 << bits {
                assert_eq!(to_8_bits(value, bits), to_8_bits_by_division(value, bits));
            }
        }
    }

    #[test]
    fn equal_values_stay() {
        for bits in [1, 2, 4, 5, 6, 8] {
            for value in 0..1u32 << bits {
                for average in [Average::Stored, Average::Light] {
                    let channel = Channel {
                        bits,
                        is_alpha: false,
                    };
                    assert_eq!(mean([value; 4], channel, average), value, "{bits} bits");
                }
            }
        }
    }

    /// Black and white in equal parts: 188, not 128 (the textbook example).
    #[test]
    fn light_is_brighter_than_stored_numbers() {
        let channel = Channel {
            bits: 8,
            is_alpha: false,
        };
        assert_eq!(mean([0, 255, 255, 0], channel, Average::Light), 188);
        assert_eq!(mean([0, 255, 255, 0], channel, Average::Stored), 128);
        let alpha = Channel {
            bits: 8,
            is_alpha: true,
        };
        assert_eq!(mean([0, 255, 255, 0], alpha, Average::Light), 128);
    }
}

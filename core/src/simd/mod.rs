//! Eight pixels at a time, in registers of 128 bits. A leaf.
//!
//! Every x86-64 has them, and a PC is where scenes are tried before they run on a microcontroller. On other processors
//! pixels come one by one: what is here is there for tests alone, which compare both.

#[cfg(any(test, not(all(target_arch = "x86_64", target_feature = "sse2"))))]
mod portable;
#[cfg(all(target_arch = "x86_64", target_feature = "sse2"))]
mod sse2;

#[cfg(not(all(target_arch = "x86_64", target_feature = "sse2")))]
pub(crate) use portable::{LongWalk, U16x8, U32x8, U64x8, Walk};
#[cfg(all(target_arch = "x86_64", target_feature = "sse2"))]
pub(crate) use sse2::{LongWalk, U16x8, U32x8, U64x8, Walk};

/// Whether it is faster: whether there are such registers.
pub(crate) const EIGHTS: bool = cfg!(all(target_arch = "x86_64", target_feature = "sse2"));

/// How many pixels that is.
pub(crate) const COUNT: usize = 8;

#[cfg(test)]
mod tests {
    use super::*;

    /// Numbers, extremes among them more often than by chance.
    fn numbers() -> impl FnMut() -> u32 {
        let mut state = 3u32;
        move || {
            state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            match state >> 29 {
                0 => 0,
                1 => u32::MAX,
                _ => state ^ state >> 15,
            }
        }
    }

    /// In registers or number by number, those of 32 and 64 bits.
    #[test]
    fn both_ways_give_the_same_bits_of_long_numbers() {
        let mut next = numbers();
        for _ in 0..20_000 {
            let [first, step, other, mask] = [0; 4].map(|_| next());
            let x = Walk::new(first, step).next_words();
            let p = portable::Walk::new(first, step).next_words();
            assert_eq!(x.array(), p.array());
            let y = Walk::new(other, first).next_words();
            let q = portable::Walk::new(other, first).next_words();
            assert_eq!(x.plus(y).array(), p.plus(q).array());
            assert_eq!(x.minus(y).array(), p.minus(q).array());
            assert_eq!(x.or(y).array(), p.or(q).array());
            assert_eq!(x.and(mask).array(), p.and(mask).array());
            assert_eq!(x.lower_halves(), p.lower_halves());
            for bits in 0..=32 {
                assert_eq!(x.down_by(bits).array(), p.down_by(bits).array(), "{bits}");
                assert_eq!(x.up(bits).array(), p.up(bits).array(), "{bits}");
            }
            for weight in [0, 1, 2, 3, 2047, 4095, 4096, first % 4097] {
                let of_17_bits = (x.and(0x1_ffff), y.and(0x1_ffff));
                let same = (p.and(0x1_ffff), q.and(0x1_ffff));
                let found = of_17_bits.0.lerp(of_17_bits.1, weight).array();
                assert_eq!(found, same.0.lerp(same.1, weight).array(), "{weight}");
            }
            assert_eq!(x.twice().array(), p.twice().array());
            let long = |upper, lower| u64::from(upper) << 32 | u64::from(lower);
            let (from, by) = (long(first, other), long(step, mask));
            let (mut walk, mut same) = (LongWalk::new(from, by), portable::LongWalk::new(from, by));
            for _ in 0..2 {
                let (x, p) = (walk.next(), same.next());
                assert_eq!(x.array(), p.array());
                let numbers = x.array().map(|number| number.rotate_left(other % 64));
                let (y, q) = (U64x8::new(numbers), portable::U64x8::new(numbers));
                assert_eq!(y.array(), numbers);
                assert_eq!(x.plus(y).array(), p.plus(q).array());
                assert_eq!(x.minus(y).array(), p.minus(q).array());
                assert_eq!(x.xor(y).array(), p.xor(q).array());
                assert_eq!(x.times(y).array(), p.times(q).array());
                assert_eq!(x.up::<31>().array(), p.up::<31>().array());
                assert_eq!(x.down::<32>().array(), p.down::<32>().array());
                assert_eq!(x.uppers_twice().array(), p.uppers_twice().array());
                assert_eq!(x.uppers().array(), p.uppers().array());
            }
            let (x, p) = (U64x8::splat(from), portable::U64x8::splat(from));
            assert_eq!(x.array(), p.array());
            let (x, p) = (U32x8::splat(first), portable::U32x8::splat(first));
            assert_eq!(x.array(), p.array());
        }
    }

    /// The same of those of 16.
    #[test]
    fn both_ways_give_the_same_bits() {
        let mut next = numbers();
        let mut above = 0;
        for round in 0..20_000 {
            let [first, step] = [0; 2].map(|_| next());
            let mut walk = Walk::new(first, step);
            let mut same = portable::Walk::new(first, step);
            for eight in 0..3 {
                let up = next() % 13;
                assert_eq!(
                    walk.tops(up).array(),
                    same.tops(up).array(),
                    "{first:x} {up}"
                );
                let tops = walk.next().array();
                assert_eq!(tops, same.next().array(), "{first:x} {step:x} {eight}");
            }
            let [mut a, b] = [0; 2].map(|_| [0; COUNT].map(|_| next() as u16));
            if round % 4 == 0 {
                // All greater, or all but one, or all but one that is equal.
                a = b.map(|number| number.saturating_add(1 + (next() as u16 >> 8)));
                let place = next() as usize % COUNT;
                a[place] = a[place].min(b[place]).max(next() as u16 & b[place]);
                a[place] = a[place].saturating_add((round >> 2 & 1) as u16);
            }
            let [x, y] = [a, b].map(U16x8::new);
            let [p, q] = [a, b].map(portable::U16x8::new);
            assert_eq!(x.array(), a);
            let of_number = |number: u16| number.wrapping_mul(40_503) ^ first as u16;
            assert_eq!(x.through(of_number).array(), a.map(of_number));
            assert_eq!(p.through(of_number).array(), a.map(of_number));
            assert_eq!(U16x8::splat(a[0]).array(), [a[0]; COUNT]);
            assert_eq!(portable::U16x8::splat(a[0]).array(), [a[0]; COUNT]);
            assert_eq!(x.or(y).array(), p.or(q).array());
            assert_eq!(x.plus(y).array(), p.plus(q).array());
            assert_eq!(x.minus(y).array(), p.minus(q).array());
            assert_eq!(x.times(y).array(), p.times(q).array());
            assert_eq!(x.times_high(y).array(), p.times_high(q).array());
            let [small, less] = [a, b].map(|numbers| numbers.map(|number| number & 0x7ff));
            let dot = |pair: [U16x8; 2]| U16x8::dot(pair, [small, less].map(U16x8::new));
            let sum = dot([x.down(10), y.down(10)]).plus(U32x8::splat(first >> 20));
            let dot = |pair| portable::U16x8::dot(pair, [small, less].map(portable::U16x8::new));
            let same = dot([p.down(10), q.down(10)]).plus(portable::U32x8::splat(first >> 20));
            assert_eq!(sum.down::<11>().array(), same.down::<11>().array());
            for weight in [0, 1, 2, 3, 2047, 4095, 4096, round % 4097] {
                assert_eq!(
                    x.lerp(y, weight).array(),
                    p.lerp(q, weight).array(),
                    "{a:?} {b:?} {weight}"
                );
            }
            assert_eq!(x.is_above(y), p.is_above(q), "{a:?} {b:?}");
            above += u32::from(x.is_above(y));
            for bits in 0..=16 {
                let mask = next() as u16;
                assert_eq!(x.and(mask).array(), p.and(mask).array());
                assert_eq!(x.up(bits).array(), p.up(bits).array(), "{a:?} {bits}");
                assert_eq!(x.down(bits).array(), p.down(bits).array(), "{a:?} {bits}");
            }
            let weights = b.map(|number| number % 33);
            let of_a_byte = |numbers: [u16; COUNT]| numbers.map(|number| number & 0xff);
            let [a, b] = [a, b].map(of_a_byte);
            let mixed = U16x8::new(a).to(U16x8::new(b), U16x8::new(weights)).array();
            for (number, mixed) in mixed.into_iter().enumerate() {
                let [a, b, weight] = [a, b, weights].map(|all| i32::from(all[number]));
                let expected = (a * (32 - weight) + b * weight + 16) >> 5;
                assert_eq!(i32::from(mixed), expected, "{a} {b} {weight}");
            }
            let [p, q, weights] = [a, b, weights].map(portable::U16x8::new);
            assert_eq!(mixed, p.to(q, weights).array());
        }
        assert!((500..10_000).contains(&above), "{above}");
    }
}

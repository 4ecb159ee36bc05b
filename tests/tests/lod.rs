//! Level of detail against exact arithmetic: lambda itself, the levels that it selects, and where
//! along a span it is taken.

use std::cell::Cell;

use host_sim::reference::lod::{self, Choice as Choices, Rule as Rules};
use host_sim::reference::{Corners, Planes, Sample};
use multum::colour::BLEND_BITS;
use multum::depth::Z16;
use multum::draw::Pipeline;
use multum::embedded_graphics::pixelcolor::{Gray8, GrayColor as _};
use multum::filter::NearestTexel;
use multum::fixed::types::{I16F16, I24F8};
use multum::lod::footprint::{Footprint, FootprintWords, Lambdas as _, SmallFootprint};
use multum::lod::{
    Choice, Chosen, EachPiece, EachPixel, EachSpan, EachTriangle, Euclidean, FinestLevel,
    LinearLevels, Lod, LongestAxis, NearestLevel, Piece, Rate, Rule, SafestLevel, Selection,
};
use multum::mipmap::Mipmapped;
use multum::perspective::{Affine, Every, PerPixel, Strategy};
use multum::project::ScreenVertex;
use multum::pyramid::{Pyramid, level_size, levels};
use multum::setup::{Cull, TriangleSetup};
use multum::shade::{Shader, ShaderRow as _};
use multum::sink::Band;
use multum::span::{Area, Span, for_each_span};
use multum::texture::Texture;
use multum::uv::Uv;
use rand::Rng as _;
use tests::random::{Rng, seeded};

/// One level.
const ONE: i32 = 1 << 16;

/// A screen of the size that the guard band leaves.
const SCREEN: Area = Area {
    width: 640,
    top: 0,
    bottom: 480,
};

fn power(e: i32) -> f64 {
    f64::from(e).exp2()
}

/// A triangle's mapping in integers: what the derivatives are made of, without rounding.
///
/// With shares `s_i = e_i / D` (`e_i` being the edge functions, D their sum) let `Q = sum s_i / w_i`
/// and `U = sum s_i u_i / w_i`; u is U / Q. The quotient rule gives
/// `du/dx = sum over k of (u_i - u_j) w_k (y - y_k) D W / B^2`, where `W = w_0 w_1 w_2`,
/// `B = sum e_i w_j w_k = D Q W`, and i and j follow k; `du/dy` has `x_k - x` for `y - y_k`.
struct Exact {
    position: [[i128; 2]; 3],
    w: [i128; 3],
    uv: [[i128; 2]; 3],
    size: [f64; 2],
    rho: f64,
}

/// Lambda, and by how much more than its logarithms the core's may be off either way.
struct Lambda {
    exact: f64,
    below: f64,
    above: f64,
}

impl Exact {
    fn new(vertices: &[ScreenVertex; 3], log2_size: (u32, u32)) -> Self {
        let w = vertices.map(|v| i128::from(v.w().to_bits()));
        let [most, least] = [w.iter().max(), w.iter().min()].map(|w| *w.expect("three") as f64);
        Self {
            position: vertices.map(|v| [v.x(), v.y()].map(|c| i128::from(c.to_bits()))),
            w,
            uv: vertices.map(|v| v.uv().map(|c| i128::from(c.to_bits()))),
            size: [log2_size.0, log2_size.1].map(|log2| power(log2 as i32)),
            rho: most / least,
        }
    }

    fn twice_area(&self) -> i128 {
        let [a, b, c] = self.position;
        (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])
    }

    /// `(u_i - u_j) w_k` for each k.
    fn weights(&self, axis: usize) -> [i128; 3] {
        [0, 1, 2].map(|k| {
            let (i, j) = ((k + 1) % 3, (k + 2) % 3);
            (self.uv[i][axis] - self.uv[j][axis]) * self.w[k]
        })
    }

    /// D Q W at a point in subpixels.
    fn denominator(&self, p: [i128; 2]) -> i128 {
        (0..3)
            .map(|k| {
                let (a, b) = (self.position[(k + 1) % 3], self.position[(k + 2) % 3]);
                let edge = (b[0] - a[0]) * (p[1] - a[1]) - (b[1] - a[1]) * (p[0] - a[0]);
                edge * self.w[(k + 1) % 3] * self.w[(k + 2) % 3]
            })
            .sum()
    }

    /// Lambda from the numerators at `p / scale` subpixels, `moved` subpixels from where the core
    /// takes them, and the denominator D Q W.
    ///
    /// The core's numerators come from weights `m_k = q_i q_j (u_i - u_j)` whose q are off by
    /// 2^-29 for the reciprocal and rho 2^-31 for the shared exponent, so the weights by twice
    /// that; they are cut to 2^32 units of q squared, of which the nearest corner has 2^60 or
    /// more, times 2^-16 repeats of 4096 texels, and, if they have more than 41 bits, to 2^-40 of the largest. What the
    /// parts of the sum are off adds up, while the sum itself may be small: in slivers.
    ///
    /// The plane of 1/w is off by 2^-29 and rho 2^-31 for the corners, by rho 2^-29 for the area,
    /// and by 2^-11 units of the 2^30 / rho that it has or more; it counts twice.
    ///
    /// In words ([`FootprintWords`]) all are off by up to 3 and a 16th units: of the largest weight times the longest side, of which 2^b w and 2^c s in bits leave
    /// a unit of 2^(b + c + 3 - 31), so less than w s 2^-26; of twice a unit of the sums where those have
    /// few bits; and of the 2^29 / rho that 1/w has or more.
    fn lambda(
        &self,
        p: [i128; 2],
        scale: i128,
        moved: f64,
        b: i128,
        is_euclidean: bool,
        words: f64,
    ) -> Lambda {
        let words = words * (3.0 + 1.0 / 16.0);
        let corner = power(-29) + self.rho * power(-31);
        let plane = corner + self.rho * (power(-29) + power(-41) + words * power(-29));
        let side = (1..3)
            .flat_map(|k| [0, 1].map(|axis| self.position[k][axis] - self.position[0][axis]))
            .fold(0, |most, n| most.max(n.unsigned_abs())) as f64;
        let w: f64 = self.w.iter().map(|&w| w as f64).product();
        let least = self
            .w
            .iter()
            .fold(f64::MAX, |least, &w| least.min(w as f64));
        // From the sums below to texels a pixel.
        let d = self.twice_area().unsigned_abs() as f64;
        let unit = d * w / (b as f64).powi(2) / 65536.0 * 256.0;
        let mut length = [[0.0f64; 2]; 2];
        let mut off = [[0.0f64; 2]; 2];
        let all = [0, 1].map(|axis| self.weights(axis));
        // A unit of m as a unit of `(u_i - u_j) w_k` in texels, that is times W; it is lost
        // once, and once more, or half of it, where a texture has fewer than 4096 texels.
        let unit_of_m = w / least.powi(2) * power(32 + 12 - 60);
        let largest = (0..2)
            .flat_map(|axis| all[axis].map(|m| m.unsigned_abs() as f64 * self.size[axis]))
            .fold(0.0, f64::max);
        for axis in [0, 1] {
            let weights = all[axis];
            let cut = 1.5 * unit_of_m + largest * power(-40);
            for (along, other) in [(0, 1), (1, 0)] {
                let terms: [i128; 3] =
                    [0, 1, 2].map(|k| weights[k] * (p[other] - scale * self.position[k][other]));
                let sum = terms.iter().sum::<i128>() as f64 / scale as f64;
                let parts: f64 = [0, 1, 2]
                    .map(|k| {
                        let far = (p[other] as f64 / scale as f64 - self.position[k][other] as f64)
                            .abs()
                            + moved;
                        let weight = weights[k].unsigned_abs() as f64 * self.size[axis];
                        (2.0 * corner * weight + cut) * far
                    })
                    .iter()
                    .sum();
                let slope = weights.iter().sum::<i128>().unsigned_abs() as f64 * self.size[axis];
                length[along][axis] = (sum * unit * self.size[axis]).abs();
                let in_words = words * (largest * side * power(-26) + 2.0 * unit_of_m);
                off[along][axis] = (parts + slope * moved + in_words) * unit;
            }
        }
        let rho = |[u, v]: [f64; 2]| if is_euclidean { u.hypot(v) } else { u.max(v) };
        let exact = rho(length[0]).max(rho(length[1]));
        let off = rho(off[0]).max(rho(off[1]));
        Lambda {
            exact: exact.log2(),
            // All of a sum may be lost: then nothing is known below.
            below: -(1.0 - off / exact).max(0.0).log2() + 2.0 * (1.0 + plane).log2(),
            above: (1.0 + off / exact).log2() - 2.0 * (1.0 - plane).log2(),
        }
    }

    fn at(&self, x: i32, y: i32, is_euclidean: bool, are_words: bool) -> Lambda {
        let p = [x, y].map(|c| 256 * i128::from(c) + 128);
        let words = f64::from(u8::from(are_words));
        self.lambda(p, 1, 0.0, self.denominator(p), is_euclidean, words)
    }

    /// At the mean of the corners, for which the core takes the nearest lower subpixel; Q is the
    /// mean of the corners' there.
    fn at_mean(&self, is_euclidean: bool) -> Lambda {
        let sum = [0, 1].map(|axis| self.position.iter().map(|p| p[axis]).sum::<i128>());
        let [a, b, c] = self.w;
        let q = self.twice_area() * (b * c + c * a + a * b) / 3;
        self.lambda(sum, 3, 2.0 / 3.0, q, is_euclidean, 0.0)
    }
}

/// Checks a lambda of the core.
///
/// Logarithms are low by up to 7.9e-5. That of the numerators counts once, or, of a sum of squares,
/// half and with what halving cuts off, 2^-17; those of the area and, twice, of 1/w count the other way.
fn check_lambda(found: i32, expected: &Lambda, what: &dyn Fn() -> String) {
    const LOW: f64 = 7.9e-5;
    let off = f64::from(found) / f64::from(ONE) - expected.exact;
    let Lambda { below, above, .. } = expected;
    assert!(
        -LOW - below <= off && off <= 3.0 * LOW + above,
        "{}: {found} is off by {off} where {below} below or {above} above are allowed beside the \
         logarithms",
        what()
    );
}

#[derive(Clone, Copy, Debug)]
struct Case {
    vertices: [ScreenVertex; 3],
    log2_size: (u32, u32),
}

/// Triangles of all shapes and sizes, in depths of ratio 1:1 to 1:4096, with from no to 127
/// repeats of textures from 1x1 to 4096x4096.
fn case(random: &mut Rng, number: usize) -> Case {
    let size = [2, 40, 300, 1_400][number % 4] * 256;
    let ratio = [1.0f64, 1.001, 1.1, 4.0, 64.0, 256.0, 4096.0][number % 7];
    let span = [0, 1, 256, 65_536, 16 * 65_536, 127 * 65_536][number / 7 % 6];
    let base = [0.004, 0.3, 1.0, 7.5][number / 4 % 4];
    let middle = [320, 240].map(|c| c * 256 + random.random_range(-20_000..=20_000));
    let direction: f64 = random.random_range(0.0..std::f64::consts::TAU);
    let mut corner = 0;
    let vertices = [0; 3].map(|_| {
        corner += 1;
        let [x, y] = if number.is_multiple_of(3) {
            // A sliver: along a line, give or take a pixel.
            let along = f64::from(random.random_range(-size / 2..=size / 2));
            [direction.cos(), direction.sin()]
                .map(|c| (c * along) as i32 + random.random_range(-200..=200))
        } else {
            [0; 2].map(|_| random.random_range(-size / 2..=size / 2))
        };
        let [x, y] = [middle[0] + x, middle[1] + y].map(|c| c.clamp(-tests::GUARD, tests::GUARD));
        // The whole ratio is used: one corner near, one far.
        let w = base
            * match corner {
                1 => 1.0,
                2 => ratio,
                _ => random.random_range(0.0..=ratio.ln()).exp(),
            };
        let low = -span / 2;
        let uv = [0; 2].map(|_| I16F16::from_bits(random.random_range(low..=low + span)));
        let [x, y] = [x, y].map(I24F8::from_bits);
        ScreenVertex::new(x, y, I16F16::from_num(w), uv).expect("a vertex in range")
    });
    let log2_size = match number % 5 {
        0 => (12, 12),
        1 => (0, 0),
        _ => (random.random_range(0..=12), random.random_range(0..=12)),
    };
    Case {
        vertices,
        log2_size,
    }
}

/// Up to some spans of a triangle, evenly spread.
fn spans(vertices: &[ScreenVertex; 3], most: usize) -> Vec<Span> {
    let mut all = Vec::new();
    let Some(setup) = TriangleSetup::new(vertices, Cull::Off) else {
        return all;
    };
    for_each_span(&setup, SCREEN, |span| all.push(span));
    let each = all.len().div_ceil(most).max(1);
    all.into_iter().step_by(each).collect()
}

fn check_rule(rule: impl Rule, is_euclidean: bool) {
    let mut random = seeded(701);
    let (mut pixels, mut near, mut triangles, mut flat) = (0, 0, 0, 0);
    for number in 0..6_000 {
        let case = case(&mut random, number);
        let Some(setup) = TriangleSetup::new(&case.vertices, Cull::Off) else {
            continue;
        };
        let footprint = Footprint::new(&setup, case.log2_size);
        let exact = Exact::new(&case.vertices, case.log2_size);
        let mean = footprint.lambda_of_mean(&setup, rule);
        let words = FootprintWords::any(&setup, case.log2_size);
        let uv = case.vertices.map(|v| v.uv());
        if uv[0] == uv[1] && uv[1] == uv[2] {
            // Nothing changes: below every level, bias or not.
            assert!(mean < -500 * ONE, "{case:?}: {mean}");
            flat += 1;
            for span in spans(&case.vertices, 10) {
                let found = footprint.row(span, rule).lambda(0);
                let in_words = words.row(span, rule).lambda(0);
                assert!(found.max(in_words) < -500 * ONE, "{case:?}: {found}");
            }
            continue;
        }
        triangles += 1;
        let what = || format!("mean of {case:?}");
        check_lambda(mean, &exact.at_mean(is_euclidean), &what);
        for span in spans(&case.vertices, 12) {
            let row = footprint.row(span, rule);
            let line = words.row(span, rule);
            let last = span.left.abs_diff(span.right) - 1;
            for offset in [0, last / 3, last / 2, last] {
                let x = span.left.wrapping_add_unsigned(offset);
                for (found, are_words) in [(row.lambda(offset), false), (line.lambda(offset), true)]
                {
                    let expected = exact.at(x, span.y, is_euclidean, are_words);
                    let what = || format!("{x}, {} of {case:?}, words: {are_words}", span.y);
                    check_lambda(found, &expected, &what);
                    pixels += 1;
                    if expected.exact > -4.0 {
                        // Logarithms included, wherever it can matter: down to a 16th of a texel a
                        // pixel.
                        let most = expected.below.max(expected.above) + 3.0 * 7.9e-5;
                        assert!(most < 1.0 / 256.0, "{}: {most}", what());
                        near += 1;
                    }
                }
            }
        }
    }
    assert!(pixels > 100_000 && triangles > 4_000 && flat > 300);
    assert!(near > 60_000, "{near} of {pixels}");
}

/// What a small triangle's derivatives are made of, at `p / scale` subpixels, `moved` subpixels from where the
/// core takes them, and the denominator D Q W.
///
/// With A the affine numerators, `e_k = w_k - w_0`, s the longest side of the box and m the largest A, the
/// numerators are off by
///
/// | bound | from |
/// |---|---|
/// | 2^-14 m w_0 | A has 15 bits, or is cut to a unit of the larger side's texels |
/// | 2^-12.6 of the sum of `e_k (u_i - u_j) (y - y_k)` | w_0 has 14 bits, or 12.6, and what it lacks is added to all of the sum |
/// | 2^-16.6 w_0 of the sum of `(u_i - u_j) (y - y_k)` | e has units of 2^-17 of the largest w |
/// | 2 s 2^-12.6 w_0, and of m 2^-14 where that is more | products of e are cut to a unit of `2^-14 w_0` times what A is cut to |
///
/// 1/w is off by 2^-15.6 for the corners and 33 2^-24.8 for the plane; see `host_sim::bound`. That of the first corner,
/// of products of 16 bits and cut to 17, is less by up to 2^-14.4, which counts once.
fn small(
    exact: &Exact,
    [p, scale]: [[i128; 2]; 2],
    moved: f64,
    b: i128,
    is_euclidean: bool,
) -> Lambda {
    let two_to = |e: f64| e.exp2();
    let at = |axis: usize, from: i128| (p[axis] - scale[0] * from) as f64 / scale[0] as f64;
    let [w, ..] = exact.w.map(|w| w as f64);
    let all_w: f64 = exact.w.iter().map(|&w| w as f64).product();
    let unit =
        exact.twice_area().unsigned_abs() as f64 * all_w / (b as f64).powi(2) / 65536.0 * 256.0;
    // u_i - u_j for each corner k.
    let differences = [0, 1].map(|axis| {
        [0, 1, 2].map(|k| (exact.uv[(k + 1) % 3][axis] - exact.uv[(k + 2) % 3][axis]) as f64)
    });
    let sides = [0, 1].map(|axis| {
        let of = exact.position.map(|p| p[axis]);
        (of.iter().max().expect("three") - of.iter().min().expect("three")) as f64
    });
    let side = sides[0].max(sides[1]);
    let most_size = exact.size[0].max(exact.size[1]);
    let mut affine = 0.0f64;
    for axis in [0, 1] {
        for other in [0, 1] {
            let a: f64 = [0, 1, 2]
                .map(|k| differences[axis][k] * -(exact.position[k][other] as f64))
                .iter()
                .sum();
            affine = affine.max(a.abs() * exact.size[axis]);
        }
    }
    let (mut length, mut off) = ([[0.0f64; 2]; 2], [[0.0f64; 2]; 2]);
    for axis in [0, 1] {
        let size = exact.size[axis];
        for (along, other) in [(0, 1), (1, 0)] {
            let far = [0, 1, 2].map(|k| at(other, exact.position[k][other]));
            let sum = |of: &dyn Fn(usize) -> f64| (0..3).map(of).sum::<f64>();
            let n = sum(&|k| differences[axis][k] * exact.w[k] as f64 * far[k]);
            let e = |k: usize| exact.w[k] as f64 - w;
            let bent = sum(&|k| e(k) * differences[axis][k] * far[k]);
            let slope = sum(&|k| e(k) * differences[axis][k]).abs();
            let spread = sum(&|k| (differences[axis][k] * far[k]).abs());
            let unit_of_a = most_size.max(affine * two_to(-14.0));
            let cut = unit_of_a * w
                + two_to(-12.6) * bent.abs() * size
                + two_to(-16.6) * w * spread * size
                + 2.0 * side * two_to(-12.6) * w * unit_of_a;
            length[along][axis] = (n * unit * size).abs();
            off[along][axis] = (cut + slope * moved * size) * unit;
        }
    }
    let rho = |[u, v]: [f64; 2]| if is_euclidean { u.hypot(v) } else { u.max(v) };
    let longest = rho(length[0]).max(rho(length[1]));
    let off = rho(off[0]).max(rho(off[1]));
    let plane = two_to(-15.6) + 33.0 * two_to(-24.8);
    Lambda {
        exact: longest.log2(),
        below: -(1.0 - off / longest).max(0.0).log2() + 2.0 * (1.0 + plane).log2(),
        above: (1.0 + off / longest).log2()
            - 2.0 * (1.0 - plane).log2()
            - (1.0 - two_to(-14.4)).log2(),
    }
}

/// The derivatives of small triangles keep to what their own arithmetic loses, which is less than 2^-8.7 where a pixel
/// spans 1/16 texel or more; nearly all keep to what large triangles do.
fn check_small(rule: impl Rule, is_euclidean: bool) {
    const LOW: f64 = 7.9e-5;
    let mut random = seeded(711);
    let (mut pixels, mut others, mut worst, mut widest, mut fine) = (0, 0, 0.0f64, 0.0f64, 0);
    for number in 0..50_000 {
        let size = [1, 2, 4, 8, 15][number % 5] * 256;
        let ratio = [1.0, 1.001, 1.03, 1.12][number / 5 % 4];
        // The last are not small.
        let span = [40, 600, 8_191, 60_000][number / 20 % 4];
        let nearest = [0.004, 0.3, 1.0, 300.0][number / 80 % 4];
        let from = [0; 2].map(|_| random.random_range(100_000..120_000));
        let vertices = [0; 3].map(|_| {
            let [x, y] = from.map(|c| I24F8::from_bits(c + random.random_range(0..=size)));
            let uv = from.map(|c| I16F16::from_bits(c + random.random_range(0..=span)));
            let w = nearest * random.random_range(1.0..=ratio);
            ScreenVertex::new(x, y, I16F16::from_num(w), uv).expect("a vertex in range")
        });
        let log2_size = if number % 7 == 0 {
            (12, 12)
        } else {
            (random.random_range(0..=12), random.random_range(0..=12))
        };
        let Some(setup) = TriangleSetup::new(&vertices, Cull::Off) else {
            continue;
        };
        let Some(footprint) = SmallFootprint::new(&setup, log2_size) else {
            others += 1;
            continue;
        };
        let exact = Exact::new(&vertices, log2_size);
        let mut check = |found: i32, expected: &Lambda, what: &str| {
            if expected.exact.is_infinite() {
                assert!(found < -100 * ONE, "{what} {vertices:?}: {found}");
                return;
            }
            let off = f64::from(found) / f64::from(ONE) - expected.exact;
            let Lambda { below, above, .. } = expected;
            assert!(
                -2.0 * LOW - below <= off && off <= 2.0 * LOW + above,
                "{what} of {vertices:?}, {log2_size:?}: {off}, but {below} and {above}"
            );
            if expected.exact > -4.0 {
                worst = worst.max(off.abs());
                widest = widest.max(below.max(*above) + 2.0 * LOW);
                pixels += 1;
                fine += u32::from(off.abs() < power(-12));
            }
        };
        let sum = [0, 1].map(|axis| exact.position.iter().map(|p| p[axis]).sum::<i128>());
        let [a, b, c] = exact.w;
        let q = exact.twice_area() * (b * c + c * a + a * b) / 3;
        let expected = small(&exact, [sum, [3, 3]], 1.0, q, is_euclidean);
        check(footprint.lambda_of_mean(&setup, rule), &expected, "mean");
        let words = footprint.words();
        let screen = Area {
            width: 1_000,
            top: 0,
            bottom: 1_000,
        };
        for_each_span(&setup, screen, |span| {
            let line = words.row(span, rule);
            for offset in 0..span.left.abs_diff(span.right) {
                let x = span.left.wrapping_add_unsigned(offset);
                let p = [x, span.y].map(|c| 256 * i128::from(c) + 128);
                let expected = small(&exact, [p, [1, 1]], 0.0, exact.denominator(p), is_euclidean);
                check(line.lambda(offset), &expected, "pixel");
            }
        });
    }
    assert!(pixels > 100_000 && others > 5_000, "{pixels} {others}");
    assert!(
        widest < (-8.7f64).exp2() && worst > widest / 4.0 && fine > pixels / 1_000 * 998,
        "{worst} of {widest}, {fine} of {pixels}"
    );
}

#[test]
fn small_triangles_keep_to_what_their_arithmetic_loses() {
    check_small(LongestAxis, false);
    check_small(Euclidean, true);
}

#[test]
fn lambda_of_the_longest_axis_is_exact_to_its_logarithms() {
    check_rule(LongestAxis, false);
}

#[test]
fn lambda_of_the_distance_is_exact_to_its_logarithms() {
    check_rule(Euclidean, true);
}

/// The greatest depths there are: of the farthest 1/w words have nothing left, or less. Lambda comes
/// out as that of a 1/w of one unit there, and never as that of a near one.
#[test]
fn the_farthest_pixels_are_far_in_words_too() {
    let far = |w: i32| {
        // The centres of the leftmost pixels lie on the far edge.
        [([300.5, 77.5], 1), ([0.5, 200.5], w), ([0.5, 0.5], w)].map(|([x, y], w)| {
            let [x, y] = [x, y].map(I24F8::from_num);
            let uv = [x, y].map(|c| I16F16::from_num(c / 16));
            ScreenVertex::new(x, y, I16F16::from_bits(w), uv).expect("a vertex in range")
        })
    };
    let mut lost = 0;
    for shift in 24..31 {
        let vertices = far(1 << shift);
        let setup = TriangleSetup::new(&vertices, Cull::Off).expect("an area");
        let footprint = Footprint::new(&setup, (8, 8));
        let words = FootprintWords::any(&setup, (8, 8));
        for span in spans(&vertices, 50) {
            let exact = footprint.row(span, LongestAxis).lambda(0);
            let found = words.row(span, LongestAxis).lambda(0);
            // 1/w has 30 bits where it is greatest.
            let unit = f64::from(2 * 30 * ONE);
            lost += u32::from((found - exact).abs() > ONE);
            assert!(
                found > exact - 8 * ONE && f64::from(found - exact) < unit,
                "{shift} {span:?}"
            );
        }
    }
    assert!(lost > 0, "words are as good as all bits");
}

/// Whole triangles of ordinary shape: the closed form above is the one of the float64 reference,
/// and the core keeps to 2^-12 of it.
#[test]
fn ordinary_triangles_keep_to_a_4096th_of_a_level() {
    let mut random = seeded(702);
    let mut pixels = 0;
    for _ in 0..400 {
        let ratio: f64 = random.random_range(1.0..256.0);
        let vertices = [[20, 30], [600, 60], [200, 460]].map(|[x, y]| {
            let [x, y] =
                [x, y].map(|c| I24F8::from_bits(c * 256 + random.random_range(-4_000..4_000)));
            let w = random.random_range(0.0..=ratio.ln()).exp();
            let uv = [0; 2].map(|_| I16F16::from_bits(random.random_range(-300_000..300_000)));
            ScreenVertex::new(x, y, I16F16::from_num(w), uv).expect("a vertex in range")
        });
        let log2_size = (random.random_range(4..=10), random.random_range(4..=10));
        let corners = Corners {
            position: vertices.map(|v| [v.x().to_num(), v.y().to_num()]),
            w: vertices.map(|v| v.w().to_num()),
            uv: vertices.map(|v| v.uv().map(I16F16::to_num)),
        };
        let planes = Planes::new(&corners).expect("an area");
        let setup = TriangleSetup::new(&vertices, Cull::Off).expect("an area");
        let footprint = Footprint::new(&setup, log2_size);
        let words = FootprintWords::any(&setup, log2_size);
        let exact = Exact::new(&vertices, log2_size);
        for span in spans(&vertices, 20) {
            for offset in (0..span.left.abs_diff(span.right)).step_by(61) {
                let x = span.left.wrapping_add_unsigned(offset);
                let sample = planes.at(f64::from(x) + 0.5, f64::from(span.y) + 0.5);
                let found = [
                    footprint.row(span, LongestAxis).lambda(offset),
                    footprint.row(span, Euclidean).lambda(offset),
                    words.row(span, LongestAxis).lambda(offset),
                    words.row(span, Euclidean).lambda(offset),
                ];
                let check = |rule: Rules, found: i32, is_euclidean| {
                    let expected = rule.rho(&sample, exact.size).log2();
                    let closed = exact.at(x, span.y, is_euclidean, false).exact;
                    assert!((expected - closed).abs() < 1e-7, "{expected} {closed}");
                    let off = f64::from(found) / f64::from(ONE) - expected;
                    assert!(
                        off.abs() < power(-12),
                        "{off} at {x}, {} of {vertices:?}",
                        span.y
                    );
                };
                check(Rules::LongestAxis, found[0], false);
                check(Rules::Euclidean, found[1], true);
                check(Rules::LongestAxis, found[2], false);
                check(Rules::Euclidean, found[3], true);
                pixels += 1;
            }
        }
    }
    assert!(pixels > 20_000, "{pixels}");
}

#[test]
fn levels_switch_where_opengl_says() {
    for k in 0..13 {
        let half = k * ONE + ONE / 2;
        let level = k as u32;
        assert_eq!(NearestLevel.level(half - 1), (level, 0));
        assert_eq!(NearestLevel.level(half), (level, 0), "of two the finer");
        assert_eq!(NearestLevel.level(half + 1), (level + 1, 0));

        let whole = k * ONE;
        assert_eq!(SafestLevel.level(whole + 1), (level + 2, 0));
        assert_eq!(SafestLevel.level(whole + ONE), (level + 2, 0));

        let most = (1 << BLEND_BITS) - 1;
        let unit = ONE >> BLEND_BITS;
        assert_eq!(LinearLevels.level(whole + unit), (level, 1));
        assert_eq!(LinearLevels.level(whole + unit - 1), (level, 0));
        assert_eq!(LinearLevels.level(half), (level, 1 << (BLEND_BITS - 1)));
        assert_eq!(LinearLevels.level(whole + ONE - 1), (level, most));
        assert_eq!(LinearLevels.level(whole + ONE), (level + 1, 0));

        for lambda in [whole + 1, half, half + 1] {
            assert_eq!(FinestLevel.level(lambda), (0, 0));
        }
    }
    for lambda in [1, i32::MAX / 2] {
        assert_eq!(FinestLevel.level(lambda), (0, 0));
    }
    assert_eq!(NearestLevel.level(1), (0, 0));
}

/// What the core chose as the reference says it.
fn plain(chosen: Chosen) -> lod::Chosen {
    match chosen {
        Chosen::Magnified(level) => lod::Chosen::Magnified(level),
        Chosen::One(level) => lod::Chosen::One(level),
        Chosen::Two { finer, weight } => lod::Chosen::Two {
            finer,
            coarser: finer + 1,
            weight: f64::from(weight) / f64::from(1 << BLEND_BITS),
        },
    }
}

fn check_choice<C: Choice>(choice: C, choices: Choices) {
    let mut random = seeded(703);
    let number = |bits: i32| f64::from(bits) / f64::from(ONE);
    let edges: Vec<i32> = (-3..15)
        .flat_map(|k| [k * ONE, k * ONE + ONE / 2])
        .flat_map(|at| [-17, -16, -15, -1, 0, 1, 15, 16, 17].map(|by| at + by))
        .chain([i32::MIN / 16, -(1 << 26), 1 << 26])
        .collect();
    for _ in 0..300 {
        // Whole and half limits meet the edges.
        let mut limit = || match random.random_range(0..4) {
            0 => random.random_range(-4..15) * ONE,
            1 => random.random_range(-8..30) * ONE / 2,
            2 => random.random_range(-4 * ONE..15 * ONE),
            _ => [i32::MIN, i32::MAX][random.random_range(0..2)],
        };
        let (bias, least, most) = (limit(), limit(), limit());
        let bias = if bias.unsigned_abs() > 1 << 21 {
            0
        } else {
            bias
        };
        let (resident, last) = (random.random_range(0..15), random.random_range(0..13));
        let [wanted, all_there] = [const { Cell::new(u8::MAX) }; 2];
        let core = Lod::new(choice, LongestAxis, EachPixel)
            .with_bias(I16F16::from_bits(bias))
            .within(I16F16::from_bits(least), I16F16::from_bits(most))
            .resident(resident);
        let everything = core.resident(0).recording(&all_there);
        let core = core.recording(&wanted);
        let reference = lod::Lod {
            choice: choices,
            bias: number(bias),
            min: number(least),
            max: number(most),
            resident,
            ..lod::Lod::default()
        };
        for &lambda in &edges {
            wanted.set(u8::MAX);
            all_there.set(u8::MAX);
            let chosen = core.choose(lambda, last);
            let limited = (number(lambda) + reference.bias)
                .max(reference.min)
                .min(reference.max);
            let expected = reference.levels(limited, last as usize + 1);
            let what = || format!("{choices:?}, {lambda} of {last} by {reference:?}");
            match (plain(chosen), expected) {
                (
                    lod::Chosen::Two {
                        finer,
                        coarser,
                        weight,
                    },
                    lod::Chosen::Two {
                        finer: fine,
                        coarser: coarse,
                        weight: exact,
                    },
                ) => {
                    assert_eq!((finer, coarser), (fine, coarse), "{}", what());
                    // Rounded down to 2^-12.
                    let off = exact - weight;
                    assert!((0.0..power(-12)).contains(&off), "{}", what());
                }
                // A weight that is rounded down to none needs one level.
                (lod::Chosen::One(level), lod::Chosen::Two { finer, weight, .. }) => {
                    assert_eq!(level, finer, "{}", what());
                    assert!(weight < power(-12), "{}", what());
                }
                (found, expected) => assert_eq!(found, expected, "{}", what()),
            }
            // What is wanted is the finest level of the choice as if all were there.
            _ = everything.choose(lambda, last);
            assert_eq!(wanted.get(), all_there.get(), "{}", what());
            let all = lod::Lod {
                resident: 0,
                ..reference
            };
            let finest = match all.levels(limited, last as usize + 1) {
                lod::Chosen::Magnified(level) | lod::Chosen::One(level) => level,
                lod::Chosen::Two { finer, .. } => finer,
            };
            assert_eq!(u32::from(wanted.get()), finest, "{}", what());
        }
    }
}

#[test]
fn bias_limits_and_residence_are_those_of_the_reference() {
    check_choice(FinestLevel, Choices::Base);
    check_choice(NearestLevel, Choices::Nearest);
    check_choice(SafestLevel, Choices::Safest);
    check_choice(LinearLevels, Choices::Linear);
}

#[test]
fn the_finest_wanted_level_of_a_frame_is_kept() {
    let wanted = Cell::new(u8::MAX);
    let lod = Lod::new(NearestLevel, LongestAxis, EachPixel)
        .resident(3)
        .recording(&wanted);
    for (lambda, kept) in [(5, 5), (7, 5), (2, 2), (4, 2), (0, 0), (9, 0)] {
        _ = lod.choose(lambda * ONE, 10);
        assert_eq!(wanted.get(), kept);
    }
}

/// Where a rate takes the lambda of a pixel, written down as its documentation has it.
type Direct = fn(Span, i32) -> Option<i32>;

fn direct_span(span: Span, _: i32) -> Option<i32> {
    Some(span.left + (span.right - span.left) / 2)
}

fn direct_piece(span: Span, x: i32) -> Option<i32> {
    let first = x - x.rem_euclid(16);
    let (start, end) = (first.max(span.left), (first + 16).min(span.right));
    Some(start + (end - start) / 2)
}

fn check_pieces(rate: impl Rate, direct: Direct) {
    let mut random = seeded(704);
    for _ in 0..3_000 {
        let left = random.random_range(0..1_000);
        let span = Span {
            y: random.random_range(0..1_000),
            left,
            right: left + random.random_range(1..=(1_024 - left).min(90)),
        };
        let len = (span.right - span.left) as usize;
        for offset in 0..len {
            let piece = rate.piece(span, offset);
            let Piece { start, end, at } = piece;
            assert!(
                start <= offset && offset < end,
                "{span:?} {offset}: {piece:?}"
            );
            let x = span.left + offset as i32;
            let column = at.map(|at| span.left + at as i32);
            // The middle of an even number of columns is either of two.
            let expected = direct(span, x);
            assert_eq!(column, expected, "{span:?} {offset}");
            for other in [start, end.min(len) - 1] {
                assert_eq!(rate.piece(span, other), piece, "{span:?} {offset} {other}");
            }
            assert!(at.is_none_or(|at| start <= at && at < end.min(len)));
        }
    }
}

#[test]
fn pieces_are_those_of_the_documentation() {
    check_pieces(EachTriangle, |_, _| None);
    check_pieces(EachSpan, direct_span);
    check_pieces(EachPiece, direct_piece);
    check_pieces(EachPixel, |_, x| Some(x));
}

/// Levels that are all of one colour, their own number.
fn numbered(width: u32, height: u32) -> Vec<Gray8> {
    (0..levels(width, height))
        .flat_map(|level| {
            let (width, height) = level_size(width, height, level);
            vec![Gray8::new(level as u8); (width * height) as usize]
        })
        .collect()
}

/// Every pixel shows the level of the lambda at its rate's place.
fn check_rate<P: Rate>(rate: P, direct: Direct) {
    let mut random = seeded(705);
    let texels = numbered(256, 64);
    let pyramid = Pyramid::<Texture<'_, Gray8>>::new(&texels, 256, 64).expect("all levels");
    let mut seen = [0; 9];
    for number in 0..400 {
        let case = case(&mut random, number);
        let Some(setup) = TriangleSetup::new(&case.vertices, Cull::Off) else {
            continue;
        };
        let lod = Lod::new(NearestLevel, Euclidean, rate);
        let shader: Mipmapped<'_, _, _, _, _> =
            Mipmapped::new(&pyramid, NearestTexel, NearestTexel, lod);
        let triangle = Shader::triangle(&shader, &setup);
        let footprint = Footprint::new(&setup, (8, 6));
        for span in spans(&case.vertices, 20) {
            let mut row = shader.row(&triangle, span);
            for x in span.left..span.right {
                let offset = (x - span.left) as usize;
                let lambda = match direct(span, x) {
                    Some(at) => footprint
                        .row(span, Euclidean)
                        .lambda((at - span.left) as u32),
                    None => footprint.lambda_of_mean(&setup, Euclidean),
                };
                let level = match lod.choose(lambda, 8) {
                    Chosen::Magnified(level) | Chosen::One(level) => level,
                    Chosen::Two { .. } => unreachable!("one level at a time"),
                };
                let found = row.texel(offset, Uv::default()).luma();
                assert_eq!(u32::from(found), level, "{x}, {} of {case:?}", span.y);
                seen[level as usize] += 1;
            }
        }
    }
    assert!(seen.iter().all(|&n| n > 0), "{seen:?}");
}

#[test]
fn shaders_take_lambda_where_the_rate_says() {
    check_rate(EachTriangle, |_, _| None);
    check_rate(EachSpan, direct_span);
    check_rate(EachPiece, direct_piece);
    check_rate(EachPixel, |_, x| Some(x));
}

/// A depth test hides a triangle behind itself: then no level is wanted, but one for a single pixel that is
/// seen.
fn check_hidden<P: Rate>(rate: P, strategy: impl Strategy + Copy) {
    const SIDE: u32 = 90;
    let texels = numbered(64, 64);
    let pyramid = Pyramid::<Texture<'_, Gray8>>::new(&texels, 64, 64).expect("all levels");
    let wanted = Cell::new(u8::MAX);
    let lod = Lod::new(NearestLevel, LongestAxis, rate).recording(&wanted);
    let corner = |x: i32, y: i32, w: i32| {
        let uv = [x, y].map(|c| I16F16::from_bits(c * 4 * 65_536 / 64));
        let [x, y] = [x, y].map(I24F8::from_num);
        ScreenVertex::new(x, y, I16F16::from_num(w), uv).expect("a vertex in range")
    };
    let vertices = [corner(0, 0, 1), corner(0, 80, 2), corner(85, 0, 3)];
    let mut depths = vec![Z16::EMPTY; (SIDE * SIDE) as usize];
    let draw = |depths: &mut [u16]| {
        let mut pixels = vec![Gray8::new(u8::MAX); depths.len()];
        let stride = SIDE as usize;
        let depth = Band::new(depths, SIDE, SIDE, stride, 0).expect("a frame");
        let mut band = Band::new(&mut pixels, SIDE, SIDE, stride, 0).expect("a frame");
        let sampler: Mipmapped<'_, _, _, _, _> =
            Mipmapped::new(&pyramid, NearestTexel, NearestTexel, lod);
        let mut pipeline = Pipeline {
            strategy,
            sampler,
            depth: Z16::new(depth, I16F16::ONE),
            cull: Cull::Off,
        };
        wanted.set(u8::MAX);
        pipeline.draw_triangle(&mut band, &vertices);
        wanted.get()
    };
    assert_ne!(draw(&mut depths), u8::MAX);
    assert_eq!(draw(&mut depths), u8::MAX);
    for (x, y) in [(0, 0), (15, 2), (16, 2), (37, 20), (3, 60)] {
        depths[(y * SIDE + x) as usize] = Z16::EMPTY;
        assert_ne!(draw(&mut depths), u8::MAX, "column {x}, row {y}");
        assert_eq!(draw(&mut depths), u8::MAX, "column {x}, row {y}");
    }
}

#[test]
fn no_level_is_wanted_where_nothing_is_seen() {
    check_hidden(EachSpan, Affine);
    check_hidden(EachPiece, Affine);
    check_hidden(EachPiece, Every::<16>);
    check_hidden(EachPixel, PerPixel);
}

#[test]
fn a_texel_a_pixel_is_lambda_zero() {
    // 64 pixels over 64 texels, and 2, 4 .. of them.
    for k in 0..7 {
        let side = 64;
        let corner = |x: i32, y: i32| {
            let uv = [x, y].map(|c| I16F16::from_bits((c << k) * 65_536 / side));
            let [x, y] = [x, y].map(I24F8::from_num);
            ScreenVertex::new(x, y, I16F16::ONE, uv).expect("a vertex in range")
        };
        let vertices = [corner(0, 0), corner(0, side), corner(side, 0)];
        let setup = TriangleSetup::new(&vertices, Cull::Off).expect("an area");
        let footprint = Footprint::new(&setup, (6, 6));
        let span = Span {
            y: 3,
            left: 0,
            right: 60,
        };
        // Powers of two throughout: their logarithms have no error, but 1/w of depth 1 has: 2^-29,
        // which 16 fraction bits may show as one unit.
        let sample = Sample {
            uv: [0.0; 2],
            w: 1.0,
            dx: [power(k) / 64.0, 0.0],
            dy: [0.0, power(k) / 64.0],
        };
        assert_eq!(
            Rules::LongestAxis.rho(&sample, [64.0; 2]).log2(),
            f64::from(k)
        );
        for found in [
            footprint.row(span, LongestAxis).lambda(17),
            footprint.row(span, Euclidean).lambda(17),
            footprint.lambda_of_mean(&setup, LongestAxis),
        ] {
            let off = found - k * ONE;
            assert!(off.abs() <= 2, "{k}: off by {off} / 65536");
        }
    }
}

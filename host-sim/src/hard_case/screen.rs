//! Hard cases for the rasterizer alone: triangles given after projection.

use super::{Corner, HardCase, frame, triangle};
use crate::error::Error;
use crate::reference::Beyond;

/// A frame of middle size, and the texture that most cases have.
const SIZE: [u32; 2] = [160, 120];
const TEXTURE: [u32; 2] = [256, 256];

/// One unit of a 16.16 number.
const UNIT: f64 = 1.0 / 65536.0;

/// Collects the cases.
struct Cases(Vec<HardCase>);

impl Cases {
    fn add(
        &mut self,
        name: &str,
        reason: &'static str,
        size: [u32; 2],
        texture: [u32; 2],
        wrap: Beyond,
        triangles: &[[Corner; 3]],
    ) -> Result<(), Error> {
        let triangles = triangles
            .iter()
            .map(|&t| triangle(t))
            .collect::<Result<_, _>>()?;
        self.0.push(HardCase {
            name: name.to_owned(),
            reason,
            frame: frame(size, texture, wrap, triangles)?,
        });
        Ok(())
    }

    /// With the usual sizes.
    fn usual(
        &mut self,
        name: &str,
        reason: &'static str,
        triangles: &[[Corner; 3]],
    ) -> Result<(), Error> {
        self.add(name, reason, SIZE, TEXTURE, Beyond::Repeat, triangles)
    }
}

pub(super) fn cases() -> Result<Vec<HardCase>, Error> {
    let mut cases = Cases(Vec::new());
    depths(&mut cases)?;
    shapes(&mut cases)?;
    centres(&mut cases)?;
    span_lengths(&mut cases)?;
    coordinates(&mut cases)?;
    textures(&mut cases)?;
    Ok(cases.0)
}

/// A triangle and its mirror image across the frame's middle: w varies along x and along y, with
/// the far corner left and right, above and below.
fn both_ways(w: [f64; 3], uv: [[f64; 2]; 3]) -> [[Corner; 3]; 2] {
    let positions = [[-3.3, 7.7], [166.1, -11.4], [71.9, 128.6]];
    let corners = |flip: bool| {
        [0, 1, 2].map(|i| {
            let [mut x, mut y] = positions[i];
            if flip {
                (x, y) = (160.0 - x, 120.0 - y);
            }
            [x, y, w[i], uv[i][0], uv[i][1]]
        })
    };
    [corners(false), corners(true)]
}

const SQUARE_16: [[f64; 2]; 3] = [[0.0, 0.0], [16.0, 0.0], [16.0, 16.0]];

fn depths(cases: &mut Cases) -> Result<(), Error> {
    const REASON: &str = "the ratio of depths within one triangle is what bends coordinates";
    for (name, ratio) in [
        ("1.001", 1.001),
        ("2", 2.0),
        ("16", 16.0),
        ("256", 256.0),
        ("4096", 4096.0),
    ] {
        cases.usual(
            &format!("depth-1:{name}"),
            REASON,
            &both_ways([1.0, ratio, ratio.sqrt()], SQUARE_16),
        )?;
    }
    cases.usual(
        "depth-far",
        "equal depths at the far end of 16.16 and one unit below it",
        &both_ways([32767.0, 32767.0 - UNIT, 32766.0], SQUARE_16),
    )?;
    cases.usual(
        "depth-one-unit",
        "w of a single unit of 16.16 beside w = 1: a ratio of 65536",
        &both_ways([UNIT, 1.0, 3.0 * UNIT], SQUARE_16),
    )?;
    cases.usual(
        "depth-whole-range",
        "the least and the largest w there are: a ratio of 2^31",
        &both_ways([UNIT, 32767.0, 1.0], SQUARE_16),
    )
}

fn shapes(cases: &mut Cases) -> Result<(), Error> {
    let sub = 1.0 / 256.0;
    let large = [1024, 1024];
    let slopes = [
        [0.0, 1.0],
        [1.0, 0.0],
        [1.0, 1.0],
        [1.0, 0.01],
        [0.01, 1.0],
        [0.7, -0.6],
        [1.0, -sub],
    ];
    let slivers: Vec<_> = slopes
        .into_iter()
        .flat_map(|[dx, dy]| {
            let scale = 1000.0 / f64::hypot(dx, dy);
            // Through the middle of the frame, less than the guard band long on each side.
            let (hx, hy) = (dx * scale, dy * scale);
            let [ax, ay, bx, by] = [512.3 - hx, 512.6 - hy, 512.3 + hx, 512.6 + hy]
                .map(|c: f64| c.clamp(-1023.0, 1023.0));
            [[sub, 0.0], [0.0, sub]].map(|[ex, ey]| {
                [
                    [ax, ay, 1.0, 0.0, 0.0],
                    [bx, by, 16.0, 8.0, 1.0],
                    [bx + ex, by + ey, 12.0, 0.0, 8.0],
                ]
            })
        })
        .collect();
    cases.add(
        "sliver",
        "1/256 px wide and up to 2000 px long: the area's reciprocal is at its ends",
        large,
        TEXTURE,
        Beyond::Repeat,
        &slivers,
    )?;
    cases.add(
        "sliver-deep",
        "a depth ratio of 4096 across 1/256 px",
        large,
        TEXTURE,
        Beyond::Repeat,
        &[
            [
                [-300.0, 100.0, 1.0, 0.0, 0.0],
                [1023.0, 700.0, 1.0, 4.0, 0.0],
                [1023.0, 700.0 + sub, 4096.0, 0.0, 4.0],
            ],
            [
                [200.0, -900.0, 4096.0, 0.0, 0.0],
                [800.0, 1023.0, 1.0, 4.0, 0.0],
                [800.0 + sub, 1023.0, 1.0, 0.0, 4.0],
            ],
        ],
    )?;
    let g = 1024.0;
    cases.add(
        "guard-band-rim",
        "the largest triangles there are, corners on the rim of the guard band",
        [320, 240],
        TEXTURE,
        Beyond::Repeat,
        &[
            [
                [-g, -g, 1.0, 0.0, 0.0],
                [g, -g, 20.0, 16.0, 0.0],
                [-g, g, 5.0, 0.0, 16.0],
            ],
            [
                [g, g, 1.0, 0.0, 0.0],
                [-g, g, 20.0, 16.0, 0.0],
                [g, -g, 5.0, 0.0, 16.0],
            ],
            [
                [-g, 0.0, 9.0, 3.0, 0.0],
                [g, -g, 20.0, 16.0, 0.0],
                [g, g, 1.0, 0.0, 16.0],
            ],
        ],
    )?;
    let corner = |x: f64, y: f64| [x, y, 1.0 + x / 100.0, x / 64.0, y / 64.0];
    cases.usual(
        "zero-area",
        "two corners in one place: nothing may be drawn",
        &[
            [corner(20.0, 20.0), corner(20.0, 20.0), corner(90.0, 70.0)],
            [corner(20.5, 20.5), corner(90.5, 20.5), corner(90.5, 20.5)],
        ],
    )?;
    cases.usual(
        "collinear",
        "three corners on one line: nothing may be drawn",
        &[
            [corner(10.5, 10.5), corner(30.5, 30.5), corner(90.5, 90.5)],
            [corner(10.0, 10.5), corner(90.0, 10.5), corner(40.0, 10.5)],
            [corner(10.5, 10.0), corner(10.5, 90.0), corner(10.5, 40.0)],
            [corner(0.0, 0.0), corner(150.0, 50.0), corner(75.0, 25.0)],
        ],
    )?;
    cases.usual(
        "one-centre",
        "all three corners on one pixel centre: nothing may be drawn",
        &[[corner(40.5, 40.5); 3]],
    )?;
    cases.usual(
        "half-a-subpixel",
        "the smallest area there is, around a pixel centre and beside it",
        &[
            [
                [40.5, 40.5, 1.0, 0.0, 0.0],
                [40.5 + sub, 40.5, 9.0, 1.0, 0.0],
                [40.5, 40.5 + sub, 4.0, 0.0, 1.0],
            ],
            [
                [50.5 - sub, 50.5, 1.0, 0.0, 0.0],
                [50.5, 50.5 - sub, 9.0, 1.0, 0.0],
                [50.5 + sub, 50.5 + sub, 4096.0, 0.0, 1.0],
            ],
        ],
    )?;
    let around = [
        [-400.0, -300.0, 1.0, 0.0, 0.0],
        [700.0, -200.0, 8.0, 5.0, 0.0],
        [30.0, 900.0, 3.0, 0.0, 5.0],
    ];
    for (name, reason, size) in [
        ("frame-1x1", "the smallest frame", [1, 1]),
        (
            "frame-1x1024",
            "a column: all spans have one pixel",
            [1, 1024],
        ),
        ("frame-1024x1", "a row: the longest span", [1024, 1]),
        ("frame-1024x1024", "the largest frame", [1024, 1024]),
    ] {
        cases.add(name, reason, size, TEXTURE, Beyond::Repeat, &[around])?;
    }
    Ok(())
}

fn centres(cases: &mut Cases) -> Result<(), Error> {
    let corner = |x: f64, y: f64| {
        let w = 1.0 + x / 40.0 + y / 90.0;
        [x, y, w, x / 32.0, y / 32.0]
    };
    let steps = [[8.0, 8.0], [8.0, 4.0], [3.0, 9.0], [16.0, 1.0], [1.0, 16.0]];
    let diagonal: Vec<_> = steps
        .into_iter()
        .flat_map(|[dx, dy]| {
            let (a, b) = (corner(20.5, 20.5), corner(20.5 + 5.0 * dx, 20.5 + 5.0 * dy));
            [
                [a, b, corner(20.5 + 5.0 * dx, 20.5)],
                [a, b, corner(20.5, 20.5 + 5.0 * dy)],
            ]
        })
        .collect();
    cases.usual(
        "edges-through-centres",
        "edges and corners exactly on pixel centres: the top-left rule decides",
        &diagonal,
    )?;
    // Edges pass centres, corners do not lie on any.
    let off: Vec<_> = steps
        .into_iter()
        .map(|[dx, dy]| {
            [
                corner(30.5 - dx / 2.0, 30.5 - dy / 2.0),
                corner(30.5 + 3.5 * dx, 30.5 + 3.5 * dy),
                corner(30.5 + 3.5 * dx, 29.25),
            ]
        })
        .collect();
    cases.usual(
        "edges-through-centres-only",
        "edges exactly through pixel centres, corners beside them",
        &off,
    )
}

/// One row after the other with a span of this length, at every place relative to the anchors.
fn span_lengths(cases: &mut Cases) -> Result<(), Error> {
    for length in [1, 2, 15, 16, 17, 31, 32, 33, 63, 64, 65] {
        let triangles: Vec<_> = (0..66)
            .map(|phase| {
                let (row, start, n) = (f64::from(phase), f64::from(phase), f64::from(length));
                // Half as wide at the row's centre as at its lower end; the left edge runs
                // through the first centre, which belongs to the span, the right one through the
                // one behind the last, which does not.
                [
                    [start + 0.5, row + 0.25, 1.0, 0.0, 0.0],
                    [start + 0.5 + 2.0 * n, row + 0.75, 5.0, n / 32.0, 0.5],
                    [start + 0.5, row + 0.75, 1.0, 0.0, 1.0],
                ]
            })
            .collect();
        cases.add(
            &format!("span-{length}"),
            "spans that just reach, just miss or just pass an anchor",
            [208, 68],
            TEXTURE,
            Beyond::Repeat,
            &triangles,
        )?;
    }
    Ok(())
}

fn coordinates(cases: &mut Cases) -> Result<(), Error> {
    let last = 64.0 - UNIT;
    let mut wide = both_ways([1.0, 3.0, 2.0], [[-64.0, -64.0], [last, 0.0], [0.0, last]]).to_vec();
    wide.extend(both_ways(
        [1.0, 3.0, 2.0],
        [[-64.0, 64.0], [0.0, 0.0], [63.0, -63.0]],
    ));
    cases.usual(
        "uv-64-repeats",
        "-64 to +64 repeats, the widest range that one triangle may have",
        &wide,
    )?;
    for ratio in [256.0, 4096.0] {
        cases.usual(
            &format!("uv-64-repeats-1:{ratio}"),
            "the widest range of coordinates over a great depth: the top of the word",
            // A far corner on a pixel centre, where u is as large as it gets.
            &[
                [
                    [0.5, 0.5, ratio, last, last],
                    [150.5, 0.5, 1.0, -64.0, 0.0],
                    [0.5, 110.5, ratio, last, -64.0],
                ],
                [
                    [150.5, 110.5, ratio, last, last],
                    [0.5, 110.5, 1.0, -64.0, 0.0],
                    [150.5, 0.5, ratio, last, last],
                ],
            ],
        )?;
    }
    cases.usual(
        "uv-limits",
        "coordinates at plus and minus 127 repeats",
        &[
            both_ways(
                [1.0, 4.0, 2.0],
                [[127.0, -127.0], [126.0, -126.0], [127.0, -120.0]],
            ),
            both_ways([1.0, 4.0, 2.0], [[127.0, -127.0], [0.0, 0.0], [1.0, -1.0]]),
        ]
        .concat(),
    )?;
    found_at_random(cases)?;
    cases.usual(
        "uv-texture-a-pixel",
        "more than a whole texture within one pixel",
        &[
            [
                [10.2, 10.1, 1.0, 0.0, 0.0],
                [60.3, 12.7, 9.0, 100.0, 3.0],
                [15.6, 58.9, 4.0, 7.0, 100.0],
            ],
            [
                [100.2, 60.1, 1.0, -60.0, -60.0],
                [104.9, 61.2, 2.0, 60.0, 0.0],
                [101.1, 65.3, 4.0, 0.0, 60.0],
            ],
        ],
    )?;
    cases.usual(
        "uv-constant",
        "u, v or both alike at all corners: planes of zeros",
        &[
            both_ways([1.0, 9.0, 3.0], [[0.3, 0.7]; 3]),
            both_ways([1.0, 9.0, 3.0], [[0.3, 0.0], [0.3, 1.0], [0.3, 4.0]]),
            both_ways([1.0, 9.0, 3.0], [[0.0, -5.5], [1.0, -5.5], [4.0, -5.5]]),
        ]
        .concat(),
    )?;
    cases.usual(
        "uv-one-unit",
        "corners one unit of 2^-16 apart: the least range",
        &both_ways(
            [1.0, 9.0, 3.0],
            [[0.5, 0.5], [0.5 + UNIT, 0.5], [0.5, 0.5 - UNIT]],
        ),
    )?;
    cases.usual(
        "uv-mirrored",
        "u and v run backwards, across zero",
        &both_ways([2.0, 1.0, 6.0], [[1.5, 1.5], [-1.5, 0.2], [0.1, -1.5]]),
    )
}

fn textures(cases: &mut Cases) -> Result<(), Error> {
    let uv = [[-1.2, -1.1], [2.7, 0.3], [0.4, 3.1]];
    for (name, texture) in [
        ("texture-1x1", [1, 1]),
        ("texture-1x64", [1, 64]),
        ("texture-64x1", [64, 1]),
        ("texture-4096x1", [4096, 1]),
        ("texture-2x4096", [2, 4096]),
    ] {
        for (suffix, wrap) in [
            ("", Beyond::Repeat),
            ("-clamp", Beyond::Clamp),
            ("-mirror", Beyond::Mirror),
        ] {
            cases.add(
                &format!("{name}{suffix}"),
                "sides of one texel, and the longest side",
                SIZE,
                texture,
                wrap,
                &both_ways([1.0, 3.0, 2.0], uv),
            )?;
        }
    }
    cases.usual(
        "level-0-only",
        "eight texels a pixel without a pyramid: the far field at full resolution",
        &both_ways([1.0, 1.2, 1.1], [[0.0, 0.0], [5.0, 0.0], [5.0, 4.0]]),
    )?;
    // 160 px show 2.5 texels.
    let (du, dv) = (2.5 / 256.0, 1.875 / 256.0);
    cases.usual(
        "magnified-64",
        "64 px a texel: steps of 1/64 texel add up",
        &[
            [
                [0.0, 0.0, 1.0, 0.0, 0.0],
                [160.0, 0.0, 1.0, du, 0.0],
                [160.0, 120.0, 1.0, du, dv],
            ],
            [
                [0.0, 0.0, 1.0, 0.0, 0.0],
                [160.0, 120.0, 1.5, du, dv],
                [0.0, 120.0, 2.0, 0.0, dv],
            ],
        ],
    )?;
    // One texel a pixel, pixel centres on texel centres: u = 1 lies at the right edge of the last
    // pixel, and no pixel may show the texel beyond it.
    for (suffix, wrap) in [
        ("", Beyond::Repeat),
        ("-clamp", Beyond::Clamp),
        ("-mirror", Beyond::Mirror),
    ] {
        cases.add(
            &format!("last-texel{suffix}"),
            "the last texel's right edge: coordinates reach 1.0 and no texel of the next repeat",
            [128, 128],
            [128, 128],
            wrap,
            &[
                [
                    [0.0, 0.0, 1.0, 0.0, 0.0],
                    [128.0, 0.0, 1.0, 1.0, 0.0],
                    [128.0, 128.0, 1.0, 1.0, 1.0],
                ],
                [
                    [0.0, 0.0, 2.0, 0.0, 0.0],
                    [128.0, 128.0, 2.0, 1.0, 1.0],
                    [0.0, 128.0, 2.0, 0.0, 1.0],
                ],
            ],
        )?;
    }
    Ok(())
}

/// Triangles that random cases failed on once.
fn found_at_random(cases: &mut Cases) -> Result<(), Error> {
    let bits = |bits: i32| f64::from(bits) / 65_536.0;
    cases.add(
        "uv-end-of-range-1:105000",
        "a far corner on a pixel centre, at the end of a range just below a power of two: rounded, u / w reached 1 / w",
        [160, 320],
        [32, 16],
        Beyond::Repeat,
        &[[
            [60.5, 42.5, 4447.64893, bits(1_421_536), bits(3_783_870)],
            [64.5, 37.0, 0.04227, bits(1_356_001), bits(3_783_870)],
            [64.0, 43.5, 1.27737, bits(1_356_001), bits(3_783_870)],
        ]],
    )?;
    cases.add(
        "uv-end-of-range-1:165000",
        "the same at the edge of 16.16 in depth, on a texture of one column",
        [1, 320],
        [1, 64],
        Beyond::Mirror,
        &[[
            [0.5, 202.5, 32767.0, bits(-3_352_275), bits(8_131_807)],
            [2.5, 204.0, 32767.0, bits(-3_352_275), bits(8_131_358)],
            [4.5, 201.0, 0.19853, bits(-3_417_810), bits(8_131_553)],
        ]],
    )?;
    let far = 4.0 * UNIT;
    cases.usual(
        "uv-minus-half-range",
        "two corners a power of two below the first: u/w is -1/2 between them, with nothing to round down to",
        &[[
            [142.0, 97.0, 1.894_79, far - 127.0, -127.0],
            [48.5, 57.5, 1.0, -127.0, -127.0],
            [48.5, 30.5, 1.869_81, -127.0, -127.0],
        ]],
    )?;
    cases.add(
        "uv-limits-steep",
        "near 127 repeats and steep in depth: a parabola through exact points swings beyond 128",
        [160, 160],
        [2, 32],
        Beyond::Clamp,
        &[[
            [65.5, 64.0, 32767.0, bits(66_932), bits(6_676_928)],
            [51.0, 83.0, 32767.0, bits(66_932), bits(6_670_064)],
            [21.0, 49.5, 3.57436, bits(-8_321_021), bits(6_664_047)],
        ]],
    )
}

//! Filters and texel formats from end to end: scenes drawn by the core against float64.

use host_sim::aliasing::study;
use host_sim::choice::Perspective;
use host_sim::compare::compare;
use host_sim::filtering::{FORMATS, Filtering, Format, Minify, Per, Within};
use host_sim::frame::Frame;
use host_sim::shaded::{Pixels, pixels};
use host_sim::subject::Subject;
use host_sim::view::{View, view};
use multum::fixed::types::I16F16;
use multum::pyramid::average::Average;
use multum::viewport::Viewport;

fn frame(name: &str) -> Frame {
    let viewport = Viewport::new(160, 120).expect("a size in range");
    Subject::by_name(name)
        .and_then(|subject| subject.frame(viewport))
        .expect("a built-in scene")
}

fn named(name: &str) -> Filtering {
    Filtering::named(name.parse::<Minify>().expect("a filter"))
}

/// The largest step between two neighbouring values of a channel as a display shows it.
fn step(format: Format) -> f64 {
    match format {
        Format::Rgb888 | Format::Gray8 | Format::Rgba8888 => 1.0,
        // Green is widened from 5 bits to 6 before it is shown: 15 is 30/63, 16 is 33/63.
        Format::Rgba5551 => 13.0,
        // 255 / 31, to whole numbers.
        _ => 9.0,
    }
}

/// Bilinear and trilinear filtering have no place where a small error of a coordinate or of lambda
/// makes a jump, so that no pixel may be off by more than the last bit; and every format is read as
/// its definition says. The scenes have no depth buffer, whose resolution would decide some pixels.
#[test]
fn smooth_filters_are_within_the_last_bit_in_all_formats() {
    for scene in ["crate", "globe", "corridor"] {
        let frame = frame(scene);
        for (name, format) in FORMATS {
            for filter in ["bilinear", "trilinear"] {
                let filtering = Filtering {
                    format,
                    ..named(filter)
                };
                let report =
                    compare(&frame, Perspective::Exact, 120, &filtering).expect("a frame in range");
                let off = report.comparison.colour_error;
                assert!(off.max <= step(format), "{scene} {name} {filter}: {off:?}");
            }
        }
    }
}

/// Where levels or texels switch, pixels on the very border may take the other side: few do.
#[test]
fn filters_that_switch_are_within_the_last_bit_nearly_everywhere() {
    for scene in ["globe", "corridor"] {
        let frame = frame(scene);
        for (name, min) in Minify::ALL {
            let filtering = Filtering {
                format: Format::Rgb888,
                ..Filtering::named(min)
            };
            let report =
                compare(&frame, Perspective::Exact, 120, &filtering).expect("a frame in range");
            // Lambda is off by at most 2^-12 of the octave between two switches, coordinates by
            // less than 2^-9 texel on either axis at level 0.
            let off = report.comparison.colour_error;
            let last_bit = if min.image == Within::Linear5 {
                // 1/64 of what a channel spans along each axis, and between two levels, and half a bit
                // for each rounding (`LinearTexels5`).
                if min.has_levels() {
                    1.5 + 3.0 * 255.0 / 64.0
                } else {
                    1.0 + 2.0 * 255.0 / 64.0
                }
            } else {
                1.0
            };
            assert!(off.p99 <= last_bit, "{scene} {name}: {off:?}");
        }
    }
}

#[test]
fn bands_change_nothing() {
    let frame = frame("room");
    for (_, min) in Minify::ALL {
        for per in [Per::Triangle, Per::Span, Per::Piece, Per::Pixel] {
            let filtering = Filtering {
                per,
                ..Filtering::named(min)
            };
            let draw = |rows| {
                pixels(&frame, Perspective::Every(16), rows, &filtering).expect("a frame in range")
            };
            assert_eq!(draw(120), draw(7), "{filtering}");
        }
    }
}

/// The figure of the lectures: mip maps take the moire away, and bilinear filtering alone does not.
#[test]
fn checkers_have_no_moire_with_mip_maps() {
    let frame = frame("checkers");
    let how = Filtering::default();
    let study = study(&frame, Perspective::Exact, &how, 512, || {}).expect("a frame in range");
    let aliasing = |name: &str| {
        let outcome = study.outcomes.iter().find(|o| o.numbers.filter == name);
        outcome.expect("a filter of the study").numbers.aliasing
    };
    assert!(aliasing("trilinear") < aliasing("nearest") / 4.0);
    assert!(aliasing("bilinear") > 2.0 * aliasing("trilinear"));
    assert!(aliasing("aniso:8") < aliasing("trilinear"));
    let error = |name: &str| {
        let outcome = study.outcomes.iter().find(|o| o.numbers.filter == name);
        outcome.expect("a filter of the study").numbers.error
    };
    assert!(error("aniso:8") < error("trilinear") && error("trilinear") < error("nearest") / 4.0);
}

/// Light averages to brighter colours than stored numbers, far from the eye.
#[test]
fn averages_of_light_are_brighter() {
    let frame = frame("checkers");
    let sum = |average| {
        let filtering = Filtering {
            average,
            ..named("trilinear")
        };
        let pixels = pixels(&frame, Perspective::Exact, 120, &filtering).expect("a frame");
        pixels
            .rgb()
            .iter()
            .flatten()
            .map(|&c| u64::from(c))
            .sum::<u64>()
    };
    assert!(sum(Average::Light) > sum(Average::Stored));
}

#[test]
fn a_level_is_shown_by_its_colour() {
    // A texel a pixel: lambda is 0.
    let frame = frame("wall");
    let level = |bias: i32| {
        // Half the size of the benchmark's frame: two texels a pixel.
        let filtering = Filtering {
            bias: I16F16::from_num(bias - 1),
            ..named("linear-mip-nearest")
        };
        let image = view(&frame, Perspective::Exact, 120, &filtering, View::Level)
            .expect("a frame in range");
        let first = *image.get_pixel(0, 0);
        let same = image
            .enumerate_pixels()
            .filter(|(_, y, p)| *y < 120 && **p == first);
        assert_eq!(same.count(), 160 * 120, "one level everywhere");
        first
    };
    assert_ne!(level(0), level(1));
    assert_ne!(level(1), level(2));
    // Nothing is finer than level 0, and nothing coarser than one texel.
    assert_eq!(level(0), level(-3));
    assert_eq!(level(9), level(12));
}

#[test]
fn coordinates_are_shown_by_red_and_green() {
    let image = view(
        &frame("wall"),
        Perspective::Exact,
        120,
        &Filtering::default(),
        View::Uv,
    )
    .expect("a frame in range");
    // u from 0 to 1.25 over 160 pixels, v from 0 to 0.9375 over 120: pixel (63, 63) is half way.
    let [r, g, b] = image.get_pixel(63, 63).0;
    assert_eq!([r, g, b], [127, 127, 32]);
    // The second repeat.
    assert_eq!(image.get_pixel(130, 0).0[2], 160);
}

#[test]
fn frames_have_as_many_bits_as_their_textures() {
    let frame = frame("crate");
    for (_, format) in FORMATS {
        let filtering = Filtering {
            format,
            ..named("bilinear")
        };
        let drawn = pixels(&frame, Perspective::Exact, 120, &filtering).expect("a frame");
        let eight = step(format) == 1.0;
        assert_eq!(matches!(drawn, Pixels::Rgb888(_)), eight, "{format:?}");
    }
}

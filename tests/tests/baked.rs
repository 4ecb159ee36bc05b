//! Text that `host-sim bake` writes: it compiles without warnings, the core takes it, and its texels
//! are those of the picture. A test of host-sim checks that the command still writes these files.

use std::path::Path;

use host_sim::atlas;
use host_sim::filtering::Format;
use host_sim::picture::Picture;
use host_sim::reference::Beyond;
use host_sim::reference::filter::Level;
use host_sim::stored::Stored;
use multum::colour::{Rgba5551, Rgba8888};
use multum::embedded_graphics::pixelcolor::{Gray8, GrayColor, Rgb565, Rgb888, RgbColor};
use multum::pyramid::Pyramid;
use multum::pyramid::average::Average;
use multum::texture::{Texels, Window};

macro_rules! baked {
    ($($module:ident)*) => {$(
        #[expect(unreachable_pub, reason = "the text may be in a library's public module")]
        mod $module {
            include!(concat!("../baked/", stringify!($module), ".rs"));
        }
    )*};
}

baked!(rgb565 rgb888 gray8 palette8 palette4 rgba5551 rgba8888 bc1 morton light);
baked!(rgb565_one palette4_one bc1_one atlas_of_two padded);

/// A texel in units of its channels, as the reference has them.
trait Plain {
    fn plain(self) -> [f64; 4];
}

impl Plain for Rgb565 {
    fn plain(self) -> [f64; 4] {
        [self.r().into(), self.g().into(), self.b().into(), 0.0]
    }
}

impl Plain for Rgb888 {
    fn plain(self) -> [f64; 4] {
        [self.r().into(), self.g().into(), self.b().into(), 0.0]
    }
}

impl Plain for Gray8 {
    fn plain(self) -> [f64; 4] {
        [self.luma().into(), 0.0, 0.0, 0.0]
    }
}

impl Plain for Rgba5551 {
    fn plain(self) -> [f64; 4] {
        let bits = u32::from(self.0);
        [bits >> 11, bits >> 6 & 31, bits >> 1 & 31, bits & 1].map(f64::from)
    }
}

impl Plain for Rgba8888 {
    fn plain(self) -> [f64; 4] {
        self.0.map(f64::from)
    }
}

fn picture(name: &str) -> Picture {
    let path = Path::new(env!("CARGO_MANIFEST_DIR"))
        .join("baked")
        .join(name);
    Picture::load(&path).expect("a picture").0
}

/// The levels that a picture should have, from the formats' definitions.
fn levels(picture: &Picture, format: Format, average: Average) -> Vec<Level> {
    let stored = Stored::new(picture, format, average).expect("a picture that can be stored");
    stored.reference()
}

fn assert_level<T: Texels<Colour: Plain>>(texture: &T, level: &Level) {
    let (log2_width, log2_height) = texture.log2_size();
    assert_eq!(
        [1 << log2_width, 1 << log2_height],
        [level.width(), level.height()]
    );
    let places = (0..level.height()).flat_map(|y| (0..level.width()).map(move |x| (x, y)));
    let texels: Vec<_> = places.map(|(x, y)| texture.texel(x, y).plain()).collect();
    assert_eq!(texels, level.texels());
}

fn assert_pyramid<T: Texels<Colour: Plain>>(pyramid: &Pyramid<T>, format: Format) {
    assert_levels(
        pyramid,
        &levels(&picture("picture.png"), format, Average::Stored),
    );
}

fn assert_levels<T: Texels<Colour: Plain>>(pyramid: &Pyramid<T>, levels: &[Level]) {
    assert_eq!(pyramid.iter().count(), levels.len());
    for (texture, level) in pyramid.iter().zip(levels) {
        assert_level(texture, level);
    }
}

#[test]
fn all_levels_of_every_format_are_those_of_the_picture() {
    assert_pyramid(&rgb565::RGB565, Format::Rgb565);
    assert_pyramid(&rgb888::RGB888, Format::Rgb888);
    assert_pyramid(&gray8::GRAY8, Format::Gray8);
    assert_pyramid(&rgba5551::RGBA5551, Format::Rgba5551);
    assert_pyramid(&rgba8888::RGBA8888, Format::Rgba8888);
    assert_pyramid(&bc1::BC1, Format::Bc1);
    assert_pyramid(&morton::MORTON, Format::Morton);
    let palette = palette8::palette8().expect("complete levels");
    assert_pyramid(&palette, Format::Palette8);
    let palette = palette4::palette4().expect("complete levels");
    assert_pyramid(&palette, Format::Palette4);
}

#[test]
fn levels_are_averaged_as_asked() {
    let picture = picture("picture.png");
    let light = levels(&picture, Format::Rgb565, Average::Light);
    assert_levels(&light::LIGHT, &light);
    assert_ne!(light, levels(&picture, Format::Rgb565, Average::Stored));
}

#[test]
fn one_level_is_the_finest() {
    let finest = |format| levels(&picture("picture.png"), format, Average::Stored).remove(0);
    assert_level(&rgb565_one::RGB565_ONE, &finest(Format::Rgb565));
    assert_level(&palette4_one::PALETTE4_ONE, &finest(Format::Palette4));
    assert_level(&bc1_one::BC1_ONE, &finest(Format::Bc1));
}

/// As many levels as the rectangles' shorter sides have.
#[test]
fn windows_of_an_atlas_are_the_pictures_level_by_level() {
    for (name, left, top, width, height) in atlas_of_two::RECTANGLES {
        let own = picture(&format!("{name}.png"));
        assert_eq!([own.width(), own.height()], [width, height]);
        let own = levels(&own, Format::Rgb565, Average::Stored);
        let exact = width.min(height).ilog2() + 1;
        for (level, own) in (0..exact).zip(&own) {
            let [left, top, width, height] = [left, top, width, height].map(|n| n >> level);
            let window = Window::new(*atlas_of_two::ATLAS.level(level), left, top, width, height);
            assert_level(&window.expect("a rectangle inside"), own);
        }
    }
}

#[test]
fn padding_repeats_the_edges_around_rectangles() {
    for (name, left, top, width, height) in padded::RECTANGLES {
        let own = picture(&format!("{name}.png"));
        let window = Window::new(padded::PADDED, left, top, width, height);
        let finest = levels(&own, Format::Rgb888, Average::Stored).remove(0);
        assert_level(&window.expect("a rectangle inside"), &finest);
        let around = atlas::padded(&own, 1, Beyond::Clamp).expect("a small picture");
        let (cell, inside) = (&around.picture, around.inside);
        let [left, top] = [left - inside.left, top - inside.top];
        let window = Window::new(padded::PADDED, left, top, cell.width(), cell.height());
        let finest = levels(cell, Format::Rgb888, Average::Stored).remove(0);
        assert_level(&window.expect("a cell inside"), &finest);
    }
}

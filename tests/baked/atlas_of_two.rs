// Made by host-sim bake --name ATLAS --format rgb565 --levels all --average stored
// An atlas of 2 pictures, 4x4 texels, 3 levels, 42 bytes in flash.

/// An atlas of 2 pictures, 4x4 texels, 3 levels.
pub static ATLAS: multum::pyramid::Pyramid<multum::texture::Texture<'static, multum::embedded_graphics::pixelcolor::Rgb565>> =
    match multum::pyramid::Pyramid::<multum::texture::Texture<'_, _>>::new(&ATLAS_TEXELS, 4, 4) {
        Ok(texture) => texture,
        Err(_) => panic!("the core refuses this texture"),
    };

#[allow(long_running_const_eval)]
static ATLAS_TEXELS: [multum::embedded_graphics::pixelcolor::Rgb565; 21] = atlas_table(b"\
    \x20\xf9\xe4\xc3\xc8\x86\xab\x49\x38\xed\x1c\xa8\xc1\x72\xa4\x3d\x0c\x00\x0c\xf0\x00\x00\x00\x00\
    \xcc\x07\xcc\xf7\x00\x00\x00\x00\x8e\xd2\x46\x64\xec\x7b\x00\x00\xa8\x6a");

const fn atlas_unit(bytes: [u8; 2]) -> multum::embedded_graphics::pixelcolor::Rgb565 {
    let [low, high] = bytes;
    multum::embedded_graphics::pixelcolor::Rgb565::new(high >> 3, high << 3 | low >> 5, low)
}

const fn atlas_table<const N: usize>(bytes: &[u8]) -> [multum::embedded_graphics::pixelcolor::Rgb565; N] {
    let (pieces, rest) = bytes.as_chunks::<2>();
    assert!(pieces.len() == N && rest.is_empty(), "2 bytes each");
    let mut table = [atlas_unit([0; 2]); N];
    let mut i = 0;
    while i < N {
        table[i] = atlas_unit(pieces[i]);
        i += 1;
    }
    table
}

/// Name, left, top, width and height of each picture, in texels of level 0 from the upper left
/// corner: what `multum::texture::Window::new` takes.
///
/// In level n all four are divided by 2^n, without a remainder until the picture's shorter
/// side is one texel.
pub const RECTANGLES: [(&str, u32, u32, u32, u32); 2] = [
    ("picture", 0, 0, 4, 2),
    ("square", 0, 2, 2, 2),
];

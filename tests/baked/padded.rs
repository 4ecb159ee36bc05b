// Made by host-sim bake --name PADDED --format rgb888 --levels one --padding 1
// An atlas of 2 pictures, 8x8 texels, 1 level, 192 bytes in flash.

/// An atlas of 2 pictures, 8x8 texels, 1 level.
pub static PADDED: multum::texture::Texture<'static, multum::embedded_graphics::pixelcolor::Rgb888> =
    match multum::texture::Texture::new(&PADDED_TEXELS, 8, 8) {
        Ok(texture) => texture,
        Err(_) => panic!("the core refuses this texture"),
    };

#[allow(long_running_const_eval)]
static PADDED_TEXELS: [multum::embedded_graphics::pixelcolor::Rgb888; 64] = padded_table(b"\
    \xff\x25\x00\xff\x25\x00\xff\x25\x00\xc3\x7f\x1f\x87\xd9\x3e\x4b\x33\x5d\x4b\x33\x5d\x4b\x33\x5d\
    \xff\x25\x00\xff\x25\x00\xff\x25\x00\xc3\x7f\x1f\x87\xd9\x3e\x4b\x33\x5d\x4b\x33\x5d\x4b\x33\x5d\
    \xeb\xa7\xc8\xeb\xa7\xc8\xeb\xa7\xc8\xaf\x01\xe7\x73\x5b\x06\x37\xb5\x25\x37\xb5\x25\x37\xb5\x25\
    \xeb\xa7\xc8\xeb\xa7\xc8\xeb\xa7\xc8\xaf\x01\xe7\x73\x5b\x06\x37\xb5\x25\x37\xb5\x25\x37\xb5\x25\
    \x00\x00\x63\x00\x00\x63\xfa\x00\x63\xfa\x00\x63\x00\x00\x00\x00\x00\x00\x00\x00\x00\x00\x00\x00\
    \x00\x00\x63\x00\x00\x63\xfa\x00\x63\xfa\x00\x63\x00\x00\x00\x00\x00\x00\x00\x00\x00\x00\x00\x00\
    \x00\xfa\x63\x00\xfa\x63\xfa\xfa\x63\xfa\xfa\x63\x00\x00\x00\x00\x00\x00\x00\x00\x00\x00\x00\x00\
    \x00\xfa\x63\x00\xfa\x63\xfa\xfa\x63\xfa\xfa\x63\x00\x00\x00\x00\x00\x00\x00\x00\x00\x00\x00\x00");

const fn padded_unit(bytes: [u8; 3]) -> multum::embedded_graphics::pixelcolor::Rgb888 {
    let [r, g, b] = bytes;
    multum::embedded_graphics::pixelcolor::Rgb888::new(r, g, b)
}

const fn padded_table<const N: usize>(bytes: &[u8]) -> [multum::embedded_graphics::pixelcolor::Rgb888; N] {
    let (pieces, rest) = bytes.as_chunks::<3>();
    assert!(pieces.len() == N && rest.is_empty(), "3 bytes each");
    let mut table = [padded_unit([0; 3]); N];
    let mut i = 0;
    while i < N {
        table[i] = padded_unit(pieces[i]);
        i += 1;
    }
    table
}

/// Name, left, top, width and height of each picture, in texels of level 0 from the upper left
/// corner: what `multum::texture::Window::new` takes.
///
/// Each has its edges repeated around it (--padding 1), for meshes whose coordinates lie in
/// the atlas: (left + u * width) / 8 and (top + v * height) / 8.
pub const RECTANGLES: [(&str, u32, u32, u32, u32); 2] = [
    ("picture", 2, 1, 4, 2),
    ("square", 1, 5, 2, 2),
];

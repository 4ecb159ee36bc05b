// Made by host-sim bake --name PALETTE8 --format palette8 --levels all --average stored
// A picture, 4x2 texels, 3 levels, 30 bytes in flash.

/// A picture, 4x2 texels, 3 levels.
///
/// Level 0 has palette indices, the others colours. A pyramid of both is put together when
/// the program starts; its levels are checked by the compiler.
///
/// # Errors
///
/// None: the levels are complete.
pub fn palette8() -> Result<
    multum::pyramid::Pyramid<multum::pyramid::build::IndexedOrDirect<'static, multum::embedded_graphics::pixelcolor::Rgb565, 8>>,
    multum::error::Error,
> {
    multum::pyramid::Pyramid::from_levels(&PALETTE8_LEVELS)
}

#[allow(long_running_const_eval)]
static PALETTE8_LEVELS: [multum::pyramid::build::IndexedOrDirect<'static, multum::embedded_graphics::pixelcolor::Rgb565, 8>; 3] = [
    multum::pyramid::build::IndexedOrDirect::Indexed(match multum::texture::Indexed::new(&PALETTE8_INDICES, &PALETTE8_PALETTE, 4, 2) {
        Ok(texture) => texture,
        Err(_) => panic!("the core refuses this texture"),
    }),
    multum::pyramid::build::IndexedOrDirect::Direct(match multum::texture::Texture::new(&PALETTE8_LEVEL_1, 2, 1) {
        Ok(texture) => texture,
        Err(_) => panic!("the core refuses this texture"),
    }),
    multum::pyramid::build::IndexedOrDirect::Direct(match multum::texture::Texture::new(&PALETTE8_LEVEL_2, 1, 1) {
        Ok(texture) => texture,
        Err(_) => panic!("the core refuses this texture"),
    }),
];

static PALETTE8_INDICES: [u8; 8] = *b"\x00\x01\x02\x03\x04\x05\x06\x07";
#[allow(long_running_const_eval)]
static PALETTE8_PALETTE: [multum::embedded_graphics::pixelcolor::Rgb565; 8] = palette8_table(b"\x20\xf9\xe4\xc3\xc8\x86\xab\x49\x38\xed\x1c\xa8\xc1\x72\xa4\x3d");
#[allow(long_running_const_eval)]
static PALETTE8_LEVEL_1: [multum::embedded_graphics::pixelcolor::Rgb565; 2] = palette8_table(b"\x8e\xd2\x46\x64");
#[allow(long_running_const_eval)]
static PALETTE8_LEVEL_2: [multum::embedded_graphics::pixelcolor::Rgb565; 1] = palette8_table(b"\x6a\x9b");

const fn palette8_unit(bytes: [u8; 2]) -> multum::embedded_graphics::pixelcolor::Rgb565 {
    let [low, high] = bytes;
    multum::embedded_graphics::pixelcolor::Rgb565::new(high >> 3, high << 3 | low >> 5, low)
}

const fn palette8_table<const N: usize>(bytes: &[u8]) -> [multum::embedded_graphics::pixelcolor::Rgb565; N] {
    let (pieces, rest) = bytes.as_chunks::<2>();
    assert!(pieces.len() == N && rest.is_empty(), "2 bytes each");
    let mut table = [palette8_unit([0; 2]); N];
    let mut i = 0;
    while i < N {
        table[i] = palette8_unit(pieces[i]);
        i += 1;
    }
    table
}

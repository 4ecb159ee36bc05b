// Made by host-sim bake --name PALETTE4_ONE --format palette4 --levels one
// A picture, 4x2 texels, 1 level, 20 bytes in flash.

/// A picture, 4x2 texels, 1 level.
#[allow(long_running_const_eval)]
pub static PALETTE4_ONE: multum::texture::Indexed<'static, multum::embedded_graphics::pixelcolor::Rgb565, 4> =
    match multum::texture::Indexed::new(&PALETTE4_ONE_INDICES, &PALETTE4_ONE_PALETTE, 4, 2) {
        Ok(texture) => texture,
        Err(_) => panic!("the core refuses this texture"),
    };

static PALETTE4_ONE_INDICES: [u8; 4] = *b"\x01\x23\x45\x67";
#[allow(long_running_const_eval)]
static PALETTE4_ONE_PALETTE: [multum::embedded_graphics::pixelcolor::Rgb565; 8] = palette4_one_table(b"\x20\xf9\xe4\xc3\xc8\x86\xab\x49\x38\xed\x1c\xa8\xc1\x72\xa4\x3d");

const fn palette4_one_unit(bytes: [u8; 2]) -> multum::embedded_graphics::pixelcolor::Rgb565 {
    let [low, high] = bytes;
    multum::embedded_graphics::pixelcolor::Rgb565::new(high >> 3, high << 3 | low >> 5, low)
}

const fn palette4_one_table<const N: usize>(bytes: &[u8]) -> [multum::embedded_graphics::pixelcolor::Rgb565; N] {
    let (pieces, rest) = bytes.as_chunks::<2>();
    assert!(pieces.len() == N && rest.is_empty(), "2 bytes each");
    let mut table = [palette4_one_unit([0; 2]); N];
    let mut i = 0;
    while i < N {
        table[i] = palette4_one_unit(pieces[i]);
        i += 1;
    }
    table
}

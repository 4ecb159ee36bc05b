// Made by host-sim bake --name GRAY8 --format gray8 --levels all --average stored
// A picture, 4x2 texels, 3 levels, 11 bytes in flash.

/// A picture, 4x2 texels, 3 levels.
pub static GRAY8: multum::pyramid::Pyramid<multum::texture::Texture<'static, multum::embedded_graphics::pixelcolor::Gray8>> =
    match multum::pyramid::Pyramid::<multum::texture::Texture<'_, _>>::new(&GRAY8_TEXELS, 4, 2) {
        Ok(texture) => texture,
        Err(_) => panic!("the core refuses this texture"),
    };

#[allow(long_running_const_eval)]
static GRAY8_TEXELS: [multum::embedded_graphics::pixelcolor::Gray8; 11] = gray8_table(b"\x51\x87\xbc\x3b\xb8\x37\x5a\x90\x72\x78\x75");

const fn gray8_unit(bytes: [u8; 1]) -> multum::embedded_graphics::pixelcolor::Gray8 {
    let [luma] = bytes;
    multum::embedded_graphics::pixelcolor::Gray8::new(luma)
}

const fn gray8_table<const N: usize>(bytes: &[u8]) -> [multum::embedded_graphics::pixelcolor::Gray8; N] {
    let (pieces, rest) = bytes.as_chunks::<1>();
    assert!(pieces.len() == N && rest.is_empty(), "1 bytes each");
    let mut table = [gray8_unit([0; 1]); N];
    let mut i = 0;
    while i < N {
        table[i] = gray8_unit(pieces[i]);
        i += 1;
    }
    table
}

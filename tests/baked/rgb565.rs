// Made by host-sim bake --name RGB565 --format rgb565 --levels all --average stored
// A picture, 4x2 texels, 3 levels, 22 bytes in flash.

/// A picture, 4x2 texels, 3 levels.
pub static RGB565: multum::pyramid::Pyramid<multum::texture::Texture<'static, multum::embedded_graphics::pixelcolor::Rgb565>> =
    match multum::pyramid::Pyramid::<multum::texture::Texture<'_, _>>::new(&RGB565_TEXELS, 4, 2) {
        Ok(texture) => texture,
        Err(_) => panic!("the core refuses this texture"),
    };

#[allow(long_running_const_eval)]
static RGB565_TEXELS: [multum::embedded_graphics::pixelcolor::Rgb565; 11] = rgb565_table(b"\x20\xf9\xe4\xc3\xc8\x86\xab\x49\x38\xed\x1c\xa8\xc1\x72\xa4\x3d\x8e\xd2\x46\x64\x6a\x9b");

const fn rgb565_unit(bytes: [u8; 2]) -> multum::embedded_graphics::pixelcolor::Rgb565 {
    let [low, high] = bytes;
    multum::embedded_graphics::pixelcolor::Rgb565::new(high >> 3, high << 3 | low >> 5, low)
}

const fn rgb565_table<const N: usize>(bytes: &[u8]) -> [multum::embedded_graphics::pixelcolor::Rgb565; N] {
    let (pieces, rest) = bytes.as_chunks::<2>();
    assert!(pieces.len() == N && rest.is_empty(), "2 bytes each");
    let mut table = [rgb565_unit([0; 2]); N];
    let mut i = 0;
    while i < N {
        table[i] = rgb565_unit(pieces[i]);
        i += 1;
    }
    table
}

// Made by host-sim bake --name LIGHT --format rgb565 --levels all --average light
// A picture, 4x2 texels, 3 levels, 22 bytes in flash.

/// A picture, 4x2 texels, 3 levels.
pub static LIGHT: multum::pyramid::Pyramid<multum::texture::Texture<'static, multum::embedded_graphics::pixelcolor::Rgb565>> =
    match multum::pyramid::Pyramid::<multum::texture::Texture<'_, _>>::new(&LIGHT_TEXELS, 4, 2) {
        Ok(texture) => texture,
        Err(_) => panic!("the core refuses this texture"),
    };

#[allow(long_running_const_eval)]
static LIGHT_TEXELS: [multum::embedded_graphics::pixelcolor::Rgb565; 11] = light_table(b"\x20\xf9\xe4\xc3\xc8\x86\xab\x49\x38\xed\x1c\xa8\xc1\x72\xa4\x3d\x73\xdb\xc7\x64\x2f\xac");

const fn light_unit(bytes: [u8; 2]) -> multum::embedded_graphics::pixelcolor::Rgb565 {
    let [low, high] = bytes;
    multum::embedded_graphics::pixelcolor::Rgb565::new(high >> 3, high << 3 | low >> 5, low)
}

const fn light_table<const N: usize>(bytes: &[u8]) -> [multum::embedded_graphics::pixelcolor::Rgb565; N] {
    let (pieces, rest) = bytes.as_chunks::<2>();
    assert!(pieces.len() == N && rest.is_empty(), "2 bytes each");
    let mut table = [light_unit([0; 2]); N];
    let mut i = 0;
    while i < N {
        table[i] = light_unit(pieces[i]);
        i += 1;
    }
    table
}

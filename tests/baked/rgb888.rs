// Made by host-sim bake --name RGB888 --format rgb888 --levels all --average stored
// A picture, 4x2 texels, 3 levels, 33 bytes in flash.

/// A picture, 4x2 texels, 3 levels.
pub static RGB888: multum::pyramid::Pyramid<multum::texture::Texture<'static, multum::embedded_graphics::pixelcolor::Rgb888>> =
    match multum::pyramid::Pyramid::<multum::texture::Texture<'_, _>>::new(&RGB888_TEXELS, 4, 2) {
        Ok(texture) => texture,
        Err(_) => panic!("the core refuses this texture"),
    };

#[allow(long_running_const_eval)]
static RGB888_TEXELS: [multum::embedded_graphics::pixelcolor::Rgb888; 11] = rgb888_table(b"\
    \xff\x25\x00\xc3\x7f\x1f\x87\xd9\x3e\x4b\x33\x5d\xeb\xa7\xc8\xaf\x01\xe7\x73\x5b\x06\x37\xb5\x25\
    \xd7\x53\x74\x5f\x87\x32\x9b\x6d\x53");

const fn rgb888_unit(bytes: [u8; 3]) -> multum::embedded_graphics::pixelcolor::Rgb888 {
    let [r, g, b] = bytes;
    multum::embedded_graphics::pixelcolor::Rgb888::new(r, g, b)
}

const fn rgb888_table<const N: usize>(bytes: &[u8]) -> [multum::embedded_graphics::pixelcolor::Rgb888; N] {
    let (pieces, rest) = bytes.as_chunks::<3>();
    assert!(pieces.len() == N && rest.is_empty(), "3 bytes each");
    let mut table = [rgb888_unit([0; 3]); N];
    let mut i = 0;
    while i < N {
        table[i] = rgb888_unit(pieces[i]);
        i += 1;
    }
    table
}

// Made by host-sim bake --name RGBA8888 --format rgba8888 --levels all --average stored
// A picture, 4x2 texels, 3 levels, 44 bytes in flash.

/// A picture, 4x2 texels, 3 levels.
pub static RGBA8888: multum::pyramid::Pyramid<multum::texture::Texture<'static, multum::colour::Rgba8888>> =
    match multum::pyramid::Pyramid::<multum::texture::Texture<'_, _>>::new(&RGBA8888_TEXELS, 4, 2) {
        Ok(texture) => texture,
        Err(_) => panic!("the core refuses this texture"),
    };

#[allow(long_running_const_eval)]
static RGBA8888_TEXELS: [multum::colour::Rgba8888; 11] = rgba8888_table(b"\
    \xff\x25\x00\xff\xc3\x7f\x1f\xff\x87\xd9\x3e\xc8\x4b\x33\x5d\x28\xeb\xa7\xc8\xff\xaf\x01\xe7\x7f\
    \x73\x5b\x06\x80\x37\xb5\x25\x00\xd7\x53\x74\xdf\x5f\x87\x32\x5c\x9b\x6d\x53\x9e");

const fn rgba8888_unit(bytes: [u8; 4]) -> multum::colour::Rgba8888 {
    multum::colour::Rgba8888(bytes)
}

const fn rgba8888_table<const N: usize>(bytes: &[u8]) -> [multum::colour::Rgba8888; N] {
    let (pieces, rest) = bytes.as_chunks::<4>();
    assert!(pieces.len() == N && rest.is_empty(), "4 bytes each");
    let mut table = [rgba8888_unit([0; 4]); N];
    let mut i = 0;
    while i < N {
        table[i] = rgba8888_unit(pieces[i]);
        i += 1;
    }
    table
}

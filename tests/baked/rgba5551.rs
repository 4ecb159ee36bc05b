// Made by host-sim bake --name RGBA5551 --format rgba5551 --levels all --average stored
// A picture, 4x2 texels, 3 levels, 22 bytes in flash.

/// A picture, 4x2 texels, 3 levels.
pub static RGBA5551: multum::pyramid::Pyramid<multum::texture::Texture<'static, multum::colour::Rgba5551>> =
    match multum::pyramid::Pyramid::<multum::texture::Texture<'_, _>>::new(&RGBA5551_TEXELS, 4, 2) {
        Ok(texture) => texture,
        Err(_) => panic!("the core refuses this texture"),
    };

#[allow(long_running_const_eval)]
static RGBA5551_TEXELS: [multum::colour::Rgba5551; 11] = rgba5551_table(b"\x01\xf9\xc9\xc3\x91\x86\x96\x49\x31\xed\x38\xa8\xc3\x72\x88\x3d\x9d\xd2\x0d\x64\x55\x9b");

const fn rgba5551_unit(bytes: [u8; 2]) -> multum::colour::Rgba5551 {
    multum::colour::Rgba5551(u16::from_le_bytes(bytes))
}

const fn rgba5551_table<const N: usize>(bytes: &[u8]) -> [multum::colour::Rgba5551; N] {
    let (pieces, rest) = bytes.as_chunks::<2>();
    assert!(pieces.len() == N && rest.is_empty(), "2 bytes each");
    let mut table = [rgba5551_unit([0; 2]); N];
    let mut i = 0;
    while i < N {
        table[i] = rgba5551_unit(pieces[i]);
        i += 1;
    }
    table
}

// Made by host-sim bake --name BC1 --format bc1 --levels all --average stored
// A picture, 4x2 texels, 3 levels, 24 bytes in flash.

/// A picture, 4x2 texels, 3 levels.
pub static BC1: multum::pyramid::Pyramid<multum::texture::Bc1<'static>> =
    match multum::pyramid::Pyramid::<multum::texture::Bc1<'_>>::new(&BC1_TEXELS, 4, 2) {
        Ok(texture) => texture,
        Err(_) => panic!("the core refuses this texture"),
    };

#[allow(long_running_const_eval)]
static BC1_TEXELS: [[u8; 8]; 3] = bc1_table(b"\x5c\xd9\xa2\x74\xdf\x52\x52\x52\xae\xd2\x02\x25\xfc\xfc\xfc\xfc\x00\x00\x6a\x9b\x55\x55\x55\x55");

const fn bc1_unit(bytes: [u8; 8]) -> [u8; 8] {
    bytes
}

const fn bc1_table<const N: usize>(bytes: &[u8]) -> [[u8; 8]; N] {
    let (pieces, rest) = bytes.as_chunks::<8>();
    assert!(pieces.len() == N && rest.is_empty(), "8 bytes each");
    let mut table = [bc1_unit([0; 8]); N];
    let mut i = 0;
    while i < N {
        table[i] = bc1_unit(pieces[i]);
        i += 1;
    }
    table
}

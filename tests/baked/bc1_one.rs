// Made by host-sim bake --name BC1_ONE --format bc1 --levels one
// A picture, 4x2 texels, 1 level, 8 bytes in flash.

/// A picture, 4x2 texels, 1 level.
pub static BC1_ONE: multum::texture::Bc1<'static> =
    match multum::texture::Bc1::new(&BC1_ONE_TEXELS, 4, 2) {
        Ok(texture) => texture,
        Err(_) => panic!("the core refuses this texture"),
    };

#[allow(long_running_const_eval)]
static BC1_ONE_TEXELS: [[u8; 8]; 1] = bc1_one_table(b"\x5c\xd9\xa2\x74\xdf\x52\x52\x52");

const fn bc1_one_unit(bytes: [u8; 8]) -> [u8; 8] {
    bytes
}

const fn bc1_one_table<const N: usize>(bytes: &[u8]) -> [[u8; 8]; N] {
    let (pieces, rest) = bytes.as_chunks::<8>();
    assert!(pieces.len() == N && rest.is_empty(), "8 bytes each");
    let mut table = [bc1_one_unit([0; 8]); N];
    let mut i = 0;
    while i < N {
        table[i] = bc1_one_unit(pieces[i]);
        i += 1;
    }
    table
}

//! What a texture filter strives for.

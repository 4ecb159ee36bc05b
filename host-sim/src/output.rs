//! Files that are written: whole or not at all.

use std::io::{Cursor, Write};
use std::path::Path;

use image::{ImageFormat, Rgb, RgbImage};

use crate::error::Error;

/// Pixels of a frame as an image, row by row from the top.
#[must_use]
pub fn image(pixels: &[[u8; 3]], width: u32) -> RgbImage {
    let height = pixels.len() as u32 / width.max(1);
    RgbImage::from_fn(width, height, |x, y| Rgb(pixels[(y * width + x) as usize]))
}

/// Writes an image as PNG, as [`write()`] does.
///
/// # Errors
///
/// [`Error::Write`].
pub fn write_png(image: &RgbImage, path: &Path) -> Result<(), Error> {
    let mut bytes = Cursor::new(Vec::new());
    image
        .write_to(&mut bytes, ImageFormat::Png)
        .map_err(|e| Error::write(path, &e))?;
    write(path, bytes.get_ref())
}

/// Makes a folder, unless it is there, and tries whether files can be written into it: before work
/// that takes long.
///
/// # Errors
///
/// [`Error::Write`].
pub fn prepare(folder: &Path) -> Result<(), Error> {
    std::fs::create_dir_all(folder)
        .and_then(|()| tempfile::tempfile_in(folder))
        .map(drop)
        .map_err(|e| Error::write(folder, &e.kind()))
}

/// Writes a file by way of a temporary one beside it; folders on the way are made.
///
/// # Errors
///
/// [`Error::Write`]; nothing is left behind then, and a file that was there before is kept.
pub fn write(path: &Path, bytes: &[u8]) -> Result<(), Error> {
    // The kind alone: the rest of the text may name the temporary file.
    let failed = |e: std::io::Error| Error::write(path, &e.kind());
    let folder = match path.parent() {
        Some(parent) if !parent.as_os_str().is_empty() => parent,
        _ => Path::new("."),
    };
    std::fs::create_dir_all(folder).map_err(failed)?;
    if path.is_dir() {
        return Err(Error::write(path, &"it is a folder"));
    }
    let mut builder = tempfile::Builder::new();
    builder.prefix(".multum-");
    // Temporary files are private otherwise; the user's mask still applies.
    #[cfg(unix)]
    builder.permissions(std::os::unix::fs::PermissionsExt::from_mode(0o666));
    let mut file = builder.tempfile_in(folder).map_err(failed)?;
    file.write_all(bytes).map_err(failed)?;
    file.persist(path).map_err(|e| failed(e.error))?;
    Ok(())
}

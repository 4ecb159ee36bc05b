//! Reading whole files, with a bound: a device file must not fill the memory.

use std::fs::File;
use std::io::{Error as IoError, Read};
use std::path::Path;

use crate::error::Error;

/// Largest file that is read, in bytes.
const MAX_BYTES: u64 = 1 << 30;

/// The contents of `path`.
pub(crate) fn read(path: &Path) -> Result<Vec<u8>, Error> {
    let read = || -> Result<Vec<u8>, IoError> {
        let mut bytes = Vec::new();
        File::open(path)?
            .take(MAX_BYTES + 1)
            .read_to_end(&mut bytes)?;
        Ok(bytes)
    };
    let bytes = read().map_err(|e| Error::read(path, &e))?;
    if bytes.len() as u64 > MAX_BYTES {
        return Err(Error::content(
            &path.display().to_string(),
            "more than 1 GiB",
            "give a smaller file",
        ));
    }
    Ok(bytes)
}

/// The last part of a path, for notices.
pub(crate) fn name(path: &Path) -> String {
    path.file_name().map_or_else(
        || path.display().to_string(),
        |n| n.to_string_lossy().into_owned(),
    )
}

//! The bytes behind a glTF document: the binary chunk, data URIs, and files beside it.

use std::borrow::Cow;
use std::path::{Path, PathBuf};

use base64::Engine;
use base64::alphabet;
use base64::engine::general_purpose::GeneralPurposeConfig;
use base64::engine::{DecodePaddingMode, GeneralPurpose};
use gltf::Document;
use gltf::buffer::{self, View};

use super::super::Source;
use crate::error::Error;
use crate::file;
use crate::picture::Picture;

const REMEDY: &str = "export the model again as glTF 2.0";

/// Some exporters leave the padding out.
const BASE64: GeneralPurpose = GeneralPurpose::new(
    &alphabet::STANDARD,
    GeneralPurposeConfig::new().with_decode_padding_mode(DecodePaddingMode::Indifferent),
);

/// All buffers of a document, each at least as long as the document says.
pub(super) struct Data {
    buffers: Vec<Vec<u8>>,
    /// Where relative URIs start.
    directory: PathBuf,
}

impl Data {
    pub(super) fn load(
        document: &Document,
        mut blob: Option<Vec<u8>>,
        path: &Path,
        source: &Source,
    ) -> Result<Self, Error> {
        let directory = path.parent().unwrap_or(Path::new("")).to_owned();
        let mut buffers = Vec::new();
        for buffer in document.buffers() {
            let number = buffer.index();
            let bytes = match buffer.source() {
                buffer::Source::Bin => blob
                    .take()
                    .ok_or_else(|| source.error(&format!("buffer {number} has no data"), REMEDY))?,
                buffer::Source::Uri(uri) => {
                    fetch(uri, &directory, &format!("buffer {number}"), source)?
                }
            };
            if bytes.len() < buffer.length() {
                return Err(source.error(
                    &format!(
                        "buffer {number} is cut off: {} of {} bytes",
                        bytes.len(),
                        buffer.length()
                    ),
                    REMEDY,
                ));
            }
            buffers.push(bytes);
        }
        Ok(Self { buffers, directory })
    }

    /// The bytes of a buffer.
    pub(super) fn buffer(&self, number: usize) -> Option<&[u8]> {
        self.buffers.get(number).map(Vec::as_slice)
    }

    /// The bytes of a view, unless it reaches beyond its buffer.
    pub(super) fn view(&self, view: &View<'_>) -> Option<&[u8]> {
        let end = view.offset().checked_add(view.length())?;
        self.buffer(view.buffer().index())?.get(view.offset()..end)
    }

    /// Decodes an image of the document.
    pub(super) fn picture(
        &self,
        document: &Document,
        number: usize,
        source: &Source,
    ) -> Result<(Picture, Option<String>), Error> {
        let what = format!("image {number}");
        // Not Image::source(), which panics without a MIME type or URI; the type is guessed anyway.
        let image = document.as_json().images.get(number);
        let view = image.and_then(|image| image.buffer_view);
        let view = view.and_then(|view| document.views().nth(view.value()));
        let uri = image.and_then(|image| image.uri.as_deref());
        let bytes = match (view, uri) {
            (Some(view), _) => Cow::Borrowed(self.view(&view).ok_or_else(|| {
                source.error(&format!("{what} reaches beyond its buffer"), REMEDY)
            })?),
            (None, Some(uri)) if uri.starts_with("data:") => {
                Cow::Owned(fetch(uri, &self.directory, &what, source)?)
            }
            (None, Some(uri)) => {
                return Picture::load(&external(uri, &self.directory, &what, source)?);
            }
            (None, None) => {
                return Err(source.error(&format!("{what} has no data"), REMEDY));
            }
        };
        let label = format!("{}: {what}", source.place);
        let (picture, notice) = Picture::from_encoded(&bytes, &label)?;
        // Notices call files by their name alone.
        let notice = notice.map(|n| n.replacen(&source.place, &source.name, 1));
        Ok((picture, notice))
    }
}

/// What a URI holds or names. `what` is named in errors.
fn fetch(uri: &str, directory: &Path, what: &str, source: &Source) -> Result<Vec<u8>, Error> {
    let Some(rest) = uri.strip_prefix("data:") else {
        return file::read(&external(uri, directory, what, source)?);
    };
    let broken = |problem: &str| source.error(&format!("{what}: data URI {problem}"), REMEDY);
    let (kind, text) = rest.split_once(',').ok_or_else(|| broken("without data"))?;
    let bytes = percent_encoding::percent_decode_str(text);
    if kind.ends_with(";base64") {
        let encoded = Cow::from(bytes);
        BASE64
            .decode(encoded.as_ref())
            .map_err(|e| broken(&format!("with broken base64 ({e})")))
    } else {
        Ok(bytes.collect())
    }
}

/// The file that a relative URI names.
fn external(uri: &str, directory: &Path, what: &str, source: &Source) -> Result<PathBuf, Error> {
    if uri.contains("://") {
        return Err(source.error(
            &format!("{what} lies elsewhere: '{uri}'"),
            "export the model again with its data embedded",
        ));
    }
    let decoded = percent_encoding::percent_decode_str(uri).decode_utf8_lossy();
    let path = directory.join(decoded.as_ref());
    // Some exporters do not encode a percent sign.
    Ok(if path.is_file() {
        path
    } else {
        directory.join(uri)
    })
}

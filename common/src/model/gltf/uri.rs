//! URIs of buffers and images: data within the file, or another file in its folder.

use std::borrow::Cow;

use anyhow::{Result, anyhow, bail};
use base64::Engine;
use base64::alphabet::STANDARD;
use base64::engine::{DecodePaddingMode, GeneralPurpose, GeneralPurposeConfig};

/// Base64 as exporters write it, some without padding.
const BASE64: GeneralPurpose = GeneralPurpose::new(
    &STANDARD,
    GeneralPurposeConfig::new().with_decode_padding_mode(DecodePaddingMode::Indifferent),
);

/// The target of a URI.
pub(super) enum Uri<'a> {
    /// Bytes within the URI.
    Data(Vec<u8>),
    /// A path relative to the glTF file.
    Path(Cow<'a, str>),
}

impl<'a> Uri<'a> {
    /// Reads a URI.
    ///
    /// # Errors
    /// If its data are not base64, or it names another computer.
    pub fn of(uri: &'a str) -> Result<Self> {
        if let Some(data) = uri.strip_prefix("data:") {
            let Some((_, data)) = data.split_once(";base64,") else {
                bail!("is a data URI without \";base64,\"");
            };
            let bytes = BASE64.decode(data.trim_ascii());
            return bytes.map(Self::Data).map_err(|_| anyhow!("is a data URI that is not base64"));
        }
        // A drive's letter is not a scheme; the folder refuses it.
        if let Some((scheme, _)) = uri.split_once(':')
            && scheme.len() > 1
            && scheme.bytes().all(|byte| byte.is_ascii_alphanumeric() || b"+-.".contains(&byte))
            && scheme.starts_with(|c: char| c.is_ascii_alphabetic())
        {
            bail!("begins with \"{scheme}:\", and only files in the model's folder are read");
        }
        let decoded = percent_encoding::percent_decode_str(uri).decode_utf8();
        // Exporters that do not encode write a bare '%'.
        Ok(Self::Path(decoded.unwrap_or(Cow::Borrowed(uri))))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn data_and_paths_are_told_apart() {
        let path = |uri| match Uri::of(uri).unwrap() {
            Uri::Path(path) => path.into_owned(),
            Uri::Data(_) => panic!("{uri} is a path"),
        };
        assert_eq!(path("a%20b.png"), "a b.png");
        assert_eq!(path("100%.png"), "100%.png");
        assert_eq!(path("caf%C3%A9/x"), "café/x");
        assert_eq!(path("%FF.bin"), "%FF.bin");
        assert_eq!(path("C:/a.png"), "C:/a.png");
        for data in ["data:;base64,AQI=", "data:application/octet-stream;base64,AQI"] {
            assert!(matches!(Uri::of(data), Ok(Uri::Data(bytes)) if bytes == [1, 2]), "{data}");
        }
        for wrong in ["data:,x", "data:;base64,*", "https://a.b/c.bin", "file:///etc/passwd"] {
            assert!(Uri::of(wrong).is_err(), "{wrong}");
        }
    }
}

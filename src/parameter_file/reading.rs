//! Parameter files are read with care: people write them with any editor.

use std::path::Path;

use super::{ParameterFile, ParameterFileError};
use crate::causes::with_causes;
use crate::file;

/// Far more than all variables of a model with a long story in the provenance \[byte\].
pub const LARGEST: u64 = 1 << 20;

/// Editors of Windows put it at the start of a file; RFC 8259, section 8.1, allows readers to ignore it.
const BYTE_ORDER_MARK: &[u8] = b"\xef\xbb\xbf";

impl ParameterFile {
    /// Reads a file of at most [`LARGEST`] bytes.
    pub fn read(path: &Path) -> Result<Self, ParameterFileError> {
        let bytes = file::read_at_most(path, LARGEST)
            .map_err(|source| ParameterFileError::Read { path: path.to_owned(), source })?;
        if bytes.starts_with(b"\xff\xfe") || bytes.starts_with(b"\xfe\xff") {
            return Err(ParameterFileError::Encoding { path: path.to_owned() });
        }
        let text = bytes.strip_prefix(BYTE_ORDER_MARK).unwrap_or(&bytes);
        // serde takes an array of a structure's fields for the structure.
        if text.trim_ascii_start().first().is_some_and(|first| *first != b'{') {
            let reason = "expected an object, {\"model\": NAME, \"values\": {...}}".to_owned();
            return Err(ParameterFileError::Syntax { path: path.to_owned(), reason });
        }
        serde_json::from_slice(text).map_err(|error| ParameterFileError::Syntax {
            path: path.to_owned(),
            reason: with_causes(&error),
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;
    use serde_json::json;
    use std::fs;

    /// What becomes of a file with these contents.
    fn read_bytes(bytes: &[u8]) -> Result<ParameterFile, ParameterFileError> {
        let directory = tempfile::tempdir().unwrap();
        let path = directory.path().join("file.json");
        fs::write(&path, bytes).unwrap();
        ParameterFile::read(&path)
    }

    const PLAIN: &str = r#"{"model": "MagneticBearingController", "values": {"sample_time": 0.001}}"#;

    /// Guards: "expected value at line 1 column 1" about files that Windows' editors wrote.
    #[test]
    fn a_byte_order_mark_is_no_part_of_the_text() {
        let marked = [BYTE_ORDER_MARK, PLAIN.as_bytes()].concat();
        assert_eq!(read_bytes(&marked).unwrap(), read_bytes(PLAIN.as_bytes()).unwrap());
        let wide: Vec<u8> = "\u{feff}{}".encode_utf16().flat_map(u16::to_le_bytes).collect();
        assert!(read_bytes(&wide).unwrap_err().to_string().ends_with("is in UTF-16, expected UTF-8"));
    }

    /// Guards: of two values for one variable the last one was taken without a word.
    #[test]
    fn a_key_that_is_there_twice_is_refused() {
        for (place, key) in [
            (r#""values": {"sample_time": 1, "observer.kind": 2, "sample_time": 1}"#, "sample_time"),
            (r#""values": {}, "units": {"a": "s", "a": "s"}"#, "a"),
            (r#""values": {}, "provenance": [{"deep": {"b": 1, "b": 1}}]"#, "b"),
        ] {
            let text = format!(r#"{{"model": "MagneticBearingController", {place}}}"#);
            let message = with_causes(&read_bytes(text.as_bytes()).unwrap_err());
            assert!(message.contains(&format!("the key \"{key}\" is there twice")), "{message}");
            assert!(message.contains("line 1"), "{message}");
        }
        for twice in
            [r#"{"model": "A", "model": "B", "values": {}}"#, r#"{"model": "A", "unit": "A", "values": {}}"#]
        {
            let message = with_causes(&read_bytes(twice.as_bytes()).unwrap_err());
            assert!(message.contains("duplicate field `model`"), "{message}");
        }
    }

    #[test]
    fn older_files_call_the_model_a_unit() {
        let older = PLAIN.replace("\"model\"", "\"unit\"");
        assert_ne!(older, PLAIN);
        assert_eq!(read_bytes(older.as_bytes()).unwrap(), read_bytes(PLAIN.as_bytes()).unwrap());
    }

    /// Guards: an array of the fields in their order, which other readers of such files refuse.
    #[test]
    fn what_is_no_object_is_refused() {
        for text in [r#"["MagneticBearingController", {"sample_time": 0.001}]"#, "\n 1", "null"] {
            let message = with_causes(&read_bytes(text.as_bytes()).unwrap_err());
            assert!(message.contains("expected an object"), "{message}");
        }
    }

    /// Guards: an unknown key of the file itself that breaks the line of the message.
    #[test]
    fn unknown_keys_are_printed_escaped() {
        let text = r#"{"model": "MaglevRigController", "values": {}, "a\nerror: b\u001b[2J\u202e": 1}"#;
        let message = with_causes(&read_bytes(text.as_bytes()).unwrap_err());
        assert!(message.contains(r"unknown field `a\nerror: b\u{1b}[2J\u{202e}`"), "{message}");
        assert!(!message.contains('\n'), "{message}");
    }

    /// Guards: reading /dev/zero until the memory is full.
    #[test]
    fn reading_is_bounded() {
        let long = PLAIN.replace("0.001", &format!("0.001{}", " ".repeat(LARGEST as usize)));
        let message = with_causes(&read_bytes(long.as_bytes()).unwrap_err());
        assert!(message.contains(&format!("larger than the {LARGEST} bytes")), "{message}");
        #[cfg(target_os = "linux")]
        assert!(matches!(ParameterFile::read(Path::new("/dev/zero")), Err(ParameterFileError::Read { .. })));
    }

    proptest! {
        #[test]
        fn any_bytes_are_read_or_refused(bytes: Vec<u8>) {
            let _ = read_bytes(&bytes);
        }

        /// Reading keeps every kind of value, whatever its key.
        #[test]
        fn provenance_may_be_anything(key: String, text: String, number: f64, whole: i64) {
            prop_assume!(number.is_finite());
            let provenance = json!({ key: [text, number, whole, null, true, {}] });
            let written = ParameterFile { provenance, ..read_bytes(PLAIN.as_bytes()).unwrap() };
            prop_assert_eq!(read_bytes(written.to_string().as_bytes()).unwrap(), written);
        }
    }
}

//! An XML document as a value of Rust.

use serde::Deserialize;

use crate::causes::with_causes;
use crate::host::error::{HostError, Result};

/// Reads the document `xml`.
pub(super) fn read<'xml, T: Deserialize<'xml>>(xml: &'xml str) -> Result<T> {
    quick_xml::de::from_str(xml).map_err(|error| HostError::Description { reason: with_causes(&error) })
}

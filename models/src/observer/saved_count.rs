//! Numbers of samples in a saved state: read back only if the arrays they refer to are that long.

use serde::de::{Deserialize, Deserializer, Error, Unexpected};

/// A number from 0 to `LARGEST`.
pub(super) fn count_up_to<'de, D: Deserializer<'de>, const LARGEST: usize>(
    deserializer: D,
) -> Result<usize, D::Error> {
    let count = usize::deserialize(deserializer)?;
    if count <= LARGEST {
        return Ok(count);
    }
    Err(D::Error::invalid_value(Unexpected::Unsigned(count as u64), &"a number of samples that were kept"))
}

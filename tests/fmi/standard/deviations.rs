//! Where the library differs from a standard on purpose.

use std::collections::BTreeSet;
use std::sync::LazyLock;

use serde::Deserialize;

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Entry {
    id: String,
    standard: String,
    section: String,
    text: String,
    library: String,
    reason: String,
}

#[derive(Deserialize)]
struct List {
    deviation: Vec<Entry>,
}

/// The entries of `deviations.toml`.
pub struct Deviations(Vec<Entry>);

impl Deviations {
    pub fn listed() -> &'static Self {
        static LISTED: LazyLock<Deviations> = LazyLock::new(|| {
            let list: List = toml::from_str(include_str!("deviations.toml")).unwrap();
            Deviations(list.deviation)
        });
        &LISTED
    }

    pub fn ids(&self) -> impl Iterator<Item = &str> {
        self.0.iter().map(|entry| entry.id.as_str())
    }

    /// Whether a deviation is still listed: one that is not is an error of the library.
    pub fn has(&self, id: &str) -> bool {
        self.ids().any(|known| known == id)
    }
}

#[test]
fn entries_are_complete() {
    let entries = &Deviations::listed().0;
    let ids: BTreeSet<_> = entries.iter().map(|entry| &entry.id).collect();
    assert_eq!(ids.len(), entries.len(), "an entry twice");
    for entry in entries {
        let texts = [&entry.standard, &entry.section, &entry.text, &entry.library, &entry.reason];
        assert!(texts.iter().all(|text| !text.is_empty()), "{}", entry.id);
    }
}

//! Elements of an XML document are counted before anything is built from them, and only those that are known are kept.

use std::fmt;
use std::marker::PhantomData;

use quick_xml::Reader;
use quick_xml::events::Event;
use serde::Deserialize;
use serde::de::{Deserializer, SeqAccess, Visitor};

use crate::causes::with_causes;
use crate::host::error::{HostError, Result};
use crate::host::limits::Limits;

/// Refuses a document with more elements than the limits allow. Memory does not grow with the document.
pub(super) fn check_number(xml: &str, limits: &Limits) -> Result<()> {
    let mut reader = Reader::from_str(xml);
    // What does not belong together is told by the parser proper, with the element's name.
    reader.config_mut().check_end_names = false;
    let mut elements = 0;
    loop {
        match reader.read_event() {
            Ok(Event::Start(_) | Event::Empty(_)) => elements += 1,
            Ok(Event::Eof) => return Ok(()),
            Ok(_) => {}
            Err(error) => return Err(HostError::Description { reason: with_causes(&error) }),
        }
        if elements > limits.description_elements {
            let limit = limits.description_elements as u64;
            return Err(HostError::OverLimit {
                subject: "modelDescription.xml".to_owned(),
                value: format!("more than {limit} elements"),
                limit,
                name: "description_elements",
            });
        }
    }
}

/// An element that may be one of a later edition.
pub(super) trait Known {
    fn is_known(&self) -> bool;
}

/// For `#[serde(deserialize_with)]`: the known elements of a list. Others take no memory, however many there are.
pub(super) fn known<'de, T, D>(deserializer: D) -> std::result::Result<Vec<T>, D::Error>
where
    T: Deserialize<'de> + Known,
    D: Deserializer<'de>,
{
    struct KnownElements<T>(PhantomData<T>);

    impl<'de, T: Deserialize<'de> + Known> Visitor<'de> for KnownElements<T> {
        type Value = Vec<T>;

        fn expecting(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
            formatter.write_str("a list of elements")
        }

        fn visit_seq<A: SeqAccess<'de>>(self, mut elements: A) -> std::result::Result<Vec<T>, A::Error> {
            let mut all = Vec::new();
            while let Some(element) = elements.next_element::<T>()? {
                if element.is_known() {
                    all.push(element);
                }
            }
            Ok(all)
        }
    }

    deserializer.deserialize_seq(KnownElements(PhantomData))
}

//! The number of elements in an XML document, counted before anything is built from them.

use quick_xml::Reader;
use quick_xml::events::Event;

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

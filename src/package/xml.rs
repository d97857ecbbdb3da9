//! What all XML documents of a package have in common.

use std::io;

use quick_xml::escape::partial_escape;
use quick_xml::events::{BytesDecl, Event, attributes};
use quick_xml::name::QName;

use super::{GenerationTime, licenses};

/// Program that wrote the document.
const GENERATION_TOOL: &str = concat!("maglev-fmu ", env!("CARGO_PKG_VERSION"));

/// An attribute whose name is a constant.
pub type Attribute = attributes::Attribute<'static>;

/// Writes elements into memory, indented.
pub type Writer = quick_xml::Writer<Vec<u8>>;

/// An XML document: the element `root` with its attributes and with what `content` writes inside.
pub fn document(
    root: &str,
    attributes: impl IntoIterator<Item = Attribute>,
    content: impl FnOnce(&mut Writer) -> io::Result<()>,
) -> String {
    let mut writer = Writer::new_with_indent(Vec::new(), b' ', 2);
    let declaration = Event::Decl(BytesDecl::new("1.0", Some("UTF-8"), None));
    writer
        .write_event(declaration)
        .and_then(|()| element(&mut writer, root, attributes, content))
        .expect("memory takes every byte");
    let mut text = String::from_utf8(writer.into_inner()).expect("names and values are text");
    text.push('\n');
    text
}

/// Writes the element `name` with what `content` writes inside.
pub fn element(
    writer: &mut Writer,
    name: &str,
    attributes: impl IntoIterator<Item = Attribute>,
    content: impl FnOnce(&mut Writer) -> io::Result<()>,
) -> io::Result<()> {
    writer.create_element(name).with_attributes(attributes).write_inner_content(content)?;
    Ok(())
}

/// Writes the element `name` with nothing inside.
pub fn empty_element(
    writer: &mut Writer,
    name: &str,
    attributes: impl IntoIterator<Item = Attribute>,
) -> io::Result<()> {
    writer.create_element(name).with_attributes(attributes).write_empty()?;
    Ok(())
}

/// An attribute. Apostrophes in its value stay as they are, since it is written in double quotes.
pub fn attribute(name: &'static str, value: impl ToString) -> Attribute {
    let value = partial_escape(value.to_string()).replace('"', "&quot;");
    Attribute { key: QName(name), value: value.into() }
}

/// An attribute that is left out if it has no value.
pub fn optional(name: &'static str, value: Option<impl ToString>) -> Option<Attribute> {
    value.map(|value| attribute(name, value))
}

/// A real number with all its digits.
pub fn real(value: f64) -> String {
    format!("{value:?}")
}

/// Whose work the document is, and what wrote it when, in the words that FMI and SSP share. A checked-in document
/// does not tell the time.
pub fn origin(time: Option<GenerationTime>) -> impl Iterator<Item = Attribute> {
    let always = [
        attribute("copyright", licenses::COPYRIGHT),
        attribute("license", licenses::NAME),
        attribute("generationTool", GENERATION_TOOL),
    ];
    always.into_iter().chain(optional("generationDateAndTime", time))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn documents_are_indented_and_leave_out_what_has_no_value() {
        let text = document("root", [attribute("size", 2)], |writer| {
            element(writer, "group", [], |writer| {
                let attributes = [attribute("is_first", true)]
                    .into_iter()
                    .chain(optional("absent", None::<f64>))
                    .chain(optional("present", Some(0.5)));
                empty_element(writer, "item", attributes)
            })
        });
        let expected = "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<root size=\"2\">\n  <group>\n    \
                        <item is_first=\"true\" present=\"0.5\"/>\n  </group>\n</root>\n";
        assert_eq!(text, expected);
    }

    #[test]
    fn values_may_hold_any_character() {
        let value = "x' < \"a & b\" > \u{3bc}\r";
        let text = document("root", [attribute("value", value)], |_| Ok(()));
        let root = roxmltree::Document::parse(&text).unwrap();
        assert_eq!(root.root_element().attribute("value"), Some(value));
        assert!(text.contains("x' &lt; &quot;a &amp; b&quot; &gt; \u{3bc}&#13;"));
    }

    #[test]
    fn real_numbers_keep_all_digits() {
        for value in [0.0, -0.1, 1e-300, 143.48, f64::MAX] {
            assert_eq!(real(value).parse::<f64>().unwrap(), value);
        }
    }
}

//! Messages on their way to the importer, formatted without the heap.

use core::ffi::c_char;
use core::fmt::{self, Write};

use super::Status;
use crate::model::memory::{OutOfMemory, try_vector};

/// Longest message in bytes, the final NUL included; the rest is cut off.
const LONGEST: usize = 1024;

/// Bytes of all messages of one call together.
const CAPACITY: usize = 16 * 1024;

/// One message, ready to be sent: plain memory, which an importer's exception or jump may pass by.
pub(super) struct Message {
    pub status: Status,
    /// Place in the list of categories.
    pub category: usize,
    text: [u8; LONGEST],
}

impl Message {
    /// A message; `is_format` if the importer takes it for a format of `printf`.
    pub(super) fn new(
        status: Status,
        category: usize,
        is_format: bool,
        arguments: fmt::Arguments<'_>,
    ) -> Self {
        let mut message = Self { status, category, text: [0; LONGEST] };
        write(&mut message.text, is_format, arguments);
        message
    }

    pub(super) fn as_ptr(&self) -> *const c_char {
        self.text.as_ptr().cast()
    }
}

/// Messages that wait until the call that makes them is done: the importer may end its logger with an exception or a
/// jump, and must not do so in the middle of a computation.
#[derive(Default)]
pub(super) struct Outbox {
    /// Records, one after the other: the header, the text and its NUL. Never grows beyond [`CAPACITY`].
    records: Vec<u8>,
    /// Where the next record begins.
    next: usize,
    /// Messages for which there was no room.
    lost: usize,
    /// What the last of those was.
    last_lost: Option<(Status, usize)>,
}

/// Status, category and length of the text with its NUL.
const HEADER: usize = 4;

impl Outbox {
    pub(super) fn new() -> Result<Self, OutOfMemory> {
        Ok(Self { records: try_vector("messages", CAPACITY)?, ..Self::default() })
    }

    #[inline]
    pub(super) fn is_empty(&self) -> bool {
        self.records.is_empty()
    }

    /// Appends a message. Remarks leave room for the message that says why the call was refused.
    pub(super) fn push(
        &mut self,
        status: Status,
        category: usize,
        is_format: bool,
        arguments: fmt::Arguments<'_>,
    ) {
        // A logger that does not come back after the last message leaves them all taken.
        if self.next == self.records.len() {
            self.records.clear();
            self.next = 0;
        }
        let kept_free = if status == Status::Ok { HEADER + LONGEST } else { 0 };
        let start = self.records.len();
        let room = self.records.capacity().saturating_sub(start + kept_free).min(HEADER + LONGEST);
        if room < HEADER + LONGEST {
            self.lost += 1;
            self.last_lost = Some((status, category));
            return;
        }
        self.records.resize(start + room, 0);
        let (header, text) = self.records[start..].split_at_mut(HEADER);
        let length = write(text, is_format, arguments) + 1;
        let [low, high] = (length as u16).to_le_bytes();
        header.copy_from_slice(&[status as u8, category as u8, low, high]);
        self.records.truncate(start + HEADER + length);
    }

    /// Takes the next message out, `None` once all have been taken.
    pub(super) fn take(&mut self) -> Option<Message> {
        if let Some((header, rest)) = self.records[self.next..].split_first_chunk::<HEADER>() {
            let [status, category, low, high] = *header;
            let length = usize::from(u16::from_le_bytes([low, high]));
            let mut text = [0; LONGEST];
            text[..length].copy_from_slice(&rest[..length]);
            self.next += HEADER + length;
            let status = Status::from_raw(status.into()).unwrap_or(Status::Error);
            return Some(Message { status, category: category.into(), text });
        }
        self.records.clear();
        self.next = 0;
        let (status, category) = self.last_lost.take()?;
        let lost = core::mem::take(&mut self.lost);
        let text = format_args!("{lost} more messages were dropped: the buffer of {CAPACITY} bytes is full");
        Some(Message::new(status, category, false, text))
    }
}

/// Writes a C string with the characters that mean something to importers escaped, cut off at the end of `text`;
/// returns its length without the NUL.
fn write(text: &mut [u8], is_format: bool, arguments: fmt::Arguments<'_>) -> usize {
    let mut writer = Writer { text, length: 0, is_format };
    // Fails only when the text is cut off, which is what we want then.
    let _ = writer.write_fmt(arguments);
    writer.length
}

struct Writer<'a> {
    /// Zeros after the first `length` bytes.
    text: &'a mut [u8],
    length: usize,
    is_format: bool,
}

impl Writer<'_> {
    fn push(&mut self, bytes: &[u8]) -> fmt::Result {
        let end = self.length + bytes.len();
        // The last byte stays NUL.
        if end >= self.text.len() {
            return Err(fmt::Error);
        }
        self.text[self.length..end].copy_from_slice(bytes);
        self.length = end;
        Ok(())
    }
}

impl Write for Writer<'_> {
    fn write_str(&mut self, text: &str) -> fmt::Result {
        let mut encoded = [0; 4];
        text.chars().try_for_each(|character| match character {
            // #4# stands for the variable with the value reference 4.
            '#' => self.push(b"##"),
            '%' if self.is_format => self.push(b"%%"),
            '\0' => self.push(b"?"),
            _ => self.push(character.encode_utf8(&mut encoded).as_bytes()),
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use core::ffi::CStr;

    fn text(message: &Message) -> &str {
        CStr::from_bytes_until_nul(&message.text).unwrap().to_str().unwrap()
    }

    fn written(arguments: fmt::Arguments<'_>, is_format: bool) -> String {
        text(&Message::new(Status::Ok, 0, is_format, arguments)).to_owned()
    }

    #[test]
    fn percent_signs_cannot_become_conversions() {
        assert_eq!(written(format_args!("100 %s"), true), "100 %%s");
        assert_eq!(written(format_args!("100 %s"), false), "100 %s");
    }

    #[test]
    fn number_signs_cannot_become_references() {
        assert_eq!(written(format_args!("#1#"), true), "##1##");
        assert_eq!(written(format_args!("#1#"), false), "##1##");
    }

    #[test]
    fn long_messages_are_cut_at_a_character() {
        let long = "ü".repeat(LONGEST);
        let cut = written(format_args!("{long}"), false);
        assert_eq!(cut.len(), LONGEST - 2);
        assert!(cut.chars().all(|character| character == 'ü'));
    }

    /// Everything that is taken out, as (status, category, text).
    fn emptied(outbox: &mut Outbox) -> Vec<(Status, usize, String)> {
        let messages = core::iter::from_fn(|| outbox.take());
        messages.map(|message| (message.status, message.category, text(&message).to_owned())).collect()
    }

    #[test]
    fn messages_come_out_in_the_order_they_went_in() {
        let mut outbox = Outbox::new().unwrap();
        assert!(outbox.is_empty() && outbox.take().is_none());
        let expected = [
            (Status::Ok, 2, "".to_owned()),
            (Status::Ok, 3, "100 %".to_owned()),
            (Status::Fatal, 1, "x".repeat(LONGEST - 1)),
        ];
        for round in 0..100 {
            for (status, category, text) in &expected {
                outbox.push(*status, *category, false, format_args!("{text}"));
            }
            assert!(!outbox.is_empty());
            // Interrupted after the first, as by an exception.
            let first = outbox.take().unwrap();
            assert_eq!(text(&first), "");
            assert_eq!(emptied(&mut outbox), expected[1..], "round {round}");
            assert!(outbox.is_empty());
        }
    }

    #[test]
    fn messages_that_were_taken_leave_their_room() {
        let mut outbox = Outbox::new().unwrap();
        for round in 0..10 * CAPACITY / LONGEST {
            outbox.push(Status::Error, 0, false, format_args!("{round} {}", "x".repeat(LONGEST)));
            // Nobody asks for a second one: an exception has ended the call.
            assert!(text(&outbox.take().unwrap()).starts_with(&format!("{round} x")));
        }
    }

    #[test]
    fn what_finds_no_room_is_counted_and_refusals_find_some() {
        let mut outbox = Outbox::new().unwrap();
        let remarks = 1000;
        for number in 0..remarks {
            outbox.push(Status::Ok, 3, false, format_args!("the observer converged at tick {number}"));
        }
        outbox.push(Status::Error, 0, false, format_args!("{}", "y".repeat(2 * LONGEST)));
        let messages = emptied(&mut outbox);
        let kept = messages.len() - 2;
        assert!(kept > 300, "{kept}");
        for (number, message) in messages[..kept].iter().enumerate() {
            assert_eq!(message.2, format!("the observer converged at tick {number}"));
        }
        assert_eq!((messages[kept].0, messages[kept].2.len()), (Status::Error, LONGEST - 1));
        let (status, category, lost) = &messages[kept + 1];
        assert_eq!((*status, *category), (Status::Ok, 3));
        assert!(lost.starts_with(&format!("{} more messages", remarks - kept)), "{lost}");
        assert!(outbox.is_empty() && outbox.take().is_none());
    }
}

//! What a unit tells the world about itself.

use core::fmt::Write;

use super::variable::{Kind, Variable};

/// Static description of an exported unit.
#[derive(Debug)]
pub struct Description {
    /// Model name, model identifier and file name: a C identifier.
    pub name: &'static str,
    pub summary: &'static str,
    /// Paragraphs of the documentation: model, source, and what is printed, derived or assumed.
    pub documentation: &'static [&'static str],
    pub variables: &'static [Variable],
    /// Suggested communication step \[s\].
    pub step_size: f64,
    /// Suggested end of a simulation \[s\].
    pub stop_time: f64,
}

impl Description {
    /// The variable called `name` and its value reference.
    pub fn find(&self, name: &str) -> Option<(usize, &'static Variable)> {
        self.variables.iter().enumerate().find(|(_, variable)| variable.name == name)
    }

    /// Whether the unit acts at ticks only, as the controllers do, and not in continuous time.
    pub fn is_sampled(&self) -> bool {
        self.find("sample_time").is_some()
    }

    /// Continuous states with their derivatives, as value references, in the order of the derivatives' rows.
    pub fn continuous_states(&self) -> impl Iterator<Item = (usize, usize)> {
        let rows = self.variables.iter().enumerate();
        rows.filter_map(|(derivative, row)| Some((self.find(row.derivative_of?)?.0, derivative)))
    }

    /// Value references of the event indicators.
    pub fn event_indicators(&self) -> impl Iterator<Item = usize> {
        let rows = self.variables.iter().enumerate();
        rows.filter(|(_, row)| row.is_event_indicator).map(|(reference, _)| reference)
    }

    /// Whether an importer may integrate the unit itself.
    pub fn offers_model_exchange(&self) -> bool {
        self.variables.iter().any(|row| row.derivative_of.is_some())
    }

    /// Instantiation token (FMI 2: GUID), computed from the interface, so that a model description and a library
    /// that disagree about a variable cannot be loaded together.
    pub fn token(&self) -> Token {
        self.token_with(core::iter::empty())
    }

    /// Token of a package that shows clocks of these names beside the variables.
    pub(super) fn token_with(&self, clocks: impl Iterator<Item = &'static str>) -> Token {
        let mut hash = Fnv128::new();
        hash.add(env!("CARGO_PKG_VERSION"));
        hash.add(self.name);
        for variable in self.variables {
            hash.add(variable.name);
            match variable.kind {
                Kind::Real(quantity) => hash.add(quantity.name),
                Kind::Integer => hash.add("Integer"),
                Kind::Boolean => hash.add("Boolean"),
                Kind::Enumeration(enumeration) => {
                    hash.add(enumeration.name);
                    enumeration.items.iter().for_each(|(item, _)| hash.add(item));
                }
            }
            hash.add_bytes(&[variable.causality as u8, variable.variability as u8]);
            hash.add(variable.derivative_of.unwrap_or_default());
            hash.add_bytes(&[variable.is_event_indicator.into(), variable.is_reinitialised.into()]);
            for number in [variable.start, variable.range.0, variable.range.1] {
                hash.add_bytes(&number.to_bits().to_le_bytes());
            }
        }
        clocks.for_each(|clock| hash.add(clock));
        Token::from_bits(hash.0)
    }
}

/// A GUID in braces, `{8-4-4-4-12}`.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct Token([u8; 38]);

impl Token {
    fn from_bits(bits: u128) -> Self {
        let mut token = Self([b' '; 38]);
        let mut rest = TokenWriter { token: &mut token.0, length: 0 };
        let part = |shift: u32, digits: u32| (bits >> shift) & ((1u128 << (4 * digits)) - 1);
        // The buffer has exactly the length of the text, so writing cannot fail.
        let _ = write!(
            rest,
            "{{{:08x}-{:04x}-{:04x}-{:04x}-{:012x}}}",
            part(96, 8),
            part(80, 4),
            part(64, 4),
            part(48, 4),
            part(0, 12)
        );
        token
    }

    pub fn as_str(&self) -> &str {
        // Hexadecimal digits, braces and dashes only.
        core::str::from_utf8(&self.0).unwrap_or_default()
    }
}

struct TokenWriter<'a> {
    token: &'a mut [u8; 38],
    length: usize,
}

impl Write for TokenWriter<'_> {
    fn write_str(&mut self, text: &str) -> core::fmt::Result {
        let end = self.length + text.len();
        self.token.get_mut(self.length..end).ok_or(core::fmt::Error)?.copy_from_slice(text.as_bytes());
        self.length = end;
        Ok(())
    }
}

/// FNV-1a, 128 bits (Fowler, Noll, Vo): enough to tell interfaces apart, no crate needed in the core.
struct Fnv128(u128);

impl Fnv128 {
    fn new() -> Self {
        Self(0x6c62_272e_07bb_0142_62b8_2175_6295_c58d)
    }

    fn add_bytes(&mut self, bytes: &[u8]) {
        for byte in bytes {
            self.0 = (self.0 ^ u128::from(*byte)).wrapping_mul(0x0000_0000_0100_0000_0000_0000_0000_013B);
        }
    }

    /// Adds a text and a separator, so that "ab", "c" differs from "a", "bc".
    fn add(&mut self, text: &str) {
        self.add_bytes(text.as_bytes());
        self.add_bytes(&[0]);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn hash_is_fnv1a() {
        // Test vector of the authors for the string "foobar".
        let mut hash = Fnv128::new();
        hash.add_bytes(b"foobar");
        assert_eq!(hash.0, 0x343e_1662_793c_64bf_6f0d_3597_ba44_6f18);
    }

    #[test]
    fn token_is_a_guid() {
        let token = Token::from_bits(0x0123_4567_89ab_cdef_0123_4567_89ab_cdef);
        assert_eq!(token.as_str(), "{01234567-89ab-cdef-0123-456789abcdef}");
    }
}

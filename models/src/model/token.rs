//! Instantiation tokens (FMI 2: GUID), computed from the interface, so that a model description and a library that
//! disagree about a variable cannot be loaded together.
//!
//! The compiler computes them, so that they stand as texts in the shared library: whether it serves a model description
//! can be seen without loading it, on a machine that could not.

use super::sampled::ClockVariable;
use super::variable::{Kind, Variable};

/// A GUID in braces, `{8-4-4-4-12}`.
#[derive(Clone, Copy, PartialEq, Eq, Hash, Debug)]
pub struct Token([u8; Token::LENGTH]);

impl Token {
    /// Bytes of the text.
    pub const LENGTH: usize = 38;

    /// Token of a package that shows these variables and clocks of the model called `name`.
    pub(super) const fn of(name: &str, variables: &[Variable], clocks: &[ClockVariable]) -> Self {
        let mut hash = Fnv128::new().text(env!("CARGO_PKG_VERSION")).text(name);
        let mut row = 0;
        while row < variables.len() {
            hash = hash.variable(&variables[row]);
            row += 1;
        }
        let mut place = 0;
        while place < clocks.len() {
            hash = hash.text(clocks[place].name);
            place += 1;
        }
        Self::from_bits(hash.0)
    }

    const fn from_bits(bits: u128) -> Self {
        let mut text = *b"{00000000-0000-0000-0000-000000000000}";
        let (mut place, mut shift) = (0, u128::BITS);
        while place < text.len() {
            if text[place] == b'0' {
                shift -= 4;
                text[place] = b"0123456789abcdef"[(bits >> shift & 0xf) as usize];
            }
            place += 1;
        }
        Self(text)
    }

    pub fn as_str(&self) -> &str {
        // Hexadecimal digits, braces and dashes only.
        core::str::from_utf8(&self.0).unwrap_or_default()
    }
}

/// FNV-1a, 128 bits (Fowler, Noll, Vo): enough to tell interfaces apart, no crate needed in the core.
struct Fnv128(u128);

impl Fnv128 {
    const fn new() -> Self {
        Self(0x6c62_272e_07bb_0142_62b8_2175_6295_c58d)
    }

    const fn bytes(mut self, bytes: &[u8]) -> Self {
        let mut place = 0;
        while place < bytes.len() {
            self.0 = (self.0 ^ bytes[place] as u128).wrapping_mul(0x0000_0000_0100_0000_0000_0000_0000_013B);
            place += 1;
        }
        self
    }

    /// A text and a separator, so that "ab", "c" differs from "a", "bc".
    const fn text(self, text: &str) -> Self {
        self.bytes(text.as_bytes()).bytes(&[0])
    }

    const fn number(self, number: f64) -> Self {
        self.bytes(&number.to_bits().to_le_bytes())
    }

    const fn variable(self, variable: &Variable) -> Self {
        let Variable { causality, variability, is_event_indicator, is_reinitialised, .. } = *variable;
        let state = match variable.derivative_of {
            Some(state) => state,
            None => "",
        };
        self.text(variable.name)
            .kind(&variable.kind)
            .bytes(&[causality as u8, variability as u8])
            .text(state)
            .bytes(&[is_event_indicator as u8, is_reinitialised as u8])
            .number(variable.start)
            .number(variable.range.0)
            .number(variable.range.1)
    }

    const fn kind(mut self, kind: &Kind) -> Self {
        match kind {
            Kind::Real(quantity) => self.text(quantity.name),
            Kind::Integer => self.text("Integer"),
            Kind::Boolean => self.text("Boolean"),
            Kind::Enumeration(enumeration) => {
                self = self.text(enumeration.name);
                let mut item = 0;
                while item < enumeration.items.len() {
                    self = self.text(enumeration.items[item].0);
                    item += 1;
                }
                self
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn hash_is_fnv1a() {
        // Test vector of the authors for the string "foobar".
        assert_eq!(Fnv128::new().bytes(b"foobar").0, 0x343e_1662_793c_64bf_6f0d_3597_ba44_6f18);
    }

    #[test]
    fn token_is_a_guid() {
        let token = Token::from_bits(0x0123_4567_89ab_cdef_0123_4567_89ab_cdef);
        assert_eq!(token.as_str(), "{01234567-89ab-cdef-0123-456789abcdef}");
    }
}

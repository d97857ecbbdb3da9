//! Access to variables by their names: convenient, not fast.

use super::error::{HostError, Result};
use super::fmu::c_text;
use super::instance::Instance;
use super::value::Value;
use super::variable::Kind;

impl Instance {
    /// Sets a variable by its name: a number, a flag, the name of an enumeration's item, or a string.
    ///
    /// # Errors
    /// Those of [`Instance::variable`] and [`Instance::set`], and [`HostError::UnknownItem`].
    pub fn set_by_name<'a>(&mut self, name: &str, value: impl Into<Value<'a>>) -> Result<()> {
        let handle = self.variable(name)?;
        match value.into() {
            Value::Real(_) | Value::Integer(_) if handle.kind == Kind::Boolean => {
                Err(self.wrong_kind(name, handle.kind, "number"))
            }
            Value::Real(number) => self.set(handle, number),
            Value::Integer(number) => self.set(handle, f64::from(number)),
            Value::Boolean(flag) if handle.kind == Kind::Boolean => {
                self.set(handle, f64::from(u8::from(flag)))
            }
            Value::Boolean(_) => Err(self.wrong_kind(name, handle.kind, "boolean")),
            Value::Text(item) if handle.kind == Kind::Enumeration => {
                let number = self.item_number(name, item)?;
                // Items beyond 2^53 are not a thing; `set` would refuse the rounded number anyway.
                self.set(handle, number as f64)
            }
            Value::Text(text) if handle.kind == Kind::String => {
                self.usable()?;
                let text = c_text(name, text)?;
                let answer = self.component.set_text(handle.value_reference, &text);
                self.explain(answer, || self.describe(handle))
            }
            Value::Text(_) => Err(self.wrong_kind(name, handle.kind, "text")),
        }
    }

    /// The value of a numeric or boolean variable by its name.
    ///
    /// # Errors
    /// Those of [`Instance::variable`] and [`Instance::get`].
    pub fn get_by_name(&self, name: &str) -> Result<f64> {
        self.get(self.variable(name)?)
    }

    fn item_number(&self, name: &str, item: &str) -> Result<i64> {
        let items = self.description().enumeration_items(self.description().variable(name)?);
        items.iter().find(|candidate| candidate.name == item).map(|found| found.value).ok_or_else(|| {
            let known: Vec<_> = items.iter().map(|item| format!("`{}`", item.name)).collect();
            HostError::UnknownItem {
                instance: self.name().to_owned(),
                variable: name.to_owned(),
                item: item.to_owned(),
                known: if known.is_empty() { "items without names".to_owned() } else { known.join(", ") },
            }
        })
    }
}

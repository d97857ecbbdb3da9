//! The status every FMI function returns.

/// `fmi2Status` and `fmi3Status`; the two standards share the first five values.
///
/// A value read from a foreign library is an `i32` first: see [`Status::from_raw`].
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
#[repr(i32)]
pub enum Status {
    /// All well.
    Ok = 0,
    /// Done, but the log has something to say.
    Warning = 1,
    /// Not done, the instance is as it was; another step size may work.
    Discard = 2,
    /// Not done, the instance is as it was.
    Error = 3,
    /// This instance is lost and may not be used again.
    Fatal = 4,
    /// FMI 2.0 only: the step goes on in the background.
    Pending = 5,
}

impl Status {
    /// The status behind a number that a library returned; `None` if no standard knows it.
    pub fn from_raw(raw: i32) -> Option<Self> {
        Some(match raw {
            0 => Self::Ok,
            1 => Self::Warning,
            2 => Self::Discard,
            3 => Self::Error,
            4 => Self::Fatal,
            5 => Self::Pending,
            _ => return None,
        })
    }

    /// The standard's name of the status, as it appears in logs.
    pub fn name(self) -> &'static str {
        match self {
            Self::Ok => "OK",
            Self::Warning => "Warning",
            Self::Discard => "Discard",
            Self::Error => "Error",
            Self::Fatal => "Fatal",
            Self::Pending => "Pending",
        }
    }
}

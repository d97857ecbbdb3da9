//! The whole story of an error of somebody else's library, for a message.

use std::error::Error;

/// The error and its causes, outermost first, separated by colons. Libraries keep the decisive part, such as what the
/// dynamic linker said, in the cause. A cause that the text before it quotes already is left out.
pub(crate) fn with_causes(error: &(dyn Error + 'static)) -> String {
    let mut text = error.to_string();
    let mut next = error.source();
    while let Some(cause) = next {
        let reason = cause.to_string();
        if !text.contains(&reason) {
            text = format!("{text}: {reason}");
        }
        next = cause.source();
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::io;

    #[derive(Debug, thiserror::Error)]
    enum Outer {
        #[error("cannot open")]
        Silent(#[source] io::Error),
        #[error("cannot open: {0}")]
        Quoting(#[source] io::Error),
    }

    #[test]
    fn every_cause_is_told_once() {
        let cause = || io::Error::other("no such thing");
        assert_eq!(with_causes(&Outer::Silent(cause())), "cannot open: no such thing");
        assert_eq!(with_causes(&Outer::Quoting(cause())), "cannot open: no such thing");
    }
}

//! What is said of an error: the whole story if it is one of somebody else's library, and nothing that steers the terminal.

use std::error::Error;

/// The error and its causes, outermost first, separated by colons. Libraries keep the decisive part, such as what the
/// dynamic linker said, in the cause. A cause that the text before it quotes already is left out. Such texts quote names from
/// files as they are, hence [`printable`].
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
    printable(&text)
}

/// The text in one line, with whatever could move the cursor, colour the screen or turn the direction of writing escaped:
/// messages quote names from files.
pub fn printable(text: &str) -> String {
    let mut line = String::with_capacity(text.len());
    for letter in text.chars() {
        match letter {
            '"' | '\'' | '\\' => line.push(letter),
            other => line.extend(other.escape_debug()),
        }
    }
    line
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
    fn messages_cannot_steer_the_terminal() {
        let kept = "`größe\\x` is \"no\" name, it's not: 5 \u{3bc}m";
        assert_eq!(printable(kept), kept);
        let steering = "a\u{1b}[2Jb\u{202e}c\u{7f}d\re\nf\tg\0";
        assert_eq!(printable(steering), r"a\u{1b}[2Jb\u{202e}c\u{7f}d\re\nf\tg\0");
        let quoting = Outer::Silent(io::Error::other("no field `a\nb`"));
        assert_eq!(with_causes(&quoting), r"cannot open: no field `a\nb`");
    }

    #[test]
    fn every_cause_is_told_once() {
        let cause = || io::Error::other("no such thing");
        assert_eq!(with_causes(&Outer::Silent(cause())), "cannot open: no such thing");
        assert_eq!(with_causes(&Outer::Quoting(cause())), "cannot open: no such thing");
    }
}

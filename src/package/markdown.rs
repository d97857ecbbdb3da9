//! Markdown as GitHub shows it: text and tables.

/// Text in which no character is taken for markup, and what `is_code` holds for is set as code: words, and settings such as
/// `map = exact`.
pub fn text(text: &str, is_code: impl Fn(&str) -> bool) -> String {
    let words: Vec<&str> = text.split_inclusive(' ').collect();
    let mut result = String::new();
    let mut place = 0;
    while place < words.len() {
        let spans =
            [3, 1].into_iter().filter_map(|count| Some((count, words.get(place..place + count)?.concat())));
        let found = spans.filter_map(|(count, span)| Some((count, with_code(&span, &is_code)?))).next();
        let (count, set) = found.unwrap_or_else(|| (1, escaped(words[place])));
        result += &set;
        place += count;
    }
    result
}

/// A span of text as code between its punctuation, if it is code.
fn with_code(span: &str, is_code: &impl Fn(&str) -> bool) -> Option<String> {
    let core = span.trim_start_matches('(').trim_end_matches([' ', ',', ';', ':', '.', ')']);
    let (before, after) = span.split_once(core)?;
    is_code(core).then(|| format!("{}{}{}", escaped(before), code(core), escaped(after)))
}

fn escaped(text: &str) -> String {
    let mut result = String::new();
    for character in text.chars() {
        if matches!(character, '\\' | '`' | '*' | '<') {
            result.push('\\');
        }
        result.push(character);
    }
    result
}

/// A name as code; it must not contain backticks.
pub fn code(name: &str) -> String {
    format!("`{name}`")
}

/// A table, with an empty line at its end.
pub fn table<const COLUMNS: usize>(
    head: [&str; COLUMNS],
    rows: impl Iterator<Item = [String; COLUMNS]>,
) -> String {
    let mut text =
        format!("{}{}", row(head.map(str::to_owned)), row([(); COLUMNS].map(|()| "---".to_owned())));
    text.extend(rows.map(row));
    text + "\n"
}

fn row<const COLUMNS: usize>(cells: [String; COLUMNS]) -> String {
    // A bar ends a cell even within code.
    format!("| {} |\n", cells.map(|cell| cell.replace('|', "\\|")).join(" | "))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_are_code_and_markup_is_plain_text() {
        let set = |words| text(words, |words| ["sensor.seed", "filter[1]", "map = exact"].contains(&words));
        assert_eq!(set("a (sensor.seed), filter[1]."), "a (`sensor.seed`), `filter[1]`.");
        assert_eq!(set("with map = exact, map = exactly"), "with `map = exact`, map = exactly");
        assert_eq!(set("a * b < `c` \\"), "a \\* b \\< \\`c\\` \\\\");
        assert_eq!(set("sensor.seeds"), "sensor.seeds");
        assert_eq!(set(""), "");
    }

    #[test]
    fn a_bar_stays_within_its_cell() {
        let rows = [["x |x|".to_owned(), String::new()]];
        assert_eq!(table(["A", "B"], rows.into_iter()), "| A | B |\n| --- | --- |\n| x \\|x\\| |  |\n\n");
    }
}

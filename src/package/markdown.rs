//! Markdown as GitHub shows it: text and tables.

/// Text in which words for which `is_name` holds are set as code and no character is taken for markup.
pub fn text(text: &str, is_name: impl Fn(&str) -> bool) -> String {
    text.split_inclusive(' ').map(|word| set_word(word, &is_name)).collect()
}

fn set_word(word: &str, is_name: &impl Fn(&str) -> bool) -> String {
    let core = word.trim_start_matches('(').trim_end_matches([' ', ',', ';', ':', '.', ')']);
    if !is_name(core) {
        return escaped(word);
    }
    let (before, after) = word.split_once(core).unwrap_or_default();
    format!("{}{}{}", escaped(before), code(core), escaped(after))
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
        let is_name = |word: &str| ["sensor.seed", "filter[1]"].contains(&word);
        assert_eq!(text("a (sensor.seed), filter[1].", is_name), "a (`sensor.seed`), `filter[1]`.");
        assert_eq!(text("a * b < `c` \\", is_name), "a \\* b \\< \\`c\\` \\\\");
        assert_eq!(text("sensor.seeds", is_name), "sensor.seeds");
    }

    #[test]
    fn a_bar_stays_within_its_cell() {
        let rows = [["x |x|".to_owned(), String::new()]];
        assert_eq!(table(["A", "B"], rows.into_iter()), "| A | B |\n| --- | --- |\n| x \\|x\\| |  |\n\n");
    }
}

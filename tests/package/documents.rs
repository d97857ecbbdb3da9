//! README.md and the pages in docs/: their links lead somewhere, and what they say of models, variables, wires and
//! commands is true of the program.

use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::{Component, Path, PathBuf};
use std::process::Command;

use maglev_fmu::model::MODELS;
use maglev_fmu::model::system::{SYSTEMS, System};
use maglev_fmu::model::variable::{Kind, Variable};

/// Most bytes of the README, which is to be read at one sitting.
const LONGEST_README: usize = 8000;

fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

fn read(path: &Path) -> String {
    fs::read_to_string(root().join(path)).unwrap().replace("\r\n", "\n")
}

/// The README and all pages below docs/, as paths below the root, with their texts.
fn pages() -> BTreeMap<PathBuf, String> {
    let mut paths = vec![PathBuf::from("README.md")];
    let mut folders = vec![PathBuf::from("docs")];
    while let Some(folder) = folders.pop() {
        for entry in fs::read_dir(root().join(&folder)).unwrap() {
            let path = folder.join(entry.unwrap().file_name());
            if root().join(&path).is_dir() {
                folders.push(path);
            } else if path.extension().is_some_and(|ending| ending == "md") {
                paths.push(path);
            }
        }
    }
    paths.into_iter().map(|path| (path.clone(), read(&path))).collect()
}

/// The pages that are written by hand: neither by `describe` nor by scripts/conformance.py.
fn written_pages() -> BTreeMap<PathBuf, String> {
    let mut pages = pages();
    pages.retain(|path, _| !path.starts_with("docs/models") && path != Path::new("docs/conformance.md"));
    pages
}

/// Lines with whether they are within a block of code, without the fences.
fn lines(text: &str) -> impl Iterator<Item = (bool, &str)> {
    let mut is_code = false;
    text.lines().filter_map(move |line| {
        if line.starts_with("```") {
            is_code = !is_code;
            return None;
        }
        Some((is_code, line))
    })
}

/// Inline code and the text around it, paragraph by paragraph: every second part is code.
fn parts(text: &str) -> Vec<Vec<String>> {
    let prose: Vec<&str> = lines(text).filter_map(|(is_code, line)| (!is_code).then_some(line)).collect();
    let prose = prose.join("\n");
    prose.split("\n\n").map(|paragraph| paragraph.split('`').map(str::to_owned).collect()).collect()
}

fn inline_code(text: &str) -> Vec<String> {
    let spans = parts(text).into_iter().flat_map(|parts| parts.into_iter().skip(1).step_by(2));
    spans.map(|span| span.split_whitespace().collect::<Vec<_>>().join(" ")).collect()
}

/// Targets of links and pictures.
fn links(text: &str) -> Vec<String> {
    let mut targets = Vec::new();
    for parts in parts(text) {
        // What stands in for code keeps a bracket from being taken for the end of a link's text.
        let plain: Vec<String> = parts.into_iter().step_by(2).collect();
        for part in plain.join("code").split("](").skip(1) {
            targets.push(part.split(')').next().unwrap().to_owned());
        }
    }
    targets
}

/// Anchors of a page's headings, as GitHub makes them.
fn anchors(text: &str) -> BTreeSet<String> {
    let mut found = BTreeSet::new();
    for (is_code, line) in lines(text) {
        let title = line.trim_start_matches('#');
        if is_code || title == line || !title.starts_with(' ') {
            continue;
        }
        let kept = title.trim().to_lowercase();
        let kept = kept.chars().filter(|letter| letter.is_alphanumeric() || " -_".contains(*letter));
        let anchor = kept.collect::<String>().replace(' ', "-");
        let repeated = (1..).map(|number| format!("{anchor}-{number}"));
        let free = [anchor.clone()].into_iter().chain(repeated).find(|name| !found.contains(name));
        found.extend(free);
    }
    found
}

/// A path without `.` and `..`.
fn plain(path: &Path) -> PathBuf {
    let mut result = PathBuf::new();
    for component in path.components() {
        match component {
            Component::ParentDir => assert!(result.pop(), "{} leaves the repository", path.display()),
            Component::CurDir => {}
            other => result.push(other),
        }
    }
    result
}

/// What a page's relative links lead to: a path below the root, and an anchor or nothing.
fn destinations(page: &Path, text: &str) -> Vec<(PathBuf, String)> {
    let mut found = Vec::new();
    for link in links(text).iter().filter(|link| !link.contains("://")) {
        let (file, anchor) = link.split_once('#').unwrap_or((link, ""));
        let path = if file.is_empty() { page.to_owned() } else { plain(&page.parent().unwrap().join(file)) };
        found.push((path, anchor.to_owned()));
    }
    found
}

#[test]
fn links_and_anchors_are_found_as_github_does() {
    let text =
        "# One `two`: x\n\n## One\n## One\n\n[a\nb](c.md#d) `[e](f)` ![g](h.png)\n\n```\n# [i](j)\n```\n";
    assert_eq!(links(text), ["c.md#d", "h.png"]);
    assert_eq!(anchors(text), ["one-two-x", "one", "one-1"].map(str::to_owned).into());
    assert_eq!(inline_code(text), ["two", "[e](f)"]);
}

#[test]
fn relative_links_lead_to_files_and_anchors() {
    let pages = pages();
    let mut number = 0;
    for (page, text) in &pages {
        for (path, anchor) in destinations(page, text) {
            let from = page.display();
            assert!(root().join(&path).exists(), "{from}: there is no {}", path.display());
            if !anchor.is_empty() {
                let target = pages.get(&path).unwrap_or_else(|| panic!("{from}: an anchor of no page"));
                assert!(anchors(target).contains(&anchor), "{from}: {} has no #{anchor}", path.display());
            }
            number += 1;
        }
    }
    assert!(number > 50, "{number} links");
}

#[test]
fn every_page_is_reached_from_the_readme() {
    let pages = pages();
    let mut reached = BTreeSet::new();
    let mut next = vec![PathBuf::from("README.md")];
    while let Some(page) = next.pop() {
        if let Some(text) = pages.get(&page).filter(|_| reached.insert(page.clone())) {
            next.extend(destinations(&page, text).into_iter().map(|(path, _)| path));
        }
    }
    for page in pages.keys() {
        assert!(reached.contains(page), "no link leads to {}", page.display());
    }
}

#[test]
fn the_readme_is_short_and_names_every_model() {
    let readme = read(Path::new("README.md"));
    assert!(readme.len() <= LONGEST_README, "README.md has {} bytes of {LONGEST_README}", readme.len());
    for model in MODELS {
        let link = format!("(docs/models/{}.md)", model.description.name);
        assert!(readme.contains(&link), "README.md does not link {}", model.description.name);
    }
}

/// Rows such as "| ball | plant `current_measured` (or `current`) | controller `current` |": any of the first is wired
/// with the last. The loop may be "each".
#[test]
fn the_wires_in_the_readme_exist() {
    let readme = read(Path::new("README.md"));
    let (_, table) =
        readme.split_once("| loop | from | to |\n| --- | --- | --- |\n").expect("a table of wires");
    let (table, _) = table.split_once("\n\n").unwrap();
    let mut wired = BTreeSet::new();
    for row in table.lines() {
        let cells: Vec<&str> = row.trim_matches(['|', ' ']).split(" | ").collect();
        let [of, from, to] = cells[..] else { panic!("{row}") };
        let outputs = inline_code(from);
        let input = &inline_code(to)[0];
        let systems: Vec<&System> = match of {
            "each" => SYSTEMS.to_vec(),
            name => vec![System::find(name).unwrap_or_else(|| panic!("no system {name}"))],
        };
        for system in systems {
            let source = if from.starts_with("plant") { system.plant } else { system.controller };
            for output in &outputs {
                assert!(source.description.find(output).is_some(), "{row}: no {output} in {}", system.name);
            }
            let is_wire = |output: &String| {
                system.wires().any(|wire| {
                    std::ptr::eq(wire.source, source.description)
                        && (wire.output, wire.input) == (output, input)
                })
            };
            assert!(outputs.iter().any(is_wire), "{row}: not wired so in {}", system.name);
            wired.insert((system.name, input.clone()));
        }
    }
    // True states are for comparisons only.
    let needed =
        SYSTEMS.iter().flat_map(|system| system.wires().map(|wire| (system.name, wire.input.to_owned())));
    let needed: BTreeSet<_> = needed.filter(|(_, input)| !input.starts_with("state.")).collect();
    assert_eq!(wired, needed);
}

fn variables() -> impl Iterator<Item = &'static Variable> {
    MODELS.iter().flat_map(|model| model.description.variables)
}

/// Whether some variable called `name` may be set to `value`.
fn accepts(name: &str, value: &str) -> bool {
    variables().filter(|variable| variable.name == name).any(|variable| match variable.kind {
        Kind::Enumeration(enumeration) => enumeration.items.iter().any(|(item, _)| *item == value),
        Kind::Boolean => value.parse::<bool>().is_ok(),
        Kind::Integer | Kind::Real(_) => value.parse().is_ok_and(|number| variable.check(number).is_ok()),
    })
}

/// Code such as `observer.kind` and `observer.kind = kalman`.
#[test]
fn variables_in_the_pages_exist_and_take_these_values() {
    const ENDINGS: [&str; 12] =
        ["fmu", "rs", "ssp", "ssv", "json", "html", "md", "py", "png", "toml", "csv", "txt"];
    let is_name_letter =
        |letter: char| letter.is_ascii_lowercase() || letter.is_ascii_digit() || "._[]".contains(letter);
    let mut number = 0;
    for (page, text) in written_pages() {
        for code in inline_code(&text) {
            let (name, value) = match code.split_once(" = ") {
                Some((name, value)) => (name, Some(value)),
                None => (code.as_str(), None),
            };
            let (_, ending) = name.rsplit_once('.').unwrap_or_default();
            let is_path = value.is_none() && (ending.is_empty() || ENDINGS.contains(&ending));
            if is_path || !name.chars().all(is_name_letter) {
                continue;
            }
            let page = page.display();
            assert!(variables().any(|variable| variable.name == name), "{page}: no variable {name}");
            if let Some(value) = value {
                assert!(accepts(name, value), "{page}: {name} does not take {value}");
            }
            number += 1;
        }
    }
    assert!(number > 20, "{number} names");
}

/// With `--help` at its end the program judges the options and values before it, and does nothing.
#[test]
fn commands_in_the_pages_are_taken() {
    let mut number = 0;
    for (page, text) in written_pages() {
        let commands = lines(&text).filter(|(is_code, _)| *is_code).filter_map(|(_, line)| {
            line.strip_prefix("maglev-fmu ").or_else(|| line.strip_prefix("cargo run --release -- "))
        });
        for command in commands {
            let (command, _) = command.split_once('#').unwrap_or((command, ""));
            let mut program = Command::new(env!("CARGO_BIN_EXE_maglev-fmu"));
            let output = program.args(command.split_whitespace()).arg("--help").output().unwrap();
            let message = String::from_utf8_lossy(&output.stderr);
            assert!(output.status.success(), "{}: {command}: {message}", page.display());
            number += 1;
        }
    }
    assert!(number > 5, "{number} commands");
}

//! The files of a package.

use std::borrow::Cow;

use super::documentation::documentation;
use super::icon::{icon_png, icon_svg};
use super::loop_diagram::{diagram_name, loop_diagram};
use super::model_description::{model_description, terminals_and_icons};
use super::reference_run::ReferenceRun;
use super::related_files::related_files;
use super::run_figure::{RUN_FIGURE, run_figure};
use super::terminal::Terminal;
use super::{FmiVersion, Form, GenerationTime, Library, PackageError, licenses};
use crate::model::{Description, StartValues};

/// A file of a package.
#[derive(Clone, Debug)]
pub struct Entry<'a> {
    /// Path in the archive, with forward slashes.
    pub path: String,
    pub bytes: Cow<'a, [u8]>,
    /// Whether the file is a program or library.
    pub executable: bool,
}

impl<'a> Entry<'a> {
    /// A file that is no program.
    pub fn document(path: String, bytes: Cow<'a, [u8]>) -> Self {
        Self { path, bytes, executable: false }
    }
}

/// All files of the package of one model in one form, sorted by path.
pub fn contents<'a>(
    description: &'static Description,
    start_values: &StartValues,
    form: Form,
    time: GenerationTime,
    libraries: &'a [Library],
) -> Result<Vec<Entry<'a>>, PackageError> {
    let name = description.name;
    let mut files: Vec<(&str, Cow<'a, [u8]>)> = vec![
        ("modelDescription.xml", owned(model_description(description, start_values, form, Some(time)))),
        ("documentation/index.html", owned(documentation(description, start_values, form, Some(time)))),
        ("documentation/licenses/license.txt", Cow::Borrowed(licenses::LICENSE.as_bytes())),
        ("documentation/licenses/THIRD-PARTY.txt", Cow::Borrowed(licenses::THIRD_PARTY.as_bytes())),
    ];
    // FMI 2.0 has an icon of its own; terminals it takes from FMI 3.0 (text of 2.0.5, section 2.3).
    files.extend([
        ("terminalsAndIcons/icon.png", Cow::Owned(icon_png(description)?)),
        ("terminalsAndIcons/icon.svg", Cow::Borrowed(icon_svg(description)?.as_bytes())),
        ("terminalsAndIcons/terminalsAndIcons.xml", owned(terminals_and_icons(description))),
    ]);
    if form.version == FmiVersion::Two {
        files.push(("model.png", Cow::Owned(icon_png(description)?)));
    }
    let mut entries: Vec<Entry<'a>> =
        files.into_iter().map(|(path, bytes)| Entry::document(path.to_owned(), bytes)).collect();
    for terminal in Terminal::all_of(description) {
        let path = format!("documentation/{}", diagram_name(terminal.system.name));
        entries.push(Entry::document(path, owned(loop_diagram(terminal.system, Some(description)))));
    }
    let run = ReferenceRun::of(description, start_values)
        .map_err(|source| PackageError::ReferenceRun { model: name, source })?;
    entries.push(Entry::document(format!("documentation/{RUN_FIGURE}"), owned(run_figure(&run))));
    entries.extend(related_files(&run).map(|(path, text)| Entry::document(path, owned(text))));
    entries.extend(libraries.iter().map(|library| {
        let platform = library.platform();
        Entry {
            path: format!("binaries/{}/{name}.{}", platform.directory(form.version), platform.extension()),
            bytes: Cow::Borrowed(library.bytes()),
            executable: true,
        }
    }));
    entries.sort_by(|a, b| a.path.cmp(&b.path));
    Ok(entries)
}

pub fn owned(text: String) -> Cow<'static, [u8]> {
    Cow::Owned(text.into_bytes())
}

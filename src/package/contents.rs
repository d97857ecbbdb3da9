//! The files of a package.

use std::borrow::Cow;

use super::documentation::documentation;
use super::icon::{icon_png, icon_svg};
use super::model_description::{model_description, terminals_and_icons};
use super::{FmiVersion, GenerationTime, Library, PackageError, licenses};
use crate::unit::{Description, StartValues};

/// A file of a package.
#[derive(Clone, Debug)]
pub struct Entry<'a> {
    /// Path in the archive, with forward slashes.
    pub path: String,
    pub bytes: Cow<'a, [u8]>,
    /// Whether the file is a program or library.
    pub executable: bool,
}

/// All files of the package of one unit, sorted by path.
pub fn contents<'a>(
    description: &'static Description,
    start_values: &StartValues,
    version: FmiVersion,
    time: GenerationTime,
    libraries: &'a [Library],
) -> Result<Vec<Entry<'a>>, PackageError> {
    let name = description.name;
    let mut files: Vec<(&str, Cow<'a, [u8]>)> = vec![
        ("modelDescription.xml", owned(model_description(description, start_values, version, Some(time))?)),
        ("documentation/index.html", owned(documentation(description, start_values, version, Some(time)))),
        ("documentation/licenses/license.txt", Cow::Borrowed(licenses::LICENSE.as_bytes())),
        ("documentation/licenses/THIRD-PARTY.txt", Cow::Borrowed(licenses::THIRD_PARTY.as_bytes())),
        ("documentation/licenses/Apache-2.0.txt", Cow::Borrowed(licenses::APACHE_2_0.as_bytes())),
    ];
    match version {
        FmiVersion::Two => files.push(("model.png", Cow::Owned(icon_png(name)?))),
        FmiVersion::Three => files.extend([
            ("terminalsAndIcons/icon.png", Cow::Owned(icon_png(name)?)),
            ("terminalsAndIcons/icon.svg", Cow::Borrowed(icon_svg(name)?.as_bytes())),
            ("terminalsAndIcons/terminalsAndIcons.xml", owned(terminals_and_icons(description)?)),
        ]),
    }
    let mut entries: Vec<Entry<'a>> = files
        .into_iter()
        .map(|(path, bytes)| Entry { path: path.to_owned(), bytes, executable: false })
        .collect();
    entries.extend(libraries.iter().map(|library| {
        let platform = library.platform();
        Entry {
            path: format!("binaries/{}/{name}.{}", platform.directory(version), platform.extension()),
            bytes: Cow::Borrowed(library.bytes()),
            executable: true,
        }
    }));
    entries.sort_by(|a, b| a.path.cmp(&b.path));
    Ok(entries)
}

fn owned(text: String) -> Cow<'static, [u8]> {
    Cow::Owned(text.into_bytes())
}

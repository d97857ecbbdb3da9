//! Icons of the models, with which they are registered.

use resvg::{tiny_skia, usvg};

use super::PackageError;
use super::registration::registration;
use crate::causes::with_causes;
use crate::model::Description;

/// Width and height of the picture \[pixel\].
const SIZE: u32 = 200;

/// The icon as a drawing in SVG.
pub fn icon_svg(description: &Description) -> Result<&'static str, PackageError> {
    registration(description).map(|model| model.icon).ok_or(PackageError::NoIcon { model: description.name })
}

/// The icon as a PNG file, 200 by 200 pixels.
pub fn icon_png(description: &Description) -> Result<Vec<u8>, PackageError> {
    let model = description.name;
    let drawing = usvg::Tree::from_str(icon_svg(description)?, &usvg::Options::default())
        .map_err(|source| PackageError::Icon { model, source })?;
    let not_drawn = |reason: String| PackageError::DrawIcon { model, reason };
    let mut picture = tiny_skia::Pixmap::new(SIZE, SIZE).ok_or_else(|| not_drawn("no memory".into()))?;
    let scale = SIZE as f32 / drawing.size().width();
    resvg::render(&drawing, tiny_skia::Transform::from_scale(scale, scale), &mut picture.as_mut());
    picture.encode_png().map_err(|error| not_drawn(with_causes(&error)))
}

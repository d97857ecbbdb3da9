//! Icons of the units: drawn by hand as SVG in `assets/`, without text, so that no font is needed.

use resvg::{tiny_skia, usvg};

use super::PackageError;
use crate::causes::with_causes;

/// Width and height of the picture \[pixel\].
const SIZE: u32 = 200;

/// The drawing of a unit's icon.
pub fn icon_svg(unit: &'static str) -> Result<&'static str, PackageError> {
    Ok(match unit {
        "MagneticBearingPlant" => include_str!("../../assets/MagneticBearingPlant.svg"),
        "MagneticBearingController" => include_str!("../../assets/MagneticBearingController.svg"),
        "LevitatedBallPlant" => include_str!("../../assets/LevitatedBallPlant.svg"),
        "LevitatedBallController" => include_str!("../../assets/LevitatedBallController.svg"),
        "MaglevRigPlant" => include_str!("../../assets/MaglevRigPlant.svg"),
        "MaglevRigController" => include_str!("../../assets/MaglevRigController.svg"),
        _ => return Err(PackageError::NoIcon { unit }),
    })
}

/// The icon as a PNG file, 200 by 200 pixels.
pub fn icon_png(unit: &'static str) -> Result<Vec<u8>, PackageError> {
    let drawing = usvg::Tree::from_str(icon_svg(unit)?, &usvg::Options::default())
        .map_err(|source| PackageError::Icon { unit, source })?;
    let not_drawn = |reason: String| PackageError::DrawIcon { unit, reason };
    let mut picture = tiny_skia::Pixmap::new(SIZE, SIZE).ok_or_else(|| not_drawn("no memory".into()))?;
    let scale = SIZE as f32 / drawing.size().width();
    resvg::render(&drawing, tiny_skia::Transform::from_scale(scale, scale), &mut picture.as_mut());
    picture.encode_png().map_err(|error| not_drawn(with_causes(&error)))
}

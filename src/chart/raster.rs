//! PNG from SVG.

use std::sync::{Arc, LazyLock};

use resvg::tiny_skia::{Pixmap, Transform};
use resvg::usvg::{Options, Tree, fontdb};

use super::{ChartError, FONT, Figure};
use crate::causes::with_causes;

/// Pixels per SVG unit, so that the picture is sharp on paper and on dense screens.
const SCALE: f32 = 2.0;

/// The embedded fonts.
static FONTS: LazyLock<Arc<fontdb::Database>> = LazyLock::new(|| {
    let mut fonts = fontdb::Database::new();
    fonts.load_font_data(dejavu::sans::regular().to_vec());
    fonts.load_font_data(dejavu::sans::bold().to_vec());
    Arc::new(fonts)
});

/// The figure's SVG as a PNG file.
pub fn png(figure: &Figure, svg: &str) -> Result<Vec<u8>, ChartError> {
    let fail = |reason: String| ChartError { figure: figure.title.clone(), reason };
    let options = Options { font_family: FONT.to_owned(), fontdb: FONTS.clone(), ..Options::default() };
    let tree = Tree::from_str(svg, &options).map_err(|error| fail(with_causes(&error)))?;
    let size = tree.size().to_int_size().scale_by(SCALE).ok_or_else(|| fail("empty picture".to_owned()))?;
    let mut pixels =
        Pixmap::new(size.width(), size.height()).ok_or_else(|| fail("picture too large".to_owned()))?;
    resvg::render(&tree, Transform::from_scale(SCALE, SCALE), &mut pixels.as_mut());
    pixels.encode_png().map_err(|error| fail(with_causes(&error)))
}

//! Line charts in panels, drawn once as SVG and rendered from that to PNG, with a font that comes along.

mod axis;
mod draw;
mod error;
mod figure;
mod points;
mod raster;

pub use draw::svg;
pub use error::ChartError;
use figure::FONT;
pub use figure::{Figure, Panel, Points, Series, Stroke};
pub use points::thin;
pub use raster::png;

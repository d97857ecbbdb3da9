//! What is drawn: figures, panels, lines.

/// Family name under which the embedded font is known to both renderers.
pub(super) const FONT: &str = "DejaVu Sans";

/// A page of panels.
#[derive(Clone, Debug)]
pub struct Figure {
    pub title: String,
    /// What the figure shows, for the report.
    pub caption: String,
    /// Panels per row.
    pub columns: usize,
    pub panels: Vec<Panel>,
}

/// One coordinate system.
#[derive(Clone, Debug)]
pub struct Panel {
    pub title: String,
    /// Axis names with their units.
    pub x_label: String,
    pub y_label: String,
    /// Shown part of the x axis; all data if absent.
    pub x_range: Option<(f64, f64)>,
    /// Ends of the y axis; all data with a margin if absent.
    pub y_range: Option<(f64, f64)>,
    /// Whether the x axis is logarithmic; values that are not positive are left out then.
    pub x_logarithmic: bool,
    /// Whether the y axis is logarithmic; values that are not positive are left out then.
    pub logarithmic: bool,
    pub series: Vec<Series>,
}

impl Panel {
    pub fn new(title: impl Into<String>, x_label: impl Into<String>, y_label: impl Into<String>) -> Self {
        Self {
            title: title.into(),
            x_label: x_label.into(),
            y_label: y_label.into(),
            x_range: None,
            y_range: None,
            x_logarithmic: false,
            logarithmic: false,
            series: Vec::new(),
        }
    }

    pub fn between(mut self, start: f64, end: f64) -> Self {
        self.x_range = Some((start, end));
        self
    }

    pub fn from_to(mut self, low: f64, high: f64) -> Self {
        self.y_range = Some((low, high));
        self
    }

    pub fn x_logarithmic(mut self) -> Self {
        self.x_logarithmic = true;
        self
    }

    pub fn logarithmic(mut self) -> Self {
        self.logarithmic = true;
        self
    }

    pub fn with(mut self, series: Series) -> Self {
        self.series.push(series);
        self
    }

    pub fn line(self, label: impl Into<String>, colour: usize, points: impl Points) -> Self {
        self.with(Series::new(label, colour, Stroke::Solid, points))
    }

    pub fn dashed(self, label: impl Into<String>, colour: usize, points: impl Points) -> Self {
        self.with(Series::new(label, colour, Stroke::Dashed, points))
    }

    pub fn held(self, label: impl Into<String>, colour: usize, points: impl Points) -> Self {
        self.with(Series::new(label, colour, Stroke::Held, points))
    }

    pub fn dots(self, label: impl Into<String>, colour: usize, points: impl Points) -> Self {
        self.with(Series::new(label, colour, Stroke::Dots, points))
    }
}

/// What can be drawn: x and y of each point.
pub trait Points: IntoIterator<Item = (f64, f64)> {}

impl<T: IntoIterator<Item = (f64, f64)>> Points for T {}

/// How a line is drawn.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Stroke {
    Solid,
    Dashed,
    /// Each value holds until the next, as the output of a sampled controller does.
    Held,
    /// Separate dots, for values that scatter.
    Dots,
}

/// A line with a legend entry; the colour is the `colour`th of the palette.
#[derive(Clone, Debug)]
pub struct Series {
    pub label: String,
    pub colour: usize,
    pub stroke: Stroke,
    pub points: Vec<(f64, f64)>,
}

impl Series {
    pub fn new(label: impl Into<String>, colour: usize, stroke: Stroke, points: impl Points) -> Self {
        Self { label: label.into(), colour, stroke, points: points.into_iter().collect() }
    }
}

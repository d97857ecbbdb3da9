//! A figure as SVG.

use std::error::Error;
use std::sync::Once;

use plotters::coord::ranged1d::{AsRangedCoord, ValueFormatter};
use plotters::prelude::*;

use super::axis::{decades, decimals, tick};
use super::points::{extent, visible};
use super::{ChartError, FONT, Figure, Panel, Series, Stroke};
use crate::causes::with_causes;

/// Drawing units per px: plotters rounds coordinates to whole units, which shows in curves when a unit is a pixel.
const FINENESS: u32 = 8;
/// Size of a panel in px.
const PANEL: (u32, u32) = (460, 300);
const TITLE_HEIGHT: u32 = 44;
const TEXT: RGBColor = RGBColor(40, 40, 40);

/// Okabe and Ito's palette, told apart by colour-blind readers; without its yellow, which is faint on white, and with
/// a violet and a grey more.
const PALETTE: [RGBColor; 9] = [
    RGBColor(0, 114, 178),
    RGBColor(213, 94, 0),
    RGBColor(0, 158, 115),
    RGBColor(204, 121, 167),
    RGBColor(86, 180, 233),
    RGBColor(230, 159, 0),
    RGBColor(60, 60, 60),
    RGBColor(110, 64, 170),
    RGBColor(150, 150, 150),
];

/// Pixels in drawing units.
const fn px(pixels: u32) -> u32 {
    pixels * FINENESS
}

/// Font of a height in px.
fn font(pixels: u32) -> TextStyle<'static> {
    TextStyle::from((FONT, px(pixels)).into_font()).color(&TEXT)
}

type Drawing<'a> = DrawingArea<SVGBackend<'a>, plotters::coord::Shift>;

/// The figure as an SVG document.
pub fn svg(figure: &Figure) -> Result<String, ChartError> {
    register_font();
    let columns = figure.columns.max(1);
    let rows = figure.panels.len().div_ceil(columns);
    let (width, height) = (PANEL.0 * columns as u32, PANEL.1 * rows as u32 + TITLE_HEIGHT);
    let (wide, high) = (width * FINENESS, height * FINENESS);
    let mut document = String::new();
    draw(figure, columns, rows, SVGBackend::with_string(&mut document, (wide, high)))
        .map_err(|error| ChartError { figure: figure.title.clone(), reason: with_causes(&*error) })?;
    // The view box keeps the drawing units, the size is in px.
    let drawn = format!("width=\"{wide}\" height=\"{high}\"");
    Ok(document.replacen(&drawn, &format!("width=\"{width}\" height=\"{height}\""), 1))
}

/// Text metrics need a font; the one drawn with comes along, so nothing has to be installed.
fn register_font() {
    static REGISTER: Once = Once::new();
    REGISTER.call_once(|| {
        // Fails only for bytes that are no font; then drawing reports it.
        let _ = plotters::style::register_font(FONT, FontStyle::Normal, dejavu::sans::regular());
        let _ = plotters::style::register_font(FONT, FontStyle::Bold, dejavu::sans::bold());
    });
}

fn draw(figure: &Figure, columns: usize, rows: usize, backend: SVGBackend<'_>) -> Result<(), Box<dyn Error>> {
    let root = backend.into_drawing_area();
    root.fill(&WHITE)?;
    let title = TextStyle::from((FONT, px(17), FontStyle::Bold).into_font()).color(&TEXT);
    let (head, body) = root.split_vertically(px(TITLE_HEIGHT));
    head.draw(&Text::new(figure.title.as_str(), (px(16) as i32, px(14) as i32), title))?;
    for (area, panel) in body.split_evenly((rows, columns)).iter().zip(&figure.panels) {
        draw_panel(panel, area)?;
    }
    root.present()?;
    Ok(())
}

fn draw_panel(panel: &Panel, area: &Drawing<'_>) -> Result<(), Box<dyn Error>> {
    let shown = visible(panel);
    let x_range = panel.x_range.unwrap_or_else(|| extent(shown.iter().flatten().map(|point| point.0)));
    let y_range = extent(shown.iter().flatten().map(|point| point.1));
    let x_axis = x_range.0..x_range.1;
    let x_decimals = decimals(x_range.1 - x_range.0);
    let margin = match 0.06 * (y_range.1 - y_range.0) {
        0.0 => (0.06 * y_range.0.abs()).max(1e-12),
        margin => margin,
    };
    let (low, high) = panel.y_range.unwrap_or((y_range.0 - margin, y_range.1 + margin));
    let y_axis = low..high;
    let y_decimals = decimals(y_axis.end - y_axis.start);
    let x_tick = |x: &f64| tick(*x, x_decimals);
    let y_tick = |y: &f64| tick(*y, y_decimals);
    let power = |value: &f64| format!("{value:.0e}");
    let canvas = Canvas { panel, shown: &shown, area };
    match (panel.x_logarithmic, panel.logarithmic) {
        (false, false) => canvas.draw(x_axis, y_axis, &x_tick, &y_tick),
        (false, true) => canvas.draw(x_axis, decades(y_range).log_scale(), &x_tick, &power),
        (true, false) => canvas.draw(decades(x_range).log_scale(), y_axis, &power, &y_tick),
        (true, true) => {
            canvas.draw(decades(x_range).log_scale(), decades(y_range).log_scale(), &power, &power)
        }
    }
}

/// A panel, the points of it that are shown, and where it is drawn.
struct Canvas<'a, 'b> {
    panel: &'a Panel,
    shown: &'a [Vec<(f64, f64)>],
    area: &'a Drawing<'b>,
}

impl Canvas<'_, '_> {
    fn draw<X, Y>(
        &self,
        x_axis: X,
        y_axis: Y,
        x_tick: &dyn Fn(&f64) -> String,
        y_tick: &dyn Fn(&f64) -> String,
    ) -> Result<(), Box<dyn Error>>
    where
        X: AsRangedCoord<Value = f64>,
        X::CoordDescType: ValueFormatter<f64>,
        Y: AsRangedCoord<Value = f64>,
        Y::CoordDescType: ValueFormatter<f64>,
    {
        let Self { panel, shown, area } = *self;
        let legend_position = emptiest_corner(panel, shown);
        let mut chart = ChartBuilder::on(area)
            .margin(px(10))
            .margin_right(px(18))
            .caption(&panel.title, font(14))
            .set_label_area_size(LabelAreaPosition::Left, px(66))
            .set_label_area_size(LabelAreaPosition::Bottom, px(42))
            .build_cartesian_2d(x_axis, y_axis)?;
        chart
            .configure_mesh()
            .x_desc(panel.x_label.as_str())
            .y_desc(panel.y_label.as_str())
            .axis_desc_style(font(13))
            .label_style(font(12))
            .x_labels(6)
            .y_labels(6)
            .x_label_formatter(x_tick)
            .y_label_formatter(y_tick)
            .light_line_style(TRANSPARENT)
            .bold_line_style(RGBColor(225, 225, 225).stroke_width(px(1)))
            .axis_style(RGBColor(120, 120, 120).stroke_width(px(1)))
            .set_all_tick_mark_size(px(4))
            .draw()?;
        for (series, points) in panel.series.iter().zip(shown) {
            draw_series(&mut chart, series, points)?;
        }
        if panel.series.iter().any(|series| !series.label.is_empty()) {
            chart
                .configure_series_labels()
                .position(legend_position)
                .background_style(WHITE.mix(0.85))
                .border_style(RGBColor(200, 200, 200).stroke_width(px(1)))
                .label_font(font(12))
                .legend_area_size(px(28))
                .margin(px(5))
                .draw()?;
        }
        Ok(())
    }
}

fn draw_series<'a, X, Y>(
    chart: &mut ChartContext<'a, SVGBackend<'a>, Cartesian2d<X, Y>>,
    series: &Series,
    points: &[(f64, f64)],
) -> Result<(), Box<dyn Error>>
where
    X: plotters::coord::ranged1d::Ranged<ValueType = f64>,
    Y: plotters::coord::ranged1d::Ranged<ValueType = f64>,
{
    let colour = PALETTE[series.colour % PALETTE.len()];
    let style = colour.stroke_width(px(2) - px(1) / 2);
    let line = points.iter().copied();
    let drawn = match series.stroke {
        Stroke::Solid | Stroke::Held => chart.draw_series(LineSeries::new(line, style))?,
        Stroke::Dashed => chart.draw_series(DashedLineSeries::new(line, px(7), px(5), style))?,
        Stroke::Dots => {
            let radius = px(3) / 2;
            chart.draw_series(line.map(|point| Circle::new(point, radius, colour.filled())))?
        }
    };
    if !series.label.is_empty() {
        let length = match series.stroke {
            Stroke::Solid | Stroke::Held => px(20),
            Stroke::Dashed => px(8),
            Stroke::Dots => px(5),
        };
        let key = if series.stroke == Stroke::Dots { colour.stroke_width(px(5)) } else { style };
        drawn.label(&series.label).legend(move |(x, y)| {
            let start = x + px(3) as i32;
            PathElement::new(vec![(start, y), (start + length as i32, y)], key)
        });
    }
    Ok(())
}

/// The corner of the panel whose quarter holds the fewest points.
fn emptiest_corner(panel: &Panel, shown: &[Vec<(f64, f64)>]) -> SeriesLabelPosition {
    let scaled = |value: f64, logarithmic: bool| if logarithmic { value.log10() } else { value };
    let place =
        |point: &(f64, f64)| (scaled(point.0, panel.x_logarithmic), scaled(point.1, panel.logarithmic));
    let (left, right) = match panel.x_range {
        Some((start, end)) => (scaled(start, panel.x_logarithmic), scaled(end, panel.x_logarithmic)),
        None => extent(shown.iter().flatten().map(|point| place(point).0)),
    };
    let (low, high) = match panel.y_range {
        Some((low, high)) => (scaled(low, panel.logarithmic), scaled(high, panel.logarithmic)),
        None => extent(shown.iter().flatten().map(|point| place(point).1)),
    };
    let share = |point: &(f64, f64)| {
        let (x, y) = place(point);
        ((x - left) / (right - left).max(f64::MIN_POSITIVE), (y - low) / (high - low).max(f64::MIN_POSITIVE))
    };
    let occupation = |right: bool, upper: bool| {
        let is_inside = |(x, y): (f64, f64)| {
            (if right { x > 0.55 } else { x < 0.45 }) && (if upper { y > 0.6 } else { y < 0.4 })
        };
        shown.iter().flatten().filter(|point| is_inside(share(point))).count()
    };
    let corners = [
        (SeriesLabelPosition::UpperRight, occupation(true, true)),
        (SeriesLabelPosition::LowerRight, occupation(true, false)),
        (SeriesLabelPosition::UpperLeft, occupation(false, true)),
        (SeriesLabelPosition::LowerLeft, occupation(false, false)),
    ];
    let fewest = corners.iter().map(|corner| corner.1).min();
    let emptiest = corners.into_iter().find(|corner| Some(corner.1) == fewest);
    emptiest.map_or(SeriesLabelPosition::UpperRight, |corner| corner.0)
}

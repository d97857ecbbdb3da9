//! Which points of a panel are drawn.

use super::{Panel, Stroke};

/// Most points a line keeps; more cannot be seen in a panel.
const RESOLUTION: usize = 1000;

/// Largest magnitudes that are drawn, on linear axes, whose length has to be a number, and on logarithmic ones, which end
/// at a power of ten; what is beyond lies on the edge.
const LARGEST: f64 = 5e307;
const LARGEST_POWER: f64 = 1e308;

/// Largest ratio of two values on a logarithmic axis; what is smaller lies on the edge.
const LARGEST_RATIO: f64 = 1e300;

/// The points of each series inside the x range that can be drawn, thinned to what a panel resolves.
pub(super) fn visible(panel: &Panel) -> Vec<Vec<(f64, f64)>> {
    let (start, end) = panel.x_range.unwrap_or((f64::NEG_INFINITY, f64::INFINITY));
    let is_drawable = |&(x, y): &(f64, f64)| {
        x >= start
            && x <= end
            && x.is_finite()
            && y.is_finite()
            && (!panel.x_logarithmic || x > 0.0)
            && (!panel.logarithmic || y > 0.0)
    };
    let all =
        || panel.series.iter().flat_map(|series| series.points.iter().filter(|point| is_drawable(point)));
    let x_limits = limits(panel.x_logarithmic, all().map(|point| point.0));
    let y_limits = limits(panel.logarithmic, all().map(|point| point.1));
    let limited = |(x, y): (f64, f64)| (x.clamp(x_limits.0, x_limits.1), y.clamp(y_limits.0, y_limits.1));
    panel
        .series
        .iter()
        .map(|series| {
            let drawable = series.points.iter().copied().filter(is_drawable).map(limited);
            let points = thin(drawable.collect(), RESOLUTION);
            if series.stroke == Stroke::Held { staircase(&points) } else { points }
        })
        .collect()
}

/// Smallest and largest value that an axis can show along with all others.
fn limits(logarithmic: bool, values: impl Iterator<Item = f64>) -> (f64, f64) {
    if !logarithmic {
        return (-LARGEST, LARGEST);
    }
    let largest = values.fold(f64::MIN_POSITIVE, f64::max).min(LARGEST_POWER);
    ((largest / LARGEST_RATIO).max(f64::MIN_POSITIVE), LARGEST_POWER)
}

/// Adds a corner before each new value.
fn staircase(points: &[(f64, f64)]) -> Vec<(f64, f64)> {
    let corners = points.windows(2).flat_map(|pair| [pair[0], (pair[1].0, pair[0].1)]);
    corners.chain(points.last().copied()).collect()
}

/// At most `resolution` points: the smallest and the largest of each of half as many bins, in their order, so that no
/// peak is lost.
pub fn thin(points: Vec<(f64, f64)>, resolution: usize) -> Vec<(f64, f64)> {
    if points.len() <= resolution {
        return points;
    }
    let bin = points.len().div_ceil(resolution / 2);
    points
        .chunks(bin)
        .flat_map(|chunk| {
            let by_value = |a: &&(f64, f64), b: &&(f64, f64)| a.1.total_cmp(&b.1);
            let ends = [chunk.iter().min_by(by_value), chunk.iter().max_by(by_value)];
            let mut ends: Vec<(f64, f64)> = ends.into_iter().flatten().copied().collect();
            ends.sort_by(|a, b| a.0.total_cmp(&b.0));
            ends
        })
        .collect()
}

/// Smallest and largest value, 0 to 1 if there is none.
pub(super) fn extent(values: impl Iterator<Item = f64>) -> (f64, f64) {
    values
        .fold(None, |range: Option<(f64, f64)>, value| {
            Some(range.map_or((value, value), |(low, high)| (low.min(value), high.max(value))))
        })
        .unwrap_or((0.0, 1.0))
}

#[cfg(test)]
mod tests {
    use super::super::{Figure, svg};
    use super::*;

    /// Guards: plotters counts decades without end where their ratio overflows, and cannot draw an axis to infinity.
    #[test]
    fn the_largest_and_the_smallest_numbers_are_drawn() {
        let extremes = [(5e-324, -f64::MAX), (1.0, 1.0), (f64::MAX, f64::MAX), (f64::INFINITY, 2.0)];
        for turned in [false, true] {
            let points = extremes.map(|(x, y)| if turned { (y, x) } else { (x, y) });
            let panel = Panel::new("", "", "").dots("", 0, points);
            let panels = vec![
                panel.clone(),
                panel.clone().logarithmic(),
                panel.clone().x_logarithmic(),
                panel.logarithmic().x_logarithmic(),
            ];
            let figure = Figure { title: String::new(), caption: String::new(), columns: 2, panels };
            let document = svg(&figure).unwrap();
            // Three points on linear axes, the two that are positive where their axis is logarithmic.
            assert_eq!(document.matches("<circle").count(), 3 + 2 + 3 + 2, "{turned}");
        }
    }

    /// Guards: a swarm that seemed to settle where the drawing had ended.
    #[test]
    fn growth_is_drawn_as_far_as_numbers_reach() {
        let growth = (0..=310).map(|decade| (f64::from(decade), 10f64.powi(decade - 2)));
        let panel = Panel::new("", "", "").dots("", 0, growth.clone()).logarithmic();
        let [points] = &visible(&panel)[..] else { panic!("one series") };
        assert!(points.iter().zip(growth).all(|(drawn, (_, y))| (drawn.1 / y.max(1e8) - 1.0).abs() < 1e-9));
    }

    #[test]
    fn thinning_keeps_the_extremes() {
        let mut points: Vec<(f64, f64)> = (0..100_000).map(|k| (f64::from(k), 0.0)).collect();
        points[12_345].1 = 7.0;
        points[54_321].1 = -3.0;
        let thinned = thin(points, RESOLUTION);
        assert!(thinned.len() <= RESOLUTION + 2);
        assert!(thinned.contains(&(12_345.0, 7.0)) && thinned.contains(&(54_321.0, -3.0)));
        assert!(thinned.windows(2).all(|pair| pair[0].0 <= pair[1].0));
    }
}

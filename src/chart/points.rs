//! Which points of a panel are drawn.

use super::{Panel, Stroke};

/// Most points a line keeps; more cannot be seen in a panel.
const RESOLUTION: usize = 1000;

/// Largest magnitude that is drawn, and the inverse of the smallest on a logarithmic axis: what is beyond lies on the edge.
/// Lengths of linear and ratios of logarithmic axes have to be numbers, too.
const LARGEST: f64 = 1e150;

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
    let limited = |value: f64, logarithmic: bool| {
        value.clamp(if logarithmic { 1.0 / LARGEST } else { -LARGEST }, LARGEST)
    };
    let limited = |(x, y): (f64, f64)| (limited(x, panel.x_logarithmic), limited(y, panel.logarithmic));
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

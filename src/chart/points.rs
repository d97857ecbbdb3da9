//! Which points of a panel are drawn.

use super::{Panel, Stroke};

/// Most points a line keeps; more cannot be seen in a panel.
const RESOLUTION: usize = 1000;

/// The points of each series inside the x range that can be drawn, thinned to what a panel resolves.
pub(super) fn visible(panel: &Panel) -> Vec<Vec<(f64, f64)>> {
    let (start, end) = panel.x_range.unwrap_or((f64::NEG_INFINITY, f64::INFINITY));
    let is_drawable = |&(x, y): &(f64, f64)| {
        x >= start
            && x <= end
            && y.is_finite()
            && (!panel.x_logarithmic || x > 0.0)
            && (!panel.logarithmic || y > 0.0)
    };
    panel
        .series
        .iter()
        .map(|series| {
            let points = thin(series.points.iter().copied().filter(is_drawable).collect(), RESOLUTION);
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
    use super::*;

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

//! What a fast observer costs: noise against the peak of its start-up, and how the peak is avoided.

use rayon::prelude::*;

use super::candidates::velocity_error;
use crate::chart::Panel;
use crate::host::Value;
use crate::observer::extended_state::{ExtendedState, gains_from_bandwidth};
use crate::observer::rig_observer::RigEstimatorSettings;
use crate::observer::sampled_extended_state::{ExtendedStateObserver, ExtendedStateSettings, Form};
use crate::study::loop_packages::LoopPackages;
use crate::study::metrics::peak;
use crate::study::report::quantity;
use crate::study::rig::observers::KINDS;
use crate::study::rig::recording::{Conditions, RIG, Recording, Reference, SENSOR, SET_POINT};
use crate::study::rig::simulation::{Measurement, Scenario, errors, simulate};
use crate::study::tuning::candidate::Candidate;
use crate::study::tuning::noise_aware::settings;
use crate::study::{FigureWithData, StudyError, Summary, Table};

const BANDWIDTHS: [f64; 15] =
    [20.0, 30.0, 40.0, 60.0, 80.0, 100.0, 130.0, 160.0, 200.0, 250.0, 300.0, 360.0, 430.0, 510.0, 600.0];
/// b of the plant at 9 mm.
const INPUT_GAIN: f64 = -3705.0;
/// Sensor noise \[V\].
const NOISE: f64 = 1e-3;
/// First sample of which the noise error is scored.
const SCORED_FROM: usize = 1000;

/// A kind of observer over its bandwidth.
pub struct Line {
    pub name: &'static str,
    /// Bandwidth \[rad/s\], largest |z2| from zero \[m/s\], rms velocity error under noise \[m/s\].
    pub points: Vec<(f64, f64, f64)>,
}

/// An observer as a function of its bandwidth.
type Family = (&'static str, fn(f64) -> ExtendedStateSettings);

const FAMILIES: [Family; 4] = [
    ("LESO", |bandwidth| settings(&Candidate::Linear { bandwidth, input_gain: INPUT_GAIN })),
    ("LESO, current form", |bandwidth| ExtendedStateSettings {
        form: Form::Current,
        ..settings(&Candidate::Linear { bandwidth, input_gain: INPUT_GAIN })
    }),
    ("LESO, b = 1 as printed", |bandwidth| settings(&Candidate::Linear { bandwidth, input_gain: 1.0 })),
    ("NESO, alpha and delta of Table 4", |bandwidth| {
        settings(&Candidate::Nonlinear {
            gains: gains_from_bandwidth(bandwidth),
            input_gain: INPUT_GAIN,
            exponents: [1.0, 0.5, 0.25],
            linear_zones: [0.01; 3],
        })
    }),
];

/// All kinds over all bandwidths; where one diverges it has no point.
pub fn trade_off() -> Vec<Line> {
    let noisy = Recording::make(&Conditions {
        noise: NOISE,
        disturbance_step: (1.0, 2.5),
        ..Conditions::new(Reference::SineAndStep, 4.0)
    });
    FAMILIES
        .par_iter()
        .map(|(name, settings)| {
            let points = BANDWIDTHS
                .iter()
                .filter_map(|bandwidth| {
                    let settings = settings(*bandwidth);
                    let error =
                        velocity_error(RigEstimatorSettings::ExtendedState(settings), &noisy, SCORED_FROM)?;
                    Some((*bandwidth, start_up_peak(settings)?, error))
                })
                .collect();
            Line { name, points }
        })
        .collect()
}

/// Largest |z2| \[m/s\] from zero estimates at a ball that rests at 9 mm; none if the observer diverges.
fn start_up_peak(settings: ExtendedStateSettings) -> Option<f64> {
    let mut observer = ExtendedStateObserver::new(settings, ExtendedState::default());
    let (sensor, voltage) = (SENSOR.voltage(SET_POINT), RIG.operating_voltage(SET_POINT));
    let mut peak = 0.0f64;
    for _ in 0..1000 {
        let estimate = observer.update(sensor, voltage);
        if estimate.restarted {
            return None;
        }
        peak = peak.max(estimate.state.velocity.abs() / SENSOR.gain);
    }
    Some(peak)
}

/// Points that no other beats in both respects, by peak: peak \[m/s\] and error \[m/s\].
pub fn front(lines: &[Line]) -> Vec<(f64, f64)> {
    let mut points: Vec<(f64, f64)> =
        lines.iter().flat_map(|line| &line.points).map(|(_, peak, error)| (*peak, *error)).collect();
    points.sort_by(|a, b| a.0.total_cmp(&b.0));
    let mut smallest = f64::INFINITY;
    points.retain(|(_, error)| {
        let is_better = *error < smallest;
        smallest = smallest.min(*error);
        is_better
    });
    points
}

pub fn figure(lines: &[Line]) -> FigureWithData {
    let mut plane = Panel::new(
        "one point per bandwidth, 20 to 600 rad/s",
        "peak of the velocity estimate from zero [m/s]",
        "rms velocity error, 1 mV of noise [mm/s]",
    )
    .x_logarithmic()
    .logarithmic();
    let mut over = Panel::new(
        "the same error over the bandwidth",
        "bandwidth wo [rad/s]",
        "rms velocity error, 1 mV of noise [mm/s]",
    )
    .x_logarithmic()
    .logarithmic();
    let mut table = Table::default();
    table.add("bandwidth [rad/s]", BANDWIDTHS);
    for (colour, line) in lines.iter().enumerate() {
        let in_plane = line.points.iter().map(|(_, peak, error)| (*peak, 1e3 * error));
        let over_bandwidth = line.points.iter().map(|(bandwidth, _, error)| (*bandwidth, 1e3 * error));
        plane = plane.line("", colour, in_plane);
        over = over.line(line.name, colour, over_bandwidth);
        let column = |value: fn(&(f64, f64, f64)) -> f64| {
            BANDWIDTHS.map(|bandwidth| {
                line.points.iter().find(|point| point.0 == bandwidth).map_or(f64::NAN, value)
            })
        };
        table.add(format!("{}: peak from zero [m/s]", line.name), column(|point| point.1));
        table.add(format!("{}: rms velocity error [m/s]", line.name), column(|point| point.2));
    }
    let best = front(lines).into_iter().map(|(peak, error)| (peak, 1e3 * error));
    plane = plane.dots("Pareto front", 6, best);
    FigureWithData::new("rig_peaking", "Noise against peaking", table)
        .caption(
            "Observers in sensor volts. Left: what none other beats in both respects is dotted. NESO above \
             400 rad/s is more than one Runge-Kutta step per ms can solve. The peak arises from zero \
             estimates alone; see the table of starts for how to do without.",
        )
        .panels(2, [plane, over])
}

/// Peaks and rms errors for the controller model's three starts, through the packages.
pub fn starts(packages: &LoopPackages) -> Result<Summary, StudyError> {
    let mut rows = Vec::new();
    for (observer, kind, input_gain) in [
        ("LESO, Table 3", KINDS[0], 1.0),
        ("LESO, Table 3 with b = -3705", KINDS[0], INPUT_GAIN),
        ("NESO, Table 4", KINDS[1], 1.0),
    ] {
        let mut row = vec![observer.to_owned()];
        for start in ["zero", "matched", "steady"] {
            let parameters = [
                kind,
                ("observer.input_gain", Value::Real(input_gain)),
                ("observer.initial", Value::Text(start)),
            ];
            let run = simulate(packages, &Scenario::new(Reference::Hold, 2.0, &parameters))?;
            let peak = peak(run.estimate("velocity").iter().map(|velocity| velocity / SENSOR.gain));
            let error = errors(&run, Measurement::Volts, input_gain, 0.0)[0];
            row.push(format!("{}, {}", quantity(peak, "m/s"), quantity(error, "V")));
        }
        rows.push(row);
    }
    Ok(Summary::new(
        "Start of the estimates, ball at rest at 9 mm, observer in volts: largest |z2|, rms e1 over 2 s",
        [
            "observer",
            "zero, as in the paper",
            "matched: position measured",
            "steady: and what holds the ball",
        ],
        rows,
    ))
}

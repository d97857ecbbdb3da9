//! One run of the loop, scored while it runs.

use super::candidate::ObserverCandidate;
use super::spread::Draw;
use crate::host::{Trace, Value};
use crate::plant::levitated_ball::LevitatedBall;
use crate::study::StudyError;
use crate::study::ball::BallReference;
use crate::study::loop_packages::LoopPackages;
use crate::study::metrics::{difference, root_mean_square};
use crate::study::run::Run;

/// Length of a run and from when on it is scored \[s\].
pub const DURATION: f64 = 4.0;
pub const SCORED_FROM: f64 = 2.0;

/// What became of a run.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Outcome {
    /// Root mean squares of the scored part.
    Survived {
        /// y - y* \[m\]
        position: f64,
        /// Share of lam0
        flux: f64,
    },
    /// The ball touched a stop at this time \[s\].
    Lost { time: f64 },
}

impl Outcome {
    pub fn survived(&self) -> bool {
        matches!(self, Self::Survived { .. })
    }

    /// rms |y - y*| \[m\], infinite if the ball was lost.
    pub fn position(&self) -> f64 {
        match self {
            Self::Survived { position, .. } => *position,
            Self::Lost { .. } => f64::INFINITY,
        }
    }

    /// rms flux error, infinite if the ball was lost.
    pub fn flux(&self) -> f64 {
        match self {
            Self::Survived { flux, .. } => *flux,
            Self::Lost { .. } => f64::INFINITY,
        }
    }
}

/// Steps after which it is looked whether the ball is lost.
const STEPS_BETWEEN_LOOKS: usize = 100;

/// Runs the loop until [`DURATION`] or until the ball touches a stop. The drive adds the draw's offset to the voltage, so
/// the controller does not know it.
pub fn run(
    packages: &LoopPackages,
    candidate: &ObserverCandidate,
    reference: BallReference,
    draw: &Draw,
) -> Result<Outcome, StudyError> {
    let believed = LevitatedBall::LABORATORY;
    let real = LevitatedBall {
        resistance: believed.resistance * (1.0 + draw.resistance),
        inductance_constant: believed.inductance_constant * (1.0 + draw.inductance_constant),
        mass: believed.mass * (1.0 + draw.mass),
        ..believed
    };
    let carrying_flux = real.equilibrium_flux();
    let plant = [
        ("resistance", Value::Real(real.resistance)),
        ("inductance_constant", Value::Real(real.inductance_constant)),
        ("mass", Value::Real(real.mass)),
        ("initial.flux", Value::Real(carrying_flux)),
        ("sensor.noise", Value::Real(draw.noise)),
        ("sensor.seed", Value::Integer(draw.seed)),
    ];
    let initial_flux = carrying_flux - draw.flux * believed.equilibrium_flux();
    let mut controller = candidate.parameters.clone();
    controller.extend([
        ("observer.initial.flux", Value::Real(initial_flux)),
        ("controller.reference_filter", Value::Real(reference.filter_rate())),
    ]);
    let sample_time = candidate.sample_time;
    let mut control_loop = packages.connect(&plant, &controller, sample_time)?;
    control_loop.add_offset("voltage", draw.voltage_offset)?;
    control_loop.record(&[
        ("plant", "position"),
        ("plant", "flux"),
        ("plant", "contact"),
        ("controller", "reference.position"),
        ("controller", "estimate.flux"),
    ])?;
    // The last row, at the end, belongs to a step that begins there.
    let rows = (DURATION / sample_time).round() as usize + 1;
    control_loop.initialise(0.0, Some(rows as f64 * sample_time), sample_time)?;
    let wanted = control_loop.controller().variable("reference")?;
    let mut trace = control_loop.empty_trace();
    let touches = |trace: &Trace| {
        let contacts = trace.column("plant.contact").unwrap_or_default();
        contacts.iter().rev().take(STEPS_BETWEEN_LOOKS).any(|contact| *contact != 0.0)
    };
    while trace.len() < rows && !touches(&trace) {
        let steps = STEPS_BETWEEN_LOOKS.min(rows - trace.len());
        control_loop
            .run_into(&mut trace, steps, |time, controller, _| controller.set(wanted, reference.at(time)))?;
    }
    let run = Run::from(trace);
    if let Some(time) = run.lost_at {
        return Ok(Outcome::Lost { time });
    }
    let deviation = difference(run.state("position"), &run["controller.reference.position"]);
    let scored = |errors: &[f64]| root_mean_square(run.since(SCORED_FROM, &errors[..rows - 1]));
    Ok(Outcome::Survived {
        position: scored(&deviation),
        flux: scored(&run.error("flux")) / believed.equilibrium_flux(),
    })
}

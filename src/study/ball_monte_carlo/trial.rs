//! One run of the loop, scored while it runs.

use super::contender::Contender;
use super::spread::Draw;
use crate::host::{HostError, Instance, Value};
use crate::plant::levitated_ball::LevitatedBall;
use crate::signal::BallReference;
use crate::study::StudyError;
use crate::study::loop_packages::LoopPackages;

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

/// Value references of real variables.
fn references<const N: usize>(instance: &Instance, names: [&str; N]) -> Result<[u32; N], HostError> {
    let mut found = [0; N];
    for (reference, name) in found.iter_mut().zip(names) {
        *reference = instance.variable(name)?.value_reference();
    }
    Ok(found)
}

/// Runs the loop, controller first, until [`DURATION`] or until the ball touches a stop. The drive adds the draw's offset to
/// the voltage, so the controller does not know it.
pub fn run(
    packages: &LoopPackages,
    contender: &Contender,
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
    let mut plant = packages.plant(&[
        ("resistance", Value::Real(real.resistance)),
        ("inductance_constant", Value::Real(real.inductance_constant)),
        ("mass", Value::Real(real.mass)),
        ("initial.flux", Value::Real(carrying_flux)),
        ("sensor.noise", Value::Real(draw.noise)),
        ("sensor.seed", Value::Integer(draw.seed)),
    ])?;
    let mut controller = packages.controller(&contender.parameters)?;
    let sample_time = contender.sample_time;
    for (name, value) in [
        ("sample_time", sample_time),
        ("observer.initial.flux", carrying_flux - draw.flux * believed.equilibrium_flux()),
        ("controller.reference_filter", reference.filter_rate()),
    ] {
        controller.set_by_name(name, value)?;
    }
    plant.initialise(0.0, Some(DURATION))?;
    controller.initialise(0.0, Some(DURATION))?;

    let sensed = references(&plant, ["current_measured", "position", "flux"])?;
    let driven = references(&plant, ["voltage"])?;
    let contact = plant.variable("contact")?;
    let heard = references(&controller, ["current", "reference"])?;
    let told = references(&controller, ["voltage", "reference.position", "estimate.flux"])?;
    let (mut plant_values, mut controller_values) = ([0.0; 3], [0.0; 3]);
    let (mut position_squares, mut flux_squares, mut scored) = (0.0, 0.0, 0.0);
    let steps = (DURATION / sample_time).round() as u32;
    for step in 0..steps {
        let time = f64::from(step) * sample_time;
        plant.get_reals(&sensed, &mut plant_values)?;
        let [current, position, flux] = plant_values;
        controller.set_reals(&heard, &[current, reference.at(time)])?;
        controller.step(time, sample_time)?;
        controller.get_reals(&told, &mut controller_values)?;
        let [voltage, wanted, estimate] = controller_values;
        if time >= SCORED_FROM - 0.5 * sample_time {
            position_squares += (position - wanted) * (position - wanted);
            flux_squares += (estimate - flux) * (estimate - flux);
            scored += 1.0;
        }
        plant.set_reals(&driven, &[voltage + draw.voltage_offset])?;
        plant.step(time, sample_time)?;
        if plant.get(contact)? != 0.0 {
            return Ok(Outcome::Lost { time: time + sample_time });
        }
    }
    Ok(Outcome::Survived {
        position: f64::sqrt(position_squares / scored),
        flux: f64::sqrt(flux_squares / scored) / believed.equilibrium_flux(),
    })
}

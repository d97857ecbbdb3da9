//! What a plant says of itself.

use core::fmt::Debug;

use crate::model::Description;
use crate::model::variable::{Variable, required_row};
use crate::model::work::Load;
use crate::scalar::Scalar;
use serde::Serialize;
use serde::de::DeserializeOwned;

/// State of a plant, and the mode that its equations are in: which contact it has, say. Modes change at events.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Motion<M, const X: usize> {
    pub state: [f64; X],
    pub mode: M,
}

/// Rows of what a plant's sensor is like, by their names in the plant's table.
#[derive(Clone, Copy, Debug)]
pub struct SensorRows {
    /// Standard deviation of its white noise.
    pub noise: usize,
    pub resolution: usize,
    pub sample_time: usize,
    pub seed: usize,
}

impl SensorRows {
    /// Found by the compiler.
    pub const fn of(variables: &[Variable]) -> Self {
        Self {
            noise: required_row(variables, "sensor.noise"),
            resolution: required_row(variables, "sensor.resolution"),
            sample_time: required_row(variables, "sensor.sample_time"),
            seed: required_row(variables, "sensor.seed"),
        }
    }
}

/// White noise that is added to a state at each communication point.
#[derive(Clone, Copy, Debug)]
pub struct ProcessNoise {
    /// Which of the states, by its place in [`PlantEquations::STATES`].
    pub state: usize,
    /// Row of its standard deviation.
    pub standard_deviation: usize,
}

/// A plant of `N` variables, `X` continuous states and `U` inputs.
///
/// What is generic over [`Scalar`] is written once for values, derivatives and dependencies. `values` are those of the
/// table's rows; an equation reads what is given and writes what follows.
///
/// An instance keeps what follows from fixed parameters and is needed at each step.
pub trait PlantEquations<const N: usize, const X: usize, const U: usize>:
    Clone + PartialEq + Send + Serialize + DeserializeOwned + 'static
{
    /// In which of several ways the equations go on from here; the default one is that of free motion.
    type Mode: Copy + Debug + Default + PartialEq + Send + Serialize + DeserializeOwned + 'static;

    const DESCRIPTION: &'static Description;

    /// All modes.
    const MODES: &'static [Self::Mode];

    /// Rows of the states, in the order of the rows of their derivatives.
    const STATES: [usize; X];

    /// Rows of the inputs, the voltage first.
    const INPUTS: [usize; U];

    /// Row of the sensor's reading.
    const READING: usize;

    /// Not to be chosen.
    const SENSOR: SensorRows = SensorRows::of(Self::DESCRIPTION.variables);

    const PROCESS_NOISE: Option<ProcessNoise> = None;

    /// With these parameters.
    fn new(values: &[f64; N]) -> Self;

    /// Parameters that follow from others.
    fn calculate_parameters<S: Scalar>(values: &mut [S; N]) {
        let _ = values;
    }

    /// The state that initialisation begins with.
    fn initial_state<S: Scalar>(values: &[S; N]) -> [S; X];

    /// The mode of the initial state.
    fn initial_mode(values: &[f64; N], state: &[f64; X]) -> Self::Mode {
        let _ = (values, state);
        Self::Mode::default()
    }

    /// A number that depends on whatever [`Self::initial_mode`] follows from.
    fn cause_of_initial_mode<S: Scalar>(values: &[S; N], state: &[S; X]) -> S {
        let _ = (values, state);
        S::from(0.0)
    }

    /// `state` with what a mode forces it to be.
    fn imposed(values: &[f64; N], state: [f64; X], mode: Self::Mode) -> [f64; X] {
        let _ = (values, mode);
        state
    }

    /// Derivatives, event indicators and all else that follows at one instant from states, inputs and parameters.
    fn evaluate<S: Scalar>(values: &mut [S; N], mode: Self::Mode);

    /// As [`Self::evaluate`], with what the instance keeps.
    #[inline]
    fn evaluate_at_step(&self, values: &mut [f64; N], mode: Self::Mode) {
        Self::evaluate(values, mode);
    }

    /// The voltage that acts \[V\] when the input is `voltage`.
    fn acting_voltage<S: Scalar>(values: &[S; N], voltage: S) -> S {
        let _ = values;
        voltage
    }

    /// Mean of [`Self::acting_voltage`] \[V\] over `duration` \[s\], while the input begins with `voltage` and has a `slope`.
    fn mean_acting_voltage(values: &[f64; N], voltage: f64, slope: f64, duration: f64) -> f64 {
        let _ = values;
        voltage + 0.5 * slope * duration
    }

    /// Writes the outputs that tell which voltage \[V\] acted.
    fn report_acting_voltage<S: Scalar>(values: &mut [S; N], voltage: S);

    /// What the sensor measures.
    fn measured<S: Scalar>(values: &[S; N], state: &[S; X]) -> S;

    /// A reading within the sensor's range.
    fn within_range<S: Scalar>(values: &[S; N], reading: S) -> S {
        let _ = values;
        reading
    }

    /// Lets `duration` \[s\] pass with held inputs.
    fn advance(
        &self,
        values: &[f64; N],
        motion: Motion<Self::Mode, X>,
        inputs: [f64; U],
        duration: f64,
    ) -> Motion<Self::Mode, X>;

    /// As [`Self::advance`] with inputs that begin with `inputs` and have `slopes` \[1/s of their units\].
    fn advance_under_ramp(
        &self,
        values: &[f64; N],
        motion: Motion<Self::Mode, X>,
        inputs: [f64; U],
        slopes: [f64; U],
        duration: f64,
    ) -> Motion<Self::Mode, X>;

    /// What an event makes of a motion under these inputs.
    fn transition(
        values: &[f64; N],
        motion: Motion<Self::Mode, X>,
        inputs: [f64; U],
    ) -> Motion<Self::Mode, X> {
        let _ = (values, inputs);
        motion
    }

    /// The motion at the end of a step, where something beside [`Self::advance`] may have moved it.
    fn at_communication_point(values: &[f64; N], motion: Motion<Self::Mode, X>) -> Motion<Self::Mode, X> {
        let _ = values;
        motion
    }

    /// Writes what outputs say of the mode.
    fn report_mode(values: &mut [f64; N], mode: Self::Mode) {
        let _ = (values, mode);
    }

    /// What a user is told when this mode begins, if anything.
    fn announcement(mode: Self::Mode) -> Option<&'static str> {
        let _ = mode;
        None
    }

    /// What computing this plant costs, beside its sensor.
    fn load(&self) -> Load {
        Load::NONE
    }

    /// Row and value of something that follows from the state and has to stay finite, too.
    fn also_finite(values: &[f64; N], state: &[f64; X]) -> Option<(usize, f64)> {
        let _ = (values, state);
        None
    }
}

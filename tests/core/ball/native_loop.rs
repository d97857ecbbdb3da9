//! The two levitated ball units wired natively, without FMI, as a master in the controller-first order would.

use maglev_fmu::plant::levitated_ball::LevitatedBall;
use maglev_fmu::signal::BallReference;
use maglev_fmu::unit::system::BALL;
use maglev_fmu::unit::{LevitatedBallController, LevitatedBallPlant, Silence, Unit};
use maglev_fmu_test::values::{get, reference, set};

/// Numbers of items of enumerations.
pub const DREM: f64 = 1.0;
pub const POLYNOMIAL_NEWTON: f64 = 2.0;
pub const POLYNOMIAL_NEWTON_ADAPTIVE: f64 = 3.0;
pub const VOLTAGE_OFFSET: f64 = 2.0;
pub const STATE: f64 = 2.0;

/// lam0 [Wb]
pub fn carrying_flux() -> f64 {
    LevitatedBall::LABORATORY.equilibrium_flux()
}

/// Plant and controller after initialisation with some parameters.
pub struct BallLoop {
    pub plant: LevitatedBallPlant,
    pub controller: LevitatedBallController,
    pub signal: BallReference,
    pub sample_time: f64,
    pub ticks: u32,
    /// Added to the voltage that acts [V].
    pub voltage_offset: f64,
    /// Added to the reference [m].
    pub reference_offset: f64,
    wires: Vec<(usize, usize)>,
    voltage: [usize; 2],
    wanted: usize,
}

impl BallLoop {
    /// `offset` is the error of the flux the observer starts with, as a share of lam0.
    pub fn new(
        signal: BallReference,
        offset: f64,
        plant_values: &[(&str, f64)],
        controller_values: &[(&str, f64)],
    ) -> Self {
        let mut plant = LevitatedBallPlant::new();
        let mut controller = LevitatedBallController::new();
        set(&mut controller, "controller.reference_filter", signal.filter_rate());
        set(&mut controller, "observer.initial.flux", (1.0 - offset) * carrying_flux());
        plant_values.iter().for_each(|(name, value)| set(&mut plant, name, *value));
        controller_values.iter().for_each(|(name, value)| set(&mut controller, name, *value));
        plant.initialise(0.0).unwrap();
        controller.initialise(0.0).unwrap();
        let wires =
            BALL.sensing.iter().map(|(from, to)| (reference(&plant, from), reference(&controller, to)));
        Self {
            signal,
            sample_time: get(&controller, "sample_time"),
            ticks: 0,
            voltage_offset: 0.0,
            reference_offset: 0.0,
            wires: wires.collect(),
            voltage: [reference(&controller, "voltage"), reference(&plant, "voltage")],
            wanted: reference(&controller, "reference"),
            plant,
            controller,
        }
    }

    /// The controller ticks, then the plant moves on.
    pub fn step(&mut self) {
        self.step_controller();
        self.pass_voltage();
        self.plant.advance(self.sample_time, &mut Silence).unwrap();
        self.ticks += 1;
    }

    /// Both move on with what the other put out before.
    pub fn step_both_at_once(&mut self) {
        self.step_controller();
        self.plant.advance(self.sample_time, &mut Silence).unwrap();
        self.pass_voltage();
        self.ticks += 1;
    }

    fn step_controller(&mut self) {
        for (from, to) in &self.wires {
            self.controller.values_mut()[*to] = self.plant.values()[*from];
        }
        self.controller.values_mut()[self.wanted] = self.signal.at(self.time()) + self.reference_offset;
        self.controller.advance(self.sample_time, &mut Silence).unwrap();
    }

    fn pass_voltage(&mut self) {
        self.plant.values_mut()[self.voltage[1]] =
            self.controller.values()[self.voltage[0]] + self.voltage_offset;
    }

    pub fn time(&self) -> f64 {
        f64::from(self.ticks) * self.sample_time
    }

    /// Error of the controller's flux at the last tick, as a share of lam0, given the plant's flux then.
    pub fn flux_error(&self, true_flux: f64) -> f64 {
        (get(&self.controller, "estimate.flux") - true_flux) / carrying_flux()
    }

    /// Runs until `until` [s] and sums up what happened from `from` [s] on.
    pub fn run(&mut self, from: f64, until: f64) -> Summary {
        let contact = reference(&self.plant, "contact");
        let [y, lam] = ["position", "flux"].map(|name| reference(&self.plant, name));
        let [wanted, estimate] =
            ["reference.position", "estimate.flux"].map(|name| reference(&self.controller, name));
        let mut summary = Summary::default();
        let (mut squares, mut flux_squares, mut samples) = (0.0, 0.0, 0u32);
        while self.time() < until - 1e-9 {
            let (position, flux) = (self.plant.values()[y], self.plant.values()[lam]);
            let counts = self.time() >= from - 1e-9;
            self.step();
            summary.survived &= self.plant.values()[contact] == 0.0;
            if !summary.survived {
                return summary;
            }
            if counts {
                let error = position - self.controller.values()[wanted];
                let flux_error = (self.controller.values()[estimate] - flux) / carrying_flux();
                squares += error * error;
                flux_squares += flux_error * flux_error;
                samples += 1;
                summary.largest_error = summary.largest_error.max(error.abs());
                summary.largest_flux_error = summary.largest_flux_error.max(flux_error.abs());
            }
        }
        summary.rms_error = (squares / f64::from(samples)).sqrt();
        summary.rms_flux_error = (flux_squares / f64::from(samples)).sqrt();
        summary
    }
}

/// What a run showed from some time on; errors of the position against the filtered reference.
#[derive(Clone, Copy, Debug)]
pub struct Summary {
    /// Whether the ball touched neither stop.
    pub survived: bool,
    /// [m]
    pub rms_error: f64,
    pub largest_error: f64,
    /// Share of lam0.
    pub rms_flux_error: f64,
    pub largest_flux_error: f64,
}

impl Default for Summary {
    fn default() -> Self {
        Self {
            survived: true,
            rms_error: 0.0,
            largest_error: 0.0,
            rms_flux_error: 0.0,
            largest_flux_error: 0.0,
        }
    }
}

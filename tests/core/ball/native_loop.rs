//! The two levitated ball models wired natively, without FMI, as a master in the controller-first order would.

use std::ops::{Deref, DerefMut};

use maglev_fmu::model::system::BALL;
use maglev_fmu::model::{ClosedLoop, NullLogSink};
use maglev_fmu::plant::levitated_ball::LevitatedBall;
use maglev_fmu::study::ball::BallReference;
use maglev_fmu_test::closed_loop::closed_loop;
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

/// The loop on one of the paper's references.
pub struct BallLoop {
    models: ClosedLoop,
    pub signal: BallReference,
    pub ticks: u32,
    /// Added to the voltage that acts [V].
    pub voltage_offset: f64,
    /// Added to the reference [m].
    pub reference_offset: f64,
}

impl Deref for BallLoop {
    type Target = ClosedLoop;

    fn deref(&self) -> &ClosedLoop {
        &self.models
    }
}

impl DerefMut for BallLoop {
    fn deref_mut(&mut self) -> &mut ClosedLoop {
        &mut self.models
    }
}

impl BallLoop {
    /// `offset` is the error of the flux the observer starts with, as a share of lam0.
    pub fn new(
        signal: BallReference,
        offset: f64,
        plant_values: &[(&str, f64)],
        controller_values: &[(&str, f64)],
    ) -> Self {
        let start = [
            ("controller.reference_filter", signal.filter_rate()),
            ("observer.initial.flux", (1.0 - offset) * carrying_flux()),
        ];
        let models = closed_loop(&BALL, plant_values, &[&start, controller_values].concat());
        Self { models, signal, ticks: 0, voltage_offset: 0.0, reference_offset: 0.0 }
    }

    /// The controller ticks, then the plant moves on.
    pub fn step(&mut self) {
        self.tick();
        self.pass_voltage();
        self.move_plant();
    }

    /// Both move on with what the other put out before.
    pub fn step_both_at_once(&mut self) {
        self.tick();
        self.move_plant();
        self.pass_voltage();
    }

    fn tick(&mut self) {
        let wanted = self.signal.at(self.time()) + self.reference_offset;
        set(&mut *self.controller, "reference", wanted);
        self.step_controller().unwrap();
    }

    fn pass_voltage(&mut self) {
        self.actuate();
        let voltage = get(&*self.plant, "voltage") + self.voltage_offset;
        set(&mut *self.plant, "voltage", voltage);
    }

    fn move_plant(&mut self) {
        let duration = self.step_size;
        self.plant.advance(duration, &mut NullLogSink).unwrap();
        self.ticks += 1;
    }

    pub fn time(&self) -> f64 {
        f64::from(self.ticks) * self.step_size
    }

    /// Error of the controller's flux at the last tick, as a share of lam0, given the plant's flux then.
    pub fn flux_error(&self, true_flux: f64) -> f64 {
        (get(&*self.controller, "estimate.flux") - true_flux) / carrying_flux()
    }

    /// Runs until `until` [s] and sums up what happened from `from` [s] on.
    pub fn run(&mut self, from: f64, until: f64) -> Summary {
        let contact = reference(&*self.plant, "contact");
        let [y, lam] = ["position", "flux"].map(|name| reference(&*self.plant, name));
        let [wanted, estimate] =
            ["reference.position", "estimate.flux"].map(|name| reference(&*self.controller, name));
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

//! The loop: everything continuous in one Runge-Kutta scheme of order four, the flux offset once per step.

use nalgebra::{SVector, Vector3};

use super::{
    ball::Motion,
    mechanics::Electrical,
    mixing::{LowPasses, Mixing, Scalar},
    reference::Target,
    regression::{Coefficients, Prefilters, Regression},
    settings::{Feedback, FilterStart, Settings, Voltage},
};

/// Plant 3, chi 1, prefilters 12, low-passes 20, speed and position observer 2, reference filter 3.
type State = SVector<f64, 41>;
const CHI: usize = 3;
const PREFILTERS: usize = 4;
const LOW_PASSES: usize = 16;
const MOMENTUM: usize = 36;
const POSITION: usize = 37;
const REFERENCE: usize = 38;

/// The ball has reached the magnet at this time \[s\].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Collision(pub f64);

/// Everything that can be seen of the loop at an instant, SI units.
#[derive(Clone, Copy, Debug)]
pub struct Row {
    pub time: f64,
    pub target: Target,
    pub motion: Motion,
    pub current: f64,
    pub voltage: f64,
    pub estimate: Motion,
    /// chi \[Wb\]
    pub integral: f64,
    pub coefficients: Coefficients,
    pub scalar: Scalar,
}

#[derive(Clone, Debug)]
pub struct Loop {
    settings: Settings,
    regression: Regression,
    state: State,
    /// theta_hat/lambda_0
    offset_estimate: f64,
    /// Voltage that acts until the next sample if it is held.
    held: Option<f64>,
    steps: u64,
}

impl Loop {
    pub fn new(settings: Settings) -> Self {
        let Settings { ball, start, .. } = settings;
        let regression =
            Regression { poles: settings.prefilter_poles, squared_frequency: ball.squared_frequency() };
        let current = ball.current(start);
        let chi = start.flux - settings.flux_offset * ball.rest_flux();
        let mut state = State::zeros();
        state.fixed_rows_mut::<3>(0).copy_from(&vector(start));
        state[CHI] = chi;
        state[MOMENTUM] = settings.momentum_estimate + settings.mechanics.momentum_shift(&ball, chi, current);
        state[POSITION] = ball.gap - ball.force_constant * current / chi;
        let mut this = Self { settings, regression, state, offset_estimate: 0.0, held: None, steps: 0 };
        if settings.filters == FilterStart::ConstantHistory {
            let (s, current) = this.normalised(&state);
            this.state.fixed_rows_mut::<12>(PREFILTERS).copy_from(&regression.constant_history(s, current));
            this.settle();
        }
        if settings.hold > 0.0 {
            this.settle();
        }
        this.sample();
        this
    }

    pub fn regression(&self) -> &Regression {
        &self.regression
    }

    pub fn prefilters(&self) -> Prefilters {
        self.state.fixed_rows::<12>(PREFILTERS).into()
    }

    pub fn low_passes(&self) -> LowPasses {
        low_passes(&self.state)
    }

    /// c0..c4 now.
    pub fn coefficients(&self) -> Coefficients {
        self.coefficients_of(&self.state)
    }

    /// \[s\]
    pub fn time(&self) -> f64 {
        self.steps as f64 * self.settings.step
    }

    /// One step of the scheme.
    pub fn step(&mut self) -> Result<(), Collision> {
        let (time, step) = (self.time(), self.settings.step);
        let holding = self.holding();
        let scalar = self.scalar(&self.state);
        let k1 = self.derivative(&self.state, time);
        let k2 = self.derivative(&(self.state + step / 2.0 * k1), time + step / 2.0);
        let k3 = self.derivative(&(self.state + step / 2.0 * k2), time + step / 2.0);
        let k4 = self.derivative(&(self.state + step * k3), time + step);
        self.state += step / 6.0 * (k1 + 2.0 * k2 + 2.0 * k3 + k4);
        self.steps += 1;
        if holding {
            self.settle();
        } else {
            self.offset_estimate = Mixing::adapted(self.offset_estimate, self.settings.gain, scalar, step);
        }
        self.sample();
        let collided = motion(&self.state).position >= self.settings.ball.gap;
        if collided { Err(Collision(self.time())) } else { Ok(()) }
    }

    pub fn row(&self) -> Row {
        let (state, time) = (&self.state, self.time());
        let seen = self.electrical(state, time);
        Row {
            time,
            target: self.target(state, time),
            motion: motion(state),
            current: seen.current,
            voltage: seen.voltage,
            estimate: self.estimate(state, seen.current),
            integral: state[CHI],
            coefficients: self.coefficients_of(state),
            scalar: self.scalar(state),
        }
    }

    /// Whether the start-up hold lasts; round-off in the time does not prolong it.
    fn holding(&self) -> bool {
        self.time() < self.settings.hold - 1e-9
    }

    /// Lets the low-passes take the values of their inputs.
    fn settle(&mut self) {
        let settled = Mixing::settled(&self.coefficients());
        self.state.fixed_rows_mut::<20>(LOW_PASSES).copy_from_slice(settled.as_slice());
    }

    /// Samples the law if the voltage is held and its time has come.
    fn sample(&mut self) {
        if let Voltage::Held(count) = self.settings.voltage
            && self.steps.is_multiple_of(count as u64)
        {
            self.held = Some(self.law(&self.state, self.time()));
        }
    }

    /// s = chi/lambda_0 and I of (N).
    fn normalised(&self, state: &State) -> (f64, f64) {
        let ball = &self.settings.ball;
        (state[CHI] / ball.rest_flux(), ball.normalised_current(ball.current(motion(state))))
    }

    fn coefficients_of(&self, state: &State) -> Coefficients {
        let (s, current) = self.normalised(state);
        self.regression.coefficients(&state.fixed_rows::<12>(PREFILTERS).into(), s, current)
    }

    fn scalar(&self, state: &State) -> Scalar {
        self.settings.mixing.scalar(&low_passes(state), &self.coefficients_of(state))
    }

    fn target(&self, state: &State, time: f64) -> Target {
        let reference = &self.settings.reference;
        reference.target(state.fixed_rows::<3>(REFERENCE).into(), reference.raw(time))
    }

    fn estimate(&self, state: &State, current: f64) -> Motion {
        let Settings { ball, mechanics, .. } = &self.settings;
        let flux = state[CHI] + self.offset_estimate * ball.rest_flux();
        Motion {
            flux,
            position: state[POSITION],
            momentum: state[MOMENTUM] - mechanics.momentum_shift(ball, flux, current),
        }
    }

    fn law(&self, state: &State, time: f64) -> f64 {
        let Settings { ball, pole, feedback, .. } = &self.settings;
        let current = ball.current(motion(state));
        let known = match feedback {
            Feedback::State => motion(state),
            Feedback::Estimate => self.estimate(state, current),
        };
        ball.linearising_voltage(known, current, &self.target(state, time), *pole)
    }

    fn electrical(&self, state: &State, time: f64) -> Electrical {
        let current = self.settings.ball.current(motion(state));
        Electrical {
            flux_estimate: self.estimate(state, current).flux,
            current,
            voltage: self.held.unwrap_or_else(|| self.law(state, time)),
        }
    }

    fn derivative(&self, state: &State, time: f64) -> State {
        let Settings { ball, mechanics, mixing, reference, .. } = &self.settings;
        let seen = self.electrical(state, time);
        let estimate = self.estimate(state, seen.current);
        let (s, current) = self.normalised(state);
        let prefilters = self.regression.derivative(&state.fixed_rows::<12>(PREFILTERS).into(), s, current);
        let extension = mixing.derivative(&low_passes(state), &self.coefficients_of(state));
        let filter = reference.derivative(state.fixed_rows::<3>(REFERENCE).into(), reference.raw(time));
        let mut result = State::zeros();
        result.fixed_rows_mut::<3>(0).copy_from(&vector(ball.derivative(motion(state), seen.voltage)));
        result[CHI] = seen.voltage - ball.resistance * seen.current;
        result.fixed_rows_mut::<12>(PREFILTERS).copy_from(&prefilters);
        result.fixed_rows_mut::<20>(LOW_PASSES).copy_from_slice(extension.as_slice());
        result[MOMENTUM] = mechanics.momentum_derivative(ball, &seen, estimate.momentum);
        result[POSITION] = mechanics.position_derivative(ball, &seen, estimate.momentum, estimate.position);
        result.fixed_rows_mut::<3>(REFERENCE).copy_from(&filter);
        result
    }
}

/// Runs the loop for `duration` \[s\]; `look` sees it before each step and at the end.
pub fn run(settings: Settings, duration: f64, mut look: impl FnMut(&Loop)) -> Result<(), Collision> {
    let mut this = Loop::new(settings);
    look(&this);
    for _ in 0..(duration / settings.step).round() as u64 {
        this.step()?;
        look(&this);
    }
    Ok(())
}

/// Rows of a run, `interval` \[s\] apart.
pub fn rows(settings: Settings, duration: f64, interval: f64) -> Result<Vec<Row>, Collision> {
    let every = (interval / settings.step).round() as u64;
    let mut rows = Vec::new();
    run(settings, duration, |this| {
        if this.steps.is_multiple_of(every) {
            rows.push(this.row());
        }
    })?;
    Ok(rows)
}

fn motion(state: &State) -> Motion {
    Motion { flux: state[0], position: state[1], momentum: state[2] }
}

fn vector(motion: Motion) -> Vector3<f64> {
    Vector3::new(motion.flux, motion.position, motion.momentum)
}

fn low_passes(state: &State) -> LowPasses {
    LowPasses::from_column_slice(&state.as_slice()[LOW_PASSES..MOMENTUM])
}

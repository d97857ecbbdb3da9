//! Speed observer (17) and position observer (20) for a given flux estimate.

use super::ball::Ball;

/// Rates of the two observers.
#[derive(Clone, Copy, Debug)]
pub struct Mechanics {
    /// g_p lambda_0^2 \[1/s\]
    pub speed_rate: f64,
    /// g_y lambda_0^2 \[1/s\]
    pub position_rate: f64,
}

/// What both observers see at an instant.
#[derive(Clone, Copy, Debug)]
pub struct Electrical {
    /// lambda_hat \[Wb\]
    pub flux_estimate: f64,
    /// i \[A\]
    pub current: f64,
    /// u \[V\]
    pub voltage: f64,
}

impl Mechanics {
    fn speed_gain(&self, ball: &Ball) -> f64 {
        self.speed_rate / ball.rest_flux().powi(2)
    }

    fn position_gain(&self, ball: &Ball) -> f64 {
        self.position_rate / ball.rest_flux().powi(2)
    }

    /// g_p k m lambda_hat i: by this the state p_I exceeds the estimate p_hat \[kg m/s\].
    pub fn momentum_shift(&self, ball: &Ball, flux_estimate: f64, current: f64) -> f64 {
        self.speed_gain(ball) * ball.force_constant * ball.mass * flux_estimate * current
    }

    /// p_I' \[N\]
    pub fn momentum_derivative(&self, ball: &Ball, seen: &Electrical, momentum_estimate: f64) -> f64 {
        let squared_flux = seen.flux_estimate.powi(2);
        let gain = self.speed_gain(ball);
        let power = (seen.voltage - ball.resistance * seen.current) * seen.current;
        squared_flux / (2.0 * ball.force_constant)
            - ball.mass * ball.gravity
            - gain * squared_flux * momentum_estimate
            + 2.0 * gain * ball.force_constant * ball.mass * power
    }

    /// y_hat' \[m/s\]
    pub fn position_derivative(
        &self,
        ball: &Ball,
        seen: &Electrical,
        momentum_estimate: f64,
        position_estimate: f64,
    ) -> f64 {
        let flux = seen.flux_estimate;
        let surplus =
            flux.powi(2) * (ball.gap - position_estimate) - ball.force_constant * seen.current * flux;
        momentum_estimate / ball.mass + self.position_gain(ball) * surplus
    }
}

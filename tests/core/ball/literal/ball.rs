//! The plant (1) and the feedback linearisation (22).

use super::reference::Target;

/// Parameters of a typical laboratory rig; the paper's own values are not in its text.
#[derive(Clone, Copy, Debug)]
pub struct Ball {
    /// m \[kg\]
    pub mass: f64,
    /// R \[Ohm\]
    pub resistance: f64,
    /// c \[m\]: the gap is c - y
    pub gap: f64,
    /// k \[N m^2/A^2\]: the inductance is k/(c - y)
    pub force_constant: f64,
    /// g \[m/s^2\]
    pub gravity: f64,
}

/// State of the plant.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Motion {
    /// lambda \[Wb\]
    pub flux: f64,
    /// y \[m\], upwards
    pub position: f64,
    /// p \[kg m/s\]
    pub momentum: f64,
}

impl Ball {
    pub const LABORATORY: Self =
        Self { mass: 0.0844, resistance: 2.52, gap: 5e-3, force_constant: 6.4042e-5, gravity: 9.81 };

    /// lambda_0 = sqrt(2 k m g) \[Wb\]: the flux of every equilibrium.
    pub fn rest_flux(&self) -> f64 {
        (2.0 * self.force_constant * self.mass * self.gravity).sqrt()
    }

    /// Equilibrium at `position`.
    pub fn rest(&self, position: f64) -> Motion {
        Motion { flux: self.rest_flux(), position, momentum: 0.0 }
    }

    /// i = (c - y) lambda / k \[A\]
    pub fn current(&self, motion: Motion) -> f64 {
        (self.gap - motion.position) * motion.flux / self.force_constant
    }

    /// W2 = g/c \[1/s^2\] of the normalised equations (N).
    pub fn squared_frequency(&self) -> f64 {
        self.gravity / self.gap
    }

    /// I = k i / (c lambda_0), the normalised current of (N).
    pub fn normalised_current(&self, current: f64) -> f64 {
        self.force_constant * current / (self.gap * self.rest_flux())
    }

    /// Right side of (1): \[Wb/s\], \[m/s\], \[N\].
    pub fn derivative(&self, motion: Motion, voltage: f64) -> Motion {
        Motion {
            flux: voltage - self.resistance * self.current(motion),
            position: motion.momentum / self.mass,
            momentum: motion.flux.powi(2) / (2.0 * self.force_constant) - self.mass * self.gravity,
        }
    }

    /// (22) \[V\] with the poles of (23) all at `-pole` \[1/s\]. `motion` may be true or estimated, the current is
    /// the measured one. In the denominator the flux is at least a fifth of the flux at rest (an assumed guard).
    pub fn linearising_voltage(&self, motion: Motion, current: f64, target: &Target, pole: f64) -> f64 {
        let (a0, a1, a2) = (pole.powi(3), 3.0 * pole.powi(2), 3.0 * pole);
        let acceleration = motion.flux.powi(2) / (2.0 * self.force_constant * self.mass) - self.gravity;
        let jerk = target.jerk
            - a2 * (acceleration - target.acceleration)
            - a1 * (motion.momentum / self.mass - target.velocity)
            - a0 * (motion.position - target.position);
        let denominator = motion.flux.max(0.2 * self.rest_flux());
        self.resistance * current + self.force_constant * self.mass / denominator * jerk
    }
}

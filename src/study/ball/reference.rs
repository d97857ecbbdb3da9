//! The two references of the levitated ball's studies, (24) and (25) of its paper; amplitudes, frequencies and the pattern
//! of the steps are assumed, the available text does not have them.

/// Which reference, before the filter.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum BallReference {
    /// (24): 0.6 mm (sin w t + sin 2.2 w t + sin 3.7 w t), w = 15 rad/s
    Sinusoids,
    /// (25): 0, 1, -1, 0.5 mm for 1 s each, again and again
    Steps,
    /// 0
    Constant,
}

impl BallReference {
    /// r at `time` \[s\] in m.
    pub fn at(self, time: f64) -> f64 {
        match self {
            Self::Sinusoids => {
                let tone = |multiple: f64| libm::sin(15.0 * multiple * time);
                0.6e-3 * (tone(1.0) + tone(2.2) + tone(3.7))
            }
            // A thousandth of a microsecond keeps rounded times on the right side of the edges.
            Self::Steps => match libm::floor(time + 1e-9) as i64 % 4 {
                1 => 1e-3,
                2 => -1e-3,
                3 => 0.5e-3,
                _ => 0.0,
            },
            Self::Constant => 0.0,
        }
    }

    /// Rate of the reference filter \[1/s\].
    pub fn filter_rate(self) -> f64 {
        match self {
            Self::Sinusoids => 80.0,
            Self::Steps | Self::Constant => 60.0,
        }
    }
}

//! What differs from run to run.

use rand_core::Rng;
use rand_pcg::Pcg32;

/// Half widths of uniform distributions, and the sensor.
#[derive(Clone, Copy, Debug)]
pub struct Spread {
    pub name: &'static str,
    /// Shares by which the plant's resistance, inductance constant and mass differ from what the observer believes.
    pub resistance: f64,
    pub inductance_constant: f64,
    pub mass: f64,
    /// Offset of the drive \[V\]
    pub voltage_offset: f64,
    /// Standard deviation of the current sensor \[A\]
    pub noise: f64,
    /// Initial flux offset, share of lam0
    pub flux: f64,
    /// Runs per reference.
    pub runs: u32,
}

impl Spread {
    /// The widths in words.
    pub fn text(&self) -> String {
        let Self { resistance, inductance_constant, mass, voltage_offset, noise, flux, .. } = self;
        let percent = |share: f64| (100.0 * share * 1e6).round() / 1e6;
        let parameters = if *resistance + inductance_constant + mass > 0.0 {
            format!(
                "R {} %, k {} %, m {} %, voltage offset {} mV",
                percent(*resistance),
                percent(*inductance_constant),
                percent(*mass),
                1e3 * voltage_offset
            )
        } else {
            "exact parameters".to_owned()
        };
        format!("{parameters}, noise {} mA, flux offset {} %", 1e3 * noise, percent(*flux))
    }
}

pub const SPREADS: [Spread; 4] = [
    Spread {
        name: "A",
        resistance: 0.01,
        inductance_constant: 0.02,
        mass: 0.01,
        voltage_offset: 5e-3,
        noise: 1e-3,
        flux: 0.1,
        runs: 1000,
    },
    Spread {
        name: "B",
        resistance: 0.03,
        inductance_constant: 0.02,
        mass: 0.01,
        voltage_offset: 10e-3,
        noise: 1e-3,
        flux: 0.1,
        runs: 500,
    },
    Spread { name: "C", noise: 1e-3, flux: 0.15, ..EXACT },
    Spread { name: "D", noise: 1e-5, flux: 0.1, ..EXACT },
];

/// Nothing but the flux is unknown.
const EXACT: Spread = Spread {
    name: "",
    resistance: 0.0,
    inductance_constant: 0.0,
    mass: 0.0,
    voltage_offset: 0.0,
    noise: 0.0,
    flux: 0.0,
    runs: 250,
};

/// One run's draw; the same for every candidate.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Draw {
    pub resistance: f64,
    pub inductance_constant: f64,
    pub mass: f64,
    pub voltage_offset: f64,
    pub noise: f64,
    pub flux: f64,
    pub seed: i32,
}

impl Spread {
    /// The draw of run number `run`, the same on every platform.
    pub fn draw(&self, run: u32) -> Draw {
        let mut generator = Pcg32::new(u64::from(run), 2018);
        let mut uniform = |width: f64| {
            const CELLS: f64 = (1u64 << 53) as f64;
            width * (2.0 * ((generator.next_u64() >> 11) as f64 / CELLS) - 1.0)
        };
        Draw {
            resistance: uniform(self.resistance),
            inductance_constant: uniform(self.inductance_constant),
            mass: uniform(self.mass),
            voltage_offset: uniform(self.voltage_offset),
            noise: self.noise,
            flux: uniform(self.flux),
            seed: run as i32,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn draws_fill_their_widths_and_repeat() {
        let spread = &SPREADS[0];
        let draws: Vec<Draw> = (0..2000).map(|run| spread.draw(run)).collect();
        assert_eq!(spread.draw(7), draws[7]);
        for (value, width) in [
            ((|draw: &Draw| draw.resistance) as fn(&Draw) -> f64, spread.resistance),
            (|draw: &Draw| draw.voltage_offset, spread.voltage_offset),
            (|draw: &Draw| draw.flux, spread.flux),
        ] {
            let mean = draws.iter().map(value).sum::<f64>() / 2000.0;
            let peak = draws.iter().map(|draw| value(draw).abs()).fold(0.0, f64::max);
            // Five standard errors of the mean of a uniform distribution.
            assert!(mean.abs() < 5.0 * width / 3f64.sqrt() / 2000f64.sqrt(), "{mean}");
            assert!(peak <= width && peak > 0.99 * width);
        }
    }
}

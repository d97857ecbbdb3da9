//! Settings of the particle swarm: as the paper prints them, and such that it settles.

/// What happens at the edge of the box.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Walls {
    /// Particles fly on; outside the box they are not evaluated.
    Open,
    /// Positions are clamped to the box, velocities stay.
    Clamping,
    /// Positions are clamped and the coordinate's velocity is lost.
    Absorbing,
}

/// Constants of (14) and the extent of the search.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SwarmSettings {
    pub particles: usize,
    pub iterations: u64,
    pub seed: u64,
    /// w in the first and in the last iteration, linear in between.
    pub inertia: (f64, f64),
    /// c1, towards the particle's own best position.
    pub cognitive: f64,
    /// c2, towards the swarm's best position.
    pub social: f64,
    pub walls: Walls,
    /// Largest velocity per iteration as a share of a coordinate's range; infinite for none.
    pub velocity_limit: f64,
}

impl SwarmSettings {
    /// Table 2 of the paper, w = 1 and c1 = c2 = 1.5, with nothing to hold the particles: velocities grow without
    /// bound (the second moments by 1.22 per iteration), as w = 1 asks c1 = c2 < 0 for stability in the mean square.
    /// Number of particles, iterations and the box are not printed.
    pub const PRINTED: Self = Self {
        particles: 30,
        iterations: 60,
        seed: 1,
        inertia: (1.0, 1.0),
        cognitive: 1.5,
        social: 1.5,
        walls: Walls::Open,
        velocity_limit: f64::INFINITY,
    };

    /// Inertia from 0.9 to 0.4 (Shi and Eberhart 1998), printed c1 and c2, clamped positions, velocities of at most a
    /// fifth of the range.
    pub const FALLING_INERTIA: Self =
        Self { inertia: (0.9, 0.4), walls: Walls::Clamping, velocity_limit: 0.2, ..Self::PRINTED };

    /// Constriction factor of Clerc and Kennedy (2002): w = 0.7298, c1 = c2 = 1.496.
    pub const CONSTRICTION: Self = Self {
        inertia: (0.7298, 0.7298),
        cognitive: 1.496,
        social: 1.496,
        walls: Walls::Clamping,
        ..Self::PRINTED
    };

    /// w of an iteration, counted from 1.
    pub(super) fn inertia_at(&self, iteration: u64) -> f64 {
        let (first, last) = self.inertia;
        let share = (iteration.max(1) - 1) as f64 / (self.iterations.max(2) - 1) as f64;
        first + (last - first) * share
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn inertia_falls_from_first_to_last() {
        let settings = SwarmSettings::FALLING_INERTIA;
        assert_eq!(settings.inertia_at(1), 0.9);
        assert!((settings.inertia_at(60) - 0.4).abs() < 1e-15);
        assert_eq!(SwarmSettings::CONSTRICTION.inertia_at(30), 0.7298);
    }
}

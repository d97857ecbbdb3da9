//! Particle swarm optimisation, (14) of the maglev rig's paper, as a solver of argmin:
//!
//! ```text
//! v <- w v + c1 r1 (p - x) + c2 r2 (g - x)        x <- x + v                                        (14)
//! ```
//!
//! with the particle's own best position p, the swarm's best g, and r1, r2 uniform in 0 to 1, drawn per coordinate.
//! argmin's own `ParticleSwarm` has one inertia for the whole search, always clamps positions and keeps velocities to
//! itself; here the inertia may fall, velocities may be limited, and the box may be left, as the printed settings do.
//! With constant inertia, clamped positions and no limit the two agree bit for bit (see the test).
//!
//! Random numbers are drawn serially and costs are computed in parallel: a seed gives the same search on any number of
//! threads.

use argmin::core::{
    CostFunction, Error, Executor, KV, PopulationState, Problem, Solver, TerminationReason, TerminationStatus,
};
use argmin_math::ArgminRandom;
use rand_xoshiro::Xoshiro256PlusPlus;
use rand_xoshiro::rand_core::SeedableRng;

use super::settings::{SwarmSettings, Walls};

/// Range of one coordinate.
pub type Range = (f64, f64);

/// The swarm after an iteration.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Iteration {
    /// 0 is the swarm as it was initialised.
    pub number: u64,
    pub best_cost: f64,
    /// Root mean square over all particles and coordinates of velocity over range: near 0 once the swarm has settled.
    pub relative_velocity: f64,
}

/// What a search found.
#[derive(Clone, Debug, PartialEq)]
pub struct Optimum {
    pub position: Vec<f64>,
    pub cost: f64,
    pub history: Vec<Iteration>,
    /// Positions that were asked for, those outside the box included.
    pub evaluations: u64,
    /// The search ended before its last iteration, because a diverging swarm had left the floating-point numbers.
    pub has_diverged: bool,
}

/// Searches the box for the smallest cost. Costs that are not numbers count as infinite. `watch` sees every iteration.
pub fn minimise(
    cost: impl Fn(&[f64]) -> f64 + Sync,
    bounds: &[Range],
    settings: &SwarmSettings,
    watch: impl FnMut(&Iteration),
) -> Result<Optimum, Error> {
    let swarm = Swarm {
        settings: *settings,
        bounds,
        random: Xoshiro256PlusPlus::seed_from_u64(settings.seed),
        history: Vec::new(),
        has_diverged: false,
        watch,
    };
    let result = Executor::new(Boxed { cost, bounds }, swarm)
        .configure(|state| state.max_iters(settings.iterations))
        .timer(false)
        .run()?;
    Ok(Optimum {
        position: result.state.individual.map(|particle| particle.best_position).unwrap_or_default(),
        cost: result.state.cost,
        has_diverged: result.solver.has_diverged,
        history: result.solver.history,
        evaluations: result.problem.counts.values().sum(),
    })
}

/// A cost that is infinite outside the box.
struct Boxed<'a, C> {
    cost: C,
    bounds: &'a [Range],
}

impl<C: Fn(&[f64]) -> f64 + Sync> CostFunction for Boxed<'_, C> {
    type Param = Vec<f64>;
    type Output = f64;

    fn cost(&self, position: &Vec<f64>) -> Result<f64, Error> {
        let is_inside =
            self.bounds.iter().zip(position).all(|((low, high), value)| (low..=high).contains(&value));
        let cost = if is_inside { (self.cost)(position) } else { f64::INFINITY };
        Ok(if cost.is_nan() { f64::INFINITY } else { cost })
    }
}

#[derive(Clone)]
struct Particle {
    position: Vec<f64>,
    velocity: Vec<f64>,
    best_position: Vec<f64>,
    best_cost: f64,
}

type State = PopulationState<Particle, f64>;

struct Swarm<'a, W> {
    settings: SwarmSettings,
    bounds: &'a [Range],
    random: Xoshiro256PlusPlus,
    history: Vec<Iteration>,
    /// A particle flew so far that its position is no finite number any more: (14) says nothing about the next one.
    has_diverged: bool,
    watch: W,
}

impl<W: FnMut(&Iteration)> Swarm<'_, W> {
    /// r (to - from) per coordinate.
    fn random_share(&mut self, from: &[f64], to: &[f64]) -> Vec<f64> {
        let way: Vec<f64> = to.iter().zip(from).map(|(to, from)| to - from).collect();
        Vec::rand_from_range(&vec![0.0; way.len()], &way, &mut self.random)
    }

    /// (14), then walls and limit.
    fn fly(&mut self, particle: &mut Particle, swarm_best: &[f64], inertia: f64) {
        let SwarmSettings { cognitive, social, walls, velocity_limit, .. } = self.settings;
        let to_own = self.random_share(&particle.position, &particle.best_position);
        let to_swarm = self.random_share(&particle.position, swarm_best);
        for (coordinate, &(low, high)) in self.bounds.iter().enumerate() {
            let limit = velocity_limit * (high - low);
            let (position, velocity) =
                (&mut particle.position[coordinate], &mut particle.velocity[coordinate]);
            let pulled = *velocity * inertia + to_own[coordinate] * cognitive + to_swarm[coordinate] * social;
            *velocity = pulled.clamp(-limit, limit);
            *position += *velocity;
            if walls != Walls::Open && !(low..=high).contains(position) {
                *position = position.clamp(low, high);
                if walls == Walls::Absorbing {
                    *velocity = 0.0;
                }
            }
        }
    }

    /// Hands the swarm back to the state, its best particle in front, and tells about it.
    fn report(&mut self, state: State, population: Vec<Particle>, best: Particle) -> State {
        let shares = population.iter().flat_map(|particle| {
            let coordinates = particle.velocity.iter().zip(self.bounds);
            coordinates.map(|(velocity, (low, high))| velocity / (high - low))
        });
        let iteration = Iteration {
            number: self.history.len() as u64,
            best_cost: best.best_cost,
            relative_velocity: root_mean_square(shares),
        };
        let mut coordinates = population.iter().flat_map(|particle| &particle.position);
        self.has_diverged = !coordinates.all(|coordinate| coordinate.is_finite());
        self.history.push(iteration);
        (self.watch)(&iteration);
        let cost = best.best_cost;
        state.individual(best).cost(cost).population(population)
    }
}

impl<C, W> Solver<Boxed<'_, C>, State> for Swarm<'_, W>
where
    C: Fn(&[f64]) -> f64 + Sync,
    W: FnMut(&Iteration),
{
    fn name(&self) -> &str {
        "particle swarm"
    }

    /// Particles at rest, uniformly in the box.
    fn init(
        &mut self,
        problem: &mut Problem<Boxed<'_, C>>,
        state: State,
    ) -> Result<(State, Option<KV>), Error> {
        let (low, high): (Vec<f64>, Vec<f64>) = self.bounds.iter().copied().unzip();
        let positions: Vec<Vec<f64>> = (0..self.settings.particles)
            .map(|_| Vec::rand_from_range(&low, &high, &mut self.random))
            .collect();
        let costs = problem.bulk_cost(&positions)?;
        let particle = |(position, best_cost): (Vec<f64>, f64)| Particle {
            velocity: vec![0.0; position.len()],
            best_position: position.clone(),
            position,
            best_cost,
        };
        let mut population: Vec<Particle> = positions.into_iter().zip(costs).map(particle).collect();
        population.sort_by(|a, b| a.best_cost.total_cmp(&b.best_cost));
        let best = population.first().cloned().ok_or_else(|| Error::msg("a swarm needs particles"))?;
        Ok((self.report(state, population, best), None))
    }

    fn next_iter(
        &mut self,
        problem: &mut Problem<Boxed<'_, C>>,
        mut state: State,
    ) -> Result<(State, Option<KV>), Error> {
        let missing = || Error::msg("a swarm must be initialised before it moves");
        let mut best = state.take_individual().ok_or_else(missing)?;
        let mut population = state.take_population().ok_or_else(missing)?;
        let inertia = self.settings.inertia_at(self.history.len() as u64);
        for particle in &mut population {
            self.fly(particle, &best.best_position, inertia);
        }
        let positions: Vec<&Vec<f64>> = population.iter().map(|particle| &particle.position).collect();
        let costs = problem.bulk_cost(&positions)?;
        for (particle, cost) in population.iter_mut().zip(costs) {
            if cost < particle.best_cost {
                particle.best_cost = cost;
                particle.best_position.clone_from(&particle.position);
                if cost < best.best_cost {
                    best.clone_from(particle);
                }
            }
        }
        Ok((self.report(state, population, best), None))
    }

    fn terminate(&mut self, _state: &State) -> TerminationStatus {
        if self.has_diverged {
            TerminationStatus::Terminated(TerminationReason::SolverExit("the swarm has diverged".to_owned()))
        } else {
            TerminationStatus::NotTerminated
        }
    }
}

/// Squares that overflow are taken of the values over the largest.
fn root_mean_square(values: impl Iterator<Item = f64> + Clone) -> f64 {
    let count = values.clone().count() as f64;
    let root = |scale: f64| {
        (values.clone().map(|value| (value / scale) * (value / scale)).sum::<f64>() / count).sqrt()
    };
    let plain = root(1.0);
    if plain.is_finite() {
        return plain;
    }
    let largest = values.clone().map(f64::abs).fold(0.0, f64::max);
    if largest.is_finite() { largest * root(largest) } else { largest }
}

#[cfg(test)]
mod tests;

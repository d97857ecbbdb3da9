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
    /// 0 is the swarm as it was strewn.
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
        let missing = || Error::msg("a swarm must be strewn before it flies");
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
    let root = |scale: f64| (values.clone().map(|value| (value / scale) * (value / scale)).sum::<f64>() / count).sqrt();
    let plain = root(1.0);
    if plain.is_finite() {
        return plain;
    }
    let largest = values.clone().map(f64::abs).fold(0.0, f64::max);
    largest * root(largest)
}

#[cfg(test)]
mod tests {
    use super::*;
    use argmin::solver::particleswarm::{Particle as Reference, ParticleSwarm};

    const BOX: [Range; 3] = [(-2.0, 3.0), (-1.0, 1.0), (0.5, 40.0)];

    /// A valley with a curved floor whose lowest point lies inside the box, on one wall in the third coordinate.
    fn valley(x: &[f64]) -> f64 {
        let across = x[1] - 0.3 * x[0] * x[0];
        (x[0] - 1.2).powi(2) + 20.0 * across * across + (x[2] - 0.5) / 10.0
    }

    #[test]
    fn agrees_bit_for_bit_with_argmin() {
        let settings = SwarmSettings { seed: 7, ..SwarmSettings::CONSTRICTION };
        let own = minimise(valley, &BOX, &settings, |_| ()).unwrap();

        // argmin starts its particles with random velocities, so it gets the population from here.
        let mut random = Xoshiro256PlusPlus::seed_from_u64(settings.seed);
        let (low, high): (Vec<f64>, Vec<f64>) = BOX.iter().copied().unzip();
        let population: Vec<Reference<Vec<f64>, f64>> = (0..settings.particles)
            .map(|_| {
                let position = Vec::rand_from_range(&low, &high, &mut random);
                let cost = valley(&position);
                Reference::new(position, cost, vec![0.0; 3])
            })
            .collect();
        let solver: ParticleSwarm<Vec<f64>, f64, _> = ParticleSwarm::new((low, high), settings.particles)
            .with_rng_generator(random)
            .with_inertia_factor(settings.inertia.0)
            .and_then(|swarm| swarm.with_cognitive_factor(settings.cognitive))
            .and_then(|swarm| swarm.with_social_factor(settings.social))
            .unwrap();
        let reference = Executor::new(Boxed { cost: valley, bounds: &BOX }, solver)
            .configure(|state| state.max_iters(settings.iterations).population(population))
            .run()
            .unwrap();
        assert_eq!(own.cost.to_bits(), reference.state.cost.to_bits());
        assert_eq!(own.position, reference.state.individual.unwrap().position);
        assert_eq!(own.evaluations, 30 * 61);
    }

    #[test]
    fn settles_on_the_optimum() {
        for settings in [
            SwarmSettings::FALLING_INERTIA,
            SwarmSettings::CONSTRICTION,
            SwarmSettings { walls: Walls::Absorbing, ..SwarmSettings::CONSTRICTION },
        ] {
            let mut seen = Vec::new();
            let optimum = minimise(valley, &BOX, &settings, |iteration| seen.push(*iteration)).unwrap();
            assert!(optimum.cost < 1e-3, "{settings:?}: {}", optimum.cost);
            assert_eq!(optimum.position[2], 0.5, "the wall");
            assert_eq!((seen.len(), &seen), (61, &optimum.history));
            assert!(seen.windows(2).all(|pair| pair[1].best_cost <= pair[0].best_cost));
            assert!(seen.last().unwrap().relative_velocity < 0.02);
        }
    }

    #[test]
    fn printed_settings_diverge() {
        // Expected second moments grow by 1.22 per iteration, velocities by its root.
        let optimum = minimise(valley, &BOX, &SwarmSettings::PRINTED, |_| ()).unwrap();
        let velocity = |number: usize| optimum.history[number].relative_velocity;
        assert!(velocity(60) > 10.0 && velocity(60) > 10.0 * velocity(10), "{}", velocity(60));
        assert!(BOX.iter().zip(&optimum.position).all(|((low, high), value)| (low..=high).contains(&value)));
    }

    /// Guards: positions overflow after some 7000 iterations, and no share of an infinite way can be drawn.
    #[test]
    fn a_swarm_that_diverges_ends_with_the_best_so_far() {
        let settings = SwarmSettings { iterations: 14_000, ..SwarmSettings::PRINTED };
        let mut seen = Vec::new();
        let optimum = minimise(valley, &BOX, &settings, |iteration| seen.push(*iteration)).unwrap();
        assert!(optimum.has_diverged && seen == optimum.history);
        let last = optimum.history.len() - 1;
        assert!((1_000..14_000).contains(&last), "{last} iterations");
        assert!(optimum.history[..last].iter().all(|iteration| iteration.relative_velocity.is_finite()));
        // No further iteration, no other result.
        let in_time = SwarmSettings { iterations: last as u64 - 1, ..settings };
        let in_time = minimise(valley, &BOX, &in_time, |_| ()).unwrap();
        assert!(!in_time.has_diverged);
        assert_eq!((in_time.cost, in_time.position), (optimum.cost, optimum.position));
    }

    #[test]
    fn velocities_obey_their_limit() {
        let limit = 0.2;
        let settings = SwarmSettings { velocity_limit: limit, ..SwarmSettings::PRINTED };
        let optimum = minimise(valley, &BOX, &settings, |_| ()).unwrap();
        assert!(optimum.history.iter().all(|iteration| iteration.relative_velocity <= limit));
    }

    #[test]
    fn a_seed_gives_the_same_search_on_any_number_of_threads() {
        let search = |threads: usize| {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
            pool.install(|| minimise(valley, &BOX, &SwarmSettings::FALLING_INERTIA, |_| ()).unwrap())
        };
        assert_eq!(search(1), search(5));
        let other = SwarmSettings { seed: 2, ..SwarmSettings::FALLING_INERTIA };
        assert_ne!(search(1), minimise(valley, &BOX, &other, |_| ()).unwrap());
    }

    #[test]
    fn costs_that_are_no_numbers_are_avoided() {
        let cost = |x: &[f64]| if x[0] < 1.0 { f64::NAN } else { x[0] };
        let optimum = minimise(cost, &BOX[..1], &SwarmSettings::FALLING_INERTIA, |_| ()).unwrap();
        assert!((1.0..1.01).contains(&optimum.cost));
    }
}

//! The swarm on a valley of which the lowest point is known.

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

/// Guards: positions overflow after some ten thousand iterations, and no share of an infinite way can be drawn.
#[test]
fn a_swarm_that_diverges_ends_with_the_best_so_far() {
    let settings = SwarmSettings { iterations: 14_000, ..SwarmSettings::PRINTED };
    let mut seen = Vec::new();
    let optimum = minimise(valley, &BOX, &settings, |iteration| seen.push(*iteration)).unwrap();
    assert!(optimum.has_diverged);
    assert_eq!(seen, optimum.history);
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

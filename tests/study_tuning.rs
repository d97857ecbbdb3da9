use maglev_fmu::study::rig::recording::*;
use maglev_fmu::study::tuning::{candidate::*, settings::*, swarm::*, *};
use std::time::Instant;
#[test]
fn probe() {
    let r = Recording::make(&Conditions::new(Reference::SineAndStep, 2.0));
    println!("{} {}", paper_cost(&TABLE_3, &r), paper_cost(&TABLE_4, &r));
    for space in [SearchSpace::BandwidthAndGain, SearchSpace::EverythingNonlinear] {
        for (n, s) in [
            ("printed", SwarmSettings::PRINTED),
            ("falling", SwarmSettings::FALLING_INERTIA),
            ("constr", SwarmSettings::CONSTRICTION),
        ] {
            for seed in 1..4 {
                let s = SwarmSettings { seed, ..s };
                let t = Instant::now();
                let o = minimise(
                    |p| space.candidate(p).map_or(1e6, |c| paper_cost(&c, &r)),
                    space.bounds(),
                    &s,
                    |_| (),
                )
                .unwrap();
                println!(
                    "{space:?} {n} {seed} {:.1} ms J={} x={:?} v={}",
                    t.elapsed().as_secs_f64() * 1e3,
                    o.cost,
                    &o.position[..2],
                    o.history.last().unwrap().relative_velocity
                );
            }
        }
    }
}

//! Ten seconds of the paper's loop, 10 000 steps of 1 ms, two packaged models in the host: what a study pays per run.

mod measure;

use std::error::Error;
use std::path::Path;

use maglev_fmu::host::{ControlLoop, ExchangeOrder, Fmu, Logging};
use maglev_fmu::package::{FmiVersion, GenerationTime, Library, build};
use measure::{Candidate, medians, verdict};

const STEP_SIZE: f64 = 1e-3;
const STEPS: usize = 10_000;
const ROUNDS: usize = 21;

/// The loop, its models and what is recorded of them.
struct PackagedLoop(ControlLoop);

impl PackagedLoop {
    fn open(directory: &Path, settings: &[(&str, &str)]) -> Result<Self, Box<dyn Error>> {
        let instance = |name: &str| {
            Fmu::open(&directory.join(name).with_extension("fmu"))?.instantiate(name, Logging::Off)
        };
        let mut controller = instance("MagneticBearingController")?;
        for (name, item) in settings {
            controller.set_by_name(name, *item)?;
        }
        let mut models = ControlLoop::connect(
            controller,
            instance("MagneticBearingPlant")?,
            ExchangeOrder::ControllerFirst,
            &[("position_measured", "position"), ("voltage_measured", "voltage_applied")],
            &[("voltage", "voltage")],
        )?;
        models.record(&[
            ("plant", "position"),
            ("controller", "voltage"),
            ("controller", "estimate.flux"),
        ])?;
        models.initialise(0.0, None, STEP_SIZE)?;
        Ok(Self(models))
    }

    /// Goes on for ten seconds, as many times as asked.
    fn run(&mut self) {
        let trace = self.0.run(STEPS).expect("a run");
        assert_eq!(trace.len(), STEPS);
    }
}

fn main() -> Result<(), Box<dyn Error>> {
    let directory = tempfile::tempdir()?;
    build(directory.path(), &[Library::of_this_build()?], GenerationTime::from_epoch_seconds(0))?;
    let kalman = [("observer.kind", "kalman"), ("controller.law", "flux_cascade")];
    let open = |version: FmiVersion, settings: &[(&str, &str)]| {
        PackagedLoop::open(&directory.path().join(version.directory()), settings)
    };
    let mut candidates = Vec::new();
    for (name, version, settings) in [
        ("FMI 2.0, newton", FmiVersion::Two, &[][..]),
        ("FMI 3.0, newton", FmiVersion::Three, &[]),
        ("FMI 2.0, kalman and flux_cascade", FmiVersion::Two, &kalman),
        ("FMI 3.0, kalman and flux_cascade", FmiVersion::Three, &kalman),
    ] {
        let mut models = open(version, settings)?;
        candidates.push(Candidate { name, operations: 1, run: Box::new(move || models.run()) });
    }
    let medians = medians(&mut candidates, ROUNDS);
    println!(
        "10 s of the loop, 10 000 steps, two packaged models in the host, three signals recorded, medians"
    );
    for (candidate, median) in candidates.iter().zip(medians) {
        verdict(candidate.name, median * 1e-6, "ms", Some(10.0), None);
    }
    Ok(())
}

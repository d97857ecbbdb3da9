//! `maglev-fmu tune`

use std::error::Error;
use std::path::PathBuf;

use clap::builder::{PathBufValueParser, TypedValueParser};
use clap::{Args, ValueEnum};
use indicatif::{ProgressBar, ProgressStyle};
use maglev_fmu::host::Value;
use maglev_fmu::model::system::RIG;
use maglev_fmu::parameter_file::ParameterFile;
use maglev_fmu::study::output;
use maglev_fmu::study::report::quantity;
use maglev_fmu::study::tuning::candidate::ObserverKind;
use maglev_fmu::study::tuning::settings::SwarmSettings;
use maglev_fmu::study::tuning::{Objective, Tuned, convergence, noise_aware, tune};
use serde_json::json;

use super::output::{report, say, with_room_beside};

/// Tune an observer of the maglev rig by particle swarm and write a parameter file
///
/// The file is for `build --parameters`, for the scripts' option --parameters, and its "values" are start values for
/// fmpy. A picture of the search is put beside it. The same seed gives the same result on any number of cores.
#[derive(Debug, Args)]
pub struct Tune {
    /// Observer to tune
    #[arg(long, value_enum, default_value_t = Observer::Linear)]
    observer: Observer,
    /// Objective to minimise: (15) of the paper, or the velocity error over noises, masses and references
    #[arg(long, value_enum, default_value_t = Goal::Paper)]
    objective: Goal,
    /// Standard deviation of the sensor in V, for noise-aware; may be repeated [default: 0.0001 0.0003 0.001 0.003]
    #[arg(long, value_name = "V", value_parser = noise)]
    noise: Vec<f64>,
    /// How the particles move
    #[arg(long, value_enum, default_value_t = Swarm::FallingInertia)]
    swarm: Swarm,
    #[arg(long, value_name = "N", default_value_t = 30, value_parser = clap::value_parser!(u32).range(2..=100_000))]
    particles: u32,
    #[arg(long, value_name = "N", default_value_t = 60, value_parser = clap::value_parser!(u64).range(1..=1_000_000))]
    iterations: u64,
    #[arg(long, value_name = "N", default_value_t = 1)]
    seed: u64,
    /// Parameter file to write [default: results/rig-OBSERVER-OBJECTIVE.json]
    #[arg(long, value_name = "FILE", value_parser = PathBufValueParser::new().try_map(parameter_file))]
    out: Option<PathBuf>,
}

#[derive(Clone, Copy, Debug, ValueEnum)]
enum Observer {
    /// LESO: bandwidth and input gain
    Linear,
    /// NESO: gains, input gain, exponents and linear zones
    Nonlinear,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum Goal {
    /// (15): rms errors and overshoots of position and velocity, in metres, from zero estimates, without noise
    Paper,
    /// Geometric mean of the velocity errors, in sensor volts, from steady estimates
    NoiseAware,
}

#[derive(Clone, Copy, Debug, ValueEnum)]
enum Swarm {
    /// Inertia from 0.9 to 0.4, positions clamped, velocities limited to a fifth of the range
    FallingInertia,
    /// Inertia 0.7298 and c1 = c2 = 1.496 after Clerc and Kennedy, positions clamped
    Constriction,
    /// Inertia 1 and c1 = c2 = 1.5 as in the paper's Table 2, nothing clamped: diverges
    Printed,
}

/// A file that the files put beside it, which have the same name but for the ending, do not overwrite.
fn parameter_file(path: PathBuf) -> Result<PathBuf, String> {
    let beside = output::FIGURE_ENDINGS;
    match path
        .extension()
        .and_then(|ending| beside.into_iter().find(|taken| ending.eq_ignore_ascii_case(taken)))
    {
        Some(taken) => {
            Err(format!("the picture's files have the ending .{taken}: expected another one, such as .json"))
        }
        None => with_room_beside(path),
    }
}

fn noise(text: &str) -> Result<f64, String> {
    let value: f64 = text.parse().map_err(|_| "expected a number of V".to_owned())?;
    if (0.0..=1.0).contains(&value) { Ok(value) } else { Err("expected 0 to 1 V".to_owned()) }
}

/// What an option's value is called on the command line.
fn name(choice: &impl ValueEnum) -> String {
    choice.to_possible_value().map_or_else(String::new, |value| value.get_name().to_owned())
}

impl Tune {
    pub fn run(&self) -> Result<(), Box<dyn Error>> {
        if self.objective == Goal::Paper && !self.noise.is_empty() {
            return Err("--noise is for --objective noise-aware: the paper's objective knows no noise".into());
        }
        let noises = if self.noise.is_empty() { &noise_aware::NOISES[..] } else { &self.noise };
        let objective = match self.objective {
            Goal::Paper => Objective::paper(),
            Goal::NoiseAware => Objective::noise_aware(noises),
        };
        let settings = self.settings();
        let bar = ProgressBar::new(settings.iterations);
        bar.set_style(ProgressStyle::with_template(
            "{bar:40} {pos:>4} of {len} iterations, {eta} left, {msg}",
        )?);
        let observer = match self.observer {
            Observer::Linear => ObserverKind::Linear,
            Observer::Nonlinear => ObserverKind::Nonlinear,
        };
        let tuned = tune(observer, &objective, &settings, |iteration| {
            bar.set_position(iteration.number);
            bar.set_message(format!("best {}", quantity(iteration.best_cost, "1")));
        })?;
        bar.finish_and_clear();
        self.write(&objective, noises, &settings, &tuned)
    }

    fn settings(&self) -> SwarmSettings {
        let settings = match self.swarm {
            Swarm::FallingInertia => SwarmSettings::FALLING_INERTIA,
            Swarm::Constriction => SwarmSettings::CONSTRICTION,
            Swarm::Printed => SwarmSettings::PRINTED,
        };
        let particles = self.particles as usize;
        SwarmSettings { particles, iterations: self.iterations, seed: self.seed, ..settings }
    }

    fn write(
        &self,
        objective: &Objective,
        noises: &[f64],
        settings: &SwarmSettings,
        tuned: &Tuned,
    ) -> Result<(), Box<dyn Error>> {
        let title = format!("rig-{}-{}", name(&self.observer), name(&self.objective));
        let path =
            self.out.clone().unwrap_or_else(|| PathBuf::from("results").join(&title).with_extension("json"));
        // Fewer than asked for if the swarm has diverged; the first of the history is the swarm as it was initialised.
        let iterations = tuned.optimum.history.len().saturating_sub(1);
        let mut provenance = json!({
            "program": concat!("maglev-fmu ", env!("CARGO_PKG_VERSION")),
            "observer": name(&self.observer),
            "objective": name(&self.objective),
            "cost": tuned.optimum.cost,
            "cost of the printed parameters": tuned.printed_cost,
            "swarm": name(&self.swarm),
            "particles": settings.particles,
            "iterations": iterations,
            "evaluations": tuned.optimum.evaluations,
            "seed": settings.seed,
        });
        if self.objective == Goal::NoiseAware {
            provenance["noise in V"] = json!(noises);
        }
        let values = tuned.parameters.iter().map(|(name, value)| (*name, json(value)));
        let file = ParameterFile::new(RIG.controller.description, values, provenance)?;
        let directory = path.parent().unwrap_or("".as_ref());
        let stem = path.file_stem().map_or(title.clone(), |stem| stem.to_string_lossy().into_owned());
        let searches = [(name(&self.swarm), tuned.optimum.history.as_slice())];
        let figure = convergence(
            &stem,
            format!("Search for {title}"),
            objective.name(),
            &searches,
            Some(tuned.printed_cost),
        );
        // The result first: it is what has taken the time.
        output::make_directory(directory)?;
        let written = file.write(&path)?;
        output::write_figure(directory, &figure)?;

        if tuned.optimum.has_diverged {
            say(format_args!(
                "The swarm has diverged: after {iterations} of {} iterations its positions are no longer finite. What \
                 follows is the best result found before.",
                settings.iterations
            ))?;
        }
        say(format_args!(
            "{}: {}, printed parameters {}",
            objective.name(),
            quantity(tuned.optimum.cost, "1"),
            quantity(tuned.printed_cost, "1")
        ))?;
        for (name, value) in &file.values {
            let unit = file.units.get(name).and_then(|unit| unit.as_str()).unwrap_or_default();
            say(format_args!("  {name} = {value} ({unit})"))?;
        }
        report(&written)?;
        Ok(say(format_args!("           {}", directory.join(&stem).with_extension("png").display()))?)
    }
}

fn json(value: &Value<'_>) -> serde_json::Value {
    match *value {
        Value::Real(number) => json!(number),
        Value::Integer(number) => json!(number),
        Value::Boolean(flag) => json!(flag),
        Value::Text(text) => json!(text),
    }
}

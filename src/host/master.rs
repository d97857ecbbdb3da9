//! The master of a control loop: one controller, one plant.

use super::error::{HostError, Result};
use super::instance::Instance;
use super::route::Route;
use super::trace::{Probe, Trace};
use maglev_models::ExchangeOrder;

/// A controller and a plant that step together at the communication points `start + k * step_size`.
///
/// With [`ExchangeOrder::ControllerFirst`], at `t_k`: plant outputs to controller inputs, controller steps,
/// controller outputs to plant inputs, *row is recorded*, plant steps. A row holds the plant's outputs at `t_k` and
/// the command computed from them.
///
/// With [`ExchangeOrder::Parallel`], at `t_k`: *row is recorded*, both step, all values are exchanged. A row holds
/// all outputs at `t_k`, the controller's being computed from the plant's outputs at `t_(k-1)`.
///
/// In both orders the values are exchanged once at the end of the initialisation. The values after the last step
/// are read from the instances.
#[derive(Debug)]
pub struct ControlLoop {
    controller: Instance,
    plant: Instance,
    order: ExchangeOrder,
    to_controller: Route,
    to_plant: Route,
    controller_probe: Probe,
    plant_probe: Probe,
    names: Vec<String>,
    units: Vec<Option<String>>,
    clock: Option<Clock>,
}

/// Communication points from an integer, so that rounding errors do not add up.
#[derive(Clone, Copy, Debug)]
struct Clock {
    start_time: f64,
    step_size: f64,
    tick: u64,
}

impl Clock {
    fn time(self) -> f64 {
        self.start_time + self.tick as f64 * self.step_size
    }
}

impl ControlLoop {
    /// Connects two instances, each connection being `(output name, input name)`.
    ///
    /// # Errors
    /// [`HostError::UnknownVariable`] or [`HostError::Array`].
    pub fn connect(
        controller: Instance,
        plant: Instance,
        order: ExchangeOrder,
        plant_to_controller: &[(&str, &str)],
        controller_to_plant: &[(&str, &str)],
    ) -> Result<Self> {
        Ok(Self {
            to_controller: Route::resolve(&plant, &controller, plant_to_controller)?,
            to_plant: Route::resolve(&controller, &plant, controller_to_plant)?,
            controller,
            plant,
            order,
            controller_probe: Probe::default(),
            plant_probe: Probe::default(),
            names: Vec::new(),
            units: Vec::new(),
            clock: None,
        })
    }

    /// Adds variables to the record, as `("plant", "position")` or `("controller", "voltage")`.
    ///
    /// # Errors
    /// [`HostError::UnknownModel`] for other first names, [`HostError::UnknownVariable`] or [`HostError::Array`].
    pub fn record(&mut self, variables: &[(&str, &str)]) -> Result<()> {
        for &(model, variable) in variables {
            let (instance, probe) = match model {
                "controller" => (&self.controller, &mut self.controller_probe),
                "plant" => (&self.plant, &mut self.plant_probe),
                _ => {
                    return Err(HostError::UnknownModel {
                        model: model.to_owned(),
                        variable: variable.to_owned(),
                    });
                }
            };
            probe.add(instance, variable, self.names.len())?;
            self.names.push(format!("{model}.{variable}"));
            self.units.push(instance.description().variable(variable)?.unit.as_deref().map(str::to_owned));
        }
        Ok(())
    }

    /// Lets the wire to this input of the plant add `offset`, in the variable's unit: a drive whose zero is off.
    ///
    /// # Errors
    /// Those of [`Instance::variable`], and [`HostError::NoWire`] if none with reals leads there.
    pub fn add_offset(&mut self, input: &str, offset: f64) -> Result<()> {
        let target = self.plant.variable(input)?.value_reference();
        if self.to_plant.add_offset(target, offset) {
            Ok(())
        } else {
            Err(HostError::NoWire { model: self.plant.name().to_owned(), variable: input.to_owned() })
        }
    }

    /// Initialises both models at `start_time`, exchanges all values once, and fixes the step size (all in seconds).
    ///
    /// # Errors
    /// [`HostError::StepSize`], and [`HostError::Call`] of either model.
    pub fn initialise(&mut self, start_time: f64, stop_time: Option<f64>, step_size: f64) -> Result<()> {
        if !(step_size.is_finite() && step_size > 0.0) {
            return Err(HostError::StepSize { step_size });
        }
        self.plant.initialise(start_time, stop_time)?;
        self.controller.initialise(start_time, stop_time)?;
        self.exchange()?;
        self.clock = Some(Clock { start_time, step_size, tick: 0 });
        Ok(())
    }

    /// Goes on for `steps` steps and returns what was recorded, one row per step.
    ///
    /// # Errors
    /// [`HostError::LoopNotInitialised`], [`HostError::Call`] and [`HostError::TerminationRequested`].
    pub fn run(&mut self, steps: usize) -> Result<Trace> {
        self.run_with(steps, |_, _, _| Ok(()))
    }

    /// As [`ControlLoop::run`], with an `intervention(time, controller, plant)` at the beginning of every
    /// communication point: the place to change a reference or a load.
    ///
    /// # Errors
    /// Those of [`ControlLoop::run`] and of the intervention.
    pub fn run_with(
        &mut self,
        steps: usize,
        intervention: impl FnMut(f64, &mut Instance, &mut Instance) -> Result<()>,
    ) -> Result<Trace> {
        let mut trace = self.empty_trace();
        self.run_into(&mut trace, steps, intervention)?;
        Ok(trace)
    }

    /// As [`ControlLoop::run_with`], appending to a trace made by [`ControlLoop::empty_trace`] or an earlier run.
    /// After an error the trace holds the complete rows up to it.
    ///
    /// # Errors
    /// Those of [`ControlLoop::run`] and of the intervention, and [`HostError::ForeignTrace`] if the trace has other
    /// columns than this loop records.
    pub fn run_into(
        &mut self,
        trace: &mut Trace,
        steps: usize,
        mut intervention: impl FnMut(f64, &mut Instance, &mut Instance) -> Result<()>,
    ) -> Result<()> {
        if trace.names != self.names || trace.columns.len() != self.names.len() {
            return Err(HostError::ForeignTrace {
                trace: trace.names.join(", "),
                recorded: self.names.join(", "),
            });
        }
        let Some(mut clock) = self.clock else {
            return Err(HostError::LoopNotInitialised {
                controller: self.controller.name().to_owned(),
                plant: self.plant.name().to_owned(),
            });
        };
        trace.reserve(steps);
        for _ in 0..steps {
            let time = clock.time();
            intervention(time, &mut self.controller, &mut self.plant)?;
            match self.order {
                ExchangeOrder::ControllerFirst => {
                    self.to_controller.read(&self.plant)?;
                    self.to_controller.write(&mut self.controller)?;
                    self.controller.step(time, clock.step_size)?;
                    self.to_plant.read(&self.controller)?;
                    self.to_plant.write(&mut self.plant)?;
                    self.sample(time, trace)?;
                    self.plant.step(time, clock.step_size)?;
                }
                ExchangeOrder::Parallel => {
                    self.sample(time, trace)?;
                    self.controller.step(time, clock.step_size)?;
                    self.plant.step(time, clock.step_size)?;
                    self.exchange()?;
                }
            }
            clock.tick += 1;
            self.clock = Some(clock);
        }
        Ok(())
    }

    /// A trace with the columns of the record and no rows.
    pub fn empty_trace(&self) -> Trace {
        Trace {
            names: self.names.clone(),
            units: self.units.clone(),
            time: Vec::new(),
            columns: vec![Vec::new(); self.names.len()],
        }
    }

    /// The next communication point in seconds, `None` before the initialisation.
    pub fn time(&self) -> Option<f64> {
        self.clock.map(Clock::time)
    }

    pub fn controller(&self) -> &Instance {
        &self.controller
    }

    pub fn controller_mut(&mut self) -> &mut Instance {
        &mut self.controller
    }

    pub fn plant(&self) -> &Instance {
        &self.plant
    }

    pub fn plant_mut(&mut self) -> &mut Instance {
        &mut self.plant
    }

    /// Gives the two instances back, the controller first.
    pub fn into_instances(self) -> (Instance, Instance) {
        (self.controller, self.plant)
    }

    /// All values, read before any is written: what one model gets does not depend on what the other got.
    #[inline]
    fn exchange(&mut self) -> Result<()> {
        self.to_controller.read(&self.plant)?;
        self.to_plant.read(&self.controller)?;
        self.to_controller.write(&mut self.controller)?;
        self.to_plant.write(&mut self.plant)
    }

    /// Appends a row; a row that fails half way is taken back.
    #[inline]
    fn sample(&mut self, time: f64, trace: &mut Trace) -> Result<()> {
        let sampled = self
            .controller_probe
            .sample(&self.controller, &mut trace.columns)
            .and_then(|()| self.plant_probe.sample(&self.plant, &mut trace.columns));
        match sampled {
            Ok(()) => trace.time.push(time),
            Err(_) => trace.columns.iter_mut().for_each(|column| column.truncate(trace.time.len())),
        }
        sampled
    }
}

//! Plant and controller of a system, wired natively, without FMI: what a master of the packaged models has to reproduce.

use super::system::{System, Wire};
use super::{Model, ModelError, NullLogSink};
use crate::exchange_order::ExchangeOrder;

/// Two models that step together.
pub struct ClosedLoop {
    pub plant: Box<dyn Model>,
    pub controller: Box<dyn Model>,
    /// Time that each step takes \[s\].
    pub step_size: f64,
    order: ExchangeOrder,
    sensing: Vec<Connection>,
    actuation: Vec<Connection>,
}

/// Value references of an output and of the input that takes it.
type Connection = (usize, usize);

impl ClosedLoop {
    /// Models as their tables say, to be started.
    pub fn of(system: &System, order: ExchangeOrder) -> Self {
        let is_sensing = |wire: &Wire| core::ptr::eq(wire.source, system.plant.description);
        let (sensing, actuation): (Vec<Wire>, Vec<Wire>) = system.wires().partition(is_sensing);
        let connect = |wires: Vec<Wire>| wires.iter().map(Wire::references).collect();
        Self {
            plant: (system.plant.create)(),
            controller: (system.controller.create)(),
            step_size: system.step_size(),
            order,
            sensing: connect(sensing),
            actuation: connect(actuation),
        }
    }

    /// Whether a model would refuse the step for its length; of two refusals that with the smaller limit.
    ///
    /// # Errors
    /// Those of [`Model::check_step`].
    pub fn check_step(&self) -> Result<(), ModelError> {
        let refusals = [&self.plant, &self.controller].map(|model| model.check_step(self.step_size).err());
        let limit = |refusal: &ModelError| refusal.longest_step().unwrap_or(0.0);
        let refusal = refusals.into_iter().flatten().min_by(|one, other| limit(one).total_cmp(&limit(other)));
        refusal.map_or(Ok(()), Err)
    }

    /// Begins at `start_time` \[s\]. Nothing is exchanged.
    ///
    /// # Errors
    /// Those of [`Model::start`].
    pub fn start(&mut self, start_time: f64) -> Result<(), ModelError> {
        self.plant.start(start_time)?;
        self.controller.start(start_time)
    }

    /// The controller's inputs become what the plant puts out.
    pub fn sense(&mut self) {
        pass(&self.sensing, &*self.plant, &mut *self.controller);
    }

    /// The plant's inputs become what the controller puts out.
    pub fn actuate(&mut self) {
        pass(&self.actuation, &*self.controller, &mut *self.plant);
    }

    /// First half of a step with the controller first: it reads the plant and moves on.
    ///
    /// # Errors
    /// Those of [`Model::advance`].
    pub fn step_controller(&mut self) -> Result<(), ModelError> {
        self.sense();
        self.controller.advance(self.step_size, &mut NullLogSink)
    }

    /// Second half: the plant takes what the controller has computed and moves on.
    ///
    /// # Errors
    /// Those of [`Model::advance`].
    pub fn step_plant(&mut self) -> Result<(), ModelError> {
        self.actuate();
        self.plant.advance(self.step_size, &mut NullLogSink)
    }

    /// A step in the order of the loop.
    ///
    /// # Errors
    /// Those of [`Model::advance`].
    pub fn step(&mut self) -> Result<(), ModelError> {
        match self.order {
            ExchangeOrder::ControllerFirst => {
                self.step_controller()?;
                self.step_plant()
            }
            ExchangeOrder::Parallel => {
                self.plant.advance(self.step_size, &mut NullLogSink)?;
                self.controller.advance(self.step_size, &mut NullLogSink)?;
                self.sense();
                self.actuate();
                Ok(())
            }
        }
    }
}

fn pass(connections: &[Connection], source: &dyn Model, target: &mut dyn Model) {
    for &(output, input) in connections {
        target.values_mut()[input] = source.values()[output];
    }
}

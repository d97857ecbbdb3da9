//! When values travel between the two models of a loop.

/// In which order values travel between the two models of a loop.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ExchangeOrder {
    /// As on a rig with a fast processor: the plant is sampled, the controller computes, the plant moves on with the
    /// new command.
    ControllerFirst,
    /// As most masters do: both step, then all values are exchanged. The command arrives one step late.
    Parallel,
}

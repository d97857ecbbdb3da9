//! Choices that several controllers offer.

use super::choice::choice;

choice! {
    /// Which voltage an observer is told.
    pub enum VoltageSource = "VoltageSource", "Voltage that the observer takes as applied over the last sample" {
        Command = "command", "The voltage this controller put out";
        Applied = "applied", "The input voltage_applied, right in every exchange order";
    }
}

choice! {
    /// What a law is fed with besides the measured position.
    pub enum Feedback = "Feedback", "Source of the law's state feedback besides the measured position" {
        Estimate = "estimate", "The observer's estimate";
        State = "state", "The inputs state.*, for comparison";
    }
}

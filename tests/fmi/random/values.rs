//! Values for variables: usual ones, declared limits and what lies beyond, and numbers that calculations trip over.

use super::super::standard::{Kind, Variable};
use super::dice::Dice;

pub fn of(variable: &Variable, dice: &mut Dice, is_tame: bool) -> f64 {
    let (smallest, largest) = variable.range;
    match variable.kind {
        Kind::Boolean => dice.below(2) as f64,
        Kind::Clock => 1.0,
        Kind::Enumeration => match dice.below(20) {
            0 => dice.pick(&[0.0, largest + 1.0, -1.0, 2_147_483_647.0, 9e18]),
            _ => (1 + dice.below(largest as usize)) as f64,
        },
        Kind::Integer => match dice.below(20) {
            0 => dice
                .pick(&[smallest - 1.0, largest + 1.0, -2_147_483_648.0, 2_147_483_647.0])
                .max(-2_147_483_648.0),
            1..=2 => smallest,
            3..=4 => largest,
            _ => near_start(variable, dice).round().clamp(smallest, largest),
        },
        Kind::Real => real(variable, dice, is_tame),
    }
}

/// The smallest or the largest value.
pub fn limit(variable: &Variable, dice: &mut Dice) -> f64 {
    let (smallest, largest) = variable.range;
    match variable.kind {
        Kind::Boolean => dice.below(2) as f64,
        _ if dice.percent(50) => smallest,
        _ => largest,
    }
}

fn real(variable: &Variable, dice: &mut Dice, is_tame: bool) -> f64 {
    let (smallest, largest) = variable.range;
    let chance = if is_tame { dice.below(60) } else { dice.below(100) };
    match chance {
        0..=39 => near_start(variable, dice),
        40..=53 => dice.between(-1.0, 1.0) * if dice.percent(50) { 1e-2 } else { 1.0 },
        54 => dice.odd(),
        55 => dice.wild(),
        56..=57 => near_start(variable, dice),
        58 => smallest.next_down(),
        59 => largest.next_up(),
        60..=73 => smallest,
        74..=87 => largest,
        88..=92 => dice.odd(),
        93..=96 => dice.wild(),
        _ => dice.between(smallest.max(-1e300), largest.min(1e300)),
    }
}

fn near_start(variable: &Variable, dice: &mut Dice) -> f64 {
    let start = variable.start.unwrap_or_default();
    if start == 0.0 { dice.between(-1e-3, 1e-3) } else { start * dice.between(0.5, 1.5) }
}

/// Of an input, per second.
pub fn slope(dice: &mut Dice) -> f64 {
    match dice.below(10) {
        0 => dice.odd(),
        1 => dice.wild(),
        _ => dice.between(-10.0, 10.0),
    }
}

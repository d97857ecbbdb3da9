//! Numbers that an equation is computed with: an equation that is written once, generic over [`Scalar`], gives
//!
//! - values with `f64`,
//! - derivatives with [`Dual`],
//! - with `Traced` what a result depends on, and how.

mod dual;
mod real;
mod traced;

pub use dual::Dual;
pub use real::Scalar;
pub use traced::{DependencyKind, MOST_VARIABLES, Traced, Variation};

//! License texts that travel with every package.

/// License of this project.
pub const LICENSE: &str = include_str!("../../LICENSE");
/// Crates that are linked into the shared library, with their licenses.
pub const THIRD_PARTY: &str = include_str!("../../assets/licenses/THIRD-PARTY.txt");

/// Short name of the project's license.
pub const NAME: &str = env!("CARGO_PKG_LICENSE");
pub const COPYRIGHT: &str = "Copyright (c) 2026 The maglev-fmu authors";

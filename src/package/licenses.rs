//! License texts that travel with every package.

/// License of this project.
pub const LICENSE: &str = include_str!("../../LICENSE");
/// Crates that are linked into the shared library.
pub const THIRD_PARTY: &str = include_str!("../../assets/licenses/THIRD-PARTY.txt");
/// License of some of them, which asks to be passed on.
pub const APACHE_2_0: &str = include_str!("../../assets/licenses/Apache-2.0.txt");

/// Short name of the project's license.
pub const NAME: &str = env!("CARGO_PKG_LICENSE");
pub const COPYRIGHT: &str = "Copyright (c) 2026 The maglev-fmu authors";

//! What a foreign file may take of this machine.

/// How large an FMU may be before the host refuses it; the default suits nearly every FMU.
///
/// ```no_run
/// use maglev_fmu::host::{Fmu, Limits};
///
/// let limits = Limits { total_bytes: 8 << 30, entry_bytes: 4 << 30, ..Limits::default() };
/// let fmu = Fmu::open_within("WithManyTables.fmu".as_ref(), &limits)?;
/// # Ok::<(), maglev_fmu::host::HostError>(())
/// ```
///
/// Sizes are counted while they are unpacked, whatever the archive says about itself. There is no limit on the ratio of
/// compression: honest tables compress by a thousand, and what matters is how much is written.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Limits {
    /// Files and directories, in the archive and unpacked: also those that stand in the path of another entry only.
    pub entries: usize,
    /// Names in the path of an entry, as many as directories lie within one another. One that is deleted with all that is in
    /// it takes a file descriptor for each.
    pub levels: usize,
    /// One file, unpacked.
    pub entry_bytes: u64,
    /// All files, unpacked, and the archive itself.
    pub total_bytes: u64,
    /// `modelDescription.xml`.
    pub description_bytes: u64,
    /// XML elements in `modelDescription.xml`, a few per variable: each takes memory, up to some hundred bytes.
    pub description_elements: usize,
}

impl Default for Limits {
    /// 10 000 entries, 64 levels deep at most, 256 MiB each and 512 MiB together; a description of 64 MiB and 1 000 000 elements.
    fn default() -> Self {
        Self {
            entries: 10_000,
            levels: 64,
            entry_bytes: 256 << 20,
            total_bytes: 512 << 20,
            description_bytes: 64 << 20,
            description_elements: 1_000_000,
        }
    }
}

impl Limits {
    /// What the list of entries at the end of an archive may take: long names and a few extra fields for each.
    pub(super) fn directory_bytes(&self) -> u64 {
        (1 << 20) + 512 * self.entries as u64
    }
}

//! When a package was made, from sources that do not change from one build to the next.

use std::fmt;

use super::PackageError;

/// A time in UTC, shown as `YYYY-MM-DDThh:mm:ssZ`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct GenerationTime {
    /// Since 1970-01-01T00:00:00Z \[s\]; reaches to February 2106.
    seconds: u32,
}

/// Date and time of day in the Gregorian calendar.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct CivilTime {
    pub year: u16,
    pub month: u8,
    pub day: u8,
    pub hour: u8,
    pub minute: u8,
    pub second: u8,
}

impl GenerationTime {
    pub const fn from_epoch_seconds(seconds: u32) -> Self {
        Self { seconds }
    }

    /// The environment's `SOURCE_DATE_EPOCH` if it is set, else the time of the commit this program was built from.
    pub fn of_this_build() -> Result<Self, PackageError> {
        let value = match std::env::var_os("SOURCE_DATE_EPOCH") {
            Some(value) => value.to_string_lossy().into_owned(),
            None => env!("MAGLEV_FMU_COMMIT_TIME").to_owned(),
        };
        let seconds = value.parse().map_err(|_| PackageError::SourceDateEpoch { value })?;
        Ok(Self { seconds })
    }

    /// Howard Hinnant, chrono-compatible low-level date algorithms, `civil_from_days`: years begin in March, so that
    /// the leap day is the last of its year; eras are the 400 years after which the calendar repeats.
    pub(super) fn civil(self) -> CivilTime {
        let day_number = self.seconds / 86_400 + 719_468;
        let (era, day_of_era) = (day_number / 146_097, day_number % 146_097);
        let year_of_era =
            (day_of_era - day_of_era / 1_460 + day_of_era / 36_524 - day_of_era / 146_096) / 365;
        let day_of_year = day_of_era - (365 * year_of_era + year_of_era / 4 - year_of_era / 100);
        let month_from_march = (5 * day_of_year + 2) / 153;
        let month = if month_from_march < 10 { month_from_march + 3 } else { month_from_march - 9 };
        let second_of_day = self.seconds % 86_400;
        CivilTime {
            year: (era * 400 + year_of_era + u32::from(month <= 2)) as u16,
            month: month as u8,
            day: (day_of_year - (153 * month_from_march + 2) / 5 + 1) as u8,
            hour: (second_of_day / 3_600) as u8,
            minute: (second_of_day / 60 % 60) as u8,
            second: (second_of_day % 60) as u8,
        }
    }
}

impl fmt::Display for GenerationTime {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        let CivilTime { year, month, day, hour, minute, second } = self.civil();
        write!(formatter, "{year:04}-{month:02}-{day:02}T{hour:02}:{minute:02}:{second:02}Z")
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn known_times() {
        for (seconds, text) in [
            (0, "1970-01-01T00:00:00Z"),
            (315_532_800, "1980-01-01T00:00:00Z"),
            (951_782_399, "2000-02-28T23:59:59Z"),
            (951_782_400, "2000-02-29T00:00:00Z"),
            (951_868_800, "2000-03-01T00:00:00Z"),
            (1_234_567_890, "2009-02-13T23:31:30Z"),
            (1_735_689_599, "2024-12-31T23:59:59Z"),
            (u32::MAX, "2106-02-07T06:28:15Z"),
        ] {
            assert_eq!(GenerationTime::from_epoch_seconds(seconds).to_string(), text);
        }
    }
}

//! Dates of files, in the calendar of people.

use std::time::{SystemTime, UNIX_EPOCH};

/// `2026-05-09 07:29`, universal time.
pub(crate) fn utc(time: SystemTime) -> String {
    let seconds = time
        .duration_since(UNIX_EPOCH)
        .map_or(0, |since| since.as_secs());
    let (day, second) = (seconds / 86_400, seconds % 86_400);
    let [year, month, day] = civil(day);
    format!(
        "{year:04}-{month:02}-{day:02} {:02}:{:02}",
        second / 3600,
        second % 3600 / 60
    )
}

/// Year, month and day of a day counted from 1 January 1970, in the Gregorian
/// calendar whose years begin in March, so that the leap day comes last.
fn civil(day: u64) -> [u64; 3] {
    const DAYS_OF_ERA: u64 = 146_097;
    // 719 468 days lie between 1 March of the year 0 and 1 January 1970.
    let day = day + 719_468;
    let (era, day) = (day / DAYS_OF_ERA, day % DAYS_OF_ERA);
    let year = (day - day / 1460 + day / 36_524 - day / 146_096) / 365;
    let of_year = day - (365 * year + year / 4 - year / 100);
    let march_month = (5 * of_year + 2) / 153;
    let of_month = of_year - (153 * march_month + 2) / 5 + 1;
    let month = if march_month < 10 {
        march_month + 3
    } else {
        march_month - 9
    };
    [400 * era + year + u64::from(month <= 2), month, of_month]
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::time::Duration;

    /// Unix times of known days: the epoch, the leap day of 2000, a day of 2026.
    #[test]
    fn days_are_those_of_the_calendar() {
        let days = [
            (0, "1970-01-01 00:00"),
            (951_782_400, "2000-02-29 00:00"),
            (1_778_311_762, "2026-05-09 07:29"),
        ];
        for (seconds, expected) in days {
            assert_eq!(utc(UNIX_EPOCH + Duration::from_secs(seconds)), expected);
        }
    }
}

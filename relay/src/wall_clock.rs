//! The time of day as text.

use std::time::{SystemTime, UNIX_EPOCH};

/// Now, in RFC 3339 with microseconds, in UTC.
pub(crate) fn now() -> String {
    at(SystemTime::now())
}

/// A time as [`now`] writes it.
pub(crate) fn at(time: SystemTime) -> String {
    let since = time.duration_since(UNIX_EPOCH).unwrap_or_default();
    text(since.as_secs(), since.subsec_micros())
}

/// The time of day of a moment, by today's clock.
pub(crate) fn of(moment: tokio::time::Instant) -> String {
    let (now, today) = (tokio::time::Instant::now(), SystemTime::now());
    let time = if moment > now { today.checked_add(moment - now) } else { today.checked_sub(now - moment) };
    at(time.unwrap_or(today))
}

fn text(seconds: u64, micros: u32) -> String {
    let (days, second) = (seconds / 86_400, seconds % 86_400);
    let (year, month, day) = date(days);
    let (hour, minute, second) = (second / 3_600, second / 60 % 60, second % 60);
    format!("{year:04}-{month:02}-{day:02}T{hour:02}:{minute:02}:{second:02}.{micros:06}Z")
}

/// µs since 1970 of a time; 0 before that.
pub(crate) fn micros(time: SystemTime) -> u64 {
    let since = time.duration_since(UNIX_EPOCH).unwrap_or_default();
    u64::try_from(since.as_micros()).unwrap_or(u64::MAX)
}

/// µs since 1970 as [`now`] writes them.
pub(crate) fn of_micros(micros: u64) -> String {
    let part = u32::try_from(micros % 1_000_000).unwrap_or_default();
    text(micros / 1_000_000, part)
}

/// µs since 1970 of a time in RFC 3339, from 1970 on: `2026-11-22T10:00:00Z`, `2026-11-22T11:00:00.5+01:00`.
pub(crate) fn parse(text: &str) -> Option<u64> {
    let number = |from: usize, length: usize, rest: &str| -> Option<u64> {
        let digits = rest.get(from..from + length)?;
        digits.bytes().all(|byte| byte.is_ascii_digit()).then(|| digits.parse().ok())?
    };
    let mark = |at: usize, allowed: &str| text.get(at..=at).is_some_and(|found| allowed.contains(found));
    let marks = [(4, "-"), (7, "-"), (10, "Tt "), (13, ":"), (16, ":")];
    let (year, month, day) = (number(0, 4, text)?, number(5, 2, text)?, number(8, 2, text)?);
    let (hour, minute, second) = (number(11, 2, text)?, number(14, 2, text)?, number(17, 2, text)?);
    let fits = (1..=12).contains(&month) && hour < 24 && minute < 60 && second <= 60;
    if !fits || !marks.iter().all(|(at, allowed)| mark(*at, allowed)) {
        return None;
    }
    let mut rest = text.get(19..)?;
    let mut micros = 0;
    if let Some(fraction) = rest.strip_prefix('.') {
        let length = fraction.bytes().take_while(u8::is_ascii_digit).count();
        let digits = fraction.get(..length).filter(|digits| !digits.is_empty())?;
        micros = format!("{digits:0<6}").get(..6)?.parse().ok()?;
        rest = fraction.get(length..)?;
    }
    let offset = match rest {
        "Z" | "z" => 0,
        // A plus in an address is a space when it arrives.
        _ => {
            let sign = match rest.get(..1)? {
                "+" | " " => 1,
                "-" => -1,
                _ => return None,
            };
            let (hours, minutes) = (number(1, 2, rest)?, number(4, 2, rest)?);
            let whole = rest.len() == 6 && rest.get(3..4) == Some(":") && hours < 24 && minutes < 60;
            let seconds = i64::try_from(hours * 3_600 + minutes * 60).ok()?;
            whole.then_some(sign * seconds)?
        }
    };
    let days = days(year, month, day)?;
    let local = i64::try_from(days * 86_400 + hour * 3_600 + minute * 60 + second).ok()?;
    u64::try_from(local - offset).ok()?.checked_mul(1_000_000)?.checked_add(micros)
}

/// Days since 1970-01-01; `None` for a day that its month does not have, and before 1970.
const fn days(year: u64, month: u64, day: u64) -> Option<u64> {
    if year < 1970 || day == 0 {
        return None;
    }
    // As in `date`: years begin on 1 March.
    let (march_year, month_of) = if month < 3 { (year - 1, month + 9) } else { (year, month - 3) };
    let days = 365 * march_year + march_year / 4 - march_year / 100 + march_year / 400;
    let days = days + (153 * month_of + 2) / 5 + day - 1 - 719_468;
    let (found_year, found_month, found_day) = date(days);
    if found_year == year && found_month == month && found_day == day { Some(days) } else { None }
}

/// Days since 1970-01-01 to the proleptic Gregorian date. Counts years from 1 March, so that the leap day is the
/// last of its year, in cycles of 400 years (146,097 days).
const fn date(days: u64) -> (u64, u64, u64) {
    let days = days + 719_468;
    let (era, day) = (days / 146_097, days % 146_097);
    let year = (day - day / 1_460 + day / 36_524 - day / 146_096) / 365;
    let day = day - (365 * year + year / 4 - year / 100);
    let month = (5 * day + 2) / 153;
    let day = day - (153 * month + 2) / 5 + 1;
    let (year, month) = (era * 400 + year, if month < 10 { month + 3 } else { month - 9 });
    (if month <= 2 { year + 1 } else { year }, month, day)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn known_moments_read_as_the_calendar_says() {
        for (seconds, expected) in [
            (0, "1970-01-01T00:00:00.000007Z"),
            (951_782_399, "2000-02-28T23:59:59.000007Z"),
            (951_782_400, "2000-02-29T00:00:00.000007Z"),
            (1_709_164_800, "2024-02-29T00:00:00.000007Z"),
            (1_735_689_599, "2024-12-31T23:59:59.000007Z"),
            (1_795_300_285, "2026-11-21T22:31:25.000007Z"),
            (4_107_542_400, "2100-03-01T00:00:00.000007Z"),
        ] {
            assert_eq!(text(seconds, 7), expected);
            assert_eq!(parse(expected), Some(seconds * 1_000_000 + 7));
            assert_eq!(of_micros(seconds * 1_000_000 + 7), expected);
        }
    }

    #[test]
    fn every_day_of_a_cycle_is_read_as_it_is_written() {
        for day in 0..146_097 {
            assert_eq!(parse(&text(day * 86_400, 0)), Some(day * 86_400_000_000));
        }
    }

    #[test]
    fn a_time_may_have_a_fraction_and_an_offset_and_nothing_else() {
        let noon = parse("2026-11-22T12:00:00Z").unwrap();
        for (text, micros) in [
            ("2026-11-22T12:00:00.5Z", noon + 500_000),
            ("2026-11-22T12:00:00.123456789Z", noon + 123_456),
            ("2026-11-22T13:00:00+01:00", noon),
            ("2026-11-22T13:00:00 01:00", noon),
            ("2026-11-22t06:30:00-05:30", noon),
        ] {
            assert_eq!(parse(text), Some(micros), "{text}");
        }
        for text in [
            "",
            "now",
            "2026-11-22",
            "2026-11-22T12:00:00",
            "2026-11-22T12:00Z",
            "2026-13-22T12:00:00Z",
            "2026-02-29T12:00:00Z",
            "2026-11-00T12:00:00Z",
            "2026-11-22T24:00:00Z",
            "1969-12-31T23:59:59Z",
            "2026-11-22T12:00:00.Z",
            "2026-11-22T12:00:00ZZ",
            "2026-11-22T12:00:00+1:00",
            "2026-11-22T12:00:00+01:0é",
            "+026-11-22T12:00:00Z",
            "ä026-11-22T12:00:00Z",
        ] {
            assert_eq!(parse(text), None, "{text}");
        }
    }
}

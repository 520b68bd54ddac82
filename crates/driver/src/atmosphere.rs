//! International standard atmosphere, ISO 2533, up to 20 km geopotential.
//!
//! $$ T = 288.15 - 0.0065\,h,\quad p = p_0 (T/T_0)^{g_0/(LR)}
//!    \quad (h \le 11\,\text{km}), \qquad
//!    T = 216.65,\quad p = p_{11} e^{-g_0(h - 11000)/(RT)} $$
//!
//! $\rho = p/(RT)$, $a = \sqrt{1.4\,RT}$.

use std::ops::RangeInclusive;

/// Geopotential altitudes the formulae hold for, m.
pub const RANGE: RangeInclusive<f64> = -2000.0..=20_000.0;

const SEA_LEVEL_TEMPERATURE: f64 = 288.15;
const SEA_LEVEL_PRESSURE: f64 = 101_325.0;
const LAPSE: f64 = 0.0065;
const TROPOPAUSE: f64 = 11_000.0;
const GAS_CONSTANT: f64 = 287.052_87;
const GRAVITY: f64 = 9.806_65;
const RATIO_OF_HEATS: f64 = 1.4;

/// Air density in kg/m³ at a geopotential altitude in m.
pub fn density(altitude: f64) -> f64 {
    let temperature = |h: f64| SEA_LEVEL_TEMPERATURE - LAPSE * h;
    let below = |h: f64| {
        let ratio = temperature(h) / SEA_LEVEL_TEMPERATURE;
        SEA_LEVEL_PRESSURE * ratio.powf(GRAVITY / (LAPSE * GAS_CONSTANT))
    };
    if altitude <= TROPOPAUSE {
        return below(altitude) / (GAS_CONSTANT * temperature(altitude));
    }
    let cold = temperature(TROPOPAUSE);
    let decay = -GRAVITY * (altitude - TROPOPAUSE) / (GAS_CONSTANT * cold);
    below(TROPOPAUSE) * decay.exp() / (GAS_CONSTANT * cold)
}

/// Speed of sound in m/s at a geopotential altitude in m.
pub fn sound_speed(altitude: f64) -> f64 {
    let temperature = SEA_LEVEL_TEMPERATURE - LAPSE * altitude.min(TROPOPAUSE);
    (RATIO_OF_HEATS * GAS_CONSTANT * temperature).sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// ISO 2533:1975, table 5: 1.225 00, 0.363 92 and 0.088 03 kg/m³ at
    /// geopotential 0, 11 000 and 20 000 m.
    #[test]
    fn density_is_that_of_the_standard() {
        let table = [
            (0.0, 1.225_00, 5e-6),
            (11e3, 0.363_92, 1e-5),
            (20e3, 0.088_035, 1e-5),
        ];
        for (altitude, expected, tolerance) in table {
            assert!(
                (density(altitude) - expected).abs() < tolerance,
                "{}",
                density(altitude)
            );
        }
    }

    /// ISO 2533:1975, table 5: 340.294 and 295.069 m/s at 0 and 11 000 m.
    #[test]
    fn speed_of_sound_is_that_of_the_standard() {
        for (altitude, expected) in [(0.0, 340.294), (11e3, 295.069), (20e3, 295.069)] {
            assert!((sound_speed(altitude) - expected).abs() < 1e-3);
        }
    }
}

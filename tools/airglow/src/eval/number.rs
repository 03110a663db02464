//! Numbers and vectors in the cells of a table.

use std::fmt::Write;

/// Nine significant digits, enough to tell any two f32 values apart; `inf`, `-inf` and `nan` spelled so.
pub fn format(value: f64) -> String {
    if value.is_nan() {
        return "nan".to_owned();
    }
    if value.is_infinite() {
        return if value > 0.0 { "inf" } else { "-inf" }.to_owned();
    }
    // The exponent after rounding: 9.9999999996 has nine digits as 10.0000000.
    let scientific = format!("{value:.8e}");
    let exponent = scientific.split_once('e').and_then(|(_, exponent)| exponent.parse::<i32>().ok());
    match exponent {
        Some(exponent @ -5..9) => format!("{value:.*}", (8 - exponent) as usize),
        _ => scientific,
    }
}

/// Components separated by `;`.
pub fn format_vector(values: &[f64]) -> String {
    let mut text = String::new();
    for (index, &value) in values.iter().enumerate() {
        let _ = write!(text, "{}{}", if index > 0 { ";" } else { "" }, format(value));
    }
    text
}

/// One number; `inf`, `-inf` and `nan` are numbers. The error says what was found.
pub fn parse(text: &str) -> Result<f64, String> {
    let text = text.trim();
    if text.is_empty() {
        return Err("is empty; expected a number".to_owned());
    }
    text.parse().map_err(|_| format!("is `{text}`; expected a number"))
}

/// Components separated by `;`.
pub fn parse_vector(text: &str) -> Result<Vec<f64>, String> {
    text.split(';').map(parse).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn nine_significant_digits() {
        assert_eq!(format(1.0 / 3.0), "0.333333333");
        assert_eq!(format(-12345.678901234), "-12345.6789");
        assert_eq!(format(0.0), "0.00000000");
        assert_eq!(format(9.9999999996), "10.0000000");
        assert_eq!(format(0.00099999999996), "0.00100000000");
        assert_eq!(format(999_999_999.7), "1.00000000e9");
        assert_eq!(format(1.5e-20), "1.50000000e-20");
        assert_eq!(format(2.0_f64.powi(40)), "1.09951163e12");
        assert_eq!([f64::INFINITY, f64::NEG_INFINITY, f64::NAN].map(format), ["inf", "-inf", "nan"]);
    }

    #[test]
    fn every_f32_survives_the_round_trip() {
        for bits in (0..u32::MAX).step_by(104_729) {
            let value = f32::from_bits(bits);
            let back = parse(&format(f64::from(value))).unwrap() as f32;
            assert!(back == value || value.is_nan() && back.is_nan(), "{value:e} came back as {back:e}");
        }
    }

    #[test]
    fn always_nine_digits() {
        for power in -12..=12 {
            for mantissa in [1.0, 1.23456789, 9.87654321, 9.999999994, 9.9999999996] {
                let text = format(-mantissa * 10f64.powi(power));
                let digits = text.split('e').next().unwrap().replace(['.', '-'], "");
                assert_eq!(digits.trim_start_matches('0').len(), 9, "{text}");
            }
        }
    }

    #[test]
    fn vectors_are_separated_by_semicolons() {
        assert_eq!(parse_vector("1; -2.5;inf").unwrap(), [1.0, -2.5, f64::INFINITY]);
        assert_eq!(format_vector(&[1.0, f64::INFINITY]), "1.00000000;inf");
        assert!(parse_vector("1;;2").is_err());
    }
}

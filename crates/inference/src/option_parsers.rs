// SPDX-License-Identifier: MIT OR Apache-2.0
//! The options of a run as text on the command line.

use std::path::Path;

use foveate_network::{ExecutionMode, accelerator::Accelerator};

use crate::{InferenceError, TuningGoal};

/// Parses a mode: `dense`, `exact`, `compare`, `truncate=0.25` or `fixed`.
///
/// # Errors
/// Fails if the text is not a mode; the message says what is expected.
pub fn parse_mode(text: &str) -> Result<ExecutionMode, String> {
    let wrong =
        || "expected dense, exact, compare, truncate=T with T of at least 0, or fixed".to_owned();
    Ok(match text.split_once('=') {
        None => match text {
            "dense" => ExecutionMode::Dense,
            "exact" => ExecutionMode::Exact,
            "compare" => ExecutionMode::Compare,
            "fixed" => ExecutionMode::Fixed,
            _ => return Err(wrong()),
        },
        Some(("truncate", limit)) => {
            let limit = limit.parse().ok().filter(|limit: &f32| limit.is_finite() && *limit >= 0.0);
            ExecutionMode::Truncate(limit.ok_or_else(wrong)?)
        }
        Some(_) => return Err(wrong()),
    })
}

/// Parses standard deviations of noise in grey levels of 8 bits, separated by commas. Zeros are
/// left out.
///
/// # Errors
/// Fails if a part is not a number from 0 to 255; the message says what is expected.
pub fn parse_noise(text: &str) -> Result<Vec<f64>, String> {
    let level = |text: &str| text.parse().ok().filter(|level| (0.0..=255.0).contains(level));
    let levels: Option<Vec<f64>> = text.split(',').map(level).collect();
    let levels = levels.ok_or(
        "expected standard deviations in grey levels of 8 bits, each 0 to 255, such as 1,2,4; 0 is none",
    )?;
    Ok(levels.into_iter().filter(|&level| level > 0.0).collect())
}

/// Parses a goal: `agreement=99%`, `cosine=0.999`, `psnr=40` or `variation=10%`.
///
/// # Errors
/// Fails if the text is not a goal; the message says what is expected.
pub fn parse_goal(text: &str) -> Result<TuningGoal, String> {
    let number = |text: &str| text.parse().ok().filter(|number: &f64| number.is_finite());
    let goal = match text.split_once('=') {
        Some(("agreement", share)) => share
            .strip_suffix('%')
            .and_then(number)
            .filter(|percent| (0.0..=100.0).contains(percent))
            .map(|percent| TuningGoal::Agreement(percent / 100.0)),
        Some(("cosine", cosine)) => {
            number(cosine).filter(|cosine| (-1.0..=1.0).contains(cosine)).map(TuningGoal::Cosine)
        }
        Some(("psnr", decibels)) => number(decibels).map(TuningGoal::Psnr),
        Some(("variation", share)) => share
            .strip_suffix('%')
            .and_then(number)
            .filter(|&percent| percent >= 0.0)
            .map(|percent| TuningGoal::Variation(percent / 100.0)),
        _ => None,
    };
    goal.ok_or_else(|| {
        "expected agreement=P% with P from 0 to 100, cosine=C with C from -1 to 1, psnr=D in decibels, or variation=P%".to_owned()
    })
}

/// Reads an accelerator and returns it with its name. A name that ends in `.toml` is a file; any
/// other name is a preset.
///
/// # Errors
/// Fails if the file cannot be read or does not describe an accelerator, or if there is no preset
/// of that name.
pub fn read_accelerator(name: &str) -> Result<(String, Accelerator), InferenceError> {
    let path = Path::new(name);
    let accelerator = if path.extension().is_some_and(|extension| extension == "toml") {
        let text = foveate_tools::read_settings(path)
            .map_err(|source| InferenceError::Read { path: path.to_owned(), source })?;
        Accelerator::from_toml(&text).map_err(|error| InferenceError::InvalidOption {
            problem: format!("`{name}`: {error}"),
        })?
    } else {
        Accelerator::from_preset(name)
            .map_err(|error| InferenceError::InvalidOption { problem: error.to_string() })?
    };
    Ok((name.to_owned(), accelerator))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn goals_are_those_of_the_summary() {
        for text in ["agreement=99%", "cosine=0.999", "psnr=40", "variation=10%"] {
            assert_eq!(parse_goal(text).unwrap().to_string(), text);
        }
        for wrong in [
            "",
            "agreement",
            "agreement=99",
            "agreement=101%",
            "cosine=2",
            "psnr=high",
            "psnr=nan",
            "ssim=1",
        ] {
            assert!(parse_goal(wrong).is_err(), "{wrong}");
        }
    }

    #[test]
    fn modes_are_those_of_the_summary() {
        assert_eq!(parse_mode("truncate=0.25"), Ok(ExecutionMode::Truncate(0.25)));
        assert_eq!(parse_mode("compare"), Ok(ExecutionMode::Compare));
        for wrong in
            ["", "sparse", "truncate", "truncate=", "truncate=-1", "truncate=nan", "exact=1"]
        {
            assert!(parse_mode(wrong).is_err(), "{wrong}");
        }
    }
}

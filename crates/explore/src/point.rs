// SPDX-License-Identifier: MIT OR Apache-2.0
//! The points of a space, each with its design ([`DesignPoint`]).

use crate::space::{DesignSpace, plain_text};
use foveate_design::DesignConfig;
use serde::{Deserialize, Serialize};
use std::collections::BTreeSet;
use toml::Value;

/// A design of a space.
#[derive(Clone, Debug, PartialEq)]
pub struct DesignPoint {
    /// The value of every axis, a string without quotes; empty if the axis has the value of the
    /// start.
    pub settings: Vec<String>,
    /// The configuration.
    pub config: DesignConfig,
    /// The number of the combination, from 0.
    pub combination: usize,
}

/// A combination that is not a valid design.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct RefusedCombination {
    /// The settings as `key = value`.
    pub settings: String,
    /// The reason why the combination cannot be built.
    pub reason: String,
}

impl DesignSpace {
    /// Returns the different designs for frames of `width` x `height` pixels, and the combinations
    /// that are not valid designs.
    #[must_use]
    pub fn points(&self, width: u32, height: u32) -> (Vec<DesignPoint>, Vec<RefusedCombination>) {
        self.points_of_combinations(None, width, height)
    }

    pub(crate) fn points_of_combinations(
        &self,
        some: Option<&[usize]>,
        width: u32,
        height: u32,
    ) -> (Vec<DesignPoint>, Vec<RefusedCombination>) {
        let (mut points, mut refused, mut seen) = (Vec::new(), Vec::new(), BTreeSet::new());
        let all = self.method.combinations(&self.axes).into_iter().enumerate();
        for (number, combination) in
            all.filter(|(number, _)| some.is_none_or(|some| some.contains(number)))
        {
            let values: Vec<Option<&Value>> = std::iter::zip(&self.axes, combination)
                .map(|(axis, index)| index.and_then(|index| axis.values.get(index)))
                .collect();
            let settings: Vec<String> =
                values.iter().map(|value| value.map(plain_text).unwrap_or_default()).collect();
            match self.config_of_values(&values, width, height) {
                Ok(config) => {
                    // The first of equal designs is kept, because it has the fewest settings.
                    if seen.insert(config.to_toml()) {
                        points.push(DesignPoint { settings, config, combination: number });
                    }
                }
                Err(reason) => {
                    refused.push(RefusedCombination {
                        settings: self.settings_of_point(&settings),
                        reason,
                    });
                }
            }
        }
        (points, refused)
    }

    /// Returns the settings as `key = value`, without those that have the value of the start.
    #[must_use]
    pub fn settings_of_point(&self, settings: &[String]) -> String {
        settings_text(self.axes.iter().map(|axis| axis.key.as_str()), settings)
    }

    fn config_of_values(
        &self,
        values: &[Option<&Value>],
        width: u32,
        height: u32,
    ) -> Result<DesignConfig, String> {
        let set = self.axes.iter().zip(values);
        let overrides: Vec<String> = set
            .filter_map(|(axis, value)| value.map(|value| format!("{}={value}", axis.key)))
            .collect();
        let config = self.start.with_overrides_in_start_levels(&overrides);
        let design = config
            .and_then(|config| config.validate_for_frames(width, height))
            .map_err(|error| error.to_string())?;
        // Every default is filled in, so that equal designs have equal texts.
        Ok(design.config())
    }
}

/// Returns the settings of some axes as `key = value`, without those that have the value of the
/// start.
pub(crate) fn settings_text<'a>(
    axes: impl Iterator<Item = &'a str>,
    settings: &[String],
) -> String {
    let set = axes.zip(settings).filter(|(_, value)| !value.is_empty());
    let words: Vec<String> = set.map(|(axis, value)| format!("{axis} = {value}")).collect();
    if words.is_empty() { START_NAME.to_owned() } else { words.join(", ") }
}

/// The name of the point that changes no setting.
pub(crate) const START_NAME: &str = "the start";

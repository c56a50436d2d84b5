// SPDX-License-Identifier: MIT OR Apache-2.0
//! The agreements that a descent has measured, and the reasons that follow from them.

use std::collections::BTreeMap;

use foveate_camera::{Camera, CameraConfig};

use super::agreement_estimate::AgreementEstimate;
use crate::ExploreError;

/// The agreement of the network behind cameras, by their configurations.
#[derive(Debug, Default)]
pub(super) struct KnownAgreements {
    /// The agreement on the frames of the search.
    pub(super) searched: BTreeMap<String, AgreementEstimate>,
    /// The agreement on later frames, for cameras that agreed enough before.
    pub(super) confirmed: BTreeMap<String, AgreementEstimate>,
}

impl KnownAgreements {
    /// Returns the number of cameras.
    pub(super) fn count(&self) -> usize {
        self.searched.len()
    }

    /// Returns the exact agreement of a camera, and its agreement on later frames if it is known.
    pub(super) fn agreements_of(
        &self,
        config: &CameraConfig,
    ) -> (AgreementEstimate, Option<AgreementEstimate>) {
        let text = config.to_toml();
        (self.searched[&text], self.confirmed.get(&text).copied())
    }

    /// Returns the reasons of the network for choosing this camera; `least` is the agreement that
    /// was to be reached.
    pub(super) fn reasons(&self, chosen: &CameraConfig, least: f64) -> Vec<String> {
        self.not_confirmed(least).into_iter().chain(self.step_lines(chosen)).collect()
    }

    /// Returns a sentence with the number of cameras that later frames did not confirm.
    fn not_confirmed(&self, least: f64) -> Option<String> {
        let failed = |agreed: &&AgreementEstimate| agreed.is_upper_bound || agreed.expected < least;
        let count = self.confirmed.values().filter(failed).count();
        let all = self.confirmed.len();
        (count > 0).then(|| {
            format!(
                "later frames did not confirm {count} of {all} cameras whose agreement was sufficient before"
            )
        })
    }

    /// Returns a line for each camera that differs from the chosen one in one setting, in the order
    /// of the keys.
    fn step_lines(&self, chosen: &CameraConfig) -> Vec<String> {
        let own = settings_of_toml(&chosen.to_toml());
        let step = |(text, agreed): (&String, &AgreementEstimate)| {
            let other = settings_of_toml(text);
            let mut changed = other.iter().filter(|setting| !own.contains(setting));
            let lost = own.iter().filter(|setting| !other.contains(setting)).count();
            let setting = changed.next().filter(|_| lost <= 1 && changed.next().is_none())?;
            let bound = if agreed.is_upper_bound { "at most " } else { "" };
            let share = 100.0 * agreed.share;
            let expected = 100.0 * agreed.expected;
            let elsewhere =
                (!agreed.is_upper_bound).then(|| format!(", {expected:.1} % elsewhere"));
            let elsewhere = elsewhere.unwrap_or_default();
            Some(format!("{setting}: agreement {bound}{share:.1} %{elsewhere}"))
        };
        self.searched.iter().filter_map(step).collect()
    }
}

/// Returns the settings of a configuration, each with the names of its tables.
fn settings_of_toml(toml: &str) -> Vec<String> {
    let table: toml::Table = toml.parse().expect("a configuration is written as TOML");
    let mut found = Vec::new();
    collect_settings("", &toml::Value::Table(table), &mut found);
    found
}

fn collect_settings(name: &str, value: &toml::Value, found: &mut Vec<String>) {
    match value {
        toml::Value::Table(table) => {
            for (key, value) in table {
                let name = if name.is_empty() { key.clone() } else { format!("{name}.{key}") };
                collect_settings(&name, value, found);
            }
        }
        toml::Value::Array(entries) => {
            entries.iter().for_each(|entry| collect_settings(name, entry, found));
        }
        value => found.push(format!("{name} = {value}")),
    }
}

/// Returns the known agreement of a camera, or calls `ask`. Without `least`, a known upper bound is
/// not enough.
pub(super) fn known_or_measured(
    known: &mut BTreeMap<String, AgreementEstimate>,
    camera: &Camera,
    least: Option<f64>,
    ask: impl FnOnce() -> Result<AgreementEstimate, ExploreError>,
) -> Result<AgreementEstimate, ExploreError> {
    let key = camera.config().to_toml();
    let enough = |agreed: &&AgreementEstimate| least.is_some() || !agreed.is_upper_bound;
    if let Some(agreed) = known.get(&key).filter(enough) {
        return Ok(*agreed);
    }
    let agreed = ask()?;
    known.insert(key, agreed);
    Ok(agreed)
}

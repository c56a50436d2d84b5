// SPDX-License-Identifier: MIT OR Apache-2.0
//! Tests that no text of a configuration reaches generated files, except the names that the program
//! defines.

use foveate_camera::{ConfigError, toml_text::TomlConfig};
use foveate_design::{DesignConfig, Preset};
use toml::{Table, Value};

use crate::hostile::{TextPlaces, key_name, texts};

/// The test puts hostile texts into every key and into every value of several presets.
#[test]
fn no_text_of_a_configuration_is_taken() {
    let problem = |config: Result<DesignConfig, ConfigError>| {
        config.and_then(|config| config.validate()).err().map(|error| error.to_string())
    };
    let mut tried = 0;
    for text in texts() {
        let quoted = Value::String(text.clone()).to_string();
        let shown: String = text.chars().take(40).collect();
        let mut refused = |said: Option<String>, key: &str| {
            let said = said.unwrap_or_else(|| panic!("{key} = {shown:?} is taken"));
            assert!(said.contains(key), "{key} = {shown:?}: {said:.300}");
            assert!(!said.contains(char::is_control), "{key} = {shown:?}: {said:.300}");
            tried += 1;
        };
        for (name, _) in DesignConfig::keys() {
            let change = format!("{}={quoted}", name.replace(".N.", ".0."));
            let said = problem(DesignConfig::from_toml_with(
                Preset::find("paper").unwrap().toml,
                &[change],
            ));
            refused(said, name.rsplit('.').next().unwrap());
        }
        for preset in ["paper", "raster", "serial"] {
            let base: Table = DesignConfig::from_toml(Preset::find(preset).unwrap().toml)
                .unwrap()
                .to_toml()
                .parse()
                .unwrap();
            let complaint = |table: &Table| problem(DesignConfig::from_toml(&table.to_string()));
            let schema = TextPlaces { base, complaint: &complaint };
            for place in schema.places() {
                let table = schema.with_value(&place, Value::String(text.clone()));
                refused(complaint(&table), key_name(&place));
            }
        }
    }
    assert!(tried > 3000, "{tried}");
}

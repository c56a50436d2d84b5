// SPDX-License-Identifier: MIT OR Apache-2.0
//! `foveate presets`: the presets and scenes to start from.

use foveate_design::{DesignConfig, PRESETS, Preset};
use foveate_pixels::Scene;
use serde::Serialize;

use crate::args::PresetsArgs;
use crate::error::CliError;
use crate::output;

#[derive(Serialize)]
struct CatalogListing {
    format_version: u32,
    entries: Vec<CatalogEntry>,
}

/// The name of a preset or scene, and a line about it.
#[derive(Serialize)]
struct CatalogEntry {
    name: &'static str,
    summary: &'static str,
}

pub(crate) fn run(args: &PresetsArgs) -> Result<(), CliError> {
    if let Some(name) = &args.name {
        // The file has every key except the size of the frame, which simulations take from their
        // input. A preset for frames of one size has that size, too.
        let own = Preset::find(name)?.config()?;
        let mut config = own.validate()?.config();
        (config.camera.frame.width, config.camera.frame.height) =
            (own.camera.frame.width, own.camera.frame.height);
        return output::print_result((args.json, false), &config, || preset_file(name, &config));
    }
    let entries: Vec<CatalogEntry> = if args.scenes {
        Scene::ALL.iter().map(|s| CatalogEntry { name: s.name(), summary: s.summary() }).collect()
    } else {
        PRESETS.iter().map(|p| CatalogEntry { name: p.name, summary: p.summary }).collect()
    };
    let listing = CatalogListing { format_version: 1, entries };
    output::print_result((args.json, false), &listing, || catalog_text(&listing.entries))
}

fn preset_file(name: &str, config: &DesignConfig) -> String {
    let size = match (config.camera.frame.width, config.camera.frame.height) {
        (None, None) => {
            "Without frame.width and frame.height, which are 224 then, `foveate simulate` and\n\
                         # `foveate cosim` take them from their input."
                .to_owned()
        }
        (width, height) => {
            let length =
                |side: Option<u32>| side.map_or_else(|| "any".to_owned(), |side| side.to_string());
            format!(
                "It is for frames of {} x {} pixels; without frame.width and frame.height,\n\
                 # `foveate simulate` and `foveate cosim` take them from their input.",
                length(width),
                length(height)
            )
        }
    };
    format!("# Preset `{name}`. {size}\n\n{}", config.to_toml())
}

fn catalog_text(entries: &[CatalogEntry]) -> String {
    let width = entries.iter().map(|entry| entry.name.len()).max().unwrap_or(0);
    entries.iter().map(|entry| format!("{:width$}  {}\n", entry.name, entry.summary)).collect()
}

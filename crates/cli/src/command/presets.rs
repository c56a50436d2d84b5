// SPDX-License-Identifier: MIT OR Apache-2.0
//! `foveate presets`: what there is to start from.

use foveate_scenes::Scene;
use foveate_spec::{PRESETS, Preset};
use serde::Serialize;

use crate::args::PresetsArgs;
use crate::error::CliError;
use crate::output;

/// Something with a name and a line about it.
#[derive(Serialize)]
struct Entry {
    name: &'static str,
    summary: &'static str,
}

pub(crate) fn run(args: &PresetsArgs) -> Result<(), CliError> {
    if let Some(name) = &args.name {
        let design = Preset::find(name)?.config()?.validate()?;
        return if args.json {
            output::json(design.config())
        } else {
            output::text(&design.config().to_toml())
        };
    }
    let entries: Vec<Entry> = if args.scenes {
        Scene::ALL.iter().map(|s| Entry { name: s.name(), summary: s.summary() }).collect()
    } else {
        PRESETS.iter().map(|p| Entry { name: p.name, summary: p.summary }).collect()
    };
    if args.json { output::json(&entries) } else { output::text(&list(&entries)) }
}

fn list(entries: &[Entry]) -> String {
    let width = entries.iter().map(|entry| entry.name.len()).max().unwrap_or(0);
    entries.iter().map(|entry| format!("{:width$}  {}\n", entry.name, entry.summary)).collect()
}

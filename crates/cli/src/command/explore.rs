// SPDX-License-Identifier: MIT OR Apache-2.0
//! `foveate explore`: a space of designs over clips, as tables and a page.

mod table;
mod units;

use std::path::Path;

use foveate_explore::{
    BUILT_IN_SPACES, DesignSpace, ExploreError, ExploreRequest, ProcessRequest, SynthesisRequest,
    check_folder, explore,
};
use foveate_media::{ImageRelation, PlaybackError};

use crate::args::{ExploreArgs, warn_about_inputs};
use crate::error::CliError;
use crate::output;
use crate::progress::RunTerminal;

pub(crate) fn run(args: &ExploreArgs) -> Result<(), CliError> {
    if args.list {
        let line =
            |space: &foveate_explore::BuiltInSpace| format!("{:16}{}\n", space.name, space.summary);
        return output::print_text(&BUILT_IN_SPACES.iter().map(line).collect::<String>());
    }
    let (Some(file), output) = (&args.space, args.output.as_deref()) else {
        return Err(CliError::Usage(
            "no space is given; give a file, or the name of a space that --list prints".to_owned(),
        ));
    };
    if let Some(folder) = output.filter(|_| !args.print) {
        check_folder(folder)?;
    }
    let text = read_space(file)?;
    let space = DesignSpace::from_toml(&text).map_err(|error| file_error(file, &error))?;
    let Some(folder) = output.filter(|_| !args.print) else { return output::print_text(&text) };
    let input = args.input.options(ImageRelation::Clip);
    warn_about_inputs(&args.inputs, &input);
    let terminal = RunTerminal::new(args.quiet)?;
    let mut request = ExploreRequest {
        space: &space,
        inputs: &args.inputs,
        input: &input,
        disturbance: args.disturb,
        synthesis: None,
    };
    if args.plan {
        return units::print_plan(&request, folder, &terminal);
    }
    if let Some(unit) = &args.only {
        return units::run_unit(args, &request, unit, folder, &terminal);
    }
    let synthesizer = if args.no_area { None } else { Some(terminal.synthesizer()?) };
    let process = terminal.process(&args.process)?;
    let energy_rate = args.energy.map(|rate| rate.per_second());
    let process = process.as_ref().map(|process| ProcessRequest { process, energy_rate });
    request.synthesis =
        synthesizer.as_ref().map(|synthesizer| SynthesisRequest { synthesizer, process });
    let found = explore(&request, folder, &terminal);
    terminal.progress.finish();
    let found = match found {
        Err(ExploreError::Playback(PlaybackError::Interrupted)) => {
            return Err(CliError::Interrupted { path: folder.to_owned() });
        }
        other => other?,
    };
    let is_quiet = args.quiet && !args.markdown;
    output::print_result((args.json, is_quiet), &found, || match args.markdown {
        true => table::markdown(&found),
        false => table::text(folder, &found, output::text_width()),
    })?;
    if found.problems.is_empty() {
        return Ok(());
    }
    let place = folder.display();
    Err(CliError::Failed(format!("`{place}` is not complete: {}", found.problems.join("; "))))
}

/// Reads the file. If it does not exist, the built-in space of that name is returned.
fn read_space(file: &Path) -> Result<String, CliError> {
    let built_in = BUILT_IN_SPACES.iter().find(|space| Path::new(space.name) == file);
    match built_in.filter(|_| !file.is_file()) {
        Some(space) => Ok(space.toml.to_owned()),
        None if file.exists() => {
            foveate_tools::read_settings(file).map_err(CliError::io("read", file))
        }
        None => {
            let names: Vec<&str> = BUILT_IN_SPACES.iter().map(|space| space.name).collect();
            Err(CliError::Usage(format!(
                "there is no file `{}` and no built-in space of that name; the built-in spaces are {}",
                file.display(),
                names.join(" and ")
            )))
        }
    }
}

fn file_error(file: &Path, error: &ExploreError) -> CliError {
    CliError::Usage(format!("{}: {error}", file.display()))
}

// SPDX-License-Identifier: MIT OR Apache-2.0
//! `foveate explore`: a space of designs over clips, as tables and a page.

mod table;
mod units;

use std::path::Path;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

use foveate_explore::{
    BUILT_IN_SPACES, DesignSpace, Exploration, ExploreError, ExploreHooks, ExploreProgress,
    ExploreRequest, Synthesizer, check_folder, explore,
};
use foveate_footage::ImageRelation;
use foveate_toolchain::{Cache, Toolchain};

use crate::args::{ExploreArgs, warn_about_inputs};
use crate::error::CliError;
use crate::progress::Progress as Shown;
use crate::{interrupt, output};

pub(crate) fn run(args: &ExploreArgs) -> Result<(), CliError> {
    if args.list {
        let line =
            |space: &foveate_explore::BuiltInSpace| format!("{:16}{}\n", space.name, space.summary);
        return output::print_text(&BUILT_IN_SPACES.iter().map(line).collect::<String>());
    }
    let (Some(file), output) = (&args.space, args.output.as_deref()) else {
        return Err(CliError::Usage(
            "no space is given; name a file, or one of those that --list prints".to_owned(),
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
    let terminal = ExploreTerminal::new(args.quiet)?;
    let mut request =
        ExploreRequest { space: &space, inputs: &args.inputs, input: &input, synthesizer: None };
    if args.plan {
        return units::print_plan(&request, folder, &terminal);
    }
    if let Some(unit) = &args.only {
        return units::run_unit(args, &request, unit, folder, &terminal);
    }
    let synthesizer = if args.no_area { None } else { Some(terminal.synthesizer()?) };
    request.synthesizer = synthesizer.as_ref();
    let found = explore(&request, folder, &terminal);
    terminal.progress.finish();
    let found = match found {
        Err(ExploreError::Cancelled) => {
            return Err(CliError::Interrupted { path: folder.to_owned() });
        }
        other => other?,
    };
    print_exploration(args, folder, &found)?;
    if found.problems.is_empty() {
        return Ok(());
    }
    let place = folder.display();
    Err(CliError::Failed(format!("`{place}` is not complete: {}", found.problems.join("; "))))
}

fn print_exploration(
    args: &ExploreArgs,
    folder: &Path,
    found: &Exploration,
) -> Result<(), CliError> {
    if args.json {
        output::print_json(found)
    } else if args.markdown {
        output::print_text(&table::markdown(found))
    } else if args.quiet {
        Ok(())
    } else {
        output::print_text(&table::text(folder, found, output::text_width()))
    }
}

/// Reads the file. If it does not exist, the built-in space of that name is returned.
fn read_space(file: &Path) -> Result<String, CliError> {
    let built_in = BUILT_IN_SPACES.iter().find(|space| Path::new(space.name) == file);
    match built_in.filter(|_| !file.exists()) {
        Some(space) => Ok(space.toml.to_owned()),
        None if file.exists() => {
            foveate_reading::read_settings(file).map_err(CliError::io("read", file))
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

/// The progress of the command on the terminal, and the flag that Ctrl-C sets.
pub(super) struct ExploreTerminal {
    pub(super) progress: Shown,
    interrupted: Arc<AtomicBool>,
}

impl ExploreTerminal {
    pub(super) fn new(quiet: bool) -> Result<Self, CliError> {
        Ok(Self { progress: Shown::new(quiet), interrupted: interrupt::stop_flag()? })
    }

    /// Returns the tools of this machine. The same Ctrl-C stops them.
    pub(super) fn synthesizer(&self) -> Result<Synthesizer, CliError> {
        let toolchain = Toolchain::system().with_cancel_flag(Arc::clone(&self.interrupted));
        // A missing Yosys is reported before hours of measurements.
        toolchain.find(foveate_toolchain::Tool::Yosys)?;
        Ok(Synthesizer { toolchain, cache: Cache::from_env()? })
    }
}

impl ExploreHooks for ExploreTerminal {
    fn progress(&self, progress: ExploreProgress) {
        let (what, done, all) = match progress {
            ExploreProgress::Reading { frames } => {
                return self.progress.report_frames(frames, None, "reading the clips");
            }
            ExploreProgress::RunningNetwork { cameras } => {
                return self
                    .progress
                    .report_work(&format!("the network looks at cameras, {cameras} so far"));
            }
            ExploreProgress::Measuring { done_pairs: done, all } => {
                ("designs over clips", done, all)
            }
            ExploreProgress::Synthesizing { done, all } => ("synthesizing with Yosys", done, all),
        };
        self.progress.report_steps(what, done as u64, all as u64);
    }

    fn cancelled(&self) -> bool {
        self.interrupted.load(Ordering::Relaxed)
    }
}

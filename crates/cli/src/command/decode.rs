// SPDX-License-Identifier: MIT OR Apache-2.0
//! `foveate decode`: a recorded stream of packets in; arrays, tables, pictures and video out.

use std::io::Read;
use std::path::Path;

use foveate_simulator::{Decoded, Recording, RunOptions, SIMULATION};
use foveate_staging::StagedFolder;
use foveate_toolchain::{InterruptibleReader, open_interruptibly, standard_input};

use super::simulate::{Terminal, text};
use crate::args::DecodeArgs;
use crate::error::CliError;
use crate::{interrupt, notice, output};

pub(crate) fn run(args: &DecodeArgs) -> Result<(), CliError> {
    StagedFolder::check(&args.output, SIMULATION, args.force)?;
    let config = args.design.read()?;
    let name = args.stream.display().to_string();
    let mut stream = open(&args.stream)?;
    let options = RunOptions { overwrite: args.force, ..args.view.options() };
    let mut hooks = Terminal::new(args.quiet)?;
    let recording = Recording { config: &config, stream: &mut stream, name: &name };
    let decoded = recording.decode(&args.output, &options, &mut hooks);
    hooks.shown.finish();
    let Decoded { summary, losses, loss_count } = decoded?;
    for loss in &losses {
        notice::say(loss);
    }
    let more = loss_count - losses.len() as u64;
    if more > 0 {
        let file = args.output.join("losses.csv");
        notice::say(&format_args!("and {more} more, in `{}`", file.display()));
    }
    match (args.json, args.quiet) {
        (true, _) => output::json(&summary)?,
        (false, true) => {}
        (false, false) => output::text(&text(&args.output, &summary))?,
    }
    hooks.verdict(&args.output, summary.problem)
}

fn open(path: &Path) -> Result<Box<dyn Read>, CliError> {
    let interrupt = interrupt::request();
    if path == Path::new("-") {
        let stdin = standard_input().map_err(CliError::io("read the packets", path))?;
        return Ok(Box::new(InterruptibleReader::new(stdin, &interrupt)));
    }
    let cannot = || CliError::io("read the packets", path);
    let file = open_interruptibly(path, &interrupt).map_err(cannot())?;
    if file.metadata().map_err(cannot())?.is_dir() {
        return Err(CliError::Usage(format!(
            "`{}` is a folder; give the file with the packets, such as packets.bin in it",
            path.display()
        )));
    }
    Ok(Box::new(InterruptibleReader::new(file, &interrupt)))
}

// SPDX-License-Identifier: MIT OR Apache-2.0
//! `foveate decode`: a recorded stream of packets in; arrays, tables, pictures and video out.

use std::io::Read;
use std::path::Path;

use foveate_simulator::{DecodedRecording, PacketRecording, RunOptions, SIMULATION_FOLDER};
use foveate_tools::{InterruptibleReader, open_interruptibly, standard_input};

use super::simulate::text;
use crate::args::{DecodeArgs, check_output};
use crate::error::CliError;
use crate::progress::RunTerminal;
use crate::{interrupt, notice, output};

pub(crate) fn run(args: &DecodeArgs) -> Result<(), CliError> {
    check_output(&args.output, SIMULATION_FOLDER, args.force, &[&args.stream])?;
    let config = args.design.config()?;
    let name = args.stream.display().to_string();
    let mut stream = open(&args.stream)?;
    let options = RunOptions { overwrite: args.force, ..args.receiver.options() };
    let hooks = RunTerminal::new(args.quiet)?;
    let recording = PacketRecording { config: &config, stream: &mut stream, name: &name };
    let decoded = recording.decode(&args.output, &options, &hooks);
    hooks.progress.finish();
    let DecodedRecording { summary, losses, loss_count } = decoded?;
    for loss in &losses {
        notice::print_notice(loss);
    }
    let more = loss_count - losses.len() as u64;
    if more > 0 {
        let file = args.output.join("losses.csv");
        notice::print_notice(&format_args!("and {more} more, in `{}`", file.display()));
    }
    output::print_result((args.json, args.quiet), &summary, || text(&args.output, &summary))?;
    hooks.check_complete(&args.output, summary.problem)
}

fn open(path: &Path) -> Result<Box<dyn Read>, CliError> {
    let interrupt = interrupt::stop_request();
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

// SPDX-License-Identifier: MIT OR Apache-2.0
//! `foveate infer` with a network alone, without a camera: on arrays, or only checked.

use std::ffi::OsString;
use std::fmt::Write as _;
use std::path::Path;

use clap::CommandFactory;
use clap::parser::ValueSource;
use foveate_inference::{
    ArrayFile, ArraySummary, NetworkFacts, NetworkReport, OPEN_SIZE, check_network, infer_arrays,
    is_array,
};
use foveate_network::operators;
use indicatif::DecimalBytes;

use crate::args::{Cli, InferArgs};
use crate::error::CliError;
use crate::output;

/// The arguments that are valid for arrays, too.
const ARRAY_ARGUMENTS: [&str; 7] =
    ["network", "inputs", "output", "force", "json", "quiet", "threads"];
/// The arguments that are valid for a check, too.
const CHECK_ARGUMENTS: [&str; 5] = ["network", "check", "json", "resize", "threads"];

pub(super) fn run_arrays(
    args: &InferArgs,
    words: &[OsString],
    folder: &Path,
) -> Result<(), CliError> {
    if let Some(other) = args.inputs.iter().find(|input| !is_array(input)) {
        return Err(CliError::Usage(format!(
            "`{}` is not an array (.npy), but other inputs are; give only arrays, one for each input of the network, or only clips",
            other.display()
        )));
    }
    refuse_other_arguments(words, &ARRAY_ARGUMENTS, "with arrays, which bypass the camera")?;
    let summary = infer_arrays(&args.network, &args.inputs, folder, args.force)?;
    output::print_result((args.json, args.quiet), &summary, || arrays_text(folder, &summary))
}

/// Checks all nodes of the network.
pub(super) fn run_check(args: &InferArgs, words: &[OsString]) -> Result<(), CliError> {
    refuse_other_arguments(words, &CHECK_ARGUMENTS, "with --check, which reads no frames")?;
    let checked = check_network(&args.network, args.input.resize.unwrap_or(OPEN_SIZE))?;
    output::print_result((args.json, false), &checked, || check_text(&args.network, &checked))?;
    match checked.problems.len() {
        0 => Ok(()),
        count => Err(CliError::Failed(format!(
            "{count} of the {} nodes of `{}` cannot be run",
            checked.nodes,
            args.network.display()
        ))),
    }
}

/// Fails if an argument outside of `allowed` is given. `here` names the use of the command in the
/// message.
fn refuse_other_arguments(
    words: &[OsString],
    allowed: &[&str],
    here: &str,
) -> Result<(), CliError> {
    let command = Cli::command();
    let matches = command.clone().get_matches_from(words);
    let Some((name, matches)) = matches.subcommand() else { return Ok(()) };
    let is_given = |id: &str| matches.value_source(id) == Some(ValueSource::CommandLine);
    let own = command.find_subcommand(name).expect("it has been parsed");
    let mut odd = own.get_arguments().filter(|argument| {
        let id = argument.get_id().as_str();
        !allowed.contains(&id) && matches.ids().any(|own| own == id) && is_given(id)
    });
    match odd.next() {
        None => Ok(()),
        Some(odd) => Err(CliError::Usage(format!(
            "--{} has no meaning {here}; leave it out",
            odd.get_long().unwrap_or(odd.get_id().as_str())
        ))),
    }
}

#[allow(clippy::cast_precision_loss, reason = "one digit is shown")]
fn millions(count: u64) -> String {
    format!("{:.1} M", count as f64 / 1e6)
}

fn shape(lengths: &[usize]) -> String {
    format!("{lengths:?}")
}

fn arrays_text(folder: &Path, summary: &ArraySummary) -> String {
    let mut text = format!("{}: outputs of {}\n", folder.display(), summary.network.display());
    let line = |of: &str, array: &ArrayFile| {
        let name = array.name.as_ref().map(|name| format!("{name} ")).unwrap_or_default();
        format!("{of:<10} {name}{} {} in {}\n", array.dtype, shape(&array.shape), array.file)
    };
    text.extend(summary.inputs.iter().map(|array| line("input", array)));
    text.extend(summary.outputs.iter().map(|array| line("output", array)));
    let _ = writeln!(text, "MACs       {}", millions(summary.macs));
    let _ = writeln!(text, "memory     weights {}", DecimalBytes(summary.weight_bytes));
    let _ = writeln!(text, "time       {:.2} ms", 1e3 * summary.seconds);
    text
}

fn check_text(path: &Path, checked: &NetworkReport) -> String {
    let name = path.display();
    if let Some(facts) = &checked.network {
        let all = format!("{name}: all {} nodes can be run\n", checked.nodes);
        return all + &network_text(facts);
    }
    let mut text =
        format!("{name}: {} of {} nodes cannot be run\n", checked.problems.len(), checked.nodes);
    for problem in &checked.problems {
        let _ = writeln!(text, "- {problem}");
    }
    let operators: Vec<_> = operators().collect();
    let _ = writeln!(text, "operators that can be run: {}", operators.join(", "));
    text
}

fn network_text(facts: &NetworkFacts) -> String {
    let mut text = format!("input      {}, layout {}\n", shape(&facts.input), facts.layout);
    for (name, lengths) in &facts.outputs {
        let _ = writeln!(text, "output     {name} {}", shape(lengths));
    }
    let operators = facts.operators.iter().map(|(name, count)| format!("{count} {name}"));
    let _ = writeln!(text, "operators  {}", operators.collect::<Vec<_>>().join(", "));
    let _ = writeln!(text, "MACs       {} per frame", millions(facts.macs));
    let _ = writeln!(
        text,
        "memory     weights {}, kept tensors {}",
        DecimalBytes(facts.weight_bytes),
        DecimalBytes(facts.kept_bytes)
    );
    text
}

// SPDX-License-Identifier: MIT OR Apache-2.0
//! Every parameter and port of the Verilog is documented, and a parameter out of range does not
//! elaborate in Verilator, Icarus and Yosys.

mod cases;

use std::collections::BTreeSet;

use crate::common::{design, every_design};
use cases::{LimitCase, all_leaves, cases, with_default};
use foveate_emit::{Top, verilog};
use foveate_tools::{
    Cache, Source, Tool, ToolError, Toolchain,
    iverilog::{self, IverilogJob},
    testing::{require_tools, sample},
    verilator,
    yosys::{self, YosysJob},
};
use rayon::prelude::*;

const TOOLS: &[Tool] = &[Tool::Verilator, Tool::Iverilog, Tool::Yosys];

/// Returns the message of a tool if it reports an error.
fn error_message<T>(result: Result<T, ToolError>) -> Option<String> {
    result.err().map(|error| match error {
        ToolError::Failed { full, .. } => full,
        other => other.to_string(),
    })
}

fn verilator_error(sources: &[Source], top: &str) -> Option<String> {
    error_message(verilator::lint(&Toolchain::system(), sources, top, None))
}

fn icarus_error(sources: &[Source], top: &str) -> Option<String> {
    let job = IverilogJob {
        sources: sources.to_vec(),
        top: top.to_owned(),
        strict: true,
        ..IverilogJob::default()
    };
    error_message(iverilog::compile(&Toolchain::system(), &Cache::temporary().unwrap(), &job))
}

/// Returns the error of Yosys, if any; `before` holds commands between reading and elaboration.
fn yosys_error(sources: &[Source], before: &str, top: &str) -> Option<String> {
    let names: Vec<&str> = sources.iter().map(|(name, _)| name.as_str()).collect();
    let script = format!("read_verilog {}\n{before}hierarchy -check -top {top}\n", names.join(" "));
    let job = YosysJob { sources: sources.to_vec(), script, outputs: Vec::new() };
    error_message(yosys::run(&Toolchain::system(), &Cache::temporary().unwrap(), &job))
}

/// Returns what is wrong with the answer of a tool, if anything.
fn problem(tool: Tool, refused: Option<&str>, said: Option<String>) -> Option<String> {
    match (refused, said) {
        (None, None) => None,
        (None, Some(said)) => Some(format!("{tool} refuses what is in range: {said}")),
        (Some(name), None) => Some(format!("{tool} takes it, and not {name}")),
        (Some(name), Some(said)) => {
            (!said.contains(name)).then(|| format!("{tool} does not name {name}: {said}"))
        }
    }
}

/// Returns what is wrong with the answers of all tools.
fn problems(sources: &[Source], top: &str, refused: Option<&str>) -> Vec<String> {
    let answers = [
        (Tool::Verilator, verilator_error(sources, top)),
        (Tool::Iverilog, icarus_error(sources, top)),
        (Tool::Yosys, yosys_error(sources, "", top)),
    ];
    answers.into_iter().filter_map(|(tool, said)| problem(tool, refused, said)).collect()
}

/// Verilator stops at the first module that does not exist, so each case is a run of its own.
/// Icarus names all of them in one run; see [`parameters_out_of_range_are_refused_together`].
#[test]
fn parameters_out_of_range_are_refused_one_by_one() {
    if !require_tools(TOOLS) {
        return;
    }
    let check = |case: &LimitCase| {
        let (sources, top) = (case.sources(), case.module.as_str());
        let found = match case.refusing_limit.as_deref() {
            None => problems(&sources, top, None),
            refused => problem(Tool::Verilator, refused, verilator_error(&sources, top))
                .into_iter()
                .collect(),
        };
        (!found.is_empty())
            .then(|| format!("{} {:?}: {}", case.module, case.parameters, found.join("; ")))
    };
    let cases = sample(cases(), 9);
    let failures: Vec<String> = cases.par_iter().filter_map(check).collect();
    assert!(failures.is_empty(), "{}", failures.join("\n"));
}

/// All cases out of range are in one elaboration, in Icarus and in Yosys; a fourth of them in most
/// runs.
#[test]
fn parameters_out_of_range_are_refused_together() {
    if !require_tools(TOOLS) {
        return;
    }
    let cases = cases();
    let refused =
        cases.iter().filter_map(|case| case.refusing_limit.as_ref().map(|limit| (case, limit)));
    let named: Vec<(String, &LimitCase, &String)> = sample(refused, 4)
        .into_iter()
        .enumerate()
        .map(|(number, (case, limit))| (format!("case_{number}"), case, limit))
        .collect();
    let modules: String = named.iter().map(|(name, case, _)| case.renamed_text(name)).collect();
    let instances: String =
        named.iter().map(|(name, ..)| format!("    {name} u_{name} ();\n")).collect();
    let copies = ("cases.v".to_owned(), modules);
    let top = ("top.v".to_owned(), format!("module top;\n{instances}endmodule\n"));
    let leaves =
        all_leaves().map(|leaf| (format!("rtl/{}.v", leaf.name), leaf.contents.to_owned()));

    let all: Vec<Source> = [copies.clone(), top].into_iter().chain(leaves).collect();
    let icarus = icarus_error(&all, "top").unwrap_or_default();
    let missing: BTreeSet<&str> = icarus.split_whitespace().collect();
    // Yosys elaborates each module as it reads it, and later stops at the first module that does
    // not exist. The missing modules that the copies instantiate are printed before, as
    // `cell \MODULE \INSTANCE`.
    let yosys = yosys_error(&[copies], "dump t:*_must_*\n", "case_0").unwrap_or_default();
    let cells: BTreeSet<&str> = yosys.split_whitespace().collect();
    let of_first = format!("Module `\\{}_case_0' referenced in module `\\case_0'", named[0].2);
    let mut wrong = Vec::new();
    if !yosys.contains(&of_first) || !yosys.contains("is not part of the design") {
        wrong
            .push(format!("{} does not refuse a module that does not exist: {yosys}", Tool::Yosys));
    }
    for (name, LimitCase { module, parameters, .. }, limit) in &named {
        if !missing.contains(format!("{limit}_{name}").as_str()) {
            wrong
                .push(format!("{module} {parameters:?}: {} does not name {limit}", Tool::Iverilog));
        }
        if !cells.contains(format!("\\{limit}_{name}").as_str()) {
            wrong.push(format!("{module} {parameters:?}: {} has no {limit}", Tool::Yosys));
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

/// The tops of all organizations refuse grids without regions, with fewer regions than a lane has,
/// or with more than a frame can have. Grids of a serial array break other limits, too, and
/// messages are truncated, so it is enough that one limit is named.
#[test]
fn grids_out_of_range_are_refused() {
    if !require_tools(TOOLS) {
        return;
    }
    let pipelined = "[frame]\nwidth = 16\nheight = 8\n";
    let serial = format!("{pipelined}[hardware]\norganization = 'serial'\nfold = 2\n");
    let any = Some("_must_be_");
    // The contract and the raster core limit the size of a frame. With regions of 64 pixels, a wide
    // frame has few regions.
    let large = "denoise.filter = 'none'\nregion.size = 64\nframe = { width = 256, height = 64 }\n";
    let lanes = format!("{large}hardware.organization = 'serial'\n");
    let raster = format!("{large}hardware.organization = 'raster'\n");
    let cases = [
        (pipelined, Top::Rcm, "3", "2", None),
        (pipelined, Top::Rcm, "0", "1", Some("COLUMNS_must_be_1_or_more")),
        (pipelined, Top::Rcm, "1", "0", Some("ROWS_must_be_1_or_more")),
        (&serial, Top::Rcm, "3", "2", None),
        (&serial, Top::Rcm, "0", "1", any),
        (&serial, Top::Rcm, "1", "0", any),
        (&serial, Top::Rcm, "1", "1", any),
        (large, Top::Rcm, "257", "1", Some("COLUMNS_must_be_256_or_less")),
        (large, Top::Rcm, "1", "257", Some("ROWS_must_be_256_or_less")),
        (&lanes, Top::Rcm, "257", "1", Some("COLUMNS_must_be_256_or_less")),
        (&lanes, Top::Rcm, "1", "257", Some("ROWS_must_be_256_or_less")),
        (&raster, Top::Rcm, "128", "256", None),
        (&raster, Top::Rcm, "129", "1", Some("FRAME_WIDTH_must_be_8192_or_less")),
        (&raster, Top::Rcm, "4", "257", Some("FRAME_HEIGHT_must_be_16384_or_less")),
        (&raster, Top::Rcm, "3", "1", Some("COLUMNS_must_be_4_or_more")),
        (&raster, Top::Rcm, "4", "0", any),
        (&serial, Top::Rpu, "2", "1", None),
        (&serial, Top::Rpu, "1", "1", any),
    ];
    for (toml, top, columns, rows, refused) in sample(cases, 5) {
        let mut files = verilog(&design(toml), top);
        let file = files.last_mut().unwrap();
        file.contents = with_default(&file.contents, "COLUMNS", columns);
        file.contents = with_default(&file.contents, "ROWS", rows);
        let sources: Vec<Source> = files.into_iter().map(|f| (f.path, f.contents)).collect();
        let found = problems(&sources, top.module(), refused);
        assert!(found.is_empty(), "{toml}{columns}x{rows}: {}", found.join("; "));
    }
}

/// A limit without a case might refuse nothing, or everything.
#[test]
fn every_limit_has_a_case_and_every_module_with_limits_a_control() {
    let cases = cases();
    for leaf in all_leaves() {
        let words = leaf.contents.split_whitespace();
        let limits: BTreeSet<&str> = words.filter(|word| word.contains("_must_")).collect();
        let own = || cases.iter().filter(|case| case.module == leaf.name);
        let tried: BTreeSet<&str> =
            own().filter_map(|case| case.refusing_limit.as_deref()).collect();
        assert_eq!(limits, tried, "{}", leaf.name);
        let controls = own().filter(|case| case.refusing_limit.is_none()).count();
        assert_eq!(controls, usize::from(!limits.is_empty()), "{}", leaf.name);
    }
}

/// Returns the lines of a module's header that declare something without a comment.
fn undocumented_lines(text: &str) -> Vec<&str> {
    let header = text.split_once("\nmodule ").unwrap().1.split_once("\n);").unwrap().0;
    let declares = |line: &&str| {
        let start = line.trim_start();
        ["parameter ", "input ", "output "].iter().any(|word| start.starts_with(word))
    };
    let silent =
        |line: &&str| line.split_once("//").is_none_or(|(_, comment)| comment.trim().is_empty());
    header.lines().filter(declares).filter(silent).collect()
}

#[test]
fn every_parameter_and_port_is_documented() {
    for leaf in all_leaves() {
        assert_eq!(undocumented_lines(leaf.contents), Vec::<&str>::new(), "{}", leaf.name);
    }
    for toml in every_design() {
        let design = design(&toml);
        for &top in Top::all_of(&design) {
            let files = verilog(&design, top);
            let top_file = &files.last().unwrap().contents;
            assert_eq!(undocumented_lines(top_file), Vec::<&str>::new(), "{toml}");
        }
    }
    let planted = "\nmodule m #(\n    parameter A = 1\n) (\n    input wire b,  // so\n    output wire c  //\n);\n";
    assert_eq!(undocumented_lines(planted).len(), 2);
}

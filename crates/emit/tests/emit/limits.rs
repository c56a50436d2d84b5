// SPDX-License-Identifier: MIT OR Apache-2.0
//! Every parameter and port of the Verilog is documented, and a parameter out of range does not elaborate, in
//! Verilator, Icarus and Yosys alike.

use std::collections::BTreeSet;

use crate::common::{design, every_design};
use foveate_emit::{LEAVES, Leaf, Top, verilog};
use foveate_toolchain::iverilog::{self, IverilogJob};
use foveate_toolchain::testing::require_tools;
use foveate_toolchain::yosys::{self, YosysJob};
use foveate_toolchain::{Cache, Source, Tool, Toolchain, verilator};
use rayon::prelude::*;

const TOOLS: &[Tool] = &[Tool::Verilator, Tool::Iverilog, Tool::Yosys];

/// A module with other parameters than its defaults.
struct Case {
    module: String,
    /// Names and values.
    parameters: Vec<(String, String)>,
    /// The module that refuses them; none if they are in range.
    refused: Option<String>,
}

/// The lines of `limits.txt`. Parameters of a line that must elaborate hold for those below it, too.
fn cases() -> Vec<Case> {
    let mut list: Vec<Case> = Vec::new();
    let mut common: Vec<(String, String)> = Vec::new();
    let lines = include_str!("limits.txt").lines().map(str::trim);
    for line in lines.filter(|line| !line.is_empty() && !line.starts_with('#')) {
        let mut parts = line.split('|').map(str::trim);
        let module = parts.next().unwrap().to_owned();
        let own = parts.next().unwrap_or_default().split_whitespace().map(|pair| {
            let (name, value) = pair.split_once('=').unwrap_or_else(|| panic!("{line}"));
            (name.to_owned(), value.to_owned())
        });
        let own: Vec<_> = own.collect();
        let refused = parts.next().map(str::to_owned);
        let mut parameters = own.clone();
        match refused {
            None => common.clone_from(&own),
            Some(_) => {
                let first = |name: &String| own.iter().all(|(given, _)| given != name);
                parameters.extend(common.iter().filter(|(name, _)| first(name)).cloned());
            }
        }
        list.push(Case { module, parameters, refused });
    }
    list
}

/// The text of a module with another default of a parameter.
fn with_default(text: &str, name: &str, value: &str) -> String {
    let start = format!(" {name} = ");
    let line = text.lines().find(|line| line.contains("parameter ") && line.contains(&start));
    let line = line.unwrap_or_else(|| panic!("no parameter {name}"));
    let (before, after) = line.split_once(&start).unwrap();
    let end = after.find([',', ' ']).unwrap_or(after.len());
    text.replacen(line, &format!("{before}{start}{value}{}", &after[end..]), 1)
}

fn leaf(name: &str) -> &'static Leaf {
    LEAVES.iter().find(|leaf| leaf.name == name).unwrap_or_else(|| panic!("no leaf {name}"))
}

/// A leaf and all that it instantiates, with the parameters of a case.
fn sources(case: &Case) -> Vec<Source> {
    let mut names: Vec<&str> = vec![leaf(&case.module).name];
    let mut at = 0;
    while let Some(name) = names.get(at) {
        let uses = leaf(name).uses.iter().filter(|used| !names.contains(used));
        let uses: Vec<&str> = uses.copied().collect();
        names.extend(uses);
        at += 1;
    }
    let text = |name: &str| {
        let text = leaf(name).contents.to_owned();
        if name != case.module {
            return text;
        }
        let parameters = case.parameters.iter();
        parameters.fold(text, |text, (name, value)| with_default(&text, name, value))
    };
    names.iter().map(|name| (format!("rtl/{name}.v"), text(name))).collect()
}

/// What each tool says against a module; nothing if it elaborates.
fn said(sources: &[Source], top: &str) -> [(Tool, Option<String>); 3] {
    let (toolchain, cache) = (Toolchain::system(), Cache::throw_away().unwrap());
    let verilator = verilator::lint(&toolchain, sources, top, None).err();
    let job = IverilogJob {
        sources: sources.to_vec(),
        top: top.to_owned(),
        strict: true,
        ..IverilogJob::default()
    };
    let icarus = iverilog::compile(&toolchain, &cache, &job).err();
    let names: Vec<&str> = sources.iter().map(|(name, _)| name.as_str()).collect();
    let script = format!("read_verilog {}\nhierarchy -check -top {top}\n", names.join(" "));
    let job = YosysJob { sources: sources.to_vec(), script, outputs: Vec::new() };
    let yosys = yosys::run(&toolchain, &cache, &job).err();
    [
        (Tool::Verilator, verilator.map(|error| error.to_string())),
        (Tool::Iverilog, icarus.map(|error| error.to_string())),
        (Tool::Yosys, yosys.map(|error| error.to_string())),
    ]
}

/// What is wrong with the answers of the tools.
fn problems(sources: &[Source], top: &str, refused: Option<&str>) -> Vec<String> {
    let wrong = |(tool, said): (Tool, Option<String>)| match (refused, said) {
        (None, None) => None,
        (None, Some(said)) => Some(format!("{tool} refuses what is in range: {said}")),
        (Some(name), None) => Some(format!("{tool} takes it, and not {name}")),
        (Some(name), Some(said)) => {
            (!said.contains(name)).then(|| format!("{tool} does not name {name}: {said}"))
        }
    };
    said(sources, top).into_iter().filter_map(wrong).collect()
}

#[test]
fn parameters_out_of_range_are_refused() {
    if !require_tools(TOOLS) {
        return;
    }
    let check = |case: &Case| {
        let found = problems(&sources(case), &case.module, case.refused.as_deref());
        (!found.is_empty())
            .then(|| format!("{} {:?}: {}", case.module, case.parameters, found.join("; ")))
    };
    let failures: Vec<String> = cases().par_iter().filter_map(check).collect();
    assert!(failures.is_empty(), "{}", failures.join("\n"));
}

/// The tops of all organizations: grids that are none, or that have fewer regions than a lane, or more than a frame
/// has. In a serial one other limits are hurt, too, and messages are cut: it is enough that one of them is named.
#[test]
fn grids_out_of_range_are_refused() {
    if !require_tools(TOOLS) {
        return;
    }
    let pipelined = "[frame]\nwidth = 16\nheight = 8\n";
    let serial = format!("{pipelined}[hardware]\norganization = 'serial'\nfold = 2\n");
    let any = Some("_must_be_");
    // Frames of contract and raster core are limited; regions of 64 pixels make few of a wide one.
    let large = "denoise.filter = 'none'\nregion.size = 64\nframe = { width = 256, height = 64 }\n";
    let lanes = format!("{large}hardware.organization = 'serial'\n");
    let raster = format!("{large}hardware.organization = 'raster'\n");
    for (toml, top, columns, rows, refused) in [
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
    ] {
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
    for leaf in LEAVES {
        let words = leaf.contents.split_whitespace();
        let limits: BTreeSet<&str> = words.filter(|word| word.contains("_must_")).collect();
        let own = || cases.iter().filter(|case| case.module == leaf.name);
        let tried: BTreeSet<&str> = own().filter_map(|case| case.refused.as_deref()).collect();
        assert_eq!(limits, tried, "{}", leaf.name);
        let controls = own().filter(|case| case.refused.is_none()).count();
        assert_eq!(controls, usize::from(!limits.is_empty()), "{}", leaf.name);
    }
}

/// Lines of a module's header that declare something and say nothing about it.
fn undocumented(text: &str) -> Vec<&str> {
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
    for leaf in LEAVES {
        assert_eq!(undocumented(leaf.contents), Vec::<&str>::new(), "{}", leaf.name);
    }
    for toml in every_design() {
        let design = design(&toml);
        for &top in Top::all_of(&design) {
            let files = verilog(&design, top);
            let top_file = &files.last().unwrap().contents;
            assert_eq!(undocumented(top_file), Vec::<&str>::new(), "{toml}");
        }
    }
    let planted = "\nmodule m #(\n    parameter A = 1\n) (\n    input wire b,  // so\n    output wire c  //\n);\n";
    assert_eq!(undocumented(planted).len(), 2);
}

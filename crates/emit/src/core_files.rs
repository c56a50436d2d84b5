// SPDX-License-Identifier: MIT OR Apache-2.0
//! The files of a core apart from its Verilog: file lists, FuseSoC, constraints, Vivado, and the
//! script that runs the benches. The README is in [`crate::readme`].

use crate::axi;
use crate::organization::emitter;
use crate::top::{self, AXI_TOP, CLOCK};
use crate::verilog_text::rendered_text;
use crate::{Prefix, SourceFile, Top, banner, synthesis_scripts, verilog};
use askama::Template;
use foveate_design::{ArrayStructure, Design};

#[derive(Template)]
#[template(path = "fusesoc.core")]
struct FuseSocFile<'a> {
    banner: String,
    version: &'static str,
    name: String,
    before: String,
    /// The module that is synthesized.
    whole: String,
    has_rpu: bool,
    on_axi: bool,
    columns: u32,
    rows: u32,
    n: u32,
    files: Vec<&'a str>,
    /// The options of nextpnr for the first device of each family.
    ecp5: String,
    ice40: String,
}

#[derive(Template)]
#[template(path = "replay.sh")]
struct ReplayScript {
    banner: String,
    /// The beginning of the names of file lists and benches: the prefix and its `_`.
    before: String,
    has_rpu: bool,
    simulator: &'static str,
}

#[derive(Template)]
#[template(path = "vivado_ooc.tcl")]
struct VivadoScript {
    banner: String,
    before: String,
    /// The module that is synthesized if the user names none.
    whole: &'static str,
    has_rpu: bool,
    on_axi: bool,
}

/// The clocks of a frame, summed over all lanes, above which a bench runs longer in Icarus than
/// Verilator takes to compile it.
const ICARUS_CLOCKS: u64 = 40_000;

/// Returns every file of the core of `design`, except its benches and its timing diagram, which
/// need the model. The names of modules begin with `prefix`.
#[must_use]
pub fn core_files(design: &Design, prefix: &Prefix) -> Vec<SourceFile> {
    let (mut files, mut lists) = (Vec::<SourceFile>::new(), Vec::new());
    let tops = Top::all_of(design).iter().rev().map(|&top| (top.module(), verilog(design, top)));
    for (module, sources) in tops.chain(axi::axi_modules(design).map(|sources| (AXI_TOP, sources)))
    {
        let sources = prefix.apply(sources);
        let path = prefix.prefixed_name(&format!("{module}.f"));
        lists.push(SourceFile { path, contents: file_list(&sources) });
        // The array of a serial core does not contain the module `rpu`, so the tops have files in
        // common and files of their own.
        let is_new = |file: &SourceFile| files.iter().all(|known| known.path != file.path);
        let new: Vec<_> = sources.into_iter().filter(is_new).collect();
        files.extend(new);
    }
    let paths: Vec<_> = files.iter().map(|file| file.path.as_str()).collect();
    let vivado = VivadoScript {
        banner: banner(design),
        before: prefix.prefixed_name(""),
        whole: top::core_top(design),
        has_rpu: Top::has_rpu(design),
        on_axi: design.is_on_axi(),
    };
    let beside = [
        ("foveate_rcm.core".to_owned(), rendered_text(&fusesoc_file(design, prefix, paths))),
        ("vivado_ooc.tcl".to_owned(), rendered_text(&vivado)),
        ("design.toml".to_owned(), design_toml(design)),
        ("tb/replay.sh".to_owned(), rendered_text(&replay_script(design, prefix))),
        ("README.md".to_owned(), emitter(design).readme(prefix)),
    ];
    files.extend(axi::axi_software(design));
    files.extend(axi::package_ip_script(design, prefix));
    files.extend(lists);
    files.extend(synthesis_scripts::synthesis_files(design, prefix));
    files.extend(constraints(design));
    files.extend(beside.map(|(path, contents)| SourceFile { path, contents }));
    files
}

fn replay_script(design: &Design, prefix: &Prefix) -> ReplayScript {
    let unit = design.unit();
    let lanes = match unit.array {
        // The bench simulates only a few copies.
        ArrayStructure::RpuCopies => 1,
        ArrayStructure::SharedLogic => u64::from(unit.count),
    };
    let is_long = design.timing().clocks_per_frame().saturating_mul(lanes) > ICARUS_CLOCKS;
    ReplayScript {
        banner: banner(design),
        before: prefix.prefixed_name(""),
        has_rpu: Top::has_rpu(design),
        simulator: if is_long { "verilator" } else { "iverilog" },
    }
}

/// Returns the constraints of the core's clock, and of the array's clock where it has another name.
fn constraints(design: &Design) -> Vec<SourceFile> {
    let of = |path: &str, clock: &str| SourceFile {
        path: format!("constraints/{path}"),
        contents: include_str!("../constraints/ooc.xdc").replace(CLOCK, clock),
    };
    let array = design.is_on_axi().then(|| of("rcm_ooc.xdc", CLOCK));
    [of("ooc.xdc", top::core_clock(design))].into_iter().chain(array).collect()
}

fn file_list(files: &[SourceFile]) -> String {
    files.iter().map(|file| format!("{}\n", file.path)).collect()
}

fn design_toml(design: &Design) -> String {
    format!("# {}\n\n{}", banner(design), design.config().to_toml())
}

fn fusesoc_file<'a>(design: &Design, prefix: &Prefix, files: Vec<&'a str>) -> FuseSocFile<'a> {
    FuseSocFile {
        banner: banner(design),
        version: env!("CARGO_PKG_VERSION"),
        // The name differs between any two designs, and between any two prefixes of one design.
        name: prefix.prefixed_name(&design.fingerprint()),
        before: prefix.prefixed_name(""),
        whole: prefix.prefixed_name(top::core_top(design)),
        has_rpu: Top::has_rpu(design),
        on_axi: design.is_on_axi(),
        columns: design.columns(),
        rows: design.rows(),
        n: design.region_size(),
        files,
        ecp5: synthesis_scripts::nextpnr_options(&synthesis_scripts::ECP5),
        ice40: synthesis_scripts::nextpnr_options(&synthesis_scripts::ICE40),
    }
}

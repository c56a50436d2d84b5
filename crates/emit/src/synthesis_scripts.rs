// SPDX-License-Identifier: MIT OR Apache-2.0
//! Scripts that place and route a core with open tools, so that users can reproduce the clock
//! frequencies that Foveate prints.
//!
//! The scripts do the same as `foveate estimate --place-and-route`. A core has more ports than a
//! device has pins, so a module around it connects each bit to a register of the device.

use super::verilog_text::WrappedPort;
use crate::top::{self, AXI_CLOCK, AXI_TOP, CLOCK};
use crate::verilog_text::rendered_text;
use crate::{Prefix, SourceFile, Top, axi, banner};
use askama::Template;
use foveate_design::{Design, PortRole};

/// The settings in which the scripts of different families of devices differ.
pub(crate) struct DeviceFamily {
    name: &'static str,
    script: &'static str,
    nextpnr: &'static str,
    /// The commands of Yosys before the Verilog is read, each with its newline.
    before_reading: &'static str,
    /// The commands of Yosys before the synthesis, each with its newline.
    before_synthesis: &'static str,
    /// An instance of a register with bit `i` of `d_i` and `q_o`.
    cell: &'static str,
    devices: &'static [Device],
}

/// A device, with its options for Yosys and nextpnr. Its name is that of
/// `foveate estimate --place-and-route`.
struct Device {
    name: &'static str,
    synthesis: &'static str,
    part: &'static str,
}

const fn device(name: &'static str, synthesis: &'static str, part: &'static str) -> Device {
    Device { name, synthesis, part }
}

pub(crate) const ECP5: DeviceFamily = DeviceFamily {
    name: "ECP5",
    script: "ecp5",
    nextpnr: "nextpnr-ecp5",
    // The macro selects the block RAM's own output register, which synthesis does not use by
    // itself.
    before_reading: "verilog_defines -DFOVEATE_ECP5\n",
    before_synthesis: "",
    cell: "TRELLIS_FF #(\n                .CEMUX(\"1\"), .CLKMUX(\"CLK\"), .GSR(\"DISABLED\"), .LSRMUX(\"LSR\"), \
           .REGSET(\"RESET\")\n            ) u_bit (.CLK(clk_i), .DI(d_i[i]), .Q(q_o[i]));",
    devices: &[
        device(
            "ecp5-85k",
            "synth_ecp5 -abc9",
            "--85k --package CABGA381 --speed 6 --lpf-allow-unconstrained --freq 400",
        ),
        device(
            "ecp5-45k",
            "synth_ecp5 -abc9",
            "--45k --package CABGA381 --speed 6 --lpf-allow-unconstrained --freq 400",
        ),
        device(
            "ecp5-25k",
            "synth_ecp5 -abc9",
            "--25k --package CABGA381 --speed 6 --lpf-allow-unconstrained --freq 400",
        ),
        device(
            "ecp5-85k-8",
            "synth_ecp5 -abc9",
            "--85k --package CABGA381 --speed 8 --lpf-allow-unconstrained --freq 400",
        ),
    ],
};

pub(crate) const ICE40: DeviceFamily = DeviceFamily {
    name: "iCE40",
    script: "ice40",
    nextpnr: "nextpnr-ice40",
    before_reading: "",
    // Read-only tables cannot be memories on this family.
    before_synthesis: "setattr -unset ram_style */m:*\n",
    cell: "SB_DFF u_bit (.C(clk_i), .D(d_i[i]), .Q(q_o[i]));",
    devices: &[
        device(
            "up5k",
            "synth_ice40 -device u -spram -dsp",
            "--up5k --package sg48 --pcf-allow-unconstrained --freq 100",
        ),
        device(
            "hx8k",
            "synth_ice40 -device hx",
            "--hx8k --package ct256 --pcf-allow-unconstrained --freq 200",
        ),
        device(
            "hx4k",
            "synth_ice40 -device hx",
            "--hx4k --package tq144 --pcf-allow-unconstrained --freq 200",
        ),
        device(
            "hx1k",
            "synth_ice40 -device hx",
            "--hx1k --package tq144 --pcf-allow-unconstrained --freq 200",
        ),
    ],
};

#[derive(Template)]
#[template(path = "synth.sh")]
struct SynthesisScript {
    banner: String,
    before: String,
    family: &'static str,
    script: &'static str,
    nextpnr: &'static str,
    before_reading: &'static str,
    before_synthesis: &'static str,
    devices: &'static [Device],
    names: String,
    /// The module that is placed if the user names none.
    top: &'static str,
    has_rpu: bool,
    on_axi: bool,
}

#[derive(Template)]
#[template(path = "synth.tcl")]
struct YosysScript {
    banner: String,
    /// The module that is placed.
    top: String,
    script: &'static str,
    before_reading: &'static str,
    before_synthesis: &'static str,
    devices: &'static [Device],
}

#[derive(Template)]
#[template(path = "registers.v")]
struct PortRegisters {
    banner: String,
    before: String,
    family: &'static str,
    cell: &'static str,
}

#[derive(Template)]
#[template(path = "ports.v")]
struct PortWrapper {
    banner: String,
    before: String,
    module: String,
    /// The clock port of the module.
    clock: &'static str,
    ports: Vec<WrappedPort>,
}

/// Returns the options of nextpnr for the first device of a family, as a list for FuseSoC.
pub(crate) fn nextpnr_options(family: &DeviceFamily) -> String {
    let words = family.devices[0].part.split(' ').chain(["--timing-allow-fail"]);
    words.map(|word| format!("'{word}'")).collect::<Vec<_>>().join(", ")
}

/// Returns the scripts of a core and the files that they read, in the folder `synth`.
pub(crate) fn synthesis_files(design: &Design, prefix: &Prefix) -> Vec<SourceFile> {
    let before = || prefix.prefixed_name("");
    let file = |name: String, contents| SourceFile { path: format!("synth/{name}"), contents };
    let mut files = Vec::new();
    for family in [ECP5, ICE40] {
        let names: Vec<&str> = family.devices.iter().map(|device| device.name).collect();
        let script = SynthesisScript {
            banner: banner(design),
            before: before(),
            family: family.name,
            script: family.script,
            nextpnr: family.nextpnr,
            before_reading: family.before_reading,
            before_synthesis: family.before_synthesis,
            devices: family.devices,
            names: names.join(", "),
            top: top::placed_top(design),
            has_rpu: Top::has_rpu(design),
            on_axi: design.is_on_axi(),
        };
        let tcl = YosysScript {
            banner: banner(design),
            top: prefix.prefixed_name(top::core_top(design)),
            script: family.script,
            before_reading: family.before_reading,
            before_synthesis: family.before_synthesis,
            devices: family.devices,
        };
        let registers = PortRegisters {
            banner: banner(design),
            before: before(),
            family: family.name,
            cell: family.cell,
        };
        files.push(file(format!("{}.sh", family.script), rendered_text(&script)));
        files.push(file(format!("{}.tcl", family.script), rendered_text(&tcl)));
        files.push(file(format!("{}_registers.v", family.script), rendered_text(&registers)));
    }
    let arrays = Top::all_of(design).iter().map(|top| {
        let ports = top.ports(design);
        let wrapped = ports.iter().filter(|port| port.role != PortRole::Clock);
        (top.module(), CLOCK, wrapped.map(WrappedPort::of).collect())
    });
    let on_bus = axi::axi_ports(design).map(|ports| (AXI_TOP, AXI_CLOCK, ports));
    for (module, clock, ports) in arrays.chain(on_bus) {
        let module = prefix.prefixed_name(module);
        let name = format!("{module}_ports.v");
        let around = PortWrapper { banner: banner(design), before: before(), module, clock, ports };
        files.push(file(name, rendered_text(&around)));
    }
    files
}

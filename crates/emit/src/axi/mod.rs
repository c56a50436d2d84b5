// SPDX-License-Identifier: MIT OR Apache-2.0
//! Generates a core on AXI: the module `rcm_axi` around the array, and its registers.

mod pages;
mod ports;
mod registers;
mod rpu_array;
mod top;
mod verilog;

pub use registers::{Field, Kind, Register, registers};
pub use rpu_array::{ARRAY_REGISTERS, array_registers, array_scores, array_software, array_table};

use crate::text::{file, text_of};
use crate::top::AXI_TOP;
use crate::wrapped::WrappedPort;
use crate::{Prefix, SourceFile, Top, banner, leaf, verilog as array};
use foveate_design::{Bus, Design, Hardware, RasterDesign};

/// The parts around the array in a core on AXI: the name of each part in reports, and its modules.
/// Apart from these parts, the top itself has only the time and three counters.
pub const AXI_PARTS: [(&str, &[&str]); 4] = [
    ("registers", &[REGISTERS]),
    ("repair of frames", &["axi_video"]),
    ("packets", &["packet_rows", "packet_frames", "packet_writer"]),
    ("queue of regions", &["packet_regions"]),
];

/// The register module, which is made for each design from the table of its registers.
const REGISTERS: &str = "axi_registers";

/// Returns the modules of a core on AXI, the array included, each after those it instantiates.
/// Returns `None` for a design without a bus.
#[must_use]
pub fn on_bus(design: &Design) -> Option<Vec<SourceFile>> {
    let around = match (design.bus(), design.hardware()) {
        (Bus::Ports, _) | (Bus::Axi, Hardware::Pipelined(_) | Hardware::Serial(_)) => return None,
        (Bus::Axi, Hardware::Raster(own)) => around(design.on(own)),
    };
    let mut files = array(design, Top::Rcm);
    let is_new = |file: &SourceFile| files.iter().all(|known| known.path != file.path);
    let new: Vec<_> = around.into_iter().filter(is_new).collect();
    files.extend(new);
    Some(files)
}

/// Returns the files that software needs for a core on AXI: its registers as a page, a C header and
/// SystemRDL, and a driver in C. The list is empty for a design without a bus.
#[must_use]
pub fn software(design: &Design) -> Vec<SourceFile> {
    let Some(list) = register_table(design) else { return Vec::new() };
    let banner = banner(design);
    let files = [
        ("REGISTERS.md", pages::markdown(&banner, &list)),
        ("software/foveate_registers.h", pages::header(&banner, &list)),
        ("software/foveate.rdl", pages::rdl(&banner, &list)),
        ("software/foveate.h", include_str!("../../templates/software/foveate.h").to_owned()),
        ("software/foveate.c", include_str!("../../templates/software/foveate.c").to_owned()),
    ];
    files.map(|(path, contents)| SourceFile { path: path.to_owned(), contents }).into()
}

/// Returns the ports of a core on AXI without its clock, for a module around it. Returns `None` for
/// a design without a bus.
pub(crate) fn wrapped_ports(design: &Design) -> Option<Vec<WrappedPort>> {
    match (design.bus(), design.hardware()) {
        (Bus::Ports, _) | (Bus::Axi, Hardware::Pipelined(_) | Hardware::Serial(_)) => None,
        (Bus::Axi, Hardware::Raster(own)) => {
            Some(ports::wrapped(&text_of(&top::view(design.on(own)))))
        }
    }
}

/// Returns the script that packages a core on AXI as IP for Vivado. Returns `None` for a design
/// without a bus.
pub(crate) fn package_ip(design: &Design, prefix: &Prefix) -> Option<SourceFile> {
    let sources = prefix.apply(on_bus(design)?);
    let contents = pages::package_ip(
        &banner(design),
        &prefix.name(AXI_TOP),
        &sources,
        &register_table(design)?,
    );
    Some(SourceFile { path: "package_ip.tcl".to_owned(), contents })
}

/// Returns the registers of a core on AXI. Returns `None` for a design without a bus.
#[must_use]
pub fn register_table(design: &Design) -> Option<Vec<Register>> {
    match (design.bus(), design.hardware()) {
        (Bus::Ports, _) | (Bus::Axi, Hardware::Pipelined(_) | Hardware::Serial(_)) => None,
        (Bus::Axi, Hardware::Raster(own)) => Some(registers(design.on(own))),
    }
}

/// Returns the modules around the array: the leaves, the registers and the top.
fn around(design: RasterDesign<'_>) -> Vec<SourceFile> {
    let parts = AXI_PARTS.iter().flat_map(|(_, modules)| modules.iter().copied());
    let leaves = leaf::with_parts(parts.collect(), |_, _| true)
        .map(|leaf| file(leaf.name, leaf.contents.to_owned()));
    let registers = registers(design);
    let own = [
        file(REGISTERS, text_of(&verilog::view(&design, (REGISTERS, false), &registers))),
        file(AXI_TOP, text_of(&top::view(design))),
    ];
    leaves.chain(own).collect()
}

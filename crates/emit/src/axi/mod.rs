// SPDX-License-Identifier: MIT OR Apache-2.0
//! Generates a core on AXI: the module `rcm_axi` around the array, and its registers.

mod axi_top;
mod register_documents;
mod register_module;
mod registers;
mod rpu_array;

pub use registers::{FieldKind, Register, RegisterField, axi_registers};
pub use rpu_array::{ARRAY_REGISTERS, array_registers, array_scores, array_software, array_table};

use super::verilog_text::WrappedPort;
use crate::leaf_files::leaf_files;
use crate::top::AXI_TOP;
use crate::verilog_text::{module_file, rendered_text};
use crate::{Prefix, SourceFile, Top, banner, verilog as array};
use foveate_design::{Design, Hardware, InterfaceKind, RasterDesign};

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
pub fn axi_modules(design: &Design) -> Option<Vec<SourceFile>> {
    let around = match (design.interface_kind(), design.hardware()) {
        (InterfaceKind::Ports, _)
        | (InterfaceKind::Axi, Hardware::Pipelined(_) | Hardware::Serial(_)) => return None,
        (InterfaceKind::Axi, Hardware::Raster(own)) => {
            modules_around_array(design.with_hardware(own))
        }
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
pub fn axi_software(design: &Design) -> Vec<SourceFile> {
    let Some(list) = register_table(design) else { return Vec::new() };
    let banner = banner(design);
    let files = [
        ("REGISTERS.md", register_documents::register_page(&banner, &list)),
        ("software/foveate_registers.h", register_documents::c_header(&banner, &list)),
        ("software/foveate.rdl", register_documents::system_rdl(&banner, &list)),
        ("software/foveate.h", include_str!("../../templates/software/foveate.h").to_owned()),
        ("software/foveate.c", include_str!("../../templates/software/foveate.c").to_owned()),
    ];
    files.map(|(path, contents)| SourceFile { path: path.to_owned(), contents }).into()
}

/// Returns the ports of a core on AXI without its clock, for a module around it. Returns `None` for
/// a design without a bus.
pub(crate) fn axi_ports(design: &Design) -> Option<Vec<WrappedPort>> {
    match (design.interface_kind(), design.hardware()) {
        (InterfaceKind::Ports, _)
        | (InterfaceKind::Axi, Hardware::Pipelined(_) | Hardware::Serial(_)) => None,
        (InterfaceKind::Axi, Hardware::Raster(own)) => {
            Some(axi_top::header_ports(&rendered_text(&axi_top::view(design.with_hardware(own)))))
        }
    }
}

/// Returns the script that packages a core on AXI as IP for Vivado. Returns `None` for a design
/// without a bus.
pub(crate) fn package_ip_script(design: &Design, prefix: &Prefix) -> Option<SourceFile> {
    let sources = prefix.apply(axi_modules(design)?);
    let contents = register_documents::package_ip(
        &banner(design),
        &prefix.prefixed_name(AXI_TOP),
        &sources,
        &register_table(design)?,
    );
    Some(SourceFile { path: "package_ip.tcl".to_owned(), contents })
}

/// Returns the registers of a core on AXI. Returns `None` for a design without a bus.
#[must_use]
pub fn register_table(design: &Design) -> Option<Vec<Register>> {
    match (design.interface_kind(), design.hardware()) {
        (InterfaceKind::Ports, _)
        | (InterfaceKind::Axi, Hardware::Pipelined(_) | Hardware::Serial(_)) => None,
        (InterfaceKind::Axi, Hardware::Raster(own)) => {
            Some(axi_registers(design.with_hardware(own)))
        }
    }
}

/// Returns the modules around the array: the leaves, the registers and the top.
fn modules_around_array(design: RasterDesign<'_>) -> Vec<SourceFile> {
    let parts = AXI_PARTS.iter().flat_map(|(_, modules)| modules.iter().copied());
    let leaves = leaf_files(parts.collect());
    let registers = axi_registers(design);
    let own = [
        module_file(
            REGISTERS,
            rendered_text(&register_module::register_module(
                &design,
                (REGISTERS, false),
                &registers,
            )),
        ),
        module_file(AXI_TOP, rendered_text(&axi_top::view(design))),
    ];
    leaves.chain(own).collect()
}

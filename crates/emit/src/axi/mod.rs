// SPDX-License-Identifier: MIT OR Apache-2.0
//! A core on a bus: the module `rcm_axi` around the array, and its registers.

mod pages;
mod registers;
mod top;
mod verilog;

pub use registers::{Field, Kind, Register, registers};

use crate::text::{file, text_of};
use crate::{SourceFile, Top, banner, leaf, verilog as array};
use foveate_design::{Bus, Design, Hardware, RasterDesign};

/// The module on top of a core on a bus.
pub const AXI_TOP: &str = "rcm_axi";

/// The modules of a core on a bus, the array included, each after those it instantiates; none without a bus.
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

/// The registers of a core on a bus for those who use them: a page, a C header, SystemRDL; none without a bus.
pub(crate) fn register_files(design: &Design) -> Vec<SourceFile> {
    let list = match (design.bus(), design.hardware()) {
        (Bus::Ports, _) | (Bus::Axi, Hardware::Pipelined(_) | Hardware::Serial(_)) => {
            return Vec::new();
        }
        (Bus::Axi, Hardware::Raster(own)) => registers(design.on(own)),
    };
    let banner = banner(design);
    let files = [
        ("REGISTERS.md", pages::markdown(&banner, &list)),
        ("software/foveate_registers.h", pages::header(&banner, &list)),
        ("software/foveate.rdl", pages::rdl(&banner, &list)),
    ];
    files.map(|(path, contents)| SourceFile { path: path.to_owned(), contents }).into()
}

/// What stands around the array.
fn around(design: RasterDesign<'_>) -> Vec<SourceFile> {
    let leaves = ["axi_video", "packet_rows", "packet_regions", "packet_frames", "packet_writer"];
    let leaves = leaf::with_parts(leaves.to_vec(), |_, _| true)
        .map(|leaf| file(leaf.name, leaf.contents.to_owned()));
    let registers = registers(design);
    let own = [
        file("axi_registers", text_of(&verilog::view(&design, &registers))),
        file(AXI_TOP, text_of(&top::view(design))),
    ];
    leaves.chain(own).collect()
}

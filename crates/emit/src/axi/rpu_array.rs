// SPDX-License-Identifier: MIT OR Apache-2.0
//! The registers of an array of RPUs on a board (docs/boards.md): a table like that of a core on
//! AXI, and the files made from it.

use super::registers::{
    FieldKind, Register, RegisterField, common_registers, field, threshold_registers,
};
use super::{register_documents, register_module};
use crate::verilog_text::{module_file, rendered_text};
use crate::{SourceFile, banner};
use foveate_camera::bits_for;
use foveate_design::{Design, PipelinedDesign, Port, PortRole};

/// The module with the registers of an array.
pub const ARRAY_REGISTERS: &str = "array_registers";

/// The bits of a frame's number within the pattern, which repeats every 128 frames.
const PERIOD_BITS: u32 = 7;

/// The number of bits of a register.
const WORD_BITS: u32 = 32;

/// Returns the registers of an array of RPUs behind a pattern, by address.
#[must_use]
pub fn array_table(design: PipelinedDesign<'_>) -> Vec<Register> {
    let is_array = field("array", 16, 1, FieldKind::Constant(1), "1: the map of an array of RPUs");
    let mut list = common_registers(&design, vec![is_array]);
    let mut add = |address: u32, name: &str, doc: &str, fields: Vec<RegisterField>| {
        list.push(Register { name: name.to_owned(), address, fields, doc: doc.to_owned() });
    };
    let status = |width: u32, doc: &str| vec![field("value", 0, width, FieldKind::Status, doc)];
    let control = |name: &str, low: u32, width: u32, doc: &str| {
        field(name, low, width, FieldKind::Control { reset: 0 }, doc)
    };
    add(0x034, "frames", "whole frames", status(WORD_BITS, "modulo 2^32"));
    add(
        0x040,
        "capture_region",
        "the region to capture",
        vec![
            control("column", 0, 16, "column of the region"),
            control("row", 16, 16, "row of the region"),
        ],
    );
    let period = vec![control("value", 0, PERIOD_BITS, "number of the frame modulo 128")];
    add(0x044, "capture_frame", "the frame to capture", period);
    add(
        0x048,
        "capture",
        "control of a capture",
        vec![
            field("start", 0, 1, FieldKind::Command, "captures the next frame of that number"),
            field("captured", 1, 1, FieldKind::Status, "a capture is complete"),
        ],
    );
    add(
        0x04C,
        "captured_frame",
        "the captured frame",
        status(WORD_BITS, "number of the frame since reset"),
    );
    let bits = ["srs", "trs", "summary", "active"].into_iter().zip(0..);
    let mut decision: Vec<_> = bits
        .map(|(name, low)| field(name, low, 1, FieldKind::Status, "output of the RPU"))
        .collect();
    let values = bits_for(design.region_pixels().into());
    decision.push(field(
        "values",
        16,
        values,
        FieldKind::Status,
        "number of pixels or means that left",
    ));
    add(0x050, "captured_decision", "decision of the captured region", decision);
    let mut address = 0x054;
    for port in array_scores(&design) {
        let name = format!("captured_{}", port.name.trim_end_matches("_o"));
        let mut part = |name: &str, width: u32, doc: &str| {
            add(address, name, doc, status(width, "output of the RPU"));
            address += 4;
        };
        match port.width.checked_sub(WORD_BITS).filter(|more| *more > 0) {
            None => part(&name, port.width, "score of the captured region"),
            Some(more) => {
                part(&format!("{name}_low"), WORD_BITS, "score of the captured region, low bits");
                part(&format!("{name}_high"), more, "score of the captured region, high bits");
            }
        }
    }
    list.extend(threshold_registers(&design));
    list
}

/// Returns the port with the count of changed pixels, and then the ports with the scores of the
/// features.
#[must_use]
pub fn array_scores(design: &Design) -> Vec<Port> {
    let ports = design.rcm_ports();
    let features = design.features().iter().map(|feature| PortRole::Score(feature.kind()));
    let roles = std::iter::once(PortRole::TemporalCount).chain(features);
    roles.filter_map(|role| ports.iter().find(|port| port.role == role).cloned()).collect()
}

/// Returns the module with the registers of an array.
#[must_use]
pub fn array_registers(design: PipelinedDesign<'_>) -> SourceFile {
    let view =
        register_module::register_module(&design, (ARRAY_REGISTERS, true), &array_table(design));
    module_file(ARRAY_REGISTERS, rendered_text(&view))
}

/// Returns the files that software needs for the registers: a page, a C header and SystemRDL.
#[must_use]
pub fn array_software(design: PipelinedDesign<'_>) -> Vec<SourceFile> {
    let (banner, list) = (banner(&design), array_table(design));
    let files = [
        ("REGISTERS.md", register_documents::register_page(&banner, &list)),
        ("software/foveate_registers.h", register_documents::c_header(&banner, &list)),
        ("software/foveate.rdl", register_documents::system_rdl(&banner, &list)),
    ];
    files.map(|(path, contents)| SourceFile { path: path.to_owned(), contents }).into()
}

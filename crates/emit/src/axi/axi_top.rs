// SPDX-License-Identifier: MIT OR Apache-2.0
//! The outside of a core on AXI. Its ports are declared only in the filled template `axi.v`
//! ([`view`]), so they are read from its header ([`header_ports`]).

use super::registers::{fingerprint_number, irrelevant_code, raw_flag, thresholds};
use crate::banner;
use crate::top::AXI_CLOCK;
use crate::verilog_text::{PortLine, WrappedPort};
use askama::Template;
use foveate_camera::index_bits;
use foveate_design::{Port, PortRole, RasterDesign, StreamRole};

const PACKET_WORD_BITS: u32 = 64;

/// The number of words of a packet around its payload: its head and its tail.
const HEAD_AND_TAIL_WORDS: u32 = 2;

/// The number of payload words of a FRAME packet.
const FRAME_WORDS: u32 = 5;

/// The number of payload words of an END packet.
const END_WORDS: u32 = 1;

#[derive(Template)]
#[template(path = "axi.v")]
pub(super) struct AxiTop {
    banner: String,
    lanes: u32,
    pixel_bits: u32,
    word_bits: u32,
    video_bits: u32,
    width: u32,
    height: u32,
    words: u32,
    words_bits: u32,
    lines_bits: u32,
    columns: u32,
    rows: u32,
    column_bits: u32,
    region_bits: u32,
    side: u32,
    pixels: u32,
    means_side: u32,
    means: u32,
    has_means: bool,
    decision_bits: u32,
    bits: u32,
    part_bits: u32,
    row_words: u32,
    pixel_words: u32,
    mean_words: u32,
    pending_bits: u32,
    irrelevant: u32,
    raw: u32,
    fingerprint: String,
    syncs: bool,
    /// The bits of the number of a word of the map of classes, in a design with zones.
    class_address_bits: Option<u32>,
    thresholds: Vec<Port>,
    /// The outputs of the array that the top does not use.
    unused: Vec<Port>,
    /// The ports of the array that become ports of the core, too.
    array_ports_outside: Vec<PortLine>,
    /// The ports of the array, and the signals that they are connected to.
    connections: Vec<(String, String)>,
}

/// The payload sizes of the packets of a design, in words.
struct PacketSizes {
    row: u32,
    pixels: u32,
    means: u32,
    decision_bits: u32,
}

impl PacketSizes {
    fn of(design: RasterDesign<'_>) -> Self {
        let value_bits = value_bits(design);
        let values = |count: u32| (count * value_bits).div_ceil(PACKET_WORD_BITS);
        let blocks = design.periphery().map(|periphery| periphery.blocks);
        let decision_bits = if blocks.is_some() { 4 } else { 2 };
        Self {
            row: (design.columns() * decision_bits).div_ceil(PACKET_WORD_BITS),
            pixels: values(design.region_size().pow(2)),
            means: blocks.map_or(0, |blocks| values(blocks * blocks)),
            decision_bits,
        }
    }

    /// Returns the number of packet bits made per clock: 16 if at that rate all regions can leave
    /// in every frame, else 32.
    fn bits_per_clock(&self, design: RasterDesign<'_>) -> u32 {
        let clocks =
            |words: u32| u64::from((words + HEAD_AND_TAIL_WORDS) * (PACKET_WORD_BITS / 16) + 1);
        let frame = u64::from(design.rows())
            * (u64::from(design.columns()) * clocks(self.pixels) + clocks(self.row))
            + clocks(FRAME_WORDS)
            + clocks(END_WORDS);
        let region = u64::from(design.region_size().pow(2) / design.pixels_per_clock());
        if frame <= u64::from(design.regions()) * region { 16 } else { 32 }
    }
}

/// Returns the number of bits of a pixel in a packet.
fn value_bits(design: RasterDesign<'_>) -> u32 {
    if design.pixel_bits() <= 8 { 8 } else { 16 }
}

pub(super) fn view(design: RasterDesign<'_>) -> AxiTop {
    let packets = PacketSizes::of(design);
    let bits = packets.bits_per_clock(design);
    let parts = PACKET_WORD_BITS / bits;
    let most = [packets.row, packets.pixels, packets.means, FRAME_WORDS].into_iter().max();
    let word_bits = design.pixels_per_clock() * design.pixel_bits();
    let words = design.width().div_ceil(design.pixels_per_clock());
    let means_side = design.periphery().map_or(0, |periphery| periphery.blocks);
    let ports = design.rcm_ports();
    let outside: Vec<Port> =
        ports.iter().filter(|port| is_outside(design, port)).cloned().collect();
    AxiTop {
        banner: banner(&design),
        lanes: design.pixels_per_clock(),
        pixel_bits: design.pixel_bits(),
        word_bits,
        video_bits: word_bits.next_multiple_of(8),
        width: design.width(),
        height: design.height(),
        words,
        words_bits: index_bits(words.into()),
        lines_bits: index_bits(design.height().into()).max(1),
        columns: design.columns(),
        rows: design.rows(),
        column_bits: index_bits(design.columns().into()),
        region_bits: index_bits(design.regions().into()),
        side: design.region_size(),
        pixels: design.region_size().pow(2),
        means_side,
        means: means_side * means_side,
        has_means: means_side > 0,
        decision_bits: packets.decision_bits,
        bits,
        part_bits: index_bits(u64::from(most.unwrap_or(1) * parts)).max(parts.ilog2() + 3),
        row_words: packets.row,
        pixel_words: packets.pixels,
        mean_words: packets.means,
        // All regions in the buffer of three rows of regions may wait.
        pending_bits: index_bits(u64::from(3 * design.columns() + 1)) + 1,
        irrelevant: irrelevant_code(&design),
        raw: raw_flag(&design),
        fingerprint: format!("{:016x}", fingerprint_number(&design)),
        syncs: design.has_frame_sync(),
        class_address_bits: design.zones().map(|_| design.class_address_bits()),
        thresholds: thresholds(&design).into_iter().map(port_without_suffix).collect(),
        unused: ports
            .iter()
            .filter(|port| array_signal(design, port).starts_with("unused_"))
            .cloned()
            .collect(),
        array_ports_outside: with_final_comma(PortLine::aligned(&outside, |_| None)),
        connections: ports
            .iter()
            .map(|port| (port.name.clone(), array_signal(design, port)))
            .collect(),
    }
}

/// Returns the port of a threshold under its name without the suffix `_i`.
fn port_without_suffix(threshold: super::registers::ThresholdInput) -> Port {
    let name = threshold.port.name.trim_end_matches("_i").to_owned();
    Port { name, ..threshold.port }
}

/// Appends a comma to the last line, because more ports follow these lines.
fn with_final_comma(mut lines: Vec<PortLine>) -> Vec<PortLine> {
    if let Some(last) = lines.last_mut() {
        let width = last.declaration.len();
        let declaration = format!("{},", last.declaration.trim_end());
        last.declaration = format!("{declaration:width$}");
    }
    lines
}

/// Returns whether a port of the array is also a port of the core on AXI. These are the ports to a
/// frame store outside.
fn is_outside(design: RasterDesign<'_>, port: &Port) -> bool {
    let interface = design.rcm_interface();
    let stream = interface.stream_with_port(port.role).map(|stream| stream.role);
    matches!(stream, Some(StreamRole::References | StreamRole::StoredWords))
}

fn array_signal(design: RasterDesign<'_>, port: &Port) -> String {
    let own = match port.role {
        PortRole::Clock => "aclk",
        PortRole::Reset => "rst || forget",
        PortRole::Valid => "word_valid",
        PortRole::StartOfFrame => "word_first",
        PortRole::Pixel => "word",
        PortRole::Ready => "word_ready",
        PortRole::DecisionValid => "decision_valid",
        PortRole::Srs => "srs",
        PortRole::Trs => "trs",
        PortRole::Active => "active",
        PortRole::Summary => "summary",
        PortRole::ForwardValid => "forward_valid",
        PortRole::ForwardReady => "forward_ready",
        PortRole::ForwardRegion => "forward_region",
        PortRole::ForwardPixel => "forward_pixel",
        PortRole::ForwardFirst => "forward_first",
        PortRole::ForwardLast => "forward_last",
        PortRole::ForwardAbort => "forward_abort",
        PortRole::ForwardFrame => "forward_frame",
        PortRole::ForwardSummary => "forward_summary",
        PortRole::LostValid => "lost_valid",
        PortRole::LostFrame => "lost_frame",
        PortRole::ClassWrite => "zone_write",
        PortRole::ClassAddress => "zone_address_q",
        PortRole::ClassWord => "zone_word",
        PortRole::ClassCommit => "zone_commit",
        PortRole::ClassPending => "array_pending",
        // Decisions come in the order of the regions, so their numbers are not needed. Losses are
        // counted in this module. Scores and the other outputs are not sent.
        PortRole::Region
        | PortRole::SyncError
        | PortRole::Score(_)
        | PortRole::TemporalCount
        | PortRole::ForwardPosition
        | PortRole::Lost
        | PortRole::LostCount
        | PortRole::LostRegion => return format!("unused_{}", port.name),
        _ if is_outside(design, port) => &port.name,
        _ => port.name.trim_end_matches("_i"),
    };
    own.to_owned()
}

/// Returns the ports in the header of a filled `axi.v`, without its clock.
pub(super) fn header_ports(verilog: &str) -> Vec<WrappedPort> {
    let header = verilog.lines().take_while(|line| *line != ");");
    header.filter_map(declared_port).filter(|port| port.name != AXI_CLOCK).collect()
}

/// Parses the port that a line such as `input wire [11:0] s_axi_awaddr, // what it is` declares.
fn declared_port(line: &str) -> Option<WrappedPort> {
    let (direction, rest) = line.trim_start().split_once(" wire ")?;
    let input = match direction.trim_end() {
        "input" => true,
        "output" => false,
        _ => return None,
    };
    let (highest, name) = match rest.trim_start().strip_prefix('[') {
        Some(ranged) => ranged.split_once(":0]")?,
        None => ("0", rest),
    };
    let name = name.trim_start().split([',', ' ']).next()?;
    Some(WrappedPort::new(name, highest.trim_start().parse::<u32>().ok()? + 1, input))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ports_are_read_off_a_header() {
        let verilog = "// input  wire no_port\nmodule rcm_axi #(\n    parameter [31:0] TICK_RATE = 32'd1  // no port\n) (\n    \
             (* X_INTERFACE_INFO = \"x CLK\" *)\n    input  wire        aclk,       // clock\n    \
             output wire [ 7:0] tkeep_o,    // 8 bits\n    input  wire [31:0] data_i, // 32 bits\n    \
             output wire        interrupt_o // the last\n);\n    input wire [3:0] beyond,\n";
        let found = header_ports(verilog);
        let text = |port: &WrappedPort| format!("{} {} {}", port.name, port.bits, port.input);
        let expected = ["tkeep_o 8 false", "data_i 32 true", "interrupt_o 1 false"];
        assert_eq!(found.iter().map(text).collect::<Vec<_>>(), expected);
    }
}

// SPDX-License-Identifier: MIT OR Apache-2.0
//! The traffic on the buses of a core, in order, with the results that it must have
//! ([`Traffic`]). It is text for a C++ program ([`program`]), which drives the buses of the
//! model that Verilator makes of the Verilog.

use crate::harness::render;
use askama::Template;
use foveate_camera::RegionClass;
use foveate_design::RasterDesign;
use foveate_pixels::Frame;
use std::fmt::Write as _;
use std::ops::Range;

/// The strobes of all four bytes of a register.
pub(super) const ALL_BYTES: u32 = 0xF;

/// The expected treatment of a frame by the core.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum FrameFate {
    /// The frame must reach the array.
    Taken,
    /// The frame must not reach the array.
    LeftOut,
    /// The frame may be skipped, because the sink stalls.
    MaybeSkipped,
    /// The frame must be skipped, because packets of the frame before it wait.
    Skipped,
    /// A reset comes while the frame is sent.
    CutByReset,
}

/// A frame that was sent, in the form to which the core repairs it.
#[derive(Clone, Debug)]
pub(super) struct ExpectedFrame {
    pub(super) frame: Frame,
    pub(super) fate: FrameFate,
    /// True if the core has forgotten all frames before this one.
    pub(super) is_first: bool,
    /// The index of the camera whose thresholds hold for the frame.
    pub(super) camera_index: usize,
    pub(super) maps: FrameMaps,
}

/// The maps of classes that a frame may use. The version in its FRAME packet says which one it is.
/// Without any, the frame uses the map of the configuration, with version 0.
#[derive(Clone, Debug, Default)]
pub(super) struct FrameMaps {
    /// The version of the first map. The next ones have the next versions.
    pub(super) first_version: u16,
    pub(super) maps: Vec<Vec<RegionClass>>,
    /// True if the maps take turns without an end.
    pub(super) take_turns: bool,
}

impl FrameMaps {
    /// Returns true if the frame may have this version of the map.
    pub(super) fn admit(&self, version: u16) -> bool {
        self.map(version).is_some() || self.maps.is_empty() && version == 0
    }

    pub(super) fn map(&self, version: u16) -> Option<&[RegionClass]> {
        let behind = usize::from(version.wrapping_sub(self.first_version));
        let turn = if self.take_turns { behind % self.maps.len().max(1) } else { behind };
        self.maps.get(turn).map(Vec::as_slice)
    }
}

/// The expected value of a register.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum ExpectedRead {
    /// The given value.
    Value(u32),
    /// The number of frames skipped since reset.
    SkippedFrames,
    /// The number of regions dropped since reset.
    DroppedRegions,
    /// The given event bits, and the bits of skipped frames and of dropped regions and rows if
    /// there were any.
    Events(u32),
}

/// The expected number of rising edges of `interrupt_o` while an event is cleared again and again.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum ExpectedEventCount {
    /// The given number.
    Exactly(u32),
    /// One for every skipped frame.
    SkippedFrames,
    /// One for every dropped row.
    DroppedRows,
    /// At least one if a region was dropped, and at most one for each dropped region; two drops at
    /// successive clocks raise the interrupt once.
    DroppedRegions,
}

/// The traffic between two resets.
#[derive(Clone, Debug, Default)]
pub(super) struct BusSession {
    pub(super) frames: Vec<ExpectedFrame>,
    /// The registers that are read, in order, with their expected values.
    pub(super) reads: Vec<(u32, ExpectedRead)>,
    /// The events that are cleared again and again, in order, with the expected number of times
    /// that each is seen.
    pub(super) event_counts: Vec<(&'static str, ExpectedEventCount)>,
    /// True if packets must leave without a dropped region or row.
    pub(super) is_lossless: bool,
    /// True if no row may be dropped.
    pub(super) keeps_rows: bool,
}

/// The traffic as lines for the program, with the expected results.
#[derive(Clone, Debug)]
pub(super) struct Traffic<'a> {
    design: RasterDesign<'a>,
    text: String,
    sessions: Vec<BusSession>,
}

impl<'a> Traffic<'a> {
    /// Creates empty traffic. The first entry must be a reset.
    pub(super) fn new(design: RasterDesign<'a>) -> Self {
        Self { design, text: String::new(), sessions: Vec::new() }
    }

    pub(super) fn design(&self) -> RasterDesign<'a> {
        self.design
    }

    pub(super) fn text(&self) -> &str {
        &self.text
    }

    pub(super) fn sessions(&self) -> &[BusSession] {
        &self.sessions
    }

    pub(super) fn max_pixel(&self) -> u16 {
        u16::try_from(self.design.pixel_max()).expect("a pixel has at most 16 bits")
    }

    /// Returns the number of transfers of a line.
    pub(super) fn words_per_line(&self) -> usize {
        self.design.width().div_ceil(self.design.pixels_per_clock()) as usize
    }

    /// Resets the core for four clocks.
    pub(super) fn reset(&mut self) {
        self.reset_for(4);
    }

    /// Resets the core for `clocks` clocks.
    pub(super) fn reset_for(&mut self, clocks: u64) {
        let patience = 8 * self.design.timing().clocks_per_frame() + 100_000;
        self.push_line(&format!("patience {patience:x}"));
        self.push_line(&format!("reset {clocks:x}"));
        self.sessions.push(BusSession { is_lossless: true, ..BusSession::default() });
    }

    /// Allows dropped regions and rows from now on, because the sink stalls, or is too slow for all
    /// regions at full rate.
    pub(super) fn allow_drops(&mut self) {
        self.current_session().is_lossless = false;
    }

    /// Allows dropped regions from now on, but no dropped rows.
    pub(super) fn allow_region_drops(&mut self) {
        self.allow_drops();
        self.current_session().keeps_rows = true;
    }

    /// Sets the share of clocks at which the source offers nothing, in percent.
    pub(super) fn set_gaps(&mut self, percent: u32) {
        self.push_line(&format!("gaps {percent:x}"));
    }

    /// Sets the share of clocks at which the sink takes nothing, in percent.
    pub(super) fn set_stalls(&mut self, percent: u32) {
        self.push_line(&format!("stalls {percent:x}"));
    }

    /// Stops the sink for `clocks` clocks.
    pub(super) fn hold_sink(&mut self, clocks: u64) {
        self.push_line(&format!("hold {clocks:x}"));
    }

    pub(super) fn wait_clocks(&mut self, clocks: u64) {
        self.push_line(&format!("clocks {clocks:x}"));
    }

    /// Waits until all packets have left.
    pub(super) fn drain(&mut self) {
        let clocks = self.drain_clocks();
        self.push_line(&format!("idle {clocks:x}"));
    }

    /// Returns the number of clocks without a packet after which no new packet follows.
    pub(super) fn drain_clocks(&self) -> u64 {
        let (side, columns) =
            (u64::from(self.design.region_size()), u64::from(self.design.columns()));
        (2 * side + 8) * columns * side + 2000
    }

    /// Writes a register, and waits until the write is done.
    pub(super) fn write(&mut self, address: u32, value: u32) {
        self.write_bytes(address, value, ALL_BYTES);
        self.push_line("join");
    }

    /// Writes some bytes of a register without waiting.
    pub(super) fn write_bytes(&mut self, address: u32, value: u32, strobes: u32) {
        self.push_line(&format!("write {address:x} {value:x} {strobes:x}"));
    }

    /// Reads a register without waiting, and expects `answer`.
    pub(super) fn read(&mut self, address: u32, answer: ExpectedRead) {
        self.read_unchecked(address);
        self.current_session().reads.push((address, answer));
    }

    /// Reads a register without waiting and without an expected value; a reset may come before the
    /// answer.
    pub(super) fn read_unchecked(&mut self, address: u32) {
        self.push_line(&format!("read {address:x}"));
    }

    pub(super) fn wait_for_accesses(&mut self) {
        self.push_line("join");
    }

    /// Sets whether reads and writes wait for each other, and for the answers to earlier ones.
    pub(super) fn set_in_order(&mut self, yes: bool) {
        self.push_line(if yes { "apart 0" } else { "apart 1" });
    }

    /// Checks that `interrupt_o` has the given value now.
    pub(super) fn expect_interrupt(&mut self, is: bool) {
        self.push_line(if is { "interrupt 1" } else { "interrupt 0" });
    }

    /// Writes a value to a register again and again from now on; other writes wait.
    pub(super) fn clear_repeatedly(&mut self, address: u32, value: u32) {
        self.push_line(&format!("clear {address:x} {value:x}"));
    }

    /// Stops the repeated write.
    pub(super) fn stop_clearing(&mut self) {
        self.push_line("clear 0 0");
        self.push_line("join");
    }

    /// Stops the repeated write, and expects the number of times that the event was seen.
    pub(super) fn expect_event_count(&mut self, event: &'static str, raised: ExpectedEventCount) {
        self.stop_clearing();
        self.push_line("rises");
        self.current_session().event_counts.push((event, raised));
    }

    /// Waits for the edge at which the core takes the write that was started last.
    pub(super) fn wait_for_taken_write(&mut self) {
        self.push_line("taken");
    }

    /// Waits until a word of a packet has been taken that is not its last.
    pub(super) fn wait_within_packet(&mut self) {
        self.push_line("within");
    }

    /// Returns the number of frames since the last reset, with skipped and damaged ones.
    pub(super) fn frame_count(&self) -> u32 {
        let sent = self.sessions.last().map_or(0, |session| session.frames.len());
        u32::try_from(sent).unwrap_or(u32::MAX)
    }

    /// Waits for a clock of this parity.
    pub(super) fn align_to_parity(&mut self, parity: u32) {
        self.push_line(&format!("align {}", parity % 2));
    }

    /// Adds a frame to the expected frames without sending transfers.
    pub(super) fn expect_frame(&mut self, sent: ExpectedFrame) {
        self.current_session().frames.push(sent);
    }

    /// Sends a whole frame.
    pub(super) fn send_frame(&mut self, sent: ExpectedFrame) {
        self.send_transfers(&sent.frame, 0..self.transfers(sent.frame.height()));
        self.expect_frame(sent);
    }

    /// Sends a whole frame, and calls `inside` before the line `at`, but within the frame.
    pub(super) fn send_frame_around(
        &mut self,
        sent: ExpectedFrame,
        at: u32,
        inside: impl FnMut(&mut Self),
    ) {
        self.send_frame_around_each(sent, [at], inside);
    }

    /// Sends a whole frame, and calls `inside` before each of the given lines, but behind the
    /// second transfer. When the core has taken the second one, the frame has begun.
    pub(super) fn send_frame_around_each<const COUNT: usize>(
        &mut self,
        sent: ExpectedFrame,
        lines: [u32; COUNT],
        mut inside: impl FnMut(&mut Self),
    ) {
        let mut from = 0;
        for line in lines {
            let stop = self.transfers(line).max(2);
            self.send_transfers(&sent.frame, from..stop);
            inside(self);
            from = stop;
        }
        self.send_transfers(&sent.frame, from..self.transfers(sent.frame.height()));
        self.expect_frame(sent);
    }

    /// Sends only the first lines of a frame.
    pub(super) fn send_torn_frame(&mut self, sent: ExpectedFrame, lines: u32) {
        self.send_transfers(&sent.frame, 0..self.transfers(lines));
        self.expect_frame(sent);
    }

    fn transfers(&self, lines: u32) -> usize {
        lines as usize * self.words_per_line()
    }

    /// Sends some transfers of a frame, which are numbered line by line.
    fn send_transfers(&mut self, frame: &Frame, range: Range<usize>) {
        let words = self.words_per_line();
        let lanes = self.design.pixels_per_clock() as usize;
        for number in range {
            let (y, at) = (number / words, number % words);
            let row = frame.row(u32::try_from(y).expect("a frame has at most 2^16 lines"));
            let pixels = row.chunks(lanes).nth(at).unwrap_or_default();
            self.send_beat(number == 0, at == words - 1, pixels);
        }
    }

    /// Returns the pixels of a line, transfer by transfer.
    pub(super) fn split_line<'r>(
        &self,
        row: &'r [u16],
    ) -> impl Iterator<Item = &'r [u16]> + use<'r> {
        row.chunks(self.design.pixels_per_clock() as usize)
    }

    /// Sends a transfer; `sof` marks the first of a frame, `eol` the last of a line.
    pub(super) fn send_beat(&mut self, sof: bool, eol: bool, pixels: &[u16]) {
        let bits = self.design.pixel_bits();
        let flags = u8::from(sof) | u8::from(eol) << 1;
        let word =
            pixels.iter().rev().fold(0_u128, |word, &pixel| word << bits | u128::from(pixel));
        let _ = writeln!(self.text, "beat {flags} {word:x}");
    }

    fn current_session(&mut self) -> &mut BusSession {
        self.sessions.last_mut().expect("traffic begins with a reset")
    }

    fn push_line(&mut self, text: &str) {
        self.text.push_str(text);
        self.text.push('\n');
    }
}

pub(super) fn rows(frame: &Frame) -> impl Iterator<Item = &[u16]> {
    (0..frame.height()).map(|y| frame.row(y))
}

#[derive(Template)]
#[template(path = "axi.cpp")]
struct BusProgram<'a> {
    top: &'a str,
    video_words: u32,
    has_store: bool,
}

/// Returns the source of the program for the module `top`.
pub(super) fn program(top: &str, design: RasterDesign<'_>) -> String {
    let bits = (design.pixels_per_clock() * design.pixel_bits()).next_multiple_of(8);
    let has_store = design.has_external_store();
    render(&BusProgram { top, video_words: bits.div_ceil(32), has_store })
}

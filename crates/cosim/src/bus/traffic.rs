// SPDX-License-Identifier: MIT OR Apache-2.0
//! What happens on the buses of a core, in order, and what must come of it.

use foveate_design::RasterDesign;
use foveate_frame::Frame;
use std::fmt::Write as _;
use std::ops::Range;

/// Strobes of all bytes of a register.
pub(super) const ALL: u32 = 0xF;

/// Whether a frame reaches the array.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Fate {
    /// It must.
    Taken,
    /// It must not.
    LeftOut,
    /// It may be skipped, because the sink stalls.
    Either,
    /// It must be skipped, because packets of the one before wait.
    Skipped,
    /// A reset comes while it is under way.
    Cut,
}

/// A frame that was sent, as the core repairs it.
#[derive(Clone, Debug)]
pub(super) struct Sent {
    pub(super) frame: Frame,
    pub(super) fate: Fate,
    /// The core has forgotten all frames before.
    pub(super) first: bool,
    /// Which thresholds hold: a number among the cameras.
    pub(super) camera: usize,
}

/// What a register must read as.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Answer {
    /// This.
    Is(u32),
    /// How many frames were skipped since reset.
    Skipped,
    /// How many regions were dropped since reset.
    Dropped,
    /// These events, and those of skipped frames and dropped packets if there were some.
    Events(u32),
}

/// How often an event must have raised `interrupt_o` while it was cleared without end.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Raised {
    /// So often.
    Times(u32),
    /// With every frame that was skipped.
    Skipped,
    /// With every row that was dropped.
    DroppedRows,
    /// At least once if a region was dropped, and at most with each: two that follow each other at once raise it once.
    DroppedRegions,
}

/// What happens between two resets.
#[derive(Clone, Debug, Default)]
pub(super) struct Session {
    pub(super) sent: Vec<Sent>,
    /// Registers that are read, in order.
    pub(super) answers: Vec<(u32, Answer)>,
    /// Events that are cleared without end, in order, and how often each must be seen all the same.
    pub(super) raised: Vec<(&'static str, Raised)>,
    /// Whether packets must leave without a dropped region or row.
    pub(super) is_lossless: bool,
    /// Whether no row may be dropped.
    pub(super) keeps_rows: bool,
}

/// What happens, as lines for the program, and what must come of it.
#[derive(Clone, Debug)]
pub(super) struct Traffic<'a> {
    design: RasterDesign<'a>,
    text: String,
    sessions: Vec<Session>,
}

impl<'a> Traffic<'a> {
    /// Nothing yet. It begins with a reset.
    pub(super) fn new(design: RasterDesign<'a>) -> Self {
        Self { design, text: String::new(), sessions: Vec::new() }
    }

    pub(super) fn design(&self) -> RasterDesign<'a> {
        self.design
    }

    pub(super) fn text(&self) -> &str {
        &self.text
    }

    pub(super) fn sessions(&self) -> &[Session] {
        &self.sessions
    }

    /// Transfers of a line.
    pub(super) fn words(&self) -> usize {
        self.design.width().div_ceil(self.design.pixels_per_clock()) as usize
    }

    /// Resets the core.
    pub(super) fn reset(&mut self) {
        self.reset_for(4);
    }

    /// Resets the core for so many clocks.
    pub(super) fn reset_for(&mut self, clocks: u64) {
        let patience = 8 * self.design.timing().clocks_per_frame() + 100_000;
        self.line(&format!("patience {patience:x}"));
        self.line(&format!("reset {clocks:x}"));
        self.sessions.push(Session { is_lossless: true, ..Session::default() });
    }

    /// Regions may be dropped from now on: the sink stalls, or is too slow for all regions at full rate.
    pub(super) fn may_drop(&mut self) {
        self.session().is_lossless = false;
    }

    /// Regions may be dropped from now on, and no rows.
    pub(super) fn may_drop_regions(&mut self) {
        self.may_drop();
        self.session().keeps_rows = true;
    }

    /// How often nothing is offered, in percent.
    pub(super) fn gaps(&mut self, percent: u32) {
        self.line(&format!("gaps {percent:x}"));
    }

    /// How often nothing is taken, in percent.
    pub(super) fn stalls(&mut self, percent: u32) {
        self.line(&format!("stalls {percent:x}"));
    }

    /// Takes no packet for so many clocks.
    pub(super) fn hold(&mut self, clocks: u64) {
        self.line(&format!("hold {clocks:x}"));
    }

    pub(super) fn clocks(&mut self, clocks: u64) {
        self.line(&format!("clocks {clocks:x}"));
    }

    /// Waits until all packets have left.
    pub(super) fn drain(&mut self) {
        let clocks = self.drain_clocks();
        self.line(&format!("idle {clocks:x}"));
    }

    /// Clocks behind which no packet follows that has not begun before.
    pub(super) fn drain_clocks(&self) -> u64 {
        let (side, columns) =
            (u64::from(self.design.region_size()), u64::from(self.design.columns()));
        (2 * side + 8) * columns * side + 2000
    }

    /// Writes a register, and waits until that is done.
    pub(super) fn write(&mut self, address: u32, value: u32) {
        self.write_bytes(address, value, ALL);
        self.line("join");
    }

    /// Writes some bytes of a register, and goes on at once.
    pub(super) fn write_bytes(&mut self, address: u32, value: u32, strobes: u32) {
        self.line(&format!("write {address:x} {value:x} {strobes:x}"));
    }

    /// Reads a register, and goes on at once.
    pub(super) fn read(&mut self, address: u32, answer: Answer) {
        self.ask(address);
        self.session().answers.push((address, answer));
    }

    /// Reads a register, and goes on at once; a reset may come before the answer.
    pub(super) fn ask(&mut self, address: u32) {
        self.line(&format!("read {address:x}"));
    }

    /// Waits for all reads and writes.
    pub(super) fn join(&mut self) {
        self.line("join");
    }

    /// Whether reads and writes wait for each other, and for the answers to those before them.
    pub(super) fn in_order(&mut self, yes: bool) {
        self.line(if yes { "apart 0" } else { "apart 1" });
    }

    /// `interrupt_o` must be this now.
    pub(super) fn interrupt(&mut self, is: bool) {
        self.line(if is { "interrupt 1" } else { "interrupt 0" });
    }

    /// Writes this to a register again and again from now on; what else is written waits.
    pub(super) fn clear(&mut self, address: u32, value: u32) {
        self.line(&format!("clear {address:x} {value:x}"));
    }

    /// Writes it no more, and counts how often the event was seen.
    pub(super) fn count_raised(&mut self, event: &'static str, raised: Raised) {
        self.line("clear 0 0");
        self.line("join");
        self.line("rises");
        self.session().raised.push((event, raised));
    }

    /// Waits until a word of a packet has been taken, and not its last.
    pub(super) fn within_a_packet(&mut self) {
        self.line("within");
    }

    /// Frames since the last reset, whatever became of them.
    pub(super) fn frames_that_came(&self) -> u32 {
        let sent = self.sessions.last().map_or(0, |session| session.sent.len());
        u32::try_from(sent).unwrap_or(u32::MAX)
    }

    /// Waits for a clock of this parity.
    pub(super) fn align(&mut self, parity: u32) {
        self.line(&format!("align {}", parity % 2));
    }

    /// A frame that is expected, whatever its pixels are sent as.
    pub(super) fn expect(&mut self, sent: Sent) {
        self.session().sent.push(sent);
    }

    /// A whole frame.
    pub(super) fn frame(&mut self, sent: Sent) {
        self.lines(&sent.frame, 0..sent.frame.height());
        self.expect(sent);
    }

    /// A whole frame; before the line `at` something else happens.
    pub(super) fn frame_around(&mut self, sent: Sent, at: u32, inside: impl FnMut(&mut Self)) {
        self.frame_around_each(sent, [at], inside);
    }

    /// A whole frame; before each of these lines something else happens.
    pub(super) fn frame_around_each<const COUNT: usize>(
        &mut self,
        sent: Sent,
        lines: [u32; COUNT],
        mut inside: impl FnMut(&mut Self),
    ) {
        let mut from = 0;
        for line in lines {
            self.lines(&sent.frame, from..line);
            inside(self);
            from = line;
        }
        self.lines(&sent.frame, from..sent.frame.height());
        self.expect(sent);
    }

    /// The first lines of a frame; the rest never comes.
    pub(super) fn torn_frame(&mut self, sent: Sent, lines: u32) {
        self.lines(&sent.frame, 0..lines);
        self.expect(sent);
    }

    fn lines(&mut self, frame: &Frame, range: Range<u32>) {
        let last = self.words() - 1;
        for y in range {
            for (at, pixels) in self.split(frame.row(y)).enumerate() {
                self.beat(at == 0 && y == 0, at == last, pixels);
            }
        }
    }

    /// The pixels of a line, by transfer.
    pub(super) fn split<'r>(&self, row: &'r [u16]) -> impl Iterator<Item = &'r [u16]> + use<'r> {
        row.chunks(self.design.pixels_per_clock() as usize)
    }

    /// A transfer: whether it is the first of a frame, and the last of a line.
    pub(super) fn beat(&mut self, sof: bool, eol: bool, pixels: &[u16]) {
        let bits = self.design.pixel_bits();
        let flags = u8::from(sof) | u8::from(eol) << 1;
        let word =
            pixels.iter().rev().fold(0_u128, |word, &pixel| word << bits | u128::from(pixel));
        let _ = writeln!(self.text, "beat {flags} {word:x}");
    }

    fn session(&mut self) -> &mut Session {
        self.sessions.last_mut().expect("traffic begins with a reset")
    }

    fn line(&mut self, text: &str) {
        self.text.push_str(text);
        self.text.push('\n');
    }
}

/// The rows of a frame.
pub(super) fn rows(frame: &Frame) -> impl Iterator<Item = &[u16]> {
    (0..frame.height()).map(|y| frame.row(y))
}

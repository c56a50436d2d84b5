// SPDX-License-Identifier: MIT OR Apache-2.0
//! The comparison of packets and registers with what the model says of the frames that came.

use super::follower::Follower;
use super::heard::{Heard, Parcel, Record, Rises};
use super::thresholds::Missed;
use super::traffic::{Answer, Fate, Raised, Sent, Session};
use super::wrong::Wrong;
use crate::situations::{BusFacts, EVENTS};
use foveate_design::{Action, Camera, RasterDesign, RasterTiming};
use foveate_emit::Register;
use foveate_model::FunctionalOutcome;
use foveate_packets::{
    Decision, End, Found, FrameInfo, Layout, Packet, Region, Row, Splitter, write,
};
use std::ops::AddAssign;

/// The frequency of the clock in Hz, the value of the core's parameter.
pub(super) const TICK_RATE: u32 = 100_000_000;
/// The mask of the counters of skipped frames and dropped regions, which wrap around.
const COUNTER_MASK: u32 = 0xFFFF;

/// The amount of output that agreed with the model.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) struct Agreed {
    /// The number of frames that left.
    pub(super) frames: u64,
    /// The number of packets and registers that were compared.
    pub(super) comparisons: u64,
}

impl AddAssign for Agreed {
    fn add_assign(&mut self, more: Self) {
        self.frames += more.frames;
        self.comparisons += more.comparisons;
    }
}

/// The facts about a core that hold for all sessions.
pub(super) struct Checker<'a> {
    layout: Layout,
    /// The camera of the design, and its cameras with other thresholds.
    cameras: &'a [Camera],
    registers: &'a [Register],
    /// The thresholds for which a check can tell if they are taken over.
    missed: &'a [Missed<'a>],
    /// The number of transfers of a frame, which is the smallest number of clocks that it takes.
    transfers: u64,
}

impl<'a> Checker<'a> {
    pub(super) fn new(
        design: RasterDesign<'_>,
        cameras: &'a [Camera],
        registers: &'a [Register],
        missed: &'a [Missed<'a>],
    ) -> Self {
        let transfers = RasterTiming::of(design).taken();
        let layout = Layout::new(&design, false, TICK_RATE)
            .unwrap_or_else(|error| unreachable!("the sizes of a core on a bus fit: {error}"));
        Self { layout, cameras, registers, missed, transfers }
    }

    /// Compares the recorded activity with the results that the traffic must have, and counts the
    /// situations in `facts`.
    pub(super) fn check(
        &self,
        sessions: &[Session],
        record: &Record,
        facts: &mut BusFacts,
    ) -> Result<Agreed, Wrong> {
        let mut agreed = Agreed::default();
        let first_breach = record.breaches.first().map(Wrong::from);
        let end = record.clocks.unwrap_or_default();
        for (number, session) in sessions.iter().enumerate() {
            let Some(heard) = record.sessions.get(number) else {
                let missing = Wrong { clock: end, ..Wrong::presence("the run ended early", false) };
                return Err(first_breach.unwrap_or(missing));
            };
            let found = Receiver::new(self, session, heard.start, facts).receive(heard, end);
            let found = found.map_err(|wrong| match &first_breach {
                Some(breach) if breach.clock <= wrong.clock => breach.clone(),
                _ => wrong,
            })?;
            agreed += found;
        }
        first_breach.map_or(Ok(agreed), Err)
    }

    /// Returns the bit mask of an event.
    fn event(&self, name: &str) -> u32 {
        let events = self.registers.iter().find(|register| register.name == "events");
        let field = events.and_then(|events| events.fields.iter().find(|field| field.name == name));
        field.map_or(0, |field| 1 << field.low)
    }
}

/// A frame whose packets are arriving.
struct Open {
    number: u32,
    is_cut: bool,
    outcome: FunctionalOutcome,
    /// The decisions of the rows that arrived.
    decisions: Vec<Option<Decision>>,
    next_row: u32,
    rows: u32,
    /// For each region, true if its packet arrived.
    came: Vec<bool>,
}

/// The state of the comparison between two resets.
struct Receiver<'a> {
    checker: &'a Checker<'a>,
    session: &'a Session,
    model: Follower<'a>,
    /// The index of the camera of the last frame; `camera_before` is that of the frames before its
    /// thresholds were written.
    camera: usize,
    camera_before: usize,
    /// The regions of the last frame that were lost.
    lost: Vec<u32>,
    facts: &'a mut BusFacts,
    open: Option<Open>,
    /// The smallest number that the next frame may have.
    next: usize,
    is_first: bool,
    /// True if a frame was skipped since the last one.
    has_skipped: bool,
    /// The first clock after the reset.
    start: u64,
    /// The earliest time at which the next frame can begin.
    time: u64,
    skipped: u32,
    dropped: u32,
    dropped_rows: u32,
    agreed: Agreed,
}

impl<'a> Receiver<'a> {
    fn new(
        checker: &'a Checker<'a>,
        session: &'a Session,
        start: u64,
        facts: &'a mut BusFacts,
    ) -> Self {
        Self {
            checker,
            session,
            model: Follower::new(checker.cameras),
            camera: 0,
            camera_before: 0,
            lost: Vec::new(),
            facts,
            open: None,
            next: 0,
            is_first: true,
            has_skipped: false,
            start,
            time: 0,
            skipped: 0,
            dropped: 0,
            dropped_rows: 0,
            agreed: Agreed::default(),
        }
    }

    fn receive(mut self, heard: &Heard, end: u64) -> Result<Agreed, Wrong> {
        for parcel in &heard.parcels {
            let frame = self.open.as_ref().map_or(self.next as u64, |open| open.number.into());
            self.parcel(parcel).map_err(|wrong| Wrong { clock: parcel.clock, frame, ..wrong })?;
        }
        let wrong = |wrong: Wrong| Wrong { clock: end, ..wrong };
        if let Some(open) = self.open.take().filter(|open| !open.is_cut) {
            let missing = Wrong::presence("the END of a frame that began", true);
            return Err(wrong(Wrong { frame: open.number.into(), ..missing }));
        }
        self.pass_over(self.session.sent.len()).map_err(wrong)?;
        self.registers(heard)?;
        self.raised(heard)?;
        Ok(self.agreed)
    }

    fn parcel(&mut self, parcel: &Parcel) -> Result<(), Wrong> {
        let is_cut = self.session.sent.iter().any(|sent| sent.fate == Fate::Cut);
        if !parcel.is_whole && is_cut {
            self.facts.cut += 1;
            return Ok(());
        }
        let mut splitter = Splitter::default();
        splitter.feed(&parcel.bytes);
        splitter.complete();
        let found = splitter.next(Some(&self.checker.layout));
        let Found::Packet { frame, packet } = found else {
            return Err(Wrong::presence("a packet of this design", true));
        };
        if !parcel.is_whole || splitter.next(Some(&self.checker.layout)) != Found::Nothing {
            return Err(Wrong::presence(
                "tlast with the last word of a packet, and no other",
                true,
            ));
        }
        let bytes = written(&self.checker.layout, frame, &packet);
        if let Some(at) = bytes.iter().zip(&parcel.bytes).position(|(own, other)| own != other) {
            let what = format!("byte {at} of a packet of {} bytes", bytes.len());
            return Err(Wrong::number(what, bytes[at], parcel.bytes[at]));
        }
        self.agreed.comparisons += 1;
        match packet {
            Packet::Frame(info) => self.frame(frame, &info, parcel.first),
            Packet::Row(row) => self.row(frame, &row),
            Packet::Region(region) => self.region(frame, &region),
            Packet::End(end) => self.end(frame, end),
            Packet::Scores(_) => Err(Wrong::presence("a SCORES packet", false)),
            Packet::Register(_) => Err(Wrong::presence("a REGISTER packet", false)),
        }
    }

    fn frame(&mut self, number: u32, info: &FrameInfo, left: u64) -> Result<(), Wrong> {
        if let Some(open) = &self.open {
            return Err(Wrong::number(
                "the END of the frame before its FRAME",
                open.number,
                number,
            ));
        }
        let at = number as usize;
        if at < self.next {
            return Err(Wrong::number("the number of a frame", self.next, number));
        }
        let sent = self.sent(at)?;
        self.pass_over(at)?;
        if matches!(sent.fate, Fate::LeftOut | Fate::Skipped) {
            return Err(Wrong::presence("a frame that must be left out", false));
        }
        self.next = at + 1;
        let first = std::mem::take(&mut self.is_first) || sent.first;
        let expected = FrameInfo { first, time: info.time, ..self.checker.layout.info().clone() };
        if *info != expected {
            let at = format!("what FRAME says: {info:?}, expected {expected:?}");
            return Err(Wrong::presence(at, false));
        }
        self.time(info.time, left)?;
        let outcome = self.step(sent, first);
        let regions = outcome.srs.len();
        self.open = Some(Open {
            number,
            is_cut: sent.fate == Fate::Cut,
            outcome,
            decisions: vec![None; regions],
            next_row: 0,
            rows: 0,
            came: vec![false; regions],
        });
        Ok(())
    }

    /// Advances the model by a frame that arrived, and returns its outcome.
    fn step(&mut self, sent: &Sent, first: bool) -> FunctionalOutcome {
        let lost = std::mem::take(&mut self.lost);
        if first {
            self.facts.restarted += u64::from(self.agreed.frames > 0);
            self.model.reset();
        } else {
            lost.iter().for_each(|&region| self.model.lose(region));
            self.facts.behind_loss += lost.len() as u64;
        }
        self.facts.behind_skipped += u64::from(std::mem::take(&mut self.has_skipped));
        if sent.camera != self.camera {
            (self.camera_before, self.camera) = (self.camera, sent.camera);
        }
        let missed = self.missed(sent);
        let outcome = self.model.step(&sent.frame, sent.camera);
        for (register, other) in missed {
            let differs =
                (0..outcome.srs.len()).any(|at| outcome.decision(at) != other.decision(at));
            *self.facts.taken_over.entry(register).or_default() += u64::from(differs);
        }
        outcome
    }

    /// Returns the outcomes that the frame would have if a threshold had not been taken over, for
    /// the thresholds that have not yet decided anything.
    fn missed(&self, sent: &Sent) -> Vec<(String, FunctionalOutcome)> {
        let is_open = |missed: &&Missed<'_>| {
            self.facts.taken_over.get(&missed.register).copied().unwrap_or_default() == 0
        };
        let open = self.checker.missed.iter().filter(is_open);
        let found = open.filter_map(|missed| {
            let camera = missed.camera(self.camera, self.camera_before)?;
            Some((missed.register.clone(), self.model.instead(&sent.frame, &camera)))
        });
        found.collect()
    }

    /// Checks the time of a frame, which is when it began: after all words of the frame before it,
    /// and before the first word of its FRAME packet left.
    fn time(&mut self, time: u64, left: u64) -> Result<(), Wrong> {
        let latest = left - self.start;
        if time < self.time {
            return Err(Wrong::number("the time of a frame, at least", self.time, time));
        }
        if time >= latest {
            return Err(Wrong::number("the time of a frame, below", latest, time));
        }
        self.time = time + self.checker.transfers;
        Ok(())
    }

    fn sent(&self, at: usize) -> Result<&'a Sent, Wrong> {
        let all = &self.session.sent;
        all.get(at).ok_or_else(|| Wrong::number("the number of a frame, below", all.len(), at))
    }

    /// Passes over the expected frames up to `at`, which have not arrived. Fails if one of them had
    /// to arrive.
    fn pass_over(&mut self, at: usize) -> Result<(), Wrong> {
        for number in self.next..at {
            let sent = self.sent(number)?;
            self.is_first |= sent.first;
            match sent.fate {
                Fate::Either | Fate::Skipped => {
                    self.skipped += 1;
                    self.has_skipped = true;
                }
                Fate::LeftOut => self.facts.left_out += 1,
                Fate::Cut => {}
                Fate::Taken => {
                    let missing = Wrong::presence(format!("the packets of frame {number}"), true);
                    return Err(Wrong { frame: number as u64, ..missing });
                }
            }
        }
        Ok(())
    }

    fn opened(&mut self, number: u32) -> Result<&mut Open, Wrong> {
        let Some(open) = &mut self.open else {
            return Err(Wrong::presence("a packet between END and FRAME", false));
        };
        if open.number != number {
            return Err(Wrong::number("the number of the frame", open.number, number));
        }
        Ok(open)
    }

    fn row(&mut self, number: u32, row: &Row) -> Result<(), Wrong> {
        let columns = self.checker.layout.columns();
        let open = self.opened(number)?;
        if row.row < open.next_row {
            return Err(Wrong::number("the row, at least", open.next_row, row.row));
        }
        open.next_row = row.row + 1;
        open.rows += 1;
        for (region, &decision) in (row.row * columns..).zip(&row.decisions) {
            let (at, code) = (region as usize, |decision: Decision| {
                u8::from(decision.srs)
                    | u8::from(decision.trs) << 1
                    | u8::from(decision.summary) << 2
            });
            let expected = open.outcome.decision(at);
            if decision != expected {
                let what = "srs, trs and summary, from the lowest bit on";
                return Err(Wrong::number(what, code(expected), code(decision)).of_region(region));
            }
            if open.came[at] && !sends(decision) {
                return Err(
                    Wrong::presence("pixels of a region that sends none", false).of_region(region)
                );
            }
            open.decisions[at] = Some(decision);
        }
        Ok(())
    }

    fn region(&mut self, number: u32, region: &Region) -> Result<(), Wrong> {
        let columns = self.checker.layout.columns();
        let raw = self.checker.layout.info().raw;
        let camera = &self.checker.cameras[0];
        let open = self.opened(number)?;
        let name = region.row * columns + region.column;
        let at = name as usize;
        let wrong = |wrong: Wrong| wrong.of_region(name);
        if std::mem::replace(&mut open.came[at], true) {
            return Err(wrong(Wrong::presence("its REGION a second time", false)));
        }
        let decision = open.outcome.decision(at);
        if !sends(decision) {
            return Err(wrong(Wrong::presence("pixels of a region that sends none", false)));
        }
        if decision.summary != region.flags.summary {
            return Err(wrong(Wrong::presence("the flag `summary`", !region.flags.summary)));
        }
        if raw != region.flags.raw {
            return Err(wrong(Wrong::presence("the flag `raw`", raw)));
        }
        let expected = match region.flags.summary {
            true => open.outcome.means[at].clone(),
            false => pixels(camera, &open.outcome, region.row, region.column),
        };
        let differs = expected.iter().zip(&region.values).position(|(own, other)| own != other);
        match differs {
            None => {
                let count = match region.flags.summary {
                    true => &mut self.facts.means,
                    false => &mut self.facts.pixels,
                };
                *count += 1;
                Ok(())
            }
            Some(place) => {
                let what = format!("value {place} of its {}", expected.len());
                Err(wrong(Wrong::number(what, expected[place], region.values[place])))
            }
        }
    }

    fn end(&mut self, number: u32, end: End) -> Result<(), Wrong> {
        let rows = self.checker.layout.rows();
        let Session { is_lossless, keeps_rows, .. } = *self.session;
        let open = self.opened(number)?;
        let sent: u32 = open.came.iter().map(|&came| u32::from(came)).sum();
        if end.regions_sent != sent {
            return Err(Wrong::number("REGION packets that END counts", sent, end.regions_sent));
        }
        let lost_rows = rows - open.rows;
        if end.rows_dropped != lost_rows {
            return Err(Wrong::number("dropped rows that END counts", lost_rows, end.rows_dropped));
        }
        let is_lost = |at: &usize| !open.came[*at] && sends(open.outcome.decision(*at));
        let lost = (0..open.came.len()).filter(is_lost);
        let lost: Vec<u32> = lost.map(|at| u32::try_from(at).unwrap_or(u32::MAX)).collect();
        let dropped = u32::try_from(lost.len()).unwrap_or(u32::MAX);
        if end.regions_dropped != dropped {
            let what = "dropped regions that END counts";
            return Err(Wrong::number(what, dropped, end.regions_dropped));
        }
        if is_lossless && (end.regions_dropped > 0 || end.rows_dropped > 0) {
            return Err(Wrong::number("dropped regions", 0, end.regions_dropped));
        }
        if keeps_rows && end.rows_dropped > 0 {
            return Err(Wrong::number("dropped rows", 0, end.rows_dropped));
        }
        self.open = None;
        self.lost = lost;
        self.dropped += end.regions_dropped;
        self.dropped_rows += end.rows_dropped;
        self.agreed.frames += 1;
        Ok(())
    }

    fn registers(&mut self, heard: &Heard) -> Result<(), Wrong> {
        let mut reads = heard.reads.iter();
        for &(address, answer) in &self.session.answers {
            let name = self.checker.registers.iter().find(|register| register.address == address);
            let name = name.map_or("nothing", |register| &register.name);
            let wrong = |clock, at: String, expected: u32, got: u32| {
                let port = "s_axi".to_owned();
                Wrong { clock, port, ..Wrong::number(at, expected, got) }
            };
            let Some(&(clock, at, value)) = reads.next() else {
                return Err(wrong(0, format!("an answer to a read of {name}"), 1, 0));
            };
            let expected = self.answer(answer);
            if (at, value) != (address, expected) {
                let what = format!("the register {name} at 'h{address:03x}");
                return Err(wrong(clock, what, expected, value));
            }
            self.agreed.comparisons += 1;
            if name == "events" {
                for event in EVENTS.into_iter().filter(|name| value & self.checker.event(name) != 0)
                {
                    *self.facts.read.entry(event).or_default() += 1;
                }
            }
        }
        Ok(())
    }

    /// Checks that events that were cleared again and again have been seen as often as they must.
    fn raised(&mut self, heard: &Heard) -> Result<(), Wrong> {
        let mut counts = heard.rises.iter();
        for &(event, raised) in &self.session.raised {
            let port = "interrupt_o".to_owned();
            let Some(&Rises { clock, count, met }) = counts.next() else {
                return Err(Wrong { port, ..Wrong::presence(format!("a count of {event}"), true) });
            };
            let (least, most) = match raised {
                Raised::Times(times) => (times, times),
                Raised::Skipped => (self.skipped, self.skipped),
                Raised::DroppedRows => (self.dropped_rows, self.dropped_rows),
                Raised::DroppedRegions => (self.dropped.min(1), self.dropped),
            };
            let bound = if count < least.into() { least } else { most };
            if !(u64::from(least)..=u64::from(most)).contains(&count) {
                let at = format!("how often {event} is seen while it is cleared");
                return Err(Wrong { clock, port, ..Wrong::number(at, bound, count) });
            }
            *self.facts.met.entry(event).or_default() += met;
            self.agreed.comparisons += 1;
        }
        Ok(())
    }

    fn answer(&self, answer: Answer) -> u32 {
        let event = |name, happened: bool| if happened { self.checker.event(name) } else { 0 };
        match answer {
            Answer::Is(value) => value,
            Answer::Skipped => self.skipped & COUNTER_MASK,
            Answer::Dropped => self.dropped & COUNTER_MASK,
            Answer::Events(others) => {
                others
                    | event("frame_skipped", self.skipped > 0)
                    | event("region_dropped", self.dropped > 0)
                    | event("row_dropped", self.dropped_rows > 0)
            }
        }
    }
}

/// Returns the bytes of a packet, written again from its fields. Bytes that no field describes are
/// 0. Returns an empty vector if the packet cannot be one of this layout.
fn written(layout: &Layout, frame: u32, packet: &Packet) -> Vec<u8> {
    let mut bytes = Vec::new();
    // A packet that cannot be written leaves `bytes` empty.
    let _ = match packet {
        Packet::Frame(info) => {
            write::frame(&mut bytes, layout, frame, (info.time, info.first));
            Ok(())
        }
        Packet::Row(row) => write::row(&mut bytes, layout, frame, row.row, &row.decisions),
        Packet::Region(Region { row, column, flags, values }) => {
            write::region(&mut bytes, layout, frame, (*row, *column), (*flags, values))
        }
        Packet::End(end) => write::end(&mut bytes, frame, *end),
        // A core sends neither; the caller reports them.
        Packet::Scores(_) | Packet::Register(_) => Ok(()),
    };
    bytes
}

/// Access to the decision of a region, as a ROW packet has it.
trait Decided {
    fn decision(&self, region: usize) -> Decision;
}

impl Decided for FunctionalOutcome {
    fn decision(&self, region: usize) -> Decision {
        let summary = match self.actions[region] {
            Action::Summarize => true,
            Action::Forward | Action::Hold | Action::Blank => false,
        };
        Decision { srs: self.srs[region], trs: self.trs[region], summary }
    }
}

/// Returns true if pixels or means follow from a decision.
fn sends(decision: Decision) -> bool {
    (decision.srs && decision.trs) || decision.summary
}

/// Returns the pixels that an active region sends.
fn pixels(camera: &Camera, outcome: &FunctionalOutcome, row: u32, column: u32) -> Vec<u16> {
    let (side, payload) = (camera.region_size(), outcome.payload(camera));
    let (left, top) = ((column * side) as usize, row * side);
    let line = |y: u32| payload.row(y).iter().skip(left).take(side as usize).copied();
    (top..top + side).flat_map(line).collect()
}

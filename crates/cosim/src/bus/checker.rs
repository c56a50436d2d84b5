// SPDX-License-Identifier: MIT OR Apache-2.0
//! The comparison of packets and registers with what the model says of the frames that came.
//!
//! A packet is decoded, and its fields are encoded again, so that every byte of it is compared.
//! Then the fields are compared with the [`FunctionalOutcome`] of its frame.

use super::lossy_model::LossyModel;
use super::replay::{BusMismatch, BusRecord, InterruptCount, RecordedPacket, SessionRecord};
use super::thresholds::StaleThreshold;
use super::traffic::{BusSession, ExpectedEventCount, ExpectedFrame, ExpectedRead, FrameFate};
use crate::situations::{BusSituationCounts, EVENTS};
use foveate_camera::{Camera, RegionAction};
use foveate_design::{RasterDesign, RasterTiming};
use foveate_emit::Register;
use foveate_model::FunctionalOutcome;
use foveate_packets::{
    EndPacket, FrameInfo, Packet, PacketLayout, PacketSplitter, RegionDecision, RegionPacket,
    RowPacket, StreamItem, packet_encoding,
};
use std::ops::AddAssign;

/// The frequency of the clock in Hz, the value of the core's parameter.
pub(super) const TICK_RATE: u32 = 100_000_000;
/// The mask of the counters of skipped frames and dropped regions, which wrap around.
const COUNTER_MASK: u32 = 0xFFFF;

/// The amount of output that agreed with the model.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) struct BusAgreement {
    /// The number of frames that left.
    pub(super) frames: u64,
    /// The number of packets and registers that were compared.
    pub(super) comparisons: u64,
}

impl AddAssign for BusAgreement {
    fn add_assign(&mut self, more: Self) {
        self.frames += more.frames;
        self.comparisons += more.comparisons;
    }
}

/// The facts about a core that hold for all sessions.
pub(super) struct BusChecker<'a> {
    layout: PacketLayout,
    /// The camera of the design, and its cameras with other thresholds.
    cameras: &'a [Camera],
    registers: &'a [Register],
    /// The thresholds for which a check can tell if they are taken over.
    stale_thresholds: &'a [StaleThreshold<'a>],
    /// The number of transfers of a frame, which is the smallest number of clocks that it takes.
    transfers: u64,
}

impl<'a> BusChecker<'a> {
    pub(super) fn new(
        design: RasterDesign<'_>,
        cameras: &'a [Camera],
        registers: &'a [Register],
        missed: &'a [StaleThreshold<'a>],
    ) -> Self {
        let transfers = RasterTiming::from_design(design).taken_words_per_frame();
        let layout = PacketLayout::new(&design, false, TICK_RATE)
            .unwrap_or_else(|error| unreachable!("the sizes of a core on a bus fit: {error}"));
        Self { layout, cameras, registers, stale_thresholds: missed, transfers }
    }

    /// Compares the recorded activity with the results that the traffic must have, and counts the
    /// situations in `facts`.
    pub(super) fn check(
        &self,
        sessions: &[BusSession],
        record: &BusRecord,
        facts: &mut BusSituationCounts,
    ) -> Result<BusAgreement, BusMismatch> {
        let versions: Vec<Vec<(u64, u16)>> =
            record.sessions.iter().map(|heard| self.map_versions(heard)).collect();
        facts.commits_before_reset += versions
            .windows(2)
            .filter(|pair| match (pair[0].last(), pair[1].first()) {
                (Some((_, before)), Some((_, after))) => before != after,
                _ => false,
            })
            .count() as u64;
        let mut agreed = BusAgreement::default();
        let first_breach = record.violations.first().map(BusMismatch::from);
        let end = record.clocks.unwrap_or_default();
        for (number, session) in sessions.iter().enumerate() {
            let Some(heard) = record.sessions.get(number) else {
                let missing = BusMismatch {
                    clock: end,
                    ..BusMismatch::from_presence("the run ended early", false)
                };
                return Err(first_breach.unwrap_or(missing));
            };
            let found =
                SessionChecker::new(self, session, heard.start, facts).check_session(heard, end);
            let found = found.map_err(|wrong| match &first_breach {
                Some(breach) if breach.clock <= wrong.clock => breach.clone(),
                _ => wrong,
            })?;
            agreed += found;
        }
        first_breach.map_or(Ok(agreed), Err)
    }

    /// Returns the versions of the map of classes that were read, each with its clock.
    fn map_versions(&self, heard: &SessionRecord) -> Vec<(u64, u16)> {
        let control = self.registers.iter().find(|register| register.name == "zone_control");
        let Some(control) = control else { return Vec::new() };
        let reads = heard.reads.iter().filter(|(_, address, _)| *address == control.address);
        reads.map(|&(clock, _, value)| (clock, (value >> 16) as u16)).collect()
    }

    /// Returns the bit mask of an event.
    fn event_mask(&self, name: &str) -> u32 {
        let events = self.registers.iter().find(|register| register.name == "events");
        let field = events.and_then(|events| events.fields.iter().find(|field| field.name == name));
        field.map_or(0, |field| 1 << field.low)
    }
}

/// A frame whose packets are arriving.
struct OpenFrame {
    number: u32,
    is_cut: bool,
    outcome: FunctionalOutcome,
    /// The decisions of the rows that arrived.
    decisions: Vec<Option<RegionDecision>>,
    next_row: u32,
    rows: u32,
    /// For each region, true if its packet arrived.
    has_arrived: Vec<bool>,
}

/// The state of the comparison between two resets.
struct SessionChecker<'a> {
    checker: &'a BusChecker<'a>,
    session: &'a BusSession,
    model: LossyModel<'a>,
    /// The index of the camera of the last frame; `camera_before` is that of the frames before its
    /// thresholds were written.
    camera: usize,
    camera_before: usize,
    facts: &'a mut BusSituationCounts,
    open: Option<OpenFrame>,
    /// The versions of the map of classes that were read, each with its clock.
    map_versions: Vec<(u64, u16)>,
    map_version: u16,
    /// The smallest number that the next frame may have.
    next_frame: usize,
    is_first: bool,
    /// True if a frame was skipped since the last one.
    has_skipped: bool,
    /// The first clock after the reset.
    start: u64,
    /// The earliest time at which the next frame can begin.
    earliest_time: u64,
    skipped: u32,
    dropped: u32,
    dropped_rows: u32,
    agreement: BusAgreement,
}

impl<'a> SessionChecker<'a> {
    fn new(
        checker: &'a BusChecker<'a>,
        session: &'a BusSession,
        start: u64,
        facts: &'a mut BusSituationCounts,
    ) -> Self {
        Self {
            checker,
            session,
            model: LossyModel::new(checker.cameras),
            camera: 0,
            camera_before: 0,
            facts,
            open: None,
            map_versions: Vec::new(),
            map_version: 0,
            next_frame: 0,
            is_first: true,
            has_skipped: false,
            start,
            earliest_time: 0,
            skipped: 0,
            dropped: 0,
            dropped_rows: 0,
            agreement: BusAgreement::default(),
        }
    }

    fn check_session(
        mut self,
        heard: &SessionRecord,
        end: u64,
    ) -> Result<BusAgreement, BusMismatch> {
        self.map_versions = self.checker.map_versions(heard);
        for recorded in &heard.packets {
            let frame =
                self.open.as_ref().map_or(self.next_frame as u64, |open| open.number.into());
            self.check_packet(recorded).map_err(|wrong| BusMismatch {
                clock: recorded.last_clock,
                frame,
                ..wrong
            })?;
        }
        let wrong = |wrong: BusMismatch| BusMismatch { clock: end, ..wrong };
        if let Some(open) = self.open.take().filter(|open| !open.is_cut) {
            let missing = BusMismatch::from_presence("the END of a frame that began", true);
            return Err(wrong(BusMismatch { frame: open.number.into(), ..missing }));
        }
        self.pass_missing_frames(self.session.frames.len()).map_err(wrong)?;
        self.check_registers(heard, end)?;
        self.check_event_counts(heard, end)?;
        Ok(self.agreement)
    }

    fn check_packet(&mut self, recorded: &RecordedPacket) -> Result<(), BusMismatch> {
        let is_cut = self.session.frames.iter().any(|sent| sent.fate == FrameFate::CutByReset);
        if !recorded.is_whole && is_cut {
            self.facts.cut += 1;
            return Ok(());
        }
        let mut splitter = PacketSplitter::default();
        splitter.feed(&recorded.bytes);
        splitter.mark_complete();
        let found = splitter.next(Some(&self.checker.layout));
        let StreamItem::Packet { frame, packet } = found else {
            return Err(BusMismatch::from_presence("a packet of this design", true));
        };
        if !recorded.is_whole || splitter.next(Some(&self.checker.layout)) != StreamItem::Pending {
            return Err(BusMismatch::from_presence(
                "tlast with the last word of a packet, and no other",
                true,
            ));
        }
        let bytes = encode_packet(&self.checker.layout, frame, &packet);
        if let Some(at) = bytes.iter().zip(&recorded.bytes).position(|(own, other)| own != other) {
            let what = format!("byte {at} of a packet of {} bytes", bytes.len());
            return Err(BusMismatch::from_numbers(what, bytes[at], recorded.bytes[at]));
        }
        self.agreement.comparisons += 1;
        match packet {
            Packet::Frame(info) => self.begin_frame(frame, &info, recorded.first_clock),
            Packet::Row(row) => self.check_row(frame, &row),
            Packet::Region(region) => self.check_region(frame, &region),
            Packet::End(end) => self.check_end(frame, end),
            Packet::Scores(_) => Err(BusMismatch::from_presence("a SCORES packet", false)),
            Packet::Register(_) => Err(BusMismatch::from_presence("a REGISTER packet", false)),
            Packet::Flow(_) => Err(BusMismatch::from_presence("a FLOW packet", false)),
        }
    }

    fn begin_frame(&mut self, number: u32, info: &FrameInfo, left: u64) -> Result<(), BusMismatch> {
        if let Some(open) = &self.open {
            return Err(BusMismatch::from_numbers(
                "the END of the frame before its FRAME",
                open.number,
                number,
            ));
        }
        let at = number as usize;
        if at < self.next_frame {
            return Err(BusMismatch::from_numbers(
                "the number of a frame",
                self.next_frame,
                number,
            ));
        }
        let sent = self.expected_frame(at)?;
        self.pass_missing_frames(at)?;
        if matches!(sent.fate, FrameFate::LeftOut | FrameFate::Skipped) {
            return Err(BusMismatch::from_presence("a frame that must be left out", false));
        }
        self.next_frame = at + 1;
        let first = std::mem::take(&mut self.is_first) || sent.is_first;
        let map_version = info.map_version;
        if !sent.maps.admit(map_version) {
            let (first, count) = (sent.maps.first_version, sent.maps.maps.len());
            let at = format!(
                "version {map_version} of the map of classes, expected one of {count} from {first} on"
            );
            return Err(BusMismatch::from_presence(at, false));
        }
        let newest = self.map_versions.iter().rfind(|(clock, _)| *clock < left);
        self.facts.frames_behind_commit +=
            u64::from(newest.is_some_and(|&(_, version)| version == map_version.wrapping_add(1)));
        let before = std::mem::replace(&mut self.map_version, map_version);
        self.facts.maps_by_turns += u64::from(sent.maps.take_turns && before != map_version);
        let own = self.checker.layout.info().clone();
        let expected = FrameInfo { first, time: info.time, map_version, ..own };
        if *info != expected {
            let at = format!("what FRAME says: {info:?}, expected {expected:?}");
            return Err(BusMismatch::from_presence(at, false));
        }
        self.check_time(info.time, left)?;
        let outcome = self.step_model(sent, map_version, first);
        let regions = outcome.srs.len();
        self.open = Some(OpenFrame {
            number,
            is_cut: sent.fate == FrameFate::CutByReset,
            outcome,
            decisions: vec![None; regions],
            next_row: 0,
            rows: 0,
            has_arrived: vec![false; regions],
        });
        Ok(())
    }

    /// Advances the model by a frame that arrived, and returns its outcome.
    fn step_model(
        &mut self,
        sent: &ExpectedFrame,
        map_version: u16,
        first: bool,
    ) -> FunctionalOutcome {
        if first {
            self.facts.restarted += u64::from(self.agreement.frames > 0);
            self.model.reset();
        } else {
            self.facts.behind_loss += self.model.lost_regions();
        }
        self.facts.behind_skipped += u64::from(std::mem::take(&mut self.has_skipped));
        if sent.camera_index != self.camera {
            (self.camera_before, self.camera) = (self.camera, sent.camera_index);
        }
        if let Some(map) = sent.maps.map(map_version) {
            self.facts.maps += u64::from(map_version > 0);
            self.model.set_classes(map);
        }
        let missed = self.stale_outcomes(sent);
        let outcome = self.model.step(&sent.frame, sent.camera_index);
        for (register, other) in missed {
            let differs =
                (0..outcome.srs.len()).any(|at| outcome.decision(at) != other.decision(at));
            *self.facts.taken_over.entry(register).or_default() += u64::from(differs);
        }
        outcome
    }

    /// Returns the outcomes that the frame would have if a threshold had not been taken over, for
    /// the thresholds that have not yet decided anything.
    fn stale_outcomes(&self, sent: &ExpectedFrame) -> Vec<(String, FunctionalOutcome)> {
        let is_open = |missed: &&StaleThreshold<'_>| {
            self.facts.taken_over.get(&missed.register).copied().unwrap_or_default() == 0
        };
        let open = self.checker.stale_thresholds.iter().filter(is_open);
        let found = open.filter_map(|missed| {
            let camera = missed.camera_with_stale_value(self.camera, self.camera_before)?;
            Some((missed.register.clone(), self.model.outcome_with(&sent.frame, &camera)))
        });
        found.collect()
    }

    /// Checks the time of a frame, which is when it began: after all words of the frame before it,
    /// and before the first word of its FRAME packet left.
    fn check_time(&mut self, time: u64, left: u64) -> Result<(), BusMismatch> {
        let latest = left - self.start;
        if time < self.earliest_time {
            return Err(BusMismatch::from_numbers(
                "the time of a frame, at least",
                self.earliest_time,
                time,
            ));
        }
        if time >= latest {
            return Err(BusMismatch::from_numbers("the time of a frame, below", latest, time));
        }
        self.earliest_time = time + self.checker.transfers;
        Ok(())
    }

    fn expected_frame(&self, at: usize) -> Result<&'a ExpectedFrame, BusMismatch> {
        let all = &self.session.frames;
        all.get(at)
            .ok_or_else(|| BusMismatch::from_numbers("the number of a frame, below", all.len(), at))
    }

    /// Passes over the expected frames up to `at`, which have not arrived. Fails if one of them had
    /// to arrive.
    fn pass_missing_frames(&mut self, at: usize) -> Result<(), BusMismatch> {
        for number in self.next_frame..at {
            let sent = self.expected_frame(number)?;
            self.is_first |= sent.is_first;
            match sent.fate {
                FrameFate::MaybeSkipped | FrameFate::Skipped => {
                    self.skipped += 1;
                    self.has_skipped = true;
                }
                FrameFate::LeftOut => self.facts.left_out += 1,
                FrameFate::CutByReset => {}
                FrameFate::Taken => {
                    let missing =
                        BusMismatch::from_presence(format!("the packets of frame {number}"), true);
                    return Err(BusMismatch { frame: number as u64, ..missing });
                }
            }
        }
        Ok(())
    }

    fn open_frame(&mut self, number: u32) -> Result<&mut OpenFrame, BusMismatch> {
        let Some(open) = &mut self.open else {
            return Err(BusMismatch::from_presence("a packet between END and FRAME", false));
        };
        if open.number != number {
            return Err(BusMismatch::from_numbers("the number of the frame", open.number, number));
        }
        Ok(open)
    }

    fn check_row(&mut self, number: u32, row: &RowPacket) -> Result<(), BusMismatch> {
        let columns = self.checker.layout.columns();
        let open = self.open_frame(number)?;
        if row.row < open.next_row {
            return Err(BusMismatch::from_numbers("the row, at least", open.next_row, row.row));
        }
        open.next_row = row.row + 1;
        open.rows += 1;
        for (region, &decision) in (row.row * columns..).zip(&row.decisions) {
            let (at, code) = (region as usize, |decision: RegionDecision| {
                u8::from(decision.srs)
                    | u8::from(decision.trs) << 1
                    | u8::from(decision.summary) << 2
            });
            let expected = open.outcome.decision(at);
            if decision != expected {
                let what = "srs, trs and summary, from the lowest bit on";
                return Err(BusMismatch::from_numbers(what, code(expected), code(decision))
                    .with_region(region));
            }
            if open.has_arrived[at] && !sends_values(decision) {
                return Err(BusMismatch::from_presence(
                    "pixels of a region that sends none",
                    false,
                )
                .with_region(region));
            }
            open.decisions[at] = Some(decision);
        }
        Ok(())
    }

    fn check_region(&mut self, number: u32, region: &RegionPacket) -> Result<(), BusMismatch> {
        let columns = self.checker.layout.columns();
        let raw = self.checker.layout.info().raw;
        let camera = &self.checker.cameras[0];
        let open = self.open_frame(number)?;
        let name = region.row * columns + region.column;
        let at = name as usize;
        let wrong = |wrong: BusMismatch| wrong.with_region(name);
        if std::mem::replace(&mut open.has_arrived[at], true) {
            return Err(wrong(BusMismatch::from_presence("its REGION a second time", false)));
        }
        let decision = open.outcome.decision(at);
        if !sends_values(decision) {
            return Err(wrong(BusMismatch::from_presence(
                "pixels of a region that sends none",
                false,
            )));
        }
        if decision.summary != region.flags.summary {
            return Err(wrong(BusMismatch::from_presence(
                "the flag `summary`",
                !region.flags.summary,
            )));
        }
        if raw != region.flags.raw {
            return Err(wrong(BusMismatch::from_presence("the flag `raw`", raw)));
        }
        let expected = match region.flags.summary {
            true => open.outcome.means[at].clone(),
            false => active_pixels(camera, &open.outcome, region.row, region.column),
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
                Err(wrong(BusMismatch::from_numbers(what, expected[place], region.values[place])))
            }
        }
    }

    fn check_end(&mut self, number: u32, end: EndPacket) -> Result<(), BusMismatch> {
        let rows = self.checker.layout.rows();
        let BusSession { is_lossless, keeps_rows, .. } = *self.session;
        let open = self.open_frame(number)?;
        let sent: u32 = open.has_arrived.iter().map(|&came| u32::from(came)).sum();
        if end.regions_sent != sent {
            return Err(BusMismatch::from_numbers(
                "REGION packets that END counts",
                sent,
                end.regions_sent,
            ));
        }
        let lost_rows = rows - open.rows;
        if end.rows_dropped != lost_rows {
            return Err(BusMismatch::from_numbers(
                "dropped rows that END counts",
                lost_rows,
                end.rows_dropped,
            ));
        }
        let is_lost =
            |at: &usize| !open.has_arrived[*at] && sends_values(open.outcome.decision(*at));
        let lost = (0..open.has_arrived.len()).filter(is_lost);
        let lost: Vec<u32> = lost.map(|at| u32::try_from(at).unwrap_or(u32::MAX)).collect();
        let dropped = u32::try_from(lost.len()).unwrap_or(u32::MAX);
        if end.regions_dropped != dropped {
            let what = "dropped regions that END counts";
            return Err(BusMismatch::from_numbers(what, dropped, end.regions_dropped));
        }
        if is_lossless && (end.regions_dropped > 0 || end.rows_dropped > 0) {
            return Err(BusMismatch::from_numbers("dropped regions", 0, end.regions_dropped));
        }
        if keeps_rows && end.rows_dropped > 0 {
            return Err(BusMismatch::from_numbers("dropped rows", 0, end.rows_dropped));
        }
        self.open = None;
        lost.into_iter().for_each(|region| self.model.lose(region));
        self.dropped += end.regions_dropped;
        self.dropped_rows += end.rows_dropped;
        self.agreement.frames += 1;
        Ok(())
    }

    /// Checks the answers to reads of registers. A missing answer counts as missing at `end`, the
    /// last clock of the run, so that no earlier violation is hidden.
    fn check_registers(&mut self, heard: &SessionRecord, end: u64) -> Result<(), BusMismatch> {
        let mut reads = heard.reads.iter();
        for &(address, answer) in &self.session.reads {
            let name = self.checker.registers.iter().find(|register| register.address == address);
            let name = name.map_or("nothing", |register| &register.name);
            let wrong = |clock, at: String, expected: u32, got: u32| {
                let port = "s_axi".to_owned();
                BusMismatch { clock, port, ..BusMismatch::from_numbers(at, expected, got) }
            };
            let Some(&(clock, at, value)) = reads.next() else {
                return Err(wrong(end, format!("an answer to a read of {name}"), 1, 0));
            };
            let expected = self.expected_value(answer);
            if (at, value) != (address, expected) {
                let what = format!("the register {name} at 'h{address:03x}");
                return Err(wrong(clock, what, expected, value));
            }
            self.agreement.comparisons += 1;
            if name == "events" {
                for event in
                    EVENTS.into_iter().filter(|name| value & self.checker.event_mask(name) != 0)
                {
                    *self.facts.event_reads.entry(event).or_default() += 1;
                }
            }
        }
        Ok(())
    }

    /// Checks that events that were cleared again and again have been seen as often as they must.
    fn check_event_counts(&mut self, heard: &SessionRecord, end: u64) -> Result<(), BusMismatch> {
        let mut counts = heard.interrupt_counts.iter();
        for &(event, raised) in &self.session.event_counts {
            let port = "interrupt_o".to_owned();
            let Some(&InterruptCount { clock, count, met_clears: met }) = counts.next() else {
                return Err(BusMismatch {
                    clock: end,
                    port,
                    ..BusMismatch::from_presence(format!("a count of {event}"), true)
                });
            };
            let (least, most) = match raised {
                ExpectedEventCount::Exactly(times) => (times, times),
                ExpectedEventCount::SkippedFrames => (self.skipped, self.skipped),
                ExpectedEventCount::DroppedRows => (self.dropped_rows, self.dropped_rows),
                ExpectedEventCount::DroppedRegions => (self.dropped.min(1), self.dropped),
            };
            let bound = if count < least.into() { least } else { most };
            if !(u64::from(least)..=u64::from(most)).contains(&count) {
                let at = format!("how often {event} is seen while it is cleared");
                return Err(BusMismatch {
                    clock,
                    port,
                    ..BusMismatch::from_numbers(at, bound, count)
                });
            }
            *self.facts.met_clears.entry(event).or_default() += met;
            self.agreement.comparisons += 1;
        }
        Ok(())
    }

    fn expected_value(&self, answer: ExpectedRead) -> u32 {
        let event = |name, happened: bool| if happened { self.checker.event_mask(name) } else { 0 };
        match answer {
            ExpectedRead::Value(value) => value,
            ExpectedRead::SkippedFrames => self.skipped & COUNTER_MASK,
            ExpectedRead::DroppedRegions => self.dropped & COUNTER_MASK,
            ExpectedRead::Events(others) => {
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
fn encode_packet(layout: &PacketLayout, frame: u32, packet: &Packet) -> Vec<u8> {
    let mut bytes = Vec::new();
    // A packet that cannot be written leaves `bytes` empty.
    let _ = match packet {
        Packet::Frame(info) => {
            let (start, version) = ((info.time, info.first), info.map_version);
            packet_encoding::append_frame_of_map(&mut bytes, layout, frame, start, version)
        }
        Packet::Row(row) => {
            packet_encoding::append_row(&mut bytes, layout, frame, row.row, &row.decisions)
        }
        Packet::Region(RegionPacket { row, column, flags, values }) => {
            packet_encoding::append_region(
                &mut bytes,
                layout,
                frame,
                (*row, *column),
                (*flags, values),
            )
        }
        Packet::End(end) => packet_encoding::append_end(&mut bytes, frame, *end),
        // A core sends none of them; the caller reports them.
        Packet::Scores(_) | Packet::Register(_) | Packet::Flow(_) => Ok(()),
    };
    bytes
}

/// Access to the decision of a region, as a ROW packet has it.
trait RegionDecisions {
    fn decision(&self, region: usize) -> RegionDecision;
}

impl RegionDecisions for FunctionalOutcome {
    fn decision(&self, region: usize) -> RegionDecision {
        let summary = match self.actions[region] {
            RegionAction::Summarize => true,
            RegionAction::Forward | RegionAction::Hold | RegionAction::Blank => false,
        };
        RegionDecision { srs: self.srs[region], trs: self.trs[region], summary }
    }
}

/// Returns true if pixels or means follow from a decision.
fn sends_values(decision: RegionDecision) -> bool {
    (decision.srs && decision.trs) || decision.summary
}

/// Returns the pixels that an active region sends.
fn active_pixels(camera: &Camera, outcome: &FunctionalOutcome, row: u32, column: u32) -> Vec<u16> {
    let (side, payload) = (camera.region_size(), outcome.payload(camera));
    let (left, top) = ((column * side) as usize, row * side);
    let line = |y: u32| payload.row(y).iter().skip(left).take(side as usize).copied();
    (top..top + side).flat_map(line).collect()
}

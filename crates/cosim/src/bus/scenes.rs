// SPDX-License-Identifier: MIT OR Apache-2.0
//! The directed scenes on the buses of a core. Every scene is played in a run of its own.

use super::checker::TICK_RATE;
use super::frame_source::{BusFrameSource, VideoDamage};
use super::traffic::{ExpectedFrame, ExpectedRead, FrameFate, FrameMaps, Traffic};
use crate::stimulus::Random;
use foveate_camera::{Camera, RegionClass};
use foveate_design::{Design, RasterDesign, RasterTiming};
use foveate_emit::{FieldKind, Register};
use foveate_pixels::Frame;

/// The approximate number of clocks that a scene may take.
const SCENE_CLOCKS: u64 = 4_000_000;
/// The strobes that write no byte; `LOWEST` writes the lowest byte.
const NO_BYTES: u32 = 0;
const LOWEST_BYTE: u32 = 1;
const ALL_BYTES: u32 = super::traffic::ALL_BYTES;
/// The last word address; no register is there.
const LAST_ADDRESS: u32 = 0xFFC;
const STORM_ACCESSES: usize = 60;
/// The number of resets among accesses. Each comes at most `MAX_RESET_DELAY` clocks after the
/// accesses, while one is under way or its answer waits.
const RESET_COUNT: u64 = 40;
const MAX_RESET_DELAY: u64 = 14;

pub(super) type BusScene<'a> = (&'static str, Traffic<'a>);

/// The registers of a core with other thresholds, and the class whose regions show that they
/// differ.
pub(super) struct OtherThresholds {
    pub(super) class: RegionClass,
    pub(super) registers: Vec<Register>,
}

/// The builder of the scenes of a core.
pub(super) struct SceneBuilder<'a> {
    design: RasterDesign<'a>,
    registers: &'a [Register],
    /// The same core with other thresholds; empty if thresholds are constants.
    other_thresholds: &'a [OtherThresholds],
    random: Random,
    frame_source: BusFrameSource,
}

impl<'a> SceneBuilder<'a> {
    pub(super) fn new(
        design: RasterDesign<'a>,
        registers: &'a [Register],
        others: &'a [OtherThresholds],
        seed: u64,
    ) -> Self {
        let mut random = Random::new(seed);
        let frame_source = BusFrameSource::new(design, &mut random);
        Self { design, registers, other_thresholds: others, random, frame_source }
    }

    /// Returns the scenes that every core must pass.
    pub(super) fn scenes(&mut self) -> Vec<BusScene<'a>> {
        let mut scenes = vec![
            ("video", self.video()),
            ("full rate", self.full_rate()),
            ("stalls", self.stalls()),
            ("damaged video", self.damaged_video()),
            ("stopped sink", self.stopped_sink()),
            ("control", self.control_scene()),
            ("reset", self.resets_at_any_time()),
            ("reset of registers", self.resets_of_registers()),
            ("registers", self.register_file()),
            ("events and their clears", self.event_clears()),
            ("thresholds", self.every_threshold()),
        ];
        scenes.extend(self.class_scenes());
        scenes
    }

    pub(super) fn design(&self) -> RasterDesign<'a> {
        self.design
    }

    pub(super) fn random(&mut self) -> &mut Random {
        &mut self.random
    }

    pub(super) fn frame_source(&mut self) -> &mut BusFrameSource {
        &mut self.frame_source
    }

    /// Sends the frames of the caller, none of which may be lost.
    pub(super) fn caller_frames(&mut self, frames: &[Frame]) -> Traffic<'a> {
        let mut traffic = self.waiting_traffic();
        frames.iter().for_each(|frame| traffic.send_frame(taken_frame(frame.clone())));
        self.end_session(&mut traffic, 0);
        traffic
    }

    fn video(&mut self) -> Traffic<'a> {
        let mut traffic = self.waiting_traffic();
        for _ in 0..self.frame_count() {
            traffic.send_frame(taken_frame(self.frame_source.next()));
        }
        self.end_session(&mut traffic, 0);
        traffic.read(self.address("frames"), ExpectedRead::Value(self.frame_count()));
        traffic.read(self.address("status"), ExpectedRead::Value(0));
        traffic.wait_for_accesses();
        traffic
    }

    /// Sends frames without gaps. A core that cannot send all regions at this rate drops some.
    fn full_rate(&mut self) -> Traffic<'a> {
        let mut traffic = self.waiting_traffic();
        traffic.set_gaps(0);
        traffic.allow_drops();
        for _ in 0..self.frame_count() {
            traffic.send_frame(taken_frame(self.frame_source.next()));
        }
        self.end_session(&mut traffic, 0);
        traffic
    }

    fn stalls(&mut self) -> Traffic<'a> {
        let mut traffic = Traffic::new(self.design);
        traffic.reset();
        traffic.allow_drops();
        for stalls in [20, 60, 90] {
            traffic.set_stalls(stalls);
            for gaps in [0, 10] {
                traffic.set_gaps(gaps);
                traffic.send_frame(ExpectedFrame {
                    fate: FrameFate::MaybeSkipped,
                    ..taken_frame(self.frame_source.next())
                });
            }
        }
        self.end_session(&mut traffic, 0);
        traffic
    }

    fn damaged_video(&mut self) -> Traffic<'a> {
        let mut traffic = self.waiting_traffic();
        if !self.sustains_full_rate() {
            // The transfers that the core adds in place of missing ones come without gaps.
            traffic.allow_drops();
        }
        traffic.send_frame(taken_frame(self.frame_source.next()));
        let (mut repaired, mut events) = (0, 0);
        for damage in VideoDamage::ALL {
            let frame = self.frame_source.next();
            if let Some(frame) = damage.send(&mut traffic, &mut self.random, &frame) {
                traffic.expect_frame(taken_frame(frame));
            }
            traffic.send_frame(taken_frame(self.frame_source.next()));
            repaired += u32::from(damage.is_repaired());
            events |= self.event_mask(damage.event());
        }
        self.end_session(&mut traffic, events);
        traffic.read(self.address("repaired"), ExpectedRead::Value(repaired));
        traffic.wait_for_accesses();
        traffic
    }

    /// Stops the sink for some frames. Without `wait` frames are skipped, with `wait` their source
    /// waits.
    fn stopped_sink(&mut self) -> Traffic<'a> {
        let frame = self.design.timing().clocks_per_frame();
        let mut traffic = Traffic::new(self.design);
        // The sink takes nothing from reset on, for longer than three frames. The first frame
        // waits, and no source waits for it.
        traffic.reset();
        traffic.allow_drops();
        traffic.hold_sink(5 * frame + 2000);
        for fate in [FrameFate::Taken, FrameFate::Skipped, FrameFate::Skipped] {
            traffic.send_frame(ExpectedFrame { fate, ..taken_frame(self.frame_source.next()) });
        }
        // The next frame is compared with the one before the skipped frames.
        traffic.drain();
        traffic.send_frame(taken_frame(self.frame_source.next()));
        self.end_session(&mut traffic, 0);
        traffic.reset();
        traffic.allow_drops();
        let either = |frame| ExpectedFrame { fate: FrameFate::MaybeSkipped, ..taken_frame(frame) };
        traffic.send_frame(either(self.frame_source.next()));
        traffic.hold_sink(3 * frame);
        for _ in 0..5 {
            traffic.send_frame(either(self.frame_source.next()));
        }
        traffic.write(self.address("control"), self.control_bits(&["enable", "wait"]));
        traffic.hold_sink(2 * frame);
        // A frame that came before `wait` was written may still be skipped.
        traffic.send_frame(either(self.frame_source.next()));
        for _ in 0..2 {
            traffic.send_frame(taken_frame(self.frame_source.next()));
        }
        // A restart forgets the references, and the counters go on.
        traffic.drain();
        traffic.write(self.address("control"), self.control_bits(&["enable", "wait", "restart"]));
        traffic
            .send_frame(ExpectedFrame { is_first: true, ..taken_frame(self.frame_source.next()) });
        self.end_session(&mut traffic, 0);
        self.hold_two_rows(&mut traffic);
        traffic
    }

    /// The packets of one row of regions leave, and the next two rows wait for the sink until both
    /// are decided. None of the three is dropped. The source waits too, so that neither the second
    /// pass nor the number of pixels per clock decides when the third row comes.
    fn hold_two_rows(&mut self, traffic: &mut Traffic<'a>) {
        let stops = [1, 3].map(|rows| self.lines_to_decide(rows));
        // Nothing holds back the rows of a frame that is whole, so a fourth one would be dropped.
        let is_whole = stops[1] >= self.design.height();
        if self.design.rows() < 3 || (self.design.rows() > 3 && is_whole) {
            return;
        }
        traffic.reset();
        traffic.allow_region_drops();
        traffic.set_gaps(0);
        let mut is_held = false;
        traffic.send_frame_around_each(
            taken_frame(self.frame_source.sparse_frame()),
            stops.map(|line| line.min(self.design.height())),
            |traffic| {
                if is_held {
                    traffic.wait_clocks(traffic.drain_clocks());
                    traffic.hold_sink(0);
                    traffic.drain();
                } else {
                    traffic.drain();
                    traffic.hold_sink(u64::from(u32::MAX));
                    is_held = true;
                }
            },
        );
        self.end_session(traffic, 0);
    }

    /// Returns the number of lines of a frame after which the core can decide the first `rows` rows
    /// of regions, and nothing of the next row. Each window holds back a line and a word.
    fn lines_to_decide(&self, rows: u32) -> u32 {
        let windows = RasterTiming::from_design(self.design).windows;
        let held_back = if windows > 0 { windows + 1 } else { 0 };
        rows * self.design.region_size() + held_back
    }

    /// Writes thresholds, `restart` and `enable` while frames come.
    fn control_scene(&mut self) -> Traffic<'a> {
        let control = self.address("control");
        let mut traffic = self.waiting_traffic();
        let middle = self.design.height() / 2;
        traffic.send_frame(taken_frame(self.frame_source.quiet_frame()));
        self.write_passing_thresholds(&mut traffic);
        let camera = self.switch_thresholds(&mut traffic, middle, 0, 1);
        let next = |source: &mut BusFrameSource| ExpectedFrame {
            camera_index: camera,
            ..taken_frame(source.next())
        };
        traffic.send_frame(next(&mut self.frame_source));
        traffic.send_frame(next(&mut self.frame_source));
        // A restart that is written within a frame waits for the end of the frame.
        let restart = self.control_bits(&["enable", "wait", "restart"]);
        let (status, waits) = (self.address("status"), self.status_bits(&["busy", "restarting"]));
        traffic.send_frame_around(next(&mut self.frame_source), middle, |traffic| {
            traffic.write(control, restart);
            traffic.read(status, ExpectedRead::Value(waits));
            traffic.wait_for_accesses();
        });
        traffic.send_frame(ExpectedFrame { is_first: true, ..next(&mut self.frame_source) });
        traffic.send_frame(next(&mut self.frame_source));
        // Only frames that come while the core is not enabled are left out.
        let disabled = self.control_bits(&["wait"]);
        traffic.send_frame_around(next(&mut self.frame_source), middle, |traffic| {
            traffic.write(control, disabled);
        });
        let left_out = |source: &mut BusFrameSource| ExpectedFrame {
            fate: FrameFate::LeftOut,
            ..taken_frame(source.next())
        };
        traffic.send_frame(left_out(&mut self.frame_source));
        let enabled = self.control_bits(&["enable", "wait"]);
        traffic.send_frame_around(left_out(&mut self.frame_source), middle, |traffic| {
            traffic.write(control, enabled);
        });
        traffic.send_frame(next(&mut self.frame_source));
        traffic.drain();
        traffic.write(control, restart);
        traffic.send_frame(ExpectedFrame { is_first: true, ..next(&mut self.frame_source) });
        traffic.send_frame(next(&mut self.frame_source));
        let camera = self.switch_thresholds(&mut traffic, middle, camera, 0);
        for _ in 0..2 {
            traffic.send_frame(ExpectedFrame {
                camera_index: camera,
                ..taken_frame(self.frame_source.next())
            });
        }
        // Every pixel changes by less than the highest bit of the level, and many change by more
        // than the other levels.
        let camera = self.switch_thresholds(&mut traffic, middle, camera, 2);
        for _ in 0..2 {
            traffic.send_frame(ExpectedFrame {
                camera_index: camera,
                ..taken_frame(self.frame_source.dark_frame())
            });
        }
        self.end_session(&mut traffic, 0);
        // The register also counts the frames that were left out.
        traffic.read(self.address("frames"), ExpectedRead::Value(traffic.frame_count()));
        traffic.wait_for_accesses();
        traffic
    }

    /// Writes other thresholds within a frame, while its first regions are decided, and restores
    /// them before its end. They must change nothing.
    fn write_passing_thresholds(&mut self, traffic: &mut Traffic<'a>) {
        let own: Vec<(u32, u32)> = self.registers.iter().filter_map(threshold_register).collect();
        let lines = [1, (self.design.region_size() + 3).min(self.design.height())];
        let mut others = [u32::MAX, 0].into_iter();
        traffic.send_frame_around_each(
            taken_frame(self.frame_source.quiet_frame()),
            lines,
            |traffic| {
                let other = others.next().unwrap_or_default();
                own.iter().for_each(|&(address, value)| traffic.write(address, value ^ other));
            },
        );
    }

    fn every_threshold(&mut self) -> Traffic<'a> {
        let mut traffic = self.waiting_traffic();
        self.send_threshold_sweep(&mut traffic, RegionClass::Normal, &FrameMaps::default());
        self.end_session(&mut traffic, 0);
        traffic
    }

    /// Sends frames of noise, and within each frame writes the thresholds of the next: those that
    /// are for regions of a class. The frames have the map of classes of `maps`.
    pub(super) fn send_threshold_sweep(
        &mut self,
        traffic: &mut Traffic<'a>,
        class: RegionClass,
        maps: &FrameMaps,
    ) {
        let middle = self.design.height() / 2;
        let others: &'a [OtherThresholds] = self.other_thresholds;
        let own = others.iter().zip(1..).filter(|(other, _)| other.class == class);
        let sets = own.map(|(other, camera)| (camera, other.registers.as_slice()));
        let sets: Vec<_> = sets.chain([(0, self.registers)]).collect();
        let mut camera_index = 0;
        for (next, registers) in sets {
            let sent = ExpectedFrame {
                camera_index,
                maps: maps.clone(),
                ..taken_frame(self.frame_source.noise_frame())
            };
            let written: Vec<_> = registers.iter().filter_map(threshold_register).collect();
            traffic.send_frame_around(sent, middle, |traffic| {
                written.iter().for_each(|&(address, value)| traffic.write(address, value));
            });
            camera_index = next;
        }
    }

    /// Writes the thresholds of camera `to` within a frame; they hold from the next frame on.
    /// Returns the index of the camera of the next frame, which is `from` if there is no camera
    /// `to`.
    fn switch_thresholds(
        &mut self,
        traffic: &mut Traffic<'a>,
        middle: u32,
        from: usize,
        to: usize,
    ) -> usize {
        let Some(others) = self.other_thresholds.get(to.max(1) - 1) else { return from };
        let registers = if to == 0 { self.registers } else { &others.registers };
        let written: Vec<(u32, u32)> = registers.iter().filter_map(threshold_register).collect();
        let frame =
            ExpectedFrame { camera_index: from, ..taken_frame(self.frame_source.quiet_frame()) };
        traffic.send_frame_around(frame, middle, |traffic| {
            written.iter().for_each(|&(address, value)| traffic.write(address, value));
        });
        to
    }

    /// Resets the core at any time: within a frame, while packets leave, while a word waits for the
    /// sink, and within a packet.
    fn resets_at_any_time(&mut self) -> Traffic<'a> {
        let mut traffic = self.waiting_traffic();
        let (side, height) = (self.design.region_size(), self.design.height());
        let decided = (side + side / 2).min(height - 1);
        for (hold, is_within) in
            [(0, false), (u64::from(u32::MAX), false), (u64::from(u32::MAX), true)]
        {
            traffic.send_frame(taken_frame(self.frame_source.next()));
            traffic.drain();
            traffic.allow_drops();
            traffic.hold_sink(hold);
            let lines = decided + self.random.up_to_u32(height - decided);
            let cut = ExpectedFrame {
                fate: FrameFate::CutByReset,
                ..taken_frame(self.frame_source.noise_frame())
            };
            traffic.send_torn_frame(cut, lines.clamp(1, height));
            if is_within {
                traffic.hold_sink(0);
                traffic.wait_within_packet();
            }
            traffic.wait_clocks(self.random.up_to(if is_within { 0 } else { 40 }));
            traffic.reset_for(1);
            self.enable_waiting(&mut traffic);
            traffic.send_frame(taken_frame(self.frame_source.next()));
            traffic.send_frame(taken_frame(self.frame_source.next()));
            traffic.drain();
            self.begin_waiting(&mut traffic);
        }
        traffic.send_frame(taken_frame(self.frame_source.next()));
        self.end_session(&mut traffic, 0);
        traffic
    }

    /// Resets the core for one clock among reads and writes. No access is answered afterwards, and
    /// no register keeps what was written.
    fn resets_of_registers(&mut self) -> Traffic<'a> {
        let mut traffic = Traffic::new(self.design);
        traffic.reset();
        // A reset clears every register that can have another value.
        for register in self.registers.iter().filter(|one| !is_class_register(one)) {
            traffic.write_bytes(register.address, !reset_value(register), ALL_BYTES);
        }
        traffic.wait_for_accesses();
        traffic.reset_for(1);
        self.expect_reset_values(&mut traffic);
        for _ in 0..RESET_COUNT {
            for _ in 0..4 {
                let (read, written) = (self.random_register(), self.random_register());
                // A map of classes stays at a reset.
                if !is_class_register(written) {
                    let value = self.random.up_to_u32(u32::MAX);
                    traffic.write_bytes(written.address, value, ALL_BYTES);
                }
                traffic.read_unchecked(read.address);
            }
            traffic.set_in_order(self.random.one_in(2));
            traffic.wait_clocks(self.random.up_to(MAX_RESET_DELAY));
            traffic.reset_for(1);
            self.expect_reset_values(&mut traffic);
        }
        traffic
    }

    fn random_register(&mut self) -> &'a Register {
        &self.registers[self.random.index(self.registers.len() - 1)]
    }

    fn expect_reset_values(&self, traffic: &mut Traffic<'a>) {
        for register in self.registers {
            traffic.read(register.address, ExpectedRead::Value(reset_value(register)));
        }
        traffic.wait_for_accesses();
        traffic.expect_interrupt(false);
    }

    fn register_file(&mut self) -> Traffic<'a> {
        let mut traffic = Traffic::new(self.design);
        traffic.reset();
        self.expect_reset_values(&mut traffic);
        self.check_strobes(&mut traffic);
        self.check_unused_addresses(&mut traffic);
        self.check_interrupts(&mut traffic);
        self.access_storm(&mut traffic);
        traffic
    }

    /// Writes every register with several combinations of byte strobes.
    fn check_strobes(&mut self, traffic: &mut Traffic<'a>) {
        for register in self.registers {
            let mut value = reset_value(register);
            for strobes in [
                ALL_BYTES,
                NO_BYTES,
                LOWEST_BYTE,
                0b1010,
                0b0110,
                self.random.up_to_u32(ALL_BYTES),
                ALL_BYTES,
            ] {
                let data = self.random.up_to_u32(u32::MAX);
                let bytes = (0..4).filter(|byte| strobes >> byte & 1 == 1);
                let bytes = bytes.fold(0_u32, |mask, byte| mask | 0xFF << (8 * byte));
                let mask = match register.name.as_str() {
                    "control" | "events" | "interrupt_test" => continue,
                    // These have scenes of their own.
                    "zone_word" | "zone_control" => continue,
                    _ => writable_mask(register) & bytes,
                };
                value = (value & !mask) | (data & mask);
                traffic.write_bytes(register.address, data, strobes);
                traffic.read(register.address, ExpectedRead::Value(value));
            }
            if writable_mask(register) != 0 {
                traffic.write_bytes(register.address, reset_value(register), ALL_BYTES);
            }
            traffic.read(register.address, ExpectedRead::Value(reset_value(register)));
        }
        traffic.wait_for_accesses();
    }

    /// Checks that addresses without a register read as 0, also after a write.
    fn check_unused_addresses(&mut self, traffic: &mut Traffic<'a>) {
        let is_there = |address| self.registers.iter().any(|register| register.address == address);
        let last = self.registers.last().map_or(0, |register| register.address);
        for address in [0x044, 0x0FC, last + 4, 0x400 + self.address("control"), LAST_ADDRESS] {
            if !is_there(address) {
                traffic.write_bytes(address, u32::MAX, ALL_BYTES);
                traffic.read(address, ExpectedRead::Value(0));
            }
        }
        traffic.read(self.address("control"), ExpectedRead::Value(self.control_bits(&["enable"])));
        traffic.wait_for_accesses();
    }

    /// Sets, enables and clears the events one by one.
    fn check_interrupts(&mut self, traffic: &mut Traffic<'a>) {
        let [events, enable, test] =
            ["events", "interrupt_enable", "interrupt_test"].map(|name| self.address(name));
        let all = writable_mask(self.register("interrupt_enable"));
        traffic.expect_interrupt(false);
        let mut set = 0;
        for bit in (0..u32::BITS).map(|bit| 1 << bit).filter(|bit| all & bit != 0) {
            traffic.write_bytes(test, bit, NO_BYTES);
            traffic.read(events, ExpectedRead::Value(set));
            traffic.write(test, bit);
            set |= bit;
            traffic.read(events, ExpectedRead::Value(set));
            traffic.write(enable, all & !bit & !set);
            traffic.expect_interrupt(false);
            traffic.write(enable, bit);
            traffic.expect_interrupt(true);
            traffic.write(enable, 0);
        }
        traffic.write_bytes(events, all, NO_BYTES);
        traffic.write(events, 0);
        traffic.read(events, ExpectedRead::Value(set));
        for bit in (0..u32::BITS).map(|bit| 1 << bit).filter(|bit| all & bit != 0) {
            traffic.write(enable, bit);
            traffic.expect_interrupt(true);
            traffic.write(events, bit);
            traffic.expect_interrupt(false);
            set &= !bit;
            traffic.read(events, ExpectedRead::Value(set));
        }
        traffic.write(enable, 0);
    }

    /// Reads and writes at the same time, also while a frame passes.
    fn access_storm(&mut self, traffic: &mut Traffic<'a>) {
        let [identity, enable] = ["identity", "interrupt_enable"].map(|name| self.address(name));
        let identity_value = reset_value(self.register("identity"));
        let data: Vec<u32> = (0..STORM_ACCESSES).map(|_| self.random.up_to_u32(u32::MAX)).collect();
        traffic.set_gaps(self.lossless_gaps());
        traffic.set_in_order(false);
        traffic.send_frame_around(taken_frame(self.frame_source.next()), 1, |traffic| {
            for &value in &data {
                traffic.write_bytes(enable, value, ALL_BYTES);
                traffic.read(identity, ExpectedRead::Value(identity_value));
            }
        });
        traffic.wait_for_accesses();
        traffic.set_in_order(true);
        traffic.write(enable, 0);
        // The written words do not include a restart.
        traffic.send_frame(taken_frame(self.frame_source.next()));
        self.end_session(traffic, 0);
    }

    /// Begins traffic for a core that was reset. Its source waits when it must, with gaps that let
    /// all regions leave.
    pub(super) fn waiting_traffic(&mut self) -> Traffic<'a> {
        let mut traffic = Traffic::new(self.design);
        self.begin_waiting(&mut traffic);
        traffic
    }

    fn begin_waiting(&mut self, traffic: &mut Traffic<'a>) {
        traffic.reset();
        self.enable_waiting(traffic);
    }

    pub(super) fn enable_waiting(&mut self, traffic: &mut Traffic<'a>) {
        traffic.set_stalls(0);
        traffic.set_gaps(self.lossless_gaps());
        traffic.write(self.address("control"), self.control_bits(&["enable", "wait"]));
    }

    /// Waits until all packets have left, and checks the counters and events.
    pub(super) fn end_session(&mut self, traffic: &mut Traffic<'a>, events: u32) {
        traffic.drain();
        traffic.read(self.address("skipped"), ExpectedRead::SkippedFrames);
        traffic.read(self.address("dropped"), ExpectedRead::DroppedRegions);
        traffic.read(
            self.address("events"),
            ExpectedRead::Events(events | self.event_mask("frame_done")),
        );
        traffic.wait_for_accesses();
    }

    /// Returns the gaps, in percent, with which no region is lost, because its packet leaves while
    /// the pixels of another region come.
    fn lossless_gaps(&self) -> u32 {
        let clocks = self.packet_words() * 4 + 1;
        let share = 100 * self.region_clocks() / (clocks + clocks / 2);
        100_u32.saturating_sub(share).clamp(25, 95)
    }

    /// Returns true if all regions can leave without gaps between the words of the video.
    fn sustains_full_rate(&self) -> bool {
        let clocks = self.packet_words() * 2 + 1;
        self.region_clocks() > clocks + clocks / 4
    }

    /// Returns the number of words of a REGION packet with pixels.
    fn packet_words(&self) -> u32 {
        let value_bits = if self.design.pixel_bits() <= 8 { 8 } else { 16 };
        (self.design.region_size().pow(2) * value_bits).div_ceil(64) + 2
    }

    /// Returns the number of clocks in which the pixels of a region come.
    fn region_clocks(&self) -> u32 {
        self.design.region_size().pow(2) / self.design.pixels_per_clock()
    }

    fn frame_count(&self) -> u32 {
        let frames = SCENE_CLOCKS / self.design.timing().clocks_per_frame().max(1);
        u32::try_from(frames.clamp(3, 7)).unwrap_or(3)
    }

    fn register(&self, name: &str) -> &'a Register {
        let found = self.registers.iter().find(|register| register.name == name);
        found.expect("every core has this register")
    }

    pub(super) fn address(&self, name: &str) -> u32 {
        self.register(name).address
    }

    pub(super) fn control_bits(&self, names: &[&str]) -> u32 {
        field_mask(self.register("control"), names)
    }

    fn status_bits(&self, names: &[&str]) -> u32 {
        field_mask(self.register("status"), names)
    }

    pub(super) fn event_mask(&self, name: &str) -> u32 {
        field_mask(self.register("events"), &[name])
    }
}

/// Returns a frame that must be taken, with the thresholds of the design.
pub(super) fn taken_frame(frame: Frame) -> ExpectedFrame {
    ExpectedFrame {
        frame,
        fate: FrameFate::Taken,
        is_first: false,
        camera_index: 0,
        maps: FrameMaps::default(),
    }
}

/// Returns the bits of the named fields of a register, each of which has one bit.
fn field_mask(register: &Register, names: &[&str]) -> u32 {
    let named = register.fields.iter().filter(|field| names.contains(&field.name.as_str()));
    named.fold(0, |bits, field| bits | 1 << field.low)
}

/// Returns true if a register belongs to the memory of classes, which keeps its map at a reset.
fn is_class_register(register: &Register) -> bool {
    register.name.starts_with("zone_")
}

fn reset_value(register: &Register) -> u32 {
    let status = if register.name == "tick_rate" { TICK_RATE } else { 0 };
    register
        .fields
        .iter()
        .fold(0, |value, field| value | field.kind.reset().unwrap_or(status) << field.low)
}

/// Returns the mask of the register bits that keep a written value.
fn writable_mask(register: &Register) -> u32 {
    register.fields.iter().fold(0, |mask, field| match field.kind {
        FieldKind::Control { .. }
        | FieldKind::Threshold { .. }
        | FieldKind::External { by_bytes: true } => {
            mask | u32::MAX >> (u32::BITS - field.width) << field.low
        }
        FieldKind::Constant(_)
        | FieldKind::Status
        | FieldKind::Command
        | FieldKind::Event
        | FieldKind::External { by_bytes: false } => mask,
    })
}

/// Returns the address and the reset value of a register that holds a threshold.
fn threshold_register(register: &Register) -> Option<(u32, u32)> {
    let is_one = |kind: &FieldKind| matches!(kind, FieldKind::Threshold { .. });
    let has = register.fields.iter().any(|field| is_one(&field.kind));
    has.then(|| (register.address, reset_value(register)))
}

/// Returns the cameras of the design and of the designs with other thresholds, in this order.
pub(super) fn cameras(design: &Design, others: &[Design]) -> Vec<Camera> {
    let camera = |design: &Design| Camera::clone(design);
    std::iter::once(design).chain(others).map(camera).collect()
}

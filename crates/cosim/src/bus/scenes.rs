// SPDX-License-Identifier: MIT OR Apache-2.0
//! The directed scenes on the buses of a core. Every scene is played in a run of its own.

use super::check::TICK_RATE;
use super::damage::Damage;
use super::film::Film;
use super::traffic::{Answer, Fate, Sent, Traffic};
use crate::stimulus::Random;
use foveate_design::{Camera, Design, RasterDesign};
use foveate_emit::{Kind, Register};
use foveate_frame::Frame;

/// The approximate number of clocks that a scene may take.
const CLOCKS: u64 = 4_000_000;
/// The strobes that write no byte; `LOWEST` writes the lowest byte.
const NONE: u32 = 0;
const LOWEST: u32 = 1;
const ALL: u32 = super::traffic::ALL;
/// The last word address; no register is there.
const END: u32 = 0xFFC;
/// The number of accesses in a storm.
const STORM: usize = 60;
/// The number of resets among accesses. Each comes at most `ACCESSES` clocks after the accesses,
/// while one is under way or its answer waits.
const RESETS: u64 = 40;
const ACCESSES: u64 = 14;

/// A scene: its name and its traffic.
pub(super) type Scene<'a> = (&'static str, Traffic<'a>);

/// The builder of the scenes of a core.
pub(super) struct Stage<'a> {
    design: RasterDesign<'a>,
    registers: &'a [Register],
    /// The registers of the same core with other thresholds; empty if thresholds are constants.
    others: &'a [Vec<Register>],
    random: Random,
    film: Film,
}

impl<'a> Stage<'a> {
    pub(super) fn new(
        design: RasterDesign<'a>,
        registers: &'a [Register],
        others: &'a [Vec<Register>],
        seed: u64,
    ) -> Self {
        let mut random = Random::new(seed);
        let film = Film::new(design, &mut random);
        Self { design, registers, others, random, film }
    }

    /// Returns the scenes that every core must pass.
    pub(super) fn scenes(&mut self) -> Vec<Scene<'a>> {
        vec![
            ("video", self.video()),
            ("full rate", self.full_rate()),
            ("stalls", self.stalls()),
            ("damaged video", self.damaged()),
            ("stopped sink", self.stopped_sink()),
            ("control", self.control()),
            ("reset", self.resets()),
            ("reset of registers", self.resets_of_registers()),
            ("registers", self.register_file()),
            ("events and their clears", self.clears()),
            ("thresholds", self.every_threshold()),
        ]
    }

    pub(super) fn design(&self) -> RasterDesign<'a> {
        self.design
    }

    pub(super) fn film(&mut self) -> &mut Film {
        &mut self.film
    }

    /// Sends the frames of the caller, none of which may be lost.
    pub(super) fn frames(&mut self, frames: &[Frame]) -> Traffic<'a> {
        let mut traffic = self.waiting();
        frames.iter().for_each(|frame| traffic.frame(taken(frame.clone())));
        self.end(&mut traffic, 0);
        traffic
    }

    fn video(&mut self) -> Traffic<'a> {
        let mut traffic = self.waiting();
        for _ in 0..self.count() {
            traffic.frame(taken(self.film.next()));
        }
        self.end(&mut traffic, 0);
        traffic.read(self.address("frames"), Answer::Is(self.count()));
        traffic.read(self.address("status"), Answer::Is(0));
        traffic.join();
        traffic
    }

    /// Sends frames without gaps. A core that cannot send all regions at this rate drops some.
    fn full_rate(&mut self) -> Traffic<'a> {
        let mut traffic = self.waiting();
        traffic.gaps(0);
        traffic.may_drop();
        for _ in 0..self.count() {
            traffic.frame(taken(self.film.next()));
        }
        self.end(&mut traffic, 0);
        traffic
    }

    fn stalls(&mut self) -> Traffic<'a> {
        let mut traffic = Traffic::new(self.design);
        traffic.reset();
        traffic.may_drop();
        for stalls in [20, 60, 90] {
            traffic.stalls(stalls);
            for gaps in [0, 10] {
                traffic.gaps(gaps);
                traffic.frame(Sent { fate: Fate::Either, ..taken(self.film.next()) });
            }
        }
        self.end(&mut traffic, 0);
        traffic
    }

    fn damaged(&mut self) -> Traffic<'a> {
        let mut traffic = self.waiting();
        if !self.is_fast() {
            // The transfers that the core adds in place of missing ones come without gaps.
            traffic.may_drop();
        }
        traffic.frame(taken(self.film.next()));
        let (mut repaired, mut events) = (0, 0);
        for damage in Damage::ALL {
            let frame = self.film.next();
            if let Some(frame) = damage.send(&mut traffic, &mut self.random, &frame) {
                traffic.expect(taken(frame));
            }
            traffic.frame(taken(self.film.next()));
            repaired += u32::from(damage.is_repaired());
            events |= self.event(damage.event());
        }
        self.end(&mut traffic, events);
        traffic.read(self.address("repaired"), Answer::Is(repaired));
        traffic.join();
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
        traffic.may_drop();
        traffic.hold(5 * frame + 2000);
        for fate in [Fate::Taken, Fate::Skipped, Fate::Skipped] {
            traffic.frame(Sent { fate, ..taken(self.film.next()) });
        }
        // The next frame is compared with the one before the skipped frames.
        traffic.drain();
        traffic.frame(taken(self.film.next()));
        self.end(&mut traffic, 0);
        traffic.reset();
        traffic.may_drop();
        let either = |frame| Sent { fate: Fate::Either, ..taken(frame) };
        traffic.frame(either(self.film.next()));
        traffic.hold(3 * frame);
        for _ in 0..5 {
            traffic.frame(either(self.film.next()));
        }
        traffic.write(self.address("control"), self.control_bits(&["enable", "wait"]));
        traffic.hold(2 * frame);
        // A frame that came before `wait` was written may still be skipped.
        traffic.frame(either(self.film.next()));
        for _ in 0..2 {
            traffic.frame(taken(self.film.next()));
        }
        // A restart forgets the references, and the counters go on.
        traffic.drain();
        traffic.write(self.address("control"), self.control_bits(&["enable", "wait", "restart"]));
        traffic.frame(Sent { first: true, ..taken(self.film.next()) });
        self.end(&mut traffic, 0);
        self.two_rows_wait(&mut traffic);
        traffic
    }

    /// One row of regions leaves while the next two wait until both are decided; none is dropped.
    fn two_rows_wait(&mut self, traffic: &mut Traffic<'a>) {
        let (side, line) = (self.design.region_size(), traffic.words() as u64);
        // With more pixels per clock the next row comes while the packets of this one still leave.
        if self.design.height() < 4 * side || self.design.pixels_per_clock() > 1 {
            return;
        }
        traffic.reset();
        traffic.may_drop_regions();
        traffic.gaps(0);
        let hold = u64::from(side + 3) * line;
        traffic.frame_around(taken(self.film.quiet()), 2 * side - 1, |traffic| traffic.hold(hold));
        self.end(traffic, 0);
    }

    /// Writes thresholds, `restart` and `enable` while frames come.
    fn control(&mut self) -> Traffic<'a> {
        let control = self.address("control");
        let mut traffic = self.waiting();
        let middle = self.design.height() / 2;
        traffic.frame(taken(self.film.quiet()));
        self.passing_thresholds(&mut traffic);
        let camera = self.thresholds(&mut traffic, middle, 0, 1);
        let next = |film: &mut Film| Sent { camera, ..taken(film.next()) };
        traffic.frame(next(&mut self.film));
        traffic.frame(next(&mut self.film));
        // A restart that is written within a frame waits for the end of the frame.
        let restart = self.control_bits(&["enable", "wait", "restart"]);
        let (status, waits) = (self.address("status"), self.status_bits(&["busy", "restarting"]));
        traffic.frame_around(next(&mut self.film), middle, |traffic| {
            traffic.write(control, restart);
            traffic.read(status, Answer::Is(waits));
            traffic.join();
        });
        traffic.frame(Sent { first: true, ..next(&mut self.film) });
        traffic.frame(next(&mut self.film));
        // Only frames that come while the core is not enabled are left out.
        let disabled = self.control_bits(&["wait"]);
        traffic.frame_around(next(&mut self.film), middle, |traffic| {
            traffic.write(control, disabled);
        });
        let left_out = |film: &mut Film| Sent { fate: Fate::LeftOut, ..taken(film.next()) };
        traffic.frame(left_out(&mut self.film));
        let enabled = self.control_bits(&["enable", "wait"]);
        traffic.frame_around(left_out(&mut self.film), middle, |traffic| {
            traffic.write(control, enabled);
        });
        traffic.frame(next(&mut self.film));
        traffic.drain();
        traffic.write(control, restart);
        traffic.frame(Sent { first: true, ..next(&mut self.film) });
        traffic.frame(next(&mut self.film));
        let camera = self.thresholds(&mut traffic, middle, camera, 0);
        for _ in 0..2 {
            traffic.frame(Sent { camera, ..taken(self.film.next()) });
        }
        // Every pixel changes by less than the highest bit of the level, and many change by more
        // than the other levels.
        let camera = self.thresholds(&mut traffic, middle, camera, 2);
        for _ in 0..2 {
            traffic.frame(Sent { camera, ..taken(self.film.flickering()) });
        }
        self.end(&mut traffic, 0);
        // The register also counts the frames that were left out.
        traffic.read(self.address("frames"), Answer::Is(traffic.frames_that_came()));
        traffic.join();
        traffic
    }

    /// Writes other thresholds within a frame, while its first regions are decided, and restores
    /// them before its end. They must change nothing.
    fn passing_thresholds(&mut self, traffic: &mut Traffic<'a>) {
        let own: Vec<(u32, u32)> = self.registers.iter().filter_map(threshold).collect();
        let lines = [1, (self.design.region_size() + 3).min(self.design.height())];
        let mut others = [u32::MAX, 0].into_iter();
        traffic.frame_around_each(taken(self.film.quiet()), lines, |traffic| {
            let other = others.next().unwrap_or_default();
            own.iter().for_each(|&(address, value)| traffic.write(address, value ^ other));
        });
    }

    /// Sends frames of noise, and within each frame writes the thresholds of the next.
    fn every_threshold(&mut self) -> Traffic<'a> {
        let mut traffic = self.waiting();
        let middle = self.design.height() / 2;
        for camera in 0..=self.others.len() {
            let sent = Sent { camera, ..taken(self.film.noise()) };
            let next = self.others.get(camera).map(Vec::as_slice).unwrap_or(self.registers);
            let written: Vec<(u32, u32)> = next.iter().filter_map(threshold).collect();
            traffic.frame_around(sent, middle, |traffic| {
                written.iter().for_each(|&(address, value)| traffic.write(address, value));
            });
        }
        self.end(&mut traffic, 0);
        traffic
    }

    /// Writes the thresholds of camera `to` within a frame; they hold from the next frame on.
    /// Returns the index of the camera of the next frame, which is `from` if there is no camera
    /// `to`.
    fn thresholds(
        &mut self,
        traffic: &mut Traffic<'a>,
        middle: u32,
        from: usize,
        to: usize,
    ) -> usize {
        let Some(others) = self.others.get(to.max(1) - 1) else { return from };
        let registers = if to == 0 { self.registers } else { others };
        let written: Vec<(u32, u32)> = registers.iter().filter_map(threshold).collect();
        let frame = Sent { camera: from, ..taken(self.film.quiet()) };
        traffic.frame_around(frame, middle, |traffic| {
            written.iter().for_each(|&(address, value)| traffic.write(address, value));
        });
        to
    }

    /// Resets the core at any time: within a frame, while packets leave, while a word waits for the
    /// sink, and within a packet.
    fn resets(&mut self) -> Traffic<'a> {
        let mut traffic = self.waiting();
        let (side, height) = (self.design.region_size(), self.design.height());
        let decided = (side + side / 2).min(height - 1);
        for (hold, is_within) in
            [(0, false), (u64::from(u32::MAX), false), (u64::from(u32::MAX), true)]
        {
            traffic.frame(taken(self.film.next()));
            traffic.drain();
            traffic.may_drop();
            traffic.hold(hold);
            let lines = decided + self.random.up_to_u32(height - decided);
            let cut = Sent { fate: Fate::Cut, ..taken(self.film.noise()) };
            traffic.torn_frame(cut, lines.min(height));
            if is_within {
                traffic.hold(0);
                traffic.within_a_packet();
            }
            traffic.clocks(self.random.up_to(if is_within { 0 } else { 40 }));
            traffic.reset_for(1);
            self.wait_from_now_on(&mut traffic);
            traffic.frame(taken(self.film.next()));
            traffic.frame(taken(self.film.next()));
            traffic.drain();
            self.begin_waiting(&mut traffic);
        }
        traffic.frame(taken(self.film.next()));
        self.end(&mut traffic, 0);
        traffic
    }

    /// Resets the core for one clock among reads and writes. No access is answered afterwards, and
    /// no register keeps what was written.
    fn resets_of_registers(&mut self) -> Traffic<'a> {
        let mut traffic = Traffic::new(self.design);
        traffic.reset();
        for _ in 0..RESETS {
            for _ in 0..4 {
                let (read, written) = (self.any(), self.any());
                traffic.write_bytes(written.address, self.random.up_to_u32(u32::MAX), ALL);
                traffic.ask(read.address);
            }
            traffic.in_order(self.random.one_in(2));
            traffic.clocks(self.random.up_to(ACCESSES));
            traffic.reset_for(1);
            self.all_as_after_reset(&mut traffic);
        }
        traffic
    }

    /// Returns a random register.
    fn any(&mut self) -> &'a Register {
        &self.registers[self.random.index(self.registers.len() - 1)]
    }

    fn all_as_after_reset(&self, traffic: &mut Traffic<'a>) {
        for register in self.registers {
            traffic.read(register.address, Answer::Is(after_reset(register)));
        }
        traffic.join();
        traffic.interrupt(false);
    }

    fn register_file(&mut self) -> Traffic<'a> {
        let mut traffic = Traffic::new(self.design);
        traffic.reset();
        self.all_as_after_reset(&mut traffic);
        self.strobes(&mut traffic);
        self.nothing_there(&mut traffic);
        self.interrupts(&mut traffic);
        self.storm(&mut traffic);
        traffic
    }

    /// Writes every register with several combinations of byte strobes.
    fn strobes(&mut self, traffic: &mut Traffic<'a>) {
        for register in self.registers {
            let mut value = after_reset(register);
            for strobes in [ALL, NONE, LOWEST, 0b1010, 0b0110, self.random.up_to_u32(ALL), ALL] {
                let data = self.random.up_to_u32(u32::MAX);
                let bytes = (0..4).filter(|byte| strobes >> byte & 1 == 1);
                let bytes = bytes.fold(0_u32, |mask, byte| mask | 0xFF << (8 * byte));
                let mask = match register.name.as_str() {
                    "control" | "events" | "interrupt_test" => continue,
                    _ => writable(register) & bytes,
                };
                value = (value & !mask) | (data & mask);
                traffic.write_bytes(register.address, data, strobes);
                traffic.read(register.address, Answer::Is(value));
            }
            traffic.write_bytes(register.address, after_reset(register), ALL);
            traffic.read(register.address, Answer::Is(after_reset(register)));
        }
        traffic.join();
    }

    /// Checks that addresses without a register read as 0, also after a write.
    fn nothing_there(&mut self, traffic: &mut Traffic<'a>) {
        let is_there = |address| self.registers.iter().any(|register| register.address == address);
        let last = self.registers.last().map_or(0, |register| register.address);
        for address in [0x044, 0x0FC, last + 4, 0x400 + self.address("control"), END] {
            if !is_there(address) {
                traffic.write_bytes(address, u32::MAX, ALL);
                traffic.read(address, Answer::Is(0));
            }
        }
        traffic.read(self.address("control"), Answer::Is(self.control_bits(&["enable"])));
        traffic.join();
    }

    /// Sets, enables and clears the events one by one.
    fn interrupts(&mut self, traffic: &mut Traffic<'a>) {
        let [events, enable, test] =
            ["events", "interrupt_enable", "interrupt_test"].map(|name| self.address(name));
        let all = writable(self.register("interrupt_enable"));
        traffic.interrupt(false);
        let mut set = 0;
        for bit in (0..u32::BITS).map(|bit| 1 << bit).filter(|bit| all & bit != 0) {
            traffic.write_bytes(test, bit, NONE);
            traffic.read(events, Answer::Is(set));
            traffic.write(test, bit);
            set |= bit;
            traffic.read(events, Answer::Is(set));
            traffic.write(enable, all & !bit & !set);
            traffic.interrupt(false);
            traffic.write(enable, bit);
            traffic.interrupt(true);
            traffic.write(enable, 0);
        }
        traffic.write_bytes(events, all, NONE);
        traffic.write(events, 0);
        traffic.read(events, Answer::Is(set));
        for bit in (0..u32::BITS).map(|bit| 1 << bit).filter(|bit| all & bit != 0) {
            traffic.write(enable, bit);
            traffic.interrupt(true);
            traffic.write(events, bit);
            traffic.interrupt(false);
            set &= !bit;
            traffic.read(events, Answer::Is(set));
        }
        traffic.write(enable, 0);
    }

    /// Reads and writes at the same time, also while a frame passes.
    fn storm(&mut self, traffic: &mut Traffic<'a>) {
        let [identity, enable] = ["identity", "interrupt_enable"].map(|name| self.address(name));
        let identity_value = after_reset(self.register("identity"));
        let data: Vec<u32> = (0..STORM).map(|_| self.random.up_to_u32(u32::MAX)).collect();
        traffic.gaps(self.pace());
        traffic.in_order(false);
        traffic.frame_around(taken(self.film.next()), 1, |traffic| {
            for &value in &data {
                traffic.write_bytes(enable, value, ALL);
                traffic.read(identity, Answer::Is(identity_value));
            }
        });
        traffic.join();
        traffic.in_order(true);
        traffic.write(enable, 0);
        // None of the written words was a restart.
        traffic.frame(taken(self.film.next()));
        self.end(traffic, 0);
    }

    /// Begins traffic for a core that was reset. Its source waits when it must, with gaps that let
    /// all regions leave.
    fn waiting(&mut self) -> Traffic<'a> {
        let mut traffic = Traffic::new(self.design);
        self.begin_waiting(&mut traffic);
        traffic
    }

    fn begin_waiting(&mut self, traffic: &mut Traffic<'a>) {
        traffic.reset();
        self.wait_from_now_on(traffic);
    }

    fn wait_from_now_on(&mut self, traffic: &mut Traffic<'a>) {
        traffic.stalls(0);
        traffic.gaps(self.pace());
        traffic.write(self.address("control"), self.control_bits(&["enable", "wait"]));
    }

    /// Waits until all packets have left, and checks the counters and events.
    fn end(&mut self, traffic: &mut Traffic<'a>, events: u32) {
        traffic.drain();
        traffic.read(self.address("skipped"), Answer::Skipped);
        traffic.read(self.address("dropped"), Answer::Dropped);
        traffic.read(self.address("events"), Answer::Events(events | self.event("frame_done")));
        traffic.join();
    }

    /// Returns the gaps, in percent, with which no region is lost, because its packet leaves while
    /// the pixels of another region come.
    fn pace(&self) -> u32 {
        let clocks = self.packet_words() * 4 + 1;
        let share = 100 * self.region_clocks() / (clocks + clocks / 2);
        100_u32.saturating_sub(share).clamp(25, 95)
    }

    /// Returns true if all regions can leave without gaps between the words of the video.
    fn is_fast(&self) -> bool {
        let clocks = self.packet_words() * 2 + 1;
        self.region_clocks() > clocks + clocks / 4
    }

    /// Returns the number of words of a REGION packet with pixels.
    fn packet_words(&self) -> u32 {
        let lane = if self.design.pixel_bits() <= 8 { 8 } else { 16 };
        (self.design.region_size().pow(2) * lane).div_ceil(64) + 2
    }

    /// Returns the number of clocks in which the pixels of a region come.
    fn region_clocks(&self) -> u32 {
        self.design.region_size().pow(2) / self.design.pixels_per_clock()
    }

    /// Returns the number of frames of a scene.
    fn count(&self) -> u32 {
        let frames = CLOCKS / self.design.timing().clocks_per_frame().max(1);
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
        bits(self.register("control"), names)
    }

    fn status_bits(&self, names: &[&str]) -> u32 {
        bits(self.register("status"), names)
    }

    pub(super) fn event(&self, name: &str) -> u32 {
        bits(self.register("events"), &[name])
    }
}

/// Returns a frame that must be taken, with the thresholds of the design.
pub(super) fn taken(frame: Frame) -> Sent {
    Sent { frame, fate: Fate::Taken, first: false, camera: 0 }
}

/// Returns the bits of the named fields of a register, each of which has one bit.
fn bits(register: &Register, names: &[&str]) -> u32 {
    let named = register.fields.iter().filter(|field| names.contains(&field.name.as_str()));
    named.fold(0, |bits, field| bits | 1 << field.low)
}

/// Returns the value of a register after a reset.
fn after_reset(register: &Register) -> u32 {
    register.fields.iter().fold(0, |value, field| {
        let own = match field.kind {
            Kind::Constant(own) | Kind::Control { reset: own } | Kind::Threshold { reset: own } => {
                own
            }
            Kind::Status if register.name == "tick_rate" => TICK_RATE,
            Kind::Status | Kind::Command | Kind::Event => 0,
        };
        value | own << field.low
    })
}

/// Returns the mask of the register bits that keep a written value.
fn writable(register: &Register) -> u32 {
    register.fields.iter().fold(0, |mask, field| match field.kind {
        Kind::Control { .. } | Kind::Threshold { .. } => {
            mask | u32::MAX >> (u32::BITS - field.width) << field.low
        }
        Kind::Constant(_) | Kind::Status | Kind::Command | Kind::Event => mask,
    })
}

/// Returns the address and the reset value of a register that holds a threshold.
fn threshold(register: &Register) -> Option<(u32, u32)> {
    let is_one = |kind: &Kind| matches!(kind, Kind::Threshold { .. });
    let has = register.fields.iter().any(|field| is_one(&field.kind));
    has.then(|| (register.address, after_reset(register)))
}

/// Returns the cameras of the design and of the designs with other thresholds, in this order.
pub(super) fn cameras(design: &Design, others: &[Design]) -> Vec<Camera> {
    let camera = |design: &Design| Camera::clone(design);
    std::iter::once(design).chain(others).map(camera).collect()
}

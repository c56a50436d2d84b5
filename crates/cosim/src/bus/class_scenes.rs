// SPDX-License-Identifier: MIT OR Apache-2.0
//! Scenes that write maps of classes into the window of a core while frames come.

use super::scenes::{BusScene, SceneBuilder, taken_frame};
use super::traffic::{ALL_BYTES, ExpectedFrame, ExpectedRead, FrameFate, FrameMaps, Traffic};
use foveate_camera::RegionClass;
use foveate_design::{CLASSES_PER_WORD, class_word};
use foveate_pixels::Frame;

const MAPS: usize = 4;
/// The number of frames that come while maps are committed at any time.
const FREE_FRAMES: usize = 12;

/// The two banks of a core's memory of classes, with the number of commits.
struct ClassBanks {
    committed: Vec<RegionClass>,
    other: Vec<RegionClass>,
    version: u16,
}

impl ClassBanks {
    fn commit(&mut self) {
        std::mem::swap(&mut self.committed, &mut self.other);
        self.version += 1;
    }

    /// Returns the frame with the committed map.
    fn frame(&self, frame: Frame) -> ExpectedFrame {
        let maps = vec![self.committed.clone()];
        let maps = FrameMaps { first_version: self.version, maps, take_turns: false };
        ExpectedFrame { maps, ..taken_frame(frame) }
    }

    /// Returns the frame with either map, while commits without writes follow each other.
    fn frame_of_any_turn(&self, frame: Frame) -> ExpectedFrame {
        let maps = vec![self.committed.clone(), self.other.clone()];
        let maps = FrameMaps { first_version: self.version, maps, take_turns: true };
        ExpectedFrame { maps, ..taken_frame(frame) }
    }
}

impl<'a> SceneBuilder<'a> {
    /// Returns the scenes of a core with zones; none without them.
    pub(super) fn class_scenes(&mut self) -> Vec<BusScene<'a>> {
        let design = self.design();
        let Some(zones) = design.zones() else { return Vec::new() };
        let map = zones.configured_classes().to_vec();
        let banks = || ClassBanks { committed: map.clone(), other: map.clone(), version: 0 };
        vec![
            ("maps of classes", self.class_maps(banks())),
            ("maps of classes at any time", self.class_maps_at_any_time(banks())),
            ("maps of classes that take turns", self.class_maps_by_turns(banks())),
            ("maps of classes before FRAME leaves", self.class_maps_before_frame(banks())),
            ("thresholds of classes", self.class_thresholds(banks())),
        ]
    }

    /// Commits maps within frames and between them, and tries what must have no effect.
    fn class_maps(&mut self, mut banks: ClassBanks) -> Traffic<'a> {
        let mut traffic = self.waiting_traffic();
        let middle = self.design().height() / 2;
        // Both banks begin with the map of the configuration.
        self.commit_map(&mut traffic, banks.version, false);
        banks.commit();
        for turn in 0..MAPS {
            let frame = banks.frame(self.frame_source().noise_frame());
            let map = self.random_map();
            traffic.send_frame_around(frame, middle, |traffic| {
                self.write_map(traffic, &map, turn);
                self.commit_map(traffic, banks.version, true);
            });
            banks.other = map;
            banks.commit();
        }
        // Between two frames the map is in use at once. Words that are not written keep the map
        // before the last one.
        traffic.send_frame(banks.frame(self.frame_source().noise_frame()));
        traffic.drain();
        let changed = self.random_map();
        let first = CLASSES_PER_WORD as usize;
        let count = first.min(changed.len());
        self.write_words(&mut traffic, 0, &changed[..count]);
        self.commit_map(&mut traffic, banks.version, false);
        banks.other[..count].copy_from_slice(&changed[..count]);
        banks.commit();
        traffic.send_frame(banks.frame(self.frame_source().noise_frame()));
        self.restart_and_reset(&mut traffic, banks);
        self.end_session(&mut traffic, 0);
        traffic
    }

    /// Restarts the core, and resets it while a committed map waits. Both maps stay, and the
    /// committed one is that of the next frame.
    fn restart_and_reset(&mut self, traffic: &mut Traffic<'a>, mut banks: ClassBanks) {
        traffic.drain();
        let restart = self.control_bits(&["enable", "wait", "restart"]);
        traffic.write(self.address("control"), restart);
        let frame = banks.frame(self.frame_source().noise_frame());
        traffic.send_frame(ExpectedFrame { is_first: true, ..frame });
        traffic.drain();
        let (map, height) = (self.random_map(), self.design().height());
        self.write_map(traffic, &map, 0);
        traffic.wait_for_accesses();
        let cut = ExpectedFrame {
            fate: FrameFate::CutByReset,
            ..banks.frame(self.frame_source().noise_frame())
        };
        traffic.send_torn_frame(cut, height / 2);
        self.commit_map(traffic, banks.version, true);
        traffic.wait_for_accesses();
        traffic.reset_for(1);
        self.enable_waiting(traffic);
        banks.other = map;
        banks.commit();
        let control = self.address("zone_control");
        traffic.read(control, ExpectedRead::Value(u32::from(banks.version) << 16));
        traffic.send_frame(banks.frame(self.frame_source().noise_frame()));
        traffic.send_frame(banks.frame(self.frame_source().noise_frame()));
        traffic.drain();
        // A reset clears the address. A reset at the edge after the write of a commit cancels it;
        // at the next edge the commit waits for its end.
        let address = self.address("zone_address");
        for waits in [1, 0] {
            traffic.write(address, 1);
            traffic.read(control, ExpectedRead::Value(u32::from(banks.version) << 16));
            traffic.wait_for_accesses();
            traffic.write_bytes(control, 1, ALL_BYTES);
            traffic.wait_for_taken_write();
            traffic.wait_clocks(waits);
            traffic.reset_for(1);
            if waits > 0 {
                banks.commit();
            }
            traffic.read(address, ExpectedRead::Value(0));
            traffic.read(control, ExpectedRead::Value(u32::from(banks.version) << 16));
        }
        traffic.write(address, 1);
        traffic.reset_for(1);
        self.enable_waiting(traffic);
        traffic.read(address, ExpectedRead::Value(0));
        traffic.send_frame(banks.frame(self.frame_source().noise_frame()));
    }

    /// Commits at every clock at which a write can start, while frames begin and pass, and while a
    /// restart waits for their end.
    fn class_maps_by_turns(&mut self, mut banks: ClassBanks) -> Traffic<'a> {
        let mut traffic = self.waiting_traffic();
        let map = self.random_map();
        self.write_map(&mut traffic, &map, 0);
        traffic.wait_for_accesses();
        banks.other = map;
        let commits = self.address("zone_control");
        traffic.clear_repeatedly(commits, 1);
        // Where an array waits for the sink, the first word of a frame follows long after its
        // beginning.
        traffic.allow_drops();
        let last_line = self.design().height() - 1;
        for turn in 0..FREE_FRAMES {
            let frame = banks.frame_of_any_turn(self.frame_source().noise_frame());
            traffic.send_frame_around(frame, last_line, |traffic| {
                traffic.hold_sink(if turn.is_multiple_of(2) { traffic.drain_clocks() } else { 0 });
            });
        }
        traffic.stop_clearing();
        let (control, middle) = (self.address("control"), self.design().height() / 2);
        let restart = self.control_bits(&["enable", "wait", "restart"]);
        for turn in 0..FREE_FRAMES {
            let frame = banks.frame_of_any_turn(self.frame_source().noise_frame());
            let frame = ExpectedFrame { is_first: turn > 0, ..frame };
            traffic.send_frame_around(frame, middle, |traffic| traffic.write(control, restart));
            traffic.clear_repeatedly(commits, 1);
            traffic.drain();
            traffic.stop_clearing();
        }
        self.end_session(&mut traffic, 0);
        traffic
    }

    /// Commits a map within a frame whose FRAME packet waits for the sink.
    fn class_maps_before_frame(&mut self, mut banks: ClassBanks) -> Traffic<'a> {
        let mut traffic = self.waiting_traffic();
        traffic.allow_drops();
        let last_line = self.design().height() - 1;
        for _ in 0..2 {
            let map = self.random_map();
            self.write_map(&mut traffic, &map, 0);
            traffic.wait_for_accesses();
            banks.other = map;
            let [before, frame] = [(); 2].map(|()| banks.frame(self.frame_source().noise_frame()));
            traffic.send_frame_around(before, last_line, |traffic| {
                traffic.hold_sink(traffic.drain_clocks());
            });
            traffic.send_frame_around(frame, 1, |traffic| {
                self.commit_map(traffic, banks.version, true);
                traffic.wait_for_accesses();
            });
            banks.commit();
            traffic.drain();
        }
        self.end_session(&mut traffic, 0);
        traffic
    }

    /// Commits maps at times that have nothing to do with those of the frames. The version in each
    /// FRAME says which of the maps the frame must use.
    fn class_maps_at_any_time(&mut self, banks: ClassBanks) -> Traffic<'a> {
        let mut traffic = self.waiting_traffic();
        let mut maps = FrameMaps {
            first_version: banks.version,
            maps: vec![banks.committed],
            take_turns: false,
        };
        maps.maps.extend((0..FREE_FRAMES).map(|_| self.random_map()));
        let (height, control) = (self.design().height(), self.address("zone_control"));
        for map in &maps.maps[1..] {
            let mut frame = || ExpectedFrame {
                maps: maps.clone(),
                ..taken_frame(self.frame_source().noise_frame())
            };
            // The commit comes near the end of a frame, or while the next one begins or passes.
            let [frame, next] = [frame(), frame()];
            let lines = height - self.random().up_to_u32(height / 4);
            traffic.send_frame_around(frame, lines, |traffic| {
                self.write_map(traffic, map, 0);
                traffic.write(control, 1);
            });
            traffic.send_frame(next);
            // Frames use a map before the next one is written.
            traffic.drain();
        }
        self.end_session(&mut traffic, 0);
        traffic
    }

    /// Gives all regions one class, and changes the thresholds of that class from frame to frame.
    fn class_thresholds(&mut self, mut banks: ClassBanks) -> Traffic<'a> {
        let mut traffic = self.waiting_traffic();
        for class in [RegionClass::Keen, RegionClass::Off] {
            traffic.drain();
            let map = vec![class; self.design().regions() as usize];
            self.write_map(&mut traffic, &map, 0);
            self.commit_map(&mut traffic, banks.version, false);
            banks.other.clone_from(&map);
            banks.commit();
            let maps =
                FrameMaps { first_version: banks.version, maps: vec![map], take_turns: false };
            self.send_threshold_sweep(&mut traffic, class, &maps);
        }
        self.end_session(&mut traffic, 0);
        traffic
    }

    fn random_map(&mut self) -> Vec<RegionClass> {
        let regions = self.design().regions();
        let random = self.random();
        (0..regions).map(|_| RegionClass::ALL[random.index(RegionClass::ALL.len() - 1)]).collect()
    }

    /// Writes a map: in order, or backwards, word by word with its address.
    fn write_map(&self, traffic: &mut Traffic<'a>, map: &[RegionClass], turn: usize) {
        if turn.is_multiple_of(2) {
            return self.write_words(traffic, 0, map);
        }
        let words: Vec<_> = (0..).zip(map.chunks(CLASSES_PER_WORD as usize)).collect();
        words.iter().rev().for_each(|&(place, classes)| self.write_words(traffic, place, classes));
    }

    /// Writes words from the one with number `place` on. A write of a part of a word has no effect.
    fn write_words(&self, traffic: &mut Traffic<'a>, place: u32, classes: &[RegionClass]) {
        let [word, address] = ["zone_word", "zone_address"].map(|name| self.address(name));
        traffic.write(address, place);
        traffic.write_bytes(word, u32::MAX, 0b0111);
        let mut behind = place;
        for classes in classes.chunks(CLASSES_PER_WORD as usize) {
            traffic.write(word, class_word(classes));
            behind += 1;
        }
        traffic.read(word, ExpectedRead::Value(0));
        // The address has no more bits than the number of the last word.
        behind %= 1 << self.design().class_address_bits();
        traffic.read(address, ExpectedRead::Value(behind));
    }

    /// Commits the map that was written. `version` is the number of commits before this one. If
    /// the commit `waits` for the end of a frame, also checks that a word and another commit then
    /// have no effect.
    fn commit_map(&self, traffic: &mut Traffic<'a>, version: u16, waits: bool) {
        let [word, address, control] =
            ["zone_word", "zone_address", "zone_control"].map(|name| self.address(name));
        let version = u32::from(version) << 16;
        traffic.write_bytes(control, 1, ALL_BYTES - 1);
        traffic.read(control, ExpectedRead::Value(version));
        traffic.write(control, 1);
        traffic.read(address, ExpectedRead::Value(0));
        let version = version + (1 << 16);
        if waits {
            traffic.read(control, ExpectedRead::Value(version | 2));
            traffic.write(word, u32::MAX);
            traffic.write(control, 1);
            traffic.read(address, ExpectedRead::Value(0));
        }
        traffic.read(control, ExpectedRead::Value(version | if waits { 2 } else { 0 }));
    }
}

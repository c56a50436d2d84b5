// SPDX-License-Identifier: MIT OR Apache-2.0
//! Scenes that write maps of classes into the window of a core while frames come.

use super::scenes::{BusScene, SceneBuilder, taken_frame};
use super::traffic::{ExpectedFrame, ExpectedRead, FrameFate, Traffic};
use foveate_design::{CLASSES_PER_WORD, RegionClass, class_word};
use foveate_frame::Frame;

/// The number of maps of a scene.
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
        ExpectedFrame { maps: vec![(self.version, self.committed.clone())], ..taken_frame(frame) }
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
            ("thresholds of classes", self.class_thresholds(banks())),
        ]
    }

    /// Commits maps within frames and between them, and tries what must have no effect.
    fn class_maps(&mut self, mut banks: ClassBanks) -> Traffic<'a> {
        let mut traffic = self.waiting_traffic();
        let middle = self.design().height() / 2;
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
    }

    /// Commits maps at times that have nothing to do with those of the frames. The version in each
    /// FRAME says which of the maps the frame must use.
    fn class_maps_at_any_time(&mut self, mut banks: ClassBanks) -> Traffic<'a> {
        let mut traffic = self.waiting_traffic();
        let mut maps = vec![(banks.version, banks.committed.clone())];
        for _ in 0..FREE_FRAMES {
            let map = self.random_map();
            banks.other.clone_from(&map);
            banks.commit();
            maps.push((banks.version, map));
        }
        let (height, control) = (self.design().height(), self.address("zone_control"));
        for number in 1..maps.len() {
            let map = maps[number].1.clone();
            let mut frame = || ExpectedFrame {
                maps: maps.clone(),
                ..taken_frame(self.frame_source().noise_frame())
            };
            // The commit comes near the end of a frame, or while the next one begins or passes.
            let [frame, next] = [frame(), frame()];
            let lines = height - self.random().up_to_u32(height / 4);
            traffic.send_frame_around(frame, lines, |traffic| {
                self.write_map(traffic, &map, 0);
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
            self.send_threshold_sweep(&mut traffic, class, &[(banks.version, map)]);
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
        traffic.write(control, 1);
        traffic.read(address, ExpectedRead::Value(0));
        let version = u32::from(version + 1) << 16;
        if waits {
            traffic.read(control, ExpectedRead::Value(version | 2));
            traffic.write(word, u32::MAX);
            traffic.write(control, 1);
            traffic.read(address, ExpectedRead::Value(0));
        }
        traffic.read(control, ExpectedRead::Value(version | if waits { 2 } else { 0 }));
    }
}

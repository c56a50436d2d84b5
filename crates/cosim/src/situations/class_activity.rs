// SPDX-License-Identifier: MIT OR Apache-2.0
//! The activity on the ports of classes of regions: the classes of a frame in a pipelined array, and
//! the words and commits of a map in the other organizations.

use super::port_situations::PortSituationCounts;
use super::watched_ports::{WatchedClock, WatchedPorts};
use foveate_camera::RegionClass;
use foveate_design::{CLASS_BITS, CLASSES_PER_WORD};

/// The classes of the last frame, and whether a map waits.
#[derive(Clone, Debug, Default)]
pub(super) struct ClassActivity {
    /// The codes of the classes of the last frame; empty after a reset until a frame begins.
    codes: Vec<u64>,
    was_pending: bool,
}

impl ClassActivity {
    pub(super) fn reset(&mut self) {
        self.codes.clear();
    }

    /// Counts the classes at the ports of a pipelined array at the first pixel of a frame.
    pub(super) fn begin_frame(
        &mut self,
        ports: &WatchedPorts,
        clock: WatchedClock<'_>,
        facts: &mut PortSituationCounts,
    ) {
        let lanes = 0..ports.region_class.lanes();
        let codes: Vec<u64> = lanes.map(|lane| clock.lane(&ports.region_class, lane)).collect();
        codes.iter().for_each(|&code| count_class(code, facts));
        let changes = self.codes.iter().zip(&codes).filter(|(before, now)| before != now);
        facts.class_changed += changes.count() as u64;
        self.codes = codes;
    }

    /// Counts the words and commits of a clock. `is_within` is true between the first and the last
    /// pixel of a frame.
    pub(super) fn count_maps(
        &mut self,
        ports: &WatchedPorts,
        clock: WatchedClock<'_>,
        is_within: bool,
        facts: &mut PortSituationCounts,
    ) {
        let [is_written, is_committed] =
            [&ports.class_write, &ports.class_commit].map(|port| clock.is_high(port));
        if self.was_pending {
            facts.word_while_pending += u64::from(is_written);
            facts.commit_while_pending += u64::from(is_committed);
            return;
        }
        if is_written {
            let word = clock.value(&ports.class_word);
            let codes = (0..CLASSES_PER_WORD).map(|place| word >> (CLASS_BITS * place));
            codes.for_each(|code| count_class(code & ((1 << CLASS_BITS) - 1), facts));
        }
        facts.map_within_frame += u64::from(is_committed && is_within);
        facts.map_between_frames += u64::from(is_committed && !is_within);
    }

    /// Keeps the outputs for the next clock.
    pub(super) fn keep_outputs(&mut self, ports: &WatchedPorts, clock: WatchedClock<'_>) {
        self.was_pending = clock.is_high(&ports.class_pending);
    }
}

fn count_class(code: u64, facts: &mut PortSituationCounts) {
    match u8::try_from(code).ok().and_then(RegionClass::from_code) {
        Some(RegionClass::Off) => facts.class_off += 1,
        Some(RegionClass::Keen) => facts.class_keen += 1,
        Some(RegionClass::Always) => facts.class_always += 1,
        Some(RegionClass::Normal) | None => {}
    }
}

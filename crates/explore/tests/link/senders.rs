// SPDX-License-Identifier: MIT OR Apache-2.0
//! The times at which cameras send, worked out by hand from docs/timing.md and docs/serial.md.

use foveate_camera::RegionAction;
use foveate_design::{Design, DesignConfig};
use foveate_explore::link::{LinkUnit, SenderCameras, SentCounts, Timeline};

/// A frame of 20x12 pixels has 3x2 regions of 8; the last column is 4 pixels wide and the last row
/// 4 pixels high.
const SIZE: &str = "frame={width=20,height=12}";
/// A clock of 1 MHz, with a period of 1 us.
const MEGAHERTZ: u64 = 1_000_000;

/// Returns the actions of regions that are active or held.
fn actions(active: &[bool]) -> Vec<RegionAction> {
    active
        .iter()
        .map(|&active| if active { RegionAction::Forward } else { RegionAction::Hold })
        .collect()
}

fn design(overrides: &[&str]) -> Design {
    let all: Vec<&str> = [&[SIZE][..], overrides].concat();
    DesignConfig::from_toml_with("", &all).unwrap().validate().unwrap()
}

/// Returns the timeline of two frames of 12 ms, with one row per millisecond.
fn timeline() -> Timeline {
    Timeline::new("clip", &[0, 12_000], 12).unwrap()
}

/// In the first frame region 0 (64 pixels) and the ragged region 5 (4x4 pixels) are active; in the
/// second frame no region is.
fn sent(design: &Design) -> [SentCounts; 2] {
    let active = [true, false, false, false, false, true];
    [
        SentCounts::from_actions(design, &actions(&active), vec![0; 12]),
        SentCounts::from_actions(design, &actions(&[false; 6]), vec![0; 12]),
    ]
}

/// Returns the times of reading, decision and sending in us, and the bits.
fn times(units: &[LinkUnit]) -> Vec<(u64, u64, u64, u64)> {
    units
        .iter()
        .map(|u| (u.read_ns / 1000, u.decided_ns / 1000, u.sent_ns / 1000, u.bits))
        .collect()
}

#[test]
fn padding_is_not_sent() {
    let design = design(&[]);
    assert_eq!(sent(&design)[0].rows, [64, 16]);
    assert_eq!(sent(&design)[0].slots, [80]);
    assert_eq!(sent(&design)[1].rows, [0, 0]);
}

#[test]
fn a_row_of_regions_is_decided_when_its_last_row_was_read() {
    // The isolated median and edge windows have latencies of (N+1) + 2 and N+1 clocks, which is 20.
    // A row of 8 pixels takes 8 clocks.
    let (design, timeline) = (design(&[]), timeline());
    let cameras = SenderCameras::new("clip", &design, &timeline, Some(MEGAHERTZ)).unwrap();
    let units = cameras.region_units_by_rows(&sent(&design)).unwrap();
    let above = 8_000 + 8 + 20;
    // Below the frame the last row is repeated four times, so 5 rows of 8 pixels are taken.
    let below = 12_000 + 5 * 8 + 20;
    let expected = [
        (1_000, above, above, 3 * 2 + 64 * 8),
        (9_000, below, below, 3 * 2 + 16 * 8),
        (13_000, 12_000 + above, 12_000 + above, 6),
        (21_000, 12_000 + below, 12_000 + below, 6),
    ];
    assert_eq!(times(&units), expected);
}

#[test]
fn neighbors_and_a_second_pass_are_waited_for() {
    // Shared windows of median and edge need two rows of halo; a row has 12 pixels, and the latency
    // is 2. Row 9 is the tenth row.
    let (design, timeline) = (design(&["region.neighborhood=\"shared\""]), timeline());
    let cameras = SenderCameras::new("clip", &design, &timeline, Some(MEGAHERTZ)).unwrap();
    let units = cameras.region_units_by_rows(&sent(&design)).unwrap();
    assert_eq!(units[0].decided_ns / 1000, 10_000 + 12 + 2);
    // With `mad` the decision falls when the next frame has passed, 12 ms later.
    let design = self::design(&["spatial=[{feature=\"mad\"}]", "denoise.filter=\"none\""]);
    let cameras = SenderCameras::new("clip", &design, &timeline, Some(MEGAHERTZ)).unwrap();
    let units = cameras.region_units_by_rows(&sent(&design)).unwrap();
    // The last row takes 8 clocks, and the tail delays by 1.
    assert_eq!(units[0].decided_ns / 1000, 12_000 + 8_000 + 8 + 1);
}

#[test]
fn pixels_leave_the_pipelined_array_with_the_next_frame() {
    let (design, timeline) = (design(&[]), timeline());
    let cameras = SenderCameras::new("clip", &design, &timeline, Some(MEGAHERTZ)).unwrap();
    // A frame is taken in 64 clocks after it has been read, and decided 20 clocks later.
    let decided = 12_000 + 64 + 20;
    let expected = [
        (1_000, decided, decided, 6 * 2),
        (1_000, decided, decided + 12_000, 80 * 8),
        (13_000, decided + 12_000, decided + 12_000, 6 * 2),
    ];
    assert_eq!(times(&cameras.slot_array(&sent(&design)).units), expected);
}

#[test]
fn a_serial_array_sends_slot_by_slot_within_the_frame() {
    let hardware = "hardware={organization=\"serial\",fold=2}";
    let (design, timeline) = (design(&[hardware]), timeline());
    let cameras = SenderCameras::new("clip", &design, &timeline, Some(100 * MEGAHERTZ)).unwrap();
    let sent = sent(&design);
    // Region 0 is in slot 0 and region 5 in slot 1.
    assert_eq!(sent[0].slots, [64, 16]);
    assert!(cameras.region_units_by_rows(&sent).is_none(), "its lanes work in step");
    let units = cameras.slot_array(&sent).units;
    // Three lanes take 2 * 64 pixels. A slot takes 64 * 83 clocks of median, 3 of count, 14 * 64 of
    // edge, 3 of score and 64 of unload.
    let (median, edge) = (64 * 83, 14 * 64);
    let (decides, slot) = (median + 3 + edge + 3, median + 3 + edge + 3 + 64);
    let clocks = |clocks: u64| 12_000_000 + (128 + clocks) * 10;
    let ns: Vec<_> = units[..4].iter().map(|u| (u.decided_ns, u.sent_ns, u.bits)).collect();
    let expected = [
        (clocks(decides), clocks(decides), 3 * 2),
        (clocks(decides), clocks(slot), 64 * 8),
        (clocks(slot + decides), clocks(slot + decides), 3 * 2),
        (clocks(slot + decides), clocks(2 * slot), 16 * 8),
    ];
    assert_eq!(ns, expected);
}

/// A displacement in a search of radius 1 has four bits, and leaves with the decision.
#[test]
fn displacements_leave_with_the_decisions() {
    let features = "spatial=[{feature=\"edge\"},{feature=\"flow\",radius=1}]";
    let hardware = "hardware={organization=\"serial\",fold=2}";
    let (design, timeline) = (design(&[hardware, features]), timeline());
    let cameras = SenderCameras::new("clip", &design, &timeline, None).unwrap();
    let units = cameras.slot_array(&sent(&design)).units;
    let bits: Vec<_> = units.iter().map(|unit| unit.bits).collect();
    assert_eq!(bits, [3 * (2 + 4), 64 * 8, 3 * (2 + 4), 16 * 8, 3 * (2 + 4), 3 * (2 + 4)]);
    assert_eq!(bits.iter().sum::<u64>(), design.bits_sent(2, 80));
}

#[test]
fn rows_and_frames_of_the_others() {
    let (design, timeline) = (design(&[]), timeline());
    let cameras = SenderCameras::new("clip", &design, &timeline, Some(MEGAHERTZ)).unwrap();
    let raw = cameras.raw_units();
    assert_eq!((raw.len(), raw[11].sent_ns, raw[11].bits), (24, 12_000_000, 20 * 8));
    assert!(raw.iter().all(|unit| unit.read_ns == unit.sent_ns));
    let mut sent = sent(&design);
    sent[1].events[2] = 5;
    assert_eq!(times(&cameras.pixel_event_units(&sent)), [(15_000, 15_000, 15_000, 5 * 32)]);
    let codec = times(&cameras.codec_units(&[100, 7]));
    assert_eq!(codec, [(1_000, 12_000, 12_000, 800), (13_000, 24_000, 24_000, 56)]);
}

#[test]
fn an_array_that_is_too_slow_is_refused() {
    // A whole frame takes 64 clocks, but 12 rows of 8 pixels one by one take 96 clocks, in 12 ms.
    let (design, timeline) = (design(&[]), timeline());
    assert!(SenderCameras::new("clip", &design, &timeline, Some(8_000)).is_ok());
    let error =
        SenderCameras::new("clip", &design, &timeline, Some(7_999)).unwrap_err().to_string();
    assert!(error.contains("every 12000000 ns") && error.contains("12001501 ns"), "{error}");
    let without = SenderCameras::new("clip", &design, &timeline, None).unwrap();
    assert_eq!(without.needed_clock_hz(), 8_000);
}

/// Every time of the array is later by at most the stated clocks, and one time is later by exactly
/// these.
#[test]
fn without_a_clock_the_clocks_of_the_array_are_left_out_and_stated() {
    let serial = "hardware={organization=\"serial\",fold=2}";
    // These are the clocks of the serial array above, up to the last pixel of the second slot.
    let two_slots = 128 + 2 * (64 * 83 + 3 + 14 * 64 + 3 + 64);
    for (set, expected) in [(&[][..], None), (&[serial], Some(two_slots))] {
        let (design, timeline) = (design(set), timeline());
        let sent = sent(&design);
        let at = |clock| SenderCameras::new("clip", &design, &timeline, clock).unwrap();
        let (without, with) = (at(None), at(Some(100 * MEGAHERTZ)));
        let all = |cameras: &SenderCameras<'_>| {
            let rows = cameras.region_units_by_rows(&sent).unwrap_or_default();
            rows.into_iter().chain(cameras.slot_array(&sent).units).collect::<Vec<_>>()
        };
        let (without_clock, with_clock) = (all(&without), all(&with));
        let pairs = without_clock.iter().zip(&with_clock);
        let later = pairs.map(|(one, other)| {
            (other.sent_ns - one.sent_ns).max(other.decided_ns - one.decided_ns)
        });
        let added = without.slot_array(&sent).added_clocks;
        assert_eq!(later.max(), Some(added * 10));
        assert_eq!(added, expected.unwrap_or(added));
    }
}

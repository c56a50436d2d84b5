// SPDX-License-Identifier: MIT OR Apache-2.0
//! Streams that lose, gain and change bytes. The frames that remain whole are received unchanged.

use fastrand::Rng;
use foveate_packets::{ReceivedFrame, StreamLoss};

use crate::stream::{TestStream, random_stream, read_stream};

/// Returns the number of random cases; `FOVEATE_FUZZ_CASES` may set more.
pub(crate) fn case_count() -> u64 {
    std::env::var("FOVEATE_FUZZ_CASES").ok().and_then(|text| text.parse().ok()).unwrap_or(400)
}

/// Damages a few bytes from `at` on in one of several ways. Returns the range of the affected
/// original bytes.
pub(crate) fn damage(rng: &mut Rng, bytes: &mut Vec<u8>, at: usize) -> std::ops::Range<usize> {
    let length = rng.usize(1..200).min(bytes.len() - at);
    match rng.u8(0..4) {
        0 => {
            bytes[at] ^= 1 << rng.u8(0..8);
            at..at + 1
        }
        1 => {
            drop(bytes.drain(at..at + length));
            at..at + length
        }
        2 => {
            let noise: Vec<u8> = (0..length).map(|_| rng.u8(..)).collect();
            bytes.splice(at..at, noise);
            at..at
        }
        _ => {
            // The noise looks like the beginning of a packet, again and again.
            let copy: Vec<u8> = bytes.iter().copied().cycle().take(8).collect();
            let noise: Vec<u8> = copy.iter().copied().cycle().take(length).collect();
            bytes.splice(at..at + length, noise);
            at..at + length
        }
    }
}

#[test]
fn fuzz_whole_frames_are_received_unchanged() {
    let mut damaged_frames = 0;
    for seed in 0..case_count() {
        let mut rng = Rng::with_seed(seed);
        let TestStream { layout, bytes, frames } = random_stream(&mut rng, 6);
        let (whole, losses) = read_stream(&mut rng, &layout, &bytes);
        assert_eq!((whole.len(), losses), (6, Vec::new()), "seed {seed}");
        let mut damaged = bytes.clone();
        // Damage is applied from the end, so that earlier offsets stay valid.
        let mut places: Vec<usize> =
            (0..rng.usize(1..4)).map(|_| rng.usize(0..bytes.len())).collect();
        places.sort_unstable();
        // The places are so far apart that no damage overlaps another.
        places.dedup_by(|next, last| *next - *last < 200);
        let damaged_ranges: Vec<_> =
            places.iter().rev().map(|&at| damage(&mut rng, &mut damaged, at)).collect();
        let (received, losses) = read_stream(&mut rng, &layout, &damaged);
        if damaged == bytes {
            continue;
        }
        assert!(!losses.is_empty(), "seed {seed}: damage passes unnoticed");
        for (number, range) in (0u32..).zip(&frames) {
            let is_whole = damaged_ranges.iter().all(|damaged| {
                damaged.end.max(damaged.start + 1) <= range.start
                    || damaged.start >= range.end
                    || *damaged == (range.start..range.start)
            });
            let has_number = |frame: &&ReceivedFrame| frame.number == number;
            let expected = whole.iter().find(has_number).unwrap();
            match received.iter().find(has_number) {
                Some(frame) if is_whole => assert_eq!(frame, expected, "seed {seed}"),
                None if is_whole => {
                    panic!("seed {seed}: frame {number} is whole, and lost: {losses:?}")
                }
                _ => damaged_frames += 1,
            }
        }
        // No frame is received twice, and no frame is invented.
        assert!(received.windows(2).all(|pair| pair[0].number < pair[1].number), "seed {seed}");
        assert!(received.iter().all(|frame| frame.number < 6), "seed {seed}");
    }
    assert!(damaged_frames > case_count() / 2, "{damaged_frames} frames were damaged");
}

#[test]
fn fuzz_noise_is_no_packet() {
    for seed in 0..case_count() {
        let mut rng = Rng::with_seed(seed);
        let TestStream { layout, bytes, .. } = random_stream(&mut rng, 1);
        let noise: Vec<u8> =
            (0..rng.usize(0..5000)).map(|_| *rng.choice(&bytes).unwrap()).collect();
        let (frames, losses) = read_stream(&mut rng, &layout, &noise);
        assert!(frames.is_empty(), "seed {seed}");
        let skipped: u64 = losses.iter().map(|loss| loss.fields()[3].unwrap()).sum();
        assert_eq!(skipped, noise.len() as u64, "every byte is accounted for, seed {seed}");
    }
}

#[test]
fn a_lost_region_is_named() {
    let mut rng = Rng::with_seed(7);
    let TestStream { layout, bytes, .. } = random_stream(&mut rng, 3);
    let region = layout.region_bytes(false);
    // A head of a REGION with pixels has the mark, type 4, and no summary flag.
    let is_region = |at: &usize| bytes[*at] == 0xFA && bytes[at + 1] & 0x4F == 4;
    let at = (layout.frame_bytes()..bytes.len() - region).step_by(8).find(is_region).unwrap();
    let damaged = [&bytes[..at], &bytes[at + region..]].concat();
    let (received, losses) = read_stream(&mut rng, &layout, &damaged);
    assert_eq!(received.len(), 3);
    let place =
        |from: usize| u32::from(u16::from_le_bytes([bytes[at + from], bytes[at + from + 1]]));
    let (row, column) = (place(4), place(6));
    assert_eq!(losses, [StreamLoss::Region { frame: 0, row, column, dropped: false }]);
}

#[test]
fn a_packet_that_comes_too_late_is_ignored() {
    let mut rng = Rng::with_seed(8);
    let TestStream { layout, bytes, frames } = random_stream(&mut rng, 3);
    let (first, second) = (frames[0].end, frames[1].end);
    let late = &bytes[first - 24..first];
    let received = read_stream(&mut rng, &layout, &bytes).0;
    let (received_late, losses) =
        read_stream(&mut rng, &layout, &[&bytes[..second], late, &bytes[second..]].concat());
    assert_eq!(losses, [StreamLoss::Misplaced { frame: 0, count: 1 }]);
    assert!(received_late == received, "the late packet changed a frame");
}

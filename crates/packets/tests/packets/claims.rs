// SPDX-License-Identifier: MIT OR Apache-2.0
//! Packets with correct checksums and wrong numbers. A malicious stream stops nothing, and costs no
//! more memory than its bytes.

use std::ops::Range;

use fastrand::Rng;
use foveate_packets::{
    FrameAssembler, PacketLayout, PacketSplitter, ReceivedFrame, StreamItem, StreamLoss,
    packet_encoding,
};

use crate::damage::case_count;
use crate::stream::{TestStream, random_stream, read_stream};

/// Returns the byte ranges of the packets of a stream.
fn packet_ranges(bytes: &[u8]) -> Vec<Range<usize>> {
    let mut at = 0;
    let next = || {
        let head = bytes.get(at..at + 4)?;
        let start = at;
        at += 8 * usize::from(u16::from_le_bytes([head[2], head[3]]));
        Some(start..at)
    };
    std::iter::from_fn(next).collect()
}

/// Returns a number that programs often handle wrongly.
fn awkward_number(rng: &mut Rng) -> u64 {
    match rng.u8(0..5) {
        0 => 0,
        1 => u64::MAX,
        2 => 1 << rng.u32(0..64),
        3 => (1 << rng.u32(0..64)) - 1,
        _ => rng.u64(..),
    }
}

/// Replaces a number in a packet, and corrects its checksum.
fn forge(rng: &mut Rng, packet: &mut [u8]) {
    let length = [1, 2, 4, 8][rng.usize(0..4)];
    let at = rng.usize(0..(packet.len() - 4 - length) / length + 1) * length;
    packet[at..at + length].copy_from_slice(&awkward_number(rng).to_le_bytes()[..length]);
    let end = packet.len() - 4;
    let check = crc32fast::hash(&packet[..end]);
    packet[end..].copy_from_slice(&check.to_le_bytes());
}

/// Returns the frames and losses received from bytes, and ignores a FRAME that is refused.
fn receive(layout: &PacketLayout, bytes: &[u8]) -> (Vec<ReceivedFrame>, Vec<StreamLoss>) {
    let (mut splitter, mut assembler) =
        (PacketSplitter::default(), FrameAssembler::new(layout.clone()));
    let mut frames = Vec::new();
    splitter.feed(bytes);
    splitter.mark_complete();
    loop {
        match splitter.next(Some(layout)) {
            StreamItem::Pending => break,
            StreamItem::Skipped { offset, bytes } => {
                assembler.add_loss(StreamLoss::Bytes { offset, bytes });
            }
            StreamItem::Packet { frame, packet } => {
                let ended = assembler.push(frame, packet).unwrap_or_default();
                frames.extend(ended.into_iter().flatten());
            }
        }
    }
    frames.extend(assembler.end_frame());
    (frames, assembler.take_losses())
}

#[test]
fn fuzz_a_stream_continues_after_packets_with_any_numbers() {
    for seed in 0..case_count() {
        let mut rng = Rng::with_seed(seed);
        let TestStream { layout, bytes, frames } = random_stream(&mut rng, 6);
        let whole = read_stream(&mut rng, &layout, &bytes).0;
        let mut forged = bytes[..frames[2].end].to_vec();
        let all = packet_ranges(&forged);
        for _ in 0..rng.usize(1..6) {
            let packet = rng.choice(&all).unwrap().clone();
            forge(&mut rng, &mut forged[packet]);
        }
        let copies: Vec<u8> = (0..rng.usize(0..4)).flat_map(|_| forged.clone()).collect();
        forged.extend(copies);
        let forged_part = forged.clone();
        forged.extend(&bytes[frames[3].start..]);
        let (received, losses) = receive(&layout, &forged);
        // At most two frames are lost before the new numbering is recognized, and the last frame is
        // received.
        assert!(received.last() == whole.last(), "seed {seed}: {losses:?}");
        let regions = u64::from(layout.columns() * layout.rows());
        let max_losses =
            (forged_part.len() as u64 / 24 + 4) * (4 + 3 * u64::from(layout.rows()) + regions);
        assert!(losses.len() as u64 <= max_losses, "seed {seed}: {} losses", losses.len());
    }
}

#[test]
fn a_wrong_frame_number_costs_two_frames_at_most() {
    let mut rng = Rng::with_seed(3);
    let TestStream { layout, bytes, frames } = random_stream(&mut rng, 8);
    for jump in [100, 1 << 16, 1 << 30, (1 << 31) - 1, 1 << 31, u32::MAX - 2] {
        let at = frames[2].end;
        let mut forged = bytes[..at].to_vec();
        packet_encoding::append_frame(
            &mut forged,
            &layout,
            2u32.wrapping_add(jump),
            (120_000, false),
        );
        forged.extend(&bytes[at..]);
        let received = read_stream(&mut rng, &layout, &forged).0;
        let numbers: Vec<u32> = received.iter().map(|frame| frame.number).collect();
        assert!(numbers.ends_with(&[5, 6, 7]), "{jump}: {numbers:?}");
    }
}

#[test]
fn a_packet_of_a_later_frame_does_not_become_a_part_of_it() {
    let mut rng = Rng::with_seed(5);
    let TestStream { layout, bytes, frames } = random_stream(&mut rng, 4);
    let whole = read_stream(&mut rng, &layout, &bytes).0;
    // The forged ROW belongs to the last frame, and its decisions are not those of that frame.
    let at = frames[2].start + layout.frame_bytes();
    let mut forged = bytes[..at].to_vec();
    let decisions = vec![Default::default(); layout.columns().try_into().unwrap()];
    packet_encoding::append_row(&mut forged, &layout, 3, 0, &decisions).unwrap();
    forged.extend(&bytes[at..]);
    let (received, losses) = read_stream(&mut rng, &layout, &forged);
    assert!(received.last() == whole.last(), "{losses:?}");
}

#[test]
fn a_packet_that_is_repeated_is_one_loss() {
    let mut rng = Rng::with_seed(4);
    let TestStream { layout, bytes, frames } = random_stream(&mut rng, 2);
    let at = frames[0].start + layout.frame_bytes()
        ..packet_ranges(&bytes).into_iter().nth(1).map(|packet| packet.end).unwrap();
    let mut forged = bytes[..at.end].to_vec();
    (0..50_000).for_each(|_| forged.extend(&bytes[at.clone()]));
    forged.extend(&bytes[at.end..]);
    let (received, losses) = read_stream(&mut rng, &layout, &forged);
    assert_eq!(received.len(), 2);
    assert_eq!(losses, [StreamLoss::Misplaced { frame: 0, count: 50_000 }]);
}

#[test]
fn endless_noise_is_reported_in_parts() {
    for byte in [0, 0xFA] {
        let (mut splitter, mut reported) = (PacketSplitter::default(), 0);
        for _ in 0..64 {
            splitter.feed(&[byte; 1 << 16]);
            while let StreamItem::Skipped { bytes, .. } = splitter.next(None) {
                reported += bytes;
            }
        }
        assert!(reported >= 3 << 20, "{reported} of 4 MiB of {byte:#x}");
    }
}

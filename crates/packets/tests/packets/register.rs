// SPDX-License-Identifier: MIT OR Apache-2.0
//! REGISTER packets: bytes written by hand, and answers between the packets of frames, also in
//! damaged streams.

use std::ops::Range;

use fastrand::Rng;
use foveate_packets::{
    Packet, PacketLayout, PacketSplitter, RegisterCommand, RegisterPacket, StreamItem,
    packet_encoding,
};

use crate::damage::{case_count, damage};
use crate::golden::packet;
use crate::stream::{TestStream, random_stream, read_stream};

/// Returns all REGISTER packets of a stream, and the number of bytes that belong to no packet.
fn registers(bytes: &[u8], layout: Option<&PacketLayout>) -> (Vec<RegisterPacket>, u64) {
    let mut splitter = PacketSplitter::default();
    splitter.feed(bytes);
    splitter.mark_complete();
    let (mut found, mut skipped) = (Vec::new(), 0);
    loop {
        match splitter.next(layout) {
            StreamItem::Pending => break,
            StreamItem::Skipped { bytes, .. } => skipped += bytes,
            StreamItem::Packet { packet: Packet::Register(register), .. } => found.push(register),
            StreamItem::Packet { .. } => {}
        }
    }
    assert_eq!(splitter.consumed_bytes(), bytes.len() as u64);
    (found, skipped)
}

/// Returns a stream with answers between its packets, and the byte ranges of the answers.
fn with_answers(
    rng: &mut Rng,
    stream: &TestStream,
) -> (Vec<u8>, Vec<(Range<usize>, RegisterPacket)>) {
    let (mut bytes, mut answers, mut at) = (Vec::new(), Vec::new(), 0);
    while at < stream.bytes.len() {
        let words = u16::from_le_bytes([stream.bytes[at + 2], stream.bytes[at + 3]]);
        let end = at + 8 * usize::from(words);
        while rng.u8(0..4) == 0 {
            let (address, value) = (rng.u16(..), rng.u32(..));
            let answer = RegisterPacket { address, is_write: rng.bool(), value };
            let start = bytes.len();
            packet_encoding::append_register(&mut bytes, answer);
            answers.push((start..bytes.len(), answer));
        }
        bytes.extend(&stream.bytes[at..end]);
        at = end;
    }
    (bytes, answers)
}

#[test]
fn commands_have_the_bytes_of_the_page() {
    let read = RegisterCommand::read(0x1000);
    assert_eq!(read.bytes(), packet(&[0x0000_1000_0003_06FA, 0], 0));
    let write = RegisterCommand::write(0x104, 0xDEAD_BEEF);
    assert_eq!(write.bytes(), packet(&[0x0000_0104_0003_16FA, 0xDEAD_BEEF], 0));
    let answer = RegisterPacket { address: 0x1000, is_write: false, value: 7 };
    assert_eq!(registers(&packet(&[0x0000_1000_0003_06FA, 7], 0), None), (vec![answer], 0));

    assert!(read.is_answered_by(answer) && !write.is_answered_by(answer));
    assert!(!read.is_answered_by(RegisterPacket { is_write: true, ..answer }));
    assert!(!read.is_answered_by(RegisterPacket { address: 4, ..answer }));
    let written = RegisterPacket { address: 0x104, is_write: true, value: 0xDEAD_BEEF };
    assert!(write.is_answered_by(written));
    assert!(!write.is_answered_by(RegisterPacket { value: 1, ..written }));
}

#[test]
fn bytes_that_are_not_exactly_a_register_packet_are_skipped() {
    let good = 0x0000_0104_0003_16FA_u64;
    assert_eq!(registers(&packet(&[good, 5], 0), None).1, 0);
    let bad_heads = [
        good ^ 0xFF,      // another mark
        good | 0x2 << 12, // an undefined flag
        0x0000_0104_0004_16FA,
        good | 1 << 48,  // a column other than 0
        good | 0x8 << 8, // type 14
    ];
    for head in bad_heads {
        let bytes = packet(&[head, 5], 0);
        assert_eq!(registers(&bytes, None), (Vec::new(), bytes.len() as u64), "{head:x}");
    }
    let mut wrong = packet(&[good, 5], 0);
    wrong[9] ^= 4;
    assert_eq!(registers(&wrong, None), (Vec::new(), 24));
}

#[test]
fn fuzz_answers_between_packets_change_no_frame() {
    for seed in 0..case_count() {
        let mut rng = Rng::with_seed(seed);
        let stream = random_stream(&mut rng, 3);
        let (bytes, answers) = with_answers(&mut rng, &stream);
        let plain = read_stream(&mut rng, &stream.layout, &stream.bytes);
        assert!(plain.1.is_empty());
        assert!(read_stream(&mut rng, &stream.layout, &bytes) == plain, "seed {seed}");
        let expected: Vec<RegisterPacket> = answers.iter().map(|(_, answer)| *answer).collect();
        assert_eq!(registers(&bytes, Some(&stream.layout)), (expected.clone(), 0), "seed {seed}");
        // REGISTER packets are found before the layout is known, too.
        assert_eq!(registers(&bytes, None).0, expected, "seed {seed}");
    }
}

#[test]
fn fuzz_answers_beside_damage_come_back() {
    let mut lost = 0;
    for seed in 0..case_count() {
        let mut rng = Rng::with_seed(seed);
        let stream = random_stream(&mut rng, 3);
        let (mut bytes, answers) = with_answers(&mut rng, &stream);
        let at = rng.usize(0..bytes.len());
        let damaged_range = damage(&mut rng, &mut bytes, at);
        let whole = |(range, _): &&(Range<usize>, RegisterPacket)| {
            damaged_range.end.max(damaged_range.start + 1) <= range.start
                || damaged_range.start >= range.end
        };
        let expected: Vec<RegisterPacket> =
            answers.iter().filter(whole).map(|(_, answer)| *answer).collect();
        let mut found = registers(&bytes, Some(&stream.layout)).0;
        // Noise that is inserted before an answer leaves it whole, so `found` may have more answers
        // than `expected`.
        let is_answer =
            |register: &RegisterPacket| answers.iter().any(|(_, answer)| answer == register);
        assert!(found.iter().all(is_answer), "seed {seed}: one from nowhere");
        lost += answers.len() - found.len();
        let mut rest = expected.iter().peekable();
        found.retain(|register| rest.next_if(|answer| *answer == register).is_some());
        assert_eq!(found, expected, "seed {seed}");
    }
    assert!(lost > 0, "no answer was damaged");
}

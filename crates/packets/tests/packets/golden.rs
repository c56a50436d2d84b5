// SPDX-License-Identifier: MIT OR Apache-2.0
//! The packets of a small frame, written by hand from `docs/packets.md`, word by word.

use foveate_packets::{
    EndPacket, FrameAssembler, Packet, PacketLayout, PacketSplitter, RegionContent, RegionDecision,
    RegionFlags, StreamItem, StreamLoss, packet_encoding,
};

use crate::stream::design;

/// Computes the CRC-32 as `docs/packets.md` defines it, bit by bit.
pub(crate) fn crc(bytes: &[u8]) -> u32 {
    let step = |crc: u32| (crc >> 1) ^ (0xEDB8_8320 & (crc & 1).wrapping_neg());
    !bytes.iter().fold(!0u32, |crc, &byte| (0..8).fold(crc ^ u32::from(byte), |crc, _| step(crc)))
}

/// Returns the bytes of the words, followed by a tail for frame `number`.
pub(crate) fn packet(words: &[u64], number: u32) -> Vec<u8> {
    let mut bytes: Vec<u8> = words.iter().flat_map(|word| word.to_le_bytes()).collect();
    bytes.extend(number.to_le_bytes());
    let check = crc(&bytes);
    bytes.extend(check.to_le_bytes());
    bytes
}

#[test]
fn the_packets_of_a_frame_equal_those_written_by_hand() {
    // The frame has 6 x 3 pixels of 10 bits in 3 x 2 regions of 2 x 2, with one mean per region.
    // The features are edge and variance.
    let design = design(
        "frame={width=6,height=3,pixel_bits=10}\nregion.size=2\ntemporal.min_count=1\nrender.irrelevant='mean'\n\
         periphery.blocks=1\nspatial=[{feature='edge',min_score=0},{feature='variance',min_score=0}]\n",
    );
    let layout = PacketLayout::new(&design, true, 1000).unwrap();
    let fingerprint = u64::from_str_radix(&design.fingerprint(), 16).unwrap();
    let number = 0x0102_0304;
    let mut bytes = Vec::new();
    packet_encoding::append_frame(&mut bytes, &layout, number, (77, true));
    let decision = |srs, trs, summary| RegionDecision { srs, trs, summary };
    let row =
        [decision(true, true, false), decision(false, true, true), decision(true, false, false)];
    packet_encoding::append_row(&mut bytes, &layout, number, 1, &row).unwrap();
    let scores = [[4, 3, 0x1234], [1, 0, 0], [0, 4, 5]];
    packet_encoding::append_scores(&mut bytes, &layout, number, 1, scores.into_iter()).unwrap();
    let flags = RegionFlags { raw: false, summary: false };
    packet_encoding::append_region(&mut bytes, &layout, number, (1, 0), (flags, &[1, 2, 0x3FF, 4]))
        .unwrap();
    let flags = RegionFlags { raw: false, summary: true };
    packet_encoding::append_region(&mut bytes, &layout, number, (1, 1), (flags, &[0x155])).unwrap();
    let end = EndPacket { regions_sent: 2, regions_dropped: 3, rows_dropped: 1 };
    packet_encoding::append_end(&mut bytes, number, end).unwrap();

    let by_hand = [
        packet(
            &[
                0x0000_0001_0007_11FA,
                u64::from_le_bytes(*b"FOVEATE\n"),
                fingerprint,
                77,
                0x0003_0006_0000_03E8,
                0x0002_0003_2201_0A02,
            ],
            number,
        ),
        packet(&[0x0003_0001_0003_02FA, 0x0163], number),
        // The largest score of variance needs 32 bits, so the changed pixels and the edge score lie
        // before it.
        packet(
            &[
                0x0003_0001_0005_03FA,
                0x0000_1234_0003_0004,
                0x0000_0000_0000_0001,
                0x0000_0005_0004_0000,
            ],
            number,
        ),
        packet(&[0x0000_0001_0003_04FA, 0x0004_03FF_0002_0001], number),
        packet(&[0x0001_0001_0003_44FA, 0x0155], number),
        packet(&[0x0000_0001_0003_15FA, 0x0000_0003_0000_0002], number),
    ];
    assert_eq!(bytes, by_hand.concat());
    let lengths = [layout.frame_bytes(), layout.row_bytes(), layout.scores_bytes()];
    let regions = [layout.region_bytes(false), layout.region_bytes(true), layout.end_bytes()];
    let all: Vec<usize> = lengths.into_iter().chain(regions).collect();
    assert_eq!(all, by_hand.iter().map(Vec::len).collect::<Vec<_>>());

    // The packets are then read back.
    let (mut splitter, mut assembler) =
        (PacketSplitter::default(), FrameAssembler::new(layout.clone()));
    splitter.feed(&bytes);
    splitter.mark_complete();
    let (mut frames, mut packets) = (Vec::new(), Vec::new());
    while let StreamItem::Packet { frame, packet } = splitter.next(Some(&layout)) {
        packets.push(packet.clone());
        frames.extend(assembler.push(frame, packet).unwrap().into_iter().flatten());
    }
    assert_eq!(packets.len(), 6);
    assert!(matches!(packets.last(), Some(Packet::End(found)) if *found == end));
    let [frame] = &frames[..] else { panic!("{} frames", frames.len()) };
    assert_eq!((frame.number, frame.info.as_ref().unwrap().time), (number, 77));
    assert_eq!(frame.decisions[3..], row);
    assert_eq!(frame.temporal_count, [0, 0, 0, 4, 1, 0]);
    assert_eq!(frame.scores, [[0, 0, 0, 3, 0, 4], [0, 0, 0, 0x1234, 0, 5]]);
    let pixels = Some(RegionContent::Pixels(vec![1, 2, 0x3FF, 4]));
    assert_eq!(frame.contents[3..], [pixels, Some(RegionContent::Means(vec![0x155])), None]);
    // Row 0 was never written; the END says that the camera dropped a row.
    let dropped = StreamLoss::Row { frame: number, row: 0, dropped: true };
    assert_eq!(assembler.take_losses(), [dropped, StreamLoss::Scores { frame: number, row: 0 }]);
}

#[test]
fn packets_have_the_lengths_of_the_page() {
    let design = design("frame={width=1920,height=1080}\nspatial=[{feature='edge'}]\n");
    let layout = PacketLayout::new(&design, true, 1).unwrap();
    assert_eq!(layout.region_bytes(false), 80);
    assert_eq!((layout.row_bytes(), layout.scores_bytes()), (80, 16 + 8 * 240));
    assert_eq!((layout.frame_bytes(), layout.end_bytes()), (56, 24));
}

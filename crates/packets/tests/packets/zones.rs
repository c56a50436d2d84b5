// SPDX-License-Identifier: MIT OR Apache-2.0
//! The version of the map of classes in FRAME packets: bytes written by hand from
//! `docs/packets.md`, versions that come back as they were sent, and versions that a design cannot
//! have.

use foveate_packets::{
    FrameAssembler, Packet, PacketError, PacketLayout, PacketSplitter, ReceivedFrame, StreamItem,
    packet_encoding,
};

use crate::golden::packet;
use crate::stream::design;

/// The least version, the first committed map, and the last version before the count wraps around.
const VERSIONS: [u16; 3] = [0, 1, 65_535];

/// Returns the layout for 6 x 4 pixels in 3 x 2 regions of 2 x 2, with or without zones.
fn layout(has_zones: bool) -> PacketLayout {
    let zones = if has_zones { "zones={}\n" } else { "" };
    let text = format!(
        "frame={{width=6,height=4}}\nregion.size=2\ntemporal.min_count=1\n\
         spatial=[{{feature='edge',min_score=1}}]\n{zones}"
    );
    PacketLayout::new(&design(&text), false, 1000).unwrap()
}

/// Returns the bytes of a FRAME by the page, for frame 5 at tick 77.
fn frame_by_hand(layout: &PacketLayout, map_version: u16) -> Vec<u8> {
    let words = [
        0x0000_0001_0007_01FA | u64::from(map_version) << 48,
        u64::from_le_bytes(*b"FOVEATE\n"),
        layout.info().fingerprint,
        77,
        0x0004_0006_0000_03E8,
        0x0002_0003_0000_0802,
    ];
    packet(&words, 5)
}

/// Returns the first item that a splitter finds in whole bytes.
fn first_item(layout: Option<&PacketLayout>, bytes: &[u8]) -> StreamItem {
    let mut splitter = PacketSplitter::default();
    splitter.feed(bytes);
    splitter.mark_complete();
    splitter.next(layout)
}

/// Returns the frames that an assembler makes of a stream without damage.
fn receive(layout: &PacketLayout, bytes: &[u8]) -> Vec<ReceivedFrame> {
    let (mut splitter, mut assembler) =
        (PacketSplitter::default(), FrameAssembler::new(layout.clone()));
    splitter.feed(bytes);
    splitter.mark_complete();
    let mut frames = Vec::new();
    while let StreamItem::Packet { frame, packet } = splitter.next(Some(layout)) {
        frames.extend(assembler.push(frame, packet).unwrap().into_iter().flatten());
    }
    assert_eq!((splitter.consumed_bytes(), assembler.take_losses()), (bytes.len() as u64, vec![]));
    frames
}

#[test]
fn a_frame_has_the_version_of_its_map_in_its_head() {
    let layout = layout(true);
    assert!(layout.has_zones());
    for version in VERSIONS {
        let mut bytes = Vec::new();
        packet_encoding::append_frame_of_map(&mut bytes, &layout, 5, (77, false), version).unwrap();
        assert_eq!(bytes, frame_by_hand(&layout, version));
    }
    let mut bytes = Vec::new();
    packet_encoding::append_frame(&mut bytes, &layout, 5, (77, false));
    assert_eq!(bytes, frame_by_hand(&layout, 0));
}

#[test]
fn versions_come_back_as_they_were_sent() {
    let (layout, mut bytes) = (layout(true), Vec::new());
    for (number, version) in (0..).zip(VERSIONS) {
        let start = (u64::from(number), number == 0);
        packet_encoding::append_frame_of_map(&mut bytes, &layout, number, start, version).unwrap();
        let still = vec![Default::default(); layout.columns() as usize];
        for row in 0..layout.rows() {
            packet_encoding::append_row(&mut bytes, &layout, number, row, &still).unwrap();
        }
        packet_encoding::append_end(&mut bytes, number, Default::default()).unwrap();
    }
    let version = |frame: &ReceivedFrame| frame.info.as_ref().unwrap().map_version;
    let received: Vec<u16> = receive(&layout, &bytes).iter().map(version).collect();
    assert_eq!(received, VERSIONS);
}

#[test]
fn a_version_in_a_frame_of_a_design_without_zones_is_damage() {
    let (own, other) = (layout(false), layout(true));
    assert!(!own.has_zones());
    for version in [1, 256, 65_535] {
        let bytes = frame_by_hand(&own, version);
        let damage = StreamItem::Skipped { offset: 0, bytes: 56 };
        assert_eq!(first_item(Some(&own), &bytes), damage);
        // The same bytes with version 0 are a FRAME.
        let whole = first_item(Some(&own), &frame_by_hand(&own, 0));
        assert!(matches!(whole, StreamItem::Packet { packet: Packet::Frame(_), .. }), "{whole:?}");

        // Before the first FRAME the design is not known. The FRAME is found, and then refused.
        let found = first_item(None, &bytes);
        let StreamItem::Packet { frame, packet } = found else { panic!("{found:?}") };
        let refusal = FrameAssembler::new(own.clone()).push(frame, packet).unwrap_err();
        let (stream, what) = (own.info().fingerprint, "version of the map");
        assert_eq!(refusal, PacketError::FieldMismatch { frame: 5, stream, what });

        // A FRAME of a design with zones is a FRAME of another design, whatever its version is.
        let found = first_item(Some(&own), &frame_by_hand(&other, version));
        let StreamItem::Packet { frame, packet } = found else { panic!("{found:?}") };
        let refusal = FrameAssembler::new(own.clone()).push(frame, packet).unwrap_err();
        assert!(matches!(refusal, PacketError::DesignMismatch { .. }), "{refusal:?}");
    }
}

#[test]
fn a_design_without_zones_writes_no_version() {
    let (layout, mut bytes) = (layout(false), vec![7; 3]);
    let refusal = packet_encoding::append_frame_of_map(&mut bytes, &layout, 5, (77, false), 1);
    assert_eq!(bytes, [7; 3]);
    assert_eq!(
        refusal.unwrap_err().to_string(),
        "the version of the map of a packet cannot be 1: it is 0 to 0"
    );
    packet_encoding::append_frame_of_map(&mut bytes, &layout, 5, (77, false), 0).unwrap();
    assert_eq!(bytes[3..], frame_by_hand(&layout, 0));
}

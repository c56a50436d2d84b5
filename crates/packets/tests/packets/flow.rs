// SPDX-License-Identifier: MIT OR Apache-2.0
//! FLOW packets: bytes written by hand from `docs/packets.md`, values that no design can find, and
//! packets that are missing, come twice or belong to no design.

use foveate_camera::Displacement;
use foveate_packets::{
    FlowPacket, FrameAssembler, Packet, PacketError, PacketLayout, PacketSplitter, ReceivedFrame,
    StreamItem, StreamLoss, packet_encoding,
};

use crate::golden::packet;
use crate::stream::design;

/// Returns the layout for 36 x 6 pixels in 9 x 2 regions of 4 x 4, with a radius.
fn layout(radius: u32) -> PacketLayout {
    let design = design(&format!(
        "frame={{width=36,height=6}}\nregion.size=4\ntemporal.min_count=1\n\
         spatial=[{{feature='flow',radius={radius}}}]\nhardware.organization='serial'\n"
    ));
    PacketLayout::new(&design, false, 1000).unwrap()
}

fn displacements(pairs: &[(i8, i8)]) -> Vec<Displacement> {
    pairs.iter().map(|&(dx, dy)| Displacement { dx, dy }).collect()
}

/// The displacements of a row of nine regions, and the bytes of a FLOW with them.
fn row_of_nine() -> (Vec<Displacement>, Vec<u8>) {
    let pairs = [(0, 0), (1, 0), (0, 1), (-1, 0), (0, -1), (3, -3), (-3, 3), (2, -2), (-3, -3)];
    // Two's complement of four bits: -1 is F, -2 is E, -3 is D. The digits of a byte are dy, dx.
    let words = [0x0009_0001_0004_07FA, 0xE23D_D3F0_0F10_0100, 0x0000_0000_0000_00DD];
    (displacements(&pairs), packet(&words, 5))
}

/// Returns the packets that are found in bytes, and the number of bytes that belong to no packet.
fn split(layout: &PacketLayout, bytes: &[u8]) -> (Vec<Packet>, u64) {
    let (mut splitter, mut packets, mut skipped) = (PacketSplitter::default(), Vec::new(), 0);
    splitter.feed(bytes);
    splitter.mark_complete();
    loop {
        match splitter.next(Some(layout)) {
            StreamItem::Pending => return (packets, skipped),
            StreamItem::Skipped { bytes, .. } => skipped += bytes,
            StreamItem::Packet { packet, .. } => packets.push(packet),
        }
    }
}

/// Returns the frame and the losses of a FRAME, these packets and an END, all of frame 5.
fn receive(layout: &PacketLayout, packets: &[Vec<u8>]) -> (ReceivedFrame, Vec<StreamLoss>) {
    let mut bytes = Vec::new();
    packet_encoding::append_frame(&mut bytes, layout, 5, (0, true));
    let still = vec![Default::default(); layout.columns() as usize];
    for row in 0..layout.rows() {
        packet_encoding::append_row(&mut bytes, layout, 5, row, &still).unwrap();
    }
    bytes.extend(packets.concat());
    packet_encoding::append_end(&mut bytes, 5, Default::default()).unwrap();
    let mut assembler = FrameAssembler::new(layout.clone());
    let mut frames = Vec::new();
    for packet in split(layout, &bytes).0 {
        frames.extend(assembler.push(5, packet).unwrap().into_iter().flatten());
    }
    assert_eq!(frames.len(), 1);
    (frames.pop().unwrap(), assembler.take_losses())
}

#[test]
fn a_row_of_displacements_has_the_bytes_of_the_page() {
    let layout = layout(3);
    let (displacements, by_hand) = row_of_nine();
    let mut bytes = Vec::new();
    packet_encoding::append_flow(&mut bytes, &layout, 5, 1, &displacements).unwrap();
    assert_eq!(bytes, by_hand);
    assert_eq!(bytes.len(), layout.flow_bytes());
    let flow = Packet::Flow(FlowPacket { row: 1, displacements });
    assert_eq!(split(&layout, &bytes), (vec![flow], 0));
}

#[test]
fn a_row_has_the_length_of_the_page() {
    let text = "frame={width=1920,height=1080}\nspatial=[{feature='edge'},{feature='flow'}]\n\
                hardware.organization='serial'\n";
    let layout = PacketLayout::new(&design(text), false, 1).unwrap();
    assert_eq!((layout.flow_bytes(), layout.rows()), (256, 135));
    let still = layout.frame_bytes() + layout.end_bytes() + 135 * (layout.row_bytes() + 256);
    assert_eq!(still, 45_440);
}

#[test]
fn displacements_are_received_and_those_of_missing_rows_are_zero() {
    let layout = layout(3);
    let (row, flow) = row_of_nine();
    let zeros = displacements(&[(0, 0); 9]);
    let (frame, losses) = receive(&layout, std::slice::from_ref(&flow));
    assert_eq!(frame.displacements, [zeros, row.clone()].concat());
    assert_eq!(losses, [StreamLoss::Flow { frame: 5, row: 0 }]);
    assert_eq!(losses[0].kind(), "flow");
    assert_eq!(losses[0].to_string(), "frame 5, row 0: displacements are missing");
    assert_eq!(losses[0].fields(), [Some(5), Some(0), None, None, None]);

    let mut first = Vec::new();
    packet_encoding::append_flow(&mut first, &layout, 5, 0, &row).unwrap();
    let (frame, losses) = receive(&layout, &[first.clone(), flow.clone()]);
    assert_eq!((frame.displacements, losses), ([&row[..], &row].concat(), vec![]));

    // The second packet of a row is ignored.
    let mut second = Vec::new();
    let others = displacements(&[(1, 1); 9]);
    packet_encoding::append_flow(&mut second, &layout, 5, 1, &others).unwrap();
    let (frame, losses) = receive(&layout, &[first, flow, second]);
    assert_eq!(frame.displacements, [&row[..], &row].concat());
    assert_eq!(losses, [StreamLoss::Misplaced { frame: 5, count: 1 }]);
}

#[test]
fn a_packet_with_a_displacement_that_is_not_searched_is_damaged() {
    for (radius, possible) in [(1, "0 1 F"), (2, "0 1 2 E F"), (3, "0 1 2 3 D E F")] {
        let layout = layout(radius);
        for digit in 0..16_u64 {
            let is_possible = possible.contains(&format!("{digit:X}"));
            for shift in (0..64).step_by(4) {
                let bytes = packet(&[0x0009_0000_0004_07FA, digit << shift, 0], 0);
                let (packets, skipped) = split(&layout, &bytes);
                assert_eq!(packets.len(), usize::from(is_possible), "{digit:X} << {shift}");
                assert_eq!(skipped, if is_possible { 0 } else { 32 });
            }
        }
        // The receiver ignores bits beyond the last region.
        let bytes = packet(&[0x0009_0000_0004_07FA, 0, 0x8888_8888_8888_8800], 0);
        assert_eq!(split(&layout, &bytes).0.len(), 1);
    }
}

#[test]
fn a_head_that_no_flow_has_is_damaged() {
    let layout = layout(3);
    let head = 0x0009_0001_0004_07FA_u64;
    assert_eq!(split(&layout, &packet(&[head, 0, 0], 0)).0.len(), 1);
    for wrong in [
        0x0009_0001_0004_17FA,
        0x0009_0002_0004_07FA,
        0x0008_0001_0004_07FA,
        0x0000_0001_0004_07FA,
        0x0009_0001_0003_07FA,
        0x0009_0001_0004_08FA,
    ] {
        assert_eq!(split(&layout, &packet(&[wrong, 0, 0], 0)).0.len(), 0, "{wrong:016x}");
    }
    // A design without flow has no such packets.
    let other = design("frame={width=36,height=6}\nregion.size=4\n");
    let other = PacketLayout::new(&other, false, 1000).unwrap();
    assert!(!other.has_flow());
    assert_eq!(split(&other, &packet(&[head, 0, 0], 0)), (vec![], 32));
    assert!(receive(&other, &[]).0.displacements.is_empty());
    // Its receiver does not wait for the rest of one.
    let consumed = |layout| {
        let mut splitter = PacketSplitter::default();
        splitter.feed(&head.to_le_bytes());
        assert_eq!(splitter.next(Some(layout)), StreamItem::Pending);
        splitter.consumed_bytes()
    };
    assert_eq!((consumed(&layout), consumed(&other)), (0, 8));
}

#[test]
fn displacements_that_do_not_fit_are_refused() {
    let refusal = |layout: &PacketLayout, row, pairs: &[(i8, i8)]| -> PacketError {
        let mut bytes = vec![7; 3];
        let displacements = displacements(pairs);
        let error =
            packet_encoding::append_flow(&mut bytes, layout, 0, row, &displacements).unwrap_err();
        assert_eq!(bytes, [7; 3], "{error}");
        error
    };
    let widest = layout(3);
    assert_eq!(
        refusal(&widest, 2, &[(0, 0); 9]).to_string(),
        "the row of a packet cannot be 2: it is 0 to 1"
    );
    assert_eq!(
        refusal(&widest, 0, &[(0, 0); 8]).to_string(),
        "a FLOW of this design carries 9 displacements, not 8"
    );
    for wrong in [(4, 0), (-4, 0), (0, 4), (0, -4), (0, i8::MIN), (16, 0), (0, 16)] {
        let row = [&[(0, 0); 8][..], &[wrong]].concat();
        let (dx, dy) = wrong;
        assert_eq!(
            refusal(&widest, 0, &row).to_string(),
            format!("the displacement of a packet cannot be ({dx}, {dy}): dx and dy are -3 to 3")
        );
    }
    assert_eq!(
        refusal(&layout(1), 0, &[(0, 2); 9]),
        PacketError::DisplacementOutOfRange { dx: 0, dy: 2, radius: 1 }
    );
    let other = design("frame={width=36,height=6}\nregion.size=4\n");
    let other = PacketLayout::new(&other, false, 1000).unwrap();
    for count in [0, 9] {
        assert_eq!(
            refusal(&other, 0, &vec![(0, 0); count]).to_string(),
            "the type of a packet cannot be 7: it is 1 to 6"
        );
    }
}

// SPDX-License-Identifier: MIT OR Apache-2.0
//! A value that does not fit into its field is refused, and the message has the value and the
//! limit. No bit is truncated, and nothing is appended.

use foveate_design::DesignConfig;
use foveate_packets::{
    EndPacket, PacketError, PacketLayout, RegionDecision, RegionFlags, packet_encoding,
};

use crate::stream::design;

/// Returns the layout for 6 x 4 pixels of 4 bits, in 3 x 2 regions of 2 x 2, with one mean per
/// region and with scores.
fn layout() -> PacketLayout {
    let design = design(
        "frame={width=6,height=4,pixel_bits=4}\nregion.size=2\ntemporal={level=1,min_count=1}\nrender.irrelevant='mean'\n\
         periphery={blocks=1,level=1}\nspatial=[{feature='edge',level=9,min_score=1}]\n",
    );
    PacketLayout::new(&design, true, 1000).unwrap()
}

/// Returns the message that refuses a packet, and checks that the output stays unchanged.
fn refusal(attempt: impl FnOnce(&mut Vec<u8>) -> Result<(), PacketError>) -> String {
    let mut bytes = vec![7; 3];
    let error = attempt(&mut bytes).unwrap_err();
    assert_eq!(bytes, [7; 3], "{error}");
    error.to_string()
}

const PIXELS: RegionFlags = RegionFlags { raw: false, summary: false };

#[test]
fn a_packet_that_would_be_longer_than_its_length_says_is_refused() {
    let layout = layout();
    // There are 65,536 words of pixels and two around them, so a length field of 16 bits would hold
    // 2.
    let pixels = vec![0; 8 * 65_536];
    assert_eq!(
        refusal(|out| packet_encoding::append_region(out, &layout, 0, (0, 0), (PIXELS, &pixels))),
        "a REGION of this design carries 4 values, not 524288"
    );
    assert_eq!(
        refusal(|out| packet_encoding::append_row(
            out,
            &layout,
            0,
            0,
            &[RegionDecision::default(); 4]
        )),
        "a ROW of this design carries 3 decisions, not 4"
    );
    let scores = (0..2).map(|_| [0; 2]);
    assert_eq!(
        refusal(|out| packet_encoding::append_scores(out, &layout, 0, 0, scores)),
        "a SCORES of this design carries 3 records, not 2"
    );
    let many = (0..).map(|_| [0; 2]).take(1 << 20);
    assert!(
        refusal(|out| packet_encoding::append_scores(out, &layout, 0, 0, many))
            .contains("3 records, not ")
    );
    let long = (0..3).map(|_| [0; 3]);
    assert_eq!(
        refusal(|out| packet_encoding::append_scores(out, &layout, 0, 0, long)),
        "a SCORES of this design carries 2 numbers of a region, not 3"
    );
}

#[test]
fn a_place_that_no_region_has_is_refused() {
    let layout = layout();
    let region = |place| {
        refusal(|out| packet_encoding::append_region(out, &layout, 0, place, (PIXELS, &[0; 4])))
    };
    let (row, column) = (
        |row| format!("the row of a packet cannot be {row}: it is 0 to 1"),
        |column| format!("the column of a packet cannot be {column}: it is 0 to 2"),
    );
    for wrong in [2, 65_535, 65_536, u32::MAX] {
        assert_eq!(region((wrong, 0)), row(wrong));
        let decisions = [RegionDecision::default(); 3];
        assert_eq!(
            refusal(|out| packet_encoding::append_row(out, &layout, 0, wrong, &decisions)),
            row(wrong)
        );
        let scores = (0..3).map(|_| [0; 2]);
        assert_eq!(
            refusal(|out| packet_encoding::append_scores(out, &layout, 0, wrong, scores)),
            row(wrong)
        );
    }
    for wrong in [3, 65_536, u32::MAX] {
        assert_eq!(region((0, wrong)), column(wrong));
    }
}

#[test]
fn a_number_that_does_not_fit_is_refused() {
    let layout = layout();
    let region = |value| {
        refusal(|out| {
            packet_encoding::append_region(out, &layout, 0, (0, 0), (PIXELS, &[0, value, 0, 0]))
        })
    };
    // A lane of 8 bits would hold 0 for the last value.
    for wrong in [16, 255, 256] {
        assert_eq!(
            region(wrong),
            format!("the value of a packet cannot be {wrong}: it is 0 to 15")
        );
    }
    let score = |record| {
        refusal(|out| packet_encoding::append_scores(out, &layout, 0, 0, (0..3).map(|_| record)))
    };
    assert_eq!(score([65_536, 0]), "the score of a packet cannot be 65536: it is 0 to 4");
    assert_eq!(score([0, 5]), "the score of a packet cannot be 5: it is 0 to 4");
    for rows_dropped in [65_536, u32::MAX] {
        let end = EndPacket { rows_dropped, ..EndPacket::default() };
        let expected =
            format!("the dropped rows of a packet cannot be {rows_dropped}: it is 0 to 65535");
        assert_eq!(refusal(|out| packet_encoding::append_end(out, 0, end)), expected);
    }
}

#[test]
fn flags_that_a_design_does_not_send_are_refused() {
    let design = design(
        "frame={width=6,height=4}\nregion.size=2\ntemporal.min_count=1\nspatial=[{feature='edge',min_score=1}]\n",
    );
    let layout = PacketLayout::new(&design, false, 1).unwrap();
    let scores = (0..3).map(|_| [0; 2]);
    assert_eq!(
        refusal(|out| packet_encoding::append_scores(out, &layout, 0, 0, scores)),
        "a SCORES of this design carries 0 records, not 3"
    );
    let summary = RegionFlags { raw: false, summary: true };
    assert_eq!(
        refusal(|out| packet_encoding::append_region(out, &layout, 0, (0, 0), (summary, &[]))),
        "the summary flag of a packet cannot be 1: it is 0 to 0"
    );
    let raw = RegionFlags { raw: true, summary: false };
    assert_eq!(
        refusal(|out| packet_encoding::append_region(out, &layout, 0, (0, 0), (raw, &[0; 4]))),
        "the raw flag of a packet cannot be 1: it is 0 to 0"
    );
}

#[test]
fn a_design_whose_sizes_do_not_fit_has_no_packets() {
    // A lane serves 1,048,576 regions of 8 x 8 pixels. As an array of its own, it is wider than any
    // frame.
    let serial = "frame={width=8192,height=8192}\nhardware={organization='serial',fold=1048576}\n";
    let lane = design(serial).lone_unit();
    let error = PacketLayout::new(&lane, false, 1).unwrap_err().to_string();
    assert_eq!(error, "the width of a packet cannot be 8388608: it is 0 to 65535");
    let error = PacketLayout::new(&design(""), false, 0).unwrap_err().to_string();
    assert_eq!(error, "the ticks per second of a packet cannot be 0: it is 1 to 4294967295");
    // This is the largest number of columns of regions that a frame with scores can have.
    let wide = "frame={width=16384,height=2,pixel_bits=16}\nregion.size=2\ntemporal.min_count=1\n\
                spatial=[{feature='edge',min_score=1},{feature='mad',mean_fraction_bits=2},{feature='corner',min_score=1},{feature='variance'}]\n";
    let layout =
        PacketLayout::new(&DesignConfig::from_toml(wide).unwrap().validate().unwrap(), true, 1)
            .unwrap();
    assert!(layout.scores_bytes() / 8 <= 65_535, "{}", layout.scores_bytes());
}

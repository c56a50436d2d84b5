// SPDX-License-Identifier: MIT OR Apache-2.0
//! The packets that a simulation writes follow from the model's integers by the page on packets.

use std::fs;

use foveate_camera::{Payload, RegionAction};
use foveate_design::Design;
use foveate_engine::Engine;
use foveate_model::{FunctionalCamera, FunctionalOutcome};
use foveate_pixels::ByteFrame;
use foveate_simulator::{
    EventTableOptions, FrameStart, PacketContent, PictureFormat, RunOptions, SentValues,
    packet_bytes, packet_layout, write_kept_packets, write_packets,
};

use crate::support::{design, frames, street};

/// The designs cover all references, irrelevant modes, payloads and features, with odd sizes and 1
/// to 16 bits. The last two have displacements.
pub(crate) const DESIGNS: [&[&str]; 11] = [
    &["frame.width=45", "frame.height=38"],
    &["frame.width=45", "frame.height=38", "temporal.reference='last-sent'"],
    &[
        "frame.width=45",
        "frame.height=38",
        "temporal.reference='last-sent'",
        "render.payload='raw'",
    ],
    &[
        "frame={width=33,height=50,pixel_bits=10}",
        "render.irrelevant='hold'",
        "temporal.reference='last-sent'",
        "spatial=[{feature='variance'},{feature='mad'}]",
    ],
    &[
        "frame={width=61,height=23,pixel_bits=4}",
        "region.size=5",
        "spatial=[{feature='edge',level=4,min_score=2}]",
        "temporal.level=0",
        "denoise.filter='none'",
    ],
    &[
        "frame.width=45",
        "frame.height=38",
        "render.irrelevant='mean'",
        "temporal.reference='last-sent'",
        "periphery.level=2",
        "spatial=[{feature='edge',min_score=12}]",
    ],
    &[
        "frame={width=70,height=37,pixel_bits=16}",
        "region={size=12,neighborhood='shared'}",
        "render={irrelevant='mean',payload='raw'}",
        "periphery.blocks=4",
        "spatial=[{feature='corner',level=900},{feature='variance'}]",
    ],
    &[
        "frame={width=40,height=40,pixel_bits=12}",
        "region.size=4",
        "spatial=[{feature='mad',min_score=0}]",
        "temporal.min_count=0",
    ],
    &[
        "frame={width=9,height=7,pixel_bits=1}",
        "region.size=64",
        "spatial=[{feature='edge',level=0,min_score=0}]",
        "temporal.level=0",
    ],
    FLOW_DESIGN,
    &[
        "frame={width=75,height=38,pixel_bits=10}",
        "spatial=[{feature='flow',radius=3},{feature='edge'}]",
        "hardware.organization='serial'",
        "render.irrelevant='mean'",
        "temporal.reference='last-sent'",
    ],
];

/// A design with displacements of up to 2 pixels.
pub(crate) const FLOW_DESIGN: &[&str] = &[
    "frame.width=45",
    "frame.height=38",
    "spatial=[{feature='edge'},{feature='flow',radius=2}]",
    "hardware.organization='serial'",
];

pub(crate) fn options(packets: Option<PacketContent>) -> RunOptions {
    RunOptions {
        rendered: Some(PictureFormat::Png),
        events: EventTableOptions { csv: true, parquet: true, only_active: false },
        packets,
        ..RunOptions::default()
    }
}

/// Returns the CRC-32, computed bit by bit.
pub(crate) fn crc(bytes: &[u8]) -> u32 {
    let step = |crc: u32| (crc >> 1) ^ (0xEDB8_8320 & (crc & 1).wrapping_neg());
    !bytes.iter().fold(!0u32, |crc, &byte| (0..8).fold(crc ^ u32::from(byte), |crc, _| step(crc)))
}

/// Returns a packet by the page: a head, numbers of the given widths from the lowest bit of the
/// first word on, and a tail.
fn packet([kind, flags, row, column]: [u64; 4], numbers: &[(u64, usize)], frame: u32) -> Vec<u8> {
    let mut bits: Vec<bool> = Vec::new();
    for &(number, width) in numbers {
        bits.extend((0..width).map(|bit| number >> bit & 1 == 1));
    }
    bits.resize(bits.len().next_multiple_of(64), false);
    let byte = |bits: &[bool]| (0..8).map(|bit| u8::from(bits[bit]) << bit).sum::<u8>();
    let words = bits.len() as u64 / 64 + 2;
    let head = 0xFA | kind << 8 | flags << 12 | words << 16 | row << 32 | column << 48;
    let mut bytes = head.to_le_bytes().to_vec();
    bytes.extend(bits.chunks(8).map(byte));
    bytes.extend(frame.to_le_bytes());
    let check = crc(&bytes);
    bytes.extend(check.to_le_bytes());
    bytes
}

/// Returns the packets of a frame, from the model and the page.
fn by_the_page(design: &Design, number: u32, time: u64, outcome: &FunctionalOutcome) -> Vec<u8> {
    let side = u64::from(design.region_size());
    let (columns, rows) = (u64::from(design.columns()), u64::from(design.rows()));
    let periphery = design.periphery();
    let raw = u64::from(design.payload() == Payload::Raw);
    let irrelevant = ["zero", "hold", "mean"];
    let irrelevant = irrelevant.iter().position(|&name| name == design.irrelevant().to_string());
    let fingerprint = u64::from_str_radix(&design.fingerprint(), 16).unwrap();
    let depth = u64::from(design.pixel_bits());
    let fields = [
        (u64::from_le_bytes(*b"FOVEATE\n"), 64),
        (fingerprint, 64),
        (time, 64),
        (1_000_000, 32),
        (design.width().into(), 16),
        (design.height().into(), 16),
        (side, 8),
        (depth, 8),
        (periphery.map_or(0, |own| own.blocks.into()), 8),
        (irrelevant.unwrap() as u64 | raw << 4, 8),
        (columns, 16),
        (rows, 16),
    ];
    let mut stream = packet([1, u64::from(number == 0), 1, 0], &fields, number);
    let value_bits = if depth <= 8 { 8 } else { 16 };
    let mut sent = 0;
    for row in 0..rows {
        let first = |row: u64| usize::try_from(row * columns).unwrap();
        let of_row = first(row)..first(row + 1);
        let bits = if periphery.is_some() { 4 } else { 2 };
        let code = |region: usize| {
            let summary = outcome.actions[region] == RegionAction::Summarize;
            let bits = [outcome.srs[region], outcome.trs[region], summary];
            (0..).zip(bits).map(|(at, bit)| u64::from(bit) << at).sum()
        };
        let codes: Vec<_> = of_row.clone().map(|region| (code(region), bits)).collect();
        stream.extend(packet([2, 0, row, columns], &codes, number));
        if !outcome.displacements.is_empty() {
            let nibble = |value: i8| u64::from(value.rem_euclid(16).unsigned_abs());
            let numbers = outcome.displacements[of_row.clone()].iter();
            let numbers = numbers.flat_map(|one| [(nibble(one.dx), 4), (nibble(one.dy), 4)]);
            stream.extend(packet([7, 0, row, columns], &numbers.collect::<Vec<_>>(), number));
        }
        for region in of_row {
            let column = region as u64 % columns;
            let payload = outcome.payload(design);
            let pixel = |at: u64| {
                let (x, y) = (column * side + at % side, row * side + at / side);
                payload.get(u32::try_from(x).unwrap(), u32::try_from(y).unwrap())
            };
            let (summary, values): (u64, Vec<u16>) = match outcome.actions[region] {
                RegionAction::Forward => (0, (0..side * side).map(pixel).collect()),
                RegionAction::Summarize => (1, outcome.means[region].clone()),
                RegionAction::Hold | RegionAction::Blank => (2, Vec::new()),
            };
            if summary < 2 {
                let values: Vec<_> =
                    values.iter().map(|&value| (value.into(), value_bits)).collect();
                let flags = raw << 1 | summary << 2;
                stream.extend(packet([4, flags, row, column], &values, number));
                sent += 1;
            }
        }
    }
    stream.extend(packet([5, 0, 0, 0], &[(sent, 64)], number));
    stream
}

#[test]
fn the_stream_is_what_the_page_says_of_the_model() {
    for (at, overrides) in DESIGNS.into_iter().enumerate() {
        let folder = tempfile::tempdir().unwrap();
        let output = folder.path().join("out");
        let options = RunOptions { rendered: None, ..options(Some(PacketContent::Plain)) };
        street(&output, overrides, &options);
        let table = fs::read_to_string(output.join("frames.csv")).unwrap();
        let time = |line: &str| line.split(',').nth(1).unwrap().parse::<u64>().unwrap();
        let design = design(overrides);
        let mut camera = FunctionalCamera::new(&design);
        let mut stream = Vec::new();
        for ((number, frame), line) in (0..).zip(frames(&design)).zip(table.lines().skip(1)) {
            let outcome = camera.step(&frame).unwrap();
            stream.extend(by_the_page(&design, number, time(line), outcome));
        }
        assert!(fs::read(output.join("packets.bin")).unwrap() == stream, "design {at}");
    }
}

#[test]
fn packets_of_kept_values_are_those_of_the_engine_and_have_the_computed_length() {
    for overrides in DESIGNS {
        let design = design(overrides);
        for content in [PacketContent::Plain, PacketContent::WithScores] {
            let layout = packet_layout(&design, content).unwrap();
            let mut engine = Engine::new(&design);
            let mut kept = Vec::new();
            for (number, frame) in (0..).zip(frames(&design)) {
                let frame = ByteFrame::from(&frame);
                engine.step_byte_frame(&frame).unwrap();
                let (time, is_first) = (u64::from(number) * 1000, number == 0);
                let mut bytes = Vec::new();
                write_packets(&mut bytes, &layout, &engine, &frame, number, (time, is_first))
                    .unwrap();
                assert_eq!(packet_bytes(&layout, &engine.outcome().actions), bytes.len() as u64);
                let values = SentValues::of_engine(&engine);
                let start = FrameStart { number, time, is_first, map_version: 0 };
                kept.push((engine.outcome().clone(), values, start, bytes));
            }
            for (outcome, values, start, expected) in kept {
                let mut bytes = Vec::new();
                write_kept_packets(&mut bytes, &layout, &outcome, &values, start).unwrap();
                assert_eq!(bytes, expected, "{overrides:?}");
            }
        }
    }
}

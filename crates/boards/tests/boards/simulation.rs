// SPDX-License-Identifier: MIT OR Apache-2.0
//! What comes over the serial line of a board is what the model says of the frames before its sensor.

use crate::common::{CORE_MHZ, Heard, play, project, simulated};
use crate::film::{Damage, Wires, frames, seen};
use foveate_boards::{Project, Sensor};
use foveate_design::Design;
use foveate_frame::Frame;
use foveate_model::FunctionalCamera;
use foveate_packets::{Found, Layout, Packet, Region, Row, Splitter};
use foveate_toolchain::Tool;
use foveate_toolchain::testing::require_tools;
use std::path::Path;

/// All regions of a frame can leave at this rate of pixels.
const SLOW_PS: u32 = 3_000_003;
/// Faster than the core's clock.
const FAST_PS: u32 = 33_337;

/// Frames of a stream: what was drawn, and the rows of regions that came.
struct Received {
    screens: Vec<Vec<u16>>,
    rows: Vec<Vec<Row>>,
    dropped: u32,
}

fn receive(design: &Design, bytes: &[u8]) -> Result<Received, String> {
    let layout = Layout::new(design, false, CORE_MHZ * 1_000_000);
    let mut splitter = Splitter::default();
    splitter.feed(bytes);
    splitter.complete();
    let mut screen = vec![0; (design.width() * design.height()) as usize];
    let mut received = Received { screens: Vec::new(), rows: Vec::new(), dropped: 0 };
    let mut rows = Vec::new();
    loop {
        match splitter.next(Some(&layout)) {
            Found::Nothing => return Ok(received),
            Found::Skipped { bytes, .. } => return Err(format!("{bytes} bytes are no packet")),
            Found::Packet { packet, .. } => match packet {
                Packet::Region(region) => paint(design, &mut screen, &region),
                Packet::Row(row) => rows.push(row),
                Packet::End(end) => {
                    received.dropped += end.regions_dropped + end.rows_dropped;
                    if rows.len() as u32 + end.rows_dropped != design.rows() {
                        return Err(format!(
                            "{} rows came, {} were dropped",
                            rows.len(),
                            end.rows_dropped
                        ));
                    }
                    received.screens.push(screen.clone());
                    received.rows.push(std::mem::take(&mut rows));
                }
                Packet::Frame(_) | Packet::Scores(_) => {}
            },
        }
    }
}

/// Draws pixels or means of a region, as packets.md has them.
fn paint(design: &Design, screen: &mut [u16], region: &Region) {
    let (side, width) = (design.region_size(), design.width());
    let blocks = if region.flags.summary { design.periphery().unwrap().blocks } else { side };
    for y in 0..side {
        for x in 0..side {
            let value = region.values[(y * blocks / side * blocks + x * blocks / side) as usize];
            let (line, column) = (region.row * side + y, region.column * side + x);
            if line < design.height() && column < width {
                screen[(line * width + column) as usize] = value;
            }
        }
    }
}

/// What the sensor of a project drives for these frames.
fn wires(sensor: &Sensor, film: &[Frame], damage: Damage, gap: usize) -> Vec<u8> {
    let mut wires = Wires::new(sensor);
    for (number, frame) in film.iter().enumerate() {
        wires.frame(frame, if number == 1 { damage } else { Damage::None }, gap);
    }
    wires.bytes
}

/// Compares screens and decisions with the model's.
fn compare(design: &Design, received: &Received, film: &[Frame]) -> Result<(), String> {
    let count = received.screens.len();
    if count != film.len() {
        return Err(format!("{count} frames came, expected {}", film.len()));
    }
    let mut model = FunctionalCamera::new(design);
    for (number, frame) in film.iter().enumerate() {
        let expected = model.step(frame).unwrap();
        for row in &received.rows[number] {
            for (column, decision) in row.decisions.iter().enumerate() {
                let region = (row.row * design.columns()) as usize + column;
                if (decision.srs, decision.trs) != (expected.srs[region], expected.trs[region]) {
                    return Err(format!("frame {number}, region {region}: another decision"));
                }
            }
        }
        if received.dropped == 0 && expected.rendered.pixels() != received.screens[number] {
            return Err(format!("frame {number}: another picture"));
        }
    }
    Ok(())
}

fn check(project: &Project, program: &Path, damage: Damage) -> Result<Heard, String> {
    let film = frames(64, 48, 4);
    let sensor = project.board.sensor().unwrap();
    let heard = play(program, &wires(&sensor, &film, damage, 600), &[], SLOW_PS, 0);
    let received = receive(&project.design, &heard.bytes)?;
    // Lines that are made up come at the clock of the core, too fast for the serial line.
    if received.dropped != 0 && damage != Damage::EarlyVsync {
        return Err(format!("{} rows and regions were dropped", received.dropped));
    }
    compare(&project.design, &received, &seen(&film, damage)).map(|()| heard)
}

const ALL: [Damage; 7] = [
    Damage::None,
    Damage::Noise,
    Damage::LostLine,
    Damage::ShortLine,
    Damage::SplitLine,
    Damage::EarlyVsync,
    Damage::Stopped,
];

#[test]
fn what_leaves_a_board_is_what_the_model_says_of_what_its_sensor_saw() {
    if !require_tools(&[Tool::Verilator, Tool::Cxx]) {
        return;
    }
    for sensor in ["hm01b0-4", "hm01b0-8", "ov7670-qvga"] {
        let project = project(sensor, &[]);
        let program = simulated(&project, None);
        // Every kind of damage with one of them.
        let all = if sensor == "ov7670-qvga" { &ALL[..] } else { &ALL[..1] };
        for &damage in all {
            let heard = check(&project, &program, damage);
            let heard = heard.unwrap_or_else(|error| panic!("{sensor}, {damage:?}: {error}"));
            assert!(
                heard.setup.ends_with("lights 0\n") || heard.setup.ends_with("lights 1\n"),
                "{}",
                heard.setup
            );
        }
    }
}

#[test]
fn a_sensor_that_is_faster_than_its_serial_line_costs_whole_regions_and_no_decision() {
    if !require_tools(&[Tool::Verilator, Tool::Cxx]) {
        return;
    }
    let project = project("hm01b0-4", &[]);
    let program = simulated(&project, None);
    let film = frames(64, 48, 4);
    let sensor = project.board.sensor().unwrap();
    let heard = play(&program, &wires(&sensor, &film, Damage::None, 400_000), &[], FAST_PS, 0);
    let received = receive(&project.design, &heard.bytes).unwrap();
    assert!(received.dropped > 0);
    compare(&project.design, &received, &film).unwrap();
}

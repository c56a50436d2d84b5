// SPDX-License-Identifier: MIT OR Apache-2.0
//! Tests that the serial line of a board sends what the model computes from the frames before its
//! sensor.

use crate::common::{CORE_MHZ, SerialRun, compile_with_sensor, project, run_board};
use crate::sensor_signals::{Damage, SensorWires, expected_frames, frames};
use foveate_boards::{BoardProject, Sensor};
use foveate_design::Design;
use foveate_emit::axi_registers;
use foveate_model::FunctionalCamera;
use foveate_packets::{
    Packet, PacketLayout, PacketSplitter, RegionPacket, RegisterCommand, RegisterPacket, RowPacket,
    StreamItem,
};
use foveate_pixels::Frame;
use foveate_tools::{
    Tool,
    testing::{require_tools, sample},
};
use std::path::Path;

/// The period of the pixel clock in picoseconds at which all regions of a frame can leave.
const SLOW_PS: u32 = 3_000_003;
/// A period in picoseconds that is shorter than that of the core's clock.
const FAST_PS: u32 = 33_337;

/// The received frames: the screens, and the rows of regions.
struct ReceivedFrames {
    screens: Vec<Vec<u16>>,
    rows: Vec<Vec<RowPacket>>,
    dropped: u32,
    answers: Vec<RegisterPacket>,
}

fn receive(design: &Design, bytes: &[u8]) -> Result<ReceivedFrames, String> {
    let layout = PacketLayout::new(design, false, CORE_MHZ * 1_000_000).unwrap();
    let mut splitter = PacketSplitter::default();
    splitter.feed(bytes);
    splitter.mark_complete();
    let mut screen = vec![0; (design.width() * design.height()) as usize];
    let mut received =
        ReceivedFrames { screens: Vec::new(), rows: Vec::new(), dropped: 0, answers: Vec::new() };
    let mut rows = Vec::new();
    loop {
        match splitter.next(Some(&layout)) {
            StreamItem::Pending => return Ok(received),
            StreamItem::Skipped { bytes, .. } => {
                return Err(format!("{bytes} bytes are no packet"));
            }
            StreamItem::Packet { packet, .. } => match packet {
                Packet::Region(region) => draw_region(design, &mut screen, &region),
                Packet::Row(row) => rows.push(row),
                Packet::End(end) => {
                    received.dropped += end.regions_dropped + end.rows_dropped;
                    if rows.len() + end.rows_dropped as usize != design.rows() as usize {
                        return Err(format!(
                            "{} rows came, {} were dropped",
                            rows.len(),
                            end.rows_dropped
                        ));
                    }
                    received.screens.push(screen.clone());
                    received.rows.push(std::mem::take(&mut rows));
                }
                Packet::Register(answer) => received.answers.push(answer),
                Packet::Frame(_) | Packet::Scores(_) | Packet::Flow(_) => {}
            },
        }
    }
}

/// Draws the pixels or means of a region, as packets.md defines them.
fn draw_region(design: &Design, screen: &mut [u16], region: &RegionPacket) {
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

/// Returns the wires of a project's sensor for these frames.
fn wires(sensor: &Sensor, input_frames: &[Frame], damage: Damage, gap: usize) -> Vec<u8> {
    let mut wires = SensorWires::new(sensor);
    for (number, frame) in input_frames.iter().enumerate() {
        wires.frame(frame, if number == 1 { damage } else { Damage::None }, gap);
    }
    wires.bytes
}

/// Compares screens and decisions with the model's.
fn compare(
    design: &Design,
    received: &ReceivedFrames,
    input_frames: &[Frame],
) -> Result<(), String> {
    let count = received.screens.len();
    if count != input_frames.len() {
        return Err(format!("{count} frames came, expected {}", input_frames.len()));
    }
    let mut model = FunctionalCamera::new(design);
    for (number, frame) in input_frames.iter().enumerate() {
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

fn check_board(
    project: &BoardProject,
    program: &Path,
    damage: Damage,
) -> Result<SerialRun, String> {
    let input_frames = frames(64, 48, 4);
    let sensor = project.board.sensor_with_pins().unwrap().unwrap().0;
    let wires = wires(&sensor, &input_frames, damage, 600);
    let place = address(project, "frame");
    // Answers come between packets, whenever a command is sent.
    let host = timed_bytes(
        &(1..=30)
            .map(|turn| (700 * turn, RegisterCommand::read(place).bytes()))
            .collect::<Vec<_>>(),
    );
    let run = run_board(program, &wires, &host, SLOW_PS, 0);
    let received = receive(&project.design, &run.bytes)?;
    let answer = RegisterPacket { address: place, is_write: false, value: 48 << 16 | 64 };
    if run.has_broken_bytes || received.answers != [answer; 30] {
        return Err(format!("{} answers came", received.answers.len()));
    }
    // Lines that the core adds come at its own clock, which is too fast for the serial line.
    if received.dropped != 0 && damage != Damage::EarlyVsync {
        return Err(format!("{} rows and regions were dropped", received.dropped));
    }
    compare(&project.design, &received, &expected_frames(&input_frames, damage)).map(|()| run)
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
fn a_board_sends_what_the_model_computes_from_its_sensor() {
    if !require_tools(&[Tool::Verilator, Tool::Cxx]) {
        return;
    }
    // The program of the first sensor serves another test, too.
    for sensor in sample(["hm01b0-4", "hm01b0-8", "ov7670-qvga"], 3) {
        let project = project(sensor, &[]);
        let program = compile_with_sensor(&project, None);
        // One of the sensors is tested with every kind of damage.
        let all = if sensor == "ov7670-qvga" { &ALL[..] } else { &ALL[..1] };
        for &damage in all {
            let run = check_board(&project, &program, damage);
            let run = run.unwrap_or_else(|error| panic!("{sensor}, {damage:?}: {error}"));
            assert!(
                run.setup.ends_with("lights 0\n") || run.setup.ends_with("lights 1\n"),
                "{}",
                run.setup
            );
        }
    }
}

#[test]
fn a_serial_line_that_is_too_slow_drops_regions_but_no_decisions() {
    if !require_tools(&[Tool::Verilator, Tool::Cxx]) {
        return;
    }
    let project = project("hm01b0-4", &[]);
    let program = compile_with_sensor(&project, None);
    let input_frames = frames(64, 48, 4);
    let sensor = project.board.sensor_with_pins().unwrap().unwrap().0;
    let run =
        run_board(&program, &wires(&sensor, &input_frames, Damage::None, 400_000), &[], FAST_PS, 0);
    let received = receive(&project.design, &run.bytes).unwrap();
    assert!(received.dropped > 0);
    compare(&project.design, &received, &input_frames).unwrap();
}

/// Returns the bytes of commands, each with its time in microseconds.
fn timed_bytes(commands: &[(u32, Vec<u8>)]) -> Vec<(u32, u8)> {
    let timed =
        |(at, bytes): &(u32, Vec<u8>)| bytes.iter().map(|&byte| (*at, byte)).collect::<Vec<_>>();
    commands.iter().flat_map(timed).collect()
}

fn address(project: &BoardProject, name: &str) -> u16 {
    let registers = axi_registers(project.design.as_raster().unwrap());
    let found = registers.iter().find(|register| register.name == name);
    u16::try_from(found.unwrap_or_else(|| panic!("no register {name}")).address).unwrap()
}

/// Registers are read and written between packets, thresholds take effect with the next frame, and
/// an incomplete command is ignored.
#[test]
fn a_host_reads_and_writes_registers_over_the_same_line() {
    if !require_tools(&[Tool::Verilator, Tool::Cxx]) {
        return;
    }
    let project = project("ov7670-qvga", &[]);
    let program = compile_with_sensor(&project, None);
    let input_frames = frames(64, 48, 4);
    let sensor = project.board.sensor_with_pins().unwrap().unwrap().0;
    let wires = wires(&sensor, &input_frames, Damage::None, 60_000);
    // The write comes between the second and the third frame.
    let frame_us =
        u32::try_from(wires.len() as u64 / 2 / 4 * u64::from(SLOW_PS) / 1_000_000).unwrap();
    let change = 2 * frame_us - frame_us / 8;
    let level = address(&project, "temporal_level");
    let mut broken = RegisterCommand::read(0).bytes();
    broken[9] ^= 4;
    let truncated = RegisterCommand::read(4).bytes()[..20].to_vec();
    let host = timed_bytes(&[
        (100, RegisterCommand::read(0).bytes()),
        (400, broken),
        (700, truncated),
        (1000, RegisterCommand::read(0x1000).bytes()),
        (1300, RegisterCommand::write(level, 77).bytes()),
        (1600, RegisterCommand::read(level).bytes()),
        (1900, RegisterCommand::read(0x1004).bytes()),
        (2200, RegisterCommand::write(level, 8).bytes()),
        (change, RegisterCommand::write(level, 250).bytes()),
        (4 * frame_us, RegisterCommand::read(0x1000).bytes()),
        (4 * frame_us + 300, RegisterCommand::read(address(&project, "frames")).bytes()),
    ]);
    let run = run_board(&program, &wires, &host, SLOW_PS, 0);
    let received = receive(&project.design, &run.bytes).unwrap();
    let answer = |address, written, value| RegisterPacket { address, is_write: written, value };
    let expected = [
        answer(0, false, u32::from_le_bytes(*b"FOVE")),
        answer(0x1000, false, 0),
        answer(level, true, 77),
        answer(level, false, 77),
        answer(0x1004, false, 0),
        answer(level, true, 8),
        answer(level, true, 250),
        answer(0x1000, false, 1),
        answer(address(&project, "frames"), false, 4),
    ];
    assert_eq!(received.answers, expected);
    let changes = |number: usize| {
        let decisions = received.rows[number].iter().flat_map(|row| &row.decisions);
        decisions.filter(|decision| decision.trs).count()
    };
    assert!(changes(1) > 0);
    assert_eq!((changes(2), changes(3)), (0, 0), "no pixel changes by more than 250");
}

/// The writes to a sensor are those of its file. A write without an acknowledge is tried again, and
/// then given up.
#[test]
fn a_sensor_is_set_up() {
    if !require_tools(&[Tool::Verilator, Tool::Cxx]) {
        return;
    }
    for sensor in sample(["hm01b0-8", "ov7670-qvga"], 2) {
        let project = project(sensor, &[]);
        let program = compile_with_sensor(&project, None);
        let host = timed_bytes(&[(60_000, RegisterCommand::read(0x1000).bytes())]);
        let sensor = project.board.sensor_with_pins().unwrap().unwrap().0;
        let bytes = sensor.i2c.address_bytes as usize;
        let line = |address: u16, value: u8| {
            let address = &address.to_be_bytes()[2 - bytes..];
            let all = [&[sensor.i2c.device << 1], address, &[value]].concat();
            all.iter().map(|byte| format!("{byte:02X} ")).collect::<String>()
        };
        let expected: Vec<_> =
            sensor.writes().map(|(address, value)| line(address, value)).collect();
        for (nacks, failed) in [(0, false), (2, false), (3, true)] {
            let run = run_board(&program, &[], &host, SLOW_PS, nacks);
            let mut lines: Vec<_> = run.setup.lines().collect();
            let lights = if failed { "lights 2" } else { "lights 0" };
            assert_eq!(lines.pop(), Some(lights));
            // The first write is given up.
            let expected = if failed { &expected[1..] } else { &expected[..] };
            assert_eq!(lines, expected, "{nacks} bytes were not acknowledged");
            let received = receive(&project.design, &run.bytes).unwrap();
            let value = 1 | u32::from(failed) << 1;
            assert_eq!(
                received.answers,
                [RegisterPacket { address: 0x1000, is_write: false, value }]
            );
        }
    }
}

/// Faults in the wiring must be found.
#[test]
fn faults_between_sensor_and_line_are_found() {
    if !require_tools(&[Tool::Verilator, Tool::Cxx]) {
        return;
    }
    let project = project("hm01b0-4", &[]);
    // Each fault needs a program of its own. All are planted by scripts/release.sh, and a fifth of
    // them in every run.
    let faults = [
        ("board", ".LEFT(2)", ".LEFT(1)"),
        ("board", ".TOP(2)", ".TOP(3)"),
        ("board", ".FORMAT(3)", ".FORMAT(4)"),
        ("board", ".VSYNC_HIGH(0)", ".VSYNC_HIGH(1)"),
        ("board", ".s_axis_video_tuser(sof)", ".s_axis_video_tuser(eol)"),
        ("board", ".s_axis_video_tlast(eol)", ".s_axis_video_tlast(1'b0)"),
        ("board", "uart_sender #(.DIVISOR(4))", "uart_sender #(.DIVISOR(5))"),
        ("board", ".last_i(packet_last)", ".last_i(1'b1)"),
        ("board", "wire rst = !awake_q[7];", "wire rst = 1'b0;"),
        ("board", ".m_araddr_o(araddr)", ".m_araddr_o()"),
    ];
    for fault in sample(faults, 5) {
        let program = compile_with_sensor(&project, Some(fault));
        let found = check_board(&project, &program, Damage::None);
        assert!(found.is_err(), "not seen: {fault:?}");
    }
}

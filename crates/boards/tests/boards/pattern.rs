// SPDX-License-Identifier: MIT OR Apache-2.0
//! Tests of the whole top of the VCU118. The sums over its core's packets for the pattern equal the
//! model's, and registers are read over the serial line.

use std::fs;
use std::process::Command as Process;

use crate::common::{PlantedFault, compile, verilog};
use foveate_boards::{Board, BoardProject};
use foveate_design::DesignConfig;
use foveate_packets::{Packet, PacketLayout, PacketSplitter, RegisterCommand, StreamItem};
use foveate_tools::{
    Tool,
    testing::{require_tools, sample},
};

const BENCH: &str = include_str!("pattern.cpp");
/// The number of clocks with the serial line, after an LED is on.
const SERIAL_CLOCKS: u32 = 400_000;
const CLOCK_LIMIT: u64 = 60_000_000;
const PASS_LEDS: &str = "4";
const FAIL_LEDS: &str = "2";

fn vcu118(keys: &[&str]) -> BoardProject {
    let board = Board::find("vcu118").unwrap();
    let toml = board.config().unwrap().to_toml();
    let design = DesignConfig::from_toml_with(&toml, keys).unwrap().validate().unwrap();
    BoardProject::new(board, design).unwrap()
}

/// Returns the LEDs of a run, and the bytes that came after that.
fn play(project: &BoardProject, fault: PlantedFault<'_>, host: &[u8]) -> (String, Vec<u8>) {
    let constants = format!(
        "#define DIVISOR 136\n#define AFTER {SERIAL_CLOCKS}\n#define LIMIT {CLOCK_LIMIT}\n"
    );
    let program = compile(verilog(project, fault), "board", &constants, BENCH);
    let dir = tempfile::tempdir().unwrap();
    fs::write(dir.path().join("host"), host).unwrap();
    let run = Process::new(program).arg(dir.path()).output().unwrap();
    let output = String::from_utf8(run.stdout).unwrap();
    let lights = output.split(' ').next().unwrap().to_owned();
    (lights, fs::read(dir.path().join("heard")).unwrap())
}

const SMALL: &[&str] = &["frame={width=200,height=76}"];

#[test]
fn sums_on_the_board_are_those_of_the_model() {
    if !require_tools(&[Tool::Verilator, Tool::Cxx]) {
        return;
    }
    let four_pixels: &[&str] =
        &["frame={width=200,height=76}", "hardware.pixels_per_clock=4", "denoise.filter='none'"];
    for (keys, address) in [(SMALL, 0x1000), (four_pixels, 0)] {
        let project = vcu118(keys);
        let (lights, received) = play(&project, None, &RegisterCommand::read(address).bytes());
        assert_eq!(lights, PASS_LEDS, "{keys:?}");
        let mut splitter = PacketSplitter::default();
        splitter.feed(&received);
        let layout = PacketLayout::new(&project.design, false, 125_000_000).unwrap();
        let (mut answers, mut others) = (Vec::new(), 0);
        loop {
            match splitter.next(Some(&layout)) {
                StreamItem::Pending => break,
                // Only the end of the first packet was received.
                StreamItem::Skipped { bytes, .. } => assert!(others == 0 && bytes < 200, "{bytes}"),
                StreamItem::Packet { packet: Packet::Register(answer), .. } => {
                    answers.push(answer.value);
                }
                StreamItem::Packet { .. } => others += 1,
            }
        }
        let [answer] = answers[..] else { panic!("{} answers", answers.len()) };
        if address == 0 {
            assert_eq!(answer, u32::from_le_bytes(*b"FOVE"));
        } else {
            assert_eq!(answer & 0xFFFF, 1, "all right");
            assert!(answer >> 16 >= 16, "frames: {}", answer >> 16);
        }
        assert!(others > 0, "packets are shown, too");
    }
}

/// The frames have the size and rate of the board. The test is run by hand, because it takes 33
/// million clocks.
#[test]
#[ignore = "takes a minute"]
fn sums_at_full_size_are_those_of_the_model() {
    let (lights, _) = play(&vcu118(&[]), None, &[]);
    assert_eq!(lights, PASS_LEDS);
}

#[test]
fn a_faulty_core_lights_the_error_led() {
    if !require_tools(&[Tool::Verilator, Tool::Cxx]) {
        return;
    }
    let project = vcu118(SMALL);
    let faults = [
        // The faults are a rare pixel value, a sum that is compared too early, and a missing line.
        ("board", "_tdata(pixel)", "_tdata(pixel ^ {7'd0, pixel == 8'd231})"),
        ("packet_signature", "done_q <= add_end_q;", "done_q <= tail_q && end_q;"),
        ("board", ".LINES(76)", ".LINES(75)"),
    ];
    for fault in sample(faults, 3) {
        assert_eq!(play(&project, Some(fault), &[]).0, FAIL_LEDS, "{fault:?}");
    }
}

// SPDX-License-Identifier: MIT OR Apache-2.0
//! Tests of registers over a line: commands are REGISTER packets, answers appear on the page, and
//! thresholds are written.

use std::sync::mpsc::{Receiver, channel};
use std::thread;

use foveate_packets::{RegisterPacket, packet_encoding};
use serde_json::Value;

use crate::client::{get, open, wait_for, write};
use crate::line::SerialLine;
use crate::sent::{CORE, street_stream};

/// Answers every command with its address plus one, or with the written value, and returns all
/// commands. `spoil` may replace the bytes of an answer.
fn answer_commands(
    mut line: SerialLine,
    spoil: impl Fn(usize, Vec<u8>) -> Vec<u8> + Send + 'static,
) -> Receiver<RegisterPacket> {
    let (sender, commands) = channel();
    thread::spawn(move || {
        for number in 0.. {
            let command = line.command();
            let value =
                if command.is_write { command.value } else { u32::from(command.address) + 1 };
            let mut bytes = Vec::new();
            packet_encoding::append_register(&mut bytes, RegisterPacket { value, ..command });
            // A test that has seen the answer finds the command.
            let is_watched = sender.send(command).is_ok();
            line.send(&spoil(number, bytes));
            if !is_watched {
                return;
            }
        }
    });
    commands
}

fn value(state: &Value, address: u32) -> Option<u64> {
    let list = state["registers"].as_array()?;
    list.iter().find(|register| register["address"] == address)?["value"].as_u64()
}

#[test]
fn registers_are_read_and_thresholds_written() {
    let line = SerialLine::new();
    let view = open(&line.path, &CORE, None).unwrap();
    let commands = answer_commands(line, |_, bytes| bytes);
    let page = wait_for(view.link(), "registers", |state| value(state, 0x1000) == Some(0x1001));
    for address in [0x20, 0x24, 0x28, 0x2C, 0x34, 0x38, 0x3C, 0x40, 0x100, 0x104] {
        assert_eq!(value(&page.state, address), Some(u64::from(address) + 1), "{address:#x}");
    }
    assert!(commands.try_iter().all(|command| !command.is_write && command.value == 0));
    let page = String::from_utf8(get(view.link(), "").body).unwrap();
    for part in [
        "\"name\":\"edge_level\"",
        "\"kind\":\"threshold\"",
        "\"name\":\"events\"",
        "\"name\":\"board\"",
    ] {
        assert!(page.contains(part), "{part}");
    }

    assert_eq!(write(view.link(), 0x104, 5).status, 200);
    let written: Vec<RegisterPacket> =
        commands.try_iter().filter(|command| command.is_write).collect();
    assert_eq!(written, [RegisterPacket { address: 0x104, is_write: true, value: 5 }]);
    assert_eq!(write(view.link(), 0x28, 0x41).status, 200);
    // This is a restart, with the other bits of the control as they are.
    assert_eq!(write(view.link(), 0x20, 5).status, 200);
    // These are values that are too large, counters, constants, and registers that do not exist.
    for (address, value) in
        [(0x100, 1 << 32), (0x104, 70_000), (0x34, 0), (0x20, 8), (0x1000, 1), (0x200, 1), (0, 1)]
    {
        let refused = write(view.link(), address, value);
        assert_eq!(refused.status, 409, "{address:#x}: {}", String::from_utf8_lossy(&refused.body));
    }
    let written: Vec<RegisterPacket> =
        commands.try_iter().filter(|command| command.is_write).collect();
    let written: Vec<(u16, u32)> =
        written.iter().map(|command| (command.address, command.value)).collect();
    assert_eq!(written, [(0x28, 0x41), (0x20, 5)]);
}

#[test]
fn a_register_is_read_again_if_its_answer_is_lost_or_of_another_register() {
    let line = SerialLine::new();
    let view = open(&line.path, &CORE, None).unwrap();
    let commands = answer_commands(line, |number, mut bytes| match number {
        // The first answer is damaged. The second is preceded by one of another register.
        0 => {
            bytes[9] ^= 1;
            bytes
        }
        1 => {
            let mut other = Vec::new();
            packet_encoding::append_register(
                &mut other,
                RegisterPacket { address: 0x40, is_write: false, value: 9 },
            );
            [other, bytes].concat()
        }
        _ => bytes,
    });
    // The registers are complete after the first round.
    let page = wait_for(view.link(), "registers", |state| state["registers"].is_array());
    assert_eq!((value(&page.state, 0), value(&page.state, 0x40)), (Some(1), Some(0x41)));
    assert_eq!(page.state["losses"]["bytes"], 1);
    let asked: Vec<u16> = commands.try_iter().take(3).map(|asked| asked.address).collect();
    assert_eq!(asked[..2], [0, 0]);
    assert_ne!(asked[2], 0);
}

#[test]
fn answers_between_packets_change_no_frame() {
    let sent = street_stream(&CORE, 2);
    let mut line = SerialLine::new();
    let view = open(&line.path, &CORE, None).unwrap();
    // The board answers one command after the other, each behind a frame.
    for (number, frame) in (1u64..).zip(&sent.frames) {
        let asked = line.command();
        line.send(frame);
        let mut bytes = Vec::new();
        packet_encoding::append_register(&mut bytes, RegisterPacket { value: 7, ..asked });
        line.send(&bytes);
        let page = wait_for(view.link(), "frame", |state| state["frames"] == number);
        assert_eq!(page.state["losses"], serde_json::json!({}));
    }
}

#[test]
fn a_board_that_does_not_answer_is_reported_and_asked_again() {
    let mut line = SerialLine::new();
    let view = open(&line.path, &CORE, None).unwrap();
    let next_address = |line: &mut SerialLine| line.command().address;
    // There are three attempts, and three more in the next round.
    assert_eq!(next_address(&mut line), 0);
    let page = wait_for(view.link(), "list", |state| state["registers"].is_array());
    let list = page.state["registers"].as_array().unwrap();
    assert!(list.iter().all(|register| register["value"].is_null()), "{list:?}");
    let all: Vec<u16> = (0..5).map(|_| next_address(&mut line)).collect();
    assert_eq!(all, [0; 5]);
}

#[test]
fn without_a_core_on_axi_no_registers_are_read() {
    let ports = &CORE[..1];
    let line = SerialLine::new();
    let view = open(&line.path, ports, None).unwrap();
    let page = String::from_utf8(get(view.link(), "").body).unwrap();
    assert!(page.contains("const REGISTERS = null;"));
    assert_eq!(write(view.link(), 0x104, 5).status, 409);
}

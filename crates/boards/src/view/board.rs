// SPDX-License-Identifier: MIT OR Apache-2.0
//! The registers of a core on a serial line. All are read again and again, and a register is
//! written when a browser asks for it. Only one command at a time is on the line.

use std::fs::File;
use std::io::Write as _;
use std::sync::mpsc::{Receiver, RecvTimeoutError, Sender, SyncSender, channel, sync_channel};
use std::sync::{Arc, Mutex, OnceLock, PoisonError};
use std::time::{Duration, Instant};

use foveate_design::{Design, DesignConfig};
use foveate_emit::{FieldKind, Register, RegisterField, register_table};
use foveate_simulator::{RegisterCommand, RegisterPacket as Answer};
use serde_json::{Value, json};

use crate::view::ViewError;
use crate::view::shared_stream::{RegisterReading, SharedStream};

/// The time to wait for an answer. After a shorter pause than this a board takes the next byte for
/// the first byte of a command, so an incomplete command does not spoil the next one.
const ANSWER_LIMIT: Duration = Duration::from_millis(300);
/// The number of times that a command is sent.
const ATTEMPTS: u32 = 3;
/// The time between two rounds through all registers.
const ROUND_PAUSE: Duration = Duration::from_secs(1);
/// The time that a browser waits for its write.
const WRITE_LIMIT: Duration = Duration::from_secs(10);
/// The number of answers that are kept until they are read. A board that sends more answers was not
/// asked for them.
const ANSWER_QUEUE: usize = 256;
/// The address of the board's own register.
const BOARD_ADDRESS: u32 = 0x1000;

/// A register that a browser wants to write, and the sender for the result.
struct RegisterWrite {
    address: u16,
    value: u32,
    result: Sender<bool>,
}

/// The registers of a core, and the port to it.
#[derive(Debug, Default)]
pub(crate) struct BoardRegisters {
    table: OnceLock<Vec<Register>>,
    writes: OnceLock<Sender<RegisterWrite>>,
    port_file: Mutex<Option<File>>,
}

impl BoardRegisters {
    /// Begins to read the registers, if there is a port and the design has registers. Returns the
    /// sender for the board's answers.
    pub(crate) fn start(
        self: &Arc<Self>,
        config: &DesignConfig,
        live: &Arc<SharedStream>,
        has_port: bool,
    ) -> Result<SyncSender<Answer>, ViewError> {
        let (answer, answers) = sync_channel(ANSWER_QUEUE);
        // The size of frames changes only the constants of the register map.
        let design = config.validate().ok().filter(|design| has_port && design.is_on_axi());
        if let Some(table) = design.as_ref().and_then(read_registers) {
            let (write, writes) = channel();
            self.table.get_or_init(|| table);
            self.writes.get_or_init(|| write);
            let (registers, live) = (Arc::clone(self), Arc::clone(live));
            crate::view::start_thread("registers", move || {
                registers.run(&live, &writes, &answers);
            })?;
        }
        Ok(answer)
    }

    /// Sets the port to write to; `None` while the port is gone.
    pub(crate) fn set_port(&self, port: Option<File>) {
        *self.port_file.lock().unwrap_or_else(PoisonError::into_inner) = port;
    }

    /// Returns a copy of the port, so that no lock is held while a command is written. The reader
    /// may want to report meanwhile that the port is gone.
    fn port(&self) -> Option<File> {
        let port = self.port_file.lock().unwrap_or_else(PoisonError::into_inner);
        port.as_ref().and_then(|port| port.try_clone().ok())
    }

    /// Returns the description of the registers for the page.
    pub(crate) fn describe(&self) -> Value {
        let field = |field: &RegisterField| {
            let RegisterField { name, low, width, kind, doc } = field;
            json!({"name": name, "low": low, "width": width, "kind": kind_name(kind), "doc": doc})
        };
        self.table.get().map_or(Value::Null, |table| {
            let register = |entry: &Register| {
                let fields: Vec<Value> = entry.fields.iter().map(field).collect();
                json!({"name": entry.name, "address": entry.address, "doc": entry.doc, "fields": fields})
            };
            table.iter().map(register).collect()
        })
    }

    /// Writes a register. Fails with a message if the register cannot be written, the value is too
    /// large, or the board does not answer.
    pub(crate) fn write(&self, address: u64, value: u64) -> Result<(), String> {
        let table =
            self.table.get().ok_or("the stream has no core with registers that can be written")?;
        let register = table.iter().find(|register| u64::from(register.address) == address);
        let register = register.ok_or_else(|| format!("there is no register {address:#x}"))?;
        let width = register.fields.iter().filter(|field| may_be_written(field));
        let width = width.map(|field| field.low + field.width).max();
        let width =
            width.ok_or_else(|| format!("the register `{}` can only be read", register.name))?;
        if value >> width != 0 {
            let most = (1u64 << width) - 1;
            return Err(format!("`{}` is at most {most}, not {value}", register.name));
        }
        let fitting = u16::try_from(register.address).ok().zip(u32::try_from(value).ok());
        let (address, value) = fitting.ok_or("a register has 32 bits")?;
        let (sender, receiver) = channel();
        let sent = self
            .writes
            .get()
            .and_then(|writes| writes.send(RegisterWrite { address, value, result: sender }).ok());
        match sent.and_then(|()| receiver.recv_timeout(WRITE_LIMIT).ok()) {
            Some(true) => Ok(()),
            Some(false) | None => {
                Err("the board did not answer; the register may have been written all the same"
                    .to_owned())
            }
        }
    }

    fn run(
        &self,
        live: &SharedStream,
        writes: &Receiver<RegisterWrite>,
        answers: &Receiver<Answer>,
    ) {
        let table = self.table.get().map_or(&[][..], Vec::as_slice);
        while !live.is_over() {
            let mut readings = Vec::with_capacity(table.len());
            for register in table {
                while let Ok(write) = writes.try_recv() {
                    self.send_write(&write, answers);
                }
                let is_silent =
                    readings.first().is_some_and(|first: &RegisterReading| first.value.is_none());
                let address = u16::try_from(register.address).unwrap_or(u16::MAX);
                // If the first register of a round has no answer, the others are not asked for
                // until the next round.
                let value = if is_silent {
                    None
                } else {
                    self.ask(RegisterCommand::read(address), answers)
                };
                readings.push(RegisterReading { address: register.address, value });
            }
            live.set_registers(readings);
            match writes.recv_timeout(ROUND_PAUSE) {
                Ok(write) => self.send_write(&write, answers),
                Err(RecvTimeoutError::Timeout) => {}
                Err(RecvTimeoutError::Disconnected) => return,
            }
        }
    }

    fn send_write(&self, write: &RegisterWrite, answers: &Receiver<Answer>) {
        let answer = self.ask(RegisterCommand::write(write.address, write.value), answers);
        // A browser that no longer waits sees the value in the table.
        let _ = write.result.send(answer.is_some());
    }

    /// Sends a command up to [`ATTEMPTS`] times, until it is answered.
    fn ask(&self, command: RegisterCommand, answers: &Receiver<Answer>) -> Option<u32> {
        for _ in 0..ATTEMPTS {
            // Answers to earlier commands are dropped; further answers may come meanwhile.
            answers.try_iter().take(ANSWER_QUEUE).for_each(drop);
            let port = self.port();
            port?.write_all(&command.bytes()).ok()?;
            let until = Instant::now() + ANSWER_LIMIT;
            while let Some(left) = until.checked_duration_since(Instant::now()) {
                match answers.recv_timeout(left) {
                    Ok(answer) if command.is_answered_by(answer) => return Some(answer.value),
                    Ok(_) => {}
                    Err(_) => break,
                }
            }
        }
        None
    }
}

fn read_registers(design: &Design) -> Option<Vec<Register>> {
    let status = |name: &str, low: u32, width: u32, doc: &str| RegisterField {
        name: name.to_owned(),
        low,
        width,
        kind: FieldKind::Status,
        doc: doc.to_owned(),
    };
    let board = Register {
        name: "board".to_owned(),
        address: BOARD_ADDRESS,
        fields: vec![
            status("done", 0, 1, "the sensor is set up"),
            status("failed", 1, 1, "the sensor did not acknowledge a register"),
            status("lost", 16, 16, "pixels lost because a buffer was full, modulo 2^16"),
        ],
        doc: "the board around the core".to_owned(),
    };
    // The first register shows that there is a core. Other constant registers are left out, because
    // every FRAME packet has their values.
    let is_read =
        |register: &Register| register.address == 0 || register.fields.iter().any(may_change);
    let all = register_table(design)?;
    Some(all.into_iter().filter(is_read).chain([board]).collect())
}

/// Returns true if a field may read as another value later.
fn may_change(field: &RegisterField) -> bool {
    match field.kind {
        FieldKind::Status
        | FieldKind::Control { .. }
        | FieldKind::Threshold { .. }
        | FieldKind::External { .. }
        | FieldKind::Event => true,
        FieldKind::Constant(_) | FieldKind::Command => false,
    }
}

fn may_be_written(field: &RegisterField) -> bool {
    match field.kind {
        FieldKind::Threshold { .. }
        | FieldKind::Control { .. }
        | FieldKind::External { .. }
        | FieldKind::Command
        | FieldKind::Event => true,
        FieldKind::Constant(_) | FieldKind::Status => false,
    }
}

fn kind_name(kind: &FieldKind) -> &'static str {
    match kind {
        FieldKind::Constant(_) => "constant",
        FieldKind::Status => "status",
        FieldKind::Control { .. } => "control",
        FieldKind::Threshold { .. } => "threshold",
        FieldKind::External { .. } => "external",
        FieldKind::Command => "command",
        FieldKind::Event => "event",
    }
}

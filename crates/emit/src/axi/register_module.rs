// SPDX-License-Identifier: MIT OR Apache-2.0
//! Fills `axi_registers.v` from the table of registers.

use super::registers::{FieldKind, REGISTER_BITS, Register, RegisterField, thresholds};
use crate::banner;
use askama::Template;
use foveate_design::Design;

#[derive(Template)]
#[template(path = "axi_registers.v")]
pub(super) struct RegisterModule {
    banner: String,
    module: &'static str,
    /// True if the upper half of the addresses shows a memory outside; such a module has no
    /// interrupt.
    has_window: bool,
    ports: Vec<ModulePort>,
    state: Vec<StateRegister>,
    /// The copies of thresholds that take effect when a frame begins, each with its source.
    taken_thresholds: Vec<(String, String)>,
    /// The commands, which last for one clock.
    commands: Vec<String>,
    writes: Vec<ByteWrite>,
    events: Vec<EventBit>,
    external_fields: Vec<ExternalField>,
    reads: Vec<(u32, String)>,
    outputs: Vec<(String, String)>,
}

struct ModulePort {
    declaration: String,
    doc: String,
}

struct StateRegister {
    name: String,
    range: String,
    reset: String,
}

/// A byte of a field, or a part of one, that is written with its own strobe.
struct ByteWrite {
    word: u32,
    byte: u32,
    target: String,
    range: String,
}

/// A field whose value the core itself keeps, which takes what is written.
struct ExternalField {
    name: String,
    word: u32,
    /// The expression of the value that the core takes.
    value: String,
    needs_all_bytes: bool,
}

struct EventBit {
    name: String,
    word: u32,
    byte: u32,
    bit: u32,
}

/// Returns the register module of a core on AXI, or that of an array on a board, which has no
/// interrupt and a memory in the upper half of its addresses.
pub(super) fn register_module(
    design: &Design,
    (module, has_window): (&'static str, bool),
    registers: &[Register],
) -> RegisterModule {
    let mut view = RegisterModule {
        banner: banner(design),
        module,
        has_window,
        ports: Vec::new(),
        state: Vec::new(),
        taken_thresholds: Vec::new(),
        commands: Vec::new(),
        writes: Vec::new(),
        events: Vec::new(),
        external_fields: Vec::new(),
        reads: Vec::new(),
        outputs: Vec::new(),
    };
    for register in registers {
        for field in &register.fields {
            view.add_field(register, field);
        }
        view.reads.push((register.address / 4, read_value(register)));
    }
    for threshold in thresholds(design) {
        // Parts are listed from the lowest bits on, but a concatenation begins with the highest.
        let mut parts: Vec<_> =
            threshold.parts().iter().map(|part| format!("{}_taken_q", part.name)).collect();
        parts.reverse();
        let name = threshold.port.name.trim_end_matches("_i");
        view.add_port("output", threshold.port.width, &format!("{name}_o"), &threshold.port.doc);
        view.outputs.push((name.to_owned(), format!("{{{}}}", parts.join(", "))));
    }
    if !has_window {
        view.add_port("output", 1, "interrupt_o", "an enabled event has happened");
    }
    if let Some(last) = view.ports.last_mut() {
        last.declaration = last.declaration.replace(',', "");
    }
    view
}

impl RegisterModule {
    fn add_field(&mut self, register: &Register, field: &RegisterField) {
        let name = signal_name(register, field);
        let is_test = register.name == "interrupt_test";
        match field.kind {
            FieldKind::Constant(_) => {}
            FieldKind::Status => {
                self.add_port("input ", field.width, &format!("{name}_i"), &field.doc);
            }
            FieldKind::Control { reset } => {
                self.add_state(name.clone(), field.width, reset);
                self.add_writes(register, field, &name);
                // The enable bits of interrupts have no output port.
                if register.name != "interrupt_enable" {
                    self.add_output(&name, field);
                }
            }
            FieldKind::Threshold { reset } => {
                self.add_state(name.clone(), field.width, reset);
                self.add_state(format!("{name}_taken"), field.width, reset);
                self.add_writes(register, field, &name);
                self.taken_thresholds.push((format!("{name}_taken"), format!("{name}_q")));
            }
            FieldKind::Command => {
                self.add_state(name.clone(), field.width, 0);
                self.add_writes(register, field, &name);
                self.commands.push(name.clone());
                if !is_test {
                    self.add_output(&name, field);
                }
            }
            FieldKind::External { by_bytes } => {
                self.add_port("input ", field.width, &format!("{name}_i"), &field.doc);
                self.add_port("output", field.width, &format!("{name}_o"), &field.doc);
                let doc = format!("{name}_o is written");
                self.add_port("output", 1, &format!("{name}_write_o"), &doc);
                self.external_fields.push(ExternalField {
                    word: register.address / 4,
                    value: if by_bytes {
                        merged_bytes(field, &name)
                    } else {
                        format!("wdata_i[{}:{}]", field.low + field.width - 1, field.low)
                    },
                    needs_all_bytes: !by_bytes,
                    name,
                });
            }
            FieldKind::Event => {
                self.add_state(name, 1, 0);
                self.add_port("input ", 1, &format!("{}_i", field.name), &field.doc);
                self.events.push(EventBit {
                    name: field.name.clone(),
                    word: register.address / 4,
                    byte: field.low / 8,
                    bit: field.low,
                });
            }
        }
    }

    fn add_state(&mut self, name: String, width: u32, reset: u32) {
        self.state.push(StateRegister {
            name,
            range: range(width),
            reset: format!("{width}'d{reset}"),
        });
    }

    fn add_output(&mut self, name: &str, field: &RegisterField) {
        self.add_port("output", field.width, &format!("{name}_o"), &field.doc);
        self.outputs.push((name.to_owned(), format!("{name}_q")));
    }

    fn add_port(&mut self, direction: &str, width: u32, name: &str, doc: &str) {
        let declaration = format!("{direction} wire {:6} {name},", range(width));
        self.ports.push(ModulePort { declaration, doc: doc.to_owned() });
    }

    /// Adds a write for each byte of a field, since each byte has a strobe of its own.
    fn add_writes(&mut self, register: &Register, field: &RegisterField, name: &str) {
        for (byte, own, written) in field_bytes(field) {
            self.writes.push(ByteWrite {
                word: register.address / 4,
                byte,
                target: format!("{name}_q{own}"),
                range: written,
            });
        }
    }
}

/// Returns the value of a field `name` of the core, in which the written bytes are replaced.
fn merged_bytes(field: &RegisterField, name: &str) -> String {
    let bytes = field_bytes(field).into_iter().rev();
    let byte = |(byte, own, written): (u32, String, String)| {
        format!("wstrb_i[{byte}] ? wdata_i{written} : {name}_i{own}")
    };
    format!("{{{}}}", bytes.map(byte).collect::<Vec<_>>().join(", "))
}

/// Returns the bytes of a register in which a field lies: the number of the byte, the range of its
/// bits in the field, and that in the register.
fn field_bytes(field: &RegisterField) -> Vec<(u32, String, String)> {
    let end = field.low + field.width;
    let mut parts = Vec::new();
    let mut low = field.low;
    while low < end {
        let high = end.min(low / 8 * 8 + 8);
        let bits = |from: u32| match (high - low, field.width) {
            (1, 1) => String::new(),
            (1, _) => format!("[{from}]"),
            (width, _) => format!("[{}:{from}]", from + width - 1),
        };
        let written = if high - low == 1 { format!("[{low}]") } else { bits(low) };
        parts.push((low / 8, bits(low - field.low), written));
        low = high;
    }
    parts
}

/// Returns the signal name of a field: the names of register and field, or the name of the register
/// alone if the field is named `value`.
fn signal_name(register: &Register, field: &RegisterField) -> String {
    match field.name.as_str() {
        "value" => register.name.clone(),
        own => format!("{}_{own}", register.name),
    }
}

/// Returns the 32 bits that a register reads as, the highest first.
fn read_value(register: &Register) -> String {
    let mut parts = Vec::new();
    let mut end = 0;
    for field in &register.fields {
        if field.low > end {
            parts.push(zeros(field.low - end));
        }
        end = field.low + field.width;
        let name = signal_name(register, field);
        parts.push(match field.kind {
            FieldKind::Constant(value) => format!("{}'d{value}", field.width),
            FieldKind::Status | FieldKind::External { .. } => format!("{name}_i"),
            FieldKind::Control { .. } | FieldKind::Threshold { .. } | FieldKind::Event => {
                format!("{name}_q")
            }
            FieldKind::Command => zeros(field.width),
        });
    }
    if end < REGISTER_BITS {
        parts.push(zeros(REGISTER_BITS - end));
    }
    parts.reverse();
    parts.join(", ")
}

fn zeros(width: u32) -> String {
    format!("{width}'d0")
}

fn range(width: u32) -> String {
    if width == 1 { String::new() } else { format!("[{}:0]", width - 1) }
}

// SPDX-License-Identifier: MIT OR Apache-2.0
//! Writes the table of registers as Markdown, as a C header and as SystemRDL, and the script that
//! packages a core for Vivado.

use std::fmt::Write;

use super::registers::{FieldKind, Register, RegisterField};
use crate::SourceFile;
use crate::verilog_text::rendered_text;
use askama::Template;

#[derive(Template)]
#[template(path = "package_ip.tcl")]
struct PackageIpScript<'a> {
    banner: &'a str,
    top: &'a str,
    description: String,
    files: Vec<&'a str>,
    registers: Vec<String>,
}

fn highest_bit(field: &RegisterField) -> u32 {
    field.low + field.width - 1
}

/// Returns the page of a core's registers, as Markdown.
pub(super) fn register_page(banner: &str, registers: &[Register]) -> String {
    let mut text = format!(
        "# Registers\n\n{banner}. Addresses are in bytes, values as after a reset.\n\n\
         | address | register | bits | field | access | value | |\n| --- | --- | --- | --- | --- | --- | --- |\n"
    );
    for register in registers {
        for (index, field) in register.fields.iter().enumerate() {
            let (address, name) = match index {
                0 => (format!("0x{:03X}", register.address), format!("`{}`", register.name)),
                _ => Default::default(),
            };
            let value = field.kind.reset().map_or(String::new(), |value| format!("0x{value:X}"));
            let bits = format!("[{}:{}]", highest_bit(field), field.low);
            let row =
                [address, name, bits, format!("`{}`", field.name), field.kind.access().to_owned()];
            let doc = match field.name.as_str() {
                "value" => format!("{}: {}", register.doc, field.doc),
                _ => field.doc.clone(),
            };
            writeln!(text, "| {} | {value} | {doc} |", row.join(" | "))
                .expect("a string takes all");
        }
    }
    text
}

/// Returns the header of the registers, for C99 and C++.
pub(super) fn c_header(banner: &str, registers: &[Register]) -> String {
    let mut text = format!(
        "/* SPDX-License-Identifier: MIT OR Apache-2.0 */\n/* {banner}. Registers, by their addresses in bytes. */\n\
         #ifndef FOVEATE_REGISTERS_H\n#define FOVEATE_REGISTERS_H\n"
    );
    for register in registers {
        let name = register.name.to_uppercase();
        write!(
            text,
            "\n/* {} */\n#define FOVEATE_{name} 0x{:03X}u\n",
            register.doc, register.address
        )
        .expect("a string takes all");
        for field in &register.fields {
            let name = match field.name.as_str() {
                "value" => name.clone(),
                own => format!("{name}_{}", own.to_uppercase()),
            };
            let mask = u64::from(u32::MAX) >> (32 - field.width) << field.low;
            write!(
                text,
                "#define FOVEATE_{name}_SHIFT {}\n#define FOVEATE_{name}_MASK 0x{mask:08X}u /* {} */\n",
                field.low, field.doc
            )
            .expect("a string takes all");
            if let FieldKind::Constant(value) = field.kind {
                writeln!(text, "#define FOVEATE_{name}_VALUE 0x{value:X}u")
                    .expect("a string takes all");
            }
        }
    }
    text + "\n#endif\n"
}

/// Returns the registers as SystemRDL 2.0.
pub(super) fn system_rdl(banner: &str, registers: &[Register]) -> String {
    let mut text = format!(
        "// SPDX-License-Identifier: MIT OR Apache-2.0\n// {banner}.\n\naddrmap foveate {{\n    name = \"Foveate core\";\n    \
         default regwidth = 32;\n    default accesswidth = 32;\n"
    );
    for register in registers {
        write!(text, "\n    reg {{\n        desc = \"{}\";\n", register.doc)
            .expect("a string takes all");
        for field in &register.fields {
            let access = match field.kind {
                FieldKind::Constant(_) | FieldKind::Status => "sw = r; hw = w;",
                FieldKind::Control { .. } | FieldKind::Threshold { .. } => "sw = rw; hw = r;",
                FieldKind::External { .. } => "sw = rw; hw = rw;",
                FieldKind::Command => "sw = w; hw = r; singlepulse;",
                FieldKind::Event => "sw = rw; hw = w; woclr; hwset;",
            };
            let reset = match &field.kind {
                // A value driven by hardware has no reset value that software could rely on.
                FieldKind::Status => String::new(),
                kind => format!(" = {}'h{:X}", field.width, kind.reset().unwrap_or_default()),
            };
            writeln!(
                text,
                "        field {{ desc = \"{}\"; {access} }} {}[{}:{}]{reset};",
                field.doc.replace('`', ""),
                field.name,
                highest_bit(field),
                field.low
            )
            .expect("a string takes all");
        }
        writeln!(text, "    }} {} @ 0x{:03X};", register.name, register.address)
            .expect("a string takes all");
    }
    text + "};\n"
}

/// Returns the script that packages a core as IP for Vivado, with its modules, its top and its
/// registers.
pub(super) fn package_ip(
    banner: &str,
    top: &str,
    sources: &[SourceFile],
    registers: &[Register],
) -> String {
    rendered_text(&PackageIpScript {
        banner,
        top,
        description: format!("Region-based event camera. {banner}."),
        files: sources.iter().map(|file| file.path.as_str()).collect(),
        registers: registers.iter().map(tcl_register).collect(),
    })
}

fn tcl_register(register: &Register) -> String {
    let field = |field: &RegisterField| {
        let (access, written) = match field.kind {
            FieldKind::Constant(_) | FieldKind::Status => ("read-only", "modify"),
            FieldKind::Control { .. }
            | FieldKind::Threshold { .. }
            | FieldKind::External { .. } => ("read-write", "modify"),
            FieldKind::Command => ("write-only", "modify"),
            FieldKind::Event => ("read-write", "oneToClear"),
        };
        let RegisterField { name, low, width, doc, .. } = field;
        format!("{{{name} {low} {width} {access} {written} {{{doc}}}}}")
    };
    let fields: Vec<_> = register.fields.iter().map(field).collect();
    let Register { name, address, doc, .. } = register;
    format!("{{{name} 0x{address:03X} {{{doc}}} {{{}}}}}", fields.join(" "))
}

// SPDX-License-Identifier: MIT OR Apache-2.0
//! The registers of a core on AXI4-Lite: one table from which Verilog, C, Markdown and SystemRDL
//! are made.

use crate::camera_flags::threshold_value;
use foveate_camera::{IrrelevantRendering, Payload};
use foveate_design::{CLASS_WORD_BITS, CoreInterface, Design, Port, RasterDesign};

pub(crate) const REGISTER_BITS: u32 = 32;
const MAP_VERSION: u32 = 1;
/// The address of the first threshold, in bytes.
const THRESHOLD_BASE: u32 = 0x100;

/// The behaviour of a field.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum FieldKind {
    /// The field always reads as this value.
    Constant(u32),
    /// The field reads the value that the core drives.
    Status,
    /// The field holds the value written last, and `reset` before the first write.
    Control {
        /// The value after a reset.
        reset: u32,
    },
    /// The field behaves as `Control`, but the core takes a new value over when a frame begins.
    Threshold {
        /// The value after a reset.
        reset: u32,
    },
    /// The core itself keeps the value, and the field reads what the core drives.
    External {
        /// True if bytes are written one by one, and false if the core takes a value only if all
        /// strobes are 1.
        by_bytes: bool,
    },
    /// Writing 1 triggers an action once; the field reads as 0.
    Command,
    /// The field becomes 1 when the event happens, and 0 when 1 is written to it.
    Event,
}

impl FieldKind {
    /// Returns the access that software has, in the words of the register documents.
    #[must_use]
    pub fn access(&self) -> &'static str {
        match self {
            Self::Constant(_) | Self::Status => "read",
            Self::Control { .. } | Self::Threshold { .. } | Self::External { .. } => "read, write",
            Self::Command => "write 1",
            Self::Event => "read, write 1 to clear",
        }
    }

    /// Returns the value after a reset; `None` for a status, whose value comes from the core.
    #[must_use]
    pub fn reset(&self) -> Option<u32> {
        match *self {
            Self::Constant(value)
            | Self::Control { reset: value }
            | Self::Threshold { reset: value } => Some(value),
            Self::Command | Self::Event | Self::External { .. } => Some(0),
            Self::Status => None,
        }
    }
}

/// Adjacent bits of a register with one meaning.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct RegisterField {
    /// The name of the field.
    pub name: String,
    /// The lowest bit of the field.
    pub low: u32,
    /// The number of bits of the field.
    pub width: u32,
    /// The behaviour of the field.
    pub kind: FieldKind,
    /// The meaning of the field, as text for its documents.
    pub doc: String,
}

/// A 32-bit word that a processor reads or writes.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Register {
    /// The name of the register.
    pub name: String,
    /// The address in bytes, relative to the base of the core.
    pub address: u32,
    /// The fields, from low bits to high ones.
    pub fields: Vec<RegisterField>,
    /// The purpose of the register, as text for its documents.
    pub doc: String,
}

/// The events and their descriptions, in the order of the bits of `EVENTS`.
const EVENTS: [(&str, &str); 8] = [
    ("eol_early", "a line was too short, and its last pixel was repeated"),
    ("eol_late", "a line was too long, and its last pixels were left out"),
    ("sof_early", "a frame was too short, and its last line was repeated"),
    ("sof_late", "pixels came between two frames, and were left out"),
    ("frame_skipped", "a frame came while two were in progress, and was skipped"),
    ("region_dropped", "pixels or means of a region were dropped, because the sink stalled"),
    ("row_dropped", "decisions of a row were dropped, because the sink stalled"),
    ("frame_done", "the last packet of a frame has left"),
];

/// Returns the registers with which every map begins: the identity of the core, and what the core
/// computes. The register `version` has the fields `beside` in addition to the version itself.
pub(super) fn common_registers(design: &Design, beside: Vec<RegisterField>) -> Vec<Register> {
    let fingerprint = fingerprint_number(design);
    let low = u32::try_from(fingerprint & 0xFFFF_FFFF).expect("32 bits");
    let high = u32::try_from(fingerprint >> REGISTER_BITS).expect("32 bits");
    let mut list = Vec::new();
    let mut add = |address: u32, name: &str, doc: &str, fields: Vec<RegisterField>| {
        list.push(Register { name: name.to_owned(), address, fields, doc: doc.to_owned() });
    };
    let constant = |name: &str, low: u32, width: u32, value: u32, doc: &str| {
        field(name, low, width, FieldKind::Constant(value), doc)
    };
    let all = |value: u32, doc: &str| vec![constant("value", 0, REGISTER_BITS, value, doc)];
    let magic = u32::from_le_bytes(*b"FOVE");
    add(0x000, "identity", "identifies a Foveate core", all(magic, "ASCII `FOVE`"));
    let width = beside.first().map_or(REGISTER_BITS, |field| field.low);
    let mut version =
        vec![constant("value", 0, width, MAP_VERSION, "grows with every incompatible change")];
    version.extend(beside);
    add(0x004, "version", "version of this map", version);
    add(
        0x008,
        "fingerprint_low",
        "fingerprint of the design",
        all(low, "last 8 digits of the fingerprint"),
    );
    add(
        0x00C,
        "fingerprint_high",
        "fingerprint of the design",
        all(high, "first 8 digits of the fingerprint"),
    );
    add(
        0x010,
        "frame",
        "size of a frame",
        vec![
            constant("width", 0, 16, design.width(), "W, pixels"),
            constant("height", 16, 16, design.height(), "H, rows"),
        ],
    );
    add(
        0x014,
        "grid",
        "regions of a frame",
        vec![
            constant("columns", 0, 16, design.columns(), "C"),
            constant("rows", 16, 16, design.rows(), "R"),
        ],
    );
    let means = design.periphery().map_or(0, |periphery| periphery.blocks);
    add(
        0x018,
        "region",
        "a region and what it sends",
        vec![
            constant("size", 0, 8, design.region_size(), "N, pixels of a side"),
            constant("pixel_bits", 8, 8, design.pixel_bits(), "P"),
            constant("means", 16, 8, means, "q, means of a side; 0 without summaries"),
            constant("irrelevant", 24, 4, irrelevant_code(design), "0 `zero`, 1 `hold`, 2 `mean`"),
            constant("raw", 28, 1, raw_flag(design), "1: raw pixels leave"),
        ],
    );
    list
}

/// Returns the registers of the core of a design, by address.
#[must_use]
pub fn axi_registers(design: RasterDesign<'_>) -> Vec<Register> {
    let mut list = common_registers(&design, Vec::new());
    let mut add = |address: u32, name: &str, doc: &str, fields: Vec<RegisterField>| {
        list.push(Register { name: name.to_owned(), address, fields, doc: doc.to_owned() });
    };
    let status = |width: u32, doc: &str| vec![field("value", 0, width, FieldKind::Status, doc)];
    add(
        0x01C,
        "tick_rate",
        "ticks of time in packets",
        status(32, "ticks per second: the clock of the core in Hz"),
    );
    add(
        0x020,
        "control",
        "control of the core",
        vec![
            field(
                "enable",
                0,
                1,
                FieldKind::Control { reset: 1 },
                "0: no frame begins, and incoming frames are left out",
            ),
            field(
                "wait",
                1,
                1,
                FieldKind::Control { reset: 0 },
                "1: a frame that may not begin yet holds up its source; 0: it is skipped",
            ),
            field(
                "restart",
                2,
                1,
                FieldKind::Command,
                "forgets all references as soon as no frame is in progress",
            ),
        ],
    );
    add(
        0x024,
        "status",
        "state of the core",
        vec![
            field("busy", 0, 1, FieldKind::Status, "a frame is in progress"),
            field(
                "restarting",
                1,
                1,
                FieldKind::Status,
                "a restart waits for the frames in progress",
            ),
        ],
    );
    let each = |kind: &FieldKind| {
        let event =
            |(bit, (name, doc)): (u32, &(&str, &str))| field(name, bit, 1, kind.clone(), doc);
        (0..).zip(&EVENTS).map(event).collect::<Vec<_>>()
    };
    add(
        0x028,
        "events",
        "events that have happened; writing 1 clears one",
        each(&FieldKind::Event),
    );
    add(
        0x02C,
        "interrupt_enable",
        "events that raise `interrupt_o`",
        each(&FieldKind::Control { reset: 0 }),
    );
    add(
        0x030,
        "interrupt_test",
        "writing 1 sets the event, to test an interrupt",
        each(&FieldKind::Command),
    );
    add(
        0x034,
        "frames",
        "frames that came, skipped ones included",
        status(32, "modulo 2^32; the number of the next frame"),
    );
    for (address, name, doc) in [
        (0x038, "repaired", "frames that were damaged"),
        (0x03C, "skipped", "frames that were skipped"),
        (0x040, "dropped", "regions that were dropped"),
    ] {
        add(address, name, doc, status(16, "modulo 2^16"));
    }
    list.extend(design.zones().map(|_| class_registers(&design)).into_iter().flatten());
    list.extend(threshold_registers(&design));
    list
}

/// Returns the registers of the memory of classes: a window of words whose address advances, and
/// the commits.
fn class_registers(design: &Design) -> [Register; 3] {
    let register = |address, name: &str, doc: &str, fields| Register {
        name: name.to_owned(),
        address,
        fields,
        doc: doc.to_owned(),
    };
    let word = "16 classes of 2 bits: 0 normal, 1 off, 2 keen, 3 always; reads as 0";
    let address = "a write to `zone_word` advances it, and a commit sets it to 0";
    let pending =
        "a committed map waits for the end of a frame; `zone_word` and `commit` have no effect";
    [
        register(
            0x044,
            "zone_word",
            "writes a word of the map of classes",
            vec![field("value", 0, CLASS_WORD_BITS, FieldKind::External { by_bytes: false }, word)],
        ),
        register(
            0x048,
            "zone_address",
            "number of the word that is written next",
            vec![field(
                "value",
                0,
                design.class_address_bits(),
                FieldKind::External { by_bytes: true },
                address,
            )],
        ),
        register(
            0x04C,
            "zone_control",
            "the map of classes",
            vec![
                field(
                    "commit",
                    0,
                    1,
                    FieldKind::Command,
                    "frames use the map that has been written",
                ),
                field("pending", 1, 1, FieldKind::Status, pending),
                field("version", 16, 16, FieldKind::Status, "number of commits, modulo 2^16"),
            ],
        ),
    ]
}

/// Returns the registers of the thresholds: one for each, or two for a threshold wider than a
/// register.
pub(super) fn threshold_registers(design: &Design) -> Vec<Register> {
    let parts = thresholds(design).into_iter().flat_map(|threshold| {
        let doc = threshold.port.doc.clone();
        threshold.parts().into_iter().map(move |part| (part, doc.clone()))
    });
    let register = |(address, (part, doc)): (u32, (ThresholdPart, String))| {
        let reset = FieldKind::Threshold { reset: part.reset };
        let fields = vec![field("value", 0, part.width, reset, &doc)];
        let doc = "threshold, from the next frame on".to_owned();
        Register { name: part.name, address, fields, doc }
    };
    (THRESHOLD_BASE..).step_by(4).zip(parts).map(register).collect()
}

/// A threshold that is an input of the array.
pub(crate) struct ThresholdInput {
    pub(crate) port: Port,
    value: u64,
}

/// The part of a threshold that fits into one register.
pub(crate) struct ThresholdPart {
    pub(crate) name: String,
    pub(crate) width: u32,
    reset: u32,
}

impl ThresholdInput {
    /// Returns the registers that hold the threshold, the one with the lowest bits first.
    pub(crate) fn parts(&self) -> Vec<ThresholdPart> {
        let name = self.port.name.trim_end_matches("_i");
        let width = self.port.width;
        let low = u32::try_from(self.value & 0xFFFF_FFFF).expect("32 bits");
        if width <= REGISTER_BITS {
            return vec![ThresholdPart { name: name.to_owned(), width, reset: low }];
        }
        let high =
            u32::try_from(self.value >> REGISTER_BITS).expect("a threshold has at most 64 bits");
        vec![
            ThresholdPart { name: format!("{name}_low"), width: REGISTER_BITS, reset: low },
            ThresholdPart {
                name: format!("{name}_high"),
                width: width - REGISTER_BITS,
                reset: high,
            },
        ]
    }
}

/// Returns the thresholds that are inputs of the array.
pub(crate) fn thresholds(design: &Design) -> Vec<ThresholdInput> {
    let CoreInterface { controls, .. } = design.rcm_interface();
    let input = |port: Port| Some(ThresholdInput { value: threshold_value(design, &port)?, port });
    controls.into_iter().filter_map(input).collect()
}

pub(crate) fn fingerprint_number(design: &Design) -> u64 {
    u64::from_str_radix(&design.fingerprint(), 16).expect("a fingerprint is hexadecimal")
}

/// Returns the number by which packets and registers name the content of irrelevant regions.
pub(crate) fn irrelevant_code(design: &Design) -> u32 {
    match design.irrelevant() {
        IrrelevantRendering::Zero => 0,
        IrrelevantRendering::Hold => 1,
        IrrelevantRendering::Mean => 2,
    }
}

/// Returns 1 if raw pixels leave, else 0, as in packets and registers. Without a filter the pixels
/// are raw in either case.
pub(crate) fn raw_flag(design: &Design) -> u32 {
    match design.payload() {
        Payload::Raw => 1,
        Payload::Denoised => 0,
    }
}

pub(super) fn field(name: &str, low: u32, width: u32, kind: FieldKind, doc: &str) -> RegisterField {
    RegisterField { name: name.to_owned(), low, width, kind, doc: doc.to_owned() }
}

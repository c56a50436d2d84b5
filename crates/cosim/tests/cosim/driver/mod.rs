// SPDX-License-Identifier: MIT OR Apache-2.0
//! The C driver of a core on AXI: beside a simulated core, and over damaged streams, for processors
//! of 32 and 64 bits.

use crate::bus::axi_design;
use crate::common::in_parallel;
use foveate_camera::{RegionAction, RegionClass};
use foveate_design::Design;
use foveate_emit::{AXI_TOP, FieldKind, axi_modules, axi_registers, axi_software};
use foveate_model::{FunctionalCamera, region_pixels};
use foveate_packets::{
    EndPacket, Packet, PacketLayout, PacketSplitter, RegionDecision, RegionFlags, StreamItem,
    packet_encoding,
};
use foveate_pixels::Frame;
use foveate_tools::{
    Cache, Source, Tool, Toolchain,
    testing::{require_tools, sampling_step},
    verilator::{self, LintMode, VerilatorJob},
};
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

const CORE_SOURCE: &str = include_str!("core.cpp");
const MAIN_SOURCE: &str = include_str!("main.c");
const STREAM_SOURCE: &str = include_str!("stream.c");
/// The C compiler, which is installed together with that of C++.
const COMPILER: &str = "cc";
/// The flags with which the driver must compile without a warning.
const STRICT_FLAGS: &[&str] =
    &["-std=c99", "-Wall", "-Wextra", "-Wpedantic", "-Wconversion", "-Werror"];
/// Each design, with the thresholds that the software sets.
const DESIGNS: &[(&[&str], &[&str])] = &[
    (
        &["frame={width=68,height=37}"],
        &["spatial=[{feature='edge',level=60,min_score=3}]", "temporal={level=5,min_count=2}"],
    ),
    (
        &[
            "frame={width=64,height=40,pixel_bits=10}",
            "render={irrelevant='mean',payload='raw'}",
            "spatial=[{feature='mad',min_score=60}]",
            "hardware.pixels_per_clock=2",
        ],
        &["spatial=[{feature='mad',min_score=20}]", "temporal={level=20,min_count=3}"],
    ),
    (
        &["frame={width=64,height=48}", "render.irrelevant='mean'", "zones={off_level=30}"],
        &[
            "spatial=[{feature='edge',level=60,min_score=3}]",
            "temporal={level=5,min_count=2}",
            "zones={off_level=50,keen={temporal={level=2,min_count=1},spatial=[{feature='edge',min_score=1}]}}",
        ],
    ),
];

/// The replaced text of the driver, and its replacement.
type DriverFault = Option<(&'static str, &'static str)>;

fn with_settings(design: &Design, keys: &[&str]) -> Design {
    let config =
        foveate_design::DesignConfig::from_toml_with(&design.config().to_toml(), keys).unwrap();
    config.validate().unwrap()
}

/// Returns frames in which a block of noise moves over a still background; every third frame is
/// noise.
fn test_frames(design: &Design, count: u32) -> Vec<Frame> {
    let mut random = fastrand::Rng::with_seed(7);
    let (width, height, bits) = (design.width(), design.height(), design.pixel_bits());
    let largest = (1_u32 << bits) - 1;
    let shot = |number: u32| {
        let mut pixel = |x: u32, y: u32| {
            let is_inside = x.wrapping_sub(number * 5) < 16 && y.wrapping_sub(number * 3) < 16;
            let grey = if is_inside || number % 3 == 2 {
                random.u32(0..=largest)
            } else {
                x / 4 * 37 % (largest / 2) + y / 4
            };
            u16::try_from(grey).unwrap()
        };
        let pixels = (0..height).flat_map(|y| (0..width).map(move |x| (x, y)));
        let pixels = pixels.map(|(x, y)| pixel(x, y)).collect();
        Frame::new(width, height, bits, pixels).unwrap()
    };
    (0..count).map(shot).collect()
}

/// Returns the pixels in the file format of the C programs and of the simulated core.
fn bytes_of(frame: &Frame) -> Vec<u8> {
    frame.pixels().iter().flat_map(|pixel| pixel.to_le_bytes()).collect()
}

/// Returns the compiler flags for the processor widths: 64 bits, and, without a fault, also 32 bits
/// if the C compiler can make programs for it.
fn width_flags(fault: DriverFault) -> &'static [&'static str] {
    if fault.is_some() {
        return &["-m64"];
    }
    let dir = tempfile::tempdir().unwrap();
    let empty = dir.path().join("empty.c");
    fs::write(&empty, "int main(void) { return 0; }\n").unwrap();
    let made = Command::new(COMPILER)
        .args(["-m32", "-o"])
        .arg(dir.path().join("empty"))
        .arg(&empty)
        .output();
    if made.unwrap().status.success() { &["-m64", "-m32"] } else { &["-m64"] }
}

/// Compiles a program with the driver of a design, in which a fault may be planted. Without a fault
/// the compiler must not warn.
fn compile(
    design: &Design,
    (name, text): (&str, &str),
    fault: DriverFault,
    dir: &Path,
    flags: &[&str],
) -> PathBuf {
    for file in axi_software(design) {
        let name = Path::new(&file.path).file_name().unwrap().to_owned();
        let mut contents = file.contents;
        if let (Some((from, to)), true) = (fault, name == "foveate.c") {
            assert_eq!(contents.matches(from).count(), 1, "`{from}`");
            contents = contents.replace(from, to);
        }
        fs::write(dir.join(name), contents).unwrap();
    }
    fs::write(dir.join(name), text).unwrap();
    let program = dir.join(format!("program{}", flags[0]));
    let made = Command::new(COMPILER)
        .args(if fault.is_some() { &STRICT_FLAGS[..1] } else { STRICT_FLAGS })
        .args(flags)
        .args(["-O1", "foveate.c", name, "-o"])
        .arg(&program)
        .current_dir(dir)
        .output()
        .unwrap();
    assert!(made.status.success(), "{flags:?}: {}", String::from_utf8_lossy(&made.stderr));
    program
}

/// Builds a simulated core that answers to a processor.
fn build_simulated_core(design: &Design) -> PathBuf {
    let sources: Vec<Source> = axi_modules(design).unwrap().into_iter().map(Source::from).collect();
    let raster = design.as_raster().unwrap();
    let quiet = design.width() * design.region_size() * 3 + 1000;
    let constants = [
        ("WIDTH", design.width()),
        ("HEIGHT", design.height()),
        ("BITS", design.pixel_bits()),
        ("LANES", raster.pixels_per_clock()),
        ("QUIET", quiet),
    ];
    let text = |(name, value): &(&str, u32)| format!("#define {name} {value}\n");
    let cpp_main = constants.iter().map(text).collect::<String>() + CORE_SOURCE;
    let job = VerilatorJob {
        sources,
        top: AXI_TOP.to_owned(),
        cpp_main,
        lint: LintMode::Lenient,
        ..VerilatorJob::default()
    };
    verilator::build(&Toolchain::system(), &Cache::from_env().unwrap(), &job).unwrap()
}

/// Returns the thresholds of a design as an argument of the C compiler.
fn threshold_flag(design: &Design) -> String {
    let list = axi_registers(design.as_raster().unwrap());
    let values = list.iter().filter_map(|register| match register.fields.as_slice() {
        [field] => match field.kind {
            FieldKind::Threshold { reset } => {
                Some(format!("FOVEATE_THRESHOLD({}, {reset}u)", register.name.to_uppercase()))
            }
            _ => None,
        },
        _ => None,
    });
    format!("-DTHRESHOLDS={}", values.collect::<Vec<_>>().join(","))
}

/// Sets the classes of all regions in turn, from the class with code `first` on.
fn set_classes(model: &mut FunctionalCamera, first: usize) {
    let regions = model.classes().len();
    let code = |region: usize| u8::try_from((first + region) % 4).unwrap();
    let classes: Vec<_> =
        (0..regions).map(|region| RegionClass::from_code(code(region)).unwrap()).collect();
    model.set_classes(&classes).unwrap();
}

/// Runs software that sets up a core, lets frames come, and paints what leaves. The screen must be
/// that of the model.
fn check_screen(design: &Design, changed: &Design, fault: DriverFault) -> Result<(), String> {
    let dir = tempfile::tempdir().unwrap();
    let frames = test_frames(design, 7);
    fs::write(dir.path().join("frames"), frames.iter().flat_map(bytes_of).collect::<Vec<_>>())
        .unwrap();
    let mut model = FunctionalCamera::new(changed);
    let mut expected = Vec::new();
    for (number, frame) in frames.iter().enumerate() {
        match number {
            // The frame comes while the core is stopped.
            4 => continue,
            6 => model.reset(),
            1..=3 if design.zones().is_some() => set_classes(&mut model, number),
            _ => {}
        }
        expected.extend(bytes_of(&model.step(frame).unwrap().rendered));
    }
    let core = build_simulated_core(design);
    for width in width_flags(fault) {
        let flags = [width, &*threshold_flag(changed)];
        let program = compile(design, ("main.c", MAIN_SOURCE), fault, dir.path(), &flags);
        let screen = dir.path().join("screen");
        let mut simulation = Command::new(&core)
            .arg(dir.path().join("frames"))
            .stdin(Stdio::piped())
            .stdout(Stdio::piped())
            .spawn()
            .unwrap();
        let software = Command::new(program)
            .arg(&screen)
            .stdin(simulation.stdout.take().unwrap())
            .stdout(simulation.stdin.take().unwrap())
            .output()
            .unwrap();
        simulation.wait().unwrap();
        let said = String::from_utf8_lossy(&software.stderr);
        if !software.status.success() {
            return Err(format!("{width}: {said}"));
        }
        let shown = fs::read(&screen).unwrap();
        if shown != expected {
            let at = shown.iter().zip(&expected).position(|(one, other)| one != other);
            return Err(format!(
                "{width}: {} bytes, expected {}; they differ from {at:?} on",
                shown.len(),
                expected.len()
            ));
        }
    }
    Ok(())
}

#[test]
fn software_with_the_driver_runs_a_core_and_shows_what_the_model_shows() {
    if !require_tools(&[Tool::Verilator, Tool::Cxx]) {
        return;
    }
    let failures = in_parallel(DESIGNS, |(keys, changes)| {
        let design = axi_design(keys);
        check_screen(&design, &with_settings(&design, changes), None)
            .map_err(|error| format!("{keys:?}: {error}"))
    });
    assert!(failures.is_empty(), "{}", failures.join("\n"));
}

/// Returns the packets of some frames.
fn packets(design: &Design, layout: &PacketLayout) -> Vec<u8> {
    let mut model = FunctionalCamera::new(design);
    let mut bytes = Vec::new();
    let columns = design.columns();
    for (number, frame) in (0..).zip(test_frames(design, 4)) {
        let seen = model.step(&frame).unwrap().clone();
        packet_encoding::append_frame(
            &mut bytes,
            layout,
            number,
            (1000 * u64::from(number), number == 0),
        );
        let mut sent = 0;
        for row in 0..design.rows() {
            let at = |column: u32| (row * columns + column) as usize;
            let decisions: Vec<RegionDecision> = (0..columns)
                .map(at)
                .map(|at| RegionDecision {
                    srs: seen.srs[at],
                    trs: seen.trs[at],
                    summary: seen.actions[at] == RegionAction::Summarize,
                })
                .collect();
            packet_encoding::append_row(&mut bytes, layout, number, row, &decisions).unwrap();
            for column in 0..columns {
                let summary = decisions[column as usize].summary;
                let values = match (summary, seen.active[at(column)]) {
                    (true, _) => seen.means[at(column)].clone(),
                    (false, true) => {
                        let (payload, mut values) = (seen.payload(design), Vec::new());
                        region_pixels(design, payload, row * columns + column, &mut values);
                        values
                    }
                    (false, false) => continue,
                };
                let flags = RegionFlags { raw: layout.info().raw, summary };
                packet_encoding::append_region(
                    &mut bytes,
                    layout,
                    number,
                    (row, column),
                    (flags, &values),
                )
                .unwrap();
                sent += 1;
            }
        }
        packet_encoding::append_end(
            &mut bytes,
            number,
            EndPacket { regions_sent: sent, regions_dropped: number, rows_dropped: number / 2 },
        )
        .unwrap();
    }
    bytes
}

/// Returns the packets that the receiver of `foveate-packets` finds, in the format of `stream.c`.
fn expected_lines(layout: &PacketLayout, bytes: &[u8]) -> String {
    let mut splitter = PacketSplitter::default();
    splitter.feed(bytes);
    splitter.mark_complete();
    let (mut text, mut lost) = (String::new(), 0);
    let sum = |values: &mut dyn Iterator<Item = u32>| {
        values.fold(0_u32, |sum, value| sum.wrapping_mul(31).wrapping_add(value))
    };
    loop {
        let line = match splitter.next(Some(layout)) {
            StreamItem::Pending => break,
            StreamItem::Skipped { bytes, .. } => {
                lost += bytes;
                continue;
            }
            StreamItem::Packet { frame, packet } => match packet {
                Packet::Frame(info) => format!("1 {frame} {} 0 0 0", info.version),
                Packet::Row(row) => {
                    let codes = row.decisions.iter().map(|one| {
                        u32::from(one.srs) | u32::from(one.trs) << 1 | u32::from(one.summary) << 2
                    });
                    format!("2 {frame} {} {} 0 {}", row.row, layout.columns(), sum(&mut { codes }))
                }
                Packet::Region(region) => {
                    let values = region.values.iter().map(|&value| u32::from(value));
                    let summary = u32::from(region.flags.summary);
                    format!(
                        "4 {frame} {} {} {summary} {}",
                        region.row,
                        region.column,
                        sum(&mut { values })
                    )
                }
                Packet::End(end) => {
                    let sum = end.regions_sent + 31 * end.regions_dropped + 961 * end.rows_dropped;
                    format!("5 {frame} 0 0 0 {sum}")
                }
                Packet::Scores(_) | Packet::Register(_) | Packet::Flow(_) => {
                    panic!("a core sends none")
                }
            },
        };
        text += &line;
        text.push('\n');
    }
    text + &format!("lost {lost}\n")
}

/// Returns the CRC of the packet format, computed bit by bit.
fn crc(bytes: &[u8]) -> u32 {
    let step = |crc: u32, _| if crc & 1 == 1 { crc >> 1 ^ 0xEDB8_8320 } else { crc >> 1 };
    !bytes.iter().fold(u32::MAX, |crc, &byte| (0..8).fold(crc ^ u32::from(byte), step))
}

/// Returns the number of words of the packet that begins here, from its header.
fn packet_words(bytes: &[u8]) -> usize {
    usize::from(u16::from_le_bytes([bytes[2], bytes[3]]))
}

/// Changes a packet to one that no core of this design sends, mostly with a correct CRC. One bit
/// differs in its header or, in a FRAME, in the first word of its content.
fn forge_packet(bytes: &mut [u8], starts: &[usize], random: &mut fastrand::Rng) {
    let kind = [1, 2, 4, 5][random.usize(0..4)];
    let of_kind: Vec<usize> = starts
        .iter()
        .copied()
        .filter(|&at| bytes[at] == 0xFA && bytes[at + 1] & 15 == kind)
        .collect();
    let Some(&start) = of_kind.get(random.usize(0..of_kind.len().max(1))) else { return };
    let true_words = packet_words(&bytes[start..]);
    let looked_at = if kind == 1 { 16 } else { 8 };
    bytes[start + random.usize(0..looked_at)] ^= 1 << random.u8(0..8);
    if kind == 4 && random.bool() {
        // The region has the flag for means, but contains none.
        bytes[start + 1] |= 4 << 4;
        bytes[start + 2..start + 4].copy_from_slice(&[2, 0]);
    }
    let words = if random.bool() { true_words } else { packet_words(&bytes[start..]).max(2) };
    let end = start + 8 * words;
    if end <= bytes.len() {
        let crc = crc(&bytes[start..end - 4]);
        bytes[end - 4..end].copy_from_slice(&crc.to_le_bytes());
    }
}

/// Returns the offsets of the packets in a stream without damage.
fn packet_offsets(bytes: &[u8]) -> Vec<usize> {
    let next =
        |&at: &usize| Some(at + 8 * packet_words(&bytes[at..])).filter(|&at| at < bytes.len());
    std::iter::successors(Some(0), next).collect()
}

/// Checks that the driver finds in damaged streams of a design what the receiver finds.
fn check_damaged_streams(design: &Design, fault: DriverFault) -> Result<(), String> {
    let layout = PacketLayout::new(design, false, 100_000_000).unwrap();
    let whole = packets(design, &layout);
    let starts = packet_offsets(&whole);
    let dir = tempfile::tempdir().unwrap();
    for width in width_flags(fault) {
        // A program of 64 bits ends if it reads outside of its memory.
        let checked = ["-m64", "-fsanitize=address,undefined", "-fno-sanitize-recover"];
        let flags = if *width == "-m64" { &checked[..] } else { &[*width][..] };
        let program = compile(design, ("stream.c", STREAM_SOURCE), fault, dir.path(), flags);
        let mut random = fastrand::Rng::with_seed(11);
        for round in 0..40 {
            let mut bytes = whole.clone();
            for _ in 0..20 * (round % 2) {
                forge_packet(&mut bytes, &starts, &mut random);
            }
            for _ in 0..round / 2 {
                let at = random.usize(0..bytes.len() - 9);
                match random.u8(0..3) {
                    0 => bytes[at] ^= 1 << random.u8(0..8),
                    1 => drop(bytes.drain(at..at + random.usize(1..9))),
                    // A packet header is inserted at a random place.
                    _ => drop(bytes.splice(at..at, whole[..8].to_vec())),
                }
            }
            if round % 4 == 3 {
                bytes.truncate(bytes.len() - 30);
            }
            fs::write(dir.path().join("bytes"), &bytes).unwrap();
            let stdin = fs::File::open(dir.path().join("bytes")).unwrap();
            let output = Command::new(&program).stdin(stdin).output().unwrap();
            let (said, expected) =
                (String::from_utf8_lossy(&output.stdout), expected_lines(&layout, &bytes));
            if !output.status.success() || said != expected {
                let first = said.lines().zip(expected.lines()).find(|(one, other)| one != other);
                let log = String::from_utf8_lossy(&output.stderr);
                return Err(format!("{width} round {round}: {first:?} {log}"));
            }
        }
    }
    Ok(())
}

#[test]
fn the_driver_finds_in_damaged_streams_what_the_receiver_finds() {
    if !require_tools(&[Tool::Cxx]) {
        return;
    }
    for (keys, _) in DESIGNS {
        check_damaged_streams(&axi_design(keys), None)
            .unwrap_or_else(|error| panic!("{keys:?}: {error}"));
    }
}

/// Faults of the driver; at least one of the tests above must find each of them.
const FAULTS: &[(&str, &str)] = &[
    ("return ~crc;", "return crc;"),
    ("head[0] == MARK && u16(head + 2) == carried + 2 ?", "head[0] == MARK ?"),
    ("flags <= FIRST && (HAS_MAPS || column == 0)", "flags <= FIRST"),
    ("flags <= FIRST && (HAS_MAPS || column == 0)", "(HAS_MAPS || column == 0)"),
    ("(HAS_MAPS || column == 0)", "column == 0"),
    ("packet->map_version = u16(bytes + 6);", "packet->map_version = u16(bytes + 4);"),
    (
        "if (classes[at] > FOVEATE_ALWAYS) return",
        "if (classes[at] > FOVEATE_ALWAYS && at > regions) return",
    ),
    ("classes[at] << 2 * (at - first)", "classes[at] << 2 * (15 - (at - first))"),
    ("put(core, FOVEATE_ZONE_ADDRESS, 0);", ""),
    ("ZONE_CONTROL), ZONE_CONTROL_VERSION)", "ZONE_CONTROL), ZONE_CONTROL_PENDING)"),
    ("packet->version = u16(bytes + 4);", "packet->version = FOVEATE_FORMAT;"),
    ("row < design->rows && column == design->columns", "row < design->rows"),
    ("flags == 0 && row < design->rows", "flags == 0"),
    ("== (design->raw ? RAW : 0u)", "== 0u"),
    ("(!is_summary || design->means > 0) &&", ""),
    ("row < design->rows && column < design->columns", "column < design->columns"),
    ("row < design->rows && column < design->columns", "row < design->rows"),
    ("flags <= 1 && row <= design->rows", "row <= design->rows"),
    (
        "if (bytes[WORD + at] != MAGIC[at]) return false;",
        "if (bytes[at] == 0 && !MAGIC[at]) return false;",
    ),
    ("if (size > reader->size && !reader->ended) return false;", ""),
    ("if (may_begin && reader->size < WORD && !reader->ended) return false;", ""),
    ("++reader->lost;", "reader->lost += reader->ended;"),
    ("packet->rows = u16(bytes + 4);", "packet->rows = u16(bytes + 6);"),
    ("packet->first = (flags & FIRST) != 0;", "packet->first = true;"),
    ("return design->means > 0 ? 4 : 2;", "return design->means > 9 ? 4 : 2;"),
    ("if (left >= design->width || top", "if (top"),
    ("y / block * side + x / block", "y / block * side + x % side"),
    ("if (!packet->first) return;", ""),
    ("if (design->irrelevant != FOVEATE_ZERO) return;", ""),
    ("column) & FOVEATE_SRS) == 0", "column) & FOVEATE_TRS) == 0"),
    ("is_set ? others | mask : others", "is_set ? mask : others"),
    ("get(core, FOVEATE_CONTROL) & ~mask", "get(core, FOVEATE_CONTROL)"),
    (
        "if ((thresholds[at].value & ~thresholds[at].mask) != 0) return FOVEATE_TOO_LARGE;",
        "if (!thresholds[at].mask) return FOVEATE_TOO_LARGE;",
    ),
    (
        "if (count > 1) put(core, FOVEATE_CONTROL, before);",
        "if (count > 1) put(core, FOVEATE_CONTROL, before & 1);",
    ),
    ("return FOVEATE_OTHER_DESIGN;", "return FOVEATE_OK;"),
    ("put(core, FOVEATE_EVENTS, events);", "put(core, FOVEATE_EVENTS, ~events);"),
    (
        "put(core, FOVEATE_INTERRUPT_ENABLE, events);",
        "put(core, FOVEATE_INTERRUPT_ENABLE, ~events);",
    ),
];

/// A run plants only a part of the faults, but a change of the driver must not leave one without
/// its text.
#[test]
fn the_driver_has_the_text_of_every_planted_fault_once() {
    for (keys, _) in DESIGNS {
        let files = axi_software(&axi_design(keys));
        let driver = files.iter().find(|file| file.path.ends_with("/foveate.c")).unwrap();
        for (from, _) in FAULTS {
            assert_eq!(driver.contents.matches(from).count(), 1, "`{from}`");
        }
    }
}

#[test]
fn every_planted_fault_of_the_driver_is_caught() {
    if !require_tools(&[Tool::Verilator, Tool::Cxx]) {
        return;
    }
    let sampled: Vec<_> = FAULTS.iter().step_by(sampling_step(12)).collect();
    let missed = in_parallel(&sampled, |&&fault| {
        let is_missed = DESIGNS.iter().all(|(keys, changes)| {
            let design = axi_design(keys);
            check_damaged_streams(&design, Some(fault)).is_ok()
                && check_screen(&design, &with_settings(&design, changes), Some(fault)).is_ok()
        });
        if is_missed { Err(format!("`{}` -> `{}`", fault.0, fault.1)) } else { Ok(()) }
    });
    assert!(missed.is_empty(), "not caught:\n{}", missed.join("\n"));
}

// SPDX-License-Identifier: MIT OR Apache-2.0
//! The whole top of an array of RPUs behind a pattern: sums, registers, thresholds and captures are those of the model.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command as Process;

use crate::common::{Fault, compiled, verilog};
use foveate_boards::{Board, BoardError, Project};
use foveate_design::{Action, Camera, Config, Preset};
use foveate_emit::{Register, array_table};
use foveate_frame::Frame;
use foveate_model::{FunctionalCamera, FunctionalOutcome};
use foveate_packets::{Command, Found, Packet, Splitter};
use foveate_toolchain::Tool;
use foveate_toolchain::testing::require_tools;

const BENCH: &str = include_str!("array.cpp");
const VCU118: &str = include_str!("../../boards/vcu118.toml");
const RIGHT: &str = "4";
const WRONG: &str = "2";
/// Where the values of a capture begin.
const VALUES: u16 = 0x800;

/// An array on a VCU118, with a serial line as fast as can be.
fn array(keys: &[&str]) -> Result<Project, BoardError> {
    let toml = VCU118.replace("baud = 921_600", "baud = 31_250_000");
    let board = Board::from_toml("vcu118", &toml).unwrap();
    let paper = Preset::find("paper").unwrap().toml;
    Project::new(board, Config::from_toml_with(paper, keys).unwrap().validate().unwrap())
}

/// 4 x 3 regions of 4 x 4.
const SMALL: &[&str] = &[
    "frame={width=16,height=12}",
    "region.size=4",
    "spatial=[{feature='edge',level=20,min_score=3}]",
    "temporal={level=4,min_count=2,reference='last-sent'}",
];
/// 4 x 3 regions of 8 x 8, all features, raw pixels.
const LARGE: &[&str] = &[
    "frame={width=32,height=24}",
    "spatial=[{feature='edge',level=20,min_score=9},{feature='mad',min_score=5.5},{feature='corner',level=3,min_score=6},\
     {feature='variance',min_score=150}]",
    "decision.combine='all'",
    "temporal={level=4,min_count=2,reference='previous'}",
    "render.payload='raw'",
];
/// 5 x 2 regions of 6 x 6 that send means, with more registers.
const DEEP: &[&str] = &[
    "frame={width=30,height=12}",
    "region.size=6",
    "spatial=[{feature='variance',min_score=80},{feature='edge',level=30,min_score=6}]",
    "temporal={level=4,min_count=2,reference='last-sent'}",
    "render.irrelevant='mean'",
    "periphery={blocks=2,level=2}",
    "hardware.pipelining='deep'",
];

fn pixel(x: u32, y: u32, t: u32) -> u16 {
    let mix = (5 * x + 19 * y) & 255;
    let noise = mix ^ (mix >> 3) ^ (x & y & 255);
    let ramp = ((x + 2 * y) & 511) >> 2;
    let moved = |at: u32, by: u32| at.wrapping_sub(by.wrapping_mul(t)) & 127;
    let value = if moved(x, 3) < 16 && moved(y, 1) < 16 {
        224 | (noise & 31)
    } else if ((x >> 6) ^ (y >> 6)) & 3 == 3 {
        (ramp >> 1) + (noise & 63)
    } else {
        ramp
    };
    u16::try_from(value).unwrap()
}

fn frame(camera: &Camera, t: u32) -> Frame {
    let (width, height) = (camera.width(), camera.height());
    let places = (0..height).flat_map(|y| (0..width).map(move |x| (x, y)));
    Frame::new(width, height, 8, places.map(|(x, y)| pixel(x, y, t)).collect()).unwrap()
}

/// A board that has been built, and the registers of it.
struct Bench {
    program: PathBuf,
    table: Vec<Register>,
}

impl Bench {
    fn new(project: &Project, fault: Fault<'_>) -> Self {
        let constants = "#define DIVISOR 4\n#define LIMIT 20000000\n";
        let program = compiled(verilog(project, fault), "board", constants.to_owned() + BENCH);
        Self { program, table: array_table(project.design.pipelined().unwrap()) }
    }

    fn address(&self, name: &str) -> u16 {
        let register = self.table.iter().find(|register| register.name == name).unwrap();
        u16::try_from(register.address).unwrap()
    }

    fn read(&self, name: &str) -> Said {
        Said { until: false, command: Command::read(self.address(name)) }
    }

    fn write(&self, name: &str, value: u32) -> Said {
        Said { until: false, command: Command::write(self.address(name), value) }
    }

    /// Lights, and what was answered.
    fn play(&self, host: &[Said]) -> (String, Vec<u32>) {
        let dir = tempfile::tempdir().unwrap();
        let bytes: Vec<u8> = host.iter().flat_map(Said::bytes).collect();
        fs::write(dir.path().join("host"), bytes).unwrap();
        let run = Process::new(&self.program).arg(dir.path()).output().unwrap();
        let lights = String::from_utf8(run.stdout).unwrap();
        eprintln!("lights and clocks: {}", lights.trim());
        assert!(run.status.success(), "an answer did not come as it should; lights {lights}");
        let values = answers(&dir.path().join("heard"));
        assert_eq!(values.len(), host.len());
        (lights.split(' ').next().unwrap().to_owned(), values)
    }

    /// What a host does to see what a region said of a frame.
    fn capture(&self, (column, row): (u32, u32), frame: u32, camera: &Camera) -> Vec<Said> {
        let wait = Said { until: true, command: Command::read(self.address("capture")) };
        let mut host = vec![
            self.write("capture_region", row << 16 | column),
            self.write("capture_frame", frame),
            self.write("capture", 1),
            wait,
            self.read("captured_frame"),
            self.read("captured_decision"),
        ];
        let rest = self.table.iter().filter(|register| (0x54..0x100).contains(&register.address));
        host.extend(rest.map(|register| self.read(&register.name)));
        let words = u16::try_from(camera.region_pixels().div_ceil(4)).unwrap();
        let value = |word| Said { until: false, command: Command::read(VALUES + 4 * word) };
        host.extend((0..words).map(value));
        host
    }
}

/// A command, maybe sent until the answer says that a capture is there.
struct Said {
    until: bool,
    command: Command,
}

impl Said {
    fn bytes(&self) -> Vec<u8> {
        [vec![u8::from(self.until)], self.command.bytes().to_vec()].concat()
    }
}

fn answers(path: &Path) -> Vec<u32> {
    let mut splitter = Splitter::default();
    splitter.feed(&fs::read(path).unwrap());
    let mut values = Vec::new();
    loop {
        match splitter.next(None) {
            Found::Packet { packet: Packet::Register(answer), .. } => values.push(answer.value),
            Found::Nothing => return values,
            _ => panic!("no answer"),
        }
    }
}

/// A capture: number of the frame, decision bits, count and scores, values that left.
#[derive(Debug, PartialEq, Eq)]
struct Captured {
    frame: u32,
    decision: u32,
    scores: Vec<u64>,
    values: Vec<u16>,
}

impl Captured {
    /// From the answers to [`Bench::capture`].
    fn read(answers: &[u32], camera: &Camera) -> Self {
        let [frame, decision, rest @ ..] = &answers[4..] else { panic!("{answers:?}") };
        let mut rest = rest.iter().copied();
        let mut next = |bits: u32| {
            let low = u64::from(rest.next().unwrap());
            if bits > 32 { low | u64::from(rest.next().unwrap()) << 32 } else { low }
        };
        let widths = camera.features().iter().map(|feature| feature.score_bits());
        let widths: Vec<u32> = std::iter::once(camera.count_bits()).chain(widths).collect();
        let scores = widths.into_iter().map(&mut next).collect();
        let bytes = rest.flat_map(u32::to_le_bytes).map(u16::from);
        let count = (decision >> 16) as usize;
        Self {
            frame: *frame,
            decision: decision & 0xFFFF,
            scores,
            values: bytes.take(count).collect(),
        }
    }

    /// What the model says.
    fn of(outcome: &FunctionalOutcome, camera: &Camera, frame: u32, place: (u32, u32)) -> Self {
        let at = (place.1 * camera.columns() + place.0) as usize;
        let action = outcome.actions[at];
        let bits =
            [outcome.srs[at], outcome.trs[at], action == Action::Summarize, outcome.active[at]];
        let count = u64::from(outcome.temporal_count[at]);
        let scores = outcome.scores.iter().map(|scores| scores[at]);
        let values = match action {
            Action::Forward => region(outcome.payload(camera), camera, place),
            Action::Summarize => outcome.means[at].clone(),
            Action::Hold | Action::Blank => Vec::new(),
        };
        Self {
            frame,
            decision: (0..).zip(bits).map(|(bit, value)| u32::from(value) << bit).sum(),
            scores: std::iter::once(count).chain(scores).collect(),
            values,
        }
    }
}

/// The pixels of a region of a frame without padding.
fn region(frame: &Frame, camera: &Camera, (column, row): (u32, u32)) -> Vec<u16> {
    let side = camera.region_size();
    let places = (0..side * side).map(|at| (column * side + at % side, row * side + at / side));
    places.map(|(x, y)| frame.pixels()[(y * camera.width() + x) as usize]).collect()
}

/// What the model says of frames, each when it has come.
fn model(camera: &Camera, frames: u32, mut seen: impl FnMut(u32, &FunctionalOutcome)) {
    let mut functional = FunctionalCamera::new(camera);
    for t in 0..frames {
        seen(t, functional.step(&frame(camera, t)).unwrap());
    }
}

/// Compares captures with the model; says what is not the same.
fn differ(camera: &Camera, places: &[(u32, u32)], captures: &[Captured]) -> Vec<String> {
    let last = captures.iter().map(|captured| captured.frame).max().unwrap();
    let mut wrong = Vec::new();
    model(camera, last + 1, |t, outcome| {
        for (place, captured) in places.iter().zip(captures).filter(|(_, c)| c.frame == t) {
            let expected = Captured::of(outcome, camera, t, *place);
            if *captured != expected {
                wrong.push(format!("{place:?}: {captured:?}, not {expected:?}"));
            }
        }
    });
    wrong
}

fn captures(
    bench: &Bench,
    camera: &Camera,
    wanted: &[((u32, u32), u32)],
) -> (String, Vec<Captured>) {
    let each = wanted.iter().map(|(place, frame)| bench.capture(*place, *frame, camera));
    let host: Vec<Vec<Said>> = each.collect();
    let length = host[0].len();
    let (lights, answers) = bench.play(&host.into_iter().flatten().collect::<Vec<_>>());
    let captured = answers.chunks(length).map(|part| Captured::read(part, camera)).collect();
    (lights, captured)
}

#[test]
fn an_array_on_a_board_says_what_the_model_says() {
    if !require_tools(&[Tool::Verilator, Tool::Cxx]) {
        return;
    }
    for keys in [SMALL, LARGE, DEEP] {
        let project = array(keys).unwrap();
        let (camera, bench) = (project.design.camera(), Bench::new(&project, None));
        let (columns, rows) = (camera.columns(), camera.rows());
        // Every region, at frames with and without a square.
        let wanted: Vec<_> = (0..rows)
            .flat_map(|row| (0..columns).map(move |column| (column, row)))
            .zip([1, 3, 126, 0, 4, 127, 2, 60, 6, 125, 5, 7])
            .collect();
        let (lights, captured) = captures(&bench, camera, &wanted);
        for ((_, frame), captured) in wanted.iter().zip(&captured) {
            assert_eq!(captured.frame % 128, *frame);
        }
        let places: Vec<_> = wanted.iter().map(|wanted| wanted.0).collect();
        assert_eq!(differ(camera, &places, &captured), Vec::<String>::new(), "{keys:?}");
        assert_eq!(lights, RIGHT, "{keys:?}");
        assert!(captured.iter().any(|captured| !captured.values.is_empty()), "{keys:?}");
        assert!(captured.iter().any(|captured| captured.decision & 8 == 0), "{keys:?}");
    }
}

// SPDX-License-Identifier: MIT OR Apache-2.0
//! Tests of the whole top of an array of RPUs behind a pattern: sums, registers, thresholds and
//! captures equal the model's.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command as Process;
use std::sync::OnceLock;

use crate::common::{array_on, compile, verilog};
use foveate_boards::{Board, BoardProject};
use foveate_camera::{Camera, IrrelevantRendering, ReferencePolicy, RegionAction};
use foveate_emit::{Register, array_table};
use foveate_model::{FunctionalCamera, FunctionalOutcome};
use foveate_packets::{Packet, PacketSplitter, RegisterCommand, StreamItem};
use foveate_pixels::Frame;
use foveate_tools::{
    Source, Tool,
    testing::{require_tools, sample},
};

const BENCH: &str = include_str!("array.cpp");
const WRAPPER: &str = include_str!("array_bench.v");
const VCU118: &str = include_str!("../../boards/vcu118.toml");
const PASS_LEDS: &str = "4";
const FAIL_LEDS: &str = "2";
/// The address at which the values of a capture begin.
const VALUES_ADDRESS: u16 = 0x800;

/// Returns an array on a VCU118, with the fastest possible serial line.
fn fast_array(keys: &[&str]) -> BoardProject {
    let toml = VCU118.replace("baud = 921_600", "baud = 31_250_000");
    array_on(Board::from_toml("vcu118", &toml).unwrap(), keys).unwrap()
}

/// 4 x 3 regions of 6 x 6 pixels. Their gradients differ, so that the first pixel of a region
/// matters, too.
const SMALL: &[&str] = &[
    "frame={width=24,height=18}",
    "region.size=6",
    "spatial=[{feature='edge',level=20,min_score=3}]",
    "temporal={level=4,min_count=2,reference='last-sent'}",
];
/// 2 x 2 regions of 8 x 8 pixels, with all features and raw pixels.
const LARGE: &[&str] = &[
    "frame={width=16,height=16}",
    "spatial=[{feature='edge',level=20,min_score=9},{feature='mad',min_score=5.5},{feature='corner',level=3,min_score=6},\
     {feature='variance',min_score=150}]",
    "decision.combine='all'",
    "temporal={level=4,min_count=2,reference='last-sent'}",
    "render.payload='raw'",
];
/// 5 x 2 regions of 4 x 4 pixels that send means, with more pipeline registers.
const DEEP: &[&str] = &[
    "frame={width=20,height=8}",
    "region.size=4",
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

/// A compiled board, and its registers.
#[derive(Clone)]
struct ArrayBench {
    program: PathBuf,
    table: Vec<Register>,
    fault: Option<usize>,
}

/// A fault that can be switched on: the module, the place in it, the text at `@`, and the text that
/// replaces it.
type SwitchedFault = (&'static str, &'static str, &'static str, &'static str);

impl ArrayBench {
    /// Compiles a project with all of these faults. A fault acts only if it is switched on, so that
    /// one program serves all faults, and is compiled once.
    fn new(project: &BoardProject, faults: &[SwitchedFault]) -> Self {
        let constants = "#define DIVISOR 4\n#define LIMIT 20000000\n";
        let mut sources = verilog(project, None);
        for (number, (module, place, from, to)) in faults.iter().enumerate() {
            let path = format!("rtl/{module}.v");
            let source = sources.iter_mut().find(|(name, _)| *name == path).unwrap();
            let from_text = place.replace('@', from);
            assert_eq!(source.1.matches(&from_text).count(), 1, "`{from_text}` in {path}");
            let either = format!("($test$plusargs(\"fault{number}\") ? {to} : {from})");
            source.1 = source.1.replace(&from_text, &place.replace('@', &either));
        }
        sources.push(Source::from(("array_bench.v".to_owned(), WRAPPER.to_owned())));
        let program = compile(sources, "array_bench", constants, BENCH);
        let table = array_table(project.design.as_pipelined().unwrap());
        Self { program, table, fault: None }
    }

    /// Returns the bench with one fault switched on.
    fn with_fault(&self, fault: usize) -> Self {
        let (program, table) = (self.program.clone(), self.table.clone());
        Self { program, table, fault: Some(fault) }
    }

    fn address(&self, name: &str) -> u16 {
        let register = self.table.iter().find(|register| register.name == name).unwrap();
        u16::try_from(register.address).unwrap()
    }

    fn read(&self, name: &str) -> HostCommand {
        HostCommand { until: false, command: RegisterCommand::read(self.address(name)) }
    }

    fn write(&self, name: &str, value: u32) -> HostCommand {
        HostCommand { until: false, command: RegisterCommand::write(self.address(name), value) }
    }

    fn play(&self, host: &[HostCommand]) -> ArrayRun {
        let dir = tempfile::tempdir().unwrap();
        let bytes: Vec<u8> = host.iter().flat_map(HostCommand::bytes).collect();
        fs::write(dir.path().join("host"), bytes).unwrap();
        let run = Process::new(&self.program)
            .arg(dir.path())
            .args(self.fault.map(|fault| format!("+fault{fault}")))
            .output()
            .unwrap();
        let output = String::from_utf8(run.stdout).unwrap();
        assert!(run.status.success(), "an answer did not come as it should; lights {output}");
        let sums = fs::read(dir.path().join("sums")).unwrap();
        let (sums, rest) = sums.as_chunks();
        assert!(rest.is_empty());
        let answers = answers(&dir.path().join("heard"));
        assert_eq!(answers.len(), host.len());
        let [lights, clocks, from] = output.split_whitespace().collect::<Vec<_>>()[..] else {
            panic!("{output}")
        };
        ArrayRun {
            lights: lights.to_owned(),
            clocks: clocks.parse().unwrap(),
            from: from.parse().unwrap(),
            answers,
            sums: sums.iter().map(|sum| u32::from_le_bytes(*sum)).collect(),
        }
    }

    /// Returns the commands by which a host captures the results of a region in a frame.
    fn capture(&self, (column, row): (u32, u32), frame: u32, camera: &Camera) -> Vec<HostCommand> {
        let wait =
            HostCommand { until: true, command: RegisterCommand::read(self.address("capture")) };
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
        let value = |word| HostCommand {
            until: false,
            command: RegisterCommand::read(VALUES_ADDRESS + 4 * word),
        };
        host.extend((0..words).map(value));
        host
    }
}

/// The results of a run: the lights, the clocks until a light was on, the frame at which the last
/// write took effect, the answers, and the running sum after each frame.
struct ArrayRun {
    lights: String,
    clocks: u64,
    from: u32,
    answers: Vec<u32>,
    sums: Vec<u32>,
}

/// A command. With `until` it is sent again until the answer reports a capture.
struct HostCommand {
    until: bool,
    command: RegisterCommand,
}

impl HostCommand {
    fn bytes(&self) -> Vec<u8> {
        [vec![u8::from(self.until)], self.command.bytes().to_vec()].concat()
    }
}

fn answers(path: &Path) -> Vec<u32> {
    let mut splitter = PacketSplitter::default();
    splitter.feed(&fs::read(path).unwrap());
    let mut values = Vec::new();
    loop {
        match splitter.next(None) {
            StreamItem::Packet { packet: Packet::Register(answer), .. } => {
                values.push(answer.value);
            }
            StreamItem::Pending => return values,
            _ => panic!("no answer"),
        }
    }
}

/// The results of a region in a frame: decision bits, count and scores, and the values that leave.
#[derive(Debug, Clone, PartialEq, Eq)]
struct RegionResult {
    frame: u32,
    decision: u32,
    scores: Vec<u64>,
    values: Vec<u16>,
}

impl RegionResult {
    /// Reads the results from the answers to [`Bench::capture`].
    fn from_answers(answers: &[u32], camera: &Camera) -> Self {
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

    /// Returns the model's results.
    fn from_outcome(
        outcome: &FunctionalOutcome,
        camera: &Camera,
        frame: u32,
        place: (u32, u32),
    ) -> Self {
        let at = (place.1 * camera.columns() + place.0) as usize;
        let action = outcome.actions[at];
        let bits = [
            outcome.srs[at],
            outcome.trs[at],
            action == RegionAction::Summarize,
            outcome.active[at],
        ];
        let count = u64::from(outcome.temporal_count[at]);
        let scores = outcome.scores.iter().map(|scores| scores[at]);
        let values = match action {
            RegionAction::Forward => region(outcome.payload(camera), camera, place),
            RegionAction::Summarize => outcome.means[at].clone(),
            RegionAction::Hold | RegionAction::Blank => Vec::new(),
        };
        Self {
            frame,
            decision: (0..).zip(bits).map(|(bit, value)| u32::from(value) << bit).sum(),
            scores: std::iter::once(count).chain(scores).collect(),
            values,
        }
    }
}

/// Returns the pixels of a region of a frame without padding.
fn region(frame: &Frame, camera: &Camera, (column, row): (u32, u32)) -> Vec<u16> {
    let side = camera.region_size();
    let places = (0..side * side).map(|at| (column * side + at % side, row * side + at / side));
    places.map(|(x, y)| frame.pixels()[(y * camera.width() + x) as usize]).collect()
}

impl RegionResult {
    /// Returns the CRC of the results, as the page defines it.
    fn crc(&self, region: u32, camera: &Camera) -> u32 {
        let widths = camera.features().iter().map(|feature| feature.score_bits());
        let widths = std::iter::once(camera.count_bits()).chain(widths);
        let mut bytes = region.to_le_bytes().to_vec();
        bytes.push(u8::try_from(self.decision).unwrap());
        for (score, bits) in self.scores.iter().zip(widths) {
            bytes.extend(&score.to_le_bytes()[..bits.div_ceil(8) as usize]);
        }
        bytes.extend(self.values.iter().map(|value| u8::try_from(*value).unwrap()));
        crc32fast::hash(&bytes)
    }
}

fn places(camera: &Camera) -> Vec<(u32, u32)> {
    let columns = camera.columns();
    (0..camera.regions()).map(|region| (region % columns, region / columns)).collect()
}

/// Returns the model's results of all regions in each of the first `frames` frames.
fn model_results(camera: &Camera, frames: u32) -> Vec<Vec<RegionResult>> {
    let mut functional = FunctionalCamera::new(camera);
    let places = places(camera);
    let all = |t| {
        let outcome = functional.step(&frame(camera, t)).unwrap();
        places.iter().map(|place| RegionResult::from_outcome(outcome, camera, t, *place)).collect()
    };
    (0..frames).map(all).collect()
}

/// Returns the model's results if the second camera replaces the first from frame `at` on. The
/// temporal reference goes on as the contract defines it. The cameras must have no summaries.
fn model_with_change(cameras: [&Camera; 2], at: u32, frames: u32) -> Vec<Vec<RegionResult>> {
    let mut functional = cameras.map(FunctionalCamera::new);
    let places = places(cameras[0]);
    let mut references: Vec<Option<Vec<u16>>> = vec![None; places.len()];
    let mut all = |t: u32| {
        let active_camera = usize::from(t >= at);
        let camera = cameras[active_camera];
        let input = frame(camera, t);
        let [old, new] = &mut functional;
        let outcomes = [old.step(&input).unwrap(), new.step(&input).unwrap()];
        let one = |(place, reference): (&(u32, u32), &mut Option<Vec<u16>>)| {
            let mut result = RegionResult::from_outcome(outcomes[active_camera], camera, t, *place);
            let denoised = region(&outcomes[active_camera].denoised, camera, *place);
            let level = camera.temporal().level;
            let differs = |(a, b): (&u16, &u16)| u32::from(a.abs_diff(*b)) > level;
            let count = match reference {
                None => denoised.len(),
                Some(reference) => {
                    denoised.iter().zip(&*reference).filter(|pair| differs(*pair)).count()
                }
            };
            result.scores[0] = count as u64;
            let trs = count as u64 >= u64::from(camera.temporal().min_count);
            let srs = result.decision & 1 == 1;
            let active = srs && trs;
            result.decision = u32::from(srs) | u32::from(trs) << 1 | u32::from(active) << 3;
            result.values.clear();
            if active {
                result.values = region(outcomes[active_camera].payload(camera), camera, *place);
            }
            match camera.temporal().reference {
                ReferencePolicy::Previous => *reference = Some(denoised),
                ReferencePolicy::LastSent if active => *reference = Some(denoised),
                ReferencePolicy::LastSent
                    if !srs && camera.irrelevant() == IrrelevantRendering::Zero =>
                {
                    *reference = None;
                }
                ReferencePolicy::LastSent => {}
            }
            result
        };
        places.iter().zip(&mut references).map(one).collect()
    };
    (0..frames).map(&mut all).collect()
}

/// Returns the running sum after each frame.
fn frame_sums(camera: &Camera, frames: &[Vec<RegionResult>]) -> Vec<u32> {
    let mut sum = 0_u32;
    let each = frames.iter().map(|regions| {
        for (region, result) in (0..).zip(regions) {
            sum = sum.wrapping_add(result.crc(region, camera));
        }
        sum
    });
    each.collect()
}

/// Makes a host capture these regions of these frames.
fn captures(
    bench: &ArrayBench,
    camera: &Camera,
    wanted: &[((u32, u32), u32)],
) -> (ArrayRun, Vec<RegionResult>) {
    let each = wanted.iter().map(|(place, frame)| bench.capture(*place, *frame, camera));
    let host: Vec<Vec<HostCommand>> = each.collect();
    let length = host[0].len();
    let run = bench.play(&host.into_iter().flatten().collect::<Vec<_>>());
    let captured =
        run.answers.chunks(length).map(|part| RegionResult::from_answers(part, camera)).collect();
    (run, captured)
}

#[test]
fn results_of_an_array_on_a_board_are_those_of_the_model() {
    if !require_tools(&[Tool::Verilator, Tool::Cxx]) {
        return;
    }
    let arrays = [(SMALL, SMALL_THRESHOLDS), (LARGE, LARGE_THRESHOLDS), (DEEP, &[])];
    for (keys, thresholds) in sample(arrays, 3) {
        let project = fast_array(keys);
        let camera = project.design.camera();
        let bench =
            if keys == SMALL { small_bench().clone() } else { ArrayBench::new(&project, &[]) };
        // The captured frames have a square and none. Small regions have many more frames in the
        // same time.
        let (right, low) = (camera.columns() - 1, camera.rows() - 1);
        let mut wanted = vec![((0, 0), 1), ((right, low), 60)];
        if camera.region_size() > 4 {
            wanted.push(((right, 0), 5));
        }
        let (run, captured) = captures(&bench, camera, &wanted);
        assert_eq!(run.lights, PASS_LEDS, "{keys:?}");
        let frames = u32::try_from(run.sums.len()).unwrap() + 1;
        let model = model_results(camera, frames);
        let expected = frame_sums(camera, &model);
        let first = run.sums.iter().zip(&expected).position(|(sum, expected)| sum != expected);
        assert_eq!(first, None, "the frame whose sum is wrong; {keys:?}");
        for (((column, row), frame), captured) in wanted.iter().zip(&captured) {
            assert_eq!(captured.frame % 128, *frame);
            let region = (row * camera.columns() + column) as usize;
            assert_eq!(*captured, model[captured.frame as usize][region], "{keys:?}");
        }
        assert!(captured.iter().any(|captured| !captured.values.is_empty()), "{keys:?}");
        assert!(captured.iter().any(|captured| captured.decision & 8 == 0), "{keys:?}");
        for threshold in thresholds {
            assert_eq!(write_fault(&bench, keys, *threshold), None, "{keys:?}");
        }
    }
}

/// Makes a host write a threshold. Every frame must be computed either with all old thresholds or
/// with all new ones. Returns a description of the first frame that is not.
fn write_fault(
    bench: &ArrayBench,
    keys: &[&str],
    (name, value, key): (&str, u32, &str),
) -> Option<String> {
    let (project, other) = (fast_array(keys), fast_array(&[keys, &[key]].concat()));
    let cameras = [project.design.camera(), other.design.camera()];
    // Reads of another register let time pass.
    let mut host = vec![bench.read("frames"), bench.write(name, value), bench.read(name)];
    host.extend((0..4).map(|_| bench.read("frames")));
    let run = bench.play(&host);
    assert_eq!(run.lights, PASS_LEDS);
    assert_eq!(run.answers[2], value);
    let frames = u32::try_from(run.sums.len()).unwrap();
    let first_difference = |at: u32| {
        let expected = frame_sums(cameras[0], &model_with_change(cameras, at, frames));
        run.sums.iter().zip(&expected).position(|(sum, expected)| sum != expected)
    };
    assert!(run.from > run.answers[0], "{name}: frame {}", run.from);
    assert!(first_difference(frames).is_some(), "{name} changes nothing");
    let wrong_frame = first_difference(run.from);
    wrong_frame.map(|frame| format!("{name}: frame {frame} is wrong; taken over at {}", run.from))
}

const LEVEL: (&str, u32, &str) =
    ("edge_level", 0, "spatial=[{feature='edge',level=0,min_score=3}]");
const MINIMUM: (&str, u32, &str) =
    ("edge_min", 0, "spatial=[{feature='edge',level=20,min_score=0}]");

/// Thresholds that a host writes, and the same values as keys.
const SMALL_THRESHOLDS: &[(&str, u32, &str)] = &[
    LEVEL,
    MINIMUM,
    ("temporal_level", 0, "temporal.level=0"),
    ("temporal_min", 9, "temporal.min_count=9"),
];
const LARGE_THRESHOLDS: &[(&str, u32, &str)] = &[
    (
        "corner_level",
        0,
        "spatial=[{feature='edge',level=20,min_score=9},{feature='mad',min_score=5.5},\
         {feature='corner',level=0,min_score=6},{feature='variance',min_score=150}]",
    ),
    ("temporal_level", 0, "temporal.level=0"),
    (
        "corner_min",
        0,
        "spatial=[{feature='edge',level=20,min_score=9},{feature='mad',min_score=5.5},\
         {feature='corner',level=3,min_score=0},{feature='variance',min_score=150}]",
    ),
];

/// Faults that light the wrong LED.
const SIGNATURE_FAULTS: &[SwitchedFault] = &[
    // Two regions get each other's pixels, and each sends those of its neighbor.
    ("board", ".pixel_i(@),", "pixel", "{pixel[REGIONS*8-1:16], pixel[7:0], pixel[15:8]}"),
    (
        "board",
        "forward_pixel_q <= @;",
        "forward_pixel",
        "{forward_pixel[REGIONS*8-9:0], forward_pixel[REGIONS*8-1-:8]}",
    ),
    ("array_pattern", "frame_ends ? @ : start_q;", "start_q - 7'd3", "start_q - 7'd2"),
    ("array_signature", "left_q <= @;", "COLUMNS[LEFT_BITS-1:0]", "COLUMNS[LEFT_BITS-1:0] - 1'b1"),
];
/// Faults that a capture shows.
const CAPTURE_FAULTS: &[SwitchedFault] = &[
    ("array_snapshot", "waits_q && @;", "next_q[6:0] == frame_i", "next_q[5:0] == frame_i[5:0]"),
    ("array_registers", "place_o = @;", "asked[8:0]", "~asked[8:0]"),
];
/// Faults that make a threshold change at a wrong clock.
const TURN_FAULTS: &[SwitchedFault] = &[
    ("board", "if (@ || rst) edge_level_q", "level_turn", "minimum_turn"),
    (
        "array_turn",
        "level_o = busy_q && @;",
        "count_q == LEVEL_AT[COUNT_BITS-1:0]",
        "count_q + 1'b1 == LEVEL_AT[COUNT_BITS-1:0]",
    ),
    ("board", "if (@ || rst) edge_min_q", "minimum_turn", "temporal_turn"),
];

/// Returns the array of 4 x 3 regions with all of these faults, which can be switched on. The tests
/// share its program.
fn small_bench() -> &'static ArrayBench {
    static BENCH: OnceLock<ArrayBench> = OnceLock::new();
    BENCH.get_or_init(|| {
        ArrayBench::new(
            &fast_array(SMALL),
            &[SIGNATURE_FAULTS, CAPTURE_FAULTS, TURN_FAULTS].concat(),
        )
    })
}

#[test]
fn a_fault_in_an_array_is_found() {
    if !require_tools(&[Tool::Verilator, Tool::Cxx]) {
        return;
    }
    let project = fast_array(SMALL);
    let camera = project.design.camera();
    let bench = small_bench();
    for (number, fault) in SIGNATURE_FAULTS.iter().enumerate() {
        assert_eq!(bench.with_fault(number).play(&[]).lights, FAIL_LEDS, "{fault:?}");
    }
    for (number, fault) in (SIGNATURE_FAULTS.len()..).zip(CAPTURE_FAULTS) {
        let wanted = [((1, 0), 67), ((0, 0), 1)];
        let (run, captured) = captures(&bench.with_fault(number), camera, &wanted);
        assert_eq!(run.lights, PASS_LEDS);
        let model = model_results(camera, u32::try_from(run.sums.len()).unwrap() + 1);
        let is_right =
            |(captured_result, ((column, _), frame)): (&RegionResult, ((u32, u32), u32))| {
                captured_result.frame % 128 == frame
                    && *captured_result == model[captured_result.frame as usize][column as usize]
            };
        assert!(!captured.iter().zip(wanted).all(is_right), "{fault:?}");
    }
    let first_turn_fault = SIGNATURE_FAULTS.len() + CAPTURE_FAULTS.len();
    for (number, threshold) in (first_turn_fault..).zip([LEVEL, LEVEL, MINIMUM]) {
        let fault_found = write_fault(&bench.with_fault(number), SMALL, threshold);
        assert!(fault_found.is_some(), "{:?}", TURN_FAULTS[number - first_turn_fault]);
    }
}

/// This is the whole array of the paper at the rate of the board. It is run by hand, because a
/// compiler takes minutes for its 784 RPUs.
#[test]
#[ignore = "takes minutes and gigabytes"]
fn results_of_the_array_of_the_paper_are_those_of_the_model() {
    let project = fast_array(&[]);
    let (camera, bench) = (project.design.camera(), ArrayBench::new(&project, &[]));
    let wanted = [((0, 0), 1), ((27, 27), 60), ((13, 5), 9)];
    let (run, captured) = captures(&bench, camera, &wanted);
    assert_eq!(run.lights, PASS_LEDS);
    let model = model_results(camera, u32::try_from(run.sums.len()).unwrap() + 1);
    assert_eq!(run.sums[..], frame_sums(camera, &model)[..run.sums.len()]);
    for (((column, row), _), captured) in wanted.iter().zip(&captured) {
        assert_eq!(*captured, model[captured.frame as usize][(row * 28 + column) as usize]);
    }
    println!("{} clocks until the light, {} frames in all", run.clocks, run.sums.len());
}

// SPDX-License-Identifier: MIT OR Apache-2.0
//! All organizations and the functional model compute the same integers from the same frames. Each
//! RTL is simulated against vectors of its own model, and scores, decisions and pixels are read
//! from these vectors.

use crate::common;
use crate::common::serial::serial_config;
use crate::common::vectors::{clock_records, port_value};
use crate::common::{feature, feature_sets, in_parallel, in_turn};
use foveate_camera::{
    Decimal, DenoiseFilter, FeatureKind, IrrelevantRendering, Neighborhood, Payload,
    ReferencePolicy, RegionAction,
};
use foveate_cosim::{CosimJob, CosimLevel, Recording, Simulator, Stimulus};
use foveate_design::{
    Design, DesignConfig, FrameStoreKind, Organization, OrganizationConfig, Pipelining, PixelFeed,
    PortRole, SerialConfig,
};
use foveate_model::{FunctionalCamera, region_pixels};
use foveate_pixels::{Frame, Scene, SceneParameters};
use foveate_tools::{
    Cache, Toolchain,
    testing::{require_tools, sample},
};

/// The result of one region in one frame.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
struct RegionResult {
    count: u64,
    scores: Vec<u64>,
    /// dx and dy, if the design has `flow`.
    displacement: Option<[i64; 2]>,
    srs: bool,
    trs: bool,
    /// True if its summary is sent.
    summary: bool,
    /// The words that leave: the pixels of an active region, or the means of a region whose summary
    /// is sent.
    sent: Vec<u64>,
}

/// The pixel of a block whose position a mean has.
#[derive(Clone, Copy, PartialEq)]
enum BlockPixel {
    First,
    Last,
}

impl RegionResult {
    /// Returns the number of values that leave: pixels and means.
    fn sent_values(&self, design: &Design) -> usize {
        let pixels = if self.srs && self.trs { design.region_pixels() } else { 0 };
        let means = if self.summary { design.periphery().unwrap().mean_count() } else { 0 };
        (pixels + means) as usize
    }

    /// Returns the position in the region of the next word.
    fn next_position(&self, design: &Design, of_block: BlockPixel) -> u64 {
        let number = self.sent.len() as u64;
        let Some(periphery) = design.periphery().filter(|_| self.summary) else { return number };
        let side = u64::from(design.region_size());
        let (blocks, block) = (u64::from(periphery.blocks), u64::from(periphery.block_side));
        let inside = if of_block == BlockPixel::Last { block - 1 } else { 0 };
        (number / blocks * block + inside) * side + number % blocks * block + inside
    }
}

type FrameResults = Vec<Vec<RegionResult>>;

fn functional_results(design: &Design, frames: &[Frame]) -> FrameResults {
    let mut camera = FunctionalCamera::new(design);
    let mut results = Vec::new();
    for frame in frames {
        let outcome = camera.step(frame).unwrap();
        let result = |region: u32| {
            let at = region as usize;
            let mut sent = Vec::new();
            if outcome.active[at] {
                region_pixels(design, outcome.payload(design), region, &mut sent);
            }
            let summary = outcome.actions[at] == RegionAction::Summarize;
            if summary {
                sent.clone_from(&outcome.means[at]);
            }
            RegionResult {
                count: outcome.temporal_count[at].into(),
                scores: outcome.scores.iter().map(|scores| scores[at]).collect(),
                displacement: outcome.displacements.get(at).map(|d| [d.dx, d.dy].map(i64::from)),
                srs: outcome.srs[at],
                trs: outcome.trs[at],
                summary,
                sent: sent.into_iter().map(u64::from).collect(),
            }
        };
        results.push((0..design.regions()).map(result).collect());
    }
    results
}

fn pipelined_results(design: &Design, recording: &Recording, frames: usize) -> FrameResults {
    let regions = design.regions() as usize;
    let outputs = recording.outputs();
    let field = |role| common::vectors::field_of_role(outputs, role);
    let has_summaries = design.periphery().is_some();
    let mut results: FrameResults = Vec::new();
    let mut forwarded = vec![Vec::new(); regions];
    for (_, output) in clock_records(recording) {
        let says = |role, lane| field(role).get(&output, lane);
        if says(PortRole::DecisionValid, 0) == 1 {
            let result = |lane| RegionResult {
                count: says(PortRole::TemporalCount, lane),
                scores: design
                    .features()
                    .iter()
                    .map(|f| says(PortRole::Score(f.kind()), lane))
                    .collect(),
                displacement: None,
                srs: says(PortRole::Srs, lane) == 1,
                trs: says(PortRole::Trs, lane) == 1,
                summary: has_summaries && says(PortRole::Summary, lane) == 1,
                sent: Vec::new(),
            };
            results.push((0..design.regions()).map(result).collect());
        }
        for (lane, words) in (0..).zip(&mut forwarded) {
            if says(PortRole::ForwardValid, lane) == 1 {
                words.push(says(PortRole::ForwardPixel, lane));
            }
        }
    }
    // The frames that follow the caller's frames let the last of them leave.
    results.truncate(frames);
    for results in &mut results {
        for (result, forwarded) in results.iter_mut().zip(&mut forwarded) {
            result.sent = forwarded.drain(..result.sent_values(design)).collect();
        }
    }
    results
}

fn serial_results(design: &Design, recording: &Recording) -> FrameResults {
    let (regions, outputs) = (design.regions() as usize, recording.outputs());
    let field = |role| common::vectors::field_of_role(outputs, role);
    let mut results: FrameResults = Vec::new();
    // A frame begins with the temporal count of region 0.
    for (_, output) in clock_records(recording) {
        let says = |role| port_value(outputs, role, &output);
        if says(PortRole::ScoreValid) == 1 {
            let (region, index) = (says(PortRole::Region), says(PortRole::ScoreIndex));
            if (region, index) == (0, 0) {
                results.push(vec![RegionResult::default(); regions]);
            }
            let result = &mut results.last_mut().unwrap()[usize::try_from(region).unwrap()];
            match index {
                0 => result.count = says(PortRole::AnyScore),
                _ => result.scores.push(says(PortRole::AnyScore)),
            }
            let feature = index.checked_sub(1).map(|at| usize::try_from(at).unwrap());
            let feature = feature.map(|at| &design.features()[at]);
            if let Some(radius) = feature.and_then(|feature| feature.radius()) {
                // Two's complement of 2 or 3 bits.
                let sign = if radius > 1 { 4 } else { 2 };
                let ports = [PortRole::DisplacementX, PortRole::DisplacementY];
                let signed = |role| {
                    let value = i64::try_from(says(role)).unwrap();
                    if value < sign { value } else { value - 2 * sign }
                };
                result.displacement = Some(ports.map(signed));
            }
            if says(PortRole::DecisionValid) == 1 {
                let is = [PortRole::Srs, PortRole::Trs, PortRole::Summary].map(|r| says(r) == 1);
                [result.srs, result.trs, result.summary] = is;
            }
        }
        let valid = field(PortRole::ForwardValid);
        for lane in (0..valid.port.lanes).filter(|&lane| valid.get(&output, lane) == 1) {
            let region = match design.as_serial().unwrap().feed() {
                PixelFeed::Raster => says(PortRole::ForwardRegion),
                PixelFeed::Parallel => {
                    u64::from(lane * design.slots()) + says(PortRole::ForwardSlot)
                }
            };
            let word = field(PortRole::ForwardPixel).get(&output, lane);
            let result = &mut results.last_mut().unwrap()[usize::try_from(region).unwrap()];
            assert_eq!(
                result.next_position(design, BlockPixel::Last),
                says(PortRole::ForwardPosition)
            );
            result.sent.push(word);
        }
    }
    results
}

fn raster_results(design: &Design, recording: &Recording) -> FrameResults {
    let (regions, outputs) = (design.regions() as usize, recording.outputs());
    let word = design.as_raster().unwrap().pixels_per_clock() as usize;
    let mut results: FrameResults = Vec::new();
    let mut decided = vec![0; regions];
    for (_, output) in clock_records(recording) {
        let says = |role| port_value(outputs, role, &output);
        let number = |role| usize::try_from(says(role)).unwrap();
        if says(PortRole::DecisionValid) == 1 {
            let region = number(PortRole::Region);
            if decided[region] == results.len() {
                results.push(vec![RegionResult::default(); regions]);
            }
            let score = |f: &foveate_camera::SpatialFeature| says(PortRole::Score(f.kind()));
            results[decided[region]][region] = RegionResult {
                count: says(PortRole::TemporalCount),
                scores: design.features().iter().map(score).collect(),
                displacement: None,
                srs: says(PortRole::Srs) == 1,
                trs: says(PortRole::Trs) == 1,
                summary: says(PortRole::Summary) == 1,
                sent: Vec::new(),
            };
            decided[region] += 1;
        }
        if says(PortRole::ForwardValid) == 1 {
            let region = number(PortRole::ForwardRegion);
            let result = &mut results[decided[region] - 1][region];
            assert_eq!(
                result.next_position(design, BlockPixel::First),
                says(PortRole::ForwardPosition)
            );
            let is_first = result.sent.is_empty();
            let words = common::vectors::field_of_role(outputs, PortRole::ForwardPixel);
            let words: Vec<u64> = words.lane_pixels(&output, word).collect();
            if says(PortRole::ForwardSummary) == 1 {
                assert_eq!(words, vec![words[0]; word], "a mean is on all pixels of a word");
                result.sent.push(words[0]);
            } else {
                result.sent.extend(words);
            }
            let is_last = result.sent.len() == result.sent_values(design);
            let ends = [PortRole::ForwardFirst, PortRole::ForwardLast, PortRole::ForwardAbort];
            assert_eq!(ends.map(|role| says(role) == 1), [is_first, is_last, false]);
            assert_eq!(number(PortRole::ForwardFrame), decided[region] - 1);
        }
        assert_eq!(says(PortRole::Lost), 0);
    }
    results
}

/// Simulates the RTL of the pipelined and serial organizations on the frames, and compares both
/// results with the functional model.
fn compare_organizations(
    config: &DesignConfig,
    frames: &[Frame],
    what: &str,
) -> Result<(), String> {
    let serial = |feed, fold| {
        OrganizationConfig::Serial(SerialConfig { feed: Some(feed), fold, memory: None })
    };
    let design = |organization| {
        let mut config = config.clone();
        config.hardware.organization = organization;
        (config.camera.frame.width, config.camera.frame.height) =
            (Some(frames[0].width()), Some(frames[0].height()));
        config.validate().unwrap()
    };
    let expected = functional_results(&design(serial(PixelFeed::Parallel, 1)), frames);
    let (toolchain, cache) = (Toolchain::system(), Cache::from_env().unwrap());
    let kinds: Vec<_> = config.camera.spatial.iter().map(|entry| entry.feature).collect();
    let supports = |organization: &OrganizationConfig| {
        let supported = organization.kind().feature_kinds();
        kinds.iter().all(|kind| supported.contains(kind))
    };
    let organizations = [
        OrganizationConfig::Pipelined,
        serial(PixelFeed::Parallel, 1),
        serial(PixelFeed::Raster, 2),
    ];
    for organization in organizations.into_iter().filter(supports) {
        let design = design(organization);
        let hardware = design.config().hardware.description();
        let level = CosimLevel::Rcm { columns: design.columns(), rows: design.rows() };
        let frames = frames.to_vec();
        let stimulus = Stimulus { level, seed: 1, rounds: 0, frames, sufficient_clocks: None };
        let output = tempfile::tempdir().unwrap();
        let folder = output.path().join("replay");
        let recording = stimulus.record(&design, &mut |_, _| {}).unwrap();
        let mut job = CosimJob::new(&design, stimulus.clone(), &folder).unwrap();
        job.simulator = Simulator::Iverilog;
        let report = job.run_on(&recording, &toolchain, &cache, &mut |_| {});
        let report = report.map_err(|error| format!("{what}: {error}"))?;
        if !report.passed() {
            return Err(format!("{what}, {hardware}: {report}"));
        }
        let got = match design.organization() {
            Organization::Pipelined => {
                pipelined_results(&design, &recording, stimulus.frames.len())
            }
            Organization::Serial => serial_results(&design, &recording),
            Organization::Raster => raster_results(&design, &recording),
        };
        if got != expected {
            return Err(format!("{what}: {hardware} is not what the contract says"));
        }
    }
    Ok(())
}

/// Returns hard cases, each over the whole frame, with repetitions and small changes between them.
fn hard_cases(width: u32, height: u32, bits: u32) -> Vec<Frame> {
    let max = u16::try_from((1u32 << bits) - 1).unwrap();
    let noise = |x: u32, y: u32, seed: u32| {
        let mixed = (x + 131 * y + 7919 * seed).wrapping_mul(0x9e37_79b9);
        u16::try_from((mixed ^ (mixed >> 15)) >> 8 & u32::from(max)).unwrap()
    };
    let pictures: [&dyn Fn(u32, u32) -> u16; 12] = [
        &|x, y| noise(x, y, 1),
        &|x, y| noise(x, y, 1),
        // The picture moves to the left and up, and then to the right.
        &|x, y| noise(x + 1, y + 1, 1),
        &|x, y| noise(x, y + 1, 1),
        &|_, _| 0,
        &|x, y| noise(x, y, 1),
        &|_, _| max,
        &|x, y| if (x + y) % 2 == 0 { max } else { 0 },
        &|x, y| if x % 4 == 0 && y % 4 == 0 { max } else { max / 2 },
        &|x, _| u16::try_from(x * u32::from(max) / width).unwrap(),
        &|x, y| noise(x, y, 2) / 16 + u16::from(x > y),
        &|x, y| if noise(x, y, 3) % 2 == 0 { 0 } else { max },
    ];
    let frame = |picture: &&dyn Fn(u32, u32) -> u16| Frame::from_fn(width, height, bits, picture);
    pictures.iter().map(|picture| frame(picture).unwrap()).collect()
}

fn configs() -> Vec<DesignConfig> {
    let mut configs = Vec::new();
    for (turn, kinds) in feature_sets(Organization::Serial).into_iter().enumerate() {
        let features: Vec<_> = kinds.iter().map(|&kind| feature(kind, 2)).collect();
        let mut config = serial_config(&features);
        config.camera.region.size = [4, 5][turn % 2];
        for spatial in &mut config.camera.spatial {
            spatial.min_score = Some(Decimal::from_whole(3));
        }
        config.camera.temporal.min_count = 3;
        config.camera.denoise.filter = in_turn(DenoiseFilter::ALL, turn / 2);
        config.camera.region.neighborhood = in_turn(Neighborhood::ALL, turn + 1);
        config.camera.temporal.reference = in_turn(ReferencePolicy::ALL, turn.div_ceil(2));
        config.camera.render.irrelevant = in_turn(IrrelevantRendering::ALL, turn + 1);
        config.camera.render.payload = in_turn(Payload::ALL, turn);
        configs.push(config);
    }
    configs
}

#[test]
fn hard_cases_give_the_same_in_both_organizations() {
    if !require_tools(Simulator::Iverilog.tools()) {
        return;
    }
    let failures = in_parallel(&sample(configs(), 4), |config| {
        let side = config.camera.region.size;
        let frames = hard_cases(3 * side - 1, 2 * side, config.camera.frame.pixel_bits);
        compare_organizations(config, &frames, &format!("{:?}", config.camera.spatial))
    });
    assert!(failures.is_empty(), "{}", failures.join("\n"));
}

/// Returns the configurations with features that raster cores have.
fn raster_configs() -> Vec<DesignConfig> {
    let supported = Organization::Raster.feature_kinds();
    let is_supported = |config: &DesignConfig| {
        config.camera.spatial.iter().all(|entry| supported.contains(&entry.feature))
    };
    configs().into_iter().filter(is_supported).collect()
}

/// The vectors of a raster core have the results of the functional model.
#[test]
fn the_vectors_of_a_raster_core_have_the_functional_results() {
    for (turn, mut config) in raster_configs().into_iter().enumerate() {
        let side = config.camera.region.size;
        let wide = if side.is_multiple_of(2) && turn > 1 { 2 } else { 1 };
        let (width, height) = (wide * 5 * side - 1, 4 * side - 2);
        let frames = hard_cases(width, height, config.camera.frame.pixel_bits);
        (config.camera.frame.width, config.camera.frame.height) = (Some(width), Some(height));
        config.hardware.make_raster().pixels_per_clock = Some(wide);
        let design = config.validate().unwrap();
        let stimulus = Stimulus {
            level: CosimLevel::Full,
            seed: 1,
            rounds: 0,
            frames: frames.clone(),
            sufficient_clocks: None,
        };
        let recording = stimulus.record(&design, &mut |_, _| {}).unwrap();
        assert!(
            raster_results(&design, &recording) == functional_results(&design, &frames),
            "{config:?}"
        );
    }
}

/// The vectors of raster cores with a single-port or external frame store, and of cores without
/// forwarding, have the results of the functional model.
#[test]
fn the_vectors_of_a_raster_core_have_the_functional_results_with_every_store() {
    for (turn, mut config) in raster_configs().into_iter().enumerate() {
        let side = config.camera.region.size;
        let frames = hard_cases(5 * side - 1, 4 * side - 2, config.camera.frame.pixel_bits);
        (config.camera.frame.width, config.camera.frame.height) =
            (Some(5 * side - 1), Some(4 * side - 2));
        config.camera.temporal.reference = ReferencePolicy::Previous;
        config.hardware.organization = Organization::Raster.into();
        config.hardware.pipelining = in_turn(Pipelining::ALL, turn);
        // Summaries need forwarding.
        let may_keep = config.camera.render.irrelevant != IrrelevantRendering::Mean;
        let stores = [
            (FrameStoreKind::SinglePort, true),
            (FrameStoreKind::External, true),
            (FrameStoreKind::External, false),
        ];
        for (store, forward) in stores.into_iter().filter(|&(_, forward)| forward || may_keep) {
            config.hardware.make_raster().store = Some(store);
            config.hardware.make_raster().forward = Some(forward);
            let design = config.validate().unwrap();
            let stimulus = Stimulus {
                level: CosimLevel::Full,
                seed: 1,
                rounds: 0,
                frames: frames.clone(),
                sufficient_clocks: None,
            };
            let recording = stimulus.record(&design, &mut |_, _| {}).unwrap();
            let mut expected = functional_results(&design, &frames);
            if !forward {
                expected.iter_mut().flatten().for_each(|result| result.sent.clear());
            }
            assert!(raster_results(&design, &recording) == expected, "{config:?}");
        }
    }
}

#[test]
fn a_street_gives_the_same_in_both_organizations() {
    if !require_tools(Simulator::Iverilog.tools()) {
        return;
    }
    let size = SceneParameters { width: 20, height: 16, bits: 8, region_size: 8, frames: 4 };
    let frames: Vec<Frame> = Scene::find("street").unwrap().frames(size).collect();
    let config = serial_config(&[feature(FeatureKind::Edge, 0)]);
    compare_organizations(&config, &frames, "street").unwrap();
}

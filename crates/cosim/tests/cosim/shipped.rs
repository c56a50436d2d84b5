// SPDX-License-Identifier: MIT OR Apache-2.0
//! The benches of a core: the contents of their vectors, and their failure when any output is
//! wrong.

use crate::common::in_parallel;
use foveate_camera::FeatureKind;
use foveate_cosim::{Occurrences, ShippedBench, VectorTally};
use foveate_design::{ArrayStructure, Design, DesignConfig, Organization};
use foveate_emit::{Prefix, SourceFile, Top, verilog};
use foveate_tools::{
    Tool, Toolchain,
    testing::{cover, require_tools, sample, sampling_step, takes_whole_lists},
};
use std::num::NonZero;
use std::path::Path;
use std::process::Command;
use std::sync::Mutex;
use std::sync::atomic::AtomicBool;

fn design(toml: &str) -> Design {
    DesignConfig::from_toml(toml)
        .unwrap()
        .validate()
        .unwrap_or_else(|error| panic!("{toml}: {error}"))
}

pub(crate) fn bench(design: &Design, top: Top) -> ShippedBench {
    ShippedBench::new(design, top, &Prefix::default(), &AtomicBool::new(false)).unwrap()
}

/// Returns the keys for a frame of the given grid of regions.
fn frame_keys(regions: (u32, u32), size: u32) -> String {
    format!("frame.width = {}\nframe.height = {}\n", regions.0 * size, regions.1 * size)
}

/// Returns designs that differ in all keys on which a bench depends: sizes x depths x variants in
/// every organization. The other keys take turns, and every second combination stands in the list
/// twice, with other turns.
fn designs() -> Vec<String> {
    [designs_with_turns(|_| true), designs_with_turns(|place| place.is_multiple_of(2))].concat()
}

/// Returns the designs of the combinations whose places on the three axes have a sum that `is_in`
/// takes.
fn designs_with_turns(is_in: fn(usize) -> bool) -> Vec<String> {
    let mut list = Vec::new();
    let variants = [
        "",
        "denoise.filter = 'none'",
        "region.neighborhood = 'shared'",
        "temporal.reference = 'last-sent'",
        "temporal.reference = 'last-sent'\nrender.irrelevant = 'hold'\nrender.payload = 'raw'",
        "decision.combine = 'all'",
        "hardware.thresholds = 'constant'",
    ];
    for (x, size) in [2, 3, 8, 20, 64].into_iter().enumerate() {
        for (y, bits) in [1, 8, 16].into_iter().enumerate() {
            for (z, variant) in variants.into_iter().enumerate() {
                // Pixels of one bit cannot reach the default thresholds.
                let is_out_of_reach = bits == 1 && variant.contains("constant");
                if is_out_of_reach || !is_in(x + y + z) {
                    continue;
                }
                let turn = list.len();
                let keys = |organization| {
                    format!(
                        "frame.pixel_bits = {bits}\nregion.size = {size}\n{variant}\n{}",
                        feature_keys(organization, turn, bits, size)
                    )
                };
                let pipelined = keys(Organization::Pipelined);
                let zones = if turn.is_multiple_of(3) { "[zones]\n" } else { "" };
                list.push(format!("{}{pipelined}{zones}", frame_keys((4, 3), size)));
                if size >= 4 {
                    let fold = [1, 2, 5][turn % 3];
                    let feed = ["parallel", "raster"][turn / 3 % 2];
                    let serial = format!(
                        "hardware.organization = 'serial'\nhardware.fold = {fold}\nhardware.feed = '{feed}'\n"
                    );
                    let toml = keys(Organization::Serial);
                    list.push(format!("{}{serial}{toml}", frame_keys((4, 3), size)));
                }
                // A frame with few large regions loses none as a whole, and the bench reports
                // that.
                if size < 64 {
                    let raster =
                        raster_keys(size, [1, 2, 4][turn % 3], ["plain", "deep"][turn % 2]);
                    let rows = [3, 5, 1, 4][turn % 4];
                    let columns = (64 / size).max(4);
                    let toml = keys(Organization::Raster);
                    list.push(format!("{}{raster}{toml}", frame_keys((columns, rows), size)));
                }
            }
        }
    }
    list
}

/// Returns the keys of a raster design with words of at most `most` pixels.
fn raster_keys(size: u32, most: u32, pipelining: &str) -> String {
    let word = (1..=most)
        .rev()
        .find(|word| [1, 2, 4].contains(word) && size.is_multiple_of(*word))
        .unwrap();
    format!(
        "hardware.organization = 'raster'\nhardware.pixels_per_clock = {word}\nhardware.pipelining = '{pipelining}'\n"
    )
}

/// Returns the keys for one feature, two, or all, in turn, with levels that the depth allows.
fn feature_keys(organization: Organization, turn: usize, bits: u32, size: u32) -> String {
    let level = [0, 1, 20][(bits as usize).ilog2() as usize / 2];
    let entry = |kind: &FeatureKind| {
        let keys = [
            kind.score_unit().is_count().then(|| format!("level = {level}\nmin_score = 1\n")),
            (!kind.score_unit().is_count()).then(|| "min_score = 0.1\n".to_owned()),
            kind.has_second_pass().then(|| format!("mean_fraction_bits = {}\n", size.ilog2())),
        ];
        format!(
            "[[spatial]]\nfeature = '{kind}'\n{}",
            keys.into_iter().flatten().collect::<String>()
        )
    };
    let all = organization.feature_kinds();
    let of = match turn % 6 {
        4 => [&all[0], &all[all.len() - 1]].map(entry).concat(),
        5 => all.iter().map(entry).collect(),
        one => entry(&all[one]),
    };
    let level = if bits == 1 { 0 } else { 8 };
    let count = if size == 2 { 2 } else { 5 };
    format!("temporal.level = {level}\ntemporal.min_count = {count}\n{of}")
}

/// Returns true for a design with corners in regions of 2x2 pixels. Behind a median filter none are
/// found, because two pixels are always equal.
fn finds_no_corners(design: &Design) -> bool {
    design.region_size() == 2 && design.feature(FeatureKind::Corner).is_some()
}

#[test]
fn every_design_shows_active_held_and_blank_regions() {
    let designs = cover(designs(), |toml| design(toml).config().to_toml());
    let failures = in_parallel(&designs, |toml| {
        let design = design(toml);
        let tops = Top::all_of(&design).iter().filter(|_| !finds_no_corners(&design));
        match tops.flat_map(|&top| bench_problem(&design, top)).next() {
            None => Ok(()),
            Some(problem) => Err(format!("{problem}\n{toml}")),
        }
    });
    assert!(failures.is_empty(), "{} failed:\n{}", failures.len(), failures.join("\n"));
}

/// The relevance of regions of 2x2 pixels depends on their neighbors. Regions of more than one
/// frame are lost, or the number of the frame would be 0 in all vectors.
#[test]
fn regions_that_depend_on_their_neighbors_are_lost_in_several_frames() {
    let toml = "frame = { width = 64, height = 6, pixel_bits = 1 }\n\
        region = { size = 2, neighborhood = 'shared' }\n\
        temporal = { level = 0, min_count = 2 }\n\
        spatial = [{ feature = 'edge', level = 0, min_score = 1 },\n\
        { feature = 'segment', level = 0, min_score = 1, mean_fraction_bits = 1 }]\n\
        hardware = { organization = 'raster', pixels_per_clock = 2 }\n";
    let bench = bench(&design(toml), Top::Rcm);
    assert_eq!(bench.shortcoming, None);
    assert!(bench.tally.lost > 0, "{:?}", bench.tally);
}

/// Returns the problem of a bench that does not show every kind of region.
fn bench_problem(design: &Design, top: Top) -> Option<String> {
    let bench = bench(design, top);
    let tally = &bench.tally;
    if let Some(shortcoming) = bench.shortcoming {
        return Some(format!("{top:?}: {shortcoming}"));
    }
    let is_kept = bench.remarks.iter().any(|remark| remark.contains("waits for the sink"));
    let loses = design.organization() == Organization::Raster && !is_kept;
    let size = bench.files[1].contents.len();
    let shows_all = tally.frames >= 3
        && tally.active > 0
        && tally.held > 0
        && tally.blank > 0
        && tally.compared > 0
        && (tally.lost > 0) == loses
        && size < 4 << 20;
    (!shows_all).then(|| format!("{top:?}, {size} bytes: {tally:?}"))
}

/// Summaries are sent and stay on the screen, for blocks of every size.
#[test]
fn the_vectors_of_designs_with_summaries_contain_some() {
    let all =
        [(2, 2, 8), (3, 1, 1), (4, 4, 16), (6, 2, 8), (8, 1, 8), (8, 2, 1), (8, 4, 8), (64, 4, 10)];
    for (number, (size, blocks, bits)) in sample(all.into_iter().enumerate(), 3) {
        for hardware in [
            "pipelining = 'deep'",
            "thresholds = 'constant'",
            "sync = true",
            "organization = 'serial'\nhardware.fold = 5",
            "organization = 'serial'\nhardware.feed = 'raster'",
        ] {
            let is_too_small = size < 4 && hardware.contains("serial");
            if is_too_small || bits == 1 && hardware.contains("constant") {
                continue;
            }
            let organization = match hardware.contains("serial") {
                true => Organization::Serial,
                false => Organization::Pipelined,
            };
            let features = feature_keys(organization, number, bits, size);
            let toml = format!(
                "{}frame.pixel_bits = {bits}\nregion.size = {size}\nrender.irrelevant = 'mean'\n\
                 periphery.blocks = {blocks}\ndenoise.filter = 'none'\nhardware.{hardware}\n{features}",
                frame_keys((4, 3), size)
            );
            let design = design(&toml);
            for &top in Top::all_of(&design) {
                let ShippedBench { tally, shortcoming, files, .. } = bench(&design, top);
                assert_eq!(shortcoming, None, "{top:?}\n{toml}");
                assert!(0 < tally.summaries && tally.summaries < tally.blank, "{tally:?}\n{toml}");
                let words = format!("A summary is sent by {} of the blank ones.", tally.summaries);
                assert!(files[0].contents.contains(&words), "{toml}");
            }
        }
    }
}

/// Summaries of raster cores are sent and stay on the screen. The frames of some cores wait for
/// pending regions, and others lose regions.
#[test]
fn the_vectors_of_raster_cores_with_summaries_contain_some() {
    for (number, (size, word, blocks, rows)) in
        [(8, 1, 2, 3), (4, 2, 2, 5), (6, 1, 2, 2), (8, 4, 1, 4)].into_iter().enumerate()
    {
        let pipelining = ["plain", "deep"][number % 2];
        let toml = format!(
            "{}region.size = {size}\nrender.irrelevant = 'mean'\nperiphery.blocks = {blocks}\n\
             denoise.filter = 'none'\n{}{}",
            frame_keys(((64 / size).max(4), rows), size),
            raster_keys(size, word, pipelining),
            feature_keys(Organization::Raster, number, 8, size)
        );
        let design = design(&toml);
        for &top in Top::all_of(&design) {
            let ShippedBench { tally, shortcoming, .. } = bench(&design, top);
            assert_eq!(shortcoming, None, "{top:?}\n{toml}");
            assert!(0 < tally.summaries && tally.summaries < tally.blank, "{tally:?}\n{toml}");
        }
    }
}

/// The streams of an external frame store are shown, and an underrun at the end; without forwarding
/// nothing is missing.
#[test]
fn a_raster_core_with_an_external_store_shows_its_streams() {
    for more in ["", "hardware.pipelining = 'deep'\nhardware.pixels_per_clock = 2\n"] {
        let toml = format!(
            "frame.width = 64\nframe.height = 24\nhardware.organization = 'raster'\n\
             hardware.store = 'external'\n{more}"
        );
        let alone = bench(&design(&format!("hardware.forward = false\n{toml}")), Top::Rcm);
        assert_eq!(alone.shortcoming, None, "{toml}");
        let tally = &alone.tally;
        assert!(tally.active > 0 && tally.held > 0 && tally.blank > 0, "{tally:?}");
        // The underrun does not change the decisions.
        let block = toml.replace("'external'", "'block'");
        let block = bench(&design(&format!("hardware.forward = false\n{block}")), Top::Rcm);
        // A core that keeps its references misses none.
        let counted = |tally: &VectorTally| VectorTally {
            situations: Occurrences::default(),
            ..tally.clone()
        };
        assert_eq!((counted(&block.tally), block.clocks), (counted(tally), alone.clocks));
        let whole = bench(&design(&toml), Top::Rcm);
        for port in ["reference_ready_o", "store_pixel_o", "store_last_o", "underrun_o"] {
            assert!(!whole.tally.zero_outputs.iter().any(|silent| silent == port), "{port}");
        }
    }
}

/// A large array with large folds shows every kind of region, in files that stay small.
#[test]
fn large_folds_show_everything() {
    const MOST: usize = 12 << 20;
    let mut folds = vec!["hardware.fold = 100\nhardware.feed = 'raster'"];
    let others = [
        "frame.width = 1920\nframe.height = 1080\nhardware.fold = 8100\ndenoise.filter = 'none'",
        "hardware.fold = 784",
        "region.size = 48\nhardware.fold = 25\nregion.neighborhood = 'shared'",
    ];
    folds.extend(others.into_iter().filter(|_| takes_whole_lists()));
    for toml in folds {
        let design = design(&format!("hardware.organization = 'serial'\n{toml}\n"));
        for &top in Top::all_of(&design) {
            let bench = bench(&design, top);
            let size = bench.files[1].contents.len();
            assert_eq!(bench.shortcoming, None, "{top:?} {toml}");
            assert!(size < MOST, "{size} bytes: {toml}");
        }
    }
}

/// A bench whose vectors lack something says so and never passes. A lack that follows from the
/// configuration is only a remark.
#[test]
fn a_bench_reports_what_its_vectors_lack() {
    for (toml, words) in [
        (
            "hardware.thresholds = 'constant'\n[[spatial]]\nfeature = 'edge'\nlevel = 1529\nmin_score = 64",
            "no region is active",
        ),
        (
            "frame = { width = 16384, height = 16384 }\nregion.size = 64\nhardware = { organization = 'serial', fold = 65536 }",
            "too long for vectors",
        ),
    ] {
        let design = design(toml);
        for &top in Top::all_of(&design) {
            let bench = bench(&design, top);
            let shortcoming = bench.shortcoming.unwrap_or_default();
            assert!(shortcoming.contains(words), "{toml}: {shortcoming}");
            let text = &bench.files[0].contents;
            assert!(text.contains("INCOMPLETE") && !text.contains("\"PASS"), "{text}");
        }
    }
    for (toml, words) in [
        ("[temporal]\nmin_count = 0", "No region is ever held"),
        ("[[spatial]]\nfeature = 'edge'\nmin_score = 0", "No region is ever blank"),
    ] {
        let constant = format!("hardware.thresholds = 'constant'\n{toml}\n");
        let constant = bench(&design(&constant), Top::Rpu);
        assert_eq!(constant.shortcoming, None, "{toml}");
        assert!(constant.files[0].contents.contains(words), "{}", constant.files[0].contents);
        let runtime = bench(&design(toml), Top::Rpu);
        assert!(runtime.remarks.is_empty() && runtime.shortcoming.is_none(), "{toml}");
        assert!(runtime.tally.held > 0 && runtime.tally.blank > 0, "{toml}");
    }
}

/// The sink stalls for so long that regions are lost. If every frame waits for the sink, no region
/// is lost, and the bench reports that.
#[test]
fn the_benches_of_raster_cores_lose_regions_where_regions_can_be_lost() {
    let waits = "temporal.reference = 'last-sent'";
    // The rows of regions of the frame, the other keys, and whether the bench loses regions.
    for (rows, more, loses) in [
        (30, "", true),
        (1, "", true),
        (30, waits, true),
        (2, waits, false),
        (3, "temporal.reference = 'last-sent'\nspatial = [{ feature = 'mad' }]", false),
    ] {
        let frame = frame_keys((40, rows), 8);
        let design = design(&format!("{frame}hardware.organization = 'raster'\n{more}\n"));
        let bench = bench(&design, Top::Rcm);
        assert_eq!(bench.grid, (40, rows), "{rows} {more}");
        assert_eq!(bench.shortcoming, None, "{rows} {more}");
        let text = &bench.files[0].contents;
        assert_eq!(text.contains("regions are lost."), loses, "{rows} {more}: {text}");
        let says = text.contains("No region is ever lost: a frame waits for the sink.");
        assert_eq!((bench.tally.lost > 0, says), (loses, !loses), "{rows} {more}: {text}");
    }
}

/// Frames come with an error of each kind, and with whole frames behind it. An RPU alone has no
/// frame synchronization.
#[test]
fn the_benches_of_arrays_with_sync_recover_from_damaged_frames() {
    for more in [
        "",
        "spatial = [{ feature = 'mad' }]\nhardware.pipelining = 'deep'",
        "hardware.organization = 'serial'\nhardware.fold = 2",
        "hardware.organization = 'serial'\nhardware.feed = 'raster'",
        "hardware.organization = 'raster'",
        "hardware.organization = 'raster'\nhardware.store = 'external'",
        "hardware.organization = 'raster'\nhardware.pixels_per_clock = 2\ntemporal.reference = 'last-sent'",
    ] {
        let design = design(&format!("{}hardware.sync = true\n{more}\n", frame_keys((4, 3), 8)));
        for &top in Top::all_of(&design) {
            let ShippedBench { grid, tally, shortcoming, files, .. } = bench(&design, top);
            let is_found = top == Top::Rcm || design.unit().array == ArrayStructure::SharedLogic;
            assert_eq!(shortcoming, None, "{top:?} {more}");
            assert_eq!(tally.sync_errors, if is_found { 2 } else { 0 }, "{top:?} {more}");
            // The decisions are those of the rest of the damaged frame, and of more than two whole
            // ones.
            let regions = u64::from(grid.0 * grid.1);
            assert!(!is_found || tally.after_error > 2 * regions, "{tally:?} {top:?} {more}");
            let says = files[0].contents.contains("Frames come damaged: 2 sync errors, and ");
            assert_eq!(says, is_found, "{}", files[0].contents);
        }
    }
}

#[test]
fn equal_designs_have_equal_benches() {
    let design = design("frame = { width = 24, height = 16 }");
    for &top in Top::all_of(&design) {
        assert_eq!(bench(&design, top).files, bench(&design, top).files);
    }
}

/// Puts every output of a module behind a switch: `+tie=I` makes output I 0. Returns the names of
/// the outputs.
fn tie_outputs(files: &mut [SourceFile], top: &str) -> Vec<String> {
    let path = format!("rtl/{top}.v");
    let file = files.iter_mut().find(|file| file.path == path).unwrap();
    let text = file.contents.clone();
    let start = text.find(&format!("\nmodule {top} ")).unwrap();
    let end = start + text[start..].find("\n);").unwrap() + 3;
    let header = &text[start..end];
    let ports: Vec<(bool, String, String)> = header
        .lines()
        .filter_map(|line| {
            let line = line.split("//").next().unwrap().trim().trim_end_matches(',');
            let (direction, rest) = line.split_once(" wire ")?;
            let (range, name) = rest.rsplit_once(' ').unwrap_or(("", rest));
            Some((direction.trim() == "output", range.trim().to_owned(), name.to_owned()))
        })
        .collect();
    let mut wrapper = format!(
        "{header}\n    integer tie;\n    initial if (!$value$plusargs(\"tie=%d\", tie)) tie = -1;\n"
    );
    let (mut pins, mut outputs) = (Vec::new(), Vec::new());
    for (is_output, range, name) in &ports {
        if *is_output {
            let number = outputs.len();
            wrapper += &format!(
                "    wire {range} {name}_core;\n    assign {name} = tie == {number} ? 0 : {name}_core;\n"
            );
            pins.push(format!(".{name}({name}_core)"));
            outputs.push(name.clone());
        } else {
            pins.push(format!(".{name}({name})"));
        }
    }
    let parameters =
        if header.contains("parameter ") { " #(.COLUMNS(COLUMNS), .ROWS(ROWS))" } else { "" };
    wrapper += &format!(
        "    {top}_core{parameters} u_core ({});\nendmodule\n`default_nettype wire\n",
        pins.join(", ")
    );
    let core = text.replacen(&format!("\nmodule {top} "), &format!("\nmodule {top}_core "), 1);
    file.contents = format!("{core}\n`default_nettype none\n{wrapper}");
    outputs
}

/// A simulator that plays a bench: Icarus builds quickly, Verilator runs quickly.
#[derive(Clone, Copy)]
pub(crate) enum BenchSimulator {
    Icarus,
    Verilator,
}

impl BenchSimulator {
    /// Builds the simulation of a folder.
    pub(crate) fn build(self, dir: &Path, files: &[SourceFile], bench: &ShippedBench) {
        let toolchain = Toolchain::system();
        let top = format!("{}_replay", bench.top.module());
        let compile = match self {
            Self::Icarus => {
                let args = ["-g2005", "-s", &top, "-o", "simulation"];
                toolchain.invocation(Tool::Iverilog).unwrap().args(args)
            }
            // The options are those of `tb/replay.sh`.
            Self::Verilator => {
                let args = ["--binary", "--timing", "-Wno-fatal", "-Wno-lint", "-Wno-style"];
                let start = ["--x-assign", "unique", "--x-initial", "unique"];
                let place = ["--Mdir", "built", "-o", "../simulation", "--top-module", &top];
                let compile = toolchain.invocation(Tool::Verilator).unwrap();
                compile.args(args).args(start).args(place)
            }
        };
        let compile = compile.dir(dir).args(files.iter().map(|file| file.path.clone()));
        toolchain.run_checked(&compile.arg(&bench.files[0].path)).unwrap();
    }

    /// Returns true if a run passes, and its output.
    pub(crate) fn play(self, dir: &Path, args: &[&str]) -> (bool, String) {
        let mut command = match self {
            Self::Icarus => {
                let mut vvp = Command::new("vvp");
                vvp.args(["-n", "simulation"]);
                vvp
            }
            Self::Verilator => Command::new(dir.join("simulation")),
        };
        let output = command.args(args).current_dir(dir).output().unwrap();
        (output.status.success(), String::from_utf8(output.stdout).unwrap())
    }
}

/// Checks that the benches of a design pass as shipped, and fail with each output tied to 0.
fn assert_tied_outputs_fail(toml: &str, player: BenchSimulator) {
    let design = design(toml);
    for &top in Top::all_of(&design) {
        assert_tied_outputs_of_top_fail(toml, &design, top, player);
    }
}

fn assert_tied_outputs_of_top_fail(toml: &str, design: &Design, top: Top, player: BenchSimulator) {
    let bench = bench(design, top);
    assert_eq!(bench.shortcoming, None, "{toml}");
    let mut files = verilog(design, top);
    let outputs = tie_outputs(&mut files, top.module());
    let dir = tempfile::tempdir().unwrap();
    let put = |file: &SourceFile| {
        let path = dir.path().join(&file.path);
        std::fs::create_dir_all(path.parent().unwrap()).unwrap();
        std::fs::write(path, &file.contents).unwrap();
    };
    files.iter().chain(&bench.files).for_each(put);
    player.build(dir.path(), &files, &bench);
    let vectors = format!("+vectors={}", bench.files[1].path);
    let play = |tie: &str| player.play(dir.path(), &[&vectors, "+stop", tie]);
    let (is_pass, log) = play("+tie=-1");
    let passed = log.contains(&format!("PASS {} clocks", bench.clocks));
    assert!(is_pass && passed, "{top:?} {toml}\n{log}");
    for (number, name) in outputs.iter().enumerate() {
        // The number of the only region is 0 in the core, too.
        if bench.grid == (1, 1) && ["region_o", "forward_region_o"].contains(&name.as_str()) {
            continue;
        }
        let (is_pass, log) = play(&format!("+tie={number}"));
        let is_named = log.contains(&format!("port {name} "));
        let fails = !is_pass && is_named && log.contains("\nFAIL ") && !log.contains("PASS");
        assert!(fails, "{top:?} with {name} tied to 0 must fail: {log}\n{toml}");
    }
}

/// The grid of the frames. It is small, because a bench plays the whole frame.
const GRID: (u32, u32) = (7, 5);

fn pipelined_or_serial_toml(size: u32, serial: Option<(u32, &str)>) -> String {
    let hardware = serial.map_or_else(String::new, |(fold, feed)| {
        format!("hardware = {{ organization = 'serial', fold = {fold}, feed = '{feed}' }}\n")
    });
    let small = "temporal.min_count = 2\nspatial = [{ feature = 'edge', min_score = 2 }]\ndenoise.filter = 'none'\n";
    let small = if size == 2 { small } else { "" };
    format!("{}region.size = {size}\n{small}{hardware}", frame_keys(GRID, size))
}

/// Returns a raster design with words of up to four pixels and with either kind of reference. The
/// regions that are sent last are lost, too.
fn raster_toml(size: u32, word: u32) -> String {
    let (pipelining, reference) = match word {
        2 => ("deep", "last-sent"),
        _ => ("plain", "previous"),
    };
    let raster = raster_keys(size, word, pipelining);
    let columns = (16 * word).div_ceil(size).max(GRID.0);
    let frame = frame_keys((columns, GRID.1), size);
    format!("{frame}region.size = {size}\ntemporal.reference = '{reference}'\n{raster}")
}

/// The test takes a sample; [`every_tied_output_fails_at_every_size`] takes the whole list.
#[test]
fn every_tied_output_fails() {
    if !require_tools(&[Tool::Iverilog, Tool::Vvp, Tool::Verilator]) {
        return;
    }
    let quick = [
        format!("hardware.sync = true\n{}", pipelined_or_serial_toml(2, None)),
        pipelined_or_serial_toml(8, None),
        format!("render.irrelevant = 'mean'\n{}", pipelined_or_serial_toml(8, None)),
        format!(
            "render.irrelevant = 'mean'\nhardware.pipelining = 'deep'\n{}",
            pipelined_or_serial_toml(6, None)
        ),
        format!("denoise.filter = 'none'\n{}", pipelined_or_serial_toml(20, None)),
        raster_toml(4, 2),
        format!("{}spatial = [{{ feature = 'mad', min_score = 5 }}]\n", raster_toml(8, 4)),
    ];
    // These take five to fifteen seconds in Icarus, and less than three in Verilator.
    let long = [
        pipelined_or_serial_toml(8, Some((3, "raster"))),
        format!(
            "render.irrelevant = 'mean'\n{}",
            pipelined_or_serial_toml(4, Some((7, "parallel")))
        ),
        format!("hardware.sync = true\n{}", raster_toml(8, 1)),
    ];
    for (designs, simulator) in
        [(&quick[..], BenchSimulator::Icarus), (&long[..], BenchSimulator::Verilator)]
    {
        let sampled = designs.iter().step_by(sampling_step(6));
        sampled.for_each(|toml| assert_tied_outputs_fail(toml, simulator));
    }
}

/// All sizes, folds, feeds, words and organizations: `cargo test -p foveate-cosim --test cosim --
/// --ignored tied`.
#[test]
#[ignore = "takes many minutes"]
fn every_tied_output_fails_at_every_size() {
    if !require_tools(&[Tool::Iverilog, Tool::Vvp, Tool::Verilator]) {
        return;
    }
    let designs = Mutex::new(matrix().into_iter());
    let control = || {
        while let Some((toml, player)) = { designs.lock().unwrap().next() } {
            assert_tied_outputs_fail(&toml, player);
            println!("fails with every output: {}", toml.replace('\n', " "));
        }
    };
    std::thread::scope(|scope| {
        for _ in 0..std::thread::available_parallelism().map_or(1, NonZero::get) {
            scope.spawn(control);
        }
    });
}

/// Returns the designs. Frames of large regions have too many clocks for Icarus.
fn matrix() -> Vec<(String, BenchSimulator)> {
    let mut list = Vec::new();
    for size in [2, 8, 20, 32, 48, 64] {
        let mut designs = vec![pipelined_or_serial_toml(size, None)];
        if size >= 4 {
            for feed in ["parallel", "raster"] {
                for fold in [1, 3, 9] {
                    designs.push(pipelined_or_serial_toml(size, Some((fold, feed))));
                }
            }
            let divides = |word: &u32| size.is_multiple_of(*word);
            designs
                .extend([1, 2, 4].into_iter().filter(divides).map(|word| raster_toml(size, word)));
        }
        let player = if size <= 8 { BenchSimulator::Icarus } else { BenchSimulator::Verilator };
        for toml in designs {
            for neighborhood in ["isolated", "shared"] {
                list.push((format!("region.neighborhood = '{neighborhood}'\n{toml}"), player));
            }
        }
    }
    list
}

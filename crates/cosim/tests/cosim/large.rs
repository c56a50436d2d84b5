// SPDX-License-Identifier: MIT OR Apache-2.0
//! The parts of a core that only a large frame has: widths, memories and counters that follow from
//! its size. The default runs and the bench of a core must reach all of them, and faults there must
//! be found.

use crate::common::{cosimulate, has_simulators, in_parallel};
use foveate_cosim::{
    CosimJob, CosimLevel, ShippedBench, Simulator, Stimulus, unelaborated_variants,
};
use foveate_design::{Design, DesignConfig, PRESETS};
use foveate_emit::{Prefix, SourceFile, Top, verilog};
use foveate_tools::{
    Tool, Toolchain,
    testing::{require_tools, sample},
};
use std::collections::BTreeSet;
use std::path::Path;
use std::process::Command;
use std::sync::atomic::AtomicBool;

/// The smallest frame with all that a large frame has: two banks of the store, more than 16 regions
/// side by side, more than 64 rows of pixels, and more than 255 regions.
const LARGE: &str = "frame = { width = 160, height = 128, pixel_bits = 4 }\nregion.size = 8\n\
    spatial = [{ feature = 'edge', level = 9, min_score = 5 }]\ntemporal = { level = 1, min_count = 5 }\n\
    hardware = { organization = 'raster', pipelining = 'deep' }\n";
/// The number of clocks after which the default run of a whole frame may stop; 1 leaves the first
/// three sequences.
const SUFFICIENT_CLOCKS: u64 = 1;

/// A fault: an edit of one file.
struct LargeFrameFault {
    description: &'static str,
    file: &'static str,
    from: &'static str,
    to: &'static str,
}

const FAULTS: &[LargeFrameFault] = &[
    LargeFrameFault {
        description: "every reference of a large store is 0",
        file: "rtl/raster_banks.v",
        from: "assign data_o = found[GROUPS];",
        to: "assign data_o = {WIDTH{1'b0}};",
    },
    LargeFrameFault {
        description: "the write address of a bank lacks a bit",
        file: "rtl/raster_banks.v",
        from: "own_write_q <= write_q[BANK_BITS-1:0];",
        to: "own_write_q <= {1'b0, write_q[BANK_BITS-2:0]};",
    },
    LargeFrameFault {
        description: "the first bank is written for all",
        file: "rtl/raster_banks.v",
        from: "write_place[group][BANK_BITS+:SLOT_BITS] == OWN",
        to: "OWN == 0",
    },
    LargeFrameFault {
        description: "a reference comes a clock early",
        file: "rtl/raster_banks.v",
        from: "assign data_o = found[GROUPS];",
        to: "assign data_o = g_group[GROUPS-1].any;",
    },
    LargeFrameFault {
        description: "4 bits of the column of a region",
        file: "rtl/raster_start.v",
        from: "column_q == BEFORE_LAST[COLUMN_BITS-1:0]",
        to: "column_q == (BEFORE_LAST & 15)",
    },
    LargeFrameFault {
        description: "6 bits of the row of a pixel",
        file: "rtl/raster_control.v",
        from: "row_q == BEFORE_LAST_TAKEN_ROW[ROW_BITS-1:0]",
        to: "row_q == (BEFORE_LAST_TAKEN_ROW & 63)",
    },
    LargeFrameFault {
        description: "losses are counted up to 255",
        file: "rtl/raster_forward.v",
        from: "lost_count_o != 16'hFFFF",
        to: "lost_count_o != 16'h00FF",
    },
];

fn design(toml: &str) -> Design {
    DesignConfig::from_toml(toml)
        .unwrap()
        .validate()
        .unwrap_or_else(|error| panic!("{toml}: {error}"))
}

/// Returns the sources of a core, with those of all of its tops.
fn core_sources(design: &Design) -> Vec<SourceFile> {
    let mut known = BTreeSet::new();
    let all = Top::all_of(design).iter().flat_map(|&top| verilog(design, top));
    all.filter(|file| known.insert(file.path.clone())).collect()
}

/// Returns true if a co-simulation at this level finds the fault.
fn is_found_by_cosim(
    design: &Design,
    files: &[SourceFile],
    (level, simulator): (CosimLevel, Simulator),
    output: &Path,
) -> bool {
    let stimulus = Stimulus {
        level,
        rounds: 1,
        sufficient_clocks: Some(SUFFICIENT_CLOCKS),
        ..Stimulus::default()
    };
    let edit = |job: &mut CosimJob| job.sources = files.to_vec();
    !cosimulate(design, simulator, stimulus, output, edit).unwrap().passed()
}

/// Returns true if the bench of the array, in Icarus, prints anything other than PASS.
fn is_found_by_bench(bench: &ShippedBench, files: &[SourceFile]) -> bool {
    let dir = tempfile::tempdir().unwrap();
    for file in files.iter().chain(&bench.files) {
        let path = dir.path().join(&file.path);
        std::fs::create_dir_all(path.parent().unwrap()).unwrap();
        std::fs::write(path, &file.contents).unwrap();
    }
    let names = files.iter().map(|file| file.path.as_str()).chain([bench.files[0].path.as_str()]);
    let built = Command::new("iverilog")
        .args(["-g2005", "-s", "rcm_replay", "-o", "simulation"])
        .args(names)
        .current_dir(dir.path())
        .status();
    assert!(built.unwrap().success());
    let vectors = format!("+vectors={}", bench.files[1].path);
    let output = Command::new("vvp")
        .args(["-n", "simulation", &vectors, "+stop"])
        .current_dir(dir.path())
        .output()
        .unwrap();
    let log = String::from_utf8(output.stdout).unwrap();
    let passes = log.contains(&format!("PASS {} clocks", bench.clocks));
    assert!(passes || log.contains("FAIL"), "{log}");
    !passes
}

/// Each fault passes the small grid, and is found by the default run of the whole frame and by the
/// bench.
#[test]
fn faults_of_a_large_frame_are_found_by_the_default_runs_and_by_the_bench() {
    if !has_simulators() {
        return;
    }
    let design = design(LARGE);
    let levels = CosimLevel::for_sources(&design, &core_sources(&design), &Prefix::default());
    assert_eq!(levels.last(), Some(&CosimLevel::Full), "{levels:?}");
    let bench =
        ShippedBench::new(&design, Top::Rcm, &Prefix::default(), &AtomicBool::new(false)).unwrap();
    assert_eq!(bench.grid, (20, 16));
    assert_eq!(bench.shortcoming, None);
    assert!(bench.tally.lost > 255, "{:?}", bench.tally);
    let sound = verilog(&design, Top::Rcm);
    assert!(!is_found_by_bench(&bench, &sound), "no fault, and yet the bench fails");
    let output = tempfile::tempdir().unwrap();
    let failures = in_parallel(&sample(FAULTS, 8), |&fault| {
        let LargeFrameFault { description: what, file, from, to } = fault;
        let mut files = sound.clone();
        let edited = files.iter_mut().find(|source| source.path == *file);
        let edited = edited.ok_or_else(|| format!("{what}: no file {file}"))?;
        if edited.contents.matches(from).count() != 1 {
            return Err(format!("{what}: `{from}` is not there once"));
        }
        edited.contents = edited.contents.replace(from, to);
        let folder = output.path().join(what.replace(' ', "-"));
        // The whole frame is quicker in Verilator, in which no unknown value shows the fault; the
        // bench runs in Icarus.
        let (small, whole) = (
            (CosimLevel::small_array(&design), Simulator::Iverilog),
            (CosimLevel::Full, Simulator::Verilator),
        );
        if is_found_by_cosim(&design, &files, small, &folder) {
            return Err(format!("{what}: the small grid finds it, so it shows nothing here"));
        }
        if !is_found_by_cosim(&design, &files, whole, &folder) {
            return Err(format!("{what}: passes the default run of the whole frame"));
        }
        if !is_found_by_bench(&bench, &files) {
            return Err(format!("{what}: passes the bench"));
        }
        Ok(())
    });
    assert!(failures.is_empty(), "{}", failures.join("\n"));
}

/// A bench for an array with too many lanes never passes.
#[test]
fn the_bench_of_too_many_lanes_never_passes() {
    let design = design(
        "frame = { width = 160, height = 128 }\nregion.size = 4\nhardware.organization = 'serial'\n",
    );
    let bench =
        ShippedBench::new(&design, Top::Rcm, &Prefix::default(), &AtomicBool::new(false)).unwrap();
    let said = bench.shortcoming.unwrap();
    assert!(said.contains("1280 lanes") && said.contains("of 40 x 32"), "{said}");
}

/// The modules that a simulation of the small grid leaves out are named with their parameter
/// values.
#[test]
fn what_a_small_grid_leaves_out_is_named() {
    if !require_tools(&[Tool::Verilator]) {
        return;
    }
    let (design, toolchain) = (design(LARGE), Toolchain::system());
    let sources = core_sources(&design);
    let left = |levels: &[CosimLevel]| {
        unelaborated_variants(&design, &sources, &Prefix::default(), levels, &toolchain).unwrap()
    };
    let small = left(&[CosimLevel::small_array(&design)]);
    let said: Vec<String> = small.iter().map(ToString::to_string).collect();
    for wanted in ["module raster_banks", "raster_ring with ", "rcm with COLUMNS = 14, ROWS = 10"] {
        assert!(said.iter().any(|text| text.starts_with(wanted)), "{wanted}: {said:?}");
    }
    assert_eq!(left(&CosimLevel::for_sources(&design, &sources, &Prefix::default())), []);
}

/// An array of copies is not simulated whole. The elaborated array shows that each copy has its own
/// lanes.
#[test]
fn each_copy_of_an_array_is_connected_to_its_own_lanes() {
    if !require_tools(&[Tool::Verilator]) {
        return;
    }
    let toolchain = Toolchain::system();
    let variants = [
        "",
        "region.neighborhood = 'shared'\ndenoise.filter = 'median3x3'\n",
        "hardware.sync = true\n",
    ];
    for more in sample(variants, 3) {
        let design = design(&format!("frame = {{ width = 160, height = 104 }}\n{more}"));
        let sources = core_sources(&design);
        let levels = CosimLevel::for_sources(&design, &sources, &Prefix::default());
        assert!(!levels.contains(&CosimLevel::Full), "{levels:?}");
        let left = |files: &[SourceFile]| {
            unelaborated_variants(&design, files, &Prefix::default(), &levels, &toolchain).unwrap()
        };
        assert_eq!(left(&sources), [], "{more}");
        for (from, to) in [
            ("pixel_i[REGION*8+:8]", "pixel_i[(REGION == 200 ? 199 : REGION)*8+:8]"),
            (".srs_o(srs_o[REGION])", ".srs_o(srs_o[REGION ^ (REGION >= 64)])"),
            (
                ".temporal_level_i(temporal_level_i)",
                ".temporal_level_i(temporal_level_i + (REGION == 200))",
            ),
        ] {
            let mut files = sources.clone();
            let array = files.iter_mut().find(|file| file.path == "rtl/rcm.v").unwrap();
            assert_eq!(array.contents.matches(from).count(), 1, "{from}");
            array.contents = array.contents.replace(from, to);
            let said: Vec<String> = left(&files).iter().map(ToString::to_string).collect();
            assert_eq!(said, ["rcm with COLUMNS = 14, ROWS = d"], "{from}");
        }
    }
}

/// Returns designs of every preset, and of frames up to 1920x1080.
fn listed_designs() -> Vec<(String, Design)> {
    let hd = "frame = { width = 1920, height = 1080 }\n";
    let mut list: Vec<(String, Design)> = PRESETS
        .iter()
        .map(|preset| {
            let design = preset.config().and_then(|config| config.validate()).unwrap();
            (preset.name.to_owned(), design)
        })
        .collect();
    for (name, more) in [
        ("pipelined 1920x1080 of 32x32", "region.size = 32\n"),
        ("serial 1920x1080, fold 300", "hardware = { organization = 'serial', fold = 300 }\n"),
        ("raster 1920x1080", "hardware.organization = 'raster'\n"),
        ("raster 1920x1080 deep", "hardware = { organization = 'raster', pipelining = 'deep' }\n"),
        (
            "raster 1920x1080 last-sent",
            "temporal.reference = 'last-sent'\nhardware.organization = 'raster'\n",
        ),
        (
            "raster 1920x1080 deep, external, K = 4",
            "hardware = { organization = 'raster', pipelining = 'deep', store = 'external', pixels_per_clock = 4 }\n",
        ),
    ] {
        list.push((name.to_owned(), design(&format!("{hd}{more}"))));
    }
    list
}

/// Every module and parameter value of every listed design is elaborated by its default runs and by
/// its bench.
#[test]
fn nothing_of_a_generated_core_is_left_out() {
    if !require_tools(&[Tool::Verilator]) {
        return;
    }
    let toolchain = Toolchain::system();
    let failures = in_parallel(&sample(listed_designs(), 4), |(name, design)| {
        let sources = core_sources(design);
        let bench = ShippedBench::levels(design).map_err(|error| error.to_string())?;
        for (what, levels) in [
            ("cosim", CosimLevel::for_sources(design, &sources, &Prefix::default())),
            ("bench", bench),
        ] {
            let left =
                unelaborated_variants(design, &sources, &Prefix::default(), &levels, &toolchain)
                    .map_err(|error| format!("{name}: {error}"))?;
            if !left.is_empty() {
                let left: Vec<String> = left.iter().map(ToString::to_string).collect();
                return Err(format!("{name}, {what}: {}", left.join("; ")));
            }
        }
        Ok(())
    });
    assert!(failures.is_empty(), "{}", failures.join("\n"));
}

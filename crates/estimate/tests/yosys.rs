// SPDX-License-Identifier: MIT OR Apache-2.0
//! Tests of a toy design with Yosys. They are skipped with a message where Yosys is missing.

use foveate_estimate::{EstimateError, EstimateJob, estimate};
use foveate_tools::{Cache, SynthesisJob, Tool, ToolError, Toolchain, testing::require_tools};

fn toy_job(regions: u64) -> EstimateJob {
    let rcm = include_str!("fixtures/rcm.v").replace("REGIONS", &regions.to_string());
    let sources = [
        ("adder.v", include_str!("fixtures/adder.v").to_owned()),
        ("pair.v", include_str!("fixtures/pair.v").to_owned()),
        ("ram.v", include_str!("fixtures/ram.v").to_owned()),
        ("rpu.v", include_str!("fixtures/rpu.v").to_owned()),
        ("rcm.v", rcm),
    ];
    EstimateJob {
        synthesis: SynthesisJob {
            sources: sources.map(|(name, text)| (name.to_owned(), text)).to_vec(),
            unit: "rpu".to_owned(),
            array: "rcm".to_owned(),
            parameters: Vec::new(),
        },
        bus: None,
        unit_name: "RPU".to_owned(),
        units: regions,
        regions,
        clocks_per_frame: 64,
        rpu_sha256: String::new(),
        leaves_of: None,
    }
}

#[test]
fn a_toy_array_is_estimated() {
    if !require_tools(&[Tool::Yosys]) {
        return;
    }
    let (tools, cache) = (Toolchain::system(), Cache::from_env().unwrap());
    let job = EstimateJob { leaves_of: Some("rpu".to_owned()), ..toy_job(784) };
    let report = estimate(&tools, &cache, &job).unwrap();
    assert_eq!(report.rpu.lut_memory, 8, "a single-port RAM of 64 x 8");
    assert_eq!(report.rpu.ff, 7, "the address register is not doubled");
    assert!(report.rpu.lut_logic_high > 10, "{report:?}");
    assert!(report.rcm_glue.lut_logic_high > 0, "the OR over all regions");
    assert_eq!(report.rcm, report.rpu.multiplied(784).plus(report.rcm_glue));
    assert!(report.paths.rpu.levels >= 3, "{:?}", report.paths);
    assert!(report.paths.rpu.to.contains("(FDRE."), "{:?}", report.paths);
    assert_eq!((report.unit.as_str(), report.units), ("RPU", 784));
    // A frame takes 64 clocks, at the clock of this netlist.
    let (speed, clock) = (report.speed.unwrap(), report.clock.as_ref().unwrap());
    assert!(speed.estimated && speed.clock_mhz == clock.mhz, "{speed:?}");
    assert_eq!(speed.frames_per_second, clock.mhz * 1e6 / 64.0);
    assert_eq!(speed.low_frames_per_second, clock.low_mhz * 1e6 / 64.0);
    assert!(report.tool.version.starts_with("Yosys "));
    let modules: Vec<&str> = report.leaves.iter().map(|leaf| leaf.module.as_str()).collect();
    assert_eq!(modules, ["rpu", "adder", "adder", "pair", "ram"]);
    assert_eq!(report.leaves[1].instances, 2);
    assert!(report.leaves[4].parameters.contains(&"DEPTH=64".to_owned()));
    assert!(report.tables().text(80).contains("RCM, Yosys estimate"));
    assert_eq!(estimate(&tools, &cache, &job).unwrap(), report);

    // The same netlist is rejected for another design.
    let error = estimate(&tools, &cache, &EstimateJob { units: 5, ..job }).unwrap_err();
    let expected = "`rcm` has 784 instances of `rpu`, but the design has 5; the Verilog may belong to another design";
    assert_eq!(error.to_string(), expected);
}

#[test]
fn a_design_without_memory_is_estimated() {
    if !require_tools(&[Tool::Yosys]) {
        return;
    }
    let (tools, cache) = (Toolchain::system(), Cache::from_env().unwrap());
    let mut job = toy_job(4);
    job.synthesis.sources[2].1 =
        job.synthesis.sources[2].1.replace("= mem[addr_i]", "= d_i").replace("reg [W", "//");
    job.synthesis.sources[2].1 = job.synthesis.sources[2].1.replace("always", "//");
    let report = estimate(&tools, &cache, &job).unwrap();
    assert_eq!(report.rpu.lut_memory, 0);
}

#[test]
fn mistakes_are_named() {
    if !require_tools(&[Tool::Yosys]) {
        return;
    }
    let (tools, cache) = (Toolchain::system(), Cache::from_env().unwrap());
    let mut job = toy_job(4);
    job.synthesis.sources[3].1 =
        job.synthesis.sources[3].1.replace("always @(posedge clk_i)", "always @*");
    let error = estimate(&tools, &cache, &job).unwrap_err();
    let EstimateError::UnknownCell { cell, module, .. } = &error else { panic!("{error}") };
    assert_eq!((cell.as_str(), module.as_str()), ("LDCE", "rpu"));

    let mut other = toy_job(4);
    other.synthesis.array = "array".into();
    let error = estimate(&tools, &cache, &other);
    let Err(EstimateError::Tool(ToolError::Failed { tail, .. })) = error else {
        panic!("{error:?}")
    };
    assert!(tail.contains("array"), "{tail}");
}

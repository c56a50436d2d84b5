// SPDX-License-Identifier: MIT OR Apache-2.0
//! The synthesized netlist agrees with the model, and a netlist with a fault does not.

use crate::common::{design, directed_stimulus, in_parallel};
use foveate_cosim::{CosimJob, CosimLevel, CosimReport, Netlist, Simulator};
use foveate_design::DesignConfig;
use foveate_tools::{
    Cache, Tool, Toolchain,
    testing::{require_tools, takes_whole_lists},
};
use std::path::Path;
use std::process::Command;

const TOOLS: &[Tool] = &[Tool::Yosys, Tool::Iverilog, Tool::Vvp];

/// A design with a window, lines in shift registers, a store in distributed RAM, and carry chains.
const EDGES: &str = "[region]\nsize = 4\n[denoise]\nfilter = \"none\"\n";
/// A design with a median, a second pass, and constant thresholds.
const MAD: &str =
    "[region]\nsize = 4\n[[spatial]]\nfeature = \"mad\"\n[hardware]\nthresholds = \"constant\"\n";

/// A design with squares and a product in DSP slices.
const VARIANCE: &str =
    "[region]\nsize = 4\n[denoise]\nfilter = \"none\"\n[[spatial]]\nfeature = \"variance\"\n";
/// A deep design with a median, edges and `last-sent` references.
const DEEP: &str = "[region]\nsize = 4\n[temporal]\nreference = \"last-sent\"\n[hardware]\n\
                    pipelining = \"deep\"\n";
/// A design with means that rotate in shift registers.
const MEANS: &str =
    "[region]\nsize = 4\n[denoise]\nfilter = \"none\"\n[render]\nirrelevant = \"mean\"\n";
/// A deep design with means, which need a division by 9, and a second pass.
const MEANS_DEEP: &str = "[region]\nsize = 6\n[denoise]\nfilter = \"none\"\n[[spatial]]\nfeature = \"mad\"\n\
                          [render]\nirrelevant = \"mean\"\n[hardware]\npipelining = \"deep\"\n";
/// A serial array with a raster feed and lanes of two regions each, one of whose slots is empty.
const FOLDED: &str = "[region]\nsize = 4\n[denoise]\nfilter = \"none\"\n[hardware]\n\
                      organization = \"serial\"\nfeed = \"raster\"\nfold = 2\n";

/// A serial array with means of single pixels in block RAM, which come back around the ring of
/// lanes.
const FOLDED_MEANS: &str = "[region]\nsize = 4\n[denoise]\nfilter = \"none\"\n[render]\n\
                            irrelevant = \"mean\"\n[periphery]\nblocks = 4\n[hardware]\n\
                            organization = \"serial\"\nmemory = \"block\"\nfold = 2\n";

/// A raster core with its memories in block RAM with two ports, one of which writes and the other
/// reads.
const RASTER: &str = "[region]\nsize = 4\n[frame]\npixel_bits = 4\n[denoise]\nfilter = \"none\"\n[hardware]\n\
                      organization = \"raster\"\n";
/// A deep raster core whose queue has words that are wider than a port, and whose pixels are
/// written twice.
const RASTER_DEEP: &str = "[region]\nsize = 4\n[frame]\npixel_bits = 4\n[temporal]\nreference = \"last-sent\"\n\
                           [render]\npayload = \"raw\"\n[hardware]\norganization = \"raster\"\n\
                           pipelining = \"deep\"\n";

/// A raster core whose means of 2x2 blocks wait beside the pixels. The means that were sent are in
/// a memory of the whole frame, and the pixels that were sent are references in another.
const RASTER_MEANS: &str = "[region]\nsize = 4\n[frame]\npixel_bits = 4\n[denoise]\nfilter = \"none\"\n[temporal]\n\
                            reference = \"last-sent\"\n[render]\nirrelevant = \"mean\"\n[periphery]\nblocks = 2\n[hardware]\norganization = \"raster\"\n\
                            pipelining = \"deep\"\n";

fn job(toml: &str, level: CosimLevel, regions: (u32, u32), output: &Path) -> CosimJob {
    let design = design(&DesignConfig::from_toml(toml).unwrap(), regions);
    let mut job = CosimJob::new(&design, directed_stimulus(level, 1), output).unwrap();
    job.simulator = Simulator::Iverilog;
    let netlist = job.synthesize(&Toolchain::system(), &Cache::from_env().unwrap());
    job.netlist = Some(netlist.unwrap());
    job
}

fn run_job(job: &CosimJob) -> CosimReport {
    job.run(&Toolchain::system(), &Cache::from_env().unwrap(), &mut |_| {}).unwrap()
}

#[test]
fn netlists_agree_with_the_model() {
    if !require_tools(TOOLS) {
        return;
    }
    let output = tempfile::tempdir().unwrap();
    let mut jobs = vec![(MAD, CosimLevel::Rpu, (1, 1))];
    // The design above and the tests of single cells cover most of these. Not covered there are
    // two regions in a lane, two RPUs side by side, `raster`, and a division by 9.
    let others = [
        (FOLDED_MEANS, CosimLevel::Rcm { columns: 3, rows: 1 }, (3, 1)),
        (RASTER_MEANS, CosimLevel::Rcm { columns: 4, rows: 1 }, (4, 1)),
        (VARIANCE, CosimLevel::Rpu, (1, 1)),
        (MEANS_DEEP, CosimLevel::Rpu, (1, 1)),
        (MEANS, CosimLevel::Rcm { columns: 2, rows: 1 }, (1, 1)),
        (DEEP, CosimLevel::Rpu, (1, 1)),
        (EDGES, CosimLevel::Rpu, (1, 1)),
        (EDGES, CosimLevel::Rcm { columns: 2, rows: 1 }, (1, 1)),
        (FOLDED, CosimLevel::Rcm { columns: 3, rows: 1 }, (3, 1)),
        (RASTER, CosimLevel::Rcm { columns: 4, rows: 3 }, (4, 3)),
        (RASTER_DEEP, CosimLevel::Rcm { columns: 4, rows: 3 }, (4, 3)),
        (RASTER_MEANS, CosimLevel::Rcm { columns: 4, rows: 2 }, (4, 2)),
    ];
    jobs.extend(others.into_iter().filter(|_| takes_whole_lists()));
    let failures = in_parallel(&jobs, |&(toml, level, regions)| {
        let job = job(toml, level, regions, &output.path().join(level.to_string()));
        let report = run_job(&job);
        let record = report.netlist.clone().unwrap();
        assert!(record.tool.version.starts_with("Yosys"), "{record:?}");
        assert!(report.name.contains(" netlist iverilog"), "{report}");
        if report.passed() { Ok(()) } else { Err(report.to_string()) }
    });
    assert!(failures.is_empty(), "{}", failures.join("\n"));
}

/// Returns the netlist with a fault in the lookup table of index `lut`: one entry is inverted, or
/// all are.
fn with_table_fault(netlist: &Netlist, lut: usize, bit: Option<u64>) -> Option<Netlist> {
    let mut faulty = netlist.clone();
    let (_, text) = faulty.sources.iter_mut().find(|(name, _)| name.ends_with("netlist.v"))?;
    let (at, _) = text.match_indices(" LUT").nth(lut)?;
    let first = at + text[at..].find("'h")? + 2;
    let last = first + text[first..].find(')')?;
    let bits: u32 = text[..first - 2].rsplit('(').next()?.parse().ok()?;
    let all = u64::MAX >> (64 - bits);
    let init = u64::from_str_radix(&text[first..last], 16).ok()?;
    let wrong = init ^ bit.map_or(all, |bit| 1 << (bit % u64::from(bits)));
    text.replace_range(first..last, &format!("{wrong:x}"));
    Some(faulty)
}

#[test]
fn a_wrong_table_is_found() {
    if !require_tools(TOOLS) {
        return;
    }
    let output = tempfile::tempdir().unwrap();
    let sound = job(EDGES, CosimLevel::Rpu, (1, 1), &output.path().join("sound"));
    let netlist = sound.netlist.clone().unwrap();
    let faults: Vec<(usize, Option<u64>)> =
        (0..4).flat_map(|i| [(26 * i, None), (26 * i + 7, Some(5 * i as u64))]).collect();
    let hidden = in_parallel(&faults, |&(lut, bit)| {
        let folder = output.path().join(format!("{lut} {bit:?}"));
        let netlist = with_table_fault(&netlist, lut, bit);
        let netlist = Some(netlist.ok_or("no such LUT")?);
        let job = CosimJob { netlist, output: folder, ..sound.clone() };
        if run_job(&job).passed() { Err(format!("LUT {lut}, entry {bit:?}")) } else { Ok(()) }
    });
    // The design may never use a single entry of a table. Some single faults must be found, and
    // every inverted table.
    assert!(!hidden.iter().any(|fault| fault.contains("None")), "not found: {hidden:?}");
    assert!(hidden.len() <= 2, "not found: {hidden:?}");

    // The replay folder shows the mismatch again, without Foveate.
    let folder = output.path().join("0 None");
    let again = Command::new(folder.join("replay.sh")).output().unwrap();
    let log = String::from_utf8_lossy(&again.stdout).into_owned();
    assert_eq!(again.status.code(), Some(1), "{log}");
    assert!(log.contains("MISMATCH clock "), "{log}");
}

// SPDX-License-Identifier: MIT OR Apache-2.0
//! Designs to emit, in which every value of the configuration occurs, mostly with every other.

use foveate_camera::FeatureKind;
use foveate_design::{Design, DesignConfig, Organization};
use foveate_tools::testing::cover;
use std::process::{Command, Stdio};

/// Returns the designs of a matrix that cover it.
pub(crate) fn covering_values(matrix: Vec<String>) -> Vec<String> {
    cover(matrix, |toml| design(toml).config().to_toml())
}

/// Returns whether there is a Tcl interpreter. Prints a message if there is none, and panics if
/// tools are required.
#[expect(clippy::print_stderr, reason = "a test that is skipped says so")]
pub(crate) fn has_tclsh() -> bool {
    if Command::new("tclsh").stdin(Stdio::null()).output().is_ok() {
        return true;
    }
    let is_strict = std::env::var_os("FOVEATE_REQUIRE_TOOLS").is_some_and(|value| value == "1");
    assert!(!is_strict, "FOVEATE_REQUIRE_TOOLS is 1, and tclsh is missing (Debian: tcl)");
    eprintln!("skipped: tclsh is missing");
    false
}

pub(crate) fn design(toml: &str) -> Design {
    DesignConfig::from_toml(toml).unwrap().validate().unwrap()
}

/// Returns the features of an organization as values of the key `spatial`, with the lowest
/// thresholds: each alone, one with a fraction of the mean, two that share a window, and all. The
/// minimum of 0 lets a region be active without a reference.
fn feature_lists(organization: Organization) -> Vec<String> {
    let entry = |kind: &FeatureKind| {
        let level = if kind.score_unit().is_count() { ",level=0" } else { "" };
        format!("{{feature='{kind}',min_score=0{level}}}")
    };
    let all: Vec<_> = organization.feature_kinds().iter().map(entry).collect();
    let pair = format!("{},{}", entry(&FeatureKind::Edge), entry(&FeatureKind::Corner));
    let fraction = "{feature='mad',min_score=0,mean_fraction_bits=2}".to_owned();
    let lists = all.iter().cloned().chain([fraction, pair, all.join(",")]);
    lists.map(|list| format!("[{list}]")).collect()
}

const WINDOW_FILTERS: [&str; 3] = ["median3x3", "switching3x3", "binomial3x3"];
const SIZES: [u32; 7] = [2, 3, 5, 8, 16, 20, 64];
const DEPTHS: [u32; 4] = [1, 8, 10, 16];
const PIPELINING: [&str; 2] = ["plain", "deep"];

/// Returns the largest number of blocks along a side that such a region can have.
fn most_blocks(size: u32) -> u32 {
    [4, 2].into_iter().find(|blocks| size.is_multiple_of(*blocks)).unwrap_or(1)
}

/// Returns the table `[zones]` with a keen region in a corner, or nothing.
fn zones_table(has_zones: bool, summarizes: bool, size: u32) -> String {
    if !has_zones {
        return String::new();
    }
    let off = if summarizes { "off_level = 1\n" } else { "" };
    format!(
        "[zones]\n{off}areas = [{{ class = 'keen', rectangle = [0, 0, {size}, {size}] }}]\n\
         keen = {{ temporal = {{ min_count = 2 }} }}\n"
    )
}

/// Returns configurations of pipelined designs as TOML.
pub(crate) fn pipelined_matrix() -> Vec<String> {
    let mut list = Vec::new();
    for (index, features) in feature_lists(Organization::Pipelined).iter().enumerate() {
        for choice in 0..8 {
            // The indices of sizes and depths do not repeat in step with the choices, so all pairs
            // occur.
            let size = SIZES[(index * 3 + choice) % SIZES.len()];
            let depth = DEPTHS[(index + choice * 3 + choice / 4) % DEPTHS.len()];
            let pick = |bit: usize, off: &'static str, on: &'static str| {
                if (choice >> bit) & 1 == 0 { off } else { on }
            };
            // Every third design shows means, and choice 5 shows the largest number of blocks.
            let irrelevant = match choice % 3 {
                2 => "mean",
                _ => pick(index % 3, "zero", "hold"),
            };
            let periphery = match choice {
                5 => format!("[periphery]\nblocks = {}\n", most_blocks(size)),
                _ => String::new(),
            };
            let zones = zones_table((index + choice / 2) % 2 == 1, irrelevant == "mean", size);
            list.push(format!(
                "spatial = {features}\n\
                 [frame]\nwidth = {width}\nheight = {size}\npixel_bits = {depth}\n\
                 [region]\nsize = {size}\nneighborhood = '{neighborhood}'\n\
                 [denoise]\nfilter = '{filter}'\n\
                 [temporal]\nlevel = 0\nmin_count = 1\nreference = '{reference}'\n\
                 [render]\npayload = '{payload}'\nirrelevant = '{irrelevant}'\n\
                 [hardware]\npipelining = '{pipelining}'\nthresholds = '{thresholds}'\nsync = {sync}\n{periphery}{zones}",
                width = 2 * size,
                neighborhood = pick(0, "isolated", "shared"),
                filter = pick(1, WINDOW_FILTERS[(index + choice) % WINDOW_FILTERS.len()], "none"),
                reference = pick(2, "previous", "last-sent"),
                payload = pick((index + 1) % 3, "denoised", "raw"),
                thresholds = pick((index + 2) % 3, "runtime", "constant"),
                sync = choice % 3 == 1,
                // Every pair of the other choices occurs both plain and deep.
                pipelining = PIPELINING[(index + choice.count_ones() as usize) % 2],
            ));
        }
    }
    list
}

/// The sizes of regions of the serial organization.
const SERIAL_SIZES: [u32; 6] = [4, 5, 8, 6, 64, 16];
/// The pixel depths of the serial and raster organizations, in bits.
const SERIAL_DEPTHS: [u32; 5] = [8, 1, 16, 2, 10];
/// Columns, rows and folds: one lane, lanes with one slot, slots that are empty, and all regions in
/// one lane.
const SERIAL_GRIDS: [(u32, u32, u32); 5] = [(2, 1, 1), (3, 2, 4), (1, 1, 1), (3, 1, 3), (5, 2, 3)];

/// Returns configurations of serial designs as TOML.
pub(crate) fn serial_matrix() -> Vec<String> {
    let mut list = Vec::new();
    for (index, features) in feature_lists(Organization::Serial).iter().enumerate() {
        for choice in 0..16 {
            let size = SERIAL_SIZES[(index * 5 + choice) % SERIAL_SIZES.len()];
            let depth = SERIAL_DEPTHS[(index + choice * 3) % SERIAL_DEPTHS.len()];
            let (columns, rows, fold) = SERIAL_GRIDS[(index * 2 + choice) % SERIAL_GRIDS.len()];
            let pick = |bit: usize, off: &'static str, on: &'static str| {
                if (choice >> bit) & 1 == 0 { off } else { on }
            };
            // Every third design shows means: all numbers of blocks, of every feature, with each
            // feed.
            let irrelevant = match (index + choice) % 3 {
                2 => "mean",
                _ => pick(index % 4, "zero", "hold"),
            };
            let periphery = match (choice % 4, irrelevant) {
                (1 | 2, "mean") => format!("[periphery]\nblocks = {}\n", most_blocks(size)),
                _ => String::new(),
            };
            let zones = zones_table((index + choice / 2) % 2 == 1, irrelevant == "mean", size);
            list.push(format!(
                "spatial = {features}\n\
                 [frame]\nwidth = {width}\nheight = {height}\npixel_bits = {depth}\n\
                 [region]\nsize = {size}\nneighborhood = '{neighborhood}'\n\
                 [denoise]\nfilter = '{filter}'\n\
                 [temporal]\nlevel = 0\nmin_count = 1\nreference = '{reference}'\n\
                 [render]\npayload = '{payload}'\nirrelevant = '{irrelevant}'\n\
                 [hardware]\norganization = 'serial'\nfold = {fold}\nfeed = '{feed}'\n\
                 pipelining = '{pipelining}'\nthresholds = '{thresholds}'\nsync = {sync}\n{periphery}{zones}",
                width = columns * size,
                height = rows * size,
                neighborhood = pick(0, "isolated", "shared"),
                filter = pick(1, WINDOW_FILTERS[(index + choice) % WINDOW_FILTERS.len()], "none"),
                reference = pick(2, "previous", "last-sent"),
                pipelining = PIPELINING[(index + choice.count_ones() as usize) % 2],
                sync = choice % 3 == 1,
                feed = pick(3, "parallel", "raster"),
                payload = pick((index + 1) % 4, "denoised", "raw"),
                thresholds = pick((index + 2) % 4, "runtime", "constant"),
            ));
        }
    }
    list
}

/// The sizes of regions of the raster organization, each with a number of pixels per word that
/// divides it.
const RASTER_SHAPES: [(u32, u32); 9] =
    [(8, 1), (4, 2), (2, 1), (8, 4), (3, 1), (16, 2), (5, 1), (64, 4), (6, 2)];
/// Rows of regions, and the pixels that the last column and row of regions lack.
const RASTER_GRIDS: [(u32, u32, u32); 5] = [(3, 0, 0), (1, 1, 0), (2, 0, 1), (4, 1, 1), (5, 1, 0)];

/// Returns configurations of raster designs as TOML, with the smallest width that is allowed.
pub(crate) fn raster_matrix() -> Vec<String> {
    let mut list = Vec::new();
    for (index, features) in feature_lists(Organization::Raster).iter().enumerate() {
        for choice in 0..16 {
            let (size, word) = RASTER_SHAPES[(index * 2 + choice) % RASTER_SHAPES.len()];
            let depth = SERIAL_DEPTHS[(index + choice * 3) % SERIAL_DEPTHS.len()];
            let (rows, beside, below) = RASTER_GRIDS[(index * 3 + choice) % RASTER_GRIDS.len()];
            let columns = (16 * word).div_ceil(size).max(4);
            let fits = |blocks: &u32| size.is_multiple_of(*blocks * word);
            let periphery = match [4, 2, 1].into_iter().find(fits) {
                Some(blocks) if choice % 3 == 2 => format!("[periphery]\nblocks = {blocks}\n"),
                _ => String::new(),
            };
            let pick = |bit: usize, off: &'static str, on: &'static str| {
                if (choice >> bit) & 1 == 0 { off } else { on }
            };
            let zones = zones_table((index + choice / 2) % 2 == 1, !periphery.is_empty(), size);
            list.push(format!(
                "spatial = {features}\n\
                 [frame]\nwidth = {width}\nheight = {height}\npixel_bits = {depth}\n\
                 [region]\nsize = {size}\nneighborhood = '{neighborhood}'\n\
                 [denoise]\nfilter = '{filter}'\n\
                 [temporal]\nlevel = 0\nmin_count = 1\nreference = '{reference}'\n\
                 [render]\npayload = '{payload}'\nirrelevant = '{irrelevant}'\n\
                 [hardware]\norganization = 'raster'\npixels_per_clock = {word}\n\
                 pipelining = '{pipelining}'\nstore = '{store}'\nthresholds = '{thresholds}'\nsync = {sync}\n{periphery}{zones}",
                width = columns * size - beside,
                height = rows * size - below,
                neighborhood = pick(0, "isolated", "shared"),
                filter = pick(1, WINDOW_FILTERS[(index + choice) % WINDOW_FILTERS.len()], "none"),
                reference = pick(2, "previous", "last-sent"),
                pipelining = pick(3, "plain", "deep"),
                payload = pick((index + 1) % 4, "denoised", "raw"),
                irrelevant = if periphery.is_empty() { pick(index % 4, "zero", "hold") } else { "mean" },
                thresholds = pick((index + 2) % 4, "runtime", "constant"),
                sync = choice % 3 == 1,
                store = pick((index + 3) % 4, "block", "ultra"),
            ));
        }
    }
    list
}

/// Raster designs with a large frame, or with choices that the matrix lacks: each branch of a
/// store, of rows that repeat, and of a core that forwards nothing.
pub(crate) const EXTRA_RASTER_DESIGNS: [&str; 19] = [
    "frame={width=320,height=240}\nhardware={organization='raster',pipelining='deep'}",
    "frame={width=320,height=240}\nhardware={organization='raster',pipelining='plain'}",
    "frame={width=320,height=240}\nhardware={organization='raster',pipelining='deep',store='ultra'}",
    "frame={width=320,height=240}\nhardware={organization='raster',pipelining='deep',store='single-port'}",
    "frame={width=320,height=240}\nhardware={organization='raster',pipelining='deep',store='external'}",
    "frame={width=320,height=240}\nhardware={organization='raster',pipelining='deep'}\ntemporal.reference='last-sent'",
    "frame={width=320,height=240}\nspatial=[{feature='mad'}]\ndenoise.filter='none'\n\
     hardware={organization='raster',pipelining='deep'}",
    "frame={width=320,height=240}\nspatial=[{feature='mad'}]\nhardware={organization='raster',pipelining='deep'}",
    "frame={width=128,height=128}\nhardware={organization='raster',pipelining='deep'}",
    "frame={width=136,height=128}\nhardware={organization='raster',pipelining='deep'}",
    "frame={width=64,height=21}\nhardware={organization='raster',forward=false}",
    "frame={width=64,height=21}\nspatial=[{feature='variance'}]\ndenoise.filter='none'\n\
     hardware={organization='raster',forward=false}",
    "frame={width=64,height=21}\nspatial=[{feature='mad'}]\nhardware={organization='raster',store='external',forward=false}",
    "frame={width=64,height=21}\nrender.payload='raw'\nhardware={organization='raster',store='single-port'}",
    "frame={width=64,height=21}\nspatial=[{feature='segment',mean_fraction_bits=3}]\ndenoise.filter='binomial3x3'\n\
     hardware={organization='raster'}",
    "frame={width=64,height=21}\nspatial=[{feature='segment'},{feature='mad'},{feature='variance'}]\n\
     hardware={organization='raster',pipelining='deep',pixels_per_clock=4}",
    "frame={width=64,height=21}\nspatial=[{feature='surface'}]\ndenoise.filter='switching3x3'\n\
     hardware={organization='raster',pixels_per_clock=4}",
    "frame={width=64,height=21,pixel_bits=1}\nspatial=[{feature='surface'},{feature='range'},{feature='corner'}]\n\
     denoise.filter='switching3x3'\ntemporal.level=0\nhardware={organization='raster',pipelining='deep'}",
    "frame={width=64,height=21}\nspatial=[{feature='surface'},{feature='segment'}]\ndenoise.filter='binomial3x3'\n\
     hardware={organization='raster',pipelining='deep',pixels_per_clock=4,forward=false}",
];

/// Returns the designs of the matrices of all organizations, and [`EXTRA_RASTER_DESIGNS`].
pub(crate) fn every_design() -> Vec<String> {
    let more = EXTRA_RASTER_DESIGNS.iter().map(|toml| (*toml).to_owned());
    [pipelined_matrix(), serial_matrix(), raster_matrix(), more.collect()].concat()
}

/// Returns the designs that cover the matrix of each organization, and the others.
pub(crate) fn covering_designs() -> Vec<String> {
    let matrices = [pipelined_matrix(), serial_matrix(), raster_matrix()];
    let more = EXTRA_RASTER_DESIGNS.iter().map(|toml| (*toml).to_owned());
    matrices.map(covering_values).concat().into_iter().chain(more).collect()
}

/// Returns raster designs on AXI: those of the matrix whose pixels leave, and one with an external
/// frame store.
pub(crate) fn every_design_on_a_bus() -> Vec<String> {
    let leaves = |toml: &String| design(toml).has_forwarding();
    let on_axi = |toml: String| toml.replacen("[hardware]\n", "[hardware]\ninterface = 'axi'\n", 1);
    let outside = "frame={width=64,height=21}\nhardware={organization='raster',store='external',interface='axi'}";
    let matrix = raster_matrix().into_iter().filter(leaves).map(on_axi);
    matrix.chain(std::iter::once(outside.to_owned())).collect()
}

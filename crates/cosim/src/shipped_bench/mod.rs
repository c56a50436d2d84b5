// SPDX-License-Identifier: MIT OR Apache-2.0
//! The benches that come with a generated core: one of `rpu` and one of `rcm`, each with vectors
//! that contain active, held and blank regions.
//!
//! An array of copies of `rpu` is replayed as a small grid of copies, any other array whole.
//! The [`script`] chooses frames that lead to active, held and blank regions under the thresholds
//! of the design. The [`tally`] counts what the vectors contain, and a bench whose vectors miss
//! something never prints `PASS`.

mod drawn_region;
mod player;
mod script;
mod tally;

use crate::error::CosimError;
use crate::harness::{annotated_bench, bench_file};
use crate::level::CosimLevel;
use foveate_design::{ArrayStructure, Design, Port};
use foveate_emit::{Prefix, SourceFile, Top};
use player::{ScriptPlayer, VectorRecorder};
use script::{BenchScript, MIN_FRAMES_PER_SCRIPT};
use std::sync::atomic::AtomicBool;

pub use tally::{RegionLosses, VectorTally};

/// The largest number of clocks of vectors. Verilator needs a quarter of an hour for them.
const MAX_CLOCKS: u64 = 1 << 31;
/// The largest number of decisions in vectors; each decision takes a few lines.
const MAX_DECISIONS: u64 = 1 << 18;

/// The bench of one module of a core, with a count of what its vectors contain.
#[derive(Clone, Debug)]
pub struct ShippedBench {
    /// The module that the bench tests.
    pub top: Top,
    /// The columns and rows of regions: the core's own grid, or a smaller one.
    pub grid: (u32, u32),
    /// The counts of what the vectors contain.
    pub tally: VectorTally,
    /// The number of clocks of the vectors.
    pub clocks: u64,
    /// The content that the vectors should have and lack, in words; the bench then never prints
    /// `PASS`.
    pub shortcoming: Option<String>,
    /// The content that no vectors of this design can have because of its configuration, in words.
    pub remarks: Vec<String>,
    /// The bench and its vectors; the paths are relative to the folder of the core.
    pub files: [SourceFile; 2],
}

impl ShippedBench {
    /// Returns the levels that the benches of a core simulate together.
    ///
    /// # Errors
    /// Fails if no small grid can stand for the grid of the design.
    pub fn levels(design: &Design) -> Result<Vec<CosimLevel>, CosimError> {
        let array = drawn_region::bench_design(design, Top::Rcm)?;
        let (columns, rows) = (array.columns(), array.rows());
        let array = CosimLevel::Rcm { columns, rows };
        let array = if array.is_whole(design) { CosimLevel::Full } else { array };
        let level = |top: &Top| match top {
            Top::Rpu => CosimLevel::Rpu,
            Top::Rcm => array,
        };
        Ok(Top::all_of(design).iter().map(level).collect())
    }

    /// Plays the frames of the script to the model of `top`, and makes a bench for a core whose
    /// module names begin with `prefix`. Equal designs give equal files.
    ///
    /// # Errors
    /// Fails if the model refuses the design's grid, or if `cancel` is set;
    /// [`CosimError::is_interrupted`] tells the two apart.
    pub fn new(
        design: &Design,
        top: Top,
        prefix: &Prefix,
        cancel: &AtomicBool,
    ) -> Result<Self, CosimError> {
        let module = prefix.prefixed_name(top.module());
        let part = drawn_region::bench_design(design, top)?;
        let ports = top.ports(&part);
        let mut take = BenchVectors::record(&part, top, &ports, false, cancel)?;
        if take.is_played && take.tally.shortcoming(&part).is_some() {
            take = BenchVectors::record(&part, top, &ports, true, cancel)?;
        }
        let BenchVectors { tally, clocks, vectors, is_played } = take;
        let remarks = tally::impossible_region_remarks(&part);
        let grid = |of: &Design| (of.columns(), of.rows());
        let is_left_out = top == Top::Rcm
            && match design.unit().array {
                ArrayStructure::RpuCopies => false,
                ArrayStructure::SharedLogic => grid(&part) != grid(design),
            };
        let shortcoming = if is_played && is_left_out {
            Some(format!(
                "{} lanes are too many for a bench, and these vectors are for {} x {} regions of {} x {}",
                design.unit().count,
                part.columns(),
                part.rows(),
                design.columns(),
                design.rows()
            ))
        } else if is_played {
            tally.shortcoming(&part)
        } else {
            Some(format!(
                "a frame of {} regions takes {} clocks, which is too long for vectors",
                part.regions(),
                part.timing().clocks_per_frame()
            ))
        };
        let mut about = tally.description_lines(design, &part, top);
        about.extend(remarks.iter().cloned());
        let parameters = top.parameters(&part);
        let bench = annotated_bench(&module, &ports, &parameters, &about, shortcoming.as_deref());
        let file = |name: String, contents| SourceFile { path: format!("tb/{name}"), contents };
        Ok(Self {
            top,
            grid: (part.columns(), part.rows()),
            tally,
            clocks,
            shortcoming,
            remarks,
            files: [
                file(bench_file(&module), bench),
                file(format!("{module}_vectors.hex"), vectors),
            ],
        })
    }
}

/// The vectors, with a count of what they contain.
struct BenchVectors {
    tally: VectorTally,
    clocks: u64,
    vectors: String,
    /// False if the vectors would be too long and are left out.
    is_played: bool,
}

impl BenchVectors {
    fn record(
        part: &Design,
        top: Top,
        ports: &[Port],
        is_wide: bool,
        cancel: &AtomicBool,
    ) -> Result<Self, CosimError> {
        let mut tape = VectorRecorder::new(part, top, ports);
        let is_played = is_short(part);
        if is_played {
            let script = BenchScript::for_design(part, is_wide);
            ScriptPlayer::new(part, top, &mut tape, cancel).play(&script)?;
        }
        let (tally, clocks, vectors) = tape.finish()?;
        Ok(Self { tally, clocks, vectors, is_played })
    }
}

/// Returns true if the frames of a bench take few enough clocks and lines.
fn is_short(part: &Design) -> bool {
    let clocks = MIN_FRAMES_PER_SCRIPT.saturating_mul(part.timing().clocks_per_frame());
    clocks <= MAX_CLOCKS && MIN_FRAMES_PER_SCRIPT * u64::from(part.regions()) <= MAX_DECISIONS
}

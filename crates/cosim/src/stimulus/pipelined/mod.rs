// SPDX-License-Identifier: MIT OR Apache-2.0
//! Vectors for one pipelined RPU, or for an array of them: pixels at every clock or with gaps, thresholds
//! that change between frames.

mod driver;
mod machine;
mod session;

use super::random::Random;
use super::run::Run;
use crate::error::CosimError;
use crate::level::Level;
use driver::Driver;
use foveate_design::{PipelinedDesign, PipelinedTiming};
use foveate_model::{PipelinedRcm, PipelinedRpu};
pub(crate) use machine::Machine;
pub use machine::PipelinedCodec;
use session::Session;

pub(super) fn record(simulated: PipelinedDesign<'_>, run: Run<'_>) -> Result<(), CosimError> {
    let Run { level, seed, extent, frames, recorder, cancel, progress, .. } = run;
    let mut random = Random::new(seed);
    let (machine, lanes) = match level {
        Level::Rpu => (Machine::Rpu(Box::new(PipelinedRpu::new(simulated))), 1),
        Level::Rcm { .. } | Level::Full => {
            (Machine::Rcm(PipelinedRcm::new(simulated)), simulated.regions())
        }
    };
    let driver = Driver::new(simulated, machine, lanes as usize, recorder, random.fork(), cancel);
    let timing = PipelinedTiming::of(simulated);
    Session::new(simulated, timing, level, driver, random).run(extent, frames, progress)
}

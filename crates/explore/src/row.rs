// SPDX-License-Identifier: MIT OR Apache-2.0
//! A point with all its figures.

use foveate_camera::Camera;
use foveate_design::{Config, Design};
use foveate_estimate::Speed;
use foveate_fidelity::{ErrorTally, Figures};
use serde::Serialize;

use crate::cost::{Silicon, Synthesized};
use crate::measure::Measured;

/// A design with its errors, costs and speed.
#[derive(Clone, Debug, Serialize)]
pub struct DesignRow {
    /// Its number, from 1, in the order of the space.
    pub number: usize,
    /// The value of every axis, a string without quotes; empty if it is the value of the start.
    pub settings: Vec<String>,
    /// The configuration, with every default filled in.
    #[serde(skip)]
    pub config: Config,
    /// The fingerprint, which identifies the design.
    pub fingerprint: String,
    /// Errors over all clips.
    pub figures: Figures,
    /// Bytes per frame that leave the array: 2 bits per region, and the pixels of active regions.
    pub bytes_per_frame: f64,
    /// Clocks from one frame to the next.
    pub clocks_per_frame: u64,
    /// Its clock and frames per second: at the clock of the space, else at that which is estimated from its
    /// netlist; none without a synthesis.
    pub speed: Option<Speed>,
    /// Area, if it was asked for.
    pub silicon: Option<Silicon>,
    /// The fronts that it is on.
    pub front: Fronts,
}

/// Which fronts a point is on.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize)]
pub struct Fronts {
    /// Of error and speed.
    pub speed: bool,
    /// Of error and LUTs of the array.
    pub area: bool,
    /// Of error, speed and LUTs of the array; without areas, as `speed`.
    pub all: bool,
}

impl DesignRow {
    pub(crate) fn new(
        number: usize,
        settings: Vec<String>,
        design: &Design,
        measured: &[&Measured],
        synthesized: Option<Synthesized>,
        clock_mhz: Option<u32>,
    ) -> Option<Self> {
        let figures = together(measured)?.figures();
        let clocks_per_frame = design.timing().clocks_per_frame();
        let given = clock_mhz.map(|mhz| Speed::given(mhz.into(), clocks_per_frame));
        let estimated = synthesized.as_ref().and_then(|synthesized| synthesized.speed);
        Some(Self {
            number,
            settings,
            config: design.config(),
            fingerprint: design.fingerprint(),
            bytes_per_frame: bytes_per_frame(design, &figures),
            clocks_per_frame,
            speed: given.or(estimated),
            silicon: synthesized.map(|synthesized| synthesized.silicon),
            figures,
            front: Fronts::default(),
        })
    }

    /// LUTs of the array, those used as memory included, two SRL16 in one.
    pub(crate) fn luts(&self) -> Option<f64> {
        self.silicon.as_ref().map(|silicon| real(silicon.array.lut_total_packed))
    }
}

/// The sums of several clips; none of none.
pub(crate) fn together(measured: &[&Measured]) -> Option<ErrorTally> {
    let mut tallies = measured.iter().map(|part| &part.tally);
    let mut all = tallies.next()?.clone();
    tallies.for_each(|tally| all.merge(tally));
    Some(all)
}

/// As `simulate` counts: the two bits of every region say what becomes of it, so no addresses are sent.
pub(crate) fn bytes_per_frame(camera: &Camera, figures: &Figures) -> f64 {
    let regions = f64::from(camera.regions());
    let pixels = f64::from(camera.width()) * f64::from(camera.height()) * figures.active;
    let means = camera.periphery().map_or(0.0, |own| f64::from(own.means()));
    let values = pixels + regions * figures.summarized * means;
    (2.0 * regions + values * f64::from(camera.pixel_bits())) / 8.0
}

/// A count as a number to calculate with.
#[allow(clippy::cast_precision_loss, reason = "exact up to 2^53")]
pub(crate) fn real(count: u64) -> f64 {
    count as f64
}

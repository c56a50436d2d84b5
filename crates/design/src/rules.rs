// SPDX-License-Identifier: MIT OR Apache-2.0
//! The questions that every organization answers; [`crate::organization`] asks them.

use crate::{Design, Feed, HardwareConfig, MemoryKind, Port, Timing};
use foveate_camera::{Camera, ConfigError};

/// The unit that an array repeats: an RPU, a lane; or the one core.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Unit {
    /// What people call one.
    pub name: &'static str,
    /// Its Verilog module.
    pub module: &'static str,
    /// How many the array has.
    pub count: u32,
    /// Regions that one serves, the last perhaps fewer.
    pub regions: u32,
    /// Whether the array `rcm` instantiates the module `rpu`. If not, `rpu` is an array of its own, with
    /// one unit.
    pub rpu_in_rcm: bool,
    /// The Verilog module whose instances say where the area goes.
    pub split: &'static str,
}

/// What an organization answers.
pub(crate) trait Rules {
    /// The unit of a design.
    fn unit(&self, design: &Design) -> Unit;
    /// What people call a unit.
    fn unit_name(&self) -> &'static str;
    /// How pixels may enter, the default first; none where there is no choice.
    fn feeds(&self) -> &'static [Feed];
    /// Of what the memory of a unit may be built, `hardware.memory`; none where there is no choice.
    fn memories(&self) -> &'static [MemoryKind];
    /// Whether regions may share a unit, `hardware.fold`.
    fn folds(&self) -> bool;
    /// `[hardware]` of such a camera, its keys filled in. [`HardwareConfig::refuse_raster_keys`] is for all
    /// but the raster organization.
    fn hardware(
        &self,
        asked: &HardwareConfig,
        camera: &Camera,
    ) -> Result<HardwareConfig, ConfigError>;
    /// The design whose ports module `rpu` has.
    fn lone_unit(&self, design: &Design) -> Design;
    /// When a design says what.
    fn timing(&self, design: &Design) -> Timing;
    /// The ports of module `rpu`, inputs first.
    fn rpu_ports(&self, design: &Design) -> Vec<Port>;
    /// The ports of module `rcm`, inputs first.
    fn rcm_ports(&self, design: &Design) -> Vec<Port>;
}

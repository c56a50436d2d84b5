// SPDX-License-Identifier: MIT OR Apache-2.0
//! What the organizations have in common, and where they differ. Each implements
//! [`OrganizationRules`] in its own module, and the methods of `Design` here return the unit,
//! the timing and the ports by these rules. [`check_support`] refuses by name what an
//! organization does not support. A new organization, or a new value of a key, does not compile
//! until it is entered here.

use crate::{
    CoreInterface, Design, DesignTiming, FeatureHardware, Hardware, HardwareConfig, Organization,
    Port, ThresholdSource,
};
use Organization::{Pipelined, Raster, Serial};
use foveate_camera::{
    Camera, ConfigError, DenoiseFilter, FeatureKind, IrrelevantRendering, ReferencePolicy,
};

impl Organization {
    /// Returns the name of one unit of the array, such as "RPU".
    #[must_use]
    pub fn unit_name(self) -> &'static str {
        match self {
            Self::Pipelined => "RPU",
            Self::Serial => "lane",
            Self::Raster => "core",
        }
    }

    /// Returns true if regions can share a unit, so that `hardware.fold` may be more than 1.
    #[must_use]
    pub fn has_folding(self) -> bool {
        match self {
            Self::Serial => true,
            Self::Pipelined | Self::Raster => false,
        }
    }
}

impl Design {
    /// Returns the unit that the array repeats.
    #[must_use]
    pub fn unit(&self) -> ArrayUnit {
        self.rules().unit()
    }

    /// Returns the design that module `rpu` belongs to: this design if the RPU is a part of its
    /// array, else the design of an array with one unit, whose frame may be wider than a
    /// configuration allows.
    #[must_use]
    pub fn lone_unit(&self) -> Self {
        self.rules().lone_unit()
    }

    /// Returns the timing of the design.
    #[must_use]
    pub fn timing(&self) -> DesignTiming {
        self.rules().timing()
    }

    /// Returns the interface of module `rpu`.
    #[must_use]
    pub fn rpu_interface(&self) -> CoreInterface {
        self.rules().rpu_interface()
    }

    /// Returns the interface of module `rcm`.
    #[must_use]
    pub fn rcm_interface(&self) -> CoreInterface {
        self.rules().rcm_interface()
    }

    /// Returns the ports of module `rpu`, inputs first.
    #[must_use]
    pub fn rpu_ports(&self) -> Vec<Port> {
        self.rpu_interface().ports()
    }

    /// Returns the ports of module `rcm`, inputs first.
    #[must_use]
    pub fn rcm_ports(&self) -> Vec<Port> {
        self.rcm_interface().ports()
    }

    /// Returns the implementation of the organization of this design.
    fn rules(&self) -> Box<dyn OrganizationRules + '_> {
        match self.hardware() {
            Hardware::Pipelined(own) => Box::new(self.with_hardware(own)),
            Hardware::Serial(own) => Box::new(self.with_hardware(own)),
            Hardware::Raster(own) => Box::new(self.with_hardware(own)),
        }
    }
}

/// The structure of an array.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ArrayStructure {
    /// The array consists of copies of module `rpu` and nothing else. The size of the array is only
    /// the number of copies, and no copy depends on it.
    RpuCopies,
    /// The array has units that share logic, or is one core. Widths, memories and counters depend
    /// on its size. Module `rpu` is not a part of it, but an array of its own with one unit.
    SharedLogic,
}

/// The unit that an array repeats: an RPU, a lane, or the one core.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ArrayUnit {
    /// Name of one unit for users.
    pub name: &'static str,
    /// Verilog module of the unit.
    pub module: &'static str,
    /// Number of units of the array.
    pub count: u32,
    /// Number of regions that one unit serves. The last unit may serve fewer.
    pub regions: u32,
    /// Structure of the array.
    pub array: ArrayStructure,
    /// Verilog module whose instances the area is reported for.
    pub area_module: &'static str,
}

/// The properties of a [`crate::DesignWithHardware`] the hardware of one organization.
pub(crate) trait OrganizationRules {
    /// Returns the unit that the array repeats.
    fn unit(&self) -> ArrayUnit;
    /// Returns the design that module `rpu` belongs to.
    fn lone_unit(&self) -> Design;
    fn timing(&self) -> DesignTiming;
    /// Returns the interface of module `rpu`. Where the RPU is not a part of the array, it is that
    /// of an array with one unit.
    fn rpu_interface(&self) -> CoreInterface {
        self.lone_unit().rcm_interface()
    }
    /// Returns the interface of module `rcm`.
    fn rcm_interface(&self) -> CoreInterface;
}

/// Refuses the parts of a camera, and the keys that every organization has, that the organization
/// does not support.
pub(crate) fn check_support(hardware: &HardwareConfig, camera: &Camera) -> Result<(), ConfigError> {
    let organization = hardware.organization.kind();
    let quoted = |name: &str| format!("\"{name}\"");
    for (index, feature) in camera.features().iter().enumerate() {
        let (key, kind) = (format!("spatial[{index}].feature"), feature.kind());
        refuse_unless(organization, &key, quoted(kind.name()), |one| supports_feature(one, kind))?;
    }
    let filter = camera.filter();
    refuse_unless(organization, "denoise.filter", quoted(filter.name()), |one| {
        supports_filter(one, filter)
    })?;
    let reference = camera.temporal().reference;
    refuse_unless(organization, "temporal.reference", quoted(reference.name()), |one| {
        supports_reference(one, reference)
    })?;
    let irrelevant = camera.irrelevant();
    refuse_unless(organization, "render.irrelevant", quoted(irrelevant.name()), |one| {
        supports_rendering(one, irrelevant)
    })?;
    let thresholds = hardware.thresholds;
    refuse_unless(organization, "hardware.thresholds", quoted(thresholds.name()), |one| {
        supports_thresholds(one, thresholds)
    })?;
    let sync = hardware.sync;
    refuse_unless(organization, "hardware.sync", sync.to_string(), |one| supports_sync(one, sync))
}

impl Organization {
    /// Returns the features whose scores the organization computes.
    #[must_use]
    pub fn feature_kinds(self) -> Vec<FeatureKind> {
        FeatureKind::ALL.iter().copied().filter(|&kind| supports_feature(self, kind)).collect()
    }
}

fn supports_feature(organization: Organization, kind: FeatureKind) -> bool {
    FeatureHardware::of_kind(kind).is_in(organization)
}

fn supports_filter(organization: Organization, filter: DenoiseFilter) -> bool {
    use DenoiseFilter::{Binomial3x3, Median3x3, None, Switching3x3};
    match (organization, filter) {
        (Pipelined | Serial | Raster, None | Median3x3 | Switching3x3 | Binomial3x3) => true,
    }
}

/// Returns true if the organization can store the reference.
fn supports_reference(organization: Organization, reference: ReferencePolicy) -> bool {
    use ReferencePolicy::{LastSent, Previous};
    match (organization, reference) {
        (Pipelined | Serial | Raster, Previous | LastSent) => true,
    }
}

/// Returns true if the organization can render irrelevant regions in this way.
fn supports_rendering(organization: Organization, irrelevant: IrrelevantRendering) -> bool {
    use IrrelevantRendering::{Hold, Mean, Zero};
    match (organization, irrelevant) {
        (Pipelined | Serial | Raster, Zero | Hold | Mean) => true,
    }
}

fn supports_thresholds(organization: Organization, thresholds: ThresholdSource) -> bool {
    use ThresholdSource::{Constant, Runtime};
    match (organization, thresholds) {
        (Pipelined | Serial | Raster, Runtime | Constant) => true,
    }
}

/// Returns true if the organization can have, or be without, an input for the start of a frame.
fn supports_sync(organization: Organization, sync: bool) -> bool {
    match (organization, sync) {
        (Pipelined | Serial | Raster, true | false) => true,
    }
}

/// Refuses the value of a key unless the organization supports it. The message lists the
/// organizations that do.
fn refuse_unless(
    organization: Organization,
    key: &str,
    value: String,
    supports: impl Fn(Organization) -> bool,
) -> Result<(), ConfigError> {
    if supports(organization) {
        return Ok(());
    }
    let others = Organization::ALL.iter().filter(|&&other| supports(other));
    let others: Vec<_> = others.map(|other| format!("\"{other}\"")).collect();
    let remedy = format!("use another value, or organization = {}", others.join(" or "));
    Err(organization.combination_error(key, value, &remedy))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::DesignConfig;
    use foveate_camera::SpatialConfig;

    #[test]
    fn an_unsupported_value_is_refused_by_name_with_the_organizations_that_support_it() {
        let refuse = |supported: &[Organization]| {
            let (key, value) = ("spatial[1].feature", "\"mad\"".to_owned());
            refuse_unless(Raster, key, value, |one| supported.contains(&one))
                .map_err(|error| error.to_string())
        };
        assert_eq!(refuse(&[Raster]), Ok(()));
        let start = "`spatial[1].feature` = \"mad\" cannot be combined with organization = \
                     \"raster\"; use another value, or organization = ";
        assert_eq!(refuse(&[Serial]), Err(format!("{start}\"serial\"")));
        let both = format!("{start}\"pipelined\" or \"serial\"");
        assert_eq!(refuse(&[Serial, Pipelined]), Err(both));
    }

    /// Searches and studies try every reference and rendering without asking first, and all
    /// features of the organization.
    #[test]
    fn every_organization_supports_every_camera_with_its_features() {
        for &organization in Organization::ALL {
            for &reference in ReferencePolicy::ALL {
                for &irrelevant in IrrelevantRendering::ALL {
                    let mut config = DesignConfig::default();
                    config.hardware.organization = organization.into();
                    config.camera.temporal.reference = reference;
                    config.camera.render.irrelevant = irrelevant;
                    let entries = organization.feature_kinds().into_iter().map(SpatialConfig::new);
                    config.camera.spatial = entries.collect();
                    config.validate().unwrap();
                }
            }
        }
    }
}

// SPDX-License-Identifier: MIT OR Apache-2.0
//! The features, filters, references, renderings and sources of thresholds that each organization
//! supports. A new organization, or a new value of one of these keys, does not compile until it
//! is entered here. A value that the organization does not support is refused by name.

use crate::{HardwareConfig, Organization, ThresholdSource};
use foveate_camera::{
    Camera, ConfigError, DenoiseFilter, FeatureKind, IrrelevantRendering, ReferencePolicy,
};

use Organization::{Pipelined, Raster, Serial};

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

/// Returns true if the organization computes the score of the feature.
fn supports_feature(organization: Organization, kind: FeatureKind) -> bool {
    use FeatureKind::{Corner, Edge, Flow, Mad, Range, Segment, Surface, Variance};
    match (organization, kind) {
        (
            Pipelined | Serial | Raster,
            Edge | Corner | Mad | Variance | Range | Surface | Segment,
        )
        | (Serial, Flow) => true,
        // A search in the reference would multiply the size of the RPU or of the core.
        (Pipelined | Raster, Flow) => false,
    }
}

/// Returns true if the organization has the filter.
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

/// Returns true if the organization can have thresholds from this source.
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

    /// Searches and studies try every reference and rendering without asking first, and all features
    /// of the organization.
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

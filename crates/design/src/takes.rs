// SPDX-License-Identifier: MIT OR Apache-2.0
//! The configurations that an organization supports. Each organization must answer for every
//! feature and every reference, so that a new one is refused by the organizations that do not
//! compute it yet.

use crate::{HardwareConfig, ThresholdSource};
use foveate_camera::{
    Camera, CameraConfig, ConfigError, FeatureKind, IrrelevantRendering, ReferencePolicy,
};

/// The configurations that an organization supports. The trait is implemented by the properties of
/// the organization.
pub(crate) trait Takes: Sized {
    /// Returns true if the organization computes the score of the feature.
    fn takes_feature(kind: FeatureKind) -> bool;
    /// Returns true if the organization can store the reference.
    fn takes_reference(reference: ReferencePolicy) -> bool;
    /// Returns true if the organization can render irrelevant regions in this way.
    fn takes_irrelevant(irrelevant: IrrelevantRendering) -> bool;
    /// Returns true if the organization supports this source of thresholds.
    fn takes_thresholds(thresholds: ThresholdSource) -> bool;
    /// Returns true if the organization supports `hardware.sync`: an input for the start of a
    /// frame, at which it finds its frames again.
    fn takes_sync() -> bool;
    /// Returns the properties of the organization, or an error if it refuses the rest of the
    /// configuration.
    fn validate(asked: &HardwareConfig, camera: &Camera) -> Result<Self, ConfigError>;
}

/// The features, references and renderings that an organization supports.
pub(crate) struct Taken {
    pub(crate) feature: fn(FeatureKind) -> bool,
    pub(crate) reference: fn(ReferencePolicy) -> bool,
    irrelevant: fn(IrrelevantRendering) -> bool,
}

impl Taken {
    pub(crate) fn by<O: Takes>() -> Self {
        Self {
            feature: O::takes_feature,
            reference: O::takes_reference,
            irrelevant: O::takes_irrelevant,
        }
    }

    /// Returns true if the organization supports all of the camera.
    pub(crate) fn takes(&self, camera: &CameraConfig) -> bool {
        camera.spatial.iter().all(|entry| (self.feature)(entry.feature))
            && (self.reference)(camera.temporal.reference)
            && (self.irrelevant)(camera.render.irrelevant)
    }
}

/// Returns the properties of the organization, or an error if it refuses a part of the
/// configuration.
pub(crate) fn taken<O: Takes>(asked: &HardwareConfig, camera: &Camera) -> Result<O, ConfigError> {
    let refuse = |key: &str, value: &str, remedy: &str| {
        let remedy = format!("{remedy}, or another organization");
        Err(asked.combination_error(key, format!("\"{value}\""), &remedy))
    };
    for (index, feature) in camera.features().iter().enumerate() {
        let kind = feature.kind();
        if !O::takes_feature(kind) {
            return refuse(
                &format!("spatial[{index}].feature"),
                kind.name(),
                "use another feature",
            );
        }
    }
    let reference = camera.temporal().reference;
    if !O::takes_reference(reference) {
        return refuse("temporal.reference", reference.name(), "use another reference");
    }
    let irrelevant = camera.irrelevant();
    if !O::takes_irrelevant(irrelevant) {
        return refuse("render.irrelevant", irrelevant.name(), "show something else");
    }
    if !O::takes_thresholds(asked.thresholds) {
        return refuse("hardware.thresholds", asked.thresholds.name(), "use other thresholds");
    }
    if asked.sync == Some(true) && !O::takes_sync() {
        let remedy = "leave the key out, or use another organization";
        return Err(asked.combination_error("hardware.sync", true.to_string(), remedy));
    }
    asked.refuse_foreign_keys()?;
    O::validate(asked, camera)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::DesignConfig;

    /// An organization that supports only a few configurations.
    #[derive(Debug, PartialEq)]
    struct NarrowOrganization;

    impl Takes for NarrowOrganization {
        fn takes_feature(kind: FeatureKind) -> bool {
            kind.has_window()
        }

        fn takes_reference(reference: ReferencePolicy) -> bool {
            reference == ReferencePolicy::Previous
        }

        fn takes_irrelevant(irrelevant: IrrelevantRendering) -> bool {
            irrelevant == IrrelevantRendering::Hold
        }

        fn takes_thresholds(thresholds: ThresholdSource) -> bool {
            thresholds == ThresholdSource::Runtime
        }

        fn takes_sync() -> bool {
            false
        }

        fn validate(_: &HardwareConfig, _: &Camera) -> Result<Self, ConfigError> {
            Ok(Self)
        }
    }

    fn asked(text: &str) -> Result<NarrowOrganization, String> {
        let config = DesignConfig::from_toml(text).unwrap();
        let camera = config.camera.validate().unwrap();
        taken(&config.hardware, &camera).map_err(|error| error.to_string())
    }

    #[test]
    fn a_camera_is_taken_if_all_of_it_is() {
        let config = DesignConfig::from_toml("[render]\nirrelevant = \"hold\"\n").unwrap().camera;
        let taken = |config: &CameraConfig| Taken::by::<NarrowOrganization>().takes(config);
        let with = |change: &dyn Fn(&mut CameraConfig)| {
            let mut other = config.clone();
            change(&mut other);
            other
        };
        assert!(taken(&config));
        let mad = with(&|config| config.spatial[0].feature = FeatureKind::Mad);
        let sent = with(&|config| config.temporal.reference = ReferencePolicy::LastSent);
        let zero = with(&|config| config.render.irrelevant = IrrelevantRendering::Zero);
        for other in [mad, sent, zero] {
            assert!(!taken(&other), "{}", other.to_toml());
            assert!(crate::is_taken(&other), "{}", other.to_toml());
        }
    }

    #[test]
    fn what_an_organization_does_not_take_is_refused_by_name() {
        let held = "[render]\nirrelevant = \"hold\"\n";
        let previous = format!("{held}[temporal]\nreference = \"previous\"\n");
        let refusal = |more: &str| asked(&format!("{more}{previous}")).unwrap_err();
        let features = "[[spatial]]\nfeature = \"edge\"\n[[spatial]]\nfeature = \"mad\"\n";
        assert_eq!(asked(&previous), Ok(NarrowOrganization));
        for (text, key, value) in [
            (refusal(features), "spatial[1].feature", "mad"),
            (refusal("[hardware]\nthresholds = \"constant\"\n"), "hardware.thresholds", "constant"),
            (refusal("[hardware]\nsync = true\n"), "hardware.sync", "true"),
            (asked("").unwrap_err(), "render.irrelevant", "zero"),
            (
                asked("[temporal]\nreference = \"last-sent\"\n").unwrap_err(),
                "temporal.reference",
                "last-sent",
            ),
        ] {
            assert!(text.contains(key) && text.contains(value), "{text}");
            assert!(text.contains("organization = \"pipelined\""), "{text}");
        }
        assert_eq!(asked(&format!("[hardware]\nsync = false\n{previous}")), Ok(NarrowOrganization));
    }
}

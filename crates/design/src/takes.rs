// SPDX-License-Identifier: MIT OR Apache-2.0
//! What an organization takes of a configuration. Each is asked for every feature and every reference, so that a new
//! one is computed by those that say so, and refused by the others.

use crate::{HardwareConfig, Thresholds};
use foveate_camera::{Camera, CameraConfig, ConfigError, FeatureKind, Irrelevant, Reference};

/// What an organization says of a configuration; it is implemented by what only that organization has.
pub(crate) trait Takes: Sized {
    /// Whether it computes the score of a feature.
    fn takes_feature(kind: FeatureKind) -> bool;
    /// Whether it keeps such a reference.
    fn takes_reference(reference: Reference) -> bool;
    /// Whether it can show that of irrelevant regions.
    fn takes_irrelevant(irrelevant: Irrelevant) -> bool;
    /// Whether its thresholds may come from there.
    fn takes_thresholds(thresholds: Thresholds) -> bool;
    /// Whether it can be told where frames start, and find them again: `hardware.sync`.
    fn takes_sync() -> bool;
    /// What only it has, if it takes the rest of what is asked for.
    fn validate(asked: &HardwareConfig, camera: &Camera) -> Result<Self, ConfigError>;
}

/// What an organization says of features, references and what irrelevant regions show.
pub(crate) struct Taken {
    pub(crate) feature: fn(FeatureKind) -> bool,
    pub(crate) reference: fn(Reference) -> bool,
    irrelevant: fn(Irrelevant) -> bool,
}

impl Taken {
    pub(crate) fn by<O: Takes>() -> Self {
        Self {
            feature: O::takes_feature,
            reference: O::takes_reference,
            irrelevant: O::takes_irrelevant,
        }
    }

    /// Whether that is all of a camera.
    pub(crate) fn takes(&self, camera: &CameraConfig) -> bool {
        camera.spatial.iter().all(|entry| (self.feature)(entry.feature))
            && (self.reference)(camera.temporal.reference)
            && (self.irrelevant)(camera.render.irrelevant)
    }
}

/// What is asked for, if the organization takes all of it.
pub(crate) fn taken<O: Takes>(asked: &HardwareConfig, camera: &Camera) -> Result<O, ConfigError> {
    let refuse = |key: &str, value: &str, remedy: &str| {
        let remedy = format!("{remedy}, or another organization");
        Err(asked.clash(key, format!("\"{value}\""), &remedy))
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
        return Err(asked.clash("hardware.sync", true.to_string(), remedy));
    }
    asked.refuse_foreign_keys()?;
    O::validate(asked, camera)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Config;

    /// An organization that takes little.
    #[derive(Debug, PartialEq)]
    struct Narrow;

    impl Takes for Narrow {
        fn takes_feature(kind: FeatureKind) -> bool {
            kind.has_window()
        }

        fn takes_reference(reference: Reference) -> bool {
            reference == Reference::Previous
        }

        fn takes_irrelevant(irrelevant: Irrelevant) -> bool {
            irrelevant == Irrelevant::Hold
        }

        fn takes_thresholds(thresholds: Thresholds) -> bool {
            thresholds == Thresholds::Runtime
        }

        fn takes_sync() -> bool {
            false
        }

        fn validate(_: &HardwareConfig, _: &Camera) -> Result<Self, ConfigError> {
            Ok(Self)
        }
    }

    fn asked(text: &str) -> Result<Narrow, String> {
        let config = Config::from_toml(text).unwrap();
        let camera = config.camera.validate().unwrap();
        taken(&config.hardware, &camera).map_err(|error| error.to_string())
    }

    #[test]
    fn a_camera_is_taken_if_all_of_it_is() {
        let config = Config::from_toml("[render]\nirrelevant = \"hold\"\n").unwrap().camera;
        let taken = |config: &CameraConfig| Taken::by::<Narrow>().takes(config);
        let with = |change: &dyn Fn(&mut CameraConfig)| {
            let mut other = config.clone();
            change(&mut other);
            other
        };
        assert!(taken(&config));
        let mad = with(&|config| config.spatial[0].feature = FeatureKind::Mad);
        let sent = with(&|config| config.temporal.reference = Reference::LastSent);
        let zero = with(&|config| config.render.irrelevant = Irrelevant::Zero);
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
        assert_eq!(asked(&previous), Ok(Narrow));
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
        assert_eq!(asked(&format!("[hardware]\nsync = false\n{previous}")), Ok(Narrow));
    }
}

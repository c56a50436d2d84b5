// SPDX-License-Identifier: MIT OR Apache-2.0
//! Where the values of a feature are, among those of all features of a design.

use foveate_design::{Design, FeatureKind};

/// The features of a design in their order.
#[derive(Clone, Debug)]
pub(crate) struct Kinds(Vec<FeatureKind>);

impl Kinds {
    pub(crate) fn of(design: &Design) -> Self {
        Self(design.features().iter().map(|feature| feature.kind()).collect())
    }

    pub(crate) fn index(&self, kind: FeatureKind) -> usize {
        let place = self.0.iter().position(|&own| own == kind);
        place.expect("a port is of a feature of the design")
    }
}

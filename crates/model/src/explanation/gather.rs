// SPDX-License-Identifier: MIT OR Apache-2.0
//! The construction of an explanation from the outcome of a frame. The hits of single pixels come
//! from the arithmetic of the model.

use std::cmp::Ordering;

use foveate_camera::{
    Camera, ClassThresholds, Displacement, FeatureKind, IrrelevantRendering, Periphery,
    RegionAction, SpatialFeature,
};
use foveate_design::Design;
use foveate_pixels::Frame;

use super::{
    DifferenceSum, DisplacementExplanation, FrameIdentification, ReferenceDifferences,
    RegionExplanation, RegionPosition, SegmentParts, SpatialExplanation, SquareRows,
    SummaryExplanation, TemporalExplanation,
};
use crate::conversions::index;
use crate::feature::flow::{DisplacedError, displaced_errors};
use crate::feature::mean::region_mean;
use crate::feature::region_hits;
use crate::feature::segment::{SegmentCounts, sides_of_mean};
use crate::feature::surface::displacement_sums;
use crate::region::FrameRegion;
use crate::temporal::RegionReferences;
use crate::{FunctionalOutcome, RegionMemory, region_pixels};

/// Version of the format. It changes when a key is removed or changes its meaning.
pub(super) const FORMAT_VERSION: u32 = 1;

impl RegionExplanation {
    /// Explains the decision for one region of a frame, from the state of the region before the
    /// frame and the outcome of the frame.
    ///
    /// # Panics
    /// Panics if the camera has no such region, or if the outcome is that of another camera.
    #[must_use]
    pub fn from_outcome(
        design: &Design,
        frame: FrameIdentification<'_>,
        region: u32,
        before: RegionMemory,
        outcome: &FunctionalOutcome,
    ) -> Self {
        let (camera, at) = (design.camera(), region as usize);
        let class = outcome.classes[at];
        let thresholds = camera.class_thresholds(class);
        let scores = thresholds.features.iter().zip(&outcome.scores);
        let mut references = RegionReferences::without_references(camera);
        if let Some(pixels) = &before.reference {
            references.set(camera, region, pixels);
        }
        let view = FrameRegion::new(camera, &outcome.denoised, region)
            .with_reference(references.frame(region));
        Self {
            format_version: FORMAT_VERSION,
            design_fingerprint: design.fingerprint(),
            frame: frame.number,
            name: frame.name.to_owned(),
            t_us: frame.t_us,
            region: RegionPosition::of(camera, region),
            pixel_bits: camera.pixel_bits(),
            raw: rows(camera, &pixels(camera, &outcome.padded, region)),
            denoised: rows(camera, &pixels(camera, &outcome.denoised, region)),
            filter: camera.filter(),
            spatial: scores
                .map(|(feature, scores)| {
                    SpatialExplanation::of(camera, feature, outcome, (region, view), scores[at])
                })
                .collect(),
            combine: camera.combine().name(),
            class: camera.zones().map(|_| class),
            srs: outcome.srs[at],
            temporal: TemporalExplanation::of(
                camera,
                thresholds,
                before.reference,
                outcome,
                region,
            ),
            trs: outcome.trs[at],
            summary: camera.periphery().map(|periphery| {
                let level = thresholds.summary_level.unwrap_or(periphery.level);
                SummaryExplanation::of(periphery, level, &outcome.means[at], before.summary)
            }),
            action: outcome.actions[at].name(),
            rule: rule(camera, outcome.srs[at], outcome.trs[at], outcome.actions[at]),
        }
    }
}

impl RegionPosition {
    pub(super) fn of(camera: &Camera, region: u32) -> Self {
        let (size, columns) = (camera.region_size(), camera.columns());
        let (x, y) = (region % columns, region / columns);
        Self {
            x,
            y,
            x0: x * size,
            y0: y * size,
            size,
            columns,
            rows: camera.rows(),
            padding_right: ((x + 1) * size).saturating_sub(camera.width()),
            padding_below: ((y + 1) * size).saturating_sub(camera.height()),
        }
    }
}

impl SpatialExplanation {
    fn of(
        camera: &Camera,
        feature: &SpatialFeature,
        outcome: &FunctionalOutcome,
        (region, view): (u32, FrameRegion<'_>),
        score: u64,
    ) -> Self {
        let hits = region_hits(camera, feature, &outcome.denoised, region);
        let mean_fraction_bits = feature.mean().map(|mean| mean.fraction_bits);
        let (mut parts, mut displacements, mut displacement) = (None, None, None);
        match feature.kind() {
            FeatureKind::Edge
            | FeatureKind::Corner
            | FeatureKind::Mad
            | FeatureKind::Variance
            | FeatureKind::Range => {}
            FeatureKind::Surface => {
                displacements = Some(displacement_sums(&view));
            }
            FeatureKind::Segment => {
                let level = feature.level().expect("segment has a level");
                let bits = mean_fraction_bits.expect("segment has a mean");
                let sides: Vec<Ordering> = sides_of_mean(&view, level, bits).collect();
                parts = Some(SegmentParts::of(camera, &sides));
            }
            FeatureKind::Flow => {
                let radius = feature.radius().expect("flow has a radius");
                let found = outcome.displacements[index(region)];
                displacement = Some(DisplacementExplanation::of(found, &view, radius));
            }
        }
        Self {
            feature: feature.kind(),
            level: feature.level(),
            hits: hits.map(|hits| rows(camera, &hits)),
            mean: mean_fraction_bits.map(|bits| region_mean(&view, bits)),
            mean_fraction_bits,
            parts,
            displacements,
            displacement,
            score,
            min_score: feature.min_score(),
            unit: feature.unit(),
            vote: score >= feature.min_score(),
        }
    }
}

impl DisplacementExplanation {
    /// Adds the differences between the region and its reference to the displacement that was
    /// found.
    fn of(displacement: Displacement, view: &FrameRegion<'_>, radius: u32) -> Self {
        let errors = displaced_errors(view, radius);
        let sum_at = |wanted: Displacement| {
            let error = errors.iter().find(|error| error.displacement == wanted)?;
            let &DisplacedError { error: sum, pairs: pixels, .. } = error;
            Some(DifferenceSum { sum, pixels })
        };
        let differences = sum_at(Displacement::default()).zip(sum_at(displacement));
        let differences =
            differences.map(|(still, displaced)| ReferenceDifferences { still, displaced });
        Self { displacement, differences }
    }
}

impl SegmentParts {
    fn of(camera: &Camera, sides: &[Ordering]) -> Self {
        let pixels_on = |side: Ordering| {
            let marks: Vec<bool> = sides.iter().map(|&own| own == side).collect();
            rows(camera, &marks)
        };
        let counts = sides.iter().copied().fold(SegmentCounts::default(), SegmentCounts::with);
        Self {
            above: pixels_on(Ordering::Greater),
            below: pixels_on(Ordering::Less),
            count_above: counts.above,
            count_below: counts.below,
        }
    }
}

impl SummaryExplanation {
    fn of(periphery: &Periphery, level: u32, means: &[u16], shown: Option<Vec<u16>>) -> Self {
        let rows = |means: &[u16]| -> SquareRows<u16> {
            means.chunks(periphery.blocks as usize).map(<[u16]>::to_vec).collect()
        };
        Self { means: rows(means), shown: shown.map(|shown| rows(&shown)), level }
    }
}

impl TemporalExplanation {
    fn of(
        camera: &Camera,
        thresholds: ClassThresholds<'_>,
        reference: Option<Vec<u16>>,
        outcome: &FunctionalOutcome,
        region: u32,
    ) -> Self {
        let ClassThresholds { temporal_level: level, min_count, .. } = thresholds;
        let current = pixels(camera, &outcome.denoised, region);
        let hits = match &reference {
            Some(referenced) => {
                let pairs = current.iter().zip(referenced);
                pairs
                    .map(|(current, referenced)| u32::from(current.abs_diff(*referenced)) > level)
                    .collect()
            }
            None => vec![true; current.len()],
        };
        Self {
            against: camera.temporal().reference.name(),
            reference: reference.map(|pixels| rows(camera, &pixels)),
            level,
            hits: rows(camera, &hits),
            count: outcome.temporal_count[region as usize],
            min_count,
        }
    }
}

fn pixels(camera: &Camera, padded: &Frame, region: u32) -> Vec<u16> {
    let mut pixels = Vec::new();
    region_pixels(camera, padded, region, &mut pixels);
    pixels
}

fn rows<T: Copy>(camera: &Camera, items: &[T]) -> SquareRows<T> {
    items.chunks(camera.region_size() as usize).map(<[T]>::to_vec).collect()
}

/// Returns the row of the decision table as a sentence.
pub(super) fn rule(camera: &Camera, srs: bool, trs: bool, action: RegionAction) -> String {
    let payload = camera.payload().name();
    match (trs, srs) {
        (true, true) => format!("TRS 1, SRS 1: active, its {payload} pixels are sent and shown"),
        (false, true) => "TRS 0, SRS 1: inactive, the previous rendered pixels stay".to_owned(),
        (_, false) => {
            let then = match camera.irrelevant() {
                IrrelevantRendering::Zero => "the region is rendered black (irrelevant = \"zero\")",
                IrrelevantRendering::Hold => {
                    "the previous rendered pixels stay (irrelevant = \"hold\")"
                }
                IrrelevantRendering::Mean if action == RegionAction::Summarize => {
                    "its means are sent and shown (irrelevant = \"mean\")"
                }
                IrrelevantRendering::Mean => {
                    "no mean differs by more than the level (irrelevant = \"mean\")"
                }
            };
            format!("TRS any, SRS 0: inactive, {then}")
        }
    }
}

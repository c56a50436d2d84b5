// SPDX-License-Identifier: MIT OR Apache-2.0
//! The cameras of a search that are worth building: the simplest of those that meet the limits, or
//! those that send the fewest bytes.

use foveate_camera::{
    CameraConfig, DenoiseFilter, FeatureKind, IrrelevantRendering, Neighborhood, ReferencePolicy,
};

use super::camera_search::ExaminedCamera;
use crate::ExploreError;
use crate::row::bytes_per_frame;

/// Returns the simplest of some cameras that meet the limits. A camera is simpler than another one
/// if it is equal in the settings that cannot be ordered, and at most as large in all others.
pub(super) fn simplest_cameras<'a>(cameras: &[&'a ExaminedCamera]) -> Vec<&'a ExaminedCamera> {
    let simpler = |one: &CameraConfig, other: &CameraConfig| {
        let (one, other) = (complexity(one), complexity(other));
        one.0 == other.0
            && one != other
            && one.1.iter().zip(&other.1).all(|(one, other)| one <= other)
    };
    let beaten = |examined: &ExaminedCamera| {
        cameras.iter().any(|other| simpler(&other.config, &examined.config))
    };
    let mut kept: Vec<&ExaminedCamera> =
        cameras.iter().copied().filter(|examined| !beaten(examined)).collect();
    // Thresholds are inputs of the core and cost nothing. Of cameras that differ only in
    // thresholds, the one with the fewest flips is kept.
    kept.sort_by(|one, other| one.figures.action_flips.total_cmp(&other.figures.action_flips));
    let mut seen = Vec::new();
    kept.retain(|examined| {
        let complexity = complexity(&examined.config);
        let new = !seen.contains(&complexity);
        seen.push(complexity);
        new
    });
    kept
}

/// The complexity of a camera: the settings that cannot be ordered, and those that cost more the
/// larger they are.
type CameraComplexity =
    ((u32, Neighborhood, Vec<FeatureKind>, IrrelevantRendering, Option<u32>), [u32; 5]);

fn complexity(config: &CameraConfig) -> CameraComplexity {
    let features = config.spatial.iter().map(|entry| entry.feature).collect();
    let fraction = config.spatial.iter().filter_map(|entry| entry.mean_fraction_bits).sum();
    let filter = filter_complexity(config.denoise.filter);
    let reference = match config.temporal.reference {
        ReferencePolicy::Previous => 0,
        ReferencePolicy::LastSent => 1,
    };
    let radius = config.spatial.iter().filter_map(|entry| entry.radius).sum();
    let ordered = [config.frame.pixel_bits, filter, reference, fraction, radius];
    let (region, shown) = (&config.region, config.render.irrelevant);
    ((region.size, region.neighborhood, features, shown, config.periphery.blocks), ordered)
}

/// Returns a number that is larger for a filter that costs more: a weighted sum costs less than a
/// median, and the switching median is a median and two comparisons.
pub(super) fn filter_complexity(filter: DenoiseFilter) -> u32 {
    match filter {
        DenoiseFilter::None => 0,
        DenoiseFilter::Binomial3x3 => 1,
        DenoiseFilter::Median3x3 => 2,
        DenoiseFilter::Switching3x3 => 3,
    }
}

pub(super) fn cameras_with_fewest_bytes<'a>(
    cameras: &[&'a ExaminedCamera],
) -> Result<Vec<&'a ExaminedCamera>, ExploreError> {
    let bytes = |camera: &&'a ExaminedCamera| {
        Ok((bytes_per_frame(&camera.config.validate()?, &camera.figures), *camera))
    };
    let sent = cameras.iter().map(bytes).collect::<Result<Vec<_>, ExploreError>>()?;
    let least = sent.iter().map(|(bytes, _)| *bytes).fold(f64::INFINITY, f64::min);
    Ok(sent.into_iter().filter(|(bytes, _)| *bytes <= least).map(|(_, camera)| camera).collect())
}

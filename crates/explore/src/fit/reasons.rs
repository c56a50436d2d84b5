// SPDX-License-Identifier: MIT OR Apache-2.0
//! The reasons why a design was chosen: the effect of one step to something simpler.

use std::collections::BTreeMap;
use std::iter;

use foveate_camera::{
    CameraConfig, DenoiseFilter, FLOW_RADII, IrrelevantRendering, Neighborhood, ReferencePolicy,
    SpatialFeature,
};
use foveate_design::{Design, Organization};
use foveate_estimate::FrameRate;

use super::FitRequest;
use super::camera_search::CameraSearch;
use super::constraints::ConstraintCheck;
use super::simplest_cameras::filter_complexity;
use super::synthesis::SynthesizedDesigns;
use super::synthesized_design::SynthesizedDesign;
use super::threshold_search::ThresholdChoice;

/// Describes a design in a few words.
pub(super) fn design_text(design: &Design) -> String {
    let features: Vec<String> = design.features().iter().map(feature_text).collect();
    format!(
        "{hardware}; {size}x{size} regions, {neighborhood} windows; {} at {} bits, {}; reference {}{}",
        features.join(" and "),
        design.pixel_bits(),
        match design.filter() {
            DenoiseFilter::None => "no denoising",
            DenoiseFilter::Median3x3 => "median",
            DenoiseFilter::Switching3x3 => "switching median",
            DenoiseFilter::Binomial3x3 => "binomial filter",
        },
        design.temporal().reference,
        match (design.irrelevant(), design.periphery()) {
            (IrrelevantRendering::Mean, Some(own)) => {
                format!("; irrelevant regions send {0}x{0} means", own.blocks)
            }
            (IrrelevantRendering::Hold, _) => "; irrelevant regions keep their pixels".to_owned(),
            (IrrelevantRendering::Zero | IrrelevantRendering::Mean, _) => String::new(),
        },
        hardware = design.config().hardware.description(),
        size = design.region_size(),
        neighborhood = design.neighborhood(),
    )
}

/// Names a feature, and its radius if it has one.
fn feature_text(feature: &SpatialFeature) -> String {
    let radius = feature.radius().map(|radius| format!(" (radius {radius})")).unwrap_or_default();
    format!("{}{radius}", feature.kind())
}

/// Returns a line for each step to something simpler, and then the cost of the next cheapest
/// design.
pub(super) fn reason_lines(
    search: &CameraSearch<'_>,
    built: &SynthesizedDesigns,
    chosen: &SynthesizedDesign,
    request: &FitRequest<'_>,
) -> Vec<String> {
    let mut lines = Vec::new();
    for (step, config) in simpler_cameras(&chosen.examined.config) {
        // The search has compared only some of these steps; the others are left out.
        lines.extend(judged_text(search, built, &config).map(|text| format!("{step}: {text}")));
    }
    lines.extend(other_features(search, built, chosen));
    let is_comparable = |other: &&SynthesizedDesign| {
        other.meets_limits() && other.cost().is_finite() && chosen.meets_limits()
    };
    let next = built.designs().iter().skip(1).find(is_comparable);
    let is_next = |design: &Design| next.is_some_and(|next| next.design == *design);
    let others = other_organizations(built, chosen);
    lines.extend(
        others
            .filter(|other| !is_next(&other.design))
            .map(|other| format!("{}: {}", design_text(&other.design), cost_text(other))),
    );
    lines.extend(deeper_fold_line(chosen, request));
    lines.extend(next.map(|next| {
        let (own, its) = (chosen.cost_text(), next.cost_text());
        format!("next cheapest: {}: {its}, instead of {own}", design_text(&next.design))
    }));
    lines
}

/// Returns the limits of which each one alone keeps some design from meeting all limits.
pub(super) fn binding_limits(built: &SynthesizedDesigns) -> Vec<&'static str> {
    if built.chosen().meets_limits() {
        return Vec::new();
    }
    let mut found: Vec<&'static str> = Vec::new();
    for candidate in built.designs() {
        let broken: Vec<&ConstraintCheck> =
            candidate.checks.iter().filter(|check| !check.holds).collect();
        if let [one] = broken.as_slice()
            && !found.contains(&one.name)
        {
            found.push(one.name);
        }
    }
    found
}

/// Returns the cameras that are simpler than the chosen one in one setting, each with a name for
/// the step.
fn simpler_cameras(chosen: &CameraConfig) -> Vec<(String, CameraConfig)> {
    let mut found = Vec::new();
    let mut step = |what: String, change: &dyn Fn(&mut CameraConfig)| {
        let mut config = chosen.clone();
        change(&mut config);
        if config != *chosen {
            found.push((what, config));
        }
    };
    let bits = chosen.frame.pixel_bits;
    if let Some(fewer) = bits.checked_sub(1).filter(|&fewer| fewer > 0) {
        step(format!("{fewer} bits per pixel"), &|config| {
            *config = config.scaled_to_depth(fewer);
        });
    }
    for &filter in DenoiseFilter::ALL {
        if filter_complexity(filter) < filter_complexity(chosen.denoise.filter) {
            let name = match filter {
                DenoiseFilter::None => "without a filter".to_owned(),
                DenoiseFilter::Median3x3
                | DenoiseFilter::Switching3x3
                | DenoiseFilter::Binomial3x3 => format!("{filter} as the filter"),
            };
            step(name, &|config| config.denoise.filter = filter);
        }
    }
    step("isolated windows".to_owned(), &|config| {
        config.region.neighborhood = Neighborhood::Isolated;
    });
    step("compared with the previous frame".to_owned(), &|config| {
        config.temporal.reference = ReferencePolicy::Previous;
    });
    for (index, entry) in chosen.spatial.iter().enumerate() {
        for radius in entry.radius.map_or(0..0, |radius| *FLOW_RADII.start()..radius) {
            step(format!("{} with a radius of {radius}", entry.feature), &|config| {
                config.spatial[index].radius = Some(radius);
            });
        }
    }
    found
}

/// Returns the limits that a camera misses with its best thresholds, or its cost if it meets all;
/// `None` if it was not compared.
fn judged_text(
    search: &CameraSearch<'_>,
    built: &SynthesizedDesigns,
    config: &CameraConfig,
) -> Option<String> {
    let best = search.with_best_thresholds(config);
    let examined = search.get(best.map_or(config, |best| &best.config));
    if let (None, Some(bound)) = (examined, best.and_then(|best| best.least_flips)) {
        return Some(format!("more than {:.2} % flips", 100.0 * bound));
    }
    let checks = examined.map(|examined| &examined.checks).or(best.map(|best| &best.checks))?;
    let broken = checks.iter().filter(|check| !check.holds).map(ConstraintCheck::text);
    let broken = broken.collect::<Vec<_>>().join(", ");
    if !broken.is_empty() {
        return Some(format!("at best {broken}"));
    }
    let examined = examined?;
    let flips = examined.figures.action_flips * 100.0;
    let of_camera = built.designs().iter();
    let own = of_camera.filter(|candidate| candidate.examined.config == examined.config);
    Some(match own.min_by(|one, other| one.cost().total_cmp(&other.cost())) {
        Some(candidate) => format!("{flips:.2} % flips; {}", cost_text(candidate)),
        None => format!(
            "{flips:.2} % flips; not synthesized, because it is less promising or a simpler one meets the limits"
        ),
    })
}

/// Returns a line for the best camera of every other set of features and region size.
fn other_features(
    search: &CameraSearch<'_>,
    built: &SynthesizedDesigns,
    chosen: &SynthesizedDesign,
) -> Vec<String> {
    let of = |config: &CameraConfig| {
        let names: Vec<&str> = config.spatial.iter().map(|entry| entry.feature.name()).collect();
        (names.join(" and "), config.region.size)
    };
    let own = of(&chosen.examined.config);
    let mut best: BTreeMap<(String, u32), &ThresholdChoice> = BTreeMap::new();
    for camera in search.best_thresholds() {
        let key = of(&camera.config);
        // Readers ask for cameras that differ in one setting only.
        if key != own && (key.0 == own.0 || key.1 == own.1) {
            let known = best.entry(key).or_insert(camera);
            if camera.distance < known.distance {
                *known = camera;
            }
        }
    }
    let mut best: Vec<_> = best.into_iter().collect();
    best.sort_by(|one, other| one.1.distance.total_cmp(&other.1.distance));
    let line = |((features, size), camera): ((String, u32), &ThresholdChoice)| {
        let text = judged_text(search, built, &camera.config)?;
        Some(format!("{features} in {size}x{size} regions: {text}"))
    };
    best.into_iter().filter_map(line).collect()
}

fn other_organizations<'a>(
    built: &'a SynthesizedDesigns,
    chosen: &SynthesizedDesign,
) -> impl Iterator<Item = &'a SynthesizedDesign> {
    let own = chosen.design.organization();
    Organization::ALL.iter().filter(move |other| **other != own).filter_map(|other| {
        built.designs().iter().find(|candidate| candidate.design.organization() == *other)
    })
}

/// Returns a line about one fold more, if it is too slow.
fn deeper_fold_line(chosen: &SynthesizedDesign, request: &FitRequest<'_>) -> Option<String> {
    let fold = chosen.design.slots() + 1;
    let deeper = chosen.design.with_fold(fold).ok()?;
    let speed = chosen.speed?;
    let at_low = FrameRate::at_given_clock(speed.low_clock_mhz, deeper.timing().clocks_per_frame());
    let [check] = request.constraints.check_speed(Some(&at_low)).try_into().ok()?;
    let whose = if request.clock_hz.is_none() { ", if its clock is the same" } else { "" };
    (!check.holds).then(|| format!("fold {fold}: {}{whose}", check.text()))
}

/// Returns the cost of a design, and the limits that it misses.
fn cost_text(candidate: &SynthesizedDesign) -> String {
    let broken = candidate.checks.iter().filter(|check| !check.holds).map(ConstraintCheck::text);
    iter::once(candidate.cost_text()).chain(broken).collect::<Vec<_>>().join("; ")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_smaller_radius_is_simpler() {
        let text = "[[spatial]]\nfeature = \"edge\"\n[[spatial]]\nfeature = \"flow\"\nradius = 3\n";
        let chosen = CameraConfig::from_toml(text).unwrap().validate().unwrap().config().clone();
        let steps = simpler_cameras(&chosen);
        let radii = steps.iter().filter(|(step, _)| step.starts_with("flow"));
        let radii: Vec<_> =
            radii.map(|(step, config)| (step.as_str(), config.spatial[1].radius)).collect();
        let expected = [("flow with a radius of 1", Some(1)), ("flow with a radius of 2", Some(2))];
        assert_eq!(radii, expected);
    }
}

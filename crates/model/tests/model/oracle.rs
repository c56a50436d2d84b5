// SPDX-License-Identifier: MIT OR Apache-2.0
//! The contract in its simplest form. The oracle computes whole frames without any state, and looks
//! up every earlier value in the complete history. It shares only types with the library.

use foveate_model::CycleModel;
use foveate_pixels::Frame;

use crate::parameters::{DesignParameters, FeatureParameters};

pub(crate) type OracleFrame = Vec<Vec<i64>>;

/// The results of the oracle for one frame. Regions are numbered row by row.
#[derive(Clone, Debug, Default)]
pub(crate) struct OracleOutcome {
    pub(crate) padded: OracleFrame,
    pub(crate) denoised: OracleFrame,
    pub(crate) regions: Vec<OracleRegion>,
    pub(crate) rendered: OracleFrame,
}

#[derive(Clone, Debug, Default)]
pub(crate) struct OracleRegion {
    /// Hits, deviations from the mean for `mad`, or sides of the mean for `segment`, by feature and
    /// pixel. A side is 1 above, -1 below, and otherwise 0.
    pub(crate) terms: Vec<Vec<i64>>,
    pub(crate) scores: Vec<i64>,
    /// Columns to the right and rows down; 0 without `flow`.
    pub(crate) displacement: (i64, i64),
    pub(crate) temporal_hits: Vec<bool>,
    pub(crate) temporal_count: i64,
    pub(crate) srs: bool,
    pub(crate) trs: bool,
    pub(crate) payload: Vec<i64>,
    /// Means of the blocks of the region. They are empty if irrelevant regions send none.
    pub(crate) means: Vec<i64>,
    pub(crate) active: bool,
    /// True if the region could not send all of its output: a loss of the raster organization.
    pub(crate) lost: bool,
    /// The action on the region of the screen.
    pub(crate) action: &'static str,
}

/// Returns the results for every frame of a clip.
pub(crate) fn oracle_history(recipe: &DesignParameters, clip: &[Frame]) -> Vec<OracleOutcome> {
    oracle_history_with_maps(recipe, &vec![Vec::new(); clip.len()], clip)
}

/// Returns the results for every frame of a clip. A map has the codes of the classes of all regions
/// in one frame.
pub(crate) fn oracle_history_with_maps(
    recipe: &DesignParameters,
    maps: &[Vec<u8>],
    clip: &[Frame],
) -> Vec<OracleOutcome> {
    let mut history: Vec<OracleOutcome> = Vec::new();
    for (map, frame) in maps.iter().zip(clip) {
        add_to_history(&mut history, recipe, map, frame);
    }
    history
}

/// Adds the results of the next frame. Regions that the map lacks are `normal`.
pub(crate) fn add_to_history(
    history: &mut Vec<OracleOutcome>,
    recipe: &DesignParameters,
    map: &[u8],
    frame: &Frame,
) {
    let mut outcome = outcome_without_regions(recipe, frame);
    for region in 0..recipe.columns() * recipe.rows() {
        let own = recipe.of_class(map.get(region as usize).copied().unwrap_or(0));
        let own = oracle_region(&own, (&history[..], &history[..]), &outcome, region);
        outcome.regions.push(own);
    }
    history.push(outcome);
    let rendered = render(recipe, history);
    history.last_mut().unwrap().rendered = rendered;
}

/// Checks that a model knows the references and the summaries that the next frame is compared with.
pub(crate) fn check_memory(
    recipe: &DesignParameters,
    history: &[OracleOutcome],
    model: &dyn CycleModel,
) -> Result<(), String> {
    let values = |pixels: &[u16]| pixels.iter().map(|&pixel| pixel.into()).collect::<Vec<i64>>();
    for region in 0..recipe.columns() * recipe.rows() {
        let known = [model.reference(region as u32), model.summary(region as u32)];
        let due =
            [reference(recipe, history, region), shown_means(history, region).map(<[i64]>::to_vec)];
        if known.map(|pixels| pixels.map(values)) != due {
            return Err(format!("region {region} keeps {known:?}, due is {due:?}"));
        }
    }
    Ok(())
}

/// Makes the results of a frame, without its regions.
pub(crate) fn outcome_without_regions(recipe: &DesignParameters, frame: &Frame) -> OracleOutcome {
    let (width, height) = (recipe.columns() * recipe.side, recipe.rows() * recipe.side);
    let padded: OracleFrame =
        (0..height).map(|y| (0..width).map(|x| frame.get_clamped(x, y).into()).collect()).collect();
    let mut denoised = padded.clone();
    if recipe.has_filter() {
        for y in 0..height {
            for x in 0..width {
                denoised[y as usize][x as usize] = filtered(recipe, &padded, (x, y));
            }
        }
    }
    OracleOutcome { padded, denoised, ..OracleOutcome::default() }
}

fn filtered(recipe: &DesignParameters, image: &OracleFrame, place: (i64, i64)) -> i64 {
    let at = |offset| neighbor(recipe, image, place, offset);
    let mut nine: Vec<i64> = window_offsets().map(at).collect();
    nine.sort_unstable();
    match recipe.filter {
        "median3x3" => nine[4],
        "switching3x3" if nine[0] < at((0, 0)) && at((0, 0)) < nine[8] => at((0, 0)),
        "switching3x3" => nine[4],
        "binomial3x3" => {
            let weight = |(dx, dy): (i64, i64)| (2 - dx.abs()) * (2 - dy.abs());
            let sum: i64 = window_offsets().map(|offset| weight(offset) * at(offset)).sum();
            // The nearest integer, or the upper one of two that are equally near.
            [sum / 16 + 1, sum / 16].into_iter().min_by_key(|mean| (16 * mean - sum).abs()).unwrap()
        }
        other => panic!("the oracle does not know {other}"),
    }
}

fn window_offsets() -> impl Iterator<Item = (i64, i64)> {
    (-1..=1).flat_map(|dy| (-1..=1).map(move |dx| (dx, dy)))
}

/// Returns the pixel next to (x, y), by the neighborhood of the region of that pixel.
fn neighbor(
    recipe: &DesignParameters,
    image: &OracleFrame,
    (x, y): (i64, i64),
    (dx, dy): (i64, i64),
) -> i64 {
    let (mut nx, mut ny) = (x + dx, y + dy);
    if !recipe.shared && nx.div_euclid(recipe.side) != x / recipe.side {
        nx = x;
    }
    if !recipe.shared && ny.div_euclid(recipe.side) != y / recipe.side {
        ny = y;
    }
    nx = nx.max(0).min(image[0].len() as i64 - 1);
    ny = ny.max(0).min(image.len() as i64 - 1);
    image[ny as usize][nx as usize]
}

/// Returns the positions of a region in row-major order.
fn positions(recipe: &DesignParameters, region: i64) -> Vec<(i64, i64)> {
    let (left, top) = (region % recipe.columns(), region / recipe.columns());
    (0..recipe.region_pixels())
        .map(|i| (left * recipe.side + i % recipe.side, top * recipe.side + i / recipe.side))
        .collect()
}

fn region_values(recipe: &DesignParameters, image: &OracleFrame, region: i64) -> Vec<i64> {
    positions(recipe, region).iter().map(|&(x, y)| image[y as usize][x as usize]).collect()
}

/// Returns the results for a region of the frame after `history`. Its reference comes from the
/// frames in `kept`.
pub(crate) fn oracle_region(
    recipe: &DesignParameters,
    (history, kept): (&[OracleOutcome], &[OracleOutcome]),
    frame: &OracleOutcome,
    region: i64,
) -> OracleRegion {
    let denoised = &frame.denoised;
    let pixels = region_values(recipe, denoised, region);
    let terms: Vec<Vec<i64>> =
        recipe.features.iter().map(|f| terms(recipe, f, denoised, region)).collect();
    let referenced = reference(recipe, kept, region);
    let mut displacement = (0, 0);
    let mut scores = Vec::new();
    let mut votes = Vec::new();
    for (feature, terms) in recipe.features.iter().zip(&terms) {
        let score: i64 = match feature.name {
            "variance" => scaled_variance(&pixels),
            "range" => pixels.iter().max().unwrap() - pixels.iter().min().unwrap(),
            "surface" => smallest_change(recipe, denoised, region),
            "flow" => {
                let (found, score) = flow(recipe, feature.radius, &pixels, referenced.as_deref());
                displacement = found;
                score
            }
            name => score_of_terms(name, terms),
        };
        let unit: i128 = match feature.name {
            "mad" => i128::from(recipe.region_pixels()) << feature.fraction_bits,
            "surface" | "flow" => recipe.region_pixels().into(),
            "variance" => i128::from(recipe.region_pixels() * recipe.region_pixels()),
            _ => 1,
        };
        votes.push(i128::from(score) * 1000 >= i128::from(feature.min_milli) * unit);
        scores.push(score);
    }
    let needed = if recipe.all_must_vote { votes.len() } else { 1 };
    let voted = votes.iter().filter(|&&vote| vote).count() >= needed;
    let srs = recipe.forced_srs.unwrap_or(voted);

    let temporal_hits: Vec<bool> = match &referenced {
        None => vec![true; pixels.len()],
        Some(reference) => {
            let pairs = pixels.iter().zip(reference);
            pairs.map(|(a, b)| (a - b).abs() > recipe.temporal_level).collect()
        }
    };
    let temporal_count = temporal_hits.iter().filter(|&&hit| hit).count() as i64;
    let trs = temporal_count >= recipe.temporal_min;
    let payload = if recipe.raw_payload { &frame.padded } else { denoised };
    let payload = region_values(recipe, payload, region);
    let active = srs && trs;
    let means = means(recipe, &payload);
    let action = action(recipe, history, region, (srs, trs), &means);
    let lost = false;
    OracleRegion {
        terms,
        scores,
        displacement,
        temporal_hits,
        temporal_count,
        srs,
        trs,
        payload,
        means,
        active,
        lost,
        action,
    }
}

/// Returns the action on a region of the frame after `history`, with these SRS, TRS and means.
pub(crate) fn action(
    recipe: &DesignParameters,
    history: &[OracleOutcome],
    region: i64,
    (srs, trs): (bool, bool),
    means: &[i64],
) -> &'static str {
    let is_near = |last: &[i64], level: i64| {
        last.iter().zip(means).all(|(last, mean)| (last - mean).abs() <= level)
    };
    match recipe.periphery {
        _ if srs && trs => "forward",
        Some(periphery) if !srs => match shown_means(history, region) {
            Some(last) if is_near(last, periphery.level) => "hold",
            _ => "summarize",
        },
        None if !srs && recipe.blank_irrelevant => "blank",
        _ => "hold",
    }
}

/// Returns the means of the blocks of a region, rounded to the nearest integer, halves up.
fn means(recipe: &DesignParameters, pixels: &[i64]) -> Vec<i64> {
    let Some(periphery) = recipe.periphery else { return Vec::new() };
    let side = recipe.side / periphery.blocks;
    let mean = |block: i64| {
        let (left, top) = (block % periphery.blocks * side, block / periphery.blocks * side);
        let is_inside = |place: i64| {
            let (x, y) = (place % recipe.side, place / recipe.side);
            (left..left + side).contains(&x) && (top..top + side).contains(&y)
        };
        let block_pixels: Vec<i64> = (0..recipe.region_pixels())
            .filter(|&i| is_inside(i))
            .map(|i| pixels[i as usize])
            .collect();
        let twice = 2 * block_pixels.iter().sum::<i64>() + block_pixels.len() as i64;
        twice.div_euclid(2 * block_pixels.len() as i64)
    };
    (0..periphery.blocks * periphery.blocks).map(mean).collect()
}

/// Returns the means that the screen shows of a region before a frame, or `None` if it shows no
/// summary.
fn shown_means(history: &[OracleOutcome], region: i64) -> Option<&[i64]> {
    let regions = history.iter().rev().map(|outcome| &outcome.regions[region as usize]);
    let last = regions.into_iter().find(|region| matches!(region.action, "forward" | "summarize"));
    last.filter(|region| region.action == "summarize" && !region.lost)
        .map(|region| &region.means[..])
}

fn terms(
    recipe: &DesignParameters,
    feature: &FeatureParameters,
    denoised: &OracleFrame,
    region: i64,
) -> Vec<i64> {
    let places = positions(recipe, region);
    let at = |place: (i64, i64), offset| neighbor(recipe, denoised, place, offset);
    let hits = |hit: &dyn Fn((i64, i64)) -> bool| places.iter().map(|&p| hit(p).into()).collect();
    match feature.name {
        "edge" => hits(&|place| {
            let weighted = |weight: &dyn Fn(i64, i64) -> i64| -> i64 {
                window_offsets().map(|(dx, dy)| weight(dx, dy) * at(place, (dx, dy))).sum()
            };
            let gx = weighted(&|dx, dy| dx * (2 - dy.abs()));
            let gy = weighted(&|dx, dy| dy * (2 - dx.abs()));
            gx.abs() + gy.abs() > feature.level
        }),
        "corner" => hits(&|place| {
            let ring = [(-1, -1), (0, -1), (1, -1), (1, 0), (1, 1), (0, 1), (-1, 1), (-1, 0)];
            let center = at(place, (0, 0));
            (0..8).any(|start| {
                let mut arc = Vec::new();
                for step in 0..5 {
                    arc.push(at(place, ring[(start + step) % 8]));
                }
                arc.iter().all(|&pixel| pixel > center + feature.level)
                    || arc.iter().all(|&pixel| pixel < center - feature.level)
            })
        }),
        "mad" => {
            let deviations = deviations(recipe, feature, denoised, region);
            deviations.into_iter().map(i64::abs).collect()
        }
        "segment" => {
            let level = feature.level << feature.fraction_bits;
            let side = |deviation: i64| deviation.signum() * i64::from(deviation.abs() > level);
            deviations(recipe, feature, denoised, region).into_iter().map(side).collect()
        }
        // These are not sums over pixels.
        "variance" | "range" | "surface" | "flow" => vec![0; places.len()],
        other => panic!("the oracle does not know {other}"),
    }
}

/// Returns the deviations from the rounded mean, in units of `2^-f` grey levels.
fn deviations(
    recipe: &DesignParameters,
    feature: &FeatureParameters,
    denoised: &OracleFrame,
    region: i64,
) -> Vec<i64> {
    let pixels = region_values(recipe, denoised, region);
    let scale = 1i64 << feature.fraction_bits;
    let mean =
        (pixels.iter().sum::<i64>() * scale + recipe.region_pixels() / 2) / recipe.region_pixels();
    pixels.iter().map(|pixel| pixel * scale - mean).collect()
}

/// Returns the score of a feature that is computed from terms of pixels.
pub(crate) fn score_of_terms(name: &str, terms: &[i64]) -> i64 {
    if name == "segment" { smaller_part(terms) } else { terms.iter().sum() }
}

/// Returns the smaller one of the numbers of terms 1 and -1: half of what is left of all of them
/// after the difference of both numbers.
fn smaller_part(sides: &[i64]) -> i64 {
    let all: i64 = sides.iter().map(|side| side.abs()).sum();
    let difference = sides.iter().sum::<i64>().abs();
    (all - difference) / 2
}

/// Returns the smallest sum of differences between a region and the region one pixel further.
fn smallest_change(recipe: &DesignParameters, image: &OracleFrame, region: i64) -> i64 {
    let change = |offset| -> i64 {
        let pairs = positions(recipe, region).into_iter();
        let pairs = pairs.map(|place| {
            [neighbor(recipe, image, place, (0, 0)), neighbor(recipe, image, place, offset)]
        });
        pairs.map(|pair| pair.iter().max().unwrap() - pair.iter().min().unwrap()).sum()
    };
    let mut changes = [(-1, 1), (0, 1), (1, 1), (1, 0)].map(change);
    changes.sort_unstable();
    changes[0]
}

/// Returns `n^2 sigma^2`, computed from the deviations: `sum((n x - sum)^2) / n`.
fn scaled_variance(pixels: &[i64]) -> i64 {
    let n = pixels.len() as i128;
    let sum: i128 = pixels.iter().map(|&pixel| i128::from(pixel)).sum();
    let squares: i128 = pixels.iter().map(|&pixel| (n * i128::from(pixel) - sum).pow(2)).sum();
    assert_eq!(squares % n, 0);
    (squares / n) as i64
}

/// Returns the displacement of a region from its reference, and its score. Errors are brought to a
/// common denominator, so that they are whole numbers.
fn flow(
    recipe: &DesignParameters,
    radius: i64,
    pixels: &[i64],
    reference: Option<&[i64]>,
) -> ((i64, i64), i64) {
    let Some(reference) = reference else { return ((0, 0), 0) };
    let side = recipe.side;
    let axis: i128 = (0..=radius).map(|shift| i128::from(side - shift)).product();
    let mean_error = |(dx, dy): (i64, i64)| {
        let (mut error, mut pairs) = (0i128, 0i128);
        for place in 0..side * side {
            let (x, y) = (place % side - dx, place / side - dy);
            if (0..side).contains(&x) && (0..side).contains(&y) {
                let partner = reference[(y * side + x) as usize];
                error += i128::from((pixels[place as usize] - partner).abs());
                pairs += 1;
            }
        }
        error * (axis * axis / pairs)
    };
    let rows = (-radius..=radius).flat_map(|dy| (-radius..=radius).map(move |dx| (dx, dy)));
    let rank = |&(dx, dy): &(i64, i64)| (mean_error((dx, dy)), dx.abs() + dy.abs(), dy, dx);
    let best = rows.min_by_key(rank).unwrap();
    let gain = mean_error((0, 0)) - mean_error(best);
    let unit = axis * axis / i128::from(recipe.region_pixels());
    (best, (gain / unit) as i64)
}

/// Returns the reference of this region for the next frame, if it is valid.
fn reference(
    recipe: &DesignParameters,
    history: &[OracleOutcome],
    region: i64,
) -> Option<Vec<i64>> {
    let decides = |outcome: &&OracleOutcome| {
        let region = &outcome.regions[region as usize];
        region.active || recipe.drops_irrelevant_pixels() && !region.srs
    };
    let outcome = if recipe.last_sent {
        history.iter().rev().find(decides).filter(|outcome| {
            let region = &outcome.regions[region as usize];
            region.active && !region.lost
        })
    } else {
        history.last()
    };
    outcome.map(|outcome| region_values(recipe, &outcome.denoised, region))
}

/// Returns the screen after the last frame of the history.
fn render(recipe: &DesignParameters, history: &[OracleOutcome]) -> OracleFrame {
    let pixel = |x: i64, y: i64| {
        let region = (y / recipe.side * recipe.columns() + x / recipe.side) as usize;
        for outcome in history.iter().rev() {
            let image = if recipe.raw_payload { &outcome.padded } else { &outcome.denoised };
            if outcome.regions[region].active {
                return image[y as usize][x as usize];
            }
            if let Some(periphery) = recipe.periphery {
                if outcome.regions[region].action == "summarize" {
                    let side = recipe.side / periphery.blocks;
                    let (x, y) = (x % recipe.side / side, y % recipe.side / side);
                    return outcome.regions[region].means[(y * periphery.blocks + x) as usize];
                }
            } else if recipe.blank_irrelevant && !outcome.regions[region].srs {
                return 0;
            }
        }
        0
    };
    (0..recipe.height).map(|y| (0..recipe.width).map(|x| pixel(x, y)).collect()).collect()
}

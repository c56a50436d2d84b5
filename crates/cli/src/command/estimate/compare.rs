// SPDX-License-Identifier: MIT OR Apache-2.0
//! `foveate estimate --compare`: which designs stand in the table.

use foveate_design::{
    Config, Design, DesignError, FeatureKind, Feed, Filter, Organization, SpatialConfig,
};
use foveate_estimate::{Comparison, Skipped};

use super::flow::Flow;
use crate::args::EstimateArgs;
use crate::error::CliError;
use crate::output;
use crate::progress::Progress;

/// Frames per second of the folded arrays, the fewer the more regions share a lane. Each is folded as deep as
/// its clock allows.
const FOLDED_RATES: [u64; 2] = [500, 30];

/// A row that the table should have.
struct Wanted {
    name: String,
    /// What is said together with others if the design is refused.
    family: String,
    design: Result<Design, DesignError>,
}

pub(super) fn run(args: &EstimateArgs, flow: &Flow) -> Result<(), CliError> {
    let base = args.design.read()?;
    args.design.design()?;
    let given = args.clock.map(f64::from);
    let mut comparison = Comparison::new(given);
    let wanted = organizations(&base);
    let progress = Progress::new(args.quiet);
    let all = (wanted.len() + FOLDED_RATES.len()) as u64;
    let rows = wanted.into_iter().map(Ok);
    let folded = FOLDED_RATES.into_iter().map(|rate| folded(&base, rate, given, flow));
    for (done, row) in (0..).zip(rows.chain(folded)) {
        progress.steps("synthesizing with Yosys", done, all);
        let Wanted { name, family, design } = row?;
        match design {
            Ok(design) => {
                let report = flow.estimate(&design, false)?;
                comparison.push(name, report);
            }
            Err(error) => {
                let skipped = Skipped { name: family, reason: error.to_string() };
                if !comparison.skipped.contains(&skipped) {
                    comparison.skipped.push(skipped);
                }
            }
        }
    }
    progress.finish();
    if args.json {
        output::json(&comparison)
    } else if args.markdown {
        output::text(&comparison.markdown())
    } else {
        output::text(&comparison.text(output::width()))
    }
}

/// The design in each organization with each feature, without and with denoising.
fn organizations(base: &Config) -> Vec<Wanted> {
    let mut list = Vec::new();
    for &organization in Organization::ALL {
        for &filter in Filter::ALL {
            for &kind in FeatureKind::ALL {
                let mut config = with_feature(base, kind, filter);
                config.hardware.organization = organization;
                config.hardware.fold = 1;
                let median = match filter {
                    Filter::None => "",
                    Filter::Median3x3 => " median",
                };
                list.push(Wanted {
                    name: format!("{organization} {kind}{median}"),
                    family: organization.to_string(),
                    design: config.validate(),
                });
            }
        }
    }
    list
}

fn with_feature(base: &Config, kind: FeatureKind, filter: Filter) -> Config {
    let mut config = base.clone();
    config.denoise.filter = filter;
    let own = base.spatial.iter().find(|entry| entry.feature == kind).cloned();
    config.spatial = vec![own.unwrap_or_else(|| SpatialConfig::new(kind))];
    config
}

/// Median and the default feature, one pixel at a time, in as few lanes as still do that many frames per second.
fn folded(base: &Config, rate: u64, given: Option<f64>, flow: &Flow) -> Result<Wanted, CliError> {
    let feature = FeatureKind::default();
    let mut config = with_feature(base, feature, Filter::Median3x3);
    config.hardware.organization = Organization::Serial;
    config.hardware.feed = Some(Feed::Raster);
    config.hardware.fold = 1;
    let clock = |design: &Design| match given {
        Some(mhz) => Ok(Some(mhz)),
        None => Ok(flow.estimate(design, false)?.clock.map(|clock| clock.mhz)),
    };
    let design = match config.validate() {
        Ok(single) => Ok(deepest(single, rate, &clock)?),
        Err(error) => Err(error),
    };
    let fold = design.as_ref().map_or(1, |design| design.config().hardware.fold);
    Ok(Wanted {
        name: format!("serial {feature} median raster fold {fold}"),
        family: "serial with raster feed".to_owned(),
        design,
    })
}

/// The deepest fold that reaches a rate at its own clock; fold 1 if none does.
fn deepest(
    single: Design,
    rate: u64,
    clock: &dyn Fn(&Design) -> Result<Option<f64>, CliError>,
) -> Result<Design, CliError> {
    let mut planned = clock(&single)?;
    // The clock of a folded array is not that of fold 1. Where it is slower, the next fold is shallower.
    while let Some(mhz) = planned {
        let Some(fold) = single.largest_fold(most_clocks(mhz, rate)) else { break };
        let folded = single.with_fold(fold)?;
        let own = clock(&folded)?;
        if own.is_some_and(|own| folded.timing().clocks_per_frame() <= most_clocks(own, rate)) {
            return Ok(folded);
        }
        planned = own;
    }
    Ok(single)
}

/// Clocks that a frame may take at so many frames per second.
#[allow(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    clippy::cast_precision_loss,
    reason = "positive and far below 2^53"
)]
fn most_clocks(mhz: f64, rate: u64) -> u64 {
    (mhz * 1e6 / rate as f64).floor() as u64
}

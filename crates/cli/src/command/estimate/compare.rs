// SPDX-License-Identifier: MIT OR Apache-2.0
//! `foveate estimate --compare`: which designs stand in the table.

use foveate_design::{
    Config, Design, DesignError, FeatureKind, Filter, Organization, SpatialConfig,
};
use foveate_estimate::{Comparison, Skipped};

use super::flow::Flow;
use crate::args::EstimateArgs;
use crate::error::CliError;
use crate::output;
use crate::progress::Progress;

/// Frames per second of the folded arrays, the fewer the more regions share a lane.
const FOLDED_RATES: [u64; 2] = [1000, 30];

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
    let mut comparison = Comparison::new(args.clock);
    let mut wanted = organizations(&base);
    wanted.extend(FOLDED_RATES.map(|rate| folded(&base, rate, &comparison)));
    let progress = Progress::new(args.quiet);
    let all = wanted.len() as u64;
    for (done, Wanted { name, family, design }) in (0..).zip(wanted) {
        progress.steps("synthesizing with Yosys", done, all);
        match design {
            Ok(design) => {
                let report = flow.estimate(&design, false)?;
                comparison.push(name, design.timing().clocks_per_frame(), report);
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
fn folded(base: &Config, rate: u64, comparison: &Comparison) -> Wanted {
    let feature = FeatureKind::default();
    let one = with_feature(base, feature, Filter::Median3x3).to_toml();
    let with_fold = |fold: u32| {
        let serial = ["organization=\"serial\"", "feed=\"raster\"", &format!("fold={fold}")]
            .map(|key| format!("hardware.{key}"));
        Config::from_toml_with(&one, &serial)?.validate()
    };
    let fast = |design: &Design| comparison.rate(design.timing().clocks_per_frame()) >= rate;
    let design = with_fold(1).map(|single| {
        let folds = (1..=single.regions()).rev();
        folds.filter_map(|fold| with_fold(fold).ok()).find(fast).unwrap_or(single)
    });
    let fold = design.as_ref().map_or(1, |design| design.config().hardware.fold);
    Wanted {
        name: format!("serial {feature} median raster fold {fold}"),
        family: "serial with raster feed".to_owned(),
        design,
    }
}

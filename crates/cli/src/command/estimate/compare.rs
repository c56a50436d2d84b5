// SPDX-License-Identifier: MIT OR Apache-2.0
//! `foveate estimate --compare`: the designs of the table.

use foveate_camera::{ConfigError, DenoiseFilter, FeatureKind, SpatialConfig};
use foveate_design::{Design, DesignConfig, Organization, PixelFeed};
use foveate_estimate::{DesignComparison, FoldCost, SkippedDesign, cheapest_fold};

use super::synthesis::SynthesisTools;
use crate::args::EstimateArgs;
use crate::error::CliError;
use crate::output;
use crate::progress::Progress;

/// The frame rates of the folded arrays, in frames per second. A lower rate lets more regions share
/// a lane. Each array has the cheapest fold that its clock allows.
const FOLDED_RATES: [u64; 2] = [500, 30];

/// A row of the table, before its synthesis.
struct PlannedRow {
    name: String,
    /// The name under which the row is reported, once for the whole family, if the design is
    /// refused.
    family: String,
    design: Result<Design, ConfigError>,
}

pub(super) fn run(args: &EstimateArgs, flow: &SynthesisTools) -> Result<(), CliError> {
    let base = args.design.config()?;
    args.design.design()?;
    let given = args.clock.map(f64::from);
    let mut comparison = DesignComparison::new(given);
    let wanted = organization_rows(&base);
    let progress = Progress::new(args.quiet);
    let all = (wanted.len() + FOLDED_RATES.len()) as u64;
    let rows = wanted.into_iter().map(Ok);
    let folded = FOLDED_RATES.into_iter().map(|rate| folded_row(&base, rate, given, flow));
    for (done, row) in (0..).zip(rows.chain(folded)) {
        progress.report_steps("synthesizing with Yosys", done, all);
        let PlannedRow { name, family, design } = row?;
        match design {
            Ok(design) => {
                let report = flow.estimate(&design, false)?;
                comparison.push(name, report);
            }
            Err(error) => {
                let skipped = SkippedDesign { name: family, reason: error.to_string() };
                if !comparison.skipped.contains(&skipped) {
                    comparison.skipped.push(skipped);
                }
            }
        }
    }
    progress.finish();
    output::print_report((args.json, args.markdown), &comparison, &comparison.table())
}

/// Returns the rows of the design in each organization, with each of its features without a filter
/// and with the median, and with the default feature and each other filter. The keys that only one
/// organization has are those of the design in its own organization, and have their defaults in the
/// others.
fn organization_rows(base: &DesignConfig) -> Vec<PlannedRow> {
    Organization::ALL.iter().flat_map(|&organization| rows_of(base, organization)).collect()
}

/// Returns the rows of one organization. If all of them are refused, they are one family, otherwise
/// those of each feature are.
fn rows_of(base: &DesignConfig, organization: Organization) -> Vec<PlannedRow> {
    let mut list = Vec::new();
    for &filter in DenoiseFilter::ALL {
        for kind in compared_features(organization, filter) {
            let mut config = with_feature(base, kind, filter);
            if organization != base.hardware.organization.kind() {
                config.hardware.organization = organization.into();
            }
            config.hardware.unfold();
            let filter_name = match filter {
                DenoiseFilter::None => "",
                DenoiseFilter::Median3x3 => " median",
                DenoiseFilter::Switching3x3 => " switching",
                DenoiseFilter::Binomial3x3 => " binomial",
            };
            list.push(PlannedRow {
                name: format!("{organization} {kind}{filter_name}"),
                family: format!("{organization} {kind}"),
                design: config.validate(),
            });
        }
    }
    if list.iter().all(|row| row.design.is_err()) {
        list.iter_mut().for_each(|row| row.family = organization.to_string());
    }
    list
}

fn compared_features(organization: Organization, filter: DenoiseFilter) -> Vec<FeatureKind> {
    match filter {
        DenoiseFilter::None | DenoiseFilter::Median3x3 => organization.feature_kinds(),
        DenoiseFilter::Switching3x3 | DenoiseFilter::Binomial3x3 => vec![FeatureKind::default()],
    }
}

fn with_feature(base: &DesignConfig, kind: FeatureKind, filter: DenoiseFilter) -> DesignConfig {
    let mut config = base.clone();
    config.camera.denoise.filter = filter;
    let own = base.camera.spatial.iter().find(|entry| entry.feature == kind).cloned();
    config.camera.spatial = vec![own.unwrap_or_else(|| SpatialConfig::new(kind))];
    config
}

/// Returns the row of a serial array with the median, the default feature and raster feed, in the
/// cheapest number of lanes that reaches `rate` frames per second.
fn folded_row(
    base: &DesignConfig,
    rate: u64,
    given: Option<f64>,
    flow: &SynthesisTools,
) -> Result<PlannedRow, CliError> {
    let feature = FeatureKind::default();
    let mut config = with_feature(base, feature, DenoiseFilter::Median3x3);
    let serial = config.hardware.make_serial();
    (serial.feed, serial.fold) = (Some(PixelFeed::Raster), 1);
    let synthesize = |design: &Design| {
        let report = flow.estimate(design, false)?;
        let clock_mhz = given.or(report.clock.as_ref().map(|clock| clock.mhz));
        Ok::<_, CliError>(FoldCost { clock_mhz, area: *report.whole_area() })
    };
    let design = match config.validate() {
        Ok(single) => Ok(cheapest_fold(single, rate, synthesize)?),
        Err(error) => Err(error),
    };
    let fold = design.as_ref().map_or(1, |design| design.slots());
    Ok(PlannedRow {
        name: format!("serial {feature} median raster fold {fold}"),
        family: "serial with raster feed".to_owned(),
        design,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Returns the names of the rows with `flow`, and the family of each row that is refused.
    fn flow_rows(overrides: &[&str]) -> (Vec<String>, Vec<String>) {
        let rows = organization_rows(&DesignConfig::from_toml_with("", overrides).unwrap());
        let refused = rows.iter().filter(|row| row.design.is_err());
        let refused = refused.map(|row| row.family.clone()).collect();
        let names = rows.into_iter().map(|row| row.name);
        (names.filter(|name| name.contains("flow")).collect(), refused)
    }

    #[test]
    fn a_feature_has_rows_in_the_organizations_that_support_it() {
        let (names, refused) = flow_rows(&[]);
        assert_eq!(names, ["serial flow", "serial flow median"]);
        assert_eq!(refused, Vec::<String>::new());
        let (_, refused) = flow_rows(&["temporal.reference='last-sent'"]);
        assert_eq!(refused, ["serial flow"; 2], "only the rows of flow have no reference");
        let (_, mut refused) = flow_rows(&["region.size=3", "temporal.min_count=2"]);
        refused.dedup();
        // The default minimum of `segment` is above all its scores, and `serial` has no such
        // regions.
        assert_eq!(refused, ["pipelined segment", "serial", "raster segment"]);
    }
}

// SPDX-License-Identifier: MIT OR Apache-2.0
//! `foveate estimate`: area from Yosys beside the paper's table.

use foveate_emit::Top;
use foveate_estimate::{
    Candidate, EstimateJob, Report, compare_markdown, compare_text, estimate, render_markdown,
    render_text,
};
use foveate_spec::{Config, Design, FeatureKind, Filter, SpatialConfig};
use foveate_toolchain::{Cache, Toolchain};
use serde::Serialize;

use crate::args::EstimateArgs;
use crate::error::CliError;
use crate::{interrupt, output, progress};

pub(crate) fn run(args: &EstimateArgs) -> Result<(), CliError> {
    let flow = Flow { toolchain: interrupt::toolchain()?, cache: Cache::from_env()? };
    if args.compare { compare(args, &flow) } else { one(args, &flow) }
}

#[derive(Serialize)]
struct Comparison {
    format_version: u32,
    candidates: Vec<Candidate>,
}

/// What every synthesis needs.
struct Flow {
    toolchain: Toolchain,
    cache: Cache,
}

impl Flow {
    fn estimate(&self, design: &Design) -> Result<Report, CliError> {
        super::pipelined(design)?;
        let sources = foveate_emit::verilog(design, Top::Rcm);
        let job = EstimateJob {
            sources: sources.into_iter().map(|file| (file.path, file.contents)).collect(),
            rpu_top: Top::Rpu.module().to_owned(),
            rcm_top: Top::Rcm.module().to_owned(),
            regions: design.regions().into(),
        };
        Ok(estimate(&self.toolchain, &self.cache, &job)?)
    }
}

fn one(args: &EstimateArgs, flow: &Flow) -> Result<(), CliError> {
    let design = args.design.design()?;
    let spinner = progress::spinner(args.quiet, "synthesizing with Yosys");
    let report = flow.estimate(&design);
    spinner.finish_and_clear();
    let report = report?;
    if args.json {
        output::json(&report)
    } else if args.markdown {
        output::text(&render_markdown(&report))
    } else {
        output::text(&render_text(&report, output::width()))
    }
}

fn compare(args: &EstimateArgs, flow: &Flow) -> Result<(), CliError> {
    super::pipelined(&args.design.design()?)?;
    let designs = variants(&args.design.read()?)?;
    let bar = progress::bar(args.quiet, designs.len() as u64, "synthesizing with Yosys");
    let mut candidates = Vec::new();
    for (name, design) in designs {
        candidates.push(Candidate {
            name,
            cycles_per_frame: super::pipelined(&design)?.cycles_per_frame,
            report: flow.estimate(&design)?,
        });
        bar.inc(1);
    }
    bar.finish_and_clear();
    if args.json {
        output::json(&Comparison { format_version: 1, candidates })
    } else if args.markdown {
        output::text(&compare_markdown(&candidates))
    } else {
        output::text(&compare_text(&candidates, output::width()))
    }
}

/// The design with each feature, without and with denoising, on a frame of one region.
fn variants(base: &Config) -> Result<Vec<(String, Design)>, CliError> {
    let mut list = Vec::new();
    for &filter in Filter::ALL {
        for &kind in FeatureKind::ALL {
            let mut config = base.clone();
            config.denoise.filter = filter;
            config.frame.width = Some(config.region.size);
            config.frame.height = Some(config.region.size);
            let same = |entry: &&SpatialConfig| entry.feature == kind;
            let own = base.spatial.iter().find(same).cloned();
            config.spatial = vec![own.unwrap_or_else(|| SpatialConfig::new(kind))];
            let name = match filter {
                Filter::None => kind.to_string(),
                Filter::Median3x3 => format!("{kind}, median"),
            };
            list.push((name, config.validate()?));
        }
    }
    Ok(list)
}

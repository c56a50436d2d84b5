// SPDX-License-Identifier: MIT OR Apache-2.0
//! The choices of a camera as the Verilog knows them: flags and numbers for parameters, inputs
//! or constants for thresholds ([`threshold_signal`], [`threshold_constants`]), and words for
//! scores. A new kind of reference, or a new content of irrelevant regions, must be mapped to
//! these flags before it can be generated.

use foveate_camera::{Camera, DenoiseFilter, FeatureKind, IrrelevantRendering, ReferencePolicy};
use foveate_design::{Design, DesignThreshold, Port, PortRole, ThresholdSource};

/// Returns `LAST_SENT`, which is also whether a pipelined RPU stores the pixels sent last. The
/// Verilog knows two references, so the flag has two values. Code that needs another property of
/// the reference asks the reference itself.
pub(crate) fn last_sent_flag(camera: &Camera) -> bool {
    match camera.temporal().reference {
        ReferencePolicy::Previous => false,
        ReferencePolicy::LastSent => true,
    }
}

/// Returns `BLANKS`: whether an irrelevant region becomes black or shows its means, and so loses
/// its reference.
pub(crate) fn blanks_flag(camera: &Camera) -> bool {
    match camera.irrelevant() {
        IrrelevantRendering::Zero | IrrelevantRendering::Mean => true,
        IrrelevantRendering::Hold => false,
    }
}

pub(crate) fn parameter_prefix(kind: FeatureKind) -> String {
    kind.name().to_uppercase()
}

pub(crate) fn filter_number(filter: DenoiseFilter) -> u32 {
    match filter {
        DenoiseFilter::None => 0,
        DenoiseFilter::Median3x3 => 1,
        DenoiseFilter::Switching3x3 => 2,
        DenoiseFilter::Binomial3x3 => 3,
    }
}

/// A threshold that is a constant in the Verilog.
pub(crate) struct ThresholdConstant {
    pub(crate) name: String,
    pub(crate) width: u32,
    pub(crate) value: u64,
}

/// Returns the scores and how they are formed, as words.
pub(crate) fn scores_text(design: &Design) -> String {
    let names: Vec<_> = design.features().iter().map(|f| f.kind().name()).collect();
    format!(
        "{} ({}), temporal against {}; {} neighborhood, filter {}",
        names.join(", "),
        design.combine(),
        design.temporal().reference,
        design.neighborhood(),
        design.filter()
    )
}

/// A function that returns the signal of a threshold in the regions of a class.
pub(crate) type ThresholdSignal = fn(&Design, PortRole) -> String;

/// Returns the input port of a threshold, or the constant that takes its place.
pub(crate) fn threshold_signal(design: &Design, role: PortRole) -> String {
    match design.threshold_source() {
        ThresholdSource::Runtime => {
            design
                .rpu_ports()
                .into_iter()
                .find(|port| port.role == role)
                .expect("a threshold of the design is a port")
                .name
        }
        ThresholdSource::Constant => constant_name(role),
    }
}

/// Returns the input port or the constant of the summary level. The array and the core have this
/// input whether irrelevant regions send summaries or not.
pub(crate) fn summary_level_signal(design: &Design) -> String {
    match design.periphery() {
        Some(_) => threshold_signal(design, PortRole::SummaryLevel),
        None => format!("{}'d0", design.pixel_bits()),
    }
}

fn constant_name(role: PortRole) -> String {
    let upper = |kind: FeatureKind| kind.name().to_uppercase();
    match role {
        PortRole::Level(kind) => format!("{}_LEVEL", upper(kind)),
        PortRole::MinScore(kind) => format!("{}_MIN", upper(kind)),
        PortRole::TemporalLevel => "TEMPORAL_LEVEL".to_owned(),
        PortRole::TemporalMinCount => "TEMPORAL_MIN".to_owned(),
        PortRole::SummaryLevel => "SUMMARY_LEVEL".to_owned(),
        PortRole::KeenLevel(kind) => format!("KEEN_{}_LEVEL", upper(kind)),
        PortRole::KeenMinScore(kind) => format!("KEEN_{}_MIN", upper(kind)),
        PortRole::KeenTemporalLevel => "KEEN_TEMPORAL_LEVEL".to_owned(),
        PortRole::KeenTemporalMinCount => "KEEN_TEMPORAL_MIN".to_owned(),
        PortRole::KeenSummaryLevel => "KEEN_SUMMARY_LEVEL".to_owned(),
        PortRole::OffSummaryLevel => "OFF_SUMMARY_LEVEL".to_owned(),
        _ => unreachable!("{role:?} is no threshold"),
    }
}

/// Returns the constants of the thresholds; none if thresholds are inputs.
pub(crate) fn threshold_constants(design: &Design) -> Vec<ThresholdConstant> {
    match design.threshold_source() {
        ThresholdSource::Runtime => Vec::new(),
        ThresholdSource::Constant => {
            let constant = |DesignThreshold { role, width, value, .. }| ThresholdConstant {
                name: constant_name(role),
                width,
                value,
            };
            design.thresholds().into_iter().map(constant).collect()
        }
    }
}

/// Returns the configured value of a threshold input; `None` for other ports.
pub(crate) fn threshold_value(design: &Design, port: &Port) -> Option<u64> {
    let thresholds = design.thresholds();
    thresholds.iter().find(|threshold| threshold.role == port.role).map(|one| one.value)
}

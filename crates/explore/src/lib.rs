// SPDX-License-Identifier: MIT OR Apache-2.0
//! Studies of designs over footage. An exploration has many designs over the same clips: the errors
//! of each design against the ideal camera, its cost and its speed; and fits, which find the
//! cheapest design that a scene needs.
//!
//! [`explore`](fn@explore) runs a [`DesignSpace`] of designs over clips and writes a folder of
//! tables, Pareto fronts, configurations and one page. It continues an interrupted run.
//! [`plan_units`] and [`measure_unit`] distribute the measurements over machines. The ideal camera
//! is the whole-frame floating-point camera of [`foveate_ideal`], and the figures are those of
//! [`foveate_measure`]. The library never prints: progress and cancellation go through
//! [`foveate_media::RunHooks`].
//!
//! [`link`] compares what a camera sends with other senders, and [`studies`] are those of the
//! paper.

mod compare;
mod cost;
mod design_disturbance;
mod disturbance;
mod error;
mod error_source;
mod exploration;
mod explore;
mod fit;
mod folder;
mod footage;
pub mod link;
mod link_load;
mod measure;
mod method;
mod objective;
mod point;
mod point_synthesis;
mod progress;
mod report;
mod request;
mod row;
mod space;
mod store;
pub mod studies;
mod target_process;
mod unit;

pub use compare::{CameraComparison, compare};
pub use cost::{DesignArea, Synthesizer};
pub use design_disturbance::{DisturbanceRow, DisturbedDesign, disturb_design};
pub use disturbance::Disturbance;
pub use error::ExploreError;
pub use error_source::ErrorSourceRow;
pub use exploration::{ClipRow, DesignFront, Exploration};
pub use explore::explore;
pub use fit::{
    ActivityTarget, AgreementEstimate, ConstraintCheck, Constraints, CostObjective, FitRequest,
    FitResult, FittedDesign, FittedNetwork, NetworkGoal, fit,
};
pub use folder::check_folder;
pub use foveate_measure::{FidelityFigures, ScoreError};
pub use link_load::LoadFigures;
pub use method::{SamplingMethod, SpaceAxis};
pub use point::{DesignPoint, RefusedCombination};
pub use request::{ExploreRequest, ProcessRequest, SynthesisRequest};
pub use row::{DesignRow, FrontMembership, WorstClip};
pub use space::{BUILT_IN_SPACES, BuiltInSpace, DesignSpace};
pub use target_process::{ProcessEnergy, ProcessFigures, TargetProcess};
pub use unit::{WorkUnit, measure_unit, plan_units};

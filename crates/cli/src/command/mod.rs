// SPDX-License-Identifier: MIT OR Apache-2.0
//! One module per sub-command.

pub(crate) mod analyze;
pub(crate) mod bench;
pub(crate) mod build;
pub(crate) mod check;
pub(crate) mod completions;
pub(crate) mod cosim;
pub(crate) mod dataset;
pub(crate) mod decode;
pub(crate) mod estimate;
pub(crate) mod explain;
pub(crate) mod explore;
pub(crate) mod features;
pub(crate) mod fit;
pub(crate) mod generate;
pub(crate) mod infer;
pub(crate) mod link;
pub(crate) mod live;
pub(crate) mod man;
pub(crate) mod presets;
pub(crate) mod simulate;
pub(crate) mod stress;
pub(crate) mod view;

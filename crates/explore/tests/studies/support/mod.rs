// SPDX-License-Identifier: MIT OR Apache-2.0
//! Runs of studies over scenes.

use std::path::{Path, PathBuf};

use foveate_design::DesignConfig;
use foveate_explore::studies::{Study, StudyError, StudyReport, StudyRequest, analyze};
use foveate_media::{InputOptions, SilentHooks};

pub(crate) fn config(text: &str) -> DesignConfig {
    DesignConfig::from_toml_with("frame.width = 32\nframe.height = 16", &[text]).unwrap()
}

pub(crate) fn run(
    study: Study,
    inputs: &[&str],
    config: &DesignConfig,
    output: &Path,
) -> Result<StudyReport, StudyError> {
    let inputs: Vec<PathBuf> = inputs.iter().map(PathBuf::from).collect();
    let input = InputOptions { frames: Some(5), ..InputOptions::default() };
    let request = StudyRequest {
        study,
        inputs: &inputs,
        input: &input,
        config,
        sensor_events: None,
        sensor_start_us: 0,
        boxes: &[],
    };
    analyze(&request, output, true, &SilentHooks)
}

pub(crate) fn cells<'a>(report: &'a StudyReport, column: &str) -> Vec<&'a str> {
    let at = report.columns.iter().position(|name| *name == column).unwrap();
    report.rows.iter().map(|row| row[at].as_str()).collect()
}

// SPDX-License-Identifier: MIT OR Apache-2.0
//! Filled templates, and the README of a project.

use askama::Template;

use crate::project::Project;
use crate::script;

#[derive(Template)]
#[template(path = "README.md")]
struct Readme<'a> {
    banner: String,
    title: &'a str,
    page: &'a str,
    sensor: &'a str,
    width: u32,
    height: u32,
    regions: u32,
    side: u32,
    core_mhz: u32,
    baud: u32,
    fps: String,
    most: String,
    wires: Vec<(String, String)>,
    install: &'static str,
    flash: String,
}

/// A filled template, ending in the newline that askama drops.
pub(crate) fn text_of(view: &impl Template) -> String {
    let text = view.render();
    text.map_or_else(|e| unreachable!("a template only fails when writing does: {e}"), |t| t + "\n")
}

pub(crate) fn readme(project: &Project) -> String {
    let Project { board, design, sensor, .. } = project;
    text_of(&Readme {
        banner: project.banner(),
        title: &board.title,
        page: &board.page,
        sensor: &sensor.title,
        width: design.width(),
        height: design.height(),
        regions: design.regions(),
        side: design.region_size(),
        core_mhz: board.clock.core_mhz,
        baud: board.serial.baud,
        fps: format!("{:.0}", project.sensor_fps()),
        most: format!("{:.0}", project.core_fps(f64::from(board.clock.core_mhz))),
        wires: project.wires(),
        install: script::tools(board.device.family).install,
        flash: project.flash(),
    })
}

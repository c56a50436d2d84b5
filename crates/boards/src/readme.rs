// SPDX-License-Identifier: MIT OR Apache-2.0
//! The README of a project.

use std::borrow::Cow;

use askama::Template;
use foveate_tools::escaping::markdown_text;

use crate::pattern::COMPARED_FRAMES;
use crate::project::{BoardProject, PortPin};
use crate::script;
use crate::text::rendered;

#[derive(Template)]
#[template(path = "README.md")]
struct ReadmeTemplate<'a> {
    banner: String,
    title: Cow<'a, str>,
    page: &'a str,
    sensor: Cow<'a, str>,
    width: u32,
    height: u32,
    regions: u32,
    side: u32,
    core_mhz: u32,
    baud: u32,
    fps: String,
    core_fps: String,
    wires: Vec<PortPin>,
    is_open: bool,
    has_sensor: bool,
    is_array: bool,
    columns: u32,
    rows: u32,
    frames: u32,
    install: &'static str,
    flash: String,
}

pub(crate) fn readme(project: &BoardProject) -> String {
    let BoardProject { board, design, .. } = project;
    let tools = script::open_tools(board.device.family);
    rendered(&ReadmeTemplate {
        banner: project.banner(),
        title: markdown_text(&board.title),
        page: &board.page,
        sensor: markdown_text(project.sensor_title()),
        width: design.width(),
        height: design.height(),
        regions: design.regions(),
        side: design.region_size(),
        core_mhz: board.clock.core_mhz,
        baud: board.serial.baud,
        fps: format!("{:.0}", project.incoming_fps()),
        core_fps: format!("{:.0}", project.core_fps(f64::from(board.clock.core_mhz))),
        wires: project.port_pins(),
        is_open: project.is_open(),
        has_sensor: project.sensor.is_some(),
        is_array: project.is_array(),
        columns: design.columns(),
        rows: design.rows(),
        frames: COMPARED_FRAMES,
        install: tools.map_or("", |tools| tools.install),
        flash: project.load_command(),
    })
}

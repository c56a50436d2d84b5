// SPDX-License-Identifier: MIT OR Apache-2.0
//! The list of all files of a project ([`BoardProject::files`]), and its README, which
//! describes them.

use super::build;
use super::text_forms::{rendered, source_file};
use crate::pattern::COMPARED_FRAMES;
use crate::project::PortPin;
use crate::{BoardProject, constraints, top};
use askama::Template;
use foveate_design::Hardware;
use foveate_emit::{SourceFile, array_software, axi_software};
use foveate_tools::escaping::markdown_text;
use std::borrow::Cow;

impl BoardProject {
    /// Returns all files of the project.
    #[must_use]
    pub fn files(&self) -> Vec<SourceFile> {
        let mut files = top::modules(self);
        let sources: Vec<_> = files.iter().map(|file| file.path.clone()).collect();
        let list: String = sources.iter().map(|path| format!("{path}\n")).collect();
        let toml = format!("# {}\n\n{}", self.banner(), self.design.config().to_toml());
        files.extend(match self.design.hardware() {
            Hardware::Pipelined(own) => array_software(self.design.with_hardware(own)),
            Hardware::Serial(_) | Hardware::Raster(_) => axi_software(&self.design),
        });
        files.push(source_file("board.f", list));
        files.push(source_file("sim/board_clock.v", top::clock_module(self, true)));
        files.push(source_file("design.toml", toml));
        files.push(source_file("board.toml", self.board.text.clone()));
        files.extend(
            self.sensor.iter().map(|(sensor, _)| source_file("sensor.toml", sensor.text.clone())),
        );
        files.push(constraints::pin_file(self));
        files.extend(build::script_files(self, &sources));
        files.push(source_file("README.md", readme(self)));
        files
    }
}

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
    let tools = build::open_tools(board.device.family);
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

// SPDX-License-Identifier: MIT OR Apache-2.0
//! The files of a project.

use foveate_design::Hardware;
use foveate_emit::{SourceFile, array_software, axi_software};

use crate::text::source_file;
use crate::{BoardProject, constraints, readme, script, top};

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
        files.extend(script::script_files(self, &sources));
        files.push(source_file("README.md", readme::readme(self)));
        files
    }
}

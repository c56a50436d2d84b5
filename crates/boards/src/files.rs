// SPDX-License-Identifier: MIT OR Apache-2.0
//! The files of a project.

use foveate_design::Hardware;
use foveate_emit::{SourceFile, array_software, software};

use crate::text::file;
use crate::{Project, constraints, readme, script, top};

impl Project {
    /// Returns all files of the project.
    #[must_use]
    pub fn files(&self) -> Vec<SourceFile> {
        let mut files = top::modules(self);
        let sources: Vec<_> = files.iter().map(|file| file.path.clone()).collect();
        let list: String = sources.iter().map(|path| format!("{path}\n")).collect();
        let toml = format!("# {}\n\n{}", self.banner(), self.design.config().to_toml());
        files.extend(match self.design.hardware() {
            Hardware::Pipelined(own) => array_software(self.design.on(own)),
            Hardware::Serial(_) | Hardware::Raster(_) => software(&self.design),
        });
        files.push(file("board.f", list));
        files.push(file("sim/board_clock.v", top::clock(self, true)));
        files.push(file("design.toml", toml));
        files.push(file("board.toml", self.board.text.clone()));
        files.extend(self.eye.iter().map(|(sensor, _)| file("sensor.toml", sensor.text.clone())));
        files.push(constraints::file_of(self));
        files.extend(script::files(self, &sources));
        files.push(file("README.md", readme::readme(self)));
        files
    }
}

// SPDX-License-Identifier: MIT OR Apache-2.0
//! A run of a core on its buses, from the scenes to the report.

use super::checker::{BusAgreement, BusChecker};
use super::replay::{BusRecord, BusReplay};
use super::scenes::{BusScene, OtherThresholds, SceneBuilder, cameras};
use super::thresholds::{StaleThreshold, other_threshold_designs, threshold_sweep};
use super::traffic::{Traffic, program};
use crate::error::CosimError;
use crate::job::CosimProgress;
use crate::level::CosimLevel;
use crate::mismatch::Mismatch;
use crate::replay;
use crate::report::{CosimReport, StepSeconds};
use crate::simulation::{Simulator, UNKNOWN_START, WAVES_FILE};
use crate::situations::{BusSituationCounts, Occurrences};
use foveate_camera::RegionClass;
use foveate_design::{Design, RasterDesign};
use foveate_emit::{AXI_TOP, Prefix, Register, SourceFile, axi_modules, axi_registers};
use foveate_pixels::Frame;
use foveate_tools::{
    Cache, Invocation, ScratchFolder, Source, Tool, Toolchain, sources_sha256,
    verilator::{self, LintMode, OptimizationLevel, VerilatorJob},
    write_file,
};
use std::fs::{self, File};
use std::io::BufReader;
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

/// The name of the scene that plays the frames of the caller.
const FRAMES_SCENE: &str = "frames of the inputs";

/// A core on AXI to run in Verilator.
#[derive(Clone, Debug)]
pub struct BusJob {
    /// The design; its core is on AXI.
    pub design: Design,
    /// The Verilog: the files that the emitter makes of the design, or an edited version of them.
    pub sources: Vec<SourceFile>,
    /// The prefix of the module names.
    pub prefix: Prefix,
    /// The seed of all random data.
    pub seed: u64,
    /// The number of times that the directed scenes are played, each time with other data. With 0
    /// only the frames are played.
    pub rounds: u32,
    /// The frames of the caller, of the size and depth of the design. They come after the scenes,
    /// and none of them may be lost.
    pub frames: Vec<Frame>,
    /// The file for the packets of the scene with the frames.
    pub packets: Option<PathBuf>,
    /// True if waves of a failing scene are written.
    pub trace: bool,
    /// The folder for the replay of a failing run.
    pub output: PathBuf,
    /// The longest time that the simulation of a scene may take.
    pub limit: Duration,
}

/// The built program of a job, and the sources that it was made from.
struct BuiltProgram {
    top: String,
    sources: Vec<Source>,
    program: String,
    executable: PathBuf,
    /// The version of Verilator.
    version: String,
}

/// The combined result of all scenes.
#[derive(Default)]
struct BusOutcome {
    clocks: u64,
    agreement: BusAgreement,
    facts: BusSituationCounts,
    mismatch: Option<Mismatch>,
    /// The folder that replays the mismatch.
    replay: Option<PathBuf>,
}

/// The result of one scene.
struct PlayedScene {
    record: BusRecord,
    record_file: PathBuf,
    wave_file: Option<PathBuf>,
}

impl BusJob {
    /// Returns a job with the Verilog that the emitter makes, or `None` if the core of the design
    /// is not on a bus.
    #[must_use]
    pub fn new(design: &Design, output: &Path) -> Option<Self> {
        Some(Self {
            sources: axi_modules(design)?,
            design: design.clone(),
            prefix: Prefix::default(),
            seed: 1,
            rounds: 1,
            frames: Vec::new(),
            packets: None,
            trace: false,
            output: output.to_owned(),
            limit: Duration::from_secs(3600),
        })
    }

    /// Returns the name of the job for people.
    #[must_use]
    pub fn name(&self) -> String {
        format!("axi {}", Simulator::Verilator)
    }

    /// Returns the name of the simulated module.
    #[must_use]
    pub fn top(&self) -> String {
        self.prefix.prefixed_name(AXI_TOP)
    }

    /// Runs the job and returns its report. A mismatch is a result and not an error.
    ///
    /// # Errors
    /// Fails if there is no result: a tool is missing or fails, a frame does not fit, a folder
    /// cannot be written, or the toolchain's flag has stopped the run.
    ///
    /// # Panics
    /// Panics if the core of the design is not on a bus.
    pub fn run(
        &self,
        toolchain: &Toolchain,
        cache: &Cache,
        progress: &mut dyn FnMut(CosimProgress),
    ) -> Result<CosimReport, CosimError> {
        let design = self.design.as_raster().expect("only a raster design is on a bus");
        self.check_frames()?;
        replay::check_folder(&self.output)?;
        toolchain.find(Tool::Verilator)?;
        replay::remove_earlier(&self.output)?;

        let start = Instant::now();
        let (classes, others) = self.other_designs();
        let cameras = cameras(&self.design, &others);
        let all: Vec<Design> = std::iter::once(&self.design).chain(&others).cloned().collect();
        let missed = StaleThreshold::all_of(&all);
        let others = others.iter().filter_map(Design::as_raster).map(axi_registers);
        let others: Vec<_> = classes
            .into_iter()
            .zip(others)
            .map(|(class, registers)| OtherThresholds { class, registers })
            .collect();
        let registers = axi_registers(design);
        let scenes = self.scenes(design, &registers, &others);
        let vectors = start.elapsed();
        if scenes.is_empty() {
            return Err(CosimError::NothingToSimulate);
        }

        let clocks = scenes.iter().map(|(_, traffic)| traffic.text().lines().count() as u64).sum();
        progress(CosimProgress::Simulation { clocks });
        let start = Instant::now();
        let built = self.build(design, toolchain, cache)?;
        let build = start.elapsed();

        let start = Instant::now();
        let checker = BusChecker::new(design, &cameras, &registers, &missed);
        let BusOutcome { clocks, agreement: agreed, facts, mismatch, replay } =
            self.play_all(&built, &scenes, &checker, toolchain)?;
        // A caller that asks for frames alone does not ask for situations.
        let situations = match self.rounds {
            0 => Occurrences::default(),
            _ => {
                let thresholds: Vec<String> =
                    missed.iter().map(|missed| missed.register.clone()).collect();
                facts.occurrences(design, &thresholds)
            }
        };
        Ok(CosimReport {
            situations,
            name: self.name(),
            design: self.design.fingerprint(),
            level: CosimLevel::Full,
            grid: (design.columns(), design.rows()),
            simulator: Simulator::Verilator,
            simulator_version: built.version,
            rtl_sha256: sources_sha256(&built.sources),
            netlist: None,
            seed: self.seed,
            sequences: scenes.len() as u64,
            frames: agreed.frames,
            clocks,
            comparisons: agreed.comparisons,
            mismatch,
            replay,
            waves: None,
            seconds: StepSeconds {
                vectors: vectors.as_secs_f64(),
                build: build.as_secs_f64(),
                run: start.elapsed().as_secs_f64(),
            },
        })
    }

    /// Returns the core with other thresholds, and of each the class whose regions show that they
    /// differ.
    fn other_designs(&self) -> (Vec<RegionClass>, Vec<Design>) {
        let others = other_threshold_designs(&self.design);
        let others = others.into_iter().map(|other| (RegionClass::Normal, other));
        let swept = [RegionClass::Normal, RegionClass::Keen, RegionClass::Off]
            .into_iter()
            .flat_map(|class| {
                threshold_sweep(&self.design, class).into_iter().map(move |other| (class, other))
            });
        others.chain(swept).unzip()
    }

    fn scenes<'a>(
        &self,
        design: RasterDesign<'a>,
        registers: &'a [Register],
        others: &'a [OtherThresholds],
    ) -> Vec<BusScene<'a>> {
        let mut scenes = Vec::new();
        for round in 0..u64::from(self.rounds) {
            let seed = self.seed.wrapping_add(round << 32);
            scenes.extend(SceneBuilder::new(design, registers, others, seed).scenes());
        }
        if !self.frames.is_empty() {
            let mut stage = SceneBuilder::new(design, registers, others, self.seed);
            scenes.push((FRAMES_SCENE, stage.caller_frames(&self.frames)));
        }
        scenes
    }

    fn check_frames(&self) -> Result<(), CosimError> {
        let wanted =
            Frame::filled(self.design.width(), self.design.height(), self.design.pixel_bits(), 0)?
                .size_and_depth();
        match self.frames.iter().position(|frame| frame.size_and_depth() != wanted) {
            None => Ok(()),
            Some(index) => Err(CosimError::FrameShape {
                index,
                found: self.frames[index].size_and_depth(),
                wanted,
            }),
        }
    }

    fn build(
        &self,
        design: RasterDesign<'_>,
        toolchain: &Toolchain,
        cache: &Cache,
    ) -> Result<BuiltProgram, CosimError> {
        let top = self.top();
        let sources: Vec<Source> =
            self.sources.iter().map(|file| (file.path.clone(), file.contents.clone())).collect();
        if !crate::hierarchy::declares(&self.sources, &top) {
            let files: Vec<&str> = sources.iter().map(|(name, _)| name.as_str()).collect();
            return Err(CosimError::NoTop { top, files: files.join(", ") });
        }
        let program = program(&top, design);
        let job = VerilatorJob {
            sources: sources.clone(),
            top: top.clone(),
            cpp_main: program.clone(),
            trace: self.trace,
            optimize: OptimizationLevel::FastBuild,
            lint: LintMode::Lenient,
            extra_args: UNKNOWN_START.map(str::to_owned).into(),
            ..VerilatorJob::default()
        };
        let executable = verilator::build(toolchain, cache, &job)?;
        let version = toolchain.find(Tool::Verilator)?.banner;
        Ok(BuiltProgram { top, sources, program, executable, version })
    }

    /// Plays the scenes in order, up to the first one with a mismatch.
    fn play_all(
        &self,
        built: &BuiltProgram,
        scenes: &[BusScene<'_>],
        checker: &BusChecker<'_>,
        toolchain: &Toolchain,
    ) -> Result<BusOutcome, CosimError> {
        let mut outcome = BusOutcome::default();
        for (name, traffic) in scenes {
            let folder = ScratchFolder::new()
                .map_err(CosimError::temporary("create a folder in", &std::env::temp_dir()))?;
            let played = self.play_scene(built, traffic, folder.path(), toolchain)?;
            outcome.clocks += played.record.clocks.unwrap_or_default();
            if *name == FRAMES_SCENE {
                self.write_packets(&played.record)?;
            }
            match checker.check(traffic.sessions(), &played.record, &mut outcome.facts) {
                Ok(more) => outcome.agreement += more,
                Err(wrong) => {
                    let mismatch = wrong.into_mismatch(name);
                    outcome.replay = Some(self.write_replay(built, traffic, &played, &mismatch)?);
                    outcome.mismatch = Some(mismatch);
                    break;
                }
            }
        }
        Ok(outcome)
    }

    /// Writes the replay folder of a failing scene.
    fn write_replay(
        &self,
        built: &BuiltProgram,
        traffic: &Traffic<'_>,
        played: &PlayedScene,
        mismatch: &Mismatch,
    ) -> Result<PathBuf, CosimError> {
        let replay = BusReplay {
            top: &built.top,
            sources: &built.sources,
            program: &built.program,
            traffic: traffic.text(),
            record_file: &played.record_file,
            wave_file: played.wave_file.as_deref(),
            mismatch,
            version: &built.version,
            seed: self.seed,
            fingerprint: &self.design.fingerprint(),
        };
        replay.write(&self.output)
    }

    fn play_scene(
        &self,
        built: &BuiltProgram,
        traffic: &Traffic<'_>,
        folder: &Path,
        toolchain: &Toolchain,
    ) -> Result<PlayedScene, CosimError> {
        let [script, heard, waves] =
            ["traffic.txt", "heard.txt", WAVES_FILE].map(|name| folder.join(name));
        fs::write(&script, traffic.text()).map_err(CosimError::temporary("write", &script))?;
        let run = Invocation::new(&built.executable)
            .arg(self.seed.to_string())
            .arg(&waves)
            .dir(folder)
            .stdin_file(&script)
            .stdout_file(&heard)
            .timeout(self.limit);
        let output = toolchain.run(&run)?;
        let file = File::open(&heard).map_err(CosimError::temporary("read", &heard))?;
        let record = BusRecord::read(BufReader::new(file)).unwrap_or_default();
        if !output.is_success() || record.clocks.is_none() {
            let log = output.log();
            let tail = log.lines().rev().find(|line| !line.trim().is_empty());
            return Err(CosimError::EndedEarly {
                simulator: Simulator::Verilator.to_string(),
                clocks: traffic.text().lines().count() as u64,
                got: record.clocks.unwrap_or_default(),
                status: output.status.clone(),
                log: tail.map(|line| format!(": {line}")).unwrap_or_default(),
            });
        }
        Ok(PlayedScene { record, record_file: heard, wave_file: self.trace.then_some(waves) })
    }

    /// Writes the packets of a run to the file, in order.
    fn write_packets(&self, record: &BusRecord) -> Result<(), CosimError> {
        let Some(file) = &self.packets else { return Ok(()) };
        let recorded = record.sessions.iter().flat_map(|heard| &heard.packets);
        let bytes: Vec<u8> = recorded.flat_map(|packet| packet.bytes.iter().copied()).collect();
        Ok(write_file(file, &bytes)?)
    }
}

// SPDX-License-Identifier: MIT OR Apache-2.0
//! One run: every frame of a source through a camera and a network, into one folder.

use crate::picture::Picture;
use crate::summary::{Summary, error, layers, macs, mode_name, ratio};
use crate::tally::{Distance, Positions, Reference};
use crate::{InferenceError, Mapping};
use foveate_design::{Config, Design};
use foveate_engine::Engine;
use foveate_footage::{FootageError, Hooks, Kind, Progress, Source, SourceFrame, read_ahead};
use foveate_network::{Executor, FrameSize, Mask, Mode, Network};
use foveate_staging::{Kind as FolderKind, StagedFolder};
use foveate_tables::{Cell, Cells, Table};
use std::path::{Path, PathBuf};
use std::time::Instant;

/// What is computed, and how.
#[derive(Clone, Debug)]
pub struct Options {
    /// What is computed for a frame.
    pub mode: Mode,
    /// How pixels become inputs.
    pub mapping: Mapping,
    /// Whether a whole computation runs beside, to be compared with.
    pub reference: bool,
    /// Whether a folder of an earlier run is replaced.
    pub overwrite: bool,
}

/// A camera, a network, and the frames to show them.
pub struct Inference {
    design: Design,
    network: Network,
    path: PathBuf,
    source: Box<dyn Source>,
}

impl Inference {
    /// Fits the configuration to the frames of the source, and reads the network for them.
    ///
    /// # Errors
    /// When the configuration is not a valid design, or the network cannot be read or takes frames of another size.
    pub fn new(
        config: &Config,
        network: &Path,
        source: Box<dyn Source>,
    ) -> Result<Self, InferenceError> {
        let mut config = config.clone();
        let (width, height) = source.size();
        let network_for = FrameSize { width: width as usize, height: height as usize };
        let path = network.to_owned();
        let network = Network::read(network, network_for)?;
        config.fit_frame(width, height)?;
        Ok(Self { design: config.validate()?, network, path, source })
    }

    /// Runs to the end of the source, or until `hooks` cancels. The folder `output` appears when everything is written; on an error nothing is left.
    ///
    /// # Errors
    /// When a frame cannot be read, the folder cannot be written, or there is no frame.
    pub fn run(
        self,
        output: &Path,
        options: &Options,
        hooks: &mut dyn Hooks,
    ) -> Result<Summary, InferenceError> {
        let Self { design, network, path, mut source } = self;
        options.mapping.check(network.input().shape()[1])?;
        let staging = StagedFolder::new(output, INFERENCE, options.overwrite)?;
        let mut run = Run::new(&design, &network, options, source.kind());
        let total = source.frames();
        let ended = read_ahead(source.as_mut(), |frames| {
            while let Some(current) = frames.next()? {
                if hooks.cancelled() {
                    return Ok::<_, InferenceError>(false);
                }
                run.step(&current)?;
                frames.give_back(current);
                hooks.progress(Progress { done: run.frames, total });
            }
            Ok(true)
        })?;
        let problem = match (ended, run.frames) {
            (false, 0) => return Err(InferenceError::Cancelled),
            (true, 0) => {
                return Err(FootageError::NoFrames { inputs: source.inputs().join(", ") }.into());
            }
            (false, _) => Some("it was interrupted".to_owned()),
            (true, _) => source.problem(),
        };
        let frames = Table::of(std::mem::take(&mut run.rows).into_iter());
        let summary = run.summary(&path, source.inputs(), problem);
        write(&staging, &summary, &frames)?;
        staging.commit()?;
        Ok(summary)
    }
}

impl std::fmt::Debug for Inference {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Inference")
            .field("design", &self.design)
            .field("path", &self.path)
            .finish_non_exhaustive()
    }
}

/// A run under way.
struct Run<'a> {
    design: &'a Design,
    network: &'a Network,
    options: &'a Options,
    kind: Kind,
    engine: Engine,
    picture: Picture,
    executor: Executor<'a>,
    reference: Option<Reference<'a>>,
    /// Picture and executor after a black picture, from which every image of a set begins.
    black: Option<(Picture, Executor<'a>)>,
    full: Mask,
    sums: Vec<Positions>,
    outputs: Distance,
    rows: Vec<Cells>,
    frames: u64,
    counted: u64,
    active: u64,
    changed: u64,
    seconds: f64,
}

impl<'a> Run<'a> {
    fn new(design: &'a Design, network: &'a Network, options: &'a Options, kind: Kind) -> Self {
        let picture = Picture::new(design, network.input(), &options.mapping);
        let full = Mask::full(network.input().height(), network.input().width());
        let begun = |mode| {
            let mut executor = Executor::new(network, mode);
            if kind == Kind::Set {
                executor.step(&picture.values, &full);
            }
            executor
        };
        let executor = begun(options.mode);
        let reference = options.reference.then(|| Reference::new(network, begun(Mode::Dense)));
        Self {
            design,
            network,
            options,
            kind,
            engine: Engine::new(design),
            black: (kind == Kind::Set).then(|| (picture.clone(), executor.clone())),
            picture,
            executor,
            reference,
            full,
            sums: vec![Positions::default(); network.nodes().len()],
            outputs: Distance::default(),
            rows: Vec::new(),
            frames: 0,
            counted: 0,
            active: 0,
            changed: 0,
            seconds: 0.0,
        }
    }

    fn step(&mut self, current: &SourceFrame) -> Result<(), InferenceError> {
        if let Some((picture, executor)) = &self.black {
            self.engine.reset();
            self.picture.clone_from(picture);
            self.executor.clone_from(executor);
        }
        self.engine.step_raster(&current.frame)?;
        self.picture.show(self.engine.rendered());
        let start = Instant::now();
        let work = self.executor.step(&self.picture.values, &self.picture.changed).to_vec();
        let seconds = start.elapsed().as_secs_f64();
        let is_counted = self.kind == Kind::Set || self.frames > 0;
        let judge = |reference: &mut Reference<'_>| {
            reference.judge(&self.picture.values, &self.full, &self.executor, is_counted)
        };
        let error = self.reference.as_mut().map(judge);
        let active = self.engine.outcome().active.iter().filter(|&&active| active).count() as u64;
        let mut own = vec![Positions::default(); work.len()];
        for (node, work) in work.iter().enumerate() {
            let places = self.network.form(node + 1).places();
            own[node].add(work, places);
            if is_counted {
                self.sums[node].add(work, places);
            }
        }
        if is_counted {
            self.counted += 1;
            self.active += active;
            self.changed += self.picture.changed_regions as u64;
            self.seconds += seconds;
            self.outputs.add(error.unwrap_or_default());
        }
        let macs = macs(self.network, &own);
        let regions = u64::from(self.design.regions());
        let real = |value: f64| Cell::Real(Some(value));
        self.rows.push(
            [
                ("frame", Cell::Count(Some(self.frames))),
                ("name", Cell::Text(current.name.clone())),
                ("t_us", Cell::Count(Some(current.time_us))),
                ("active_share", real(ratio(active, regions))),
                ("changed_share", real(ratio(self.picture.changed_regions as u64, regions))),
                ("macs_dense", real(macs.dense)),
                ("macs_needed", real(macs.needed)),
                ("macs_scheduled", real(macs.scheduled)),
                ("seconds", real(seconds)),
                ("relative_rms", Cell::Real(error.map(|error| error.relative()))),
            ]
            .map(|(name, cell)| (name.to_owned(), cell))
            .into(),
        );
        self.frames += 1;
        Ok(())
    }

    fn summary(self, path: &Path, inputs: &[String], problem: Option<String>) -> Summary {
        let layers = layers(self.network, &self.sums, self.reference.as_ref());
        let counted_regions = self.counted * u64::from(self.design.regions());
        let forms = || (0..=self.network.nodes().len()).map(|value| self.network.form(value));
        #[allow(clippy::cast_precision_loss, reason = "a mean")]
        let counted = self.counted.max(1) as f64;
        Summary {
            format_version: 1,
            foveate_version: env!("CARGO_PKG_VERSION"),
            complete: problem.is_none(),
            problem,
            inputs: inputs.to_vec(),
            network: path.display().to_string(),
            mode: mode_name(self.options.mode),
            mapping: self.options.mapping.clone(),
            width: self.design.width(),
            height: self.design.height(),
            frames: self.frames,
            counted_frames: self.counted,
            active_share: ratio(self.active, counted_regions),
            changed_share: ratio(self.changed, counted_regions),
            macs: macs(self.network, &self.sums),
            weight_bytes: layers.iter().map(|layer| layer.weight_bytes).sum(),
            kept_bytes: self.network.kept_bytes(),
            mask_bytes: forms().map(|form| form.places().div_ceil(8) as u64).sum(),
            seconds_per_frame: self.seconds / counted,
            error: self.reference.as_ref().map(|reference| error(reference, &self.outputs)),
            layers,
        }
    }
}

/// The files of a run.
fn write(staging: &StagedFolder, summary: &Summary, frames: &Table) -> Result<(), InferenceError> {
    let layers = summary.layer_table();
    let table = |name: &'static str| move |source| InferenceError::Table { name, source };
    staging.write("layers.csv", layers.csv().as_bytes())?;
    staging.write("layers.parquet", &layers.parquet("layers").map_err(table("layers.parquet"))?)?;
    staging.write("frames.csv", frames.csv().as_bytes())?;
    staging.write("frames.parquet", &frames.parquet("frames").map_err(table("frames.parquet"))?)?;
    let json = serde_json::to_vec_pretty(summary).expect("a summary has no keys that are not text");
    Ok(staging.write("inference.json", &json)?)
}

/// What a run leaves, and what it may replace.
const INFERENCE: FolderKind =
    FolderKind { what: "an inference (its inference.json)", is: is_inference, listed: true };

fn is_inference(folder: &Path) -> bool {
    folder.join("inference.json").is_file()
}

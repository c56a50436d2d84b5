// SPDX-License-Identifier: MIT OR Apache-2.0
//! An exploration ([`explore`]): it measures a space over clips, and writes a folder of tables,
//! fronts, configurations and one page. An [`ExplorationWork`] is what there is to measure: the
//! clips, and the cameras of the designs.

use super::folder::{MARK_FILE, UNFINISHED_MARK, claim_folder, open_continued, replace_mark};
use super::point_synthesis::{PointSynthesis, SynthesizedPoints};
use super::row::{error_cells, load_cells, name_cells, point_cells, process_cells};
use crate::footage::ExplorationFootage;
use crate::link_load::LoadMeasurement;
use crate::measure::CameraMeasurement;
use crate::objective::mark_fronts;
use crate::row::{ClockSource, DesignRow, WorstClip};
use crate::store::MeasurementStore;
use crate::{
    ClipRow, DesignPoint, Exploration, ExploreError, ExploreRequest, LoadFigures,
    RefusedCombination,
};
use foveate_camera::Camera;
use foveate_design::Design;
use foveate_media::RunHooks;
use foveate_output::tables::{NamedCells, Table};
use foveate_tools::StagingError;
use std::collections::BTreeMap;
use std::ops::Range;
use std::path::Path;
use std::time::{Duration, Instant};

/// The names of the tables and of the page.
const POINTS: &str = "points.csv";
const POINTS_PARQUET: &str = "points.parquet";
const CLIPS: &str = "clips.csv";
const REPORT: &str = "report.html";
/// The time of a batch of syntheses after which the files are written again.
const NEWS_AFTER: Duration = Duration::from_secs(1);
const TABLES: [&str; 4] = [POINTS, POINTS_PARQUET, CLIPS, REPORT];

/// Runs an exploration and writes `output`. Finished results are kept there, so an interrupted run
/// can continue. The tables and the page are written when the errors are known, and again as areas
/// arrive.
///
/// # Errors
/// Fails if an input cannot be read, no point is a valid design, the folder holds something else or
/// cannot be written, or `hooks` cancels.
pub fn explore(
    request: &ExploreRequest<'_>,
    output: &Path,
    hooks: &dyn RunHooks,
) -> Result<Exploration, ExploreError> {
    // The files of designs are not known before the clips have been opened.
    open_continued(output)?.check_files(TABLES.into_iter().chain([MARK_FILE]))?;
    let work = ExplorationWork::new(request, None, hooks)?;
    request.synthesis.map_or(Ok(()), |own| PointSynthesis::check(own, &work.footage))?;
    // The names are checked now, because writing the files may come hours later.
    let names = (1..=work.points.len()).map(design_file).chain(TABLES.map(str::to_owned));
    let names: Vec<String> = names.chain([MARK_FILE.to_owned()]).collect();
    open_continued(output)?.check_files(names.iter().map(String::as_str))?;
    claim_folder(output)?;
    let was_complete = replace_mark(output)?;
    let store = MeasurementStore::open(output)?;
    let mut results = PointResults::measure(request, &work, &store)?;
    if let Some(own) = request.synthesis {
        let synthesis = PointSynthesis::new(own, &work.footage, &store, hooks);
        // The tables of an earlier run stay as long as all areas come from the cache.
        let mut has_news = !was_complete;
        while results.unsynthesized() > 0 {
            if has_news {
                results.write_so_far(request, &work, output)?;
            }
            let begin = Instant::now();
            synthesis.synthesize_next(&results.designs, &mut results.synthesized)?;
            has_news |= begin.elapsed() > NEWS_AFTER;
        }
    }
    let exploration = results.exploration(request, &work);
    results.write(&exploration, &work, output)?;
    Ok(exploration)
}

/// The results of all measurements and syntheses.
struct PointResults {
    /// The measurement of every clip and camera.
    cameras: Vec<Vec<CameraMeasurement>>,
    /// The load of every clip and point; empty if the space has no link.
    loads: Vec<Vec<Option<LoadFigures>>>,
    designs: Vec<Design>,
    /// The results of synthesizing the designs, as far as they are known; without synthesis empty
    /// results.
    synthesized: SynthesizedPoints,
}

impl PointResults {
    fn measure(
        request: &ExploreRequest<'_>,
        work: &ExplorationWork<'_>,
        store: &MeasurementStore,
    ) -> Result<Self, ExploreError> {
        let designs = work.points.iter().map(|point| point.config.validate());
        let designs = designs.collect::<Result<Vec<_>, _>>()?;
        let loads = LoadMeasurement::of_space(request.space, &work.footage);
        let loads = loads.map(|loads| loads.measure_clips(&designs, store)).transpose()?;
        let cameras = work.footage.measure_clips(&work.cameras, store)?;
        let mut synthesized = SynthesizedPoints::default();
        if request.synthesis.is_none() {
            synthesized.points.resize_with(designs.len(), Default::default);
        }
        Ok(Self { cameras, loads: loads.unwrap_or_default(), designs, synthesized })
    }

    /// Returns the number of designs that are still to be synthesized.
    fn unsynthesized(&self) -> usize {
        self.designs.len() - self.synthesized.points.len()
    }

    /// Returns the points with their figures and fronts.
    fn rows(&self, work: &ExplorationWork<'_>, clocks: ClockSource) -> Vec<DesignRow> {
        let mut rows = Vec::new();
        let clips = work.footage.clips.clips();
        for (index, design) in self.designs.iter().enumerate() {
            let camera = work.camera_of_point[index];
            let measured: Vec<&CameraMeasurement> =
                self.cameras.iter().map(|clip| &clip[camera]).collect();
            let settings = work.points[index].settings.clone();
            let row = (index + 1, settings);
            let synthesized = self.synthesized.points.get(index).cloned().unwrap_or_default();
            let row = DesignRow::new(row, design, &measured, synthesized, clocks);
            let load = LoadFigures::of_clips(self.loads.iter().map(|clip| clip[index]));
            let flips = clips.iter().zip(&measured).map(|(clip, measured)| WorstClip {
                name: clip.name.clone(),
                action_flips: measured.tally.figures().action_flips,
            });
            let worst_clip =
                flips.reduce(
                    |worst, clip| {
                        if clip.action_flips > worst.action_flips { clip } else { worst }
                    },
                );
            let worst_clip = worst_clip.filter(|worst| clips.len() > 1 && worst.action_flips > 0.0);
            rows.extend(row.map(|row| DesignRow { load, worst_clip, ..row }));
        }
        mark_fronts(&mut rows, clocks.has_process);
        rows
    }

    fn exploration(&self, request: &ExploreRequest<'_>, work: &ExplorationWork<'_>) -> Exploration {
        let space = request.space;
        let process = request.synthesis.and_then(|synthesis| synthesis.process);
        let clocks = ClockSource { given_mhz: space.clock_mhz, has_process: process.is_some() };
        let (mut clips, mut problems) = (Vec::new(), Vec::new());
        for (input, measured) in work.footage.clips.clips().iter().zip(&self.cameras) {
            // Every space has at least one design.
            let frames = measured[0].tally.figures().frames;
            clips.push(ClipRow { name: input.name.clone(), frames });
            let problem = measured.iter().find_map(|one| one.problem.as_ref());
            problems.extend(problem.map(|problem| format!("{}: {problem}", input.name)));
        }
        problems.extend(self.synthesized.problems.iter().cloned());
        Exploration {
            format_version: 6,
            program: concat!("foveate ", env!("CARGO_PKG_VERSION")).to_owned(),
            clips,
            size: work.footage.size,
            disturbance: request.disturbance.map(|own| own.to_string()),
            luma: work.footage.clips.options().luma.name(),
            ideal: space.ideal.to_toml(),
            clock_mhz: space.clock_mhz,
            library: process.map(|own| own.process.library.name.clone()),
            energy_rate: process.and_then(|own| own.energy_rate),
            link_bits_per_second: space.link.map(|rate| rate.0),
            axes: space.axes.iter().map(|axis| axis.key.clone()).collect(),
            rows: self.rows(work, clocks),
            refused: work.refused.clone(),
            problems,
            awaited_areas: self.unsynthesized(),
        }
    }

    /// Writes what is known so far, unless somebody has changed a file, which only the last write
    /// reports.
    fn write_so_far(
        &self,
        request: &ExploreRequest<'_>,
        work: &ExplorationWork<'_>,
        output: &Path,
    ) -> Result<(), ExploreError> {
        match self.write(&self.exploration(request, work), work, output) {
            Err(ExploreError::Output(StagingError::UnlistedFiles { .. })) => Ok(()),
            result => result,
        }
    }

    /// Writes the tables, the configurations and the page.
    fn write(
        &self,
        exploration: &Exploration,
        work: &ExplorationWork<'_>,
        output: &Path,
    ) -> Result<(), ExploreError> {
        let (rows, has_link) = (&exploration.rows, exploration.link_bits_per_second.is_some());
        let point = |row: &DesignRow| {
            let mut cells = point_cells(row, &exploration.axes);
            if exploration.library.is_some() {
                cells.extend(process_cells(row));
            }
            cells
        };
        let with_load = |mut cells: NamedCells, load: Option<LoadFigures>| {
            if has_link {
                cells.extend(load_cells(load.as_ref()));
            }
            cells
        };
        let table = |rows: &mut dyn Iterator<Item = &DesignRow>| {
            let cells = |row: &DesignRow| with_load(point(row), row.load);
            Table::from_rows(rows.map(cells))
        };
        let points = table(&mut rows.iter());
        let parquet = points.to_parquet("points");
        let parquet = parquet.map_err(ExploreError::io("write", &output.join(POINTS_PARQUET)))?;
        let clips = exploration.clips.iter().zip(&self.cameras).enumerate();
        let clips = clips.flat_map(|(number, (clip, measured))| {
            rows.iter().map(move |row| {
                let figures = measured[work.camera_of_point[row.number - 1]].tally.figures();
                let mut cells = name_cells(row.number, &clip.name);
                cells.extend(error_cells(&figures));
                with_load(cells, self.loads.get(number).and_then(|clip| clip[row.number - 1]))
            })
        });
        let mut files = vec![
            (POINTS.to_owned(), points.to_csv().into_bytes()),
            (POINTS_PARQUET.to_owned(), parquet),
            (CLIPS.to_owned(), Table::from_rows(clips).to_csv().into_bytes()),
        ];
        let design = |row: &DesignRow| (design_file(row.number), row.config.to_toml().into_bytes());
        files.extend(rows.iter().map(design));
        files.push((REPORT.to_owned(), crate::report::render_page(exploration)?.into_bytes()));
        // This file is written last, because it marks the exploration as complete. It is plain data
        // with text keys, so it cannot fail.
        let mark = match self.unsynthesized() {
            0 => {
                let json = serde_json::to_string_pretty(exploration);
                json.expect("it has no map with other keys than text") + "\n"
            }
            _ => UNFINISHED_MARK.to_owned(),
        };
        files.push((MARK_FILE.to_owned(), mark.into_bytes()));
        // Designs of an earlier, larger space are removed, because their numbers would belong to
        // other points.
        Ok(open_continued(output)?.write(&files)?)
    }
}

/// Returns the name of the configuration file of a point.
fn design_file(number: usize) -> String {
    format!("designs/{number}.toml")
}

/// The clips, the points, and the cameras to measure.
///
/// For a single unit only its own combinations are tried, because a space may have many more.
pub(crate) struct ExplorationWork<'a> {
    pub(crate) footage: ExplorationFootage<'a>,
    pub(crate) points: Vec<DesignPoint>,
    pub(crate) refused: Vec<RefusedCombination>,
    /// The different cameras of the designs.
    pub(crate) cameras: Vec<Camera>,
    /// The index into `cameras` of the camera of each point.
    pub(crate) camera_of_point: Vec<usize>,
}

impl<'a> ExplorationWork<'a> {
    /// Opens the clips, and tries some combinations of the space or all of them.
    ///
    /// # Errors
    /// Fails if an input cannot be read or no point is a valid design.
    pub(crate) fn new(
        request: &ExploreRequest<'a>,
        some: Option<&[usize]>,
        hooks: &'a dyn RunHooks,
    ) -> Result<Self, ExploreError> {
        let space = request.space;
        let footage =
            ExplorationFootage::new((request.inputs, &[]), request.input, &space.ideal, hooks)?
                .disturbed(request.disturbance);
        let (width, height) = footage.size;
        let (points, refused) = space.points_of_combinations(some, width, height);
        if points.is_empty() {
            let first = refused.into_iter().next().expect("a space has a combination");
            let RefusedCombination { settings, reason } = first;
            return Err(ExploreError::NoPoints { settings, reason });
        }
        let (cameras, camera_of_point) = distinct_cameras(&points)?;
        Ok(Self { footage, points, refused, cameras, camera_of_point })
    }

    pub(crate) fn points_of_cameras(&self, cameras: &Range<usize>) -> Vec<&DesignPoint> {
        let points = self.points.iter().zip(&self.camera_of_point);
        let points = points.filter(|(_, camera)| cameras.contains(camera));
        points.map(|(point, _)| point).collect()
    }

    pub(crate) fn first_point_of_cameras(&self) -> Vec<&DesignPoint> {
        let mut found = Vec::with_capacity(self.cameras.len());
        for (point, &camera) in self.points.iter().zip(&self.camera_of_point) {
            if camera == found.len() {
                found.push(point);
            }
        }
        found
    }
}

fn distinct_cameras(points: &[DesignPoint]) -> Result<(Vec<Camera>, Vec<usize>), ExploreError> {
    let (mut cameras, mut numbers, mut camera_of_point) = (Vec::new(), BTreeMap::new(), Vec::new());
    for point in points {
        let camera = &point.config.camera;
        let next = numbers.len();
        let number = *numbers.entry(camera.to_toml()).or_insert(next);
        if number == next {
            cameras.push(camera.validate()?);
        }
        camera_of_point.push(number);
    }
    Ok((cameras, camera_of_point))
}

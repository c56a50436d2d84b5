// SPDX-License-Identifier: MIT OR Apache-2.0
//! An exploration in units of work for several machines. A unit is a clip, and designs that see it
//! together.
//!
//! A unit adds the missing results to the store of the folder, and then writes a file that marks it
//! as done. Both have the same bytes wherever the unit is done, so a unit may be done twice, and at
//! the same time.

use std::fs;
use std::ops::Range;
use std::path::Path;

use foveate_footage::input_without_secrets;
use foveate_playback::RunHooks;
use foveate_staging::write_file;
use foveate_toolchain::sha256_hex;
use serde::{Deserialize, Serialize};

use crate::exploration_work::ExplorationWork;
use crate::folder::{UNITS_FOLDER, check_folder, claim_folder};
use crate::footage::{CAMERAS_PER_UNIT, MeasurementCount};
use crate::store::{KEY_DIGITS, MeasurementStore};
use crate::{ExploreError, ExploreRequest};

/// A unit of work.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct WorkUnit {
    /// The name of the unit: a hash of everything that its results depend on.
    #[serde(rename = "unit")]
    pub name: String,
    /// The name of the clip.
    pub clip: String,
    /// The inputs of the clip. The unit is the same in an exploration of these inputs alone.
    pub inputs: Vec<String>,
    /// The designs that see the clip, by the numbers of their combinations.
    pub combinations: Vec<usize>,
    /// The path of the file that is written when all results exist.
    pub file: String,
}

/// The content of the file of a unit.
#[derive(Serialize)]
struct UnitReceipt<'a> {
    /// The names of the results in the store.
    measured: &'a [String],
}

/// A unit, and its part of the work.
struct PlannedUnit {
    unit: WorkUnit,
    /// The number of the clip.
    clip: usize,
    cameras: Range<usize>,
    keys: Vec<String>,
}

/// Returns the units of an exploration into `output`, finished or not. It writes nothing.
///
/// # Errors
/// Fails if an input cannot be read, no point is a valid design, or the folder holds something
/// else.
pub fn plan_units(
    request: &ExploreRequest<'_>,
    output: &Path,
    hooks: &dyn RunHooks,
) -> Result<Vec<WorkUnit>, ExploreError> {
    check_folder(output)?;
    let work = ExplorationWork::new(request, None, hooks)?;
    Ok(planned_units(&work, output).map(|part| part.unit).collect())
}

/// Does one unit of an exploration into `output`. `unit` is its name or its whole line of the plan,
/// which is found faster.
///
/// # Errors
/// Fails if the exploration has no unit of that name, its clip cannot be read or ends early, the
/// folder holds something else or cannot be written, or `hooks` cancels.
pub fn measure_unit(
    request: &ExploreRequest<'_>,
    unit: &str,
    output: &Path,
    hooks: &dyn RunHooks,
) -> Result<WorkUnit, ExploreError> {
    let line: Option<WorkUnit> = serde_json::from_str(unit).ok();
    let (name, some) = match &line {
        Some(line) => (line.name.as_str(), Some(line.combinations.as_slice())),
        None => (unit, None),
    };
    let work = ExplorationWork::new(request, some, hooks)?;
    let part = planned_units(&work, output).find(|part| part.unit.name == name);
    let part = part.ok_or_else(|| ExploreError::NoUnit { unit: name.to_owned() })?;
    claim_folder(output)?;
    let store = MeasurementStore::open(output)?;
    let cameras = &work.cameras[part.cameras.clone()];
    let measured = work.footage.measure_clip(
        part.clip,
        cameras,
        &store,
        &MeasurementCount::from_total(cameras.len()),
    )?;
    if let Some(problem) = measured.into_iter().find_map(|one| one.problem) {
        return Err(ExploreError::IncompleteClip { clip: part.unit.clip, problem });
    }
    let folder = output.join(UNITS_FOLDER);
    fs::create_dir_all(&folder).map_err(ExploreError::io("make the folder", &folder))?;
    let receipt = UnitReceipt { measured: &part.keys };
    // The receipt is plain data with text keys, so this cannot fail.
    let text = serde_json::to_string(&receipt).expect("it has no map") + "\n";
    write_file(Path::new(&part.unit.file), text.as_bytes())?;
    Ok(part.unit)
}

/// Returns the units clip by clip, each with as many designs as a run measures together.
fn planned_units<'a>(
    work: &'a ExplorationWork<'_>,
    output: &'a Path,
) -> impl Iterator<Item = PlannedUnit> + 'a {
    let clips = work.footage.clips.clips().iter().enumerate();
    let points = work.first_point_of_cameras();
    clips.flat_map(move |(clip, subject)| {
        let points = points.clone();
        let keys = work.footage.measurement_keys(clip, &work.cameras);
        let starts = (0..keys.len()).step_by(CAMERAS_PER_UNIT);
        starts.map(move |start| {
            let cameras = start..(start + CAMERAS_PER_UNIT).min(keys.len());
            let keys = keys[cameras.clone()].to_vec();
            let unit = sha256_hex(keys.join("\n"))[..KEY_DIGITS].to_owned();
            let file = output.join(UNITS_FOLDER).join(format!("{unit}.json"));
            let unit = WorkUnit {
                name: unit,
                clip: subject.name.clone(),
                inputs: subject.inputs.iter().map(|path| input_without_secrets(path)).collect(),
                combinations: points[cameras.clone()]
                    .iter()
                    .map(|point| point.combination)
                    .collect(),
                file: file.display().to_string(),
            };
            PlannedUnit { unit, clip, cameras, keys }
        })
    })
}

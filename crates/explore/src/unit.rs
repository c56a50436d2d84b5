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

use foveate_design::Design;
use foveate_media::{RunHooks, input_without_secrets};
use foveate_tools::write_file;
use serde::{Deserialize, Serialize};

use super::explore::ExplorationWork;
use super::folder::{UNITS_FOLDER, check_folder, claim_folder};
use crate::footage::{CAMERAS_PER_UNIT, MeasurementCount};
use crate::link_load::LoadMeasurement;
use crate::store::{MeasurementStore, key_of};
use crate::{DesignSpace, ExploreError, ExploreRequest};

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
    clip: usize,
    cameras: Range<usize>,
    /// The designs that are measured in front of the link; none if the space has no link.
    designs: Vec<Design>,
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
    Ok(planned_units(request.space, &work, output)?.into_iter().map(|part| part.unit).collect())
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
    let mut parts = planned_units(request.space, &work, output)?.into_iter();
    let part = parts.find(|part| part.unit.name == name);
    let part = part.ok_or_else(|| ExploreError::NoUnit { unit: name.to_owned() })?;
    claim_folder(output)?;
    let store = MeasurementStore::open(output)?;
    if let Some(loads) = LoadMeasurement::of_space(request.space, &work.footage) {
        loads.measure_clip(part.clip, &part.designs, &store)?;
    }
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

/// Returns the units clip by clip, each with as many cameras as a run measures together, and with
/// their designs if these are measured in front of a link.
fn planned_units(
    space: &DesignSpace,
    work: &ExplorationWork<'_>,
    output: &Path,
) -> Result<Vec<PlannedUnit>, ExploreError> {
    let loads = LoadMeasurement::of_space(space, &work.footage);
    let first_points = work.first_point_of_cameras();
    let mut units = Vec::new();
    for (clip, subject) in work.footage.clips.clips().iter().enumerate() {
        let camera_keys = work.footage.measurement_keys(clip, &work.cameras);
        for start in (0..camera_keys.len()).step_by(CAMERAS_PER_UNIT) {
            let cameras = start..(start + CAMERAS_PER_UNIT).min(camera_keys.len());
            let mut keys = camera_keys[cameras.clone()].to_vec();
            let (mut points, mut designs) = (first_points[cameras.clone()].to_vec(), Vec::new());
            if let Some(loads) = &loads {
                points = work.points_of_cameras(&cameras);
                let all = points.iter().map(|point| point.config.validate());
                designs = all.collect::<Result<_, _>>()?;
                designs.retain(|design| design.has_forwarding());
                keys.extend(loads.keys(clip, &designs));
            }
            let unit = key_of(&keys.join("\n"));
            let file = output.join(UNITS_FOLDER).join(format!("{unit}.json"));
            let unit = WorkUnit {
                name: unit,
                clip: subject.name.clone(),
                inputs: subject.inputs.iter().map(|path| input_without_secrets(path)).collect(),
                combinations: points.iter().map(|point| point.combination).collect(),
                file: file.display().to_string(),
            };
            units.push(PlannedUnit { unit, clip, cameras, designs, keys });
        }
    }
    Ok(units)
}

// SPDX-License-Identifier: MIT OR Apache-2.0
//! The work of an exploration: the clips, and the cameras of the designs.

use std::collections::BTreeMap;
use std::ops::Range;

use foveate_camera::Camera;
use foveate_media::RunHooks;

use crate::footage::ExplorationFootage;
use crate::{DesignPoint, ExploreError, ExploreRequest, RefusedCombination};

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

    /// Returns the points that have one of these cameras.
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

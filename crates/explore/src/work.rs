// SPDX-License-Identifier: MIT OR Apache-2.0
//! The work of an exploration: the clips, and the cameras of the designs.

use std::collections::BTreeMap;

use foveate_camera::Camera;

use crate::footage::Footage;
use crate::{ExploreError, Hooks, Point, Refused, Request};

/// The clips, the points, and the cameras to measure.
///
/// For a single unit only its own combinations are tried, because a space may have many more.
pub(crate) struct Work<'a> {
    pub(crate) footage: Footage<'a>,
    pub(crate) points: Vec<Point>,
    pub(crate) refused: Vec<Refused>,
    /// The different cameras of the designs.
    pub(crate) looks: Vec<Camera>,
    /// The index into `looks` of the camera of each point.
    pub(crate) look_of: Vec<usize>,
}

impl<'a> Work<'a> {
    /// Opens the clips, and tries some combinations of the space or all of them.
    ///
    /// # Errors
    /// Fails if an input cannot be read or no point is a valid design.
    pub(crate) fn new(
        request: &Request<'a>,
        some: Option<&[usize]>,
        hooks: &'a dyn Hooks,
    ) -> Result<Self, ExploreError> {
        let space = request.space;
        let footage = Footage::new(request.inputs, request.input, &space.ideal, hooks)?;
        let (width, height) = footage.size;
        let (points, refused) = space.points_of(some, width, height);
        if points.is_empty() {
            let first = refused.into_iter().next().expect("a space has a combination");
            let Refused { settings, reason } = first;
            return Err(ExploreError::NoPoints { settings, reason });
        }
        let (looks, look_of) = looks(&points)?;
        Ok(Self { footage, points, refused, looks, look_of })
    }

    /// Returns, for each camera, the first point that has it.
    pub(crate) fn first_points(&self) -> Vec<&Point> {
        let mut found = Vec::with_capacity(self.looks.len());
        for (point, &look) in self.points.iter().zip(&self.look_of) {
            if look == found.len() {
                found.push(point);
            }
        }
        found
    }
}

fn looks(points: &[Point]) -> Result<(Vec<Camera>, Vec<usize>), ExploreError> {
    let (mut looks, mut numbers, mut of_point) = (Vec::new(), BTreeMap::new(), Vec::new());
    for point in points {
        let camera = &point.config.camera;
        let next = numbers.len();
        let number = *numbers.entry(camera.to_toml()).or_insert(next);
        if number == next {
            looks.push(camera.validate()?);
        }
        of_point.push(number);
    }
    Ok((looks, of_point))
}

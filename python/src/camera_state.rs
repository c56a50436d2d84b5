// SPDX-License-Identifier: MIT OR Apache-2.0
//! The state of a camera: its engine, and the frames that it has taken.

use std::sync::{Arc, Mutex, MutexGuard, TryLockError};

use foveate_camera::RegionClass;
use foveate_design::DesignConfig;
use foveate_engine::{Engine, EngineError, EngineOptions};
use foveate_pixels::ByteFrame;
use foveate_simulator::SentValues;
use pyo3::exceptions::{PyRuntimeError, PyValueError};
use pyo3::prelude::*;

use super::outcome::RegionClasses;
use super::timed_camera::StepClock;
use crate::error::raise;
use crate::frame::{Grey, Scratch, check_size, design_of_size, rows, size_of};

/// The engine for frames of the size of the first frame.
pub(crate) struct SizedEngine {
    /// The design of the engine, which outcomes share.
    pub(crate) design: Arc<foveate_design::Design>,
    pub(crate) engine: Engine,
    /// The number of maps of classes that were set; 0 for that of the configuration.
    maps_set: u64,
}

impl SizedEngine {
    pub(crate) fn new(design: foveate_design::Design, threads: usize) -> PyResult<Self> {
        let options = EngineOptions { threads, ..EngineOptions::default() };
        let engine = Engine::with_options(&design, options).map_err(raise)?;
        Ok(Self { design: Arc::new(design), engine, maps_set: 0 })
    }

    /// Returns the map of classes that the last frame used, of a design with zones.
    pub(crate) fn classes(&self) -> Option<RegionClasses> {
        self.design.zones()?;
        Some(RegionClasses { map: self.engine.classes().to_vec(), maps_set: self.maps_set })
    }

    pub(crate) fn set_classes(&mut self, classes: &[RegionClass]) -> Result<(), EngineError> {
        self.engine.set_classes(classes)?;
        self.maps_set += 1;
        Ok(())
    }

    fn assigned_map(&self) -> Option<RegionClasses> {
        self.classes().filter(|classes| classes.maps_set > 0)
    }

    /// Continues with the map of classes of another engine for frames of the same size.
    fn continue_map(&mut self, classes: &RegionClasses) -> PyResult<()> {
        self.engine.set_classes(&classes.map).map_err(raise)?;
        self.maps_set = classes.maps_set;
        Ok(())
    }

    /// Copies the values that the regions of the last frame send.
    pub(crate) fn sent_values(&self) -> SentValues {
        SentValues::of_engine(&self.engine)
    }
}

/// A map of classes in a pickled camera: the width and height of frames, the code of each region,
/// and the number of maps that were set.
pub(crate) type PickledMap = ((usize, usize), Vec<u8>, u64);

/// The message of a camera that has no size yet.
pub(crate) const NO_SIZE: &str = "this camera has no size yet: it takes that of its first frame, so show it one, or give the size, \
                       frame={\"width\": 640, \"height\": 480}";

/// The state of a camera. The default is that of a camera that has seen no frame.
#[derive(Default)]
pub(crate) struct CameraState {
    /// The engine, which is kept after a reset for frames of the same size.
    pub(crate) sized_engine: Option<SizedEngine>,
    /// Number of frames since the camera was made or reset.
    pub(crate) frames: u64,
    /// Number of frames in all, which says to which outcome the screen belongs.
    pub(crate) steps: u64,
    /// Times of the frames.
    pub(crate) clock: StepClock,
    /// The process to which the threads belong.
    process: u32,
    scratch: Scratch,
}

impl CameraState {
    /// Returns the engine of a camera, and makes it first if the configuration has the size of frames.
    pub(crate) fn engine_of(
        &mut self,
        config: &DesignConfig,
        threads: usize,
    ) -> PyResult<&mut SizedEngine> {
        if self.sized_engine.is_none() {
            let frame = &config.camera.frame;
            if frame.width.is_none() || frame.height.is_none() {
                return Err(PyValueError::new_err(NO_SIZE));
            }
            let design = config.validate().map_err(raise)?;
            self.sized_engine = Some(SizedEngine::new(design, threads)?);
            self.process = std::process::id();
        }
        Ok(self.sized_engine.as_mut().expect("it has just been made"))
    }

    /// Returns the engine, if the frame of this step is the last one that it took. `what` names what is gone otherwise, and `name`
    /// what reads it.
    pub(crate) fn engine_after(&self, step: u64, what: &str, name: &str) -> PyResult<&SizedEngine> {
        let own = self.sized_engine.as_ref().filter(|_| self.steps == step);
        own.ok_or_else(|| {
            PyRuntimeError::new_err(format!(
                "this outcome's {what} gone, because the camera has taken another frame or was reset; read \
                 outcome.{name} before the next step, or keep it with step(frame, keep=True)"
            ))
        })
    }

    /// Prepares the camera for a frame of this size, or refuses the frame.
    pub(crate) fn fit(
        &mut self,
        config: &DesignConfig,
        threads: usize,
        size: (usize, usize),
    ) -> PyResult<()> {
        let own_size = self.sized_engine.as_ref().map(|own| size_of(&own.design));
        if self.frames > 0 {
            if threads != 1 && self.process != std::process::id() {
                return Err(PyRuntimeError::new_err(
                    "this camera has threads, which do not exist after a fork; make the camera in the new process",
                ));
            }
            check_size(size, own_size.expect("it has seen a frame"))?;
        } else if own_size != Some(size) || self.process != std::process::id() {
            // Threads do not exist after a fork, but the map of classes goes on.
            let old = self.sized_engine.as_ref().filter(|_| own_size == Some(size));
            let assigned_map = old.and_then(SizedEngine::assigned_map);
            let mut sized_engine = SizedEngine::new(design_of_size(config, size)?, threads)?;
            if let Some(map) = assigned_map {
                sized_engine.continue_map(&map)?;
            }
            self.sized_engine = Some(sized_engine);
            self.process = std::process::id();
        }
        Ok(())
    }

    /// Returns the map of classes that was set last, for a copy of the camera.
    pub(crate) fn pickled_map(&self) -> Option<PickledMap> {
        let sized_engine = self.sized_engine.as_ref()?;
        let RegionClasses { map, maps_set } = sized_engine.assigned_map()?;
        let size = size_of(&sized_engine.design);
        Some((size, map.into_iter().map(RegionClass::code).collect(), maps_set))
    }

    /// Makes the state of a camera that has seen no frame, and whose map of classes is that of
    /// another camera.
    pub(crate) fn with_map(
        config: &DesignConfig,
        threads: usize,
        (size, codes, maps_set): PickledMap,
    ) -> PyResult<Self> {
        let classes: Option<Vec<RegionClass>> =
            codes.into_iter().map(RegionClass::from_code).collect();
        let map = classes.ok_or_else(|| PyValueError::new_err("a code of zones is 0 to 3"))?;
        let mut sized_engine = SizedEngine::new(design_of_size(config, size)?, threads)?;
        sized_engine.continue_map(&RegionClasses { map, maps_set })?;
        let process = std::process::id();
        Ok(Self { sized_engine: Some(sized_engine), process, ..Self::default() })
    }

    /// Takes a frame of the size and depth of the engine.
    pub(crate) fn take_frame(&mut self, frame: &ByteFrame) -> Result<(), EngineError> {
        let own = self.sized_engine.as_mut().expect("made ready");
        own.engine.step_byte_frame(frame)?;
        self.count();
        Ok(())
    }

    /// Takes an array of the size and depth of the engine, without holding the interpreter.
    pub(crate) fn take_array(&mut self, py: Python<'_>, frame: &Grey<'_>) -> PyResult<()> {
        let Self { sized_engine, scratch, .. } = self;
        let engine = &mut sized_engine.as_mut().expect("made ready").engine;
        match frame {
            Grey::Bytes(array) => {
                let (pixels, stride) = rows(array.as_array(), &mut scratch.bytes);
                py.detach(|| engine.step_u8(pixels, stride).map(|_| ()))
            }
            Grey::Words(array) => {
                let (pixels, stride) = rows(array.as_array(), &mut scratch.words);
                py.detach(|| engine.step_u16(pixels, stride).map(|_| ()))
            }
        }
        .map_err(raise)?;
        self.count();
        Ok(())
    }

    fn count(&mut self) {
        self.frames += 1;
        self.steps += 1;
    }
}

/// Locks the state of a camera of this class, for one thread at a time.
pub(crate) fn lock_camera<'a, T>(state: &'a Mutex<T>, class: &str) -> PyResult<MutexGuard<'a, T>> {
    match state.try_lock() {
        Ok(state) => Ok(state),
        Err(TryLockError::Poisoned(poisoned)) => Ok(poisoned.into_inner()),
        Err(TryLockError::WouldBlock) => Err(PyRuntimeError::new_err(format!(
            "another thread is using this camera; give each thread a camera of its own, {class}(camera.design)"
        ))),
    }
}

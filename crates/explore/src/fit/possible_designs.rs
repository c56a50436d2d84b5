// SPDX-License-Identifier: MIT OR Apache-2.0
//! The designs that can build a camera, before any of them is synthesized.

use foveate_camera::CameraConfig;
use foveate_design::{
    Design, DesignConfig, HardwareConfig, LaneMemoryKind, Organization, OrganizationConfig,
    PixelFeed, RasterConfig, SerialConfig,
};
use foveate_estimate::most_clocks_per_frame;

use super::FitRequest;
use super::rough_cost::RoughCostModel;
use crate::row::count_to_f64;

/// The planned clock in Hz. It decides which folds are tried, because a design has no netlist and
/// so no estimated clock before its synthesis. No frame rate is reported at it. It is below the low
/// ends of the serial arrays in `docs/area.md`, of which the slowest is at 56 MHz. A faster design
/// is folded again for its own clock.
const PLANNED_HZ: u64 = 50_000_000;

/// The bounds on the designs of a camera.
#[derive(Clone, Copy)]
pub(super) struct BuildBounds {
    /// The most clocks that a frame may take.
    max_clocks: Option<u64>,
    /// True if the bound comes from a planned clock, so that a design with a faster clock may take
    /// more clocks.
    is_planned: bool,
    /// The kind of lane memory to build. If it is `None`, each design follows its own rule.
    memory: Option<LaneMemoryKind>,
    target: DesignTarget,
}

/// The technology for which designs are possible.
#[derive(Clone, Copy, PartialEq, Eq)]
enum DesignTarget {
    /// An FPGA, on which a pipelined array is never cheaper than a serial one.
    Fpga,
    /// The cells of a process, in which a pipelined array may be the cheapest.
    Process,
    /// The same, but the energy decides, which is not known for organization `raster`.
    ProcessWithEnergy,
}

impl BuildBounds {
    /// Returns the bounds for the frame rate of the request, at its clock or at the planned one.
    pub(super) fn of_request(request: &FitRequest<'_>, memory: Option<LaneMemoryKind>) -> Self {
        let hertz = count_to_f64(request.clock_hz.unwrap_or(PLANNED_HZ));
        let max_clocks = request.constraints.min_fps.map(|fps| most_clocks_per_frame(hertz, fps));
        let target = match request.process {
            None => DesignTarget::Fpga,
            Some(_) if request.is_decided_by_energy() => DesignTarget::ProcessWithEnergy,
            Some(_) => DesignTarget::Process,
        };
        Self { max_clocks, is_planned: request.clock_hz.is_none(), memory, target }
    }

    /// Returns the bounds for any frame rate.
    pub(super) fn at_any_speed(self) -> Self {
        Self { max_clocks: None, ..self }
    }
}

/// Returns the possible designs of a camera. For each feed of a serial array these are the folds
/// that are fast enough and may be the cheapest, and halvings of the deepest fold, because only a
/// synthesis shows which one is the cheapest. If no fold is fast enough, the pipelined array is
/// possible, and at a planned clock also fold 1. In the cells of a process the pipelined array is
/// always possible. A raster core has the fewest pixels per clock that are fast enough; at a
/// planned clock it has the most, if none is fast enough. There is no raster core if the energy
/// decides.
pub(super) fn possible_designs(
    camera: &CameraConfig,
    task_hardware: &HardwareConfig,
    bounds: BuildBounds,
) -> Vec<Design> {
    let (arrays, is_fast) = serial_arrays(camera, task_hardware, bounds);
    let of = |organization| match organization {
        Organization::Serial => arrays.clone(),
        Organization::Pipelined if is_fast && bounds.target == DesignTarget::Fpga => Vec::new(),
        Organization::Pipelined => {
            let array = possible_design(camera, task_hardware, OrganizationConfig::Pipelined);
            array.into_iter().collect()
        }
        Organization::Raster if bounds.target == DesignTarget::ProcessWithEnergy => Vec::new(),
        Organization::Raster => {
            let core = |pixels| {
                let pixels_per_clock = Some(pixels);
                let own = RasterConfig { pixels_per_clock, ..RasterConfig::default() };
                possible_design(camera, task_hardware, OrganizationConfig::Raster(own))
            };
            let cores = [1, 2, 4].into_iter().filter_map(core).collect();
            fewest_pixels_per_clock(cores, bounds).into_iter().collect()
        }
    };
    Organization::ALL.iter().flat_map(|&organization| of(organization)).collect()
}

/// Returns true if an organization can build the camera, at whatever speed.
pub(super) fn can_be_built(camera: &CameraConfig, task_hardware: &HardwareConfig) -> bool {
    let (memory, target) = (None, DesignTarget::Process);
    let bounds = BuildBounds { max_clocks: None, is_planned: true, memory, target };
    !possible_designs(camera, task_hardware, bounds).is_empty()
}

/// Returns a design of that organization with the thresholds and `sync` of the task; `None` if it
/// is not valid.
fn possible_design(
    camera: &CameraConfig,
    task_hardware: &HardwareConfig,
    organization: OrganizationConfig,
) -> Option<Design> {
    let &HardwareConfig { thresholds, sync, .. } = task_hardware;
    let hardware = HardwareConfig { organization, thresholds, sync, ..HardwareConfig::default() };
    DesignConfig { camera: camera.clone(), hardware }.validate().ok()
}

/// Returns the serial arrays of every feed, and whether one is fast enough.
fn serial_arrays(
    camera: &CameraConfig,
    task_hardware: &HardwareConfig,
    bounds: BuildBounds,
) -> (Vec<Design>, bool) {
    let (mut found, mut is_fast) = (Vec::new(), false);
    let fed = |&feed| {
        let own = SerialConfig { fold: 1, feed: Some(feed), memory: bounds.memory };
        possible_design(camera, task_hardware, OrganizationConfig::Serial(own))
    };
    for single in PixelFeed::ALL.iter().filter_map(fed) {
        let (folds, enough) = folded_arrays(&single, bounds);
        is_fast |= enough;
        found.extend(folds);
    }
    (found, is_fast)
}

/// Returns the folds of a serial array, and whether one is fast enough.
fn folded_arrays(single: &Design, bounds: BuildBounds) -> (Vec<Design>, bool) {
    let folds = single.pareto_folds(bounds.max_clocks.unwrap_or(u64::MAX));
    let is_fast = !folds.is_empty();
    let folds = if folds.is_empty() && bounds.is_planned { vec![1] } else { folds };
    let deepest = folds.first().map_or(0, |deepest| deepest / 2);
    let halvings = std::iter::successors(Some(deepest), |fold| Some(fold / 2));
    let halvings = halvings.take_while(|fold| *fold > 0).filter(|fold| !folds.contains(fold));
    let all = folds.iter().copied().chain(halvings);
    (all.filter_map(|fold| single.with_fold(fold).ok()).collect(), is_fast)
}

/// Returns the first raster core that is fast enough; `cores` have rising numbers of pixels per
/// clock.
fn fewest_pixels_per_clock(
    cores: Vec<Design>,
    BuildBounds { max_clocks, is_planned: planned, .. }: BuildBounds,
) -> Option<Design> {
    let is_fast = |design: &Design| {
        max_clocks.is_none_or(|clocks| design.timing().clocks_per_frame() <= clocks)
    };
    let most = cores.last().filter(|_| planned).cloned();
    cores.into_iter().find(is_fast).or(most)
}

/// Returns roughly the least cost of a camera, however it is built; infinite if it cannot be built.
pub(super) fn least_rough_cost(camera: &CameraConfig, request: &FitRequest<'_>) -> f64 {
    let bounds = BuildBounds::of_request(request, None).at_any_speed();
    let designs = possible_designs(camera, &request.task.hardware, bounds);
    let cost_model = RoughCostModel::of_request(request);
    let costs = designs.iter().map(|design| cost_model.cost(design));
    costs.fold(f64::INFINITY, f64::min)
}

#[cfg(test)]
mod tests {
    use super::*;

    const FPGA: BuildBounds = BuildBounds {
        max_clocks: None,
        is_planned: true,
        memory: None,
        target: DesignTarget::Fpga,
    };

    /// Returns the pixels per clock of the raster designs among the designs of a camera of 64x48
    /// pixels, and whether one of them is pipelined.
    fn words(max_clocks: u64, planned: bool) -> (Vec<u32>, bool) {
        let task = DesignConfig::from_toml("[frame]\nwidth = 64\nheight = 48\n").unwrap();
        let bounds = BuildBounds { max_clocks: Some(max_clocks), is_planned: planned, ..FPGA };
        let designs = possible_designs(&task.camera, &task.hardware, bounds);
        let of = |organization| designs.iter().filter(move |d| d.organization() == organization);
        let words =
            of(Organization::Raster).map(|d| d.as_raster().unwrap().pixels_per_clock()).collect();
        (words, of(Organization::Pipelined).next().is_some())
    }

    /// All organizations may be the cheapest in a process, but the energy of `raster` is not known.
    #[test]
    fn a_process_has_pipelined_arrays_and_energy_has_no_raster_cores() {
        let task = DesignConfig::from_toml("[frame]\nwidth = 64\nheight = 48\n").unwrap();
        let organizations = |target| {
            let bounds = BuildBounds { max_clocks: Some(1_000_000), target, ..FPGA };
            let designs = possible_designs(&task.camera, &task.hardware, bounds);
            let has = |own| designs.iter().any(|design| design.organization() == own);
            [Organization::Pipelined, Organization::Serial, Organization::Raster].map(has)
        };
        assert_eq!(organizations(DesignTarget::Fpga), [false, true, true]);
        assert_eq!(organizations(DesignTarget::Process), [true, true, true]);
        assert_eq!(organizations(DesignTarget::ProcessWithEnergy), [true, true, false]);
    }

    /// Only `serial` has `flow`, with regions of 4x4 pixels or more, and a reference that no region
    /// would ever have is refused.
    #[test]
    fn flow_is_built_where_an_organization_supports_it() {
        let designs = |more: &[&str]| {
            let flow = "spatial=[{feature='flow',radius=2}]";
            let task = DesignConfig::from_toml_with("", &[&[flow], more].concat()).unwrap();
            let designs = possible_designs(&task.camera, &task.hardware, FPGA);
            assert_eq!(can_be_built(&task.camera, &task.hardware), !designs.is_empty());
            designs.iter().map(Design::organization).collect::<Vec<_>>()
        };
        let arrays = designs(&[]);
        assert!(!arrays.is_empty());
        assert!(arrays.iter().all(|one| matches!(one, Organization::Serial)), "{arrays:?}");
        assert!(!designs(&["region.size=4"]).is_empty());
        assert!(designs(&["region.size=3"]).is_empty());
        assert!(designs(&["temporal.reference='last-sent'"]).is_empty());
    }

    /// There are 784 regions. At most 17 regions per lane are fast enough; 16 and 8 take fewer
    /// block RAMs.
    #[test]
    fn lanes_share_as_many_regions_as_may_be_cheapest_and_halvings_of_the_most() {
        let task = DesignConfig::from_toml("").unwrap();
        let bounds = BuildBounds { max_clocks: Some(210_623), ..FPGA };
        let designs = possible_designs(&task.camera, &task.hardware, bounds);
        let arrays = designs.iter().filter_map(Design::as_serial);
        let folds =
            arrays.filter(|array| array.feed() == PixelFeed::Raster).map(|array| array.fold());
        assert_eq!(folds.collect::<Vec<_>>(), [17, 16, 8, 4, 2, 1]);
    }

    /// The 3,072 pixels take 3,072, 1,536 or 768 clocks, and some more between frames.
    #[test]
    fn a_raster_core_has_the_fewest_pixels_per_clock_that_are_fast_enough() {
        assert_eq!(words(1_000_000, false), (vec![1], false));
        assert_eq!(words(3_072, false), (vec![2], true));
        assert_eq!(words(1_536, false), (vec![4], true));
        assert_eq!(words(64, false), (vec![], true));
        assert_eq!(words(64, true), (vec![4], true));
    }
}

// SPDX-License-Identifier: MIT OR Apache-2.0
//! The check that a design fits a board, behind a sensor or a pattern.

use foveate_camera::Neighborhood;
use foveate_design::{Design, Hardware, InterfaceKind, PipelinedDesign, RasterDesign};

use crate::sensor::Sensor;

/// The largest number of values of a region that the registers of an array can show. The upper half
/// of the addresses is for values, four at each address.
const MAX_REGION_VALUES: u32 = 2048;

/// Fails with the reason if a design does not fit a board, behind this sensor or a pattern.
pub(crate) fn check_fit(design: &Design, sensor: Option<&Sensor>) -> Result<(), String> {
    match (design.interface_kind(), design.hardware(), sensor) {
        (InterfaceKind::Axi, Hardware::Raster(hardware), sensor) => {
            check_raster(design.with_hardware(hardware), sensor)
        }
        (InterfaceKind::Ports, Hardware::Pipelined(_), None) if design.zones().is_some() => {
            Err("an array on a board has no source of classes; leave [zones] out".to_owned())
        }
        (InterfaceKind::Ports, Hardware::Pipelined(hardware), None) => {
            check_array(design.with_hardware(hardware))
        }
        (InterfaceKind::Ports, Hardware::Pipelined(_), Some(_)) => {
            Err("an array of RPUs takes a pixel of every region per clock, but a sensor sends one \
                 pixel; set hardware.organization='raster' and hardware.interface='axi', or choose \
                 a board with a pattern, vcu118"
                .to_owned())
        }
        (InterfaceKind::Ports, Hardware::Serial(_), _) => {
            Err("no board supports the organization `serial`; set hardware.organization='raster' \
                 and hardware.interface='axi', or 'pipelined' for a board with a pattern"
                .to_owned())
        }
        (InterfaceKind::Ports, Hardware::Raster(_), _) => {
            Err("it has no AXI interface; set hardware.interface='axi'".to_owned())
        }
        (InterfaceKind::Axi, Hardware::Pipelined(_) | Hardware::Serial(_), _) => {
            Err("only the organization `raster` has an AXI interface".to_owned())
        }
    }
}

fn check_raster(raster: RasterDesign<'_>, sensor: Option<&Sensor>) -> Result<(), String> {
    if raster.has_external_store() {
        let remedy = "set hardware.store='block'";
        return Err(format!(
            "no board has a memory for a frame store outside of the core; {remedy}"
        ));
    }
    if raster.pixel_bits() != 8 {
        return Err(format!(
            "frame.pixel_bits = {}: pixels on a board have 8 bits",
            raster.pixel_bits()
        ));
    }
    let lanes = raster.pixels_per_clock();
    let Some(sensor) = sensor else { return Ok(()) };
    if lanes != 1 {
        return Err(format!(
            "hardware.pixels_per_clock = {lanes}: a sensor sends one pixel per clock"
        ));
    }
    let (width, height) = (raster.width(), raster.height());
    let (max_width, max_height) = (sensor.width - sensor.left, sensor.height - sensor.top);
    if width > max_width || height > max_height {
        return Err(format!(
            "frames of {width} x {height}: the sensor sends {max_width} x {max_height} at most"
        ));
    }
    Ok(())
}

/// Fails with the reason if an array does not fit behind a pattern.
fn check_array(array: PipelinedDesign<'_>) -> Result<(), String> {
    let side = array.region_size();
    if array.neighborhood() == Neighborhood::Shared {
        return Err("an RPU on a board gets only the pixels of its own region; set region.neighborhood='isolated'".to_owned());
    }
    if array.has_frame_sync() {
        return Err(
            "a pattern loses no pixels, so it needs no frame sync; set hardware.sync=false"
                .to_owned(),
        );
    }
    if array.pixel_bits() != 8 {
        return Err(format!(
            "frame.pixel_bits = {}: pixels on a board have 8 bits",
            array.pixel_bits()
        ));
    }
    if array.region_pixels() > MAX_REGION_VALUES {
        return Err(format!(
            "region.size = {side}: registers show {MAX_REGION_VALUES} pixels; 45 is the largest"
        ));
    }
    for (key, length) in [("width", array.width()), ("height", array.height())] {
        if !length.is_multiple_of(side) {
            let multiple = length.div_ceil(side) * side;
            return Err(format!(
                "frame.{key} = {length}: the pattern makes whole regions; use a multiple of {side}, such as {multiple}"
            ));
        }
    }
    let (columns, max_columns) = (array.columns(), array.region_pixels());
    if columns > max_columns {
        return Err(format!(
            "{columns} regions side by side: their sum is made in {max_columns} clocks; frame.width = {} is the largest with regions of {side} x {side}",
            max_columns * side
        ));
    }
    Ok(())
}

// SPDX-License-Identifier: MIT OR Apache-2.0
//! The classes of the key `zones.classes`: strings of digits, for each region or for each pixel.

use crate::{CameraConfig, ConfigError, RegionClass, ZonesConfig};

/// The classes of the pixels of a frame before any area.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) enum BaseClasses {
    /// All pixels are normal.
    Normal,
    /// A class for each region, by rows.
    OfRegions(Vec<Vec<RegionClass>>),
    /// A class for each pixel, by rows.
    OfPixels(Vec<Vec<RegionClass>>),
}

impl ZonesConfig {
    /// Sets the class of every region of a frame with `columns` regions per row, row by row. The
    /// image, the classes and the areas that were there before are gone.
    pub fn set_classes(&mut self, classes: &[RegionClass], columns: u32) {
        let is_normal = |&class: &RegionClass| class == RegionClass::Normal;
        self.classes = match classes.iter().all(is_normal) {
            true => Vec::new(),
            false => text_of_classes(classes, columns),
        };
        (self.map, self.areas) = (None, Vec::new());
    }
}

impl BaseClasses {
    /// Checks the classes of a configuration whose frame has `width` x `height` pixels.
    pub(crate) fn resolve(
        config: &CameraConfig,
        zones: &ZonesConfig,
        (width, height): (u32, u32),
    ) -> Result<Self, ConfigError> {
        if let Some(map) = &zones.map {
            return Err(ConfigError::Type {
                key: "zones.map".to_owned(),
                problem: format!(
                    "the image \"{map}\" is not read here; write its classes to zones.classes, or name \
                     it in a configuration file, in --set, or in Python"
                ),
            });
        }
        if zones.classes.is_empty() {
            return Ok(Self::Normal);
        }
        let rows = zones.classes.iter().enumerate().map(|(row, text)| classes_of_row(row, text));
        let rows: Vec<Vec<RegionClass>> = rows.collect::<Result<_, _>>()?;
        let side = config.region.size;
        let has_size = |(across, down): (u32, u32)| {
            rows.len() == down as usize && rows.iter().all(|row| row.len() == across as usize)
        };
        let grid = (width.div_ceil(side), height.div_ceil(side));
        if has_size(grid) {
            Ok(Self::OfRegions(rows))
        } else if has_size((width, height)) {
            Ok(Self::OfPixels(rows))
        } else if !config.frame.has_size() {
            Ok(Self::Normal)
        } else {
            let longest = rows.iter().map(Vec::len).max().unwrap_or_default();
            let shortest = rows.iter().map(Vec::len).min().unwrap_or_default();
            let across = match longest == shortest {
                true => longest.to_string(),
                false => format!("{shortest} to {longest}"),
            };
            Err(ConfigError::Range {
                key: "zones.classes".to_owned(),
                value: format!("{} rows of {across} classes", rows.len()),
                valid: format!(
                    "{} rows of {} classes (one for each region), or {height} rows of {width} (one \
                     for each pixel); an image `zones.map` has these classes as its pixels",
                    grid.1, grid.0
                ),
            })
        }
    }

    /// Writes the classes of the pixels of row `y`. Regions have `side` pixels a side.
    pub(crate) fn fill_row(&self, y: u32, side: u32, row: &mut [RegionClass]) {
        match self {
            Self::Normal => row.fill(RegionClass::Normal),
            Self::OfRegions(classes) => {
                let classes = &classes[(y / side) as usize];
                for (pixels, &class) in row.chunks_mut(side as usize).zip(classes) {
                    pixels.fill(class);
                }
            }
            Self::OfPixels(classes) => row.copy_from_slice(&classes[y as usize]),
        }
    }
}

/// Returns the text of the classes of the regions of a frame, row by row.
pub(crate) fn text_of_classes(classes: &[RegionClass], columns: u32) -> Vec<String> {
    let rows = classes.chunks(columns as usize);
    rows.map(|row| row.iter().map(|class| class.digit()).collect()).collect()
}

fn classes_of_row(row: usize, text: &str) -> Result<Vec<RegionClass>, ConfigError> {
    let class = |digit: char| {
        let code = digit.to_digit(10).and_then(|code| u8::try_from(code).ok());
        code.and_then(RegionClass::from_code).ok_or_else(|| ConfigError::Range {
            key: format!("zones.classes[{row}]"),
            value: format!("'{digit}'"),
            valid: "the digits 0 (normal), 1 (off), 2 (keen) and 3 (always)".to_owned(),
        })
    };
    text.chars().map(class).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::AreaConfig;

    fn config(classes: &[&str], size: Option<(u32, u32)>) -> CameraConfig {
        let mut config = CameraConfig::default();
        config.frame.width = size.map(|(width, _)| width);
        config.frame.height = size.map(|(_, height)| height);
        config.region.size = 4;
        let classes = classes.iter().map(|&row| row.to_owned()).collect();
        config.zones = Some(ZonesConfig { classes, ..ZonesConfig::default() });
        config
    }

    fn codes(config: &CameraConfig) -> Vec<u8> {
        let classes = config.validate().unwrap().configured_classes();
        classes.into_iter().map(RegionClass::code).collect()
    }

    #[test]
    fn classes_are_those_of_regions_or_of_pixels() {
        assert_eq!(codes(&config(&["012", "300"], Some((11, 5)))), [0, 1, 2, 3, 0, 0]);
        // The first region has six pixels of 16 that are off, the second one eight of twelve.
        let pixels = ["1100111", "1100111", "1100011", "0000000"];
        assert_eq!(codes(&config(&pixels, Some((7, 4)))), [0, 1]);
    }

    #[test]
    fn a_validated_configuration_has_the_classes_of_regions() {
        let mut config = config(&["1100111", "1100111", "1100011", "0000000"], Some((7, 4)));
        let area = "[{ class = \"keen\", rectangle = [0, 0, 3, 3] }]";
        let zones = config.zones.as_mut().unwrap();
        zones.areas =
            CameraConfig::from_toml(&format!("zones.areas = {area}")).unwrap().zones.unwrap().areas;
        let camera = config.validate().unwrap();
        let zones = camera.config().zones.as_ref().unwrap();
        assert_eq!((zones.classes.as_slice(), zones.areas.len()), (&["21".to_owned()][..], 0));
        assert_eq!(camera.config().validate().unwrap(), camera);
    }

    #[test]
    fn a_map_replaces_classes_and_areas() {
        let mut config = config(&["01", "23"], Some((8, 8)));
        let zones = config.zones.as_mut().unwrap();
        zones.map = Some("map.png".to_owned());
        zones.areas.push(AreaConfig {
            class: RegionClass::Off,
            rectangle: Some([0, 0, 8, 8]),
            polygon: None,
        });
        let map = [3, 0, 2, 1].map(|code| RegionClass::from_code(code).unwrap());
        zones.set_classes(&map, 2);
        assert_eq!(codes(&config), [3, 0, 2, 1]);
        config.zones.as_mut().unwrap().set_classes(&[RegionClass::Normal; 4], 2);
        assert_eq!(config.zones, Some(ZonesConfig::default()));
    }

    #[test]
    fn another_frame_size_has_no_map() {
        let mut config = config(&["01", "23"], Some((8, 8)));
        config.resize_frame(12, 4);
        assert_eq!(codes(&config), [0, 0, 0]);
    }

    #[test]
    fn classes_of_another_size_or_value_are_refused() {
        let error = |config: CameraConfig| config.validate().unwrap_err().to_string();
        let size = Some((8, 8));
        assert!(error(config(&["012", "300"], size)).contains("2 rows of 3 classes"));
        assert!(error(config(&["01", "3"], size)).contains("2 rows of 1 to 2 classes"));
        assert!(error(config(&["01", "34"], size)).contains("zones.classes[1]` = '4'"));
        // The size is that of an input which is not known yet.
        assert!(config(&["012", "300"], None).validate().is_ok());
        let mut with_map = config(&[], size);
        with_map.zones.as_mut().unwrap().map = Some("map.png".to_owned());
        assert!(error(with_map).contains("is not read here"));
    }
}

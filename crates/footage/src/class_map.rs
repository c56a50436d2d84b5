// SPDX-License-Identifier: MIT OR Apache-2.0
//! Maps of zones: images whose pixels are classes of regions. `docs/configuration.md` names the
//! colours.

use std::path::Path;

use foveate_camera::{CameraConfig, RegionClass};

use crate::FootageError;
use crate::picture::read_rgb;

/// Replaces the image of `zones.map` in a configuration by the classes of its pixels. A relative
/// path is relative to `folder`. Without such an image nothing happens.
///
/// # Errors
/// Fails if the image cannot be read, if it has a pixel whose colour is no class, or if the
/// configuration has `zones.classes`, too.
pub fn read_class_map(config: &mut CameraConfig, folder: &Path) -> Result<(), FootageError> {
    let Some(zones) = &mut config.zones else { return Ok(()) };
    if let Some(map) = zones.map.take() {
        if !zones.classes.is_empty() {
            return Err(FootageError::ClassesTwice { map });
        }
        zones.classes = class_rows(&folder.join(map))?;
    }
    Ok(())
}

/// Returns the codes of the classes of an image, a string of digits for each row.
fn class_rows(path: &Path) -> Result<Vec<String>, FootageError> {
    let image = read_rgb(path)?;
    let digit = |(x, y, pixel): (u32, u32, &image::Rgb<u8>)| {
        class_of_colour(pixel.0).map(|class| (y, class.digit())).ok_or_else(|| {
            let [red, green, blue] = pixel.0;
            FootageError::ClassColour { path: path.to_owned(), x, y, red, green, blue }
        })
    };
    let mut rows = vec![String::new(); image.height() as usize];
    for pixel in image.enumerate_pixels() {
        let (y, digit) = digit(pixel)?;
        rows[y as usize].push(digit);
    }
    Ok(rows)
}

/// Returns the class of a colour, or `None` if the colour is no class.
fn class_of_colour(colour: [u8; 3]) -> Option<RegionClass> {
    match colour {
        [0, 0, 0] => Some(RegionClass::Normal),
        [255, 0, 0] | [1, 1, 1] => Some(RegionClass::Off),
        [0, 255, 0] | [2, 2, 2] => Some(RegionClass::Keen),
        [255, 255, 255] | [3, 3, 3] => Some(RegionClass::Always),
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use foveate_camera::ZonesConfig;
    use image::{GrayImage, Luma, Rgb, RgbImage};

    fn config(map: &str) -> CameraConfig {
        let zones = ZonesConfig { map: Some(map.to_owned()), ..ZonesConfig::default() };
        CameraConfig { zones: Some(zones), ..CameraConfig::default() }
    }

    #[test]
    fn colours_and_grey_levels_are_classes() {
        let folder = tempfile::tempdir().unwrap();
        let colours = [[0, 0, 0], [255, 0, 0], [0, 255, 0], [255, 255, 255]];
        let image = RgbImage::from_fn(2, 2, |x, y| Rgb(colours[(2 * y + x) as usize]));
        image.save(folder.path().join("colours.png")).unwrap();
        let image = GrayImage::from_fn(4, 1, |x, _| Luma([u8::try_from(x).unwrap()]));
        image.save(folder.path().join("grey.png")).unwrap();
        for (name, rows) in [("colours.png", &["01", "23"][..]), ("grey.png", &["0123"])] {
            let mut config = config(name);
            read_class_map(&mut config, folder.path()).unwrap();
            let zones = config.zones.unwrap();
            assert_eq!(
                (zones.map, zones.classes),
                (None, rows.iter().map(|&row| row.into()).collect())
            );
        }
    }

    #[test]
    fn a_map_beside_classes_is_refused() {
        let mut config = config("map.png");
        config.zones.as_mut().unwrap().classes = vec!["01".to_owned()];
        let error = read_class_map(&mut config, Path::new("")).unwrap_err();
        assert!(matches!(error, FootageError::ClassesTwice { .. }), "{error}");
    }

    #[test]
    fn other_colours_and_missing_images_are_refused() {
        let folder = tempfile::tempdir().unwrap();
        let mut image = RgbImage::new(5, 4);
        image.put_pixel(3, 2, Rgb([0, 0, 255]));
        image.save(folder.path().join("blue.png")).unwrap();
        let error = read_class_map(&mut config("blue.png"), folder.path()).unwrap_err().to_string();
        assert!(error.contains("pixel (3, 2)") && error.contains("(0, 0, 255)"), "{error}");
        let error = read_class_map(&mut config("gone.png"), folder.path()).unwrap_err().to_string();
        assert!(error.contains("gone.png"), "{error}");
    }
}

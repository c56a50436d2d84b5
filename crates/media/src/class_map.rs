// SPDX-License-Identifier: MIT OR Apache-2.0
//! Maps of zones: images whose pixels are classes of regions. `docs/configuration.md` names the
//! colours.

use std::path::Path;

use foveate_camera::{CameraConfig, RegionClass};

use crate::FootageError;
use crate::picture::read_image;

/// Replaces the image of `zones.map` in a configuration by the classes of its pixels. A relative
/// path is relative to the folder of `file`, from which the configuration was read, or to the
/// working folder if one of the `overrides` (`KEY=VALUE`) names the image. Without such an image
/// nothing happens.
///
/// # Errors
/// Fails if the image cannot be read, if it has a pixel whose colour is no class, or if the
/// configuration has `zones.classes`, too.
pub fn read_class_map(
    config: &mut CameraConfig,
    file: Option<&Path>,
    overrides: &[String],
) -> Result<(), FootageError> {
    let Some(zones) = &mut config.zones else { return Ok(()) };
    if let Some(map) = zones.map.take() {
        if !zones.classes.is_empty() {
            return Err(FootageError::ClassesTwice { map });
        }
        let mut keys = overrides.iter().filter_map(|one| Some(one.split_once('=')?.0.trim()));
        let is_overridden = keys.any(|key| key == "zones" || key == "zones.map");
        let folder = file.filter(|_| !is_overridden).and_then(Path::parent);
        zones.classes = class_rows(&folder.unwrap_or(Path::new("")).join(map))?;
    }
    Ok(())
}

/// Returns the codes of the classes of an image, a string of digits for each row.
fn class_rows(path: &Path) -> Result<Vec<String>, FootageError> {
    let image = read_image(path)?;
    let is_deep = image.color().bytes_per_pixel() > image.color().channel_count();
    let white = if is_deep { u16::MAX } else { u16::from(u8::MAX) };
    let image = image.into_rgb16();
    let mut rows = vec![String::new(); image.height() as usize];
    for (x, y, pixel) in image.enumerate_pixels() {
        // Levels of 8 bits are multiplied by a whole number for 16 bits.
        let colour = pixel.0.map(|level| level / (u16::MAX / white));
        let class = class_of_colour(colour, white).ok_or_else(|| {
            let [red, green, blue] = colour;
            FootageError::ClassColour { path: path.to_owned(), x, y, red, green, blue }
        })?;
        rows[y as usize].push(class.digit());
    }
    Ok(rows)
}

/// Returns the class of a colour of an image whose largest level is `white`, or `None` if the
/// colour is no class. The grey levels 1 and 2 of an image of 2 bits are 85 and 170 of 255.
fn class_of_colour(colour: [u16; 3], white: u16) -> Option<RegionClass> {
    match colour {
        [0, 0, 0] => Some(RegionClass::Normal),
        [1, 1, 1] => Some(RegionClass::Off),
        [2, 2, 2] => Some(RegionClass::Keen),
        [3, 3, 3] => Some(RegionClass::Always),
        [85, 85, 85] if white == 255 => Some(RegionClass::Off),
        [170, 170, 170] if white == 255 => Some(RegionClass::Keen),
        colour if colour == [white, 0, 0] => Some(RegionClass::Off),
        colour if colour == [0, white, 0] => Some(RegionClass::Keen),
        colour if colour == [white; 3] => Some(RegionClass::Always),
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use foveate_camera::ZonesConfig;
    use image::{GrayImage, ImageBuffer, Luma, Rgb, RgbImage};

    fn config(map: &str) -> CameraConfig {
        let zones = ZonesConfig { map: Some(map.to_owned()), ..ZonesConfig::default() };
        CameraConfig { zones: Some(zones), ..CameraConfig::default() }
    }

    fn read(config: &mut CameraConfig, folder: &Path) -> Result<(), FootageError> {
        read_class_map(config, Some(&folder.join("camera.toml")), &[])
    }

    #[test]
    fn colours_and_grey_levels_are_classes() {
        let folder = tempfile::tempdir().unwrap();
        let colours = [[0, 0, 0], [255, 0, 0], [0, 255, 0], [255, 255, 255]];
        let image = RgbImage::from_fn(2, 2, |x, y| Rgb(colours[(2 * y + x) as usize]));
        image.save(folder.path().join("colours.png")).unwrap();
        let image = GrayImage::from_fn(4, 1, |x, _| Luma([u8::try_from(x).unwrap()]));
        image.save(folder.path().join("grey.png")).unwrap();
        let deep = [0, 1, 2, 3, u16::MAX].map(|level| [level; 3]);
        let deep = [deep.as_slice(), &[[u16::MAX, 0, 0], [0, u16::MAX, 0]]].concat();
        let image = ImageBuffer::from_fn(7, 1, |x, _| Rgb(deep[x as usize]));
        image.save(folder.path().join("deep.png")).unwrap();
        std::fs::write(folder.path().join("small.pgm"), "P2 4 1 3\n0 1 2 3\n").unwrap();
        for (name, rows) in [
            ("colours.png", &["01", "23"][..]),
            ("grey.png", &["0123"]),
            ("deep.png", &["0123312"]),
            ("small.pgm", &["0123"]),
        ] {
            let mut config = config(name);
            read(&mut config, folder.path()).unwrap();
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
        let error = read_class_map(&mut config, None, &[]).unwrap_err();
        assert!(matches!(error, FootageError::ClassesTwice { .. }), "{error}");
    }

    #[test]
    fn other_colours_and_missing_images_are_refused() {
        let folder = tempfile::tempdir().unwrap();
        let mut image = RgbImage::new(5, 4);
        image.put_pixel(3, 2, Rgb([0, 0, 255]));
        image.save(folder.path().join("blue.png")).unwrap();
        let error = read(&mut config("blue.png"), folder.path()).unwrap_err().to_string();
        assert!(error.contains("pixel (3, 2)") && error.contains("(0, 0, 255)"), "{error}");
        let image = ImageBuffer::from_pixel(1, 1, Luma([256_u16]));
        image.save(folder.path().join("deep.png")).unwrap();
        let error = read(&mut config("deep.png"), folder.path()).unwrap_err().to_string();
        assert!(error.contains("(256, 256, 256)"), "{error}");
        let error = read(&mut config("gone.png"), folder.path()).unwrap_err().to_string();
        assert!(error.contains("gone.png"), "{error}");
    }
}

// SPDX-License-Identifier: MIT OR Apache-2.0
//! Overlays, heat maps and videos show the results of the model.
#![allow(clippy::cast_possible_truncation, reason = "a test fails by panicking")]

use crate::support;
use std::fs;
use std::path::Path;
use std::process::Command;

use crate::support::{STREET, frames, names, outcomes, street};
use foveate_camera::RegionAction;
use foveate_pixels::convert_depth;
use foveate_simulator::{OverlayStyle, PictureFormat, RunOptions};
use foveate_tools::{Tool, Toolchain, testing::require_tools};
use image::RgbImage;

const NOTHING: fn() -> RunOptions = || RunOptions { rendered: None, ..RunOptions::default() };
/// The factor by which 45 x 38 pixels are enlarged to a width of at least 448. `DOT` is the size of
/// a dot in the footer.
const SCALE: u32 = 10;
const DOT: u32 = 2;

fn pictures(folder: &Path, name: &str) -> Vec<RgbImage> {
    let picture = |t| image::open(folder.join(format!("{name}/{t:06}.png"))).unwrap().into_rgb8();
    assert_eq!(names(&folder.join(name)).len(), 5);
    (0..5).map(picture).collect()
}

/// Sent regions are as bright as the frame, regions that are not sent are dark, and means are
/// tinted.
#[test]
fn the_overlay_shows_what_is_sent() {
    let folder = tempfile::tempdir().unwrap();
    let means = [&STREET[..], &["render.irrelevant=\"mean\""]].concat();
    for overrides in [&STREET[..], &means] {
        let output = folder.path().join(overrides.len().to_string());
        street(&output, overrides, &RunOptions { overlay: Some(PictureFormat::Png), ..NOTHING() });
        let sources = frames(&support::design(overrides));
        let shown = pictures(&output, "overlay").into_iter().zip(outcomes(overrides));
        let mut tinted = 0;
        for ((picture, outcome), source) in shown.zip(sources) {
            for region in 0..30 {
                let (x, y) = (region % 6 * 8 + 3, region / 6 * 8 + 3);
                let colour = picture.get_pixel(x * SCALE + 2, y * SCALE + 2).0;
                let grey = source.get(x, y) as u8;
                match outcome.actions[region as usize] {
                    RegionAction::Forward => assert_eq!(colour, [grey; 3]),
                    RegionAction::Summarize => {
                        assert!(colour[0] > colour[1] && colour[2] > colour[1], "{colour:?}");
                        tinted += 1;
                    }
                    RegionAction::Hold | RegionAction::Blank => {
                        assert!(
                            colour == [colour[0]; 3] && 3 * u32::from(colour[0]) <= grey.into()
                        );
                    }
                }
            }
        }
        assert_eq!(tinted > 0, overrides.len() > STREET.len());
    }
}

#[test]
fn the_outlines_show_each_state_in_its_colour() {
    let folder = tempfile::tempdir().unwrap();
    let output = folder.path().join("out");
    let outlines = RunOptions { overlay_style: OverlayStyle::Outlines, ..NOTHING() };
    street(&output, &STREET, &RunOptions { overlay: Some(PictureFormat::Png), ..outlines });
    assert!(!output.join("rendered").exists());
    for (picture, outcome) in pictures(&output, "overlay").iter().zip(outcomes(&STREET)) {
        assert_eq!(picture.dimensions(), (45 * SCALE, 38 * SCALE + (9 + 9 + 28) * DOT));
        for region in 0..30 {
            // This pixel is not on a line of the grid.
            let at = ((region % 6 * 8 + 3) * SCALE, (region / 6 * 8 + 3) * SCALE);
            let [r, g, b] = picture.get_pixel(at.0, at.1).0;
            let index = region as usize;
            match (outcome.srs[index], outcome.trs[index]) {
                (true, true) => assert!(g > r && g > b),
                (true, false) => assert!(r > g && g > b),
                (false, true) => assert!(b > g && g > r),
                (false, false) => assert!(r == g && g == b),
            }
            let corner = (region % 6 * 8 * SCALE, region / 6 * 8 * SCALE);
            let outlined = picture.get_pixel(corner.0, corner.1).0 == [70, 230, 180];
            assert_eq!(outlined, outcome.active[index], "outline of region {region}");
        }
    }
}

/// A picture of squares moves by two columns and a row. Each region whose content has moved has an
/// arrow, in white, from its centre towards the right and downwards. The arrows end in the next
/// region.
#[test]
fn arrows_show_where_content_has_moved() {
    let folder = tempfile::tempdir().unwrap();
    let image = |name: &str, shift: (u32, u32)| {
        let inside = |at: u32, shift: u32| matches!((at + 16 - shift) % 8, 2 | 3);
        support::grey(&folder.path().join(name), 32, 16, |x, y| match x {
            0..16 if inside(x, shift.0) && inside(y, shift.1) => 200,
            _ => 20,
        })
    };
    let images = [image("a.png", (0, 0)), image("b.png", (2, 1)), image("c.png", (2, 1))];
    let overrides = [
        "hardware.organization=\"serial\"",
        "denoise.filter=\"none\"",
        "spatial=[{feature=\"flow\",radius=2}]",
    ];
    let output = folder.path().join("out");
    let options = RunOptions { overlay: Some(PictureFormat::Png), ..NOTHING() };
    support::run(&images, &overrides, &output, &options).unwrap();
    // Each pixel is enlarged to 14 x 14, and a region to 112 x 112.
    const CELL: u32 = 112;
    let white_at = |frame: u32, region: u32| {
        let picture = image::open(output.join(format!("overlay/{frame:06}.png"))).unwrap();
        let picture = picture.into_rgb8();
        let places = (0..CELL).flat_map(|y| (0..CELL).map(move |x| (x, y)));
        let is_white = |&(x, y): &(u32, u32)| {
            picture.get_pixel(region % 4 * CELL + x, region / 4 * CELL + y).0 == [255; 3]
        };
        places.filter(is_white).collect::<Vec<_>>()
    };
    for region in 0..8 {
        assert_eq!(white_at(0, region), [], "the first frame has no reference");
        assert_eq!(white_at(1, region).is_empty(), region % 4 == 3, "region {region}");
        assert_eq!(white_at(2, region), [], "nothing moves in the last frame");
        if region % 4 == 0 {
            let arrow = white_at(1, region);
            let from = CELL / 2 - 8;
            assert!(arrow.iter().all(|&(x, y)| x >= from && y >= from), "{arrow:?}");
            let right = arrow.iter().filter(|(x, _)| *x >= CELL - 20).count();
            let below = arrow.iter().filter(|(_, y)| *y >= CELL - 20).count();
            assert!(right > below, "it is longer to the right than downwards");
        }
    }
}

/// Regions that are off are hatched, and a line surrounds the areas of the other classes. The
/// legend names the classes of the map, and only these.
#[test]
fn the_overlay_shows_the_classes_of_regions() {
    let folder = tempfile::tempdir().unwrap();
    let plain = |x: u32, y: u32| (100 + x + y) as u8;
    let image = support::grey(&folder.path().join("a.png"), 48, 32, plain);
    let output = folder.path().join("out");
    let overrides =
        ["denoise.filter=\"none\"", "zones.classes=[\"100033\",\"102203\",\"102200\",\"000000\"]"];
    let options = RunOptions { overlay: Some(PictureFormat::Png), ..NOTHING() };
    support::run(&[image], &overrides, &output, &options).unwrap();
    let picture = image::open(output.join("overlay/000000.png")).unwrap().into_rgb8();
    // Each pixel is enlarged to 10 x 10, and a dot is 2 x 2.
    const CELL: u32 = 80;
    assert_eq!(picture.dimensions(), (480, 320 + (2 * 9 + 9 + 28) * 2));
    let at = |x: u32, y: u32| picture.get_pixel(x, y).0;
    let [keen, always] = [[0, 114, 178], [213, 94, 0]];
    // The area of regions 2,1 to 3,2 has a line around it and none inside.
    for place in (2 * CELL..4 * CELL).step_by(7) {
        assert_eq!(at(place, CELL), keen);
        assert_eq!(at(place, 3 * CELL - 1), keen);
        let place = place - CELL;
        assert_eq!([at(2 * CELL, place), at(4 * CELL - 1, place)], [keen; 2]);
    }
    assert!(![at(3 * CELL, CELL + 30), at(2 * CELL + 30, 2 * CELL)].contains(&keen));
    // The border of the frame is an edge, too.
    assert_eq!(
        [at(4 * CELL + 9, 0), at(6 * CELL - 1, CELL + 9), at(5 * CELL, CELL + 9)],
        [always; 3]
    );
    let shades = |column: u32, row: u32| {
        let row = (0..20).map(|x| at(column * CELL + 30 + x, row * CELL + 35));
        let darkest = row.clone().map(|[r, g, b]| u32::from(r) + u32::from(g) + u32::from(b));
        (darkest.clone().min().unwrap(), darkest.max().unwrap())
    };
    let (dark, bright) = shades(0, 1);
    assert!(dark * 2 < bright, "{dark} {bright}");
    let (dark, bright) = shades(1, 1);
    assert!(dark * 5 > bright * 4, "{dark} {bright}");
    // A map of one class has a legend of one class, and none with normal regions alone.
    let legend = |classes: &str| {
        let output = folder.path().join(format!("out{}", classes.len()));
        support::run(&[folder.path().join("a.png")], &[classes], &output, &options).unwrap();
        image::open(output.join("overlay/000000.png")).unwrap().into_rgb8()
    };
    let row = "\"222222\"";
    let only_keen = legend(&format!("zones.classes=[{row},{row},{row},{row}]"));
    let has = |picture: &RgbImage, colour: [u8; 3]| {
        picture.enumerate_pixels().any(|(_, y, pixel)| y >= 320 && pixel.0 == colour)
    };
    assert_eq!([keen, always].map(|colour| has(&only_keen, colour)), [true, false]);
    assert_eq!([keen, always].map(|colour| has(&picture, colour)), [true; 2]);
    assert_eq!(legend("zones={}").height(), 320 + (9 + 9 + 28) * 2);
}

/// The bars fill the width. Each has the height of the share of active regions, on the smallest
/// scale for all bars but the first, which ends at the top.
#[test]
fn the_strip_shows_the_share_of_active_regions() {
    const HEIGHT: u32 = 28 * DOT;
    let folder = tempfile::tempdir().unwrap();
    let output = folder.path().join("out");
    street(&output, &STREET, &RunOptions { overlay: Some(PictureFormat::Png), ..NOTHING() });
    let pictures = pictures(&output, "overlay");
    let last = &pictures[4];
    let active = outcomes(&STREET).into_iter();
    let active: Vec<u32> =
        active.map(|outcome| outcome.active.iter().filter(|&&bit| bit).count() as u32).collect();
    let most = active[1..].iter().max().unwrap();
    let scale =
        [10, 20, 50, 100, 200, 500, 1000].into_iter().find(|scale| most * 1000 <= scale * 30);
    for (t, active) in (0..).zip(active) {
        let column = last.width() * (2 * t + 1) / 10;
        let lit = (0..HEIGHT)
            .filter(|y| last.get_pixel(column, last.height() - 1 - y).0 == [70, 230, 180])
            .count() as u32;
        assert_eq!(lit, (active * 1000 * HEIGHT / (scale.unwrap() * 30)).min(HEIGHT), "frame {t}");
    }
}

/// Brightness grows with the score, and equal scores have equal colours.
#[test]
fn heat_maps_are_ordered_like_the_scores() {
    let folder = tempfile::tempdir().unwrap();
    let output = folder.path().join("out");
    street(&output, &STREET, &RunOptions { heatmap: Some(PictureFormat::Png), ..NOTHING() });
    let outcomes = outcomes(&STREET);
    let counts = |t: usize| outcomes[t].temporal_count.iter().map(|&count| count.into()).collect();
    type ScoresOfFrame<'a> = Box<dyn Fn(usize) -> Vec<u64> + 'a>;
    let maps: [(&str, ScoresOfFrame<'_>); 3] = [
        ("heatmap_edge", Box::new(|t| outcomes[t].scores[0].clone())),
        ("heatmap_mad", Box::new(|t| outcomes[t].scores[1].clone())),
        ("heatmap_temporal", Box::new(counts)),
    ];
    for (name, scores) in maps {
        let mut seen: Vec<(u64, u32)> = Vec::new();
        for (t, picture) in pictures(&output, name).iter().enumerate() {
            for (region, score) in (0..).zip(scores(t)) {
                let at = ((region % 6 * 8 + 3) * SCALE, (region / 6 * 8 + 3) * SCALE);
                let [r, g, b] = picture.get_pixel(at.0, at.1).0.map(u32::from);
                seen.push((score, 299 * r + 587 * g + 114 * b));
            }
        }
        seen.sort_unstable();
        assert!(seen.windows(2).all(|pair| pair[0].1 <= pair[1].1), "{name}");
        assert!(seen[0].1 < seen[seen.len() - 1].1, "{name}");
    }
}

#[test]
fn tiny_and_narrow_frames_have_pictures_too() {
    let folder = tempfile::tempdir().unwrap();
    for (width, height) in [(1, 1), (2, 300), (300, 2), (5, 2000)] {
        let (w, h) = (format!("frame.width={width}"), format!("frame.height={height}"));
        let overrides = [
            w.as_str(),
            h.as_str(),
            "region.size=2",
            "temporal.min_count=1",
            "spatial.0.min_score=1",
        ];
        let output = folder.path().join(format!("{width}x{height}"));
        let both = RunOptions {
            overlay: Some(PictureFormat::Png),
            heatmap: Some(PictureFormat::Png),
            ..RunOptions::default()
        };
        street(&output, &overrides, &both);
        assert_eq!(
            pictures(&output, "heatmap_edge")[0].width(),
            pictures(&output, "overlay")[0].width()
        );
    }
}

/// Returns the decoded bytes of a video.
fn decoded(path: &Path, format: &str) -> Vec<u8> {
    let ffmpeg = Toolchain::system().find(Tool::Ffmpeg).unwrap().path;
    let mut command = Command::new(ffmpeg);
    command.args(["-v", "error", "-i"]).arg(path);
    let output = command.args(["-f", "rawvideo", "-pix_fmt", format, "pipe:1"]).output().unwrap();
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    output.stdout
}

#[test]
fn lossless_video_gives_every_pixel_back() {
    if !require_tools(&[Tool::Ffmpeg]) {
        return;
    }
    let folder = tempfile::tempdir().unwrap();
    for (bits, depth, format) in [(8, 8, "gray"), (3, 8, "gray"), (12, 16, "gray16le")] {
        let bits_override = format!("frame.pixel_bits={bits}");
        let overrides =
            [&STREET[..3], &["spatial.0.level=1", "temporal.level=1", &bits_override]].concat();
        let output = folder.path().join(bits.to_string());
        let options = RunOptions { rendered: Some(PictureFormat::Mkv), ..RunOptions::default() };
        street(&output, &overrides, &options);
        let mut expected = Vec::new();
        for outcome in outcomes(&overrides) {
            for &value in outcome.rendered.pixels() {
                let [low, high] = convert_depth(value, bits, depth).to_le_bytes();
                expected.push(low);
                if depth == 16 {
                    expected.push(high);
                }
            }
        }
        assert!(decoded(&output.join("rendered.mkv"), format) == expected, "{bits} bits");
        assert!(!output.join("rendered").exists());
    }
}

#[test]
fn overlays_as_video_are_the_pictures() {
    if !require_tools(&[Tool::Ffmpeg]) {
        return;
    }
    let folder = tempfile::tempdir().unwrap();
    let [video, png, mp4] = ["video", "png", "mp4"].map(|name| folder.path().join(name));
    street(&video, &STREET, &RunOptions { overlay: Some(PictureFormat::Mkv), ..NOTHING() });
    street(&png, &STREET, &RunOptions { overlay: Some(PictureFormat::Png), ..NOTHING() });
    let pictures = pictures(&png, "overlay");
    let (width, height) = pictures[0].dimensions();
    let expected: Vec<u8> = pictures.into_iter().flat_map(RgbImage::into_raw).collect();
    assert!(decoded(&video.join("overlay.mkv"), "rgb24") == expected);
    // In MP4, odd sides grow by one line.
    street(&mp4, &STREET, &RunOptions { overlay: Some(PictureFormat::Mp4), ..NOTHING() });
    let even = |side: u32| (side.next_multiple_of(2)) as usize;
    let bytes = decoded(&mp4.join("overlay.mp4"), "gray").len();
    assert_eq!(bytes, 5 * even(width) * even(height));
}

#[test]
fn a_video_of_one_frame_has_one() {
    if !require_tools(&[Tool::Ffmpeg]) {
        return;
    }
    let folder = tempfile::tempdir().unwrap();
    let image = support::grey(&folder.path().join("a.png"), 9, 9, |x, y| (20 * x * y) as u8);
    let output = folder.path().join("out");
    let options = RunOptions { rendered: Some(PictureFormat::Mkv), ..RunOptions::default() };
    support::run(&[&image], &["spatial.0.min_score=0"], &output, &options).unwrap();
    assert_eq!(decoded(&output.join("rendered.mkv"), "gray").len(), 81);
    assert!(fs::metadata(output.join("rendered.mkv")).unwrap().len() > 0);
    assert_eq!(frames(&support::design(&STREET)).count(), 5);
}

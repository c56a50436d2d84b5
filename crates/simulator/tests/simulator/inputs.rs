// SPDX-License-Identifier: MIT OR Apache-2.0
//! The inputs that can be named, the order in which they are read, and the messages for inputs that
//! cannot be read.

use std::fs;
use std::path::{Path, PathBuf};

use crate::support::{grey, run};
use foveate_camera::CameraConfig;
use foveate_design::DesignConfig;
use foveate_media::{FootageError, InputOptions, open};
use foveate_simulator::RunOptions;

fn level(frame: usize) -> u8 {
    u8::try_from(frame).unwrap()
}

/// Returns the names and the first pixels of all frames, in order.
fn read_all<P: AsRef<Path>>(inputs: &[P]) -> Result<Vec<(String, u16)>, FootageError> {
    let mut source = open(inputs, &CameraConfig::default(), &InputOptions::default())?;
    let total = source.frames();
    let mut seen = Vec::new();
    while let Some(frame) = source.next_frame()? {
        let name = Path::new(&frame.name).file_name().unwrap().to_string_lossy().into_owned();
        seen.push((name, frame.frame.get(0, 0)));
    }
    assert_eq!(total, Some(seen.len() as u64));
    Ok(seen)
}

fn refusal<P: AsRef<Path>>(inputs: &[P]) -> String {
    read_all(inputs).unwrap_err().to_string()
}

#[test]
fn folders_and_patterns_are_read_in_natural_order() {
    let folder = tempfile::tempdir().unwrap();
    let sorted = ["frame1.png", "frame2.bmp", "frame02b.pgm", "frame10.PNG", "frame11.jpg"];
    for (index, name) in sorted.iter().enumerate().rev() {
        grey(&folder.path().join(name), 8, 8, |_, _| level(index));
    }
    fs::write(folder.path().join("notes.txt"), "no image").unwrap();
    fs::write(folder.path().join(".hidden.png"), "no image").unwrap();
    fs::create_dir(folder.path().join("folder.png")).unwrap();
    let expected: Vec<(String, u16)> =
        sorted.iter().zip(0..).map(|(&name, index)| (name.to_owned(), index)).collect();
    assert_eq!(read_all(&[folder.path()]).unwrap(), expected);
    assert_eq!(read_all(&[folder.path().join("*")]).unwrap(), expected);
    let some = read_all(&[folder.path().join("frame1*")]).unwrap();
    assert_eq!(some, [expected[0].clone(), expected[3].clone(), expected[4].clone()]);
}

#[test]
fn listed_files_keep_their_order() {
    let folder = tempfile::tempdir().unwrap();
    let files: Vec<PathBuf> = ["c.png", "a.png", "b[1].png"]
        .iter()
        .enumerate()
        .map(|(index, name)| grey(&folder.path().join(name), 4, 4, |_, _| level(index)))
        .collect();
    let seen = read_all(&[&files[0], &files[1], &files[2], &files[1]]).unwrap();
    assert_eq!(seen.iter().map(|frame| frame.1).collect::<Vec<_>>(), [0, 1, 2, 1]);
}

#[test]
fn the_number_of_frames_can_be_limited() {
    let folder = tempfile::tempdir().unwrap();
    for index in 0..5 {
        grey(&folder.path().join(format!("{index}.png")), 4, 4, |_, _| level(index));
    }
    let limit = |frames| InputOptions { frames: Some(frames), ..InputOptions::default() };
    let config = DesignConfig::default();
    assert_eq!(open(&[folder.path()], &config.camera, &limit(3)).unwrap().frames(), Some(3));
    assert_eq!(open(&["scene:fade"], &config.camera, &limit(300)).unwrap().frames(), Some(300));
    let error = open(&[folder.path()], &config.camera, &limit(0)).err().unwrap();
    assert!(error.to_string().contains("holds no frame"));
}

#[test]
fn scenes_take_their_size_from_the_configuration() {
    let options = InputOptions::default();
    let config = DesignConfig::default();
    assert_eq!(open(&["scene:street"], &config.camera, &options).unwrap().size(), (224, 224));
    let config = DesignConfig::from_toml("frame.width = 64\nframe.height = 20").unwrap();
    let mut source = open(&["scene:street"], &config.camera, &options).unwrap();
    assert_eq!((source.size(), source.frames()), ((64, 20), Some(90)));
    assert_eq!(source.next_frame().unwrap().unwrap().name, "scene:street");
    let config = DesignConfig::from_toml("frame.width = 99999").unwrap();
    let message = open(&["scene:street"], &config.camera, &options).err().unwrap().to_string();
    assert!(message.contains("frame.width") && message.contains("1..=16384"), "{message}");
}

#[test]
fn what_cannot_be_opened_is_named_with_what_to_do() {
    let folder = tempfile::tempdir().unwrap();
    let here = |name: &str| folder.path().join(name).display().to_string();
    let contains = |message: &str, parts: &[&str]| {
        assert!(parts.iter().all(|part| message.contains(part)), "{message}");
        assert!(!message.contains('\n'), "one line: {message}");
    };
    contains(&refusal::<&str>(&[]), &["no input was given", "scene:NAME"]);
    contains(&refusal(&[here("gone.png")]), &[&here("gone.png"), "does not exist"]);
    contains(&refusal(&[here("*.png")]), &[&here("*.png"), "no image matches"]);
    contains(&refusal(&[here("a**b")]), &["is not a valid pattern"]);
    contains(&refusal(&[folder.path()]), &["holds no image and no video", "PNG, JPEG, BMP"]);
    contains(&refusal(&["scene:stret"]), &["unknown scene `stret`; did you mean `street`?"]);
    contains(&refusal(&["scene:street", "scene:fade"]), &["`scene:street`", "on its own"]);
    fs::write(here("text.png"), "not an image").unwrap();
    contains(&refusal(&[here("text.png")]), &[&here("text.png"), "supported type"]);
    fs::write(here("empty.png"), "").unwrap();
    contains(&refusal(&[here("empty.png")]), &[&here("empty.png"), "supported type"]);
}

#[test]
fn frames_of_different_sizes_are_refused_with_both_names() {
    let folder = tempfile::tempdir().unwrap();
    let first = grey(&folder.path().join("1.png"), 8, 6, |_, _| 0);
    grey(&folder.path().join("2.png"), 8, 6, |_, _| 0);
    let other = grey(&folder.path().join("3.png"), 9, 6, |_, _| 0);
    let message = refusal(&[folder.path()]);
    assert!(message.contains(&format!("`{}` has 8x6 pixels", first.display())), "{message}");
    assert!(message.contains(&format!("`{}` has 9x6", other.display())), "{message}");
}

#[test]
fn a_configured_size_must_be_that_of_the_images() {
    let folder = tempfile::tempdir().unwrap();
    let file = grey(&folder.path().join("1.png"), 8, 6, |_, _| 0);
    let output = folder.path().join("out");
    let error = run(&[&file], &["frame.width=16"], &output, &RunOptions::default()).unwrap_err();
    let message = error.to_string();
    assert!(message.contains("`frame.width` = 16") && message.contains("8x6"), "{message}");
    assert!(!output.exists());
}

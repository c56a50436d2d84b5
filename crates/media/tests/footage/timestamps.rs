// SPDX-License-Identifier: MIT OR Apache-2.0
//! Times that a file gives to frames.

use std::fs;
use std::path::{Path, PathBuf};

use crate::clips::{frames, opened};
use foveate_media::{
    FootageError, FrameRate, ImageRelation, InputOptions, RawLayout, TimestampUnit, TimestampsFile,
};

struct Folder(tempfile::TempDir);

impl Folder {
    fn new() -> Self {
        let dir = tempfile::tempdir().unwrap();
        for frame in 0..4 {
            fs::write(dir.path().join(format!("f{frame}.pgm")), "P2 2 1 255 1 2\n").unwrap();
        }
        Self(dir)
    }

    fn path(&self) -> &Path {
        self.0.path()
    }

    fn options(&self, text: &str, unit: TimestampUnit) -> InputOptions {
        let path = self.path().join("times.txt");
        fs::write(&path, text).unwrap();
        InputOptions { timestamps: Some(TimestampsFile { path, unit }), ..InputOptions::default() }
    }

    fn error(&self, text: &str) -> String {
        let options = self.options(text, TimestampUnit::Seconds);
        let read = || -> Result<(), FootageError> {
            let mut source = opened(self.path(), 8, &options)?;
            while source.next_frame()?.is_some() {}
            Ok(())
        };
        read().unwrap_err().to_string()
    }
}

fn times(path: &Path, options: &InputOptions) -> Vec<u64> {
    frames(path, 8, options).0.iter().map(|frame| frame.time_us).collect()
}

#[test]
fn images_have_the_times_of_the_file() {
    let folder = Folder::new();
    let options = folder.options("10\n10.5\n12\n12.25\n", TimestampUnit::Seconds);
    assert_eq!(times(folder.path(), &options), [0, 500_000, 2_000_000, 2_250_000]);
    // They select frames, as the times of a video do.
    let mut late = options.clone();
    late.selection.start_us = Some(400_000);
    late.selection.end_us = Some(2_250_000);
    assert_eq!(times(folder.path(), &late), [500_000, 2_000_000]);
    let mut slow = options;
    slow.selection.rate = FrameRate::new(1, 1).ok();
    assert_eq!(times(folder.path(), &slow), [0, 2_000_000]);
    let named = "5 a/f0.pgm\n7 a/f1.pgm\n8 a/f2.pgm\n9 a/f3.pgm\n";
    let named = folder.options(named, TimestampUnit::Nanoseconds);
    assert_eq!(
        opened(folder.path(), 8, &named).err().unwrap().to_string().split(": ").nth(1).unwrap(),
        "line 2"
    );
    let named = "5e0".replace("e0", "000 a/f0.pgm\n7000 f1.pgm\n8000 f2.pgm\n9000 f3.pgm\n");
    let named = folder.options(&named, TimestampUnit::Nanoseconds);
    assert_eq!(times(folder.path(), &named), [0, 2, 3, 4]);
}

#[test]
fn a_file_that_does_not_fit_is_refused() {
    let folder = Folder::new();
    assert!(folder.error("1\n2\n3\n").contains("it has 3 times, but there are 4 frames"));
    assert!(folder.error("1\n2\n3\n4\n5\n").contains("it has 5 times, but there are 4 frames"));
    assert!(folder.error("").contains("it has 0 times"));
    let other = folder.error("1 f0.pgm\n2 f2.pgm\n3 f1.pgm\n4 f3.pgm\n");
    assert!(other.contains("line 2 is for `f2.pgm`, but the frame is `"), "{other}");
    let options = folder.options("1\n2\n3\n4\n", TimestampUnit::Seconds);
    let missing = InputOptions {
        timestamps: Some(TimestampsFile {
            path: PathBuf::from("none.txt"),
            unit: TimestampUnit::Seconds,
        }),
        ..InputOptions::default()
    };
    let error = opened(folder.path(), 8, &missing).err().unwrap().to_string();
    assert!(error.starts_with("the times in `none.txt` cannot be used: "), "{error}");
    let set = InputOptions { images: ImageRelation::Set, ..options.clone() };
    for (path, options) in [(folder.path(), &set), (Path::new("scene:street"), &options)] {
        let error = opened(path, 8, options).err().unwrap().to_string();
        assert!(error.starts_with("--timestamps cannot be used: "), "{error}");
    }
}

/// The number of frames of a stream may be unknown. Those before a fault are kept.
#[test]
fn raw_video_of_another_length_than_its_times_has_a_problem() {
    let folder = Folder::new();
    let path = folder.path().join("clip.gz");
    fs::write(&path, [3; 12]).unwrap();
    let raw = RawLayout::parse("2x2,gray").ok();
    for (text, count, problem) in [
        ("0\n1\n", 2, Some("it has 2 times, but there are more frames")),
        ("0\n1\n2\n3\n", 3, Some("it has 4 times, but there are 3 frames")),
        ("0\n1\n2\n", 3, None),
    ] {
        let options = folder.options(text, TimestampUnit::Seconds);
        let options = InputOptions { raw, ..options };
        let (found, said) = frames(&path, 8, &options);
        assert_eq!((found.len(), said.is_some()), (count, problem.is_some()), "{said:?}");
        assert!(problem.is_none_or(|problem| said.unwrap().contains(problem)));
        // Frames that are not wanted need no times.
        let few = InputOptions { frames: Some(2), ..options };
        assert_eq!(frames(&path, 8, &few).1, None);
    }
    let none = folder.options("", TimestampUnit::Seconds);
    let error = opened(&path, 8, &InputOptions { raw, ..none }).err().unwrap().to_string();
    assert!(error.contains("it has 0 times"), "{error}");
}

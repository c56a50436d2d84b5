// SPDX-License-Identifier: MIT OR Apache-2.0
//! Tests of inputs that are not of the type for which they were taken, and of the messages about
//! them.

use std::fs;
use std::path::Path;
use std::process::Command;

use crate::common::{expect_failure, foveate, run_in};
use foveate_tools::{
    Tool,
    testing::{data_folder, require_tools},
};

fn ffmpeg(folder: &Path, args: &str) {
    let args = args.split_whitespace();
    let status =
        Command::new("ffmpeg").args(["-v", "error"]).args(args).current_dir(folder).status();
    assert!(status.unwrap().success());
}

/// Returns the messages on standard error of a run that succeeds.
fn messages(folder: &Path, args: &[&str]) -> String {
    let _ = fs::remove_dir_all(folder.join("out"));
    let outcome = run_in(folder, &[args, &["-o", "out", "--quiet"]].concat());
    assert_eq!(outcome.code, 0, "{args:?}: {}", outcome.stderr);
    outcome.stderr
}

fn pgm(path: &Path, (width, height): (usize, usize), pixel: impl Fn(usize, usize) -> u8) {
    let mut bytes = format!("P5 {width} {height} 255\n").into_bytes();
    bytes.extend(
        (0..height).flat_map(|y| (0..width).map(move |x| (x, y))).map(|(x, y)| pixel(x, y)),
    );
    fs::write(path, bytes).unwrap();
}

#[test]
fn what_is_no_video_is_not_to_be_played() {
    if !require_tools(&[Tool::Ffmpeg, Tool::Ffprobe]) {
        return;
    }
    let dir = tempfile::tempdir().unwrap();
    let at = |name: &str| dir.path().join(name);
    fs::write(at("empty.mp4"), "").unwrap();
    fs::write(at("t10k-labels-idx1-ubyte"), [0, 0, 8, 1, 0, 0, 0, 2, 7, 1]).unwrap();
    fs::write(at("floats.idx"), [0, 0, 13, 2, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 0]).unwrap();
    fs::write(at("notes.txt"), "no footage").unwrap();
    fs::write(at("broken.mp4"), "no footage").unwrap();
    for (input, parts) in [
        ("empty.mp4", &["`empty.mp4` holds no frames: it is empty"][..]),
        ("t10k-labels-idx1-ubyte", &["IDX file of labels", "name the file of the images"]),
        ("floats.idx", &["IDX file, but not of 8-bit images"]),
        ("notes.txt", &["`notes.txt` is not an image", "PNG", "IDX"]),
        ("v4l2:/dev/none", &["camera `/dev/none` gives no frame", "No such file", "connected"]),
        ("https://example.org/a.mp4?x=[1]", &["is a URL", "download it first", "yuv4mpegpipe"]),
        (
            "rtsp://me:secret@127.0.0.1:9/live",
            &["camera `rtsp://127.0.0.1:9/live` gives no frame", "refused", "ffprobe URL"],
        ),
        ("rtmp://camera/1", &["`rtmp://camera/1` is a URL", "RTSP"]),
        ("missing.mp4", &["`missing.mp4` does not exist"]),
    ] {
        expect_failure(dir.path(), 2, &["simulate", input, "-o", "out"], parts);
        let outcome = run_in(dir.path(), &["simulate", input, "-o", "out"]);
        assert!(!outcome.stderr.contains("play it"), "{}", outcome.stderr);
        assert!(!outcome.stderr.contains("secret"), "{}", outcome.stderr);
    }
    // An input that claims to be a video may be a damaged one.
    expect_failure(
        dir.path(),
        2,
        &["simulate", "broken.mp4", "-o", "out"],
        &["broken.mp4", "play it"],
    );
}

#[test]
fn a_file_of_several_videos_is_told_of_and_one_is_chosen() {
    if !require_tools(&[Tool::Ffmpeg, Tool::Ffprobe]) {
        return;
    }
    let dir = tempfile::tempdir().unwrap();
    let source = |size: &str| format!("-f lavfi -i testsrc2=size={size}:rate=10:duration=0.3");
    let sources = [source("64x48"), source("32x24")].join(" ");
    ffmpeg(dir.path(), &format!("{sources} -map 0 -map 1 -c:v ffv1 two.mkv"));
    for (choice, size) in [(&[][..], "64x48"), (&["--video-stream", "1"], "32x24")] {
        let said = messages(dir.path(), &[&["simulate", "two.mkv"], choice].concat());
        assert_eq!(said.contains("warning: `two.mkv` has 2 video streams"), choice.is_empty());
        let summary = fs::read(dir.path().join("out/summary.json")).unwrap();
        let summary: serde_json::Value = serde_json::from_slice(&summary).unwrap();
        let found = format!("{}x{}", summary["width"], summary["height"]);
        assert_eq!((found.as_str(), &summary["complete"]), (size, &true.into()), "{said}");
    }
    let other = ["simulate", "two.mkv", "--video-stream", "2", "-o", "no"];
    expect_failure(dir.path(), 2, &other, &["no video stream 2"]);
}

#[test]
fn no_frames_at_all_are_not_asked_for() {
    let dir = tempfile::tempdir().unwrap();
    for option in ["--frames", "--max-frames"] {
        let outcome = run_in(dir.path(), &["simulate", "scene:street", "-o", "out", option, "0"]);
        assert_eq!(outcome.code, 2);
        assert!(
            outcome.stderr.contains("'0'") && outcome.stderr.contains("1.."),
            "{}",
            outcome.stderr
        );
    }
}

#[test]
fn images_and_videos_side_by_side_are_a_question() {
    if !require_tools(&[Tool::Ffmpeg]) {
        return;
    }
    let dir = tempfile::tempdir().unwrap();
    fs::create_dir_all(dir.path().join("mixed/cat")).unwrap();
    ffmpeg(dir.path(), "-f lavfi -i testsrc2=size=64x48:rate=10:duration=0.3 mixed/%d.png");
    ffmpeg(dir.path(), "-i mixed/%d.png -c:v mpeg4 mixed/clip.mp4");
    fs::copy(dir.path().join("mixed/1.png"), dir.path().join("mixed/cat/1.png")).unwrap();
    let parts = ["3 and 1", "`mixed/clip.mp4`", "'mixed/*.png'"];
    for command in ["simulate", "analyze temporal"] {
        let command: Vec<&str> = command.split(' ').collect();
        let args = [&command[..], &["mixed", "-o", "out"]].concat();
        expect_failure(
            dir.path(),
            2,
            &args,
            &[&parts[..], &["`mixed` holds images and videos"]].concat(),
        );
    }
    let pattern = [&parts[..], &["`mixed/*` holds images and videos"]].concat();
    expect_failure(dir.path(), 2, &["simulate", "mixed/*", "-o", "out"], &pattern);
    let videos = ["`mixed/*.mp4` matches videos", "leave the quotation marks out"];
    expect_failure(dir.path(), 2, &["simulate", "mixed/*.mp4", "-o", "out"], &videos);
    assert_eq!(messages(dir.path(), &["simulate", "mixed/*.png"]), "");
    let set = messages(dir.path(), &["dataset", "mixed"]);
    assert!(
        set.contains("warning: a set consists of images: videos in `mixed`, 1 in all"),
        "{set}"
    );
    fs::remove_file(dir.path().join("mixed/clip.mp4")).unwrap();
    let clip = messages(dir.path(), &["simulate", "mixed"]);
    assert!(
        clip.contains("warning: images and videos in folders below `mixed`, such as `mixed/cat`"),
        "{clip}"
    );
    assert_eq!(messages(dir.path(), &["dataset", "mixed"]), "");
}

#[test]
fn an_animated_png_is_a_clip() {
    if !require_tools(&[Tool::Ffmpeg, Tool::Ffprobe]) {
        return;
    }
    let dir = tempfile::tempdir().unwrap();
    fs::create_dir(dir.path().join("frames")).unwrap();
    ffmpeg(dir.path(), "-f lavfi -i testsrc2=size=64x48:rate=10:duration=0.5 frames/%d.png");
    ffmpeg(dir.path(), "-framerate 10 -i frames/%d.png -f apng moving.png");
    let scores = |input: &str| {
        assert_eq!(messages(dir.path(), &["simulate", input, "--rate", "10"]), "");
        fs::read(dir.path().join("out/score_edge.npy")).unwrap()
    };
    // The clip has all five frames, with the same pixels as the pictures.
    assert_eq!(scores("moving.png"), scores("frames"));
    fs::copy(dir.path().join("moving.png"), dir.path().join("frames/6.png")).unwrap();
    let parts = ["`frames/6.png` holds several frames", "on its own"];
    expect_failure(dir.path(), 2, &["simulate", "frames", "-o", "no"], &parts);
    expect_failure(dir.path(), 2, &["dataset", "frames", "-o", "no"], &parts);
}

#[test]
fn images_without_labels_are_reported() {
    let dir = tempfile::tempdir().unwrap();
    let header = [0, 0, 8, 3, 0, 0, 0, 2, 0, 0, 0, 16, 0, 0, 0, 16];
    let images: Vec<u8> = header.into_iter().chain(vec![9; 512]).collect();
    fs::write(dir.path().join("t10k-images-idx3-ubyte"), images).unwrap();
    for command in ["simulate", "dataset"] {
        let said = messages(dir.path(), &[command, "t10k-images-idx3-ubyte"]);
        for part in
            ["warning: ", "no file of labels beside it (t10k-labels-idx1-ubyte)", "--labels"]
        {
            assert!(said.contains(part), "{said}");
        }
    }
    let labels = "t10k-labels-idx1-ubyte";
    fs::write(dir.path().join(labels), [0, 0, 8, 1, 0, 0, 0, 2, 7, 1]).unwrap();
    assert_eq!(messages(dir.path(), &["dataset", "t10k-images-idx3-ubyte"]), "");
    // Labels for inputs that cannot have labels used to be ignored.
    pgm(&dir.path().join("a.pgm"), (16, 16), |x, _| x.to_le_bytes()[0]);
    for input in ["a.pgm", "scene:street"] {
        let args = ["simulate", input, "--labels", labels, "-o", "no"];
        expect_failure(dir.path(), 2, &args, &["--labels", labels, "IDX"]);
    }
}

/// The commands read a folder of which only a part is used.
#[test]
fn every_command_that_reads_clips_says_what_it_leaves_out() {
    let dir = tempfile::tempdir().unwrap();
    fs::create_dir_all(dir.path().join("clip/more")).unwrap();
    for name in ["clip/0.pgm", "clip/1.pgm", "clip/more/0.pgm"] {
        pgm(&dir.path().join(name), (16, 16), |x, y| (x * y).to_le_bytes()[0]);
    }
    fs::write(dir.path().join("space.toml"), "[vary]\nregion.size = [8]\n").unwrap();
    let warning =
        "foveate: warning: images and videos in folders below `clip`, such as `clip/more`";
    for args in [
        &["simulate", "clip"][..],
        &["analyze", "temporal", "clip"],
        &["explore", "space.toml", "clip", "--no-area"],
    ] {
        let said = messages(dir.path(), args);
        assert!(said.starts_with(warning) && said.lines().count() == 1, "{args:?}: {said}");
    }
    // The warning comes before the search for tools.
    let fit =
        foveate(&["fit", "clip"]).current_dir(dir.path()).env("FOVEATE_YOSYS", "gone").output();
    let said = String::from_utf8(fit.unwrap().stderr).unwrap();
    assert!(said.starts_with(warning) && said.lines().count() == 2, "{said}");
}

/// The inputs are a picture whose rows are pictures themselves, and a photograph of the same shape.
#[test]
fn a_sheet_is_told_from_a_photograph() {
    let dir = tempfile::tempdir().unwrap();
    // Every row is a ramp of 32x32 pixels with another brightness and direction.
    pgm(&dir.path().join("sheet.pgm"), (1024, 40), |x, y| {
        let (column, row) = (x % 32, x / 32);
        ((y * 97) % 150 + if y % 2 == 0 { column + row } else { 62 - column - row }).to_le_bytes()
            [0]
    });
    pgm(&dir.path().join("photo.pgm"), (1024, 40), |x, y| ((x / 5 + y * 2) % 256).to_le_bytes()[0]);
    let warned = messages(dir.path(), &["simulate", "sheet.pgm"]);
    assert!(warned.contains("`sheet.pgm` looks like a CIFAR sheet"), "{warned}");
    assert_eq!(messages(dir.path(), &["simulate", "photo.pgm"]), "");
    let sheet = ["--images", "cifar-sheet"];
    assert_eq!(messages(dir.path(), &[&["simulate", "sheet.pgm"], &sheet[..]].concat()), "");
    let warned = messages(dir.path(), &[&["simulate", "photo.pgm"], &sheet[..]].concat());
    assert!(warned.contains("`photo.pgm` looks like a photograph"), "{warned}");
}

/// This test uses real sheets, if the environment variable FOVEATE_DATA names their folder.
#[test]
fn a_real_sheet_is_recognized() {
    let Some(data) = data_folder() else { return };
    let dir = tempfile::tempdir().unwrap();
    let sheet = data.join("cifar10/cifar10_batch_0.png");
    let sheet = sheet.to_str().unwrap();
    assert!(messages(dir.path(), &["simulate", sheet]).contains("looks like a CIFAR sheet"));
    assert_eq!(
        messages(dir.path(), &["simulate", sheet, "--images", "cifar-sheet", "--frames", "9"]),
        ""
    );
    let photo = data.join("mosquito/aedes");
    let args = ["simulate", photo.to_str().unwrap(), "--frames", "1", "--resize", "64x64"];
    assert_eq!(messages(dir.path(), &args), "");
}

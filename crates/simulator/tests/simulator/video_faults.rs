// SPDX-License-Identifier: MIT OR Apache-2.0
//! A damaged video gives the frames that can be decoded and is reported. A file that is not a video
//! is refused. Without ffmpeg the tests are skipped with a message.

use std::fs;

use crate::support::clips::{all, clip, ffmpeg, frames, opened, tools};
use crate::support::run;
use foveate_media::{FootageError, FrameSelection, InputOptions};
use foveate_simulator::RunOptions;

#[test]
fn a_truncated_video_gives_what_could_be_decoded_and_says_so() {
    if !tools() {
        return;
    }
    let dir = tempfile::tempdir().unwrap();
    for (name, more) in [
        ("a.mp4", &["-pix_fmt", "yuv420p", "-movflags", "+faststart"][..]),
        ("a.mkv", &["-c:v", "mpeg4"]),
        ("a.avi", &["-c:v", "mpeg4"]),
    ] {
        let path = clip(dir.path(), name, more);
        let whole = fs::read(&path).unwrap();
        let cut = dir.path().join(format!("cut-{name}"));
        for tenths in [5, 7, 9] {
            fs::write(&cut, &whole[..whole.len() * tenths / 10]).unwrap();
            let (seen, problem) = all(&cut);
            assert!((10..100).contains(&seen.len()), "{name} {tenths}: {} frames", seen.len());
            let problem = problem.unwrap();
            assert!(!problem.is_empty() && !problem.contains('\n'), "{problem}");
        }
        let output = dir.path().join(format!("out-{name}"));
        let summary = run(&[&cut], &[], &output, &RunOptions::default()).unwrap();
        assert!(!summary.complete && summary.problem.is_some() && summary.frames > 10);
        let written = fs::read_to_string(output.join("summary.json")).unwrap();
        assert!(written.contains("\"complete\": false"));
    }
}

#[test]
fn a_damaged_video_is_not_complete() {
    if !tools() {
        return;
    }
    let dir = tempfile::tempdir().unwrap();
    let path = clip(dir.path(), "a.avi", &["-c:v", "mpeg4"]);
    let mut bytes = fs::read(&path).unwrap();
    let middle = bytes.len() / 2;
    bytes[middle..middle + 2000].fill(0x55);
    fs::write(&path, bytes).unwrap();
    let (seen, problem) = all(&path);
    assert!(seen.len() > 40 && problem.unwrap().starts_with("ffmpeg reports"));
}

/// ffmpeg reports errors for each of these, but none in a frame that is shown.
#[test]
fn intact_frames_are_complete_whatever_else_is_damaged() {
    if !tools() {
        return;
    }
    let dir = tempfile::tempdir().unwrap();
    let at = |name: &str| dir.path().join(name);
    // Cut before a picture whose successors refer to pictures before it, without being encoded
    // anew.
    let source = ["-f", "lavfi", "-i", "testsrc2=size=80x60:rate=25:duration=4"];
    let open = "open-gop=1:keyint=30:scenecut=0:bframes=3:b-pyramid=strict:ref=2:b-adapt=2";
    let h264 = ["-pix_fmt", "yuv420p", "-c:v", "libx264", "-x264-params", open];
    let (whole, cut) = (at("whole.mp4"), at("cut.mp4"));
    let (from, to) = (whole.to_str().unwrap(), cut.to_str().unwrap());
    ffmpeg(&[&source[..], &h264, &[from]].concat());
    ffmpeg(&["-ss", "1.3", "-i", from, "-c", "copy", to]);
    // Images with an APP1 segment of no sense.
    let images = clip(dir.path(), "plain.mjpeg", &["-pix_fmt", "yuvj420p", "-frames:v", "5"]);
    let mut odd = Vec::new();
    for byte in fs::read(&images).unwrap() {
        odd.push(byte);
        if odd.ends_with(b"\xFF\xD8") {
            odd.extend(b"\xFF\xE1\0\x10Exif\0\0XXXXXXXX");
        }
    }
    fs::write(at("odd.mjpeg"), odd).unwrap();
    let (from, to) = (at("odd.mjpeg"), at("odd.avi"));
    ffmpeg(&["-i", from.to_str().unwrap(), "-c", "copy", to.to_str().unwrap()]);
    // Sound of which no packet is valid.
    let spoken = at("spoken.mp4");
    let source = ["-f", "lavfi", "-i", "testsrc=size=80x60:rate=25:duration=2"];
    let sine = ["-f", "lavfi", "-i", "sine=duration=2", "-c:a", "aac", "-pix_fmt", "yuv420p"];
    let noise = ["-bsf:a", "noise=1", spoken.to_str().unwrap()];
    ffmpeg(&[&source[..], &sine, &noise].concat());
    for (path, frames) in [(cut, 67), (at("odd.avi"), 5), (spoken, 50)] {
        let (seen, problem) = all(&path);
        assert_eq!((seen.len(), problem), (frames, None), "{}", path.display());
    }
}

/// Decoders work ahead, so that ffmpeg reports these losses before it shows the first frame.
/// Decoding begins with an IDR picture, so nothing was cut off before it.
#[test]
fn a_loss_soon_after_the_first_frame_is_damage() {
    if !tools() {
        return;
    }
    let dir = tempfile::tempdir().unwrap();
    let whole = dir.path().join("whole.mp4");
    let source = ["-f", "lavfi", "-i", "testsrc2=size=80x60:rate=25:duration=6"];
    let regular = "keyint=25:min-keyint=25:scenecut=0:bframes=3:b-adapt=0:b-pyramid=strict:ref=2";
    let h264 = ["-pix_fmt", "yuv420p", "-c:v", "libx264", "-x264-params", regular];
    ffmpeg(&[&source[..], &h264, &[whole.to_str().unwrap()]].concat());
    let late = FrameSelection { start_us: Some(4_000_000), ..FrameSelection::default() };
    // The P picture between two groups of B pictures stays, and removes one that is not there. The
    // second clip begins without an IDR picture, and its first frame is that of the first second.
    for (name, first, selection, frames_left) in
        [("begin.mp4", 0, FrameSelection::default(), 143), ("late.mp4", 75, late, 25)]
    {
        let lost = [1, 2, 3, 4, 6, 7, 8].map(|packet| first + packet).into_iter();
        let lost = lost.chain((first > 0).then_some(0)).map(|packet| format!("eq(n\\,{packet})"));
        let noise = format!("noise=amount=0:drop={}", lost.collect::<Vec<_>>().join("+"));
        let path = dir.path().join(name);
        let [from, to] = [&whole, &path].map(|path| path.to_str().unwrap());
        ffmpeg(&["-i", from, "-c", "copy", "-copyinkf", "-bsf:v", &noise, to]);
        let options = InputOptions { selection, ..InputOptions::default() };
        let (seen, problem) = frames(&path, 8, &options);
        assert_eq!(seen.len(), frames_left, "{name}");
        let problem = problem.unwrap_or_default();
        assert!(problem.contains("mmco: unref short failure"), "{name}: {problem}");
    }
}

#[test]
fn a_change_of_size_ends_the_clip_unless_frames_are_scaled() {
    if !tools() {
        return;
    }
    let dir = tempfile::tempdir().unwrap();
    let mut joined = Vec::new();
    for size in ["64x48", "80x64"] {
        let part = dir.path().join(format!("{size}.ts"));
        let source = format!("testsrc=size={size}:rate=25:duration=1");
        ffmpeg(&["-f", "lavfi", "-i", &source, "-c:v", "mpeg2video", part.to_str().unwrap()]);
        joined.extend(fs::read(part).unwrap());
    }
    let path = dir.path().join("joined.ts");
    fs::write(&path, joined).unwrap();
    let (seen, problem) = all(&path);
    assert!((20..=25).contains(&seen.len()), "{}", seen.len());
    let problem = problem.unwrap();
    assert!(problem.contains("from 64x48 to 80x64 at"), "{problem}");
    let scaled = InputOptions { resize: Some((32, 24)), ..InputOptions::default() };
    assert!(frames(&path, 8, &scaled).0.len() > 40);
}

#[test]
fn what_holds_no_video_is_refused_in_one_line() {
    if !tools() {
        return;
    }
    let dir = tempfile::tempdir().unwrap();
    let at = |name: &str| dir.path().join(name);
    fs::write(at("text.mp4"), "no video").unwrap();
    fs::write(at("empty.mp4"), "").unwrap();
    fs::write(at("real.gif"), b"GIF89a\x01\x00\x01\x00\x00\x00\x00;").unwrap();
    ffmpeg(&["-f", "lavfi", "-i", "sine=duration=1", at("sound.wav").to_str().unwrap()]);
    let whole = fs::read(clip(dir.path(), "a.mp4", &["-pix_fmt", "yuv420p"])).unwrap();
    // An MP4 cannot be decoded without its index, which comes last.
    fs::write(at("cut.mp4"), &whole[..whole.len() / 2]).unwrap();
    for name in ["text.mp4", "empty.mp4", "real.gif", "sound.wav", "cut.mp4"] {
        let error = opened(&at(name), 8, &InputOptions::default()).err().unwrap();
        let message = error.to_string();
        assert!(
            matches!(error, FootageError::Video { .. } | FootageError::Frameless { .. }),
            "{message}"
        );
        assert!(message.contains(name) && !message.contains('\n'), "{message}");
    }
    let late = FrameSelection { start_us: Some(100_000_000), ..FrameSelection::default() };
    let late = InputOptions { selection: late, ..InputOptions::default() };
    fs::write(at("whole.mp4"), whole).unwrap();
    let error = opened(&at("whole.mp4"), 8, &late).err().unwrap();
    assert!(error.to_string().contains("(as selected) holds no frame"), "{error}");
}

#[test]
fn names_are_files_and_nothing_else() {
    if !tools() {
        return;
    }
    let dir = tempfile::tempdir().unwrap();
    let path = clip(dir.path(), "a.mkv", &["-c:v", "ffv1", "-frames:v", "2"]);
    for name in ["-i.mkv", "concat:x|y.mkv", "100%d.mkv", "a b'c.mkv", "http:x.mkv"] {
        let odd = dir.path().join(name);
        fs::copy(&path, &odd).unwrap();
        assert_eq!(all(&odd).0.len(), 2, "{name}");
    }
}

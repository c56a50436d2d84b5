// SPDX-License-Identifier: MIT OR Apache-2.0
//! The format of a file does not depend on its name: containers are read, lists of other files are
//! refused. Rare pixel formats give frames or an error.

use std::fs;
use std::path::Path;
use std::process::Command;

use crate::clips::{all, ffmpeg, frames, opened, tools};
use foveate_media::InputOptions;
use foveate_tools::testing::sample;

/// Returns the message for an input without frames.
fn refusal(path: &Path) -> String {
    match opened(path, 8, &InputOptions::default()) {
        Ok(_) => panic!("{} is read", path.display()),
        Err(error) => error.to_string(),
    }
}

#[test]
fn a_file_that_leads_to_others_is_refused_by_the_name_of_its_format() {
    if !tools() {
        return;
    }
    let dir = tempfile::tempdir().unwrap();
    let real = dir.path().join("real.mp4");
    let source = ["-f", "lavfi", "-i", "testsrc=size=64x48:rate=10:duration=0.5"];
    ffmpeg(&[&source[..], &["-c:v", "mpeg4", real.to_str().unwrap()]].concat());
    let elsewhere = real.display();
    let dash = "<?xml version=\"1.0\"?><MPD xmlns=\"urn:mpeg:dash:schema:mpd:2011\" \
                profiles=\"urn:mpeg:dash:profile:isoff-on-demand:2011\" type=\"static\" \
                mediaPresentationDuration=\"PT1S\"><Period><AdaptationSet><Representation id=\"1\" bandwidth=\"1\">\
                <BaseURL>real.mp4</BaseURL></Representation></AdaptationSet></Period></MPD>";
    let sdp = "v=0\no=- 0 0 IN IP4 127.0.0.1\ns=x\nc=IN IP4 127.0.0.1\nt=0 0\nm=video 5004 RTP/AVP 96\n\
               a=rtpmap:96 H264/90000\n";
    let hls = |name: &str| {
        format!("#EXTM3U\n#EXT-X-TARGETDURATION:1\n#EXTINF:1,\n{name}\n#EXT-X-ENDLIST\n")
    };
    for (name, text, format) in [
        ("hls.mp4", hls("real.mp4"), "hls"),
        ("hls.mkv", hls(&format!("file://{elsewhere}")), "hls"),
        ("playlist.ts", hls("http://127.0.0.1:9/a.ts"), "hls"),
        ("concat.mp4", "ffconcat version 1.0\nfile real.mp4\n".to_owned(), "concat"),
        ("dash.mp4", dash.to_owned(), "dash"),
        ("camera.avi", sdp.to_owned(), "sdp"),
        // The text has colour codes of a terminal, so it is not plain text.
        ("art.ans", "\u{1b}[31m\u{0}one line\r\n".repeat(200), "tty"),
    ] {
        let path = dir.path().join(name);
        fs::write(&path, text).unwrap();
        let said = refusal(&path);
        assert!(said.contains(&format!("`{format}`")) && said.contains(name), "{said}");
        assert!(!said.contains('\n'), "{said}");
    }
    let notes = dir.path().join("notes.txt");
    fs::write(&notes, "one line of text\n".repeat(200)).unwrap();
    assert!(refusal(&notes).ends_with("it is text"), "{}", refusal(&notes));
    // The file that the others refer to is read by its own name.
    assert_eq!(all(&real).0.len(), 5);
}

#[test]
fn pointers_and_recordings_of_other_tools_are_called_what_they_are() {
    let dir = tempfile::tempdir().unwrap();
    let pointer = b"version https://git-lfs.github.com/spec/v1\noid sha256:aa\nsize 12345\n";
    let files: [(&str, &[u8], &str); 6] = [
        ("a.mp4", pointer, "git lfs pull"),
        ("a.png", pointer, "git lfs pull"),
        ("a.zip", pointer, "git lfs pull"),
        ("a.bag", b"#ROSBAG V2.0\n\x45\0\0\0", "a ROS 1 bag"),
        ("a.h5", b"\x89HDF\r\n\x1a\n\0\0\0\0", "an HDF5 file"),
        ("a.es", b"Event Stream\x02\0\0", "an event stream (`.es`)"),
    ];
    for (name, bytes, part) in files {
        let path = dir.path().join(name);
        fs::write(&path, bytes).unwrap();
        let said = refusal(&path);
        assert!(said.contains(part) && said.contains(name), "{said}");
    }
}

/// Containers that ffmpeg writes, each with a codec.
#[test]
fn every_ordinary_container_is_read() {
    if !tools() {
        return;
    }
    let dir = tempfile::tempdir().unwrap();
    let containers = [
        ("a.mp4", "-c:v mpeg4"),
        ("a.m4v", "-c:v mpeg4"),
        ("a.mov", "-c:v mjpeg -pix_fmt yuvj420p"),
        ("a.3gp", "-c:v h263 -s 176x144"),
        ("a.mkv", "-c:v ffv1"),
        ("a.webm", "-c:v libvpx"),
        ("a.avi", "-c:v mpeg4"),
        ("a.ts", "-c:v mpeg2video"),
        ("a.m2ts", "-c:v mpeg2video"),
        ("a.mpg", "-c:v mpeg2video"),
        ("a.vob", "-c:v mpeg2video -f vob"),
        ("a.flv", "-c:v flv1"),
        ("a.gif", "-c:v gif"),
        ("a.apng", "-f apng -c:v apng -plays 1"),
        ("a.ogv", "-c:v libtheora"),
        ("a.wmv", "-c:v wmv2 -f asf"),
        ("a.mxf", "-c:v mpeg2video"),
        ("a.gxf", "-c:v mpeg2video -s 720x512 -f gxf"),
        ("a.nut", "-c:v ffv1"),
        ("a.ivf", "-c:v libvpx -f ivf"),
        ("a.wtv", "-c:v mpeg2video -f wtv"),
        ("a.rm", "-c:v rv10 -s 176x144 -f rm"),
        ("a.dv", "-c:v dvvideo -s 720x576 -pix_fmt yuv420p -f dv"),
        ("a.swf", "-c:v flv1 -f swf"),
        ("a.y4m", "-f yuv4mpegpipe"),
        ("a.h264", "-c:v libx264 -f h264"),
        ("a.hevc", "-c:v libx265 -x265-params log-level=none -f hevc"),
        ("raw.m4v", "-c:v mpeg4 -f m4v"),
        ("a.mjpeg", "-c:v mjpeg -pix_fmt yuvj420p -f mjpeg"),
        ("a.m2v", "-c:v mpeg2video -f mpeg2video"),
    ];
    for (name, options) in sample(containers, 3) {
        let path = dir.path().join(name);
        let source = ["-v", "error", "-nostdin", "-f", "lavfi", "-i"];
        let made = Command::new("ffmpeg")
            .args(source)
            .args(["testsrc=size=64x48:rate=25:duration=0.2", "-pix_fmt", "yuv420p"])
            .args(options.split_whitespace())
            .arg(&path)
            .output()
            .unwrap();
        if !made.status.success() {
            // Builds of ffmpeg have different encoders.
            eprintln!("skipped: {name}: {}", String::from_utf8_lossy(&made.stderr));
            continue;
        }
        let mut source = opened(&path, 8, &InputOptions::default())
            .unwrap_or_else(|error| panic!("{name}: {error}"));
        assert!(source.next_frame().unwrap().is_some(), "{name}");
    }
}

/// APNG and Matroska can have grey of sixteen bits with high bytes first. The clip is long enough
/// to fill a pipe.
#[test]
fn grey_with_high_bytes_first_is_read_bit_by_bit() {
    if !tools() {
        return;
    }
    let dir = tempfile::tempdir().unwrap();
    let raw = dir.path().join("raw");
    let source = "testsrc=size=640x480:rate=25:duration=0.4";
    for (name, options) in [
        ("a.mkv", &["-c:v", "png", "-pix_fmt", "gray16be"][..]),
        ("a.nut", &["-c:v", "rawvideo", "-pix_fmt", "gray10be"]),
        ("a.png", &["-f", "apng", "-c:v", "apng", "-pix_fmt", "gray16be", "-plays", "1"]),
    ] {
        let path = dir.path().join(name);
        let (shown, raw) = (path.to_str().unwrap(), raw.to_str().unwrap());
        ffmpeg(&[&["-f", "lavfi", "-i", source], options, &[shown]].concat());
        let (depth, native) = if name == "a.nut" { (10, "gray10le") } else { (16, "gray16le") };
        ffmpeg(&["-i", shown, "-pix_fmt", native, "-f", "rawvideo", raw]);
        let bytes = fs::read(raw).unwrap();
        let (seen, problem) = frames(&path, depth, &InputOptions::default());
        assert_eq!((seen.len(), problem), (10, None), "{name}");
        for (frame, expected) in seen.iter().zip(bytes.chunks(2 * 640 * 480)) {
            let words = expected.chunks(2).map(|pair| u16::from_le_bytes([pair[0], pair[1]]));
            assert!(frame.frame.borrowed_pixels().to_words().into_iter().eq(words), "{name}");
        }
    }
}

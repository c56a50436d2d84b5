// SPDX-License-Identifier: MIT OR Apache-2.0
//! Tests of codecs: their bytes are those of the stream, their quality is the one that ffmpeg
//! prints, and the same frames give the same bytes.

use std::fs;
use std::path::Path;
use std::process::Command;

use foveate_explore::link::{ClipEncoder, Codec, EncoderPreset, GreyFootage, check_encoders};
use foveate_media::{RunMonitor, SilentHooks, testing::RecordingHooks};
use foveate_pixels::{Scene, SceneParameters};
use foveate_tools::{
    ProgramOutput, Tool, Toolchain,
    testing::{MockHost, require_tools},
};

const FRAMES: u32 = 5;

fn footage(folder: &Path, (width, height): (u32, u32)) -> GreyFootage {
    let size = SceneParameters { width, height, bits: 8, region_size: 8, frames: FRAMES };
    let frames = Scene::Street.frames(size);
    let bytes = frames.flat_map(|frame| {
        frame.pixels().iter().map(|&pixel| u8::try_from(pixel).unwrap()).collect::<Vec<_>>()
    });
    let path = folder.join("clip.gray");
    fs::write(&path, bytes.collect::<Vec<u8>>()).unwrap();
    GreyFootage { clip: "street".to_owned(), path, width, height, frames: FRAMES.into() }
}

/// Returns the PSNR of a stream as ffmpeg's own filter prints it.
fn psnr(footage: &GreyFootage, stream: &Path) -> String {
    let size = format!("{}x{}", footage.width, footage.height);
    let output = Command::new("ffmpeg")
        .args(["-hide_banner", "-nostdin", "-r", "30", "-i"])
        .arg(stream)
        .args(["-f", "rawvideo", "-pixel_format", "gray", "-video_size", &size, "-r", "30", "-i"])
        .arg(&footage.path)
        .args(["-lavfi", "[0]extractplanes=y[a];[a][1]psnr", "-f", "null", "-"])
        .output()
        .unwrap();
    let said = String::from_utf8(output.stderr).unwrap();
    let found = said.rsplit("average:").next().unwrap();
    found.split_whitespace().next().unwrap().to_owned()
}

#[test]
fn bytes_are_those_of_the_stream_and_pictures_as_good_as_ffmpeg_says() {
    if !require_tools(&[Tool::Ffmpeg, Tool::Ffprobe]) {
        return;
    }
    let tools = Toolchain::system();
    check_encoders(&tools, &Codec::ALL).unwrap();
    for size in [(160, 120), (75, 50)] {
        let folder = tempfile::tempdir().unwrap();
        let footage = footage(folder.path(), size);
        for codec in Codec::ALL {
            let monitor = RunMonitor::of_frames(&SilentHooks, None);
            let mut encoder =
                ClipEncoder::new(&tools, &footage, (codec, EncoderPreset::Veryfast), &monitor);
            let encoded = encoder.encode_with(20).unwrap().clone();
            let stream = fs::read(encoder.stream_path()).unwrap();
            let context = format!("{} {size:?}", codec.name());
            assert_eq!(encoded.packets.iter().sum::<u64>(), stream.len() as u64, "{context}");
            assert_eq!(encoded.packets.len() as u64, footage.frames, "{context}");
            let own = format!("{:.2}", encoded.quality.psnr.unwrap());
            let theirs: f64 = psnr(&footage, encoder.stream_path()).parse().unwrap();
            assert_eq!(own, format!("{theirs:.2}"), "{context}");
            if size.0 < 160 {
                continue;
            }
            // The clip is encoded again, and then with a coarser quantizer.
            let mut again =
                ClipEncoder::new(&tools, &footage, (codec, EncoderPreset::Veryfast), &monitor);
            assert_eq!(again.encode_with(20).unwrap(), &encoded, "{context}");
            assert_eq!(fs::read(again.stream_path()).unwrap(), stream, "{context}");
            let coarse = again.encode_with(30).unwrap();
            assert!(coarse.quality.psnr < encoded.quality.psnr, "{context}");
            assert!(coarse.packets.iter().sum::<u64>() < stream.len() as u64, "{context}");
            let intra = matches!(codec, Codec::Mjpeg | Codec::H264Intra | Codec::H265Intra);
            let smaller = encoded.packets[1..].iter().all(|&bytes| 2 * bytes < encoded.packets[0]);
            assert_eq!(smaller, !intra, "{context}: {:?}", encoded.packets);
        }
    }
}

#[test]
fn the_finest_h264_is_lossless() {
    if !require_tools(&[Tool::Ffmpeg, Tool::Ffprobe]) {
        return;
    }
    let folder = tempfile::tempdir().unwrap();
    let (tools, footage) = (Toolchain::system(), footage(folder.path(), (64, 48)));
    let monitor = RunMonitor::of_frames(&SilentHooks, None);
    let mut encoder =
        ClipEncoder::new(&tools, &footage, (Codec::H264, EncoderPreset::Veryfast), &monitor);
    assert_eq!(encoder.encode_with(0).unwrap().quality.psnr, None);
    assert_eq!(encoder.encoded_clips().len(), 1);
}

#[test]
fn an_interrupt_is_heard_and_a_missing_encoder_is_named() {
    if require_tools(&[Tool::Ffmpeg, Tool::Ffprobe]) {
        let folder = tempfile::tempdir().unwrap();
        let (tools, footage) = (Toolchain::system(), footage(folder.path(), (64, 48)));
        let hooks = RecordingHooks::cancelling_after(0);
        let stop = RunMonitor::of_frames(&hooks, None);
        let mut encoder =
            ClipEncoder::new(&tools, &footage, (Codec::Mjpeg, EncoderPreset::Veryfast), &stop);
        let error = encoder.encode_with(9).unwrap_err().to_string();
        assert_eq!(error, "interrupted; nothing was written");
    }
    let host = MockHost::new().tool(
        "/opt/bin/ffmpeg",
        "ffmpeg version 5.1
",
    );
    let host = host.on_run(|_| Ok(ProgramOutput::success(" V....D libx264    H.264\n")));
    let tools = Toolchain::with_host(host);
    check_encoders(&tools, &[Codec::H264, Codec::H264Intra]).unwrap();
    let error = check_encoders(&tools, &[Codec::H264, Codec::H265]).unwrap_err().to_string();
    assert!(error.contains("no encoder `libx265`") && error.contains("`h265`"), "{error}");
}

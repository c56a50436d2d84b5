// SPDX-License-Identifier: MIT OR Apache-2.0
//! PSNR and SSIM against ffmpeg's own filters, frame by frame and over a clip, to the printed
//! digits.

use std::fs;
use std::path::Path;
use std::process::Command;

use foveate_camera::Camera;
use foveate_measure::{Fidelity, FidelityError, FidelityFigures, FrameOrder, FrameSimilarity};
use foveate_pixels::{ByteFrame, FramePixels, Scene, SceneParameters};
use foveate_tools::{Tool, testing::require_tools};

use crate::results::{blank_ideal, blank_outcome, config, greys, shown_as_denoised};

const FRAMES: u32 = 6;

fn scene(scene: Scene, camera: &Camera) -> Vec<ByteFrame> {
    let (width, height, bits) = (camera.width(), camera.height(), camera.pixel_bits());
    let size = SceneParameters { width, height, bits, region_size: 8, frames: FRAMES };
    scene.frames(size).map(|frame| ByteFrame::from(&frame)).collect()
}

/// Writes pixels in ffmpeg's format `gray` or `gray10le`.
fn write(path: &Path, frames: &[ByteFrame]) {
    let bytes: Vec<u8> = frames
        .iter()
        .flat_map(|frame| match frame.borrowed_pixels() {
            FramePixels::Bytes(pixels) => pixels.to_vec(),
            FramePixels::Words(pixels) => {
                pixels.iter().flat_map(|pixel| pixel.to_le_bytes()).collect()
            }
        })
        .collect();
    fs::write(path, bytes).unwrap();
}

/// Returns the lines of statistics of a filter, and ffmpeg's final messages.
fn filtered(folder: &Path, filter: &str, camera: &Camera) -> (Vec<String>, String) {
    let size = format!("{}x{}", camera.width(), camera.height());
    let format = match camera.pixel_bits() {
        8 => "gray".to_owned(),
        bits => format!("gray{bits}le"),
    };
    let input = |name: &str| {
        ["-f", "rawvideo", "-pix_fmt", &format, "-s", &size, "-i", name].map(str::to_owned)
    };
    let output = Command::new("ffmpeg")
        .current_dir(folder)
        // The filter's assembler code for x86 computes a wrong SSIM if width / 4 is 2 more than a
        // multiple of 4 (1.000000 for any two frames that are 8 wide); its C code does not.
        .args(["-hide_banner", "-nostdin", "-cpuflags", "0"])
        .args(input("screen"))
        .args(input("other"))
        .args(["-lavfi", &format!("{filter}=stats_file=stats"), "-f", "null", "-"])
        .output()
        .unwrap();
    let messages = String::from_utf8(output.stderr).unwrap();
    assert!(output.status.success(), "{messages}");
    let stats = fs::read_to_string(folder.join("stats")).unwrap();
    (stats.lines().map(str::to_owned).collect(), messages)
}

/// Returns the value after the last `key` of a text.
fn value(text: &str, key: &str) -> String {
    let found = text.rsplit(key).next().unwrap();
    found.split_whitespace().next().unwrap().to_owned()
}

/// Formats a PSNR like ffmpeg.
fn printed(psnr: Option<f64>, digits: usize) -> String {
    psnr.map_or("inf".to_owned(), |psnr| format!("{psnr:.digits$}"))
}

/// Compares the six digits that ffmpeg prints, to which its single precision is right.
fn assert_ssim(ssim: f64, printed: &str, context: &str) {
    assert_eq!(format!("{ssim:.6}"), printed, "{ssim}, {context}");
}

/// Returns the PSNR and SSIM without cameras.
fn likeness(camera: &Camera, input: &[ByteFrame], shown: &[ByteFrame]) -> (Option<f64>, f64) {
    let mut likeness = FrameSimilarity::new(camera.width(), camera.height());
    for (input, shown) in input.iter().zip(shown) {
        let (FramePixels::Bytes(input), FramePixels::Bytes(shown)) =
            (input.borrowed_pixels(), shown.borrowed_pixels())
        else {
            unreachable!("8 bits are bytes");
        };
        likeness.add(shown, input).unwrap();
        let short = likeness.add(&shown[1..], input);
        assert!(matches!(short, Err(FidelityError::ResultLength { .. })));
    }
    assert_eq!(likeness.frames(), input.len() as u64);
    (likeness.psnr(), likeness.ssim())
}

fn compare(camera: &Camera, input: &[ByteFrame], ideal: &[ByteFrame], shown: &[ByteFrame]) {
    let mut whole = Fidelity::new(camera, camera).unwrap();
    let mut frame_figures: Vec<FidelityFigures> = Vec::new();
    for ((input, ideal), shown) in input.iter().zip(ideal).zip(shown) {
        let mut outcome = blank_ideal(camera);
        outcome.rendered = greys(&ideal.borrowed_pixels().to_words());
        let mut single_frame = Fidelity::new(camera, camera).unwrap();
        for fidelity in [&mut whole, &mut single_frame] {
            let (blank, mut denoised) = (blank_outcome(camera), Vec::new());
            let candidate = shown_as_denoised(&blank, shown.borrowed_pixels(), &mut denoised);
            fidelity.add(input, &outcome, candidate, FrameOrder::Later).unwrap();
        }
        frame_figures.push(single_frame.tally().figures());
    }
    let all = whole.tally().figures();
    if camera.pixel_bits() == 8 {
        assert_eq!(likeness(camera, input, shown), (all.psnr_input, all.ssim_input));
    }
    let folder = tempfile::tempdir().unwrap();
    write(&folder.path().join("screen"), shown);
    for (name, other) in [("ideal", ideal), ("input", input)] {
        write(&folder.path().join("other"), other);
        let psnr_and_ssim = |figures: &FidelityFigures| match name {
            "ideal" => (figures.psnr_ideal, figures.ssim_ideal),
            _ => (figures.psnr_input, figures.ssim_input),
        };
        let context = format!("{}x{} {name}", camera.width(), camera.height());
        let (stats, messages) = filtered(folder.path(), "psnr", camera);
        assert_eq!(stats.len(), frame_figures.len());
        for (figures, line) in frame_figures.iter().zip(&stats) {
            assert_eq!(
                printed(psnr_and_ssim(figures).0, 2),
                value(line, "psnr_y:"),
                "{line} {context}"
            );
        }
        assert_eq!(printed(psnr_and_ssim(&all).0, 6), value(&messages, "average:"), "{context}");
        let (stats, messages) = filtered(folder.path(), "ssim", camera);
        for (figures, line) in frame_figures.iter().zip(&stats) {
            assert_ssim(psnr_and_ssim(figures).1, &value(line, "Y:"), &format!("{line} {context}"));
        }
        assert_ssim(psnr_and_ssim(&all).1, &value(&messages, "SSIM Y:"), &context);
    }
}

#[test]
fn figures_are_those_of_ffmpeg() {
    if !require_tools(&[Tool::Ffmpeg]) {
        return;
    }
    for (size, bits) in
        [((96, 64), 8), ((37, 29), 8), ((8, 8), 8), ((200, 9), 8), ((70, 50), 10), ((68, 44), 12)]
    {
        let camera = config(size, 8, bits).validate().unwrap();
        let street = scene(Scene::Street, &camera);
        let night = scene(Scene::NightRain, &camera);
        let random = scene(Scene::Random, &camera);
        // The first frames of two clips are equal, so that there is an identical frame.
        let mut mixed = scene(Scene::Shake, &camera);
        mixed[0] = street[0].clone();
        compare(&camera, &night, &mixed, &street);
        compare(&camera, &street, &random, &mixed);
    }
}

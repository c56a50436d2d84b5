// SPDX-License-Identifier: MIT OR Apache-2.0
//! Measures the throughput of the engine on a clip in memory. Prints one JSON object per line.
//!
//! ```text
//! throughput CLIP.npy --side N --features edge,corner,mad [--neighborhood shared] [--threads 1]
//!     [--batch 1] [--screens] [--no-skip] [--level avx2] [--seconds 1] [--reference last-sent]
//!     [--blocks 2] [--filter median3x3]
//! ```
//!
//! With `--blocks`, irrelevant regions send means of that many blocks per side. Frames are given
//! `--batch` at a time, and with `--screens` the rendered frame of each is kept.
//! `throughput --copy` measures the copy bandwidth of the machine. `mpixel_s` is in megapixels per
//! second over the faster half of the frames, as `cv_pipeline.py` reports it. `mpixel_s_mean` is
//! over all frames of the clip, each with its fastest time.

use std::sync::Barrier;
use std::time::{Duration, Instant};

use foveate_camera::{
    CameraConfig, Decimal, DenoiseFilter, FeatureKind, IrrelevantRendering, Neighborhood,
    ReferencePolicy, SpatialConfig,
};
use foveate_engine::{BatchScreens, Engine, EngineOptions, FrameOutcome, InstructionSet};

type BoxError = Box<dyn std::error::Error>;

fn main() -> Result<(), BoxError> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    if arguments.iter().any(|argument| argument == "--copy") {
        print(&copy_bandwidth());
        return Ok(());
    }
    let value = |name: &str| {
        let at = arguments.iter().position(|argument| argument == name)?;
        arguments.get(at + 1).map(String::as_str)
    };
    let path = arguments.first().ok_or("name a clip: an .npy of bytes, frames x height x width")?;
    let clip = ByteClip::read(path)?;
    let mut config = CameraConfig::default();
    (config.frame.width, config.frame.height) = (Some(clip.width), Some(clip.height));
    config.region.size = value("--side").unwrap_or("8").parse()?;
    config.region.neighborhood = match value("--neighborhood") {
        Some("isolated") => Neighborhood::Isolated,
        _ => Neighborhood::Shared,
    };
    if value("--reference") == Some("last-sent") {
        config.temporal.reference = ReferencePolicy::LastSent;
    }
    if let Some(blocks) = value("--blocks") {
        config.render.irrelevant = IrrelevantRendering::Mean;
        config.periphery.blocks = Some(blocks.parse()?);
    }
    if let Some(name) = value("--filter") {
        let filter = DenoiseFilter::ALL.iter().find(|filter| filter.name() == name);
        config.denoise.filter = *filter.ok_or("no such filter")?;
    }
    let features = value("--features").unwrap_or("edge");
    config.spatial = features.split(',').map(feature).collect::<Result<_, _>>()?;
    let level_name = value("--level").unwrap_or_else(|| InstructionSet::detect().name());
    let options = EngineOptions {
        threads: value("--threads").unwrap_or("1").parse()?,
        skips_identical_regions: !arguments.iter().any(|argument| argument == "--no-skip"),
        level: *InstructionSet::available()
            .iter()
            .find(|level| level.name() == level_name)
            .ok_or("this processor has no such instructions")?,
    };
    let seconds: f64 = value("--seconds").unwrap_or("1").parse()?;
    let mut engine = Engine::with_options(&config.validate()?, options)?;
    let delivery = FrameDelivery {
        batch: value("--batch").unwrap_or("1").parse::<usize>()?.max(1),
        screens: arguments.iter().any(|argument| argument == "--screens"),
    };
    let measured = measure(&clip, &mut engine, &delivery, Duration::from_secs_f64(seconds))?;
    let (width, height) = (clip.width, clip.height);
    print(&serde_json::json!({
        "clip": path, "width": width, "height": height, "side": config.region.size,
        "neighborhood": config.region.neighborhood.name(), "features": features,
        "filter": config.denoise.filter.name(),
        "reference": config.temporal.reference.name(), "threads": options.threads,
        "batch": delivery.batch, "screens": delivery.screens, "level": options.level.name(), "skip": options.skips_identical_regions,
        "mpixel_s": measured.mpixel_s, "mpixel_s_mean": measured.mpixel_s_mean,
        "skipped": measured.skipped, "active": measured.active,
    }));
    Ok(())
}

#[allow(clippy::print_stdout, reason = "the purpose of the program")]
fn print(line: &serde_json::Value) {
    println!("{line}");
}

/// Returns a feature with the thresholds of the OpenCV pipeline.
fn feature(name: &str) -> Result<SpatialConfig, BoxError> {
    let kind = *FeatureKind::ALL.iter().find(|kind| kind.name() == name).ok_or("no feature")?;
    let mut feature = SpatialConfig::new(kind);
    if kind == FeatureKind::Corner {
        feature.min_score = Some(Decimal::from_whole(1));
    }
    if kind == FeatureKind::Mad {
        feature.min_score = Some(Decimal::from_whole(1));
    }
    Ok(feature)
}

struct ThroughputResult {
    /// Megapixels per second over the faster half of the frames.
    mpixel_s: f64,
    /// Megapixels per second over all frames of the clip, each with its fastest time.
    mpixel_s_mean: f64,
    skipped: f64,
    active: f64,
}

/// The way in which frames are given to the engine.
struct FrameDelivery {
    /// The number of frames per call.
    batch: usize,
    /// Keeps the rendered frame of every frame.
    screens: bool,
}

/// Times every batch of frames in rounds over the clip. The engine is reset before each round, so
/// that frames follow each other only as they do in the clip.
fn measure(
    clip: &ByteClip,
    engine: &mut Engine,
    delivery: &FrameDelivery,
    time: Duration,
) -> Result<ThroughputResult, BoxError> {
    let width = usize::try_from(clip.width)?;
    let size = width * usize::try_from(clip.height)?;
    let (mut times, mut skipped, mut active, mut frame_count) = (Vec::new(), 0, 0, 0);
    let start = Instant::now();
    let frames: Vec<&[u8]> = clip.pixels.chunks_exact(size).collect();
    let mut screens = BatchScreens::new();
    let batches: Vec<&[&[u8]]> = frames.chunks(delivery.batch).collect();
    for (number, batch) in batches.iter().enumerate().cycle() {
        if number == 0 {
            engine.reset();
        }
        let screens = delivery.screens.then_some(&mut screens);
        let step_start = Instant::now();
        let outcomes = step_frames(engine, batch, width, screens)?;
        times.push(step_start.elapsed().as_secs_f64() / count_as_f64(batch.len()));
        skipped += outcomes.iter().map(|outcome| outcome.skipped).sum::<usize>();
        active += outcomes.iter().flat_map(|outcome| &outcome.active).filter(|on| **on).count();
        frame_count += batch.len();
        if start.elapsed() > time && times.len() >= 5 {
            break;
        }
    }
    let regions = count_as_f64(frame_count * engine.outcome().srs.len());
    // The fastest time of each batch leaves out the time that other programs take, and keeps the
    // differences between frames.
    let times_of = |number: usize| times.iter().skip(number).step_by(batches.len()).copied();
    let measured = batches.iter().take(times.len()).enumerate();
    let frame_times = measured.map(|(number, batch)| {
        count_as_f64(batch.len()) * times_of(number).fold(f64::MAX, f64::min)
    });
    let measured = batches.iter().take(times.len()).map(|batch| batch.len()).sum();
    let mean_of_all = frame_times.sum::<f64>() / count_as_f64(measured);
    times.sort_by(f64::total_cmp);
    times.truncate(times.len().div_ceil(2));
    let mean = times.iter().sum::<f64>() / count_as_f64(times.len());
    let pixels = count_as_f64(size);
    Ok(ThroughputResult {
        mpixel_s: (pixels / mean / 1e6).round(),
        mpixel_s_mean: (pixels / mean_of_all / 1e6).round(),
        skipped: count_as_f64(skipped) / regions,
        active: count_as_f64(active) / regions,
    })
}

/// Takes some frames. A single frame takes the path for single frames, without a buffer for its
/// screen.
fn step_frames<'e>(
    engine: &'e mut Engine,
    batch: &[&[u8]],
    width: usize,
    screens: Option<&mut BatchScreens<u8>>,
) -> Result<&'e [FrameOutcome], BoxError> {
    Ok(match batch {
        [frame] => std::slice::from_ref(engine.step_u8(frame, width)?),
        _ => engine.step_batch_u8(batch, width, screens)?,
    })
}

#[allow(clippy::cast_precision_loss, reason = "a count of frames or regions")]
fn count_as_f64(count: usize) -> f64 {
    count as f64
}

/// Measures the gigabytes per second that one thread copies, and that two threads copy together.
/// Bytes read and bytes written both count.
fn copy_bandwidth() -> serde_json::Value {
    let measure = |bytes: usize, rounds: usize| {
        [1, 2].map(|threads| {
            let barrier = Barrier::new(threads);
            std::thread::scope(|scope| {
                let copy = || copy_rate(bytes, rounds, &barrier);
                let copies: Vec<_> = (0..threads).map(|_| scope.spawn(copy)).collect();
                copies.into_iter().filter_map(|copy| copy.join().ok()).sum::<f64>()
            })
        })
    };
    serde_json::json!({
        "copy_memory_gb_s": measure(256 << 20, 7),
        "copy_frame_gb_s": measure(1920 * 1080, 2001),
        "copy_small_gb_s": measure(224 * 224, 20001),
    })
}

/// Returns the gigabytes per second of one thread, over the faster half of the rounds.
fn copy_rate(bytes: usize, rounds: usize, barrier: &Barrier) -> f64 {
    let (from, mut to) = (vec![1u8; bytes], vec![0u8; bytes]);
    barrier.wait();
    let mut times: Vec<f64> = (0..rounds)
        .map(|_| {
            let round_start = Instant::now();
            to.copy_from_slice(std::hint::black_box(&from));
            std::hint::black_box(&mut to);
            round_start.elapsed().as_secs_f64()
        })
        .collect();
    times.sort_by(f64::total_cmp);
    let half = &times[..rounds.div_ceil(2)];
    2.0 * count_as_f64(bytes) * count_as_f64(half.len()) / half.iter().sum::<f64>() / 1e9
}

/// A clip of frames of bytes, one after the other.
struct ByteClip {
    width: u32,
    height: u32,
    pixels: Vec<u8>,
}

impl ByteClip {
    /// Reads an `.npy` file of shape (frames, height, width) and type u8.
    fn read(path: &str) -> Result<Self, BoxError> {
        let bytes = std::fs::read(path).map_err(|error| format!("{path}: {error}"))?;
        let header = bytes.get(8..10).ok_or("no .npy file")?;
        let header = usize::from(u16::from_le_bytes([header[0], header[1]]));
        let text = std::str::from_utf8(bytes.get(10..10 + header).ok_or("no .npy file")?)?;
        if !text.contains("|u1") || text.contains("'fortran_order': True") {
            return Err(format!("{path}: not bytes in C order: {text}").into());
        }
        let shape = text.split(['(', ')']).nth(1).ok_or("no shape")?;
        let shape: Vec<u32> =
            shape.split(',').map(|side| side.trim().parse()).collect::<Result<_, _>>()?;
        let &[_, height, width] = &shape[..] else {
            return Err("the shape is not (frames, height, width)".into());
        };
        Ok(Self { width, height, pixels: bytes[10 + header..].to_vec() })
    }
}

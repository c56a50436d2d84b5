// SPDX-License-Identifier: MIT OR Apache-2.0
//! A clip that goes through a codec and back: the bytes of every frame, as ffprobe finds them in
//! the stream, and the quality of the decoded frames.

use std::collections::BTreeMap;
use std::fs::File;
use std::io::{BufReader, Read};
use std::path::{Path, PathBuf};

use foveate_measure::FrameSimilarity;
use foveate_media::RunMonitor;
use foveate_tools::{Invocation, ProgramReader, Tool, ToolError, Toolchain};

use crate::link::error::scratch_error;
use crate::link::{Codec, EncoderPreset, GreyFootage, LinkError, Quality};

/// The frame rate that the encoders are given. With a constant quantizer it does not change any
/// frame.
const FRAME_RATE: &str = "30";

/// A clip after encoding and decoding.
#[derive(Clone, Debug, PartialEq)]
pub struct EncodedClip {
    /// The bytes of every frame.
    pub packets: Vec<u64>,
    /// The quality of the decoded frames.
    pub quality: Quality,
}

/// An encoder of one clip with one codec. It encodes each quantizer once.
pub struct ClipEncoder<'a> {
    tools: &'a Toolchain,
    footage: &'a GreyFootage,
    codec: Codec,
    effort: EncoderPreset,
    /// The path of the stream, next to the footage.
    stream: PathBuf,
    known: BTreeMap<u32, EncodedClip>,
    /// The monitor of the run, which counts every decoded frame.
    monitor: &'a RunMonitor<'a>,
}

impl<'a> ClipEncoder<'a> {
    /// Creates an encoder that has encoded nothing. `monitor` counts every decoded frame.
    #[must_use]
    pub fn new(
        tools: &'a Toolchain,
        footage: &'a GreyFootage,
        (codec, effort): (Codec, EncoderPreset),
        monitor: &'a RunMonitor<'a>,
    ) -> Self {
        let stream = footage.path.with_extension(codec.format());
        Self { tools, footage, codec, effort, stream, known: BTreeMap::new(), monitor }
    }

    /// Returns the clip after encoding with this quantizer.
    ///
    /// # Errors
    /// Fails if ffmpeg fails or loses frames, or if the run is to stop.
    pub fn encode_with(&mut self, quantizer: u32) -> Result<&EncodedClip, LinkError> {
        if !self.known.contains_key(&quantizer) {
            let encoded = self.encode(quantizer)?;
            self.known.insert(quantizer, encoded);
        }
        Ok(&self.known[&quantizer])
    }

    /// Returns the results so far, by quantizer.
    #[must_use]
    pub fn encoded_clips(&self) -> &BTreeMap<u32, EncodedClip> {
        &self.known
    }

    /// Returns the path of the stream of the last quantizer.
    #[must_use]
    pub fn stream_path(&self) -> &Path {
        &self.stream
    }

    fn encode(&self, quantizer: u32) -> Result<EncodedClip, LinkError> {
        self.monitor.check()?;
        let size = format!("{}x{}", self.footage.width, self.footage.height);
        let encode = self
            .tools
            .invocation(Tool::Ffmpeg)?
            .args(["-hide_banner", "-nostdin", "-loglevel", "error", "-y"])
            .args(["-f", "rawvideo", "-pixel_format", "gray", "-video_size", &size])
            .args(["-framerate", FRAME_RATE, "-i"])
            .arg(&self.footage.path)
            .args(self.codec.options(quantizer, self.effort))
            .args(["-f", self.codec.format()])
            .arg(&self.stream);
        self.tools.run_checked(&encode).map_err(|error| self.encoder_error(error))?;
        Ok(EncodedClip {
            packets: self.packet_sizes(quantizer)?,
            quality: self.decoded_quality(quantizer)?,
        })
    }

    /// Converts an error of ffmpeg to an error in one line, if the encoder printed a reason.
    fn encoder_error(&self, error: ToolError) -> LinkError {
        let (encoder, codec) = (self.codec.encoder(), self.codec.name());
        let ToolError::Failed { full, .. } = &error else { return error.into() };
        let own = |line: &str| {
            let (speaker, said) = line.split_once("] ")?;
            speaker
                .strip_prefix('[')?
                .starts_with(encoder)
                .then(|| said.trim_end_matches('.').to_owned())
        };
        let Some(said) = full.lines().find_map(own) else { return error.into() };
        let GreyFootage { clip, width, height, .. } = self.footage;
        LinkError::EncoderRefused {
            encoder,
            codec,
            clip: clip.clone(),
            width: *width,
            height: *height,
            message: said,
        }
    }

    /// Returns the bytes of every frame.
    fn packet_sizes(&self, quantizer: u32) -> Result<Vec<u64>, LinkError> {
        let ask = self
            .tools
            .invocation(Tool::Ffprobe)?
            .args(["-v", "error", "-show_entries", "packet=size", "-of", "csv=p=0"])
            .args(["-f", self.codec.format()])
            .arg(&self.stream);
        let text = self.tools.run_checked(&ask)?.stdout;
        let text = String::from_utf8_lossy(&text);
        let sizes = text.lines().map(|line| line.trim_end_matches(',').parse());
        let sizes: Result<Vec<u64>, _> = sizes.collect();
        let sizes =
            sizes.map_err(|error| self.lost_frames_error(quantizer, 0, error.to_string()))?;
        self.check_frame_count(quantizer, sizes.len() as u64, "of ffprobe's packets")?;
        Ok(sizes)
    }

    /// Returns the quality of the decoded frames.
    fn decoded_quality(&self, quantizer: u32) -> Result<Quality, LinkError> {
        let mut decoder = ProgramReader::start(&self.decoder_command()?, &self.tools.interrupt())?;
        let path = &self.footage.path;
        let original = File::open(path).map_err(scratch_error("read", path))?;
        let mut original = BufReader::new(original);
        let (width, height) = (self.footage.width, self.footage.height);
        let mut likeness = FrameSimilarity::new(width, height);
        let mut pixels = [0, 1].map(|_| vec![0; width as usize * height as usize]);
        let [seen, expected] = &mut pixels;
        while decoder.read_exact(seen).is_ok() && likeness.frames() < self.footage.frames {
            self.monitor.add_frame();
            self.monitor.check()?;
            original.read_exact(expected).map_err(scratch_error("read", path))?;
            likeness.add(seen, expected)?;
        }
        let said = decoder.next_line()?.unwrap_or_else(|| "ffmpeg said nothing".to_owned());
        self.check_frame_count(quantizer, likeness.frames(), &said)?;
        Ok(Quality::from_likeness(&likeness))
    }

    fn decoder_command(&self) -> Result<Invocation, LinkError> {
        let ffmpeg = self.tools.find(Tool::Ffmpeg)?;
        // The option had another name before ffmpeg 5.1. Builds between releases have no version.
        let renamed = ffmpeg.version.as_ref().is_none_or(|version| version.is_at_least(5, 1));
        Ok(Invocation::new(ffmpeg.path)
            .args(["-hide_banner", "-nostdin", "-loglevel", "error"])
            .args(["-f", self.codec.format(), "-i"])
            .arg(&self.stream)
            .args(["-vf", "extractplanes=y"])
            .args([if renamed { "-fps_mode" } else { "-vsync" }, "passthrough"])
            .args(["-f", "rawvideo", "pipe:1"]))
    }

    fn check_frame_count(&self, quantizer: u32, found: u64, said: &str) -> Result<(), LinkError> {
        match found == self.footage.frames {
            true => Ok(()),
            false => Err(self.lost_frames_error(quantizer, found, said.to_owned())),
        }
    }

    fn lost_frames_error(&self, quantizer: u32, found: u64, said: String) -> LinkError {
        let (clip, expected) = (self.footage.clip.clone(), self.footage.frames);
        LinkError::LostFrames {
            codec: self.codec.name(),
            quantizer,
            clip,
            found,
            expected,
            message: said,
        }
    }
}

/// Checks that ffmpeg has the encoders of all codecs.
///
/// # Errors
/// Fails if ffmpeg is missing or lacks an encoder.
pub fn check_encoders(tools: &Toolchain, codecs: &[Codec]) -> Result<(), LinkError> {
    let ask = tools.invocation(Tool::Ffmpeg)?.args(["-hide_banner", "-encoders"]);
    let listed = tools.run_checked(&ask)?.stdout;
    let listed = String::from_utf8_lossy(&listed);
    let names: Vec<_> = listed.lines().map(|line| line.split_whitespace().nth(1)).collect();
    match codecs.iter().find(|codec| !names.contains(&Some(codec.encoder()))) {
        None => Ok(()),
        Some(codec) => Err(LinkError::NoEncoder { encoder: codec.encoder(), codec: codec.name() }),
    }
}

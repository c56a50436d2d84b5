// SPDX-License-Identifier: MIT OR Apache-2.0
//! Vectors on disk: the inputs, and the outputs that the model expects, clock by clock.
//!
//! Both are files of packed records (see [`RecordLayout`]) in a folder of their own. So the length
//! of a run is limited by the disk and not by memory, and the simulator reads the inputs directly.

use super::codec::VectorPacker;
use crate::error::CosimError;
use crate::layout::RecordLayout;
use crate::situations::{Occurrences, SituationMonitor};
use foveate_design::{Design, Port};
use foveate_emit::Top;
use foveate_tools::ScratchFolder;
use std::fs::File;
use std::io::{BufReader, BufWriter, Read, Seek, SeekFrom, Write};
use std::ops::Range;
use std::path::{Path, PathBuf};
use std::sync::{Mutex, PoisonError};

/// The sequence and frame of a stretch of clocks, for messages about a mismatch.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct RecordingSpan {
    /// The first clock of the stretch, which ends where the next one begins.
    pub first_clock: u64,
    /// The name of the sequence of frames.
    pub sequence: String,
    /// The index of the frame in the sequence that enters, from 0.
    pub frame: u64,
    /// The region whose pixels enter, if one region is simulated at a time.
    pub region: Option<u32>,
}

/// The name of the file with the vectors of a replay bench.
pub(crate) const VECTORS_FILE: &str = "vectors.hex";
/// The name of the file with the ends of sequences, for the same bench.
pub(crate) const ENDS_FILE: &str = "ends.hex";

/// Finished vectors, for any number of runs, also at the same time. The files are removed when the
/// value is dropped.
#[derive(Debug)]
pub struct Recording {
    folder: ScratchFolder,
    /// True if the folder has the files of the replay bench.
    has_bench_files: Mutex<bool>,
    inputs: RecordLayout,
    outputs: RecordLayout,
    clocks: u64,
    frames: u64,
    spans: Vec<RecordingSpan>,
    situations: Occurrences,
}

impl Recording {
    /// Returns the number of times that each situation occurred that the design can have.
    #[must_use]
    pub fn situations(&self) -> &Occurrences {
        &self.situations
    }

    /// Returns the layout of an input record.
    #[must_use]
    pub fn inputs(&self) -> &RecordLayout {
        &self.inputs
    }

    /// Returns the layout of an output record.
    #[must_use]
    pub fn outputs(&self) -> &RecordLayout {
        &self.outputs
    }

    /// Returns the number of clocks; each clock has one input and one output record.
    #[must_use]
    pub fn clocks(&self) -> u64 {
        self.clocks
    }

    /// Returns the expected outputs of one clock.
    ///
    /// # Errors
    /// Fails if they cannot be read.
    pub(crate) fn expected_at(&self, clock: u64) -> Result<Vec<u8>, CosimError> {
        let (path, mut record) = (self.expected_path(), self.outputs.zero_record());
        let mut file = open_buffered(&path)?;
        file.seek(SeekFrom::Start(clock * record.len() as u64))
            .and_then(|_| file.read_exact(&mut record))
            .map_err(CosimError::io("read", &path))?;
        Ok(record)
    }

    /// Returns the number of values that are compared in the first `clocks` clocks.
    ///
    /// # Errors
    /// Fails if the expected outputs cannot be read.
    pub fn comparisons(&self, clocks: u64) -> Result<u64, CosimError> {
        let mut record = self.outputs.zero_record();
        if self.outputs.is_ungated() {
            return Ok(clocks * self.outputs.compared_values(&record));
        }
        let path = self.expected_path();
        let (mut expected, mut values) = (open_buffered(&path)?, 0);
        for _ in 0..clocks {
            expected.read_exact(&mut record).map_err(CosimError::io("read", &path))?;
            values += self.outputs.compared_values(&record);
        }
        Ok(values)
    }

    /// Returns the number of frames that were begun.
    #[must_use]
    pub fn frames(&self) -> u64 {
        self.frames
    }

    /// Returns the number of sequences of frames.
    #[must_use]
    pub fn sequences(&self) -> u64 {
        let starts = self.spans.chunk_by(|a, b| a.sequence == b.sequence && a.region == b.region);
        starts.count() as u64
    }

    /// Returns all stretches in order.
    #[must_use]
    pub fn spans(&self) -> &[RecordingSpan] {
        &self.spans
    }

    /// Returns the stretch to which a clock belongs.
    #[must_use]
    pub fn span(&self, clock: u64) -> Option<&RecordingSpan> {
        let after = self.spans.partition_point(|span| span.first_clock <= clock);
        after.checked_sub(1).and_then(|index| self.spans.get(index))
    }

    /// Returns the clocks of the sequence to which a clock belongs, from its reset on.
    #[must_use]
    pub fn sequence(&self, clock: u64) -> Range<u64> {
        let after = self.spans.partition_point(|span| span.first_clock <= clock);
        let (before, after) = self.spans.split_at(after);
        let starts = |span: &&RecordingSpan| span.frame == 0;
        let start = before.iter().rfind(starts).map_or(0, |span| span.first_clock);
        start..after.iter().find(starts).map_or(self.clocks, |span| span.first_clock)
    }

    /// Writes the clocks at which sequences end, for a replay bench.
    ///
    /// # Errors
    /// Fails if the file cannot be written.
    fn write_ends(&self, path: &Path) -> Result<(), CosimError> {
        let starts = self.spans.iter().filter(|span| span.frame == 0).map(|span| span.first_clock);
        let ends = starts.filter(|&clock| clock > 0).map(|clock| format!("{clock:x}\n"));
        std::fs::write(path, ends.collect::<String>()).map_err(CosimError::io("write", path))
    }

    /// Calls `see` for each of these clocks, with its input record and its expected outputs.
    ///
    /// # Errors
    /// Fails if the files cannot be read.
    pub(crate) fn for_each_clock(
        &self,
        clocks: Range<u64>,
        mut see: impl FnMut(u64, &[u8], &[u8]),
    ) -> Result<(), CosimError> {
        let (inputs_path, expected_path) = (self.inputs_path(), self.expected_path());
        let (mut inputs, mut outputs) =
            (open_buffered(&inputs_path)?, open_buffered(&expected_path)?);
        let (mut input, mut expected) = (self.inputs.zero_record(), self.outputs.zero_record());
        inputs
            .seek(SeekFrom::Start(clocks.start * input.len() as u64))
            .map_err(CosimError::io("read", &inputs_path))?;
        outputs
            .seek(SeekFrom::Start(clocks.start * expected.len() as u64))
            .map_err(CosimError::io("read", &expected_path))?;
        for clock in clocks {
            inputs.read_exact(&mut input).map_err(CosimError::io("read", &inputs_path))?;
            outputs.read_exact(&mut expected).map_err(CosimError::io("read", &expected_path))?;
            see(clock, &input, &expected);
        }
        Ok(())
    }

    /// Returns the path of the file of input records.
    #[must_use]
    pub fn inputs_path(&self) -> PathBuf {
        inputs_path(self.folder.path())
    }

    /// Returns the path of the file of expected output records.
    #[must_use]
    pub fn expected_path(&self) -> PathBuf {
        expected_path(self.folder.path())
    }

    /// Returns the folder of the files.
    #[must_use]
    pub fn folder(&self) -> &Path {
        self.folder.path()
    }

    /// Creates a folder for the files of one run, which is removed with the recording.
    ///
    /// # Errors
    /// Fails if the folder cannot be created.
    pub(crate) fn create_run_folder(&self) -> Result<PathBuf, CosimError> {
        let folder = tempfile::Builder::new()
            .prefix("run-")
            .tempdir_in(self.folder())
            .map_err(CosimError::temporary("create a folder in", self.folder()))?;
        Ok(folder.keep())
    }

    /// Returns the folder with [`VECTORS_FILE`] and [`ENDS_FILE`], which are written at the first
    /// call.
    ///
    /// # Errors
    /// Fails if a file cannot be read or written.
    pub(crate) fn bench_folder(&self) -> Result<&Path, CosimError> {
        let mut has_files = self.has_bench_files.lock().unwrap_or_else(PoisonError::into_inner);
        if !*has_files {
            self.write_hex(&self.folder().join(VECTORS_FILE), u64::MAX)?;
            self.write_ends(&self.folder().join(ENDS_FILE))?;
            *has_files = true;
        }
        Ok(self.folder())
    }

    /// Writes the first `limit` clocks as the vectors of a replay bench.
    ///
    /// # Errors
    /// Fails if a file cannot be read or written.
    pub fn write_hex(&self, path: &Path, limit: u64) -> Result<(), CosimError> {
        let file = File::create(path).map_err(CosimError::io("write", path))?;
        self.pack_vectors(limit, BufWriter::with_capacity(1 << 18, file), path).map(drop)
    }

    /// Packs the first `limit` clocks as vectors of a replay bench; errors name `to`.
    fn pack_vectors<W: Write>(&self, limit: u64, out: W, to: &Path) -> Result<W, CosimError> {
        let (inputs, expected) = (self.inputs_path(), self.expected_path());
        let mut sources = [open_buffered(&inputs)?, open_buffered(&expected)?];
        let [input, output] = &mut sources;
        let (mut applied, mut wanted) = (self.inputs.zero_record(), self.outputs.zero_record());
        let mut packer = VectorPacker::new(&self.inputs, &self.outputs, out);
        for _ in 0..self.clocks.min(limit) {
            input.read_exact(&mut applied).map_err(CosimError::io("read", &inputs))?;
            output.read_exact(&mut wanted).map_err(CosimError::io("read", &expected))?;
            packer.push(&applied, &wanted, 1).map_err(CosimError::io("write", to))?;
        }
        packer.finish().map_err(CosimError::io("write", to))
    }
}

/// Returns the first `limit` clocks of a recording as text for a replay bench; [`VectorPacker`]
/// describes its lines.
///
/// # Errors
/// Fails if the recording cannot be read.
pub fn vectors_hex(recording: &Recording, limit: u64) -> Result<String, CosimError> {
    let bytes = recording.pack_vectors(limit, Vec::new(), Path::new("vectors"))?;
    Ok(String::from_utf8_lossy(&bytes).into_owned())
}

/// A writer of a recording.
#[derive(Debug)]
pub struct Recorder {
    recording: Recording,
    watch: Option<SituationMonitor>,
    input: BufWriter<File>,
    expected: BufWriter<File>,
}

impl Recorder {
    /// Creates an empty recording for a module with these ports.
    ///
    /// # Errors
    /// Fails if there is no place for temporary files.
    pub fn new(ports: &[Port]) -> Result<Self, CosimError> {
        let parent = std::env::temp_dir();
        let folder =
            ScratchFolder::new().map_err(CosimError::temporary("create a folder in", &parent))?;
        let create = |path: PathBuf| {
            let file = File::create(&path).map_err(CosimError::temporary("write", &path))?;
            Ok::<_, CosimError>(BufWriter::with_capacity(1 << 18, file))
        };
        Ok(Self {
            input: create(inputs_path(folder.path()))?,
            expected: create(expected_path(folder.path()))?,
            watch: None,
            recording: Recording {
                situations: Occurrences::default(),
                folder,
                has_bench_files: Mutex::new(false),
                inputs: RecordLayout::inputs(ports),
                outputs: RecordLayout::outputs(ports),
                clocks: 0,
                frames: 0,
                spans: Vec::new(),
            },
        })
    }

    /// Counts the situations of this module of a design from now on.
    pub(crate) fn count_situations(&mut self, design: &Design, top: Top) {
        self.watch = Some(SituationMonitor::new(design, top, self.inputs(), self.outputs()));
    }

    /// Returns the layout of an input record.
    #[must_use]
    pub fn inputs(&self) -> &RecordLayout {
        &self.recording.inputs
    }

    /// Returns the layout of an output record.
    #[must_use]
    pub fn outputs(&self) -> &RecordLayout {
        &self.recording.outputs
    }

    /// Returns the number of clocks so far.
    #[must_use]
    pub fn clocks(&self) -> u64 {
        self.recording.clocks
    }

    /// Names the sequence, frame and region of the following clocks, and counts a frame.
    pub fn begin_frame(&mut self, sequence: &str, frame: u64, region: Option<u32>) {
        let first_clock = self.recording.clocks;
        self.recording.frames += 1;
        let sequence = sequence.to_owned();
        self.recording.spans.push(RecordingSpan { first_clock, sequence, frame, region });
    }

    /// Adds one clock: the inputs of an edge, and the outputs after it.
    ///
    /// # Errors
    /// Fails if the files cannot be written.
    pub fn push(&mut self, input: &[u8], expected: &[u8]) -> Result<(), CosimError> {
        if let Some(watch) = &mut self.watch {
            watch.add_clocks(input, expected, 1);
        }
        let folder = self.recording.folder.path();
        self.input.write_all(input).map_err(CosimError::temporary("write", folder))?;
        self.expected.write_all(expected).map_err(CosimError::temporary("write", folder))?;
        self.recording.clocks += 1;
        Ok(())
    }

    /// Ends the recording.
    ///
    /// # Errors
    /// Fails if the files cannot be written.
    pub fn finish(mut self) -> Result<Recording, CosimError> {
        let folder = self.recording.folder.path();
        self.input.flush().map_err(CosimError::temporary("write", folder))?;
        self.expected.flush().map_err(CosimError::temporary("write", folder))?;
        if let Some(watch) = &self.watch {
            self.recording.situations = watch.occurrences();
        }
        Ok(self.recording)
    }
}

fn inputs_path(folder: &Path) -> PathBuf {
    folder.join("inputs.bin")
}

fn expected_path(folder: &Path) -> PathBuf {
    folder.join("expected.bin")
}

/// Opens a file with a large buffer.
pub(crate) fn open_buffered(path: &Path) -> Result<BufReader<File>, CosimError> {
    let file = File::open(path).map_err(CosimError::io("read", path))?;
    Ok(BufReader::with_capacity(1 << 18, file))
}

// SPDX-License-Identifier: MIT OR Apache-2.0
//! The events of a pixel camera as files: NPZ with the fields that tonic uses, and CSV.

use std::fs::{self, File};
use std::io::{self, BufReader, BufWriter, Read, Write};
use std::path::{Path, PathBuf};

use foveate_spec::Design;

use super::csv::Csv;
use super::npz::Npz;
use super::sink::Step;
use super::{PixelCamera, PixelEvents, cannot_write};
use crate::SimulatorError;

/// An event as NumPy reads it, and as tonic names and types its fields; 13 bytes.
const EVENT: &str = "[('x', '<i2'), ('y', '<i2'), ('t', '<i8'), ('p', '|b1')]";

/// The camera with its files, open.
pub(super) struct PixelRecorder {
    camera: PixelCamera,
    npz: Option<NpzFile>,
    csv: Option<Csv>,
    events: u64,
    /// Events of one frame as bytes.
    bytes: Vec<u8>,
}

/// The archive, and beside it the number of events before each frame until there is room for them.
struct NpzFile {
    path: PathBuf,
    npz: Npz,
    starts_path: PathBuf,
    starts: BufWriter<File>,
    frames: u64,
}

impl PixelRecorder {
    pub(super) fn create(
        folder: &Path,
        design: &Design,
        options: PixelEvents,
    ) -> Result<Self, SimulatorError> {
        let csv = options.csv.then(|| Csv::create(&folder.join("pixel_events.csv"), "x,y,t,p"));
        Ok(Self {
            camera: PixelCamera::new(design, options)?,
            npz: options.npz.then(|| NpzFile::create(folder)).transpose()?,
            csv: csv.transpose()?,
            events: 0,
            bytes: Vec::new(),
        })
    }

    pub(super) fn push(&mut self, step: &Step<'_>) -> Result<(), SimulatorError> {
        let Self { camera, npz, csv, events, bytes } = self;
        let time = step.source.time_us;
        let before = *events;
        let mut lines = Ok(());
        bytes.clear();
        camera.step(&step.source.frame, |event| {
            *events += 1;
            let polarity = u8::from(event.brighter);
            if npz.is_some() {
                // Coordinates stay below 2^14.
                bytes.extend(event.x.to_le_bytes().into_iter().take(2));
                bytes.extend(event.y.to_le_bytes().into_iter().take(2));
                bytes.extend(time.to_le_bytes());
                bytes.push(polarity);
            }
            if let (Some(csv), Ok(())) = (csv.as_mut(), &lines) {
                let fields = [event.x.into(), event.y.into(), time, polarity.into()];
                lines = csv.line(fields);
            }
        });
        lines?;
        npz.as_mut().map_or(Ok(()), |npz| npz.push(before, bytes).map_err(cannot_write(&npz.path)))
    }

    /// Completes the files; how many events they hold.
    pub(super) fn finish(self) -> Result<u64, SimulatorError> {
        if let Some(csv) = self.csv {
            csv.finish()?;
        }
        if let Some(npz) = self.npz {
            let path = npz.path.clone();
            npz.finish(self.events).map_err(cannot_write(&path))?;
        }
        Ok(self.events)
    }
}

impl NpzFile {
    fn create(folder: &Path) -> Result<Self, SimulatorError> {
        let path = folder.join("pixel_events.npz");
        let starts_path = folder.join(".frame_start.partial");
        let file = File::create(&path).map_err(cannot_write(&path))?;
        let starts = File::create(&starts_path).map_err(cannot_write(&starts_path))?;
        let npz = Npz::create(file, "events", EVENT).map_err(cannot_write(&path))?;
        Ok(Self { path, npz, starts_path, starts: BufWriter::new(starts), frames: 0 })
    }

    fn push(&mut self, before: u64, events: &[u8]) -> io::Result<()> {
        self.frames += 1;
        self.starts.write_all(&before.to_le_bytes())?;
        self.npz.write(events)
    }

    fn finish(mut self, events: u64) -> io::Result<()> {
        self.starts.write_all(&events.to_le_bytes())?;
        self.starts.flush()?;
        drop(self.starts);
        self.npz.next(events, "frame_start", "'<i8'")?;
        let mut starts = BufReader::new(File::open(&self.starts_path)?);
        let mut chunk = [0; 1 << 13];
        loop {
            match starts.read(&mut chunk)? {
                0 => break,
                length => self.npz.write(&chunk[..length])?,
            }
        }
        self.npz.finish(self.frames + 1)?;
        fs::remove_file(&self.starts_path)
    }
}

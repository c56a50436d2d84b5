// SPDX-License-Identifier: MIT OR Apache-2.0
//! The events of a pixel camera as files: NPZ with the fields that tonic uses, CSV, EVT 2.0,
//! EVT 3.0 and AEDAT4.

use super::csv::CsvFile;
use super::npz::NpzArchive;
use super::sink::SinkFrame;
use super::{PixelCamera, PixelEvent, PixelEventOptions, cannot_write};
use crate::SimulatorError;
use foveate_camera::Camera;
use foveate_media::{EventEncoder, EventFileError, EventFormat};
use foveate_tools::GrowingFile;
use std::fs::{self, File};
use std::io::Read;
use std::path::{Path, PathBuf};

/// The type of the records of events in NumPy's notation.
const EVENT_TYPE: &str = "[('x', '<i2'), ('y', '<i2'), ('t', '<i8'), ('p', '|b1')]";

/// The camera and its open files.
pub(super) struct PixelEventFiles {
    camera: PixelCamera,
    npz: Option<EventArchive>,
    csv: Option<CsvFile>,
    streams: Vec<EventStream>,
    events: u64,
    /// The events of one frame as bytes.
    bytes: Vec<u8>,
}

/// A file in a format of event cameras.
struct EventStream {
    encoder: EventEncoder,
    file: GrowingFile,
}

/// The archive, and a second file with the number of events before each frame, which is moved into
/// the archive at the end.
struct EventArchive {
    npz: NpzArchive,
    starts_path: PathBuf,
    starts: GrowingFile,
    frames: u64,
}

impl PixelEventFiles {
    pub(super) fn create(
        folder: &Path,
        camera: &Camera,
        options: PixelEventOptions,
    ) -> Result<Self, SimulatorError> {
        let csv = options.csv.then(|| CsvFile::create(&folder.join("pixel_events.csv"), "x,y,t,p"));
        Ok(Self {
            camera: PixelCamera::new(camera, options)?,
            npz: options.npz.then(|| EventArchive::create(folder)).transpose()?,
            csv: csv.transpose()?,
            streams: EventStream::create_all(folder, camera, options)?,
            events: 0,
            bytes: Vec::new(),
        })
    }

    pub(super) fn push(&mut self, sink_frame: &SinkFrame<'_>) -> Result<(), SimulatorError> {
        let Self { camera, npz, csv, streams, events, bytes } = self;
        let time = sink_frame.source.time_us;
        let (before, mut written) = (*events, Ok(()));
        bytes.clear();
        camera.step(&sink_frame.source.frame.to_frame()?, |event| {
            *events += 1;
            if npz.is_some() {
                event.append_record(time, bytes);
            }
            for stream in streams.iter_mut() {
                if written.is_ok() {
                    written = stream.push(event, time);
                }
            }
            if let Some(csv) = csv {
                let polarity = u64::from(event.brighter);
                csv.line([event.x.into(), event.y.into(), time, polarity]);
            }
        });
        if let Some(npz) = npz {
            npz.push(before, bytes);
        }
        Ok(written?)
    }

    pub(super) fn write_out(&mut self) -> Result<(), SimulatorError> {
        self.csv.as_mut().map_or(Ok(()), CsvFile::write_pending)?;
        self.streams.iter_mut().try_for_each(|stream| stream.file.write_pending())?;
        self.npz.as_mut().map_or(Ok(()), |npz| {
            npz.starts.write_pending()?;
            npz.npz.write_out()
        })
    }

    /// Completes the files. Returns the number of events in them.
    pub(super) fn finish(self) -> Result<u64, SimulatorError> {
        self.csv.map_or(Ok(()), |mut csv| csv.write_all())?;
        for EventStream { mut encoder, mut file } in self.streams {
            encoder.finish(file.pending_mut());
            file.write_all()?;
        }
        if let Some(npz) = self.npz {
            npz.finish(self.events)?;
        }
        Ok(self.events)
    }
}

impl EventStream {
    /// Creates the files that are wanted, with their headers.
    fn create_all(
        folder: &Path,
        camera: &Camera,
        options: PixelEventOptions,
    ) -> Result<Vec<Self>, SimulatorError> {
        let size = (camera.width(), camera.height());
        let wanted = [
            (options.evt2, EventFormat::Evt2, "pixel_events_evt2.raw"),
            (options.evt3, EventFormat::Evt3, "pixel_events_evt3.raw"),
            (options.aedat4, EventFormat::Aedat4, "pixel_events.aedat4"),
        ];
        let create = |(_, format, name)| {
            let (encoder, header) = EventEncoder::new(format, size)?;
            let mut file = GrowingFile::create(&folder.join(name))?;
            file.append(&header);
            Ok(Self { encoder, file })
        };
        wanted.into_iter().filter(|(is_wanted, ..)| *is_wanted).map(create).collect()
    }

    fn push(&mut self, event: PixelEvent, time_us: u64) -> Result<(), EventFileError> {
        let side = |side| u16::try_from(side).expect("a stream has frames that fit");
        let event = foveate_media::PixelEvent {
            x: side(event.x),
            y: side(event.y),
            time_us,
            is_brighter: event.brighter,
        };
        self.encoder.push(event, self.file.pending_mut())
    }
}

impl EventArchive {
    fn create(folder: &Path) -> Result<Self, SimulatorError> {
        let path = folder.join("pixel_events.npz");
        let starts_path = folder.join(".frame_start.partial");
        let npz = NpzArchive::new(GrowingFile::create(&path)?, "events", EVENT_TYPE);
        let starts = GrowingFile::create(&starts_path)?;
        Ok(Self { npz, starts_path, starts, frames: 0 })
    }

    fn push(&mut self, before: u64, events: &[u8]) {
        self.frames += 1;
        self.starts.append(&before.to_le_bytes());
        self.npz.write(events);
    }

    fn finish(mut self, events: u64) -> Result<(), SimulatorError> {
        let failed = cannot_write(&self.starts_path);
        self.starts.append(&events.to_le_bytes());
        self.starts.write_all()?;
        drop(self.starts);
        self.npz.next_array(events, "frame_start", "'<i8'")?;
        let mut starts = File::open(&self.starts_path).map_err(&failed)?;
        let mut chunk = [0; 1 << 13];
        loop {
            match starts.read(&mut chunk).map_err(&failed)? {
                0 => break,
                length => self.npz.write(&chunk[..length]),
            }
            self.npz.write_out()?;
        }
        self.npz.finish(self.frames + 1)?;
        fs::remove_file(&self.starts_path).map_err(&failed)
    }
}

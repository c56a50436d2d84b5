// SPDX-License-Identifier: MIT OR Apache-2.0
//! Numbered PNG files in a folder, written by a pool of threads, because the compression of a
//! picture takes longer than all other work for a frame. A picture for which the disk has no space
//! is kept in memory until the end.

use super::cannot_write;
use super::raw_image::{RawImage, SampleFormat};
use crate::SimulatorError;
use image::codecs::png::{CompressionType, FilterType, PngEncoder};
use image::{ExtendedColorType, ImageEncoder, ImageError};
use std::path::{Path, PathBuf};
use std::sync::mpsc::{Receiver, Sender, SyncSender, channel, sync_channel};
use std::sync::{Arc, Mutex, PoisonError};
use std::thread::{Builder, JoinHandle};
use std::{fs, io};

/// The largest number of threads. More threads do not help, because other work is then the limit.
const MAX_THREADS: usize = 8;

/// A picture and the path of its file.
struct PngJob {
    path: PathBuf,
    picture: RawImage,
}

/// The threads and their queues.
pub(super) struct PngWriters {
    /// The queue of pictures, or `None` once no more pictures come.
    jobs: Option<SyncSender<PngJob>>,
    done: Receiver<(PngJob, io::Result<()>)>,
    threads: Vec<JoinHandle<()>>,
    /// The pictures that found no space on the disk.
    unwritten: Vec<PngJob>,
    /// The memory for the next picture.
    spare_buffer: Vec<u8>,
}

impl PngWriters {
    pub(super) fn new() -> Result<Self, SimulatorError> {
        let size = Self::size();
        let (jobs, queue) = sync_channel(size);
        let (sender, done) = channel();
        let queue = Arc::new(Mutex::new(queue));
        let mut writers = Self {
            jobs: Some(jobs),
            done,
            threads: Vec::new(),
            unwritten: Vec::new(),
            spare_buffer: Vec::new(),
        };
        for _ in 0..size {
            let (queue, sender) = (Arc::clone(&queue), sender.clone());
            let thread = Builder::new().name("pictures".to_owned());
            let thread = thread.spawn(move || write_pictures(&queue, &sender));
            let refused = |error: io::Error| SimulatorError::Thread { reason: error.to_string() };
            writers.threads.push(thread.map_err(refused)?);
        }
        Ok(writers)
    }

    fn size() -> usize {
        rayon::current_num_threads().min(MAX_THREADS)
    }

    /// Returns the largest number of pictures that may be queued or in compression at once.
    fn max_pictures_in_work() -> usize {
        2 * Self::size() + 1
    }

    /// Returns the largest number of bytes that the pictures in the queue and in compression need
    /// on the disk. A pixel has `samples` bytes.
    pub(super) fn max_bytes_in_work(width: u32, height: u32, samples: u64) -> u64 {
        // A PNG is larger than its pixels by at most a byte per row, some bytes per block, and the
        // fixed chunks.
        let picture = (u64::from(width) * samples + 1) * u64::from(height);
        (picture + picture / 1000 + 4096) * Self::max_pictures_in_work() as u64
    }

    /// Returns a buffer for a picture, with the size of the last one.
    pub(super) fn take_spare_buffer(&mut self) -> Vec<u8> {
        std::mem::take(&mut self.spare_buffer)
    }

    /// Queues a picture. Waits while the queue is full.
    pub(super) fn push(&mut self, path: PathBuf, picture: RawImage) {
        let job = PngJob { path, picture };
        let refused = match &self.jobs {
            Some(jobs) => jobs.send(job).err().map(|refused| refused.0),
            None => Some(job),
        };
        self.unwritten.extend(refused);
    }

    /// Checks that all finished pictures were written.
    pub(super) fn check_written(&mut self) -> Result<(), SimulatorError> {
        for (job, result) in self.done.try_iter() {
            match result {
                Ok(()) => self.spare_buffer = job.picture.bytes,
                Err(error) => {
                    let failed = cannot_write(&job.path)(error);
                    self.unwritten.push(job);
                    return Err(failed);
                }
            }
        }
        Ok(())
    }

    /// Waits for all pictures, and writes those again that found no space.
    pub(super) fn finish(mut self) -> Result<(), SimulatorError> {
        self.join_threads();
        let failed = self.done.try_iter().filter(|(_, result)| result.is_err()).map(|(job, _)| job);
        self.unwritten.extend(failed);
        let mut bytes = Vec::new();
        for PngJob { path, picture } in &self.unwritten {
            write(path, picture, &mut bytes).map_err(cannot_write(path))?;
        }
        Ok(())
    }

    fn join_threads(&mut self) {
        drop(self.jobs.take());
        for thread in self.threads.drain(..) {
            // The panic of a thread was reported already, and its picture is missing in `done`.
            let _ = thread.join();
        }
    }
}

impl Drop for PngWriters {
    /// Ends the threads, so that none writes into a folder that is about to be removed.
    fn drop(&mut self) {
        self.join_threads();
    }
}

fn write_pictures(queue: &Mutex<Receiver<PngJob>>, done: &Sender<(PngJob, io::Result<()>)>) {
    let mut bytes = Vec::new();
    loop {
        let job = queue.lock().unwrap_or_else(PoisonError::into_inner).recv();
        let Ok(job) = job else { return };
        let result = write(&job.path, &job.picture, &mut bytes);
        if done.send((job, result)).is_err() {
            return;
        }
    }
}

/// Encodes a picture into `bytes` and writes it to a file at once.
pub(super) fn write(path: &Path, picture: &RawImage, bytes: &mut Vec<u8>) -> io::Result<()> {
    let colour = match picture.samples {
        SampleFormat::Grey8 => ExtendedColorType::L8,
        // The encoder takes the byte order of the machine, and writes that of PNG.
        SampleFormat::Grey16 => ExtendedColorType::L16,
        SampleFormat::Rgb8 => ExtendedColorType::Rgb8,
    };
    bytes.clear();
    PngEncoder::new_with_quality(&mut *bytes, CompressionType::Fast, FilterType::Paeth)
        .write_image(&picture.bytes, picture.width, picture.height, colour)
        .map_err(|error| match error {
            ImageError::IoError(error) => error,
            other => io::Error::other(other),
        })?;
    fs::write(path, bytes)
}

/// A folder of pictures `000000.png`, `000001.png` and so on.
pub(super) struct PngSeries {
    folder: PathBuf,
    next: u64,
    pub(super) writers: PngWriters,
}

impl PngSeries {
    pub(super) fn create(folder: PathBuf) -> Result<Self, SimulatorError> {
        fs::create_dir(&folder).map_err(cannot_write(&folder))?;
        Ok(Self { folder, next: 0, writers: PngWriters::new()? })
    }

    pub(super) fn folder(&self) -> &Path {
        &self.folder
    }

    pub(super) fn push(&mut self, picture: RawImage) {
        let path = self.folder.join(format!("{:06}.png", self.next));
        self.next += 1;
        self.writers.push(path, picture);
    }
}

// SPDX-License-Identifier: MIT OR Apache-2.0
//! PNG files written side by side on threads of their own, since packing one takes longer than
//! everything else that is done for a frame. A picture for which there is no room is kept until the end.

use std::io;
use std::path::PathBuf;
use std::sync::mpsc::{Receiver, Sender, SyncSender, channel, sync_channel};
use std::sync::{Arc, Mutex, PoisonError};
use std::thread::{Builder, JoinHandle};

use super::picture::RawImage;
use super::{cannot_write, png};
use crate::SimulatorError;
use foveate_staging::is_full;

/// More do not help: something else is the limit then.
const MOST: usize = 8;

/// A picture and where it goes.
struct Job {
    path: PathBuf,
    picture: RawImage,
}

/// The threads with their work.
pub(super) struct Crew {
    /// None once there is no more to do.
    jobs: Option<SyncSender<Job>>,
    done: Receiver<(Job, io::Result<()>)>,
    threads: Vec<JoinHandle<()>>,
    /// What found no room.
    unwritten: Vec<Job>,
    /// Memory for the next picture.
    spare: Vec<u8>,
}

impl Crew {
    pub(super) fn new() -> Result<Self, SimulatorError> {
        let size = Self::size();
        let (jobs, queue) = sync_channel(size);
        let (sender, done) = channel();
        let queue = Arc::new(Mutex::new(queue));
        let mut crew = Self {
            jobs: Some(jobs),
            done,
            threads: Vec::new(),
            unwritten: Vec::new(),
            spare: Vec::new(),
        };
        for _ in 0..size {
            let (queue, sender) = (Arc::clone(&queue), sender.clone());
            let thread = Builder::new().name("pictures".to_owned());
            let thread = thread.spawn(move || work(&queue, &sender));
            let refused = |error: io::Error| SimulatorError::Thread { reason: error.to_string() };
            crew.threads.push(thread.map_err(refused)?);
        }
        Ok(crew)
    }

    fn size() -> usize {
        rayon::current_num_threads().min(MOST)
    }

    /// At most how many pictures may be on their way.
    fn on_the_way() -> usize {
        2 * Self::size() + 1
    }

    /// At most how many bytes the pictures need that are on their way, of `samples` bytes per pixel.
    pub(super) fn owed(width: u32, height: u32, samples: u64) -> u64 {
        // No PNG is longer than its pixels by more than a byte per row, some per block, and the frame.
        let picture = (u64::from(width) * samples + 1) * u64::from(height);
        (picture + picture / 1000 + 4096) * Self::on_the_way() as u64
    }

    /// Memory for a picture, as long as the last.
    pub(super) fn spare(&mut self) -> Vec<u8> {
        std::mem::take(&mut self.spare)
    }

    /// Hands a picture over; waits while there is more to do than hands.
    pub(super) fn push(&mut self, path: PathBuf, picture: RawImage) {
        let job = Job { path, picture };
        let refused = match &self.jobs {
            Some(jobs) => jobs.send(job).err().map(|refused| refused.0),
            None => Some(job),
        };
        self.unwritten.extend(refused);
    }

    /// Whether all pictures that are done are there; waits for `all` of them if asked to.
    pub(super) fn write_out(&mut self, all: bool) -> Result<(), SimulatorError> {
        if all {
            self.end();
        }
        for (job, result) in self.done.try_iter() {
            match result {
                Ok(()) => self.spare = job.picture.bytes,
                Err(error) if is_full(&error) => {
                    self.unwritten.push(job);
                    return Err(cannot_write(&self.unwritten[self.unwritten.len() - 1].path)(
                        error,
                    ));
                }
                Err(error) => return Err(cannot_write(&job.path)(error)),
            }
        }
        Ok(())
    }

    /// Waits for all pictures, and tries those again for which there was no room.
    pub(super) fn finish(mut self) -> Result<(), SimulatorError> {
        while let Err(error) = self.write_out(true) {
            if !error.is_full() {
                return Err(error);
            }
        }
        let mut bytes = Vec::new();
        for Job { path, picture } in std::mem::take(&mut self.unwritten) {
            png::write(&path, &picture, &mut bytes).map_err(cannot_write(&path))?;
        }
        Ok(())
    }

    fn end(&mut self) {
        drop(self.jobs.take());
        for thread in self.threads.drain(..) {
            // A thread that has panicked has said so, and its picture is missing in `done`.
            let _ = thread.join();
        }
    }
}

impl Drop for Crew {
    /// Nobody writes into a folder that is about to be removed.
    fn drop(&mut self) {
        self.end();
    }
}

fn work(queue: &Mutex<Receiver<Job>>, done: &Sender<(Job, io::Result<()>)>) {
    let mut bytes = Vec::new();
    loop {
        let job = queue.lock().unwrap_or_else(PoisonError::into_inner).recv();
        let Ok(job) = job else { return };
        let result = png::write(&job.path, &job.picture, &mut bytes);
        if done.send((job, result)).is_err() {
            return;
        }
    }
}

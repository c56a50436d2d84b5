// SPDX-License-Identifier: MIT OR Apache-2.0
//! The monitor of a run: it counts the frames of all players, reports progress to the hooks, and
//! ends the playback when they cancel.

use std::sync::atomic::{AtomicU64, AtomicUsize, Ordering};

use crate::playback::{ClipPlayer, PlaybackError, PlayedFrame, RunHooks, RunProgress};

/// The progress of a run, which the threads of the run share.
pub struct RunMonitor<'a> {
    hooks: &'a dyn RunHooks,
    report: ReportForm<'a>,
    frames_done: AtomicU64,
    clips_done: AtomicUsize,
}

enum ReportForm<'a> {
    Frames { total: Option<u64> },
    Clips { total: usize },
    Stage(&'a (dyn Fn(u64) -> RunProgress<'static> + Sync)),
}

impl<'a> RunMonitor<'a> {
    /// Makes a monitor that reports frames, of `total` if it is known.
    #[must_use]
    pub fn of_frames(hooks: &'a dyn RunHooks, total: Option<u64>) -> Self {
        Self::new(hooks, ReportForm::Frames { total })
    }

    /// Makes a monitor that reports frames and clips, of so many clips.
    #[must_use]
    pub fn of_clips(hooks: &'a dyn RunHooks, total: usize) -> Self {
        Self::new(hooks, ReportForm::Clips { total })
    }

    /// Makes a monitor that reports a stage of the run after every frame. `stage` gets the number
    /// of frames that are done.
    #[must_use]
    pub fn of_stage(
        hooks: &'a dyn RunHooks,
        stage: &'a (dyn Fn(u64) -> RunProgress<'static> + Sync),
    ) -> Self {
        Self::new(hooks, ReportForm::Stage(stage))
    }

    fn new(hooks: &'a dyn RunHooks, report: ReportForm<'a>) -> Self {
        let (frames_done, clips_done) = (AtomicU64::new(0), AtomicUsize::new(0));
        Self { hooks, report, frames_done, clips_done }
    }

    /// Returns the frames of a clip one by one. A frame is done when the next one is asked for.
    /// The frames end with [`PlaybackError::Interrupted`] when the hooks cancel.
    pub fn watch<'p>(&'p self, player: &'p mut ClipPlayer) -> MonitoredFrames<'p> {
        MonitoredFrames { monitor: self, player, is_showing: false }
    }

    /// Returns the number of frames that are done.
    #[must_use]
    pub fn frames_done(&self) -> u64 {
        self.frames_done.load(Ordering::Relaxed)
    }

    /// Counts a frame that is done, and reports it.
    pub fn add_frame(&self) {
        self.frames_done.fetch_add(1, Ordering::Relaxed);
        self.report();
    }

    /// Counts a clip that is done, and reports it.
    pub fn add_clip(&self) {
        self.clips_done.fetch_add(1, Ordering::Relaxed);
        self.report();
    }

    /// Returns true if the run is to stop.
    #[must_use]
    pub fn is_cancelled(&self) -> bool {
        self.hooks.is_cancelled()
    }

    /// Checks that the run is to go on.
    ///
    /// # Errors
    /// Fails if the run is to stop.
    pub fn check(&self) -> Result<(), PlaybackError> {
        if self.is_cancelled() { Err(PlaybackError::Interrupted) } else { Ok(()) }
    }

    /// Reports the present state.
    pub fn report(&self) {
        let frames = self.frames_done();
        self.hooks.progress(&match self.report {
            ReportForm::Frames { total } => RunProgress::frames(frames, total, ""),
            ReportForm::Clips { total } => {
                let clips = self.clips_done.load(Ordering::Relaxed);
                RunProgress::frames(frames, None, format!("{clips}/{total} clips"))
            }
            ReportForm::Stage(stage) => stage(frames),
        });
    }
}

/// The frames of a clip that a monitor watches.
pub struct MonitoredFrames<'a> {
    monitor: &'a RunMonitor<'a>,
    player: &'a mut ClipPlayer,
    /// True while a frame is out that is not done.
    is_showing: bool,
}

impl Iterator for MonitoredFrames<'_> {
    type Item = Result<PlayedFrame, PlaybackError>;

    fn next(&mut self) -> Option<Self::Item> {
        if std::mem::take(&mut self.is_showing) {
            self.monitor.add_frame();
        }
        let next = self.player.next();
        // An interrupt may have ended ffmpeg, too, which then looks like a damaged clip.
        let may_go_on = next.is_some() || self.player.problem().is_some();
        if may_go_on && self.monitor.is_cancelled() {
            return Some(Err(PlaybackError::Interrupted));
        }
        self.is_showing = matches!(next, Some(Ok(_)));
        next
    }
}

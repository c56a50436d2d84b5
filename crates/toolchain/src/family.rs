// SPDX-License-Identifier: MIT OR Apache-2.0
//! A child process and all that it starts: verilator, yosys and iverilog are drivers of other programs.
//!
//! Each family is a process group of its own. An interrupt from the terminal goes to this program alone,
//! which decides how to end, and what ends the group ends every member, whatever started it. Families that
//! have not ended are listed, so that a process that exits at once leaves none behind.

use std::collections::BTreeSet;
use std::io;
use std::process::{Child, Command, ExitStatus};
use std::sync::{Mutex, MutexGuard, PoisonError};

/// The heads of families that nobody has waited for, by their process numbers.
struct FamilyRegistry {
    heads: BTreeSet<u32>,
    /// Whether this process is about to exit, so that no family may start any more.
    is_closed: bool,
}

static LIVING: Mutex<FamilyRegistry> =
    Mutex::new(FamilyRegistry { heads: BTreeSet::new(), is_closed: false });

fn living() -> MutexGuard<'static, FamilyRegistry> {
    LIVING.lock().unwrap_or_else(PoisonError::into_inner)
}

/// Ends every family of this process, and lets no other start: for a process that exits at once.
pub fn end_all_families() {
    let mut living = living();
    living.is_closed = true;
    living.heads.iter().copied().for_each(kill);
}

/// A running child that is the head of a family; the family ends with it.
#[derive(Debug)]
pub(crate) struct Family {
    pub(crate) head: Child,
}

impl Family {
    /// Starts a program as the head of a family.
    pub(crate) fn start(command: &mut Command) -> io::Result<Self> {
        set_apart(command);
        let mut living = living();
        if living.is_closed {
            return Err(io::Error::other("the program is about to end"));
        }
        let head = command.spawn()?;
        living.heads.insert(head.id());
        Ok(Self { head })
    }

    /// The status with which the head has ended, if it has.
    pub(crate) fn try_wait(&mut self) -> io::Result<Option<ExitStatus>> {
        // Once it was waited for, its number may be another's: nobody may read the list in between.
        let mut living = living();
        let ended = self.head.try_wait()?;
        if ended.is_some() {
            living.heads.remove(&self.head.id());
        }
        Ok(ended)
    }

    /// Ends the whole family if its head has not ended by itself, and waits for the head.
    pub(crate) fn end(&mut self) {
        if matches!(self.try_wait(), Ok(None)) {
            self.kill();
            let _ = self.head.wait();
            living().heads.remove(&self.head.id());
        }
    }

    #[cfg(unix)]
    fn kill(&mut self) {
        kill(self.head.id());
    }

    /// Elsewhere there are no process groups, and only the head ends.
    #[cfg(not(unix))]
    fn kill(&mut self) {
        // It can only fail because the process has ended already.
        let _ = self.head.kill();
    }
}

impl Drop for Family {
    fn drop(&mut self) {
        self.end();
    }
}

#[cfg(unix)]
fn set_apart(command: &mut Command) {
    use std::os::unix::process::CommandExt as _;
    command.process_group(0);
}

/// Ends a process group by the number of its head.
#[cfg(unix)]
fn kill(head: u32) {
    use rustix::process::{Pid, Signal, kill_process_group};
    if let Some(group) = i32::try_from(head).ok().and_then(Pid::from_raw) {
        // It can only fail because all have ended already.
        let _ = kill_process_group(group, Signal::KILL);
    }
}

#[cfg(not(unix))]
fn set_apart(_: &mut Command) {}

/// Elsewhere a process cannot be ended by its number alone.
#[cfg(not(unix))]
fn kill(_: u32) {}

// SPDX-License-Identifier: MIT OR Apache-2.0
//! A child process and all processes that it starts; verilator, yosys and iverilog run other
//! programs.
//!
//! Each family is a process group of its own. An interrupt from the terminal therefore reaches only
//! this program, which decides how to end. A signal that ends the group ends every member. Families
//! that have not ended are registered, so that a process that exits at once leaves none of them
//! running.

use std::collections::BTreeSet;
use std::io;
use std::process::{Child, Command, ExitStatus};
use std::sync::{Mutex, MutexGuard, PoisonError};

/// The registered families: the first processes of families that have not been waited for, by
/// process number.
struct ProcessFamilyRegistry {
    leaders: BTreeSet<u32>,
    /// True if this process is about to exit, so that no new family may start.
    is_closed: bool,
}

static REGISTRY: Mutex<ProcessFamilyRegistry> =
    Mutex::new(ProcessFamilyRegistry { leaders: BTreeSet::new(), is_closed: false });

fn locked_registry() -> MutexGuard<'static, ProcessFamilyRegistry> {
    REGISTRY.lock().unwrap_or_else(PoisonError::into_inner)
}

/// Ends every family of this process and refuses new ones. A process that exits at once calls this.
pub fn end_all_process_families() {
    let mut registry = locked_registry();
    registry.is_closed = true;
    registry.leaders.iter().copied().for_each(kill);
}

/// A running child that is the first process of a family. Dropping this value ends the family.
#[derive(Debug)]
pub(crate) struct ProcessFamily {
    pub(crate) leader: Child,
}

impl ProcessFamily {
    /// Starts a program as the first process of a family.
    pub(crate) fn start(command: &mut Command) -> io::Result<Self> {
        set_process_group(command);
        let mut registry = locked_registry();
        if registry.is_closed {
            return Err(io::Error::other("the program is about to end"));
        }
        let leader = command.spawn()?;
        registry.leaders.insert(leader.id());
        Ok(Self { leader })
    }

    /// Returns the status of the first process if it has ended.
    pub(crate) fn try_wait(&mut self) -> io::Result<Option<ExitStatus>> {
        // Once a process has been waited for, the system may reuse its number, so the registry
        // stays locked until the number is removed from it.
        let mut registry = locked_registry();
        let ended = self.leader.try_wait()?;
        if ended.is_some() {
            registry.leaders.remove(&self.leader.id());
        }
        Ok(ended)
    }

    /// Ends the whole family if its first process has not ended by itself, and waits for that
    /// process.
    pub(crate) fn end(&mut self) {
        if matches!(self.try_wait(), Ok(None)) {
            self.kill();
            let _ = self.leader.wait();
            locked_registry().leaders.remove(&self.leader.id());
        }
    }

    #[cfg(unix)]
    fn kill(&mut self) {
        kill(self.leader.id());
    }

    /// Ends only the first process, because other systems have no process groups.
    #[cfg(not(unix))]
    fn kill(&mut self) {
        // An error can only mean that the process has already ended.
        let _ = self.leader.kill();
    }
}

impl Drop for ProcessFamily {
    fn drop(&mut self) {
        self.end();
    }
}

#[cfg(unix)]
fn set_process_group(command: &mut Command) {
    use std::os::unix::process::CommandExt as _;
    command.process_group(0);
}

/// Ends a process group by the number of its first process.
#[cfg(unix)]
fn kill(leader: u32) {
    use rustix::process::{Pid, Signal, kill_process_group};
    if let Some(group) = i32::try_from(leader).ok().and_then(Pid::from_raw) {
        // An error can only mean that all processes have already ended.
        let _ = kill_process_group(group, Signal::KILL);
    }
}

#[cfg(not(unix))]
fn set_process_group(_: &mut Command) {}

/// Does nothing, because other systems cannot end a process by its number alone.
#[cfg(not(unix))]
fn kill(_: u32) {}

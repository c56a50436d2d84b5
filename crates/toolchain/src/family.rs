// SPDX-License-Identifier: MIT OR Apache-2.0
//! A child process and all that it starts: verilator, yosys and iverilog are drivers of other programs.
//!
//! Each family is a process group of its own. An interrupt from the terminal goes to this program alone,
//! which decides how to end, and what ends the group ends every member, whatever started it.

use std::process::{Child, Command};

/// Lets a program that is to be started be the head of a family.
#[cfg(unix)]
pub(crate) fn found(command: &mut Command) {
    use std::os::unix::process::CommandExt as _;
    command.process_group(0);
}

/// Ends a child that was [`found`]ed, and its family, if it has not ended by itself, and waits for it.
#[cfg(unix)]
pub(crate) fn end(child: &mut Child) {
    use rustix::process::{Pid, Signal, kill_process_group};
    // Once it was waited for, its number may be another's.
    if matches!(child.try_wait(), Ok(None)) {
        // It can only fail because all have ended already.
        let _ = kill_process_group(Pid::from_child(child), Signal::KILL);
    }
    let _ = child.wait();
}

/// Elsewhere there are no process groups.
#[cfg(not(unix))]
pub(crate) fn found(_: &mut Command) {}

/// Elsewhere only the child itself ends.
#[cfg(not(unix))]
pub(crate) fn end(child: &mut Child) {
    // Each can only fail because the process has ended already.
    let _ = child.kill();
    let _ = child.wait();
}

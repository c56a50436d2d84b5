// SPDX-License-Identifier: MIT OR Apache-2.0
//! A command that serves a page until a signal comes, and a client that knows its link.
#![cfg(unix)]

use std::io::{BufRead as _, BufReader, Read as _, Write as _};
use std::net::TcpStream;
use std::path::Path;
use std::process::{Child, ChildStderr, Command, Stdio};

use crate::common::foveate_with_signals;

/// A command that has printed its link.
pub(crate) struct ServedCommand {
    child: Child,
    pub(crate) link: String,
    /// The standard error of the command.
    pub(crate) errors: BufReader<ChildStderr>,
}

impl ServedCommand {
    /// Starts the command in `folder`.
    pub(crate) fn start(folder: &Path, args: &[&str]) -> Self {
        Self::start_with_input(folder, args, Stdio::null())
    }

    /// Starts the command in `folder` with `input` as its standard input.
    pub(crate) fn start_with_input(folder: &Path, args: &[&str], input: Stdio) -> Self {
        let mut child = foveate_with_signals()
            .args(args)
            .current_dir(folder)
            .stdin(input)
            .stdout(Stdio::piped())
            .stderr(Stdio::piped())
            .spawn()
            .unwrap();
        let mut link = String::new();
        BufReader::new(child.stdout.take().unwrap()).read_line(&mut link).unwrap();
        let errors = BufReader::new(child.stderr.take().unwrap());
        Self { child, link: link.trim().to_owned(), errors }
    }

    /// Requests a path below the link, and expects the status 200.
    pub(crate) fn assert_serves(&self, what: &str) {
        let (page, _settings) = self.link.split_once('#').unwrap_or((&self.link, ""));
        let (host, token) = page.strip_prefix("http://").unwrap().split_once('/').unwrap();
        let mut browser = TcpStream::connect(host).unwrap();
        write!(browser, "GET /{token}{what} HTTP/1.1\r\nHost: {host}\r\n\r\n").unwrap();
        let mut status = [0; 15];
        browser.read_exact(&mut status).unwrap();
        assert_eq!(&status, b"HTTP/1.1 200 OK");
    }

    /// Returns the memory of the command in KiB; `None` if the system does not provide it.
    pub(crate) fn memory(&self) -> Option<u64> {
        let status = std::fs::read_to_string(format!("/proc/{}/status", self.child.id())).ok()?;
        let line = status.lines().find_map(|line| line.strip_prefix("VmRSS:"))?;
        line.trim().strip_suffix(" kB")?.parse().ok()
    }

    /// Ends the command by a signal. Returns its exit code and its messages since the last read.
    pub(crate) fn stop_with(mut self, signal: &str) -> (Option<i32>, String) {
        let id = self.child.id().to_string();
        let sent = Command::new("kill").args([&format!("-{signal}"), &id]).status().unwrap();
        assert!(sent.success());
        let code = self.child.wait().unwrap().code();
        let mut told = String::new();
        self.errors.read_to_string(&mut told).unwrap();
        (code, told)
    }
}

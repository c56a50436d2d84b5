// SPDX-License-Identifier: MIT OR Apache-2.0
//! The input of a view: a serial port, a file, or something that can be read only once, such as a
//! FIFO.

use std::fs::File;
use std::io::{self, Read};
use std::path::{Path, PathBuf};

use crate::view::{PlayMode, ViewError};

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum InputKind {
    Port,
    File,
    /// A FIFO or standard input.
    OneTime,
}

/// An input that exists.
#[derive(Clone, Debug)]
pub(crate) struct Input {
    path: PathBuf,
    kind: InputKind,
    baud: u32,
}

pub(crate) struct OpenInput {
    pub(crate) reader: Box<dyn Read + Send>,
    /// The port for writing, if the input is a serial port.
    pub(crate) port: Option<File>,
}

impl Input {
    pub(crate) fn find(path: PathBuf, baud: u32) -> Result<Self, ViewError> {
        let kind = if path == Path::new("-") {
            InputKind::OneTime
        } else {
            match std::fs::metadata(&path) {
                Err(source) => return Err(ViewError::Open { path, source }),
                Ok(found) if found.is_dir() => return Err(ViewError::Folder { path }),
                Ok(found) if found.is_file() => InputKind::File,
                Ok(found) if is_device(&found) => InputKind::Port,
                Ok(_) => InputKind::OneTime,
            }
        };
        Ok(Self { path, kind, baud })
    }

    pub(crate) fn is_port(&self) -> bool {
        self.kind == InputKind::Port
    }

    /// Returns true if the input sends at times of its own.
    pub(crate) fn is_live(&self) -> bool {
        self.kind != InputKind::File
    }

    pub(crate) fn name(&self) -> String {
        self.path.display().to_string()
    }

    /// Returns when the frames are shown: as asked, or else by the kind of the input. Fails if an
    /// input that can be read only once is to be repeated.
    pub(crate) fn play_mode(&self, asked: Option<PlayMode>) -> Result<PlayMode, ViewError> {
        match (asked, self.kind) {
            (None, InputKind::File) => Ok(PlayMode::Timed),
            (None, InputKind::Port | InputKind::OneTime) => Ok(PlayMode::AtOnce),
            (Some(PlayMode::Looped), InputKind::Port | InputKind::OneTime) => {
                Err(ViewError::NotRepeatable { path: self.path.clone() })
            }
            (Some(play), _) => Ok(play),
        }
    }

    /// Opens the input. Opening a FIFO waits for a process that writes to it.
    pub(crate) fn open(&self) -> Result<OpenInput, ViewError> {
        let failed = |source| ViewError::Open { path: self.path.clone(), source };
        if self.is_port() {
            return self.open_port();
        }
        let reader: Box<dyn Read + Send> = if self.path == Path::new("-") {
            Box::new(io::stdin())
        } else {
            Box::new(foveate_tools::open_file(&self.path).map_err(failed)?)
        };
        Ok(OpenInput { reader, port: None })
    }

    /// Opens a serial port for raw bytes in both directions, at its rate, and for this process
    /// alone.
    #[cfg(unix)]
    fn open_port(&self) -> Result<OpenInput, ViewError> {
        use rustix::fs::{Mode, OFlags};
        use rustix::termios::{ControlModes, OptionalActions, SpecialCodeIndex};
        use rustix::{fs, io, termios};

        let path = || self.path.clone();
        let failed = |source: io::Errno| ViewError::Open { path: path(), source: source.into() };
        // Without NONBLOCK, a port with open modem lines would not open.
        let flags = OFlags::RDWR | OFlags::NOCTTY | OFlags::CLOEXEC | OFlags::NONBLOCK;
        let port = fs::open(&self.path, flags, Mode::empty()).map_err(failed)?;
        if !termios::isatty(&port) {
            return Err(ViewError::NotASerialPort { path: path() });
        }
        termios::ioctl_tiocexcl(&port).map_err(failed)?;
        let mut modes = termios::tcgetattr(&port).map_err(failed)?;
        modes.make_raw();
        modes.control_modes |= ControlModes::CLOCAL | ControlModes::CREAD;
        modes.control_modes -= ControlModes::CSTOPB | ControlModes::PARENB | ControlModes::CRTSCTS;
        modes.special_codes[SpecialCodeIndex::VMIN] = 1;
        modes.special_codes[SpecialCodeIndex::VTIME] = 0;
        let rate = |source: io::Errno| ViewError::BaudRate {
            path: path(),
            baud: self.baud,
            source: source.into(),
        };
        modes.set_speed(self.baud).map_err(rate)?;
        termios::tcsetattr(&port, OptionalActions::Now, &modes).map_err(rate)?;
        let flags = fs::fcntl_getfl(&port).map_err(failed)?;
        fs::fcntl_setfl(&port, flags - OFlags::NONBLOCK).map_err(failed)?;
        let port = File::from(port);
        let reader = port.try_clone().map_err(|source| ViewError::Open { path: path(), source })?;
        Ok(OpenInput { reader: Box::new(reader), port: Some(port) })
    }

    #[cfg(not(unix))]
    fn open_port(&self) -> Result<OpenInput, ViewError> {
        Err(ViewError::NotASerialPort { path: self.path.clone() })
    }
}

#[cfg(unix)]
fn is_device(found: &std::fs::Metadata) -> bool {
    std::os::unix::fs::FileTypeExt::is_char_device(&found.file_type())
}

#[cfg(not(unix))]
fn is_device(_: &std::fs::Metadata) -> bool {
    false
}

// SPDX-License-Identifier: MIT OR Apache-2.0
//! Sets of small images in one file: IDX (MNIST and similar) and CIFAR. Every image is a first
//! frame.

pub(crate) mod cifar;
pub(crate) mod idx;

use std::io::{self, BufRead, BufReader, Read};
use std::path::Path;

use foveate_tools::{
    GZIP_MAGIC, Interrupt, InterruptibleReader, open_file, open_interruptibly, unpacked,
};

use crate::FootageError;

/// Opens a file, and unpacks it if it is gzipped.
pub(crate) fn open_unpacked(path: &Path) -> Result<Box<dyn BufRead + Send>, FootageError> {
    unpacked(open_file(path).map_err(unreadable(path))?).map_err(unreadable(path))
}

/// Opens a FIFO or another pipe that can be read once.
pub(crate) fn open_pipe(
    path: &Path,
    interrupt: &Interrupt,
) -> Result<Box<dyn BufRead + Send>, FootageError> {
    match open_interruptibly(path, interrupt) {
        Ok(pipe) => Ok(Box::new(BufReader::new(InterruptibleReader::new(pipe, interrupt)))),
        Err(_) if interrupt.is_set() => Err(FootageError::Interrupted),
        Err(error) => Err(unreadable(path)(error)),
    }
}

/// Returns true if a file is gzipped.
fn is_packed(path: &Path) -> Result<bool, FootageError> {
    let mut file = BufReader::new(open_file(path).map_err(unreadable(path))?);
    Ok(file.fill_buf().map_err(unreadable(path))?.starts_with(&GZIP_MAGIC))
}

fn unreadable(path: &Path) -> impl Fn(io::Error) -> FootageError + '_ {
    |error| FootageError::Unreadable { path: path.to_owned(), problem: error.to_string() }
}

/// Returns an error that names the file.
fn damaged(path: &Path, problem: impl Into<String>) -> FootageError {
    FootageError::DataSet { path: path.to_owned(), problem: problem.into() }
}

fn compressed_data_error(path: &Path) -> impl Fn(io::Error) -> FootageError + '_ {
    |error| match error.kind() {
        io::ErrorKind::UnexpectedEof => damaged(path, "its compressed data have no end"),
        _ => damaged(path, format!("its compressed data are damaged ({error})")),
    }
}

/// Reads to the end of a file, after which nothing may be left. A gzipped file has its checksum
/// there.
fn expect_end(input: &mut dyn BufRead, path: &Path, after: &str) -> Result<(), FootageError> {
    let left = io::copy(&mut input.take(u64::MAX), &mut io::sink())
        .map_err(compressed_data_error(path))?;
    if left > 0 {
        return Err(damaged(
            path,
            format!("{left} bytes follow {after} that its header announces"),
        ));
    }
    Ok(())
}

// SPDX-License-Identifier: MIT OR Apache-2.0
//! Reads files from untrusted sources up to a limit.
//!
//! A small file has a limit of bytes ([`read_text`], [`read_bytes`]). A table has a limit of bytes
//! per record ([`table_reader`]), so that a table of any length can be read, but one endless record
//! cannot take all memory. A reader of a whole document has a limit of bytes, too
//! ([`LimitedReader`]), which also holds behind [`unpacked`], for files that may be gzipped.
//! Reaching a limit is a distinct error and never looks like the end of a file.
//!
//! The errors are [`io::Error`]s of the kind [`io::ErrorKind::FileTooLarge`] or
//! [`io::ErrorKind::InvalidData`]; the caller adds the name of the file.
//!
//! [`io::Error`]: std::io::Error
//! [`io::ErrorKind::FileTooLarge`]: std::io::ErrorKind::FileTooLarge
//! [`io::ErrorKind::InvalidData`]: std::io::ErrorKind::InvalidData

mod file;
mod foreign_format;
mod size_text;
mod table;

pub use file::{
    GZIP_MAGIC, LimitedReader, SETTINGS_LIMIT, open_file, read_bytes, read_settings, read_text,
    settings_from, unpacked,
};
pub use foreign_format::foreign_format;
pub use table::{RECORD_LIMIT, TableReader, TableRecords, table_reader};

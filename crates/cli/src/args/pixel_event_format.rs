// SPDX-License-Identifier: MIT OR Apache-2.0
//! The formats of pixel events as values of the command line.

use std::ffi::OsStr;

use clap::builder::{EnumValueParser, PossibleValue, TypedValueParser};
use clap::error::ErrorKind;
use clap::{Arg, Command, Error, ValueEnum};

#[derive(Clone, Copy, Debug, PartialEq, ValueEnum)]
pub(crate) enum PixelEventFormat {
    /// Compressed arrays of NumPy, with the fields of tonic
    Npz,
    Csv,
    /// EVT 2.0, for frames of at most 2048x2048 pixels
    Evt2,
    /// EVT 3.0, for frames of at most 2048x2048 pixels
    Evt3,
    /// AEDAT4, compressed with LZ4
    Aedat4,
}

/// Reads the name of a format. HDF5 is refused with the way to it.
#[derive(Clone, Copy, Debug)]
pub(super) struct PixelEventFormatParser;

impl TypedValueParser for PixelEventFormatParser {
    type Value = PixelEventFormat;

    fn parse_ref(
        &self,
        command: &Command,
        argument: Option<&Arg>,
        value: &OsStr,
    ) -> Result<PixelEventFormat, Error> {
        let is_hdf5 = |name: &&str| value.eq_ignore_ascii_case(name);
        if let Some(name) = ["hdf5", "h5", "dsec"].iter().find(|name| is_hdf5(name)) {
            let message = format!(
                "the command writes no HDF5, so --pixel-events={name} is not possible; write npz, and `write_dsec` of \
                 the Python package makes a file like those of DSEC of its events\n"
            );
            return Err(Error::raw(ErrorKind::ValueValidation, message).with_cmd(command));
        }
        EnumValueParser::new().parse_ref(command, argument, value)
    }

    fn possible_values(&self) -> Option<Box<dyn Iterator<Item = PossibleValue> + '_>> {
        let values = PixelEventFormat::value_variants().iter();
        Some(Box::new(values.filter_map(ValueEnum::to_possible_value)))
    }
}

//! The forms of results: arrays and tables as files, reports as text, colours by meaning, charts and
//! pages. The crate does not depend on the meaning of the data.

pub mod chart;
pub mod lettering;
pub mod npy;
pub mod number_text;
pub mod page;
pub mod palette;
pub mod report;
pub mod tables;
mod xml_text;

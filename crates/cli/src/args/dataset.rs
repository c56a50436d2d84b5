// SPDX-License-Identifier: MIT OR Apache-2.0
//! The options of `dataset`.

use std::path::PathBuf;

use clap::Args;

use super::DesignArgs;
use super::input::InputArgs;
use super::threads::ThreadArgs;

/// Turn a data set into one that shows only active regions, in the same format, with labels and
/// tags
#[derive(Args, Debug)]
#[command(after_help = "Examples: foveate dataset train-images-idx3-ubyte.gz -o regions
          foveate dataset photos/ -o regions --preset steady --resize 224x224
          foveate dataset data_batch_1.bin data_batch_2.bin -o regions")]
pub(crate) struct DatasetArgs {
    /// IDX or CIFAR files, images, or a folder of images whose sub-folders are labels. Each file of
    /// many images, and each folder, becomes a data set of its own
    #[arg(value_name = "INPUT", required = true)]
    pub(crate) inputs: Vec<String>,
    #[command(flatten)]
    pub(crate) design: DesignArgs,
    /// Folder to write
    #[arg(long, short, value_name = "DIR")]
    pub(crate) output: PathBuf,
    /// Replace the folder if it holds a data set or a simulation
    #[arg(long)]
    pub(crate) force: bool,
    /// Print the summary as JSON
    #[arg(long)]
    pub(crate) json: bool,
    /// Show no progress and no summary
    #[arg(long, short)]
    pub(crate) quiet: bool,
    #[command(flatten)]
    pub(crate) threads: ThreadArgs,
    /// The options for reading the inputs. They are last, because clap lists later options under
    /// their heading.
    #[command(flatten)]
    pub(crate) input: InputArgs,
}

// SPDX-License-Identifier: MIT OR Apache-2.0
//! The boxes of a file, by frame.
//!
//! MOT files go by the number of a frame. It is the number in the name of the image file
//! (`000012.jpg`), as in every MOT sequence. Frames without such a name are numbered from 1 in
//! their order in the input, and frames that are not selected count, too. All other formats go by
//! the name of the image. The name in the file may have folders: it fits an image whose path ends
//! with it.

use std::collections::{BTreeMap, HashMap};
use std::path::{Path, PathBuf};
use std::sync::{Mutex, PoisonError};

use super::error::BoxError;
use super::format::{Format, coco, mot, table, yolo};
use super::labelled::Labelled;
use super::name::endings;
use super::view::View;
use crate::{Crop, Origin, SourceFrame};
use foveate_frame::Rect;

/// The properties of a frame by which its boxes are found.
#[derive(Clone, Copy, Debug)]
pub struct Place<'a> {
    /// The path of the frame's file, or another name.
    pub name: &'a Path,
    /// `name` is the path of a file that holds only this frame.
    pub own_file: bool,
    /// The number of the frame in the input, counted from 0.
    pub number: u64,
    /// The width and height of the frame before it is cropped and scaled.
    pub size: (u32, u32),
}

impl<'a> Place<'a> {
    /// Makes the key of a frame that a source returned with this origin.
    #[must_use]
    pub fn of(frame: &'a SourceFrame, origin: &Origin) -> Self {
        let name = Path::new(&frame.name);
        Self { name, own_file: origin.own_file, number: origin.number, size: origin.size }
    }
}

/// The boxes of a frame, or `None` if the file has no entry for it.
pub type Found = Option<Vec<Labelled>>;

/// The boxes of a file or folder.
#[derive(Debug)]
pub struct Boxes {
    path: PathBuf,
    format: Format,
    entries: Entries,
    /// The image that took the boxes of each name.
    taken: Mutex<HashMap<String, PathBuf>>,
}

#[derive(Debug)]
enum Entries {
    Numbers(BTreeMap<u64, Vec<Labelled>>),
    Names(HashMap<String, Vec<Labelled>>),
    /// The entries are files of a folder, which are read when an image needs them.
    Folder,
}

impl Boxes {
    /// Reads a file, or opens a folder of YOLO files without reading them.
    ///
    /// # Errors
    /// Fails if the file cannot be read. The message names the file, and the line if the format has
    /// lines.
    pub fn read(path: &Path) -> Result<Self, BoxError> {
        let format = Format::of(path)?;
        let entries = match format {
            Format::Mot => Entries::Numbers(mot::read(path)?),
            Format::Coco => Entries::Names(coco::read(path)?),
            Format::Csv => Entries::Names(table::read(path)?),
            Format::Yolo => Entries::Folder,
        };
        Ok(Self { path: path.to_owned(), format, entries, taken: Mutex::default() })
    }

    /// Returns the path of the file or folder.
    #[must_use]
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// Returns the format.
    #[must_use]
    pub fn format(&self) -> Format {
        self.format
    }

    /// Returns true if the boxes go by frame numbers and therefore belong to one clip.
    #[must_use]
    pub fn are_of_one_clip(&self) -> bool {
        matches!(self.entries, Entries::Numbers(_))
    }

    /// Returns the boxes of a frame.
    ///
    /// # Errors
    /// Fails if a file of a YOLO folder cannot be read, a name fits two images, or an image has the
    /// number 0 although frames are numbered from 1.
    pub fn at(&self, place: &Place<'_>) -> Result<Found, BoxError> {
        match &self.entries {
            Entries::Numbers(frames) => Ok(frames.get(&self.number(place)?).cloned()),
            Entries::Names(images) => {
                let found = endings(place.name)
                    .into_iter()
                    .find_map(|name| images.get(&name).map(|boxes| (name, boxes.clone())));
                found.map(|(name, boxes)| self.take(name, place).map(|()| boxes)).transpose()
            }
            Entries::Folder => {
                let Some(file) = yolo::file_of(&self.path, &endings(place.name)) else {
                    return Ok(None);
                };
                self.take(file.display().to_string(), place)?;
                yolo::read(&file, place.size).map(Some)
            }
        }
    }

    /// Returns the rectangles of a frame's objects in the frame as it is cropped and scaled,
    /// without those that lie mostly outside. Returns `None` if the file has no entry for the
    /// frame.
    ///
    /// # Errors
    /// The errors are those of [`Boxes::at`].
    pub fn objects(
        &self,
        frame: &SourceFrame,
        origin: &Origin,
        crop: Option<Crop>,
    ) -> Result<Option<Vec<Rect>>, BoxError> {
        let view = View::of(frame, origin, crop);
        let found = self.at(&Place::of(frame, origin))?;
        Ok(found.map(|found| found.iter().filter_map(|one| view.see(&one.rect)).collect()))
    }

    /// Returns the error for a clip of which no frame has an entry.
    #[must_use]
    pub fn none_fit(&self, clip: &str) -> BoxError {
        let first = match &self.entries {
            Entries::Numbers(frames) => frames.keys().next().map(|frame| format!("frame {frame}")),
            Entries::Names(images) => images.keys().min().map(|name| format!("`{name}`")),
            Entries::Folder => None,
        };
        let holds = match (&self.entries, first) {
            (_, Some(first)) => format!("begins with {first}"),
            (Entries::Folder, _) => "needs a file for each, with its name and .txt".to_owned(),
            _ => "has none at all".to_owned(),
        };
        BoxError::NoneFit { path: self.path.clone(), clip: clip.to_owned(), holds }
    }

    /// Returns the number of a frame, counted from 1.
    fn number(&self, place: &Place<'_>) -> Result<u64, BoxError> {
        let stem = place.name.file_stem().and_then(|stem| stem.to_str());
        let digits = stem.filter(|stem| stem.bytes().all(|byte| byte.is_ascii_digit()));
        match digits.filter(|_| place.own_file).and_then(|digits| digits.parse().ok()) {
            Some(0) => {
                let (path, image) = (self.path.clone(), place.name.to_owned());
                Err(BoxError::FrameZero { path, image })
            }
            Some(number) => Ok(number),
            None => Ok(place.number + 1),
        }
    }

    /// Assigns the boxes of a name to an image, unless another image has them.
    fn take(&self, name: String, place: &Place<'_>) -> Result<(), BoxError> {
        let mut taken = self.taken.lock().unwrap_or_else(PoisonError::into_inner);
        let owner = taken.entry(name.clone()).or_insert_with(|| place.name.to_owned());
        if owner == place.name {
            return Ok(());
        }
        let mut both = [owner.clone(), place.name.to_owned()];
        both.sort();
        let [one, other] = both;
        Err(BoxError::Ambiguous { path: self.path.clone(), name, one, other })
    }
}

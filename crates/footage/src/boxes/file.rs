// SPDX-License-Identifier: MIT OR Apache-2.0
//! The boxes of a file, by frames.
//!
//! MOT files go by the number of a frame. It is the number that the image file has as its name (`000012.jpg`),
//! as in every such set; frames without such a name are counted from 1 in their order in the input, also those
//! that are not seen. All other formats go by the name of the image. The name in the file may have folders: it
//! fits an image whose path ends with it.

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

/// A frame, as boxes are found for it.
#[derive(Clone, Copy, Debug)]
pub struct Place<'a> {
    /// The path of its file, or another name.
    pub name: &'a Path,
    /// Whether that is a file of its own.
    pub own_file: bool,
    /// Its number in the input, from 0.
    pub number: u64,
    /// Width and height before it is cropped and scaled.
    pub size: (u32, u32),
}

impl<'a> Place<'a> {
    /// Of a frame that a source gave from this place in its input.
    #[must_use]
    pub fn of(frame: &'a SourceFrame, origin: &Origin) -> Self {
        let name = Path::new(&frame.name);
        Self { name, own_file: origin.own_file, number: origin.number, size: origin.size }
    }
}

/// The boxes of a frame; `None` if the file has no entry for it.
pub type Found = Option<Vec<Labelled>>;

/// The boxes of a file or folder.
#[derive(Debug)]
pub struct Boxes {
    path: PathBuf,
    format: Format,
    entries: Entries,
    /// Which image took the boxes of a name.
    taken: Mutex<HashMap<String, PathBuf>>,
}

#[derive(Debug)]
enum Entries {
    Numbers(BTreeMap<u64, Vec<Labelled>>),
    Names(HashMap<String, Vec<Labelled>>),
    /// Read when an image asks for them.
    Folder,
}

impl Boxes {
    /// Reads a file, or looks at a folder of YOLO files.
    ///
    /// # Errors
    /// When it cannot be read; the message names the file and, where there are lines, the line.
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

    /// The file or folder.
    #[must_use]
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// Its format.
    #[must_use]
    pub fn format(&self) -> Format {
        self.format
    }

    /// Whether they belong to one clip, because they go by numbers of frames.
    #[must_use]
    pub fn are_of_one_clip(&self) -> bool {
        matches!(self.entries, Entries::Numbers(_))
    }

    /// The boxes of a frame.
    ///
    /// # Errors
    /// When a file of a YOLO folder cannot be read, a name fits two images, or an image has the number 0 where
    /// frames begin at 1.
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

    /// Where the objects of a frame lie in it, cropped and scaled as it is, without those that lie mostly outside; `None` if there is no entry for it.
    ///
    /// # Errors
    /// As [`Boxes::at`].
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

    /// What to say where no frame of a clip has an entry.
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

    /// The number of a frame, from 1.
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

    /// Gives the boxes of a name to an image, unless another has them.
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

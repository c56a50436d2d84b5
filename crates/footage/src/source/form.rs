// SPDX-License-Identifier: MIT OR Apache-2.0
//! What a set is as files, so that a set made of it can have the same form.

/// The files and the labels of a set.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct SetForm {
    /// What holds the images.
    pub files: SetFiles,
    /// What the labels are.
    pub labels: Labels,
}

/// What holds the images of a set.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub enum SetFiles {
    /// A file each.
    #[default]
    Images,
    /// Records in another file, without names of their own.
    Records,
    /// An IDX file, and one of labels.
    Idx {
        /// The images.
        images: IdxFile,
        /// The labels, if there are any.
        labels: Option<IdxFile>,
    },
}

/// An IDX file.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct IdxFile {
    /// Its name, without the folder.
    pub name: String,
    /// Whether it is gzipped.
    pub packed: bool,
}

/// What the labels of a set are.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub enum Labels {
    /// There are none.
    #[default]
    None,
    /// Numbers as they are.
    Numbers,
    /// Names, each once and in byte order; a label's number is its place here.
    Names(Vec<String>),
}

impl Labels {
    /// The number of a label; -1 for none.
    #[must_use]
    pub fn number(&self, label: Option<&str>) -> i64 {
        let number = label.and_then(|label| match self {
            Self::None => None,
            Self::Numbers => label.parse().ok(),
            Self::Names(names) => {
                let place = names.binary_search_by(|name| name.as_str().cmp(label)).ok()?;
                i64::try_from(place).ok()
            }
        });
        number.unwrap_or(-1)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn labels_have_numbers() {
        let names = Labels::Names(vec!["ant".to_owned(), "bee".to_owned()]);
        assert_eq!([Some("bee"), Some("cat"), None].map(|label| names.number(label)), [1, -1, -1]);
        assert_eq!(Labels::Numbers.number(Some("42")), 42);
        assert_eq!(Labels::None.number(Some("42")), -1);
    }
}

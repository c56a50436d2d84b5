// SPDX-License-Identifier: MIT OR Apache-2.0
//! Checks whether programs may be run from a folder: only this user and root may be able to put
//! files there. The folder and every folder above it are checked from the top down, so no other
//! user can change a folder that was checked. Links are resolved before the checks, and never
//! again.

use std::path::{Path, PathBuf};

use crate::error::ToolError;

/// Returns the path of the cache without links, and creates the folder if it is missing. The path
/// is checked on every use.
///
/// # Errors
/// Fails if the folder cannot be created, or if other users can write to it.
pub(super) fn open_root(root: &Path) -> Result<PathBuf, ToolError> {
    let failed = ToolError::cache("create", root);
    // This check comes before anything is created, because the place may belong to another user.
    let existing = root.ancestors().find(|folder| folder.exists()).unwrap_or(root);
    check(root, &existing.canonicalize().map_err(failed)?, existing == root)?;
    create_private_folder(root).map_err(ToolError::cache("create", root))?;
    let place = root.canonicalize().map_err(ToolError::cache("use", root))?;
    check(root, &place, true)?;
    Ok(place)
}

/// Creates a folder that only its owner can enter, and those above it.
fn create_private_folder(root: &Path) -> std::io::Result<()> {
    let mut builder = std::fs::DirBuilder::new();
    builder.recursive(true);
    #[cfg(unix)]
    std::os::unix::fs::DirBuilderExt::mode(&mut builder, 0o700);
    builder.create(root)
}

#[cfg(not(unix))]
fn check(_: &Path, _: &Path, _: bool) -> Result<(), ToolError> {
    Ok(())
}

/// Returns true, because on other systems the metadata of a folder do not tell who can write to it.
#[cfg(not(unix))]
pub(super) fn is_entry(_: &Path, _: &str) -> bool {
    true
}

#[cfg(unix)]
use unix::check;
#[cfg(unix)]
pub(super) use unix::is_entry;

#[cfg(unix)]
mod unix {
    use std::fs::{Metadata, symlink_metadata};
    use std::os::unix::fs::MetadataExt as _;
    use std::path::Path;

    use crate::error::ToolError;

    const GROUP: u32 = 0o020;
    const ALL: u32 = 0o002;
    /// The sticky bit. In a folder with it, a user who is neither the owner nor root cannot rename
    /// the entries of others.
    const STICKY: u32 = 0o1000;

    /// Fails if other users can put files into a place, whose path has no links. `root` is the path
    /// that the user gave for the cache, and `is_cache` says whether the place is the cache or a
    /// folder above it.
    pub(super) fn check(root: &Path, place: &Path, is_cache: bool) -> Result<(), ToolError> {
        let mut above: Vec<&Path> = place.ancestors().collect();
        above.reverse();
        for folder in above {
            let about = symlink_metadata(folder).map_err(ToolError::cache("use", folder))?;
            let may_be_shared = !is_cache || folder != place;
            if let Some((reason, advice)) = refusal_reason(folder, &about, may_be_shared) {
                return Err(ToolError::Untrusted { path: root.to_owned(), reason, advice });
            }
        }
        Ok(())
    }

    /// Returns why other users can write to a folder, and the remedy; `None` if they cannot. Above
    /// the cache, folders that everybody can write to are accepted if they are sticky, such as
    /// `/tmp`.
    fn refusal_reason(
        folder: &Path,
        metadata: &Metadata,
        may_be_shared: bool,
    ) -> Option<(String, String)> {
        let name = folder.display();
        let other_folder_advice = "set FOVEATE_CACHE to a folder of your own, or to `off`";
        if !is_trusted(metadata.uid()) {
            let reason = format!("`{name}` belongs to another user (uid {})", metadata.uid());
            return Some((reason, other_folder_advice.to_owned()));
        }
        let who = match metadata.mode() {
            mode if may_be_shared && mode & STICKY != 0 => return None,
            mode if mode & ALL != 0 => "everybody",
            mode if mode & GROUP != 0 => "its group",
            _ => return None,
        };
        let reason = format!("{who} may write to `{name}`");
        Some((reason, format!("run `chmod go-w '{name}'`, or {other_folder_advice}")))
    }

    /// Returns whether other users are unable to change the file of an entry.
    pub(in super::super) fn is_entry(place: &Path, artifact: &str) -> bool {
        let Ok(folder) = symlink_metadata(place) else { return false };
        let is_private = folder.mode() & 0o077 == 0;
        let is_safe = |metadata: &Metadata| {
            is_trusted(metadata.uid()) && (is_private || metadata.mode() & (GROUP | ALL) == 0)
        };
        let file = symlink_metadata(place.join(artifact));
        folder.is_dir() && is_safe(&folder) && file.is_ok_and(|metadata| is_safe(&metadata))
    }

    fn is_trusted(user: u32) -> bool {
        user == 0 || user == rustix::process::geteuid().as_raw()
    }
}

#[cfg(unix)]
#[cfg(test)]
mod tests {
    use super::*;
    use std::fs::{self, Permissions};
    use std::os::unix::fs::{MetadataExt as _, PermissionsExt as _, chown, symlink};

    /// The id of another user.
    const OTHER: u32 = 54_321;

    fn set_mode(path: &Path, mode: u32) {
        fs::set_permissions(path, Permissions::from_mode(mode)).unwrap();
    }

    fn refusal_text(root: &Path) -> String {
        let error = open_root(root).unwrap_err();
        assert!(error.is_environment(), "{error:?}");
        error.to_string()
    }

    #[test]
    fn a_folder_that_is_made_is_private_and_accepted() {
        let dir = tempfile::tempdir().unwrap();
        let root = dir.path().join("a/b");
        assert_eq!(open_root(&root).unwrap(), root.canonicalize().unwrap());
        for made in [&root, &dir.path().join("a")] {
            assert_eq!(fs::metadata(made).unwrap().mode() & 0o7777, 0o700);
        }
        set_mode(&root, 0o755);
        open_root(&root).unwrap();
    }

    #[test]
    fn folders_that_others_may_write_are_refused() {
        let dir = tempfile::tempdir().unwrap();
        let (above, root) = (dir.path().join("above"), dir.path().join("above/cache"));
        fs::create_dir_all(&root).unwrap();
        for (mode, who) in [(0o770, "its group"), (0o777, "everybody"), (0o1777, "everybody")] {
            set_mode(&root, mode);
            let text = refusal_text(&root);
            let expected = format!("{who} may write to `{}`; run `chmod go-w", root.display());
            assert!(text.contains(&expected), "{mode:o}: {text}");
        }
        set_mode(&root, 0o700);
        for (mode, is_refused) in [(0o775, true), (0o777, true), (0o1777, false), (0o755, false)] {
            set_mode(&above, mode);
            assert_eq!(open_root(&root).is_err(), is_refused, "{mode:o}");
            // Nothing is created in the folder either.
            assert_eq!(open_root(&above.join("new/cache")).is_err(), is_refused, "{mode:o}");
            assert_eq!(above.join("new").exists(), !is_refused, "{mode:o}");
            let _ = fs::remove_dir_all(above.join("new"));
        }
    }

    #[test]
    fn folders_of_others_are_refused() {
        let dir = tempfile::tempdir().unwrap();
        let (above, root) = (dir.path().join("above"), dir.path().join("above/cache"));
        fs::create_dir_all(&root).unwrap();
        if chown(&root, Some(OTHER), None).is_err() {
            return crate::testing::report_skip("only root can give a folder away");
        }
        let text = refusal_text(&root);
        assert!(
            text.contains(&format!("`{}` belongs to another user (uid 54321)", root.display()))
        );
        assert!(text.contains("set FOVEATE_CACHE to a folder of your own, or to `off`"), "{text}");
        chown(&root, Some(0), None).unwrap();
        open_root(&root).unwrap();
        chown(&above, Some(OTHER), None).unwrap();
        assert!(refusal_text(&root).contains(&format!("`{}` belongs", above.display())));
        // A link of another user leads to a good folder, which is used by its own path.
        let link = dir.path().join("link");
        let good = dir.path().join("good");
        fs::create_dir(&good).unwrap();
        symlink(&good, &link).unwrap();
        std::os::unix::fs::lchown(&link, Some(OTHER), None).unwrap();
        assert_eq!(open_root(&link).unwrap(), good.canonicalize().unwrap());
    }

    #[test]
    fn entries_that_others_could_change_are_not_used() {
        let dir = tempfile::tempdir().unwrap();
        let (place, file) = (dir.path().join("entry"), dir.path().join("entry/program"));
        fs::create_dir(&place).unwrap();
        fs::write(&file, "").unwrap();
        for (folder, program, is_used) in [
            (0o755, 0o755, true),
            (0o700, 0o777, true),
            (0o775, 0o755, false),
            (0o757, 0o755, false),
            (0o755, 0o775, false),
        ] {
            set_mode(&place, folder);
            set_mode(&file, program);
            assert_eq!(is_entry(&place, "program"), is_used, "{folder:o} {program:o}");
        }
        set_mode(&place, 0o755);
        set_mode(&file, 0o755);
        for path in [&file, &place] {
            if chown(path, Some(OTHER), None).is_ok() {
                assert!(!is_entry(&place, "program"));
                chown(path, Some(0), None).unwrap();
            }
        }
    }
}

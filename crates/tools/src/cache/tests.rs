// SPDX-License-Identifier: MIT OR Apache-2.0
//! Tests of builds, entries, their removal, and two processes.

use std::process::Command;
use std::sync::atomic::{AtomicU32, Ordering};
use std::time::{Duration, SystemTime};

use super::size_limit::STALE_AGE;
use super::*;
use crate::testing::MockHost;

fn key(text: &str) -> CacheKey {
    CacheKey::builder("test").field("text", text).finish()
}

fn entries(cache: &Cache) -> Vec<String> {
    let names = fs::read_dir(cache.root()).unwrap();
    names.map(|entry| entry.unwrap().file_name().into_string().unwrap()).collect()
}

fn fill(dir: &Path) -> Result<(), ToolError> {
    fs::write(dir.join("file"), "built").map_err(ToolError::io("write", dir))
}

#[test]
fn builds_once_per_key() {
    let cache = Cache::temporary().unwrap();
    let count = AtomicU32::new(0);
    for text in ["a", "a", "b", "a"] {
        let path = cache.get_or_build(&key(text), "file", |dir| {
            count.fetch_add(1, Ordering::Relaxed);
            fill(dir)
        });
        assert_eq!(fs::read_to_string(path.unwrap()).unwrap(), "built");
    }
    assert_eq!(count.into_inner(), 2);
    assert_eq!(entries(&cache).len(), 2);
}

#[test]
fn simultaneous_builds_of_one_key_agree() {
    let cache = Cache::temporary().unwrap();
    let barrier = std::sync::Barrier::new(4);
    std::thread::scope(|scope| {
        for _ in 0..4 {
            scope.spawn(|| {
                let path = cache.get_or_build(&key("same"), "file", |dir| {
                    barrier.wait();
                    fill(dir)
                });
                assert!(path.unwrap().is_file());
            });
        }
    });
    assert_eq!(entries(&cache), [key("same").as_str()]);
}

#[test]
fn a_failed_build_leaves_only_its_log() {
    let folder = tempfile::tempdir().unwrap();
    let cache = Cache::in_folder(folder.path()).unwrap();
    let error = cache.get_or_build(&key("bad"), "file", |dir| {
        fill(dir)?;
        Err(ToolError::Failed {
            command: "cc".into(),
            status: "exit status: 1".into(),
            tail: "end".into(),
            full: "start\nend".into(),
            log: None,
        })
    });
    let Err(ToolError::Failed { log: Some(log), .. }) = error else { panic!("{error:?}") };
    assert_eq!(fs::read_to_string(log).unwrap(), "$ cc\nstart\nend\nexit status: 1\n");
    assert_eq!(entries(&cache), ["logs"]);
}

#[test]
fn a_damaged_entry_is_built_again() {
    let cache = Cache::temporary().unwrap();
    let path = cache.get_or_build(&key("x"), "file", fill).unwrap();
    fs::remove_file(&path).unwrap();
    assert!(cache.get_or_build(&key("x"), "file", fill).unwrap().is_file());
}

#[test]
fn the_folder_follows_the_environment() {
    let root = |host: MockHost| Cache::from_host(&host).unwrap().root().to_owned();
    let home = || MockHost::new().variable("HOME", "/home/me");
    assert_eq!(root(home()), Path::new("/home/me/.cache/foveate"));
    let xdg = || home().variable("XDG_CACHE_HOME", "/xdg");
    assert_eq!(root(xdg()), Path::new("/xdg/foveate"));
    assert_eq!(root(xdg().variable("FOVEATE_CACHE", "/mine")), Path::new("/mine"));
    assert!(root(xdg().variable("FOVEATE_CACHE", "off")).starts_with(std::env::temp_dir()));
    assert!(matches!(Cache::from_host(&MockHost::new()), Err(ToolError::NoCacheFolder)));
}

#[test]
fn remains_of_killed_builds_are_removed() {
    let folder = tempfile::tempdir().unwrap();
    let cache = Cache::in_folder(folder.path()).unwrap();
    let [old, new] = ["old", "new"].map(|name| cache.root().join(format!(".building-{name}")));
    fs::create_dir(&old).unwrap();
    fs::create_dir(&new).unwrap();
    let past = SystemTime::now() - STALE_AGE - Duration::from_secs(60);
    fs::File::open(&old).unwrap().set_modified(past).unwrap();
    cache.get_or_build(&key("x"), "file", fill).unwrap();
    assert!(!old.exists() && new.exists());
}

#[test]
fn a_folder_that_cannot_be_created_is_an_environment_error() {
    let error = Cache::in_folder(Path::new("/proc/none/foveate")).unwrap();
    let error = error.get_or_build(&key("x"), "file", fill).unwrap_err();
    assert!(error.is_environment(), "{error:?}");
    let text = error.to_string();
    assert!(text.starts_with("cannot create `/proc/none/foveate`"), "{text}");
    assert!(text.contains("set FOVEATE_CACHE to a writable folder"), "{text}");
}

#[test]
fn a_throw_away_cache_goes_away() {
    let cache = Cache::temporary().unwrap();
    let path = cache.get_or_build(&key("x"), "file", fill).unwrap();
    drop(cache.clone());
    assert!(path.is_file());
    drop(cache);
    assert!(!path.exists());
}

fn build_of_size(bytes: usize) -> impl FnOnce(&Path) -> Result<(), ToolError> {
    move |dir| fs::write(dir.join("file"), vec![7; bytes]).map_err(ToolError::io("write", dir))
}

fn limited_cache(root: &Path, bytes: u64) -> Cache {
    Cache { limit: SizeLimit(Some(bytes)), ..Cache::in_folder(root).unwrap() }
}

/// Sets the time of use of an entry back by this number of hours.
fn set_age(cache: &Cache, name: &str, hours: u64) {
    let past = SystemTime::now() - Duration::from_secs(3600 * hours);
    let folder = fs::File::open(cache.root().join(key(name).as_str())).unwrap();
    folder.set_modified(past).unwrap();
}

fn presence(cache: &Cache, names: &[&str]) -> Vec<bool> {
    names.iter().map(|name| cache.contains(&key(name), "file")).collect()
}

#[cfg(unix)]
#[test]
fn the_least_recently_used_entry_is_removed_first() {
    let folder = tempfile::tempdir().unwrap();
    let cache = limited_cache(folder.path(), 10_000);
    for (name, hours) in [("a", 4), ("b", 3), ("c", 2)] {
        cache.get_or_build(&key(name), "file", build_of_size(3000)).unwrap();
        set_age(&cache, name, hours);
    }
    assert_eq!(presence(&cache, &["a", "b", "c"]), [true, true, true]);
    // Entry `a` is used again, so only the entry that is built now is younger.
    cache.get_or_build(&key("a"), "file", |_| panic!("it is there")).unwrap();
    cache.get_or_build(&key("d"), "file", build_of_size(3000)).unwrap();
    assert_eq!(presence(&cache, &["a", "b", "c", "d"]), [true, false, true, true]);
}

#[test]
fn entries_of_the_last_hours_stay() {
    let folder = tempfile::tempdir().unwrap();
    let cache = limited_cache(folder.path(), 10_000);
    for name in ["a", "b", "c"] {
        cache.get_or_build(&key(name), "file", build_of_size(6000)).unwrap();
        set_age(&cache, name, 1);
    }
    assert_eq!(presence(&cache, &["a", "b", "c"]), [true, true, true]);
    set_age(&cache, "b", 3);
    cache.get_or_build(&key("d"), "file", build_of_size(6000)).unwrap();
    assert_eq!(presence(&cache, &["a", "b", "c", "d"]), [true, false, true, true]);
    // Nothing is left beside the entries.
    assert_eq!(entries(&cache).len(), 3);
}

#[cfg(unix)]
#[test]
fn only_files_of_the_cache_are_removed() {
    let folder = tempfile::tempdir().unwrap();
    let [mine, hidden] = ["thesis", ".ssh"].map(|name| folder.path().join(name));
    for foreign in [&mine, &hidden] {
        fs::create_dir(foreign).unwrap();
        fs::write(foreign.join("file"), vec![1; 50_000]).unwrap();
        fs::File::open(foreign).unwrap().set_modified(SystemTime::UNIX_EPOCH).unwrap();
    }
    fs::write(folder.path().join("notes-0123.txt"), "notes").unwrap();
    let cache = limited_cache(folder.path(), 10_000);
    for name in ["a", "b", "c"] {
        cache.get_or_build(&key(name), "file", build_of_size(6000)).unwrap();
        set_age(&cache, name, 3);
    }
    assert_eq!(presence(&cache, &["a", "b", "c"]), [false, false, true]);
    assert!(mine.join("file").is_file() && hidden.join("file").is_file());
    assert!(folder.path().join("notes-0123.txt").is_file());
}

#[test]
fn old_logs_count_too() {
    let folder = tempfile::tempdir().unwrap();
    let cache = limited_cache(folder.path(), 10_000);
    fs::create_dir(folder.path().join("logs")).unwrap();
    let log = folder.path().join("logs").join(format!("{}.log", key("bad")));
    fs::write(&log, vec![b'x'; 20_000]).unwrap();
    fs::File::options()
        .write(true)
        .open(&log)
        .unwrap()
        .set_modified(SystemTime::UNIX_EPOCH)
        .unwrap();
    cache.get_or_build(&key("a"), "file", build_of_size(100)).unwrap();
    assert!(!log.exists());
    assert_eq!(presence(&cache, &["a"]), [true]);
}

const WORKER: &str = "FOVEATE_TEST_WORKER";
const WORKER_LIMIT: u64 = 40_000;

/// Builds and uses entries, all of which are old at once, so that each of two workers removes what
/// the other uses. An entry that vanishes is built again.
fn use_entries(root: &Path, worker: u32) {
    for round in 0..300 {
        // A new cache makes room after its first build.
        let cache = limited_cache(root, WORKER_LIMIT);
        let name = ((worker * 7 + round * 5) % 12).to_string();
        let path = cache.get_or_build(&key(&name), "file", build_of_size(9000)).unwrap();
        match fs::read(path) {
            Ok(bytes) => assert_eq!(bytes.len(), 9000, "an entry is complete"),
            Err(error) => assert_eq!(error.kind(), std::io::ErrorKind::NotFound),
        }
        if let Ok(folder) = fs::File::open(root.join(key(&name).as_str())) {
            folder.set_modified(SystemTime::UNIX_EPOCH).unwrap();
        }
    }
}

/// This is not a test by itself, but the second process of one.
#[test]
fn second_process_of_a_test() {
    if let Some(root) = std::env::var_os(WORKER) {
        use_entries(Path::new(&root), 1);
    }
}

#[cfg(unix)]
#[test]
fn two_processes_build_and_remove_the_same_entries() {
    let folder = tempfile::tempdir().unwrap();
    let mut second = Command::new(std::env::current_exe().unwrap())
        .args(["cache::tests::second_process_of_a_test", "--exact"])
        .env(WORKER, folder.path())
        .spawn()
        .unwrap();
    use_entries(folder.path(), 0);
    assert!(second.wait().unwrap().success());
    let last = limited_cache(folder.path(), WORKER_LIMIT);
    last.get_or_build(&key("last"), "file", build_of_size(1)).unwrap();
    assert!(size_limit::bytes_of(folder.path()) <= WORKER_LIMIT);
    assert!(entries(&last).iter().all(|name| !name.contains("ing-")), "{:?}", entries(&last));
}

#[test]
fn the_size_follows_the_environment() {
    let host = |size: &str| {
        MockHost::new().variable("HOME", "/home/me").variable("FOVEATE_CACHE_SIZE", size)
    };
    assert_eq!(Cache::from_host(&host("")).unwrap().limit, SizeLimit::default());
    assert_eq!(Cache::from_host(&host("100M")).unwrap().limit, SizeLimit(Some(100 << 20)));
    let error = Cache::from_host(&host("much")).unwrap_err();
    assert!(error.to_string().contains("FOVEATE_CACHE_SIZE is `much`"), "{error}");
}

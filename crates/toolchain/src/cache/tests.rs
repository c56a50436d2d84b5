// SPDX-License-Identifier: MIT OR Apache-2.0
//! Tests of builds, entries, their removal, and concurrent processes.

use std::io::{BufRead as _, BufReader};
use std::process::{Command, Stdio};
use std::sync::atomic::{AtomicU32, Ordering};
use std::time::{Duration, Instant, SystemTime};

use super::eviction::STALE_AGE;
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
        assert_eq!(fs::read_to_string(path.unwrap().path()).unwrap(), "built");
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
                assert!(path.unwrap().path().is_file());
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
    let path = cache.keep_or_build(&key("x"), "file", fill).unwrap();
    fs::remove_file(&path).unwrap();
    assert!(cache.keep_or_build(&key("x"), "file", fill).unwrap().is_file());
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
    let cache = Cache::temporary().unwrap();
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
    let path = cache.keep_or_build(&key("x"), "file", fill).unwrap();
    drop(cache.clone());
    assert!(path.is_file());
    drop(cache);
    assert!(!path.exists());
}

fn build_of_size(bytes: usize) -> impl FnOnce(&Path) -> Result<(), ToolError> {
    move |dir| fs::write(dir.join("file"), vec![7; bytes]).map_err(ToolError::io("write", dir))
}

fn limited_cache(root: &Path, bytes: u64) -> Cache {
    Cache { limit: CacheLimit::bytes(bytes), ..Cache::in_folder(root).unwrap() }
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

#[cfg(unix)]
#[test]
fn entries_in_use_stay() {
    let folder = tempfile::tempdir().unwrap();
    let cache = limited_cache(folder.path(), 10_000);
    let held = cache.get_or_build(&key("held"), "file", build_of_size(6000)).unwrap();
    let kept = cache.keep_or_build(&key("kept"), "file", build_of_size(6000)).unwrap();
    set_age(&cache, "held", 9);
    set_age(&cache, "kept", 9);
    // A second cache behaves like another process as far as locks are concerned.
    let other = limited_cache(folder.path(), 10_000);
    other.get_or_build(&key("x"), "file", build_of_size(6000)).unwrap();
    assert!(held.path().is_file() && kept.is_file());
    drop((held, cache));
    other.get_or_build(&key("y"), "file", build_of_size(6000)).unwrap();
    assert_eq!(presence(&other, &["held", "kept", "y"]), [false, false, true]);
    assert!(entries(&other).iter().all(|name| !name.starts_with(".removing")));
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
    cache.get_or_build(&key("a"), "file", build_of_size(100)).unwrap();
    assert!(!log.exists());
    assert_eq!(presence(&cache, &["a"]), [true]);
}

/// Threads with their own caches build, use and remove the same entries. An entry stays while a
/// thread uses it, and in the end the folder is within its limit.
#[cfg(unix)]
#[test]
fn concurrent_use_and_removal_do_not_conflict() {
    const LIMIT: u64 = 40_000;
    let folder = tempfile::tempdir().unwrap();
    let built = AtomicU32::new(0);
    std::thread::scope(|scope| {
        for worker in 0..4_u32 {
            let (folder, built) = (folder.path(), &built);
            scope.spawn(move || {
                for round in 0..150_u32 {
                    // A new cache checks the folder after its first build.
                    let cache = limited_cache(folder, LIMIT);
                    let name = (worker * 7 + round * 5) % 12;
                    let entry = cache.get_or_build(&key(&name.to_string()), "file", |dir| {
                        built.fetch_add(1, Ordering::Relaxed);
                        build_of_size(9000)(dir)
                    });
                    let entry = entry.unwrap();
                    for _ in 0..3 {
                        assert_eq!(fs::read(entry.path()).unwrap().len(), 9000);
                        std::thread::yield_now();
                    }
                }
            });
        }
    });
    assert!(built.into_inner() > 12, "nothing was removed");
    // While another test of this process starts a program, the new process holds copies of the
    // locks until it runs.
    let end = Instant::now() + Duration::from_secs(20);
    for number in 0.. {
        let last = key(&format!("last {number}"));
        limited_cache(folder.path(), LIMIT).get_or_build(&last, "file", build_of_size(1)).unwrap();
        if eviction::folder_bytes(folder.path()) <= LIMIT {
            break;
        }
        assert!(Instant::now() < end, "more is left than is allowed");
        std::thread::sleep(Duration::from_millis(20));
    }
    let rests = fs::read_dir(folder.path()).unwrap().map(|entry| entry.unwrap().file_name());
    let rests: Vec<_> = rests.filter(|name| name.to_string_lossy().contains("ing-")).collect();
    assert!(rests.is_empty(), "{rests:?}");
}

const HOLDER: &str = "FOVEATE_TEST_HOLDER";

/// This is not a test by itself, but the body of a process that holds an entry until its input
/// ends.
#[test]
fn entry_holder_process() {
    let Some(root) = std::env::var_os(HOLDER) else { return };
    let entry = limited_cache(Path::new(&root), 10_000).get_or_build(
        &key("held"),
        "file",
        build_of_size(6000),
    );
    println!("\nholding");
    let _ = std::io::stdin().read_line(&mut String::new());
    drop(entry);
}

#[cfg(unix)]
#[test]
fn entries_of_another_process_stay_until_it_ends() {
    let folder = tempfile::tempdir().unwrap();
    let mut child = Command::new(std::env::current_exe().unwrap())
        .args(["cache::tests::entry_holder_process", "--exact", "--nocapture"])
        .env(HOLDER, folder.path())
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .spawn()
        .unwrap();
    let lines = BufReader::new(child.stdout.take().unwrap()).lines();
    assert!(lines.map_while(Result::ok).any(|line| line == "holding"));
    let fresh = || limited_cache(folder.path(), 10_000);
    set_age(&fresh(), "held", 9);
    fresh().get_or_build(&key("a"), "file", build_of_size(6000)).unwrap();
    assert_eq!(presence(&fresh(), &["held"]), [true]);
    // The lock is released even if the process is killed.
    child.kill().unwrap();
    child.wait().unwrap();
    fresh().get_or_build(&key("b"), "file", build_of_size(6000)).unwrap();
    assert_eq!(presence(&fresh(), &["held", "b"]), [false, true]);
}

#[test]
fn the_size_follows_the_environment() {
    let host = |size: &str| {
        MockHost::new().variable("HOME", "/home/me").variable("FOVEATE_CACHE_SIZE", size)
    };
    assert_eq!(Cache::from_host(&host("")).unwrap().limit, CacheLimit::default());
    assert_eq!(Cache::from_host(&host("100M")).unwrap().limit, CacheLimit::bytes(100 << 20));
    let error = Cache::from_host(&host("much")).unwrap_err();
    assert!(error.to_string().contains("FOVEATE_CACHE_SIZE is `much`"), "{error}");
}

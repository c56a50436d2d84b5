// SPDX-License-Identifier: MIT OR Apache-2.0
//! Compiles and links the C++ that Verilator writes ([`ModelCompiler`]).
//!
//! Every C++ file of a model includes the same large headers, whose compilation takes longer
//! than the code of a small model. Small models are therefore compiled as one file that
//! includes all others and the main, and large models as several such files. For models that
//! are built with `-Og`, the headers are compiled once, into the cache.
//!
//! Verilator's makefiles say which files it wrote, and which parts of its run time and which
//! libraries they need ([`MakefileLists`]). This differs between versions, so it is read and
//! not assumed.

use crate::cache::Cache;
use crate::cache_key::{CacheKey, CacheKeyBuilder};
use crate::error::ToolError;
use crate::invocation::Invocation;
use crate::source_files;
use crate::tool::Tool;
use crate::toolchain::Toolchain;
use std::ffi::OsString;
use std::path::{Path, PathBuf};
use std::sync::{Mutex, PoisonError};
use std::time::Duration;
use std::{fs, thread};

/// The name of the linked executable.
pub(super) const EXECUTABLE: &str = "simulator";
/// The file with the `main` of the job.
pub(super) const MAIN: &str = "foveate_main.cpp";
/// The time limit of a run of Verilator or of the compiler.
pub(super) const LIMIT: Duration = Duration::from_secs(1800);
/// The bytes of generated C++ that one compiler run takes at most, unless a single file is larger.
const BUNDLE_BYTES: u64 = 256 << 10;
const COMPILER_COUNT: usize = 2;
const RUN_TIME_FLAG: &str = "-O2";
/// The headers of libraries for waves that Verilator's package does not install, with their Debian
/// packages.
const WAVE_HEADERS: [(&str, &str); 2] = [("zlib.h", "zlib1g-dev"), ("lz4.h", "liblz4-dev")];
const SLOW_FLAG: &str = "-O0";
/// The includes of models and their mains, which are compiled once for each optimization flag. The
/// compiled header takes 60 MB, and saves a fifth of the time that a small model takes to compile.
/// A main may include other headers.
const COMMON_HEADER: &str = "#include \"verilated.h\"\n#include <chrono>\n#include <cstddef>\n\
    #include <cstdio>\n#include <cstdlib>\n#include <cstring>\n#include <memory>\n\
    #include <type_traits>\n#include <vector>\n";
const HEADER_FILE: &str = "foveate_verilated.h";
/// The name under which GCC and Clang search for a compiled header.
const COMPILED_HEADER: &str = "foveate_verilated.h.gch";

/// The optimization level of the C++ compiler.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum OptimizationLevel {
    /// The flag `-Og`: quick to build, for short runs.
    #[default]
    FastBuild,
    /// The flag `-O3`: quick to run, for long runs.
    FastRun,
}

impl OptimizationLevel {
    pub(super) const fn flag(self) -> &'static str {
        match self {
            Self::FastBuild => "-Og",
            Self::FastRun => "-O3",
        }
    }
}

/// A C++ compiler with the settings for Verilator's headers.
pub(super) struct ModelCompiler<'a> {
    toolchain: &'a Toolchain,
    include: &'a Path,
    flags: Vec<String>,
}

/// One run of the compiler.
struct CompilationUnit {
    source: PathBuf,
    object: PathBuf,
    flag: &'static str,
    /// A header to include first, compiled with the same flag.
    header: Option<PathBuf>,
}

impl<'a> ModelCompiler<'a> {
    pub(super) fn new(
        toolchain: &'a Toolchain,
        include: &'a Path,
        trace: bool,
    ) -> Result<Self, ToolError> {
        toolchain.find(Tool::Cxx)?;
        Ok(Self { toolchain, include, flags: header_flags(trace) })
    }

    /// Returns the objects of Verilator's run time, which are compiled when they are first needed.
    pub(super) fn compile_run_time(
        &self,
        cache: &Cache,
        makefile: &MakefileLists,
    ) -> Result<Vec<PathBuf>, ToolError> {
        in_parallel(&makefile.run_time, |name| {
            let key = tools_key("verilated", self.toolchain)?
                .list("flags", &self.flags)
                .field("include", self.include.as_os_str().as_encoded_bytes())
                .field("file", name)
                .finish();
            let object = format!("{name}.o");
            cache.get_or_build(&key, &object, |dir| {
                let source = self.include.join(format!("{name}.cpp"));
                let object = dir.join(&object);
                self.compile(
                    dir,
                    &CompilationUnit { source, object, flag: RUN_TIME_FLAG, header: None },
                )
            })
        })
    }

    /// Returns the common headers, which are compiled when they are first needed.
    fn compile_header(&self, cache: &Cache, flag: &'static str) -> Result<PathBuf, ToolError> {
        let key = tools_key("verilated header", self.toolchain)?
            .list("flags", &self.flags)
            .field("optimize", flag)
            .field("include", self.include.as_os_str().as_encoded_bytes())
            .field("text", COMMON_HEADER)
            .finish();
        let compiled = cache.get_or_build(&key, COMPILED_HEADER, |dir| {
            source_files::write_file(dir, HEADER_FILE, COMMON_HEADER.as_bytes())?;
            let invocation = self
                .compiler_invocation(dir)?
                .args(&self.flags)
                .arg(flag)
                .args(self.include_arguments())
                .args(["-x", "c++-header", HEADER_FILE, "-o", COMPILED_HEADER]);
            self.toolchain.run_checked(&invocation).map(drop)
        })?;
        Ok(compiled.with_file_name(HEADER_FILE))
    }

    /// Returns the objects of the model and of its main.
    pub(super) fn compile_model(
        &self,
        cache: &Cache,
        dir: &Path,
        makefile: &MakefileLists,
        optimize: OptimizationLevel,
    ) -> Result<Vec<PathBuf>, ToolError> {
        let flag = optimize.flag();
        let header_for = |flag| match optimize {
            OptimizationLevel::FastBuild => self.compile_header(cache, flag).map(Some),
            OptimizationLevel::FastRun => Ok(None),
        };
        let header = header_for(flag)?;
        let unit = |name: &str, flag, header| CompilationUnit {
            source: dir.join(name),
            object: dir.join(name).with_extension("o"),
            flag,
            header,
        };
        let all = [&makefile.fast[..], &makefile.slow].concat();
        let mut units = Vec::new();
        if let [all] = &write_bundles(dir, "all", &all, Some(MAIN))?[..] {
            units.push(unit(all, flag, header));
        } else {
            for name in write_bundles(dir, "fast", &makefile.fast, Some(MAIN))? {
                units.push(unit(&name, flag, header.clone()));
            }
            let header = header_for(SLOW_FLAG)?;
            for name in write_bundles(dir, "slow", &makefile.slow, None)? {
                units.push(unit(&name, SLOW_FLAG, header.clone()));
            }
        }
        in_parallel(&units, |unit| self.compile(dir, unit).map(|()| unit.object.clone()))
    }

    /// Links the executable.
    pub(super) fn link(
        &self,
        dir: &Path,
        objects: &[PathBuf],
        makefile: &MakefileLists,
    ) -> Result<PathBuf, ToolError> {
        let executable = dir.join(EXECUTABLE);
        let invocation = self
            .compiler_invocation(dir)?
            .arg("-o")
            .arg(&executable)
            .args(objects)
            .args(["-pthread", "-latomic"])
            .args(&makefile.libraries);
        self.toolchain.run_checked(&invocation)?;
        Ok(executable)
    }

    fn compile(&self, dir: &Path, unit: &CompilationUnit) -> Result<(), ToolError> {
        let mut invocation = self.compiler_invocation(dir)?.args(&self.flags).arg(unit.flag);
        if let Some(header) = &unit.header {
            invocation = invocation.arg("-include").arg(header);
        }
        let invocation = invocation
            .args(self.include_arguments())
            .arg("-c")
            .arg(&unit.source)
            .arg("-o")
            .arg(&unit.object);
        self.toolchain.run_checked(&invocation).map(drop).map_err(explain_missing_header)
    }

    /// Returns the arguments with the folders of headers.
    fn include_arguments(&self) -> [OsString; 5] {
        let (system, more) = (OsString::from("-isystem"), self.include.join("vltstd"));
        ["-I.".into(), system.clone(), self.include.into(), system, more.into()]
    }

    fn compiler_invocation(&self, dir: &Path) -> Result<Invocation, ToolError> {
        Ok(self.toolchain.invocation(Tool::Cxx)?.dir(dir).merge_stderr().timeout(LIMIT))
    }
}

/// Turns the error about a header that the compiler did not find into one that says how to install
/// it.
fn explain_missing_header(error: ToolError) -> ToolError {
    let ToolError::Failed { full, .. } = &error else { return error };
    let missing = |(header, _): &&(&str, &str)| {
        full.contains(&format!("{header}: No such file")) // gcc
            || full.contains(&format!("'{header}' file not found")) // clang
    };
    match WAVE_HEADERS.iter().find(missing) {
        Some(&(header, package)) => ToolError::MissingHeader { header, package },
        None => error,
    }
}

/// Starts a key that depends on the versions of Verilator and the compiler.
pub(super) fn tools_key(kind: &str, toolchain: &Toolchain) -> Result<CacheKeyBuilder, ToolError> {
    let verilator = toolchain.find(Tool::Verilator)?;
    let compiler = toolchain.find(Tool::Cxx)?;
    Ok(CacheKey::builder(kind)
        .field("verilator", verilator.identity())
        .field("path", verilator.path.as_os_str().as_encoded_bytes())
        .field("compiler", compiler.identity()))
}

/// Returns the flags that Verilator's headers need, with or without waves.
pub(super) fn header_flags(trace: bool) -> Vec<String> {
    let trace = u8::from(trace);
    let fixed = ["-std=gnu++17", "-w", "-pthread", "-DVERILATOR=1", "-DVL_TIME_CONTEXT"];
    let mut flags: Vec<String> = fixed.map(str::to_owned).into();
    flags.extend(["COVERAGE", "SC", "TRACE_VCD", "TIMING"].map(|name| format!("-DVM_{name}=0")));
    flags.extend(["TRACE", "TRACE_FST"].map(|name| format!("-DVM_{name}={trace}")));
    flags
}

/// Writes bundles, which are files that include the generated files. A bundle includes at most
/// [`BUNDLE_BYTES`], or one larger file. `last`, if given, is the last file of the last bundle.
/// Returns the names of the bundles.
fn write_bundles(
    dir: &Path,
    kind: &str,
    names: &[String],
    last: Option<&str>,
) -> Result<Vec<String>, ToolError> {
    let mut bundles: Vec<(u64, String)> = Vec::new();
    let generated = names.iter().map(|name| format!("{name}.cpp"));
    for name in generated.chain(last.map(str::to_owned)) {
        let path = dir.join(&name);
        let size = fs::metadata(&path).map_err(ToolError::io("read", &path))?.len();
        let include = format!("#include \"{name}\"\n");
        match bundles.last_mut() {
            Some((total, text)) if *total + size <= BUNDLE_BYTES => {
                *total += size;
                text.push_str(&include);
            }
            _ => bundles.push((size, include)),
        }
    }
    let write = |(index, (_, text)): (usize, &(u64, String))| {
        let name = format!("foveate_{kind}_{index}.cpp");
        source_files::write_file(dir, &name, text.as_bytes()).map(|()| name)
    };
    bundles.iter().enumerate().map(write).collect()
}

/// Does `work` for every item, a few at a time. Returns the results in order. Fails if `work` fails
/// for any item.
fn in_parallel<T: Sync, R: Send>(
    items: &[T],
    work: impl Fn(&T) -> Result<R, ToolError> + Sync,
) -> Result<Vec<R>, ToolError> {
    let queue = Mutex::new(items.iter().enumerate());
    let next = || queue.lock().unwrap_or_else(PoisonError::into_inner).next();
    let worker = || {
        let mut done = Vec::new();
        while let Some((index, item)) = next() {
            done.push((index, work(item)?));
        }
        Ok(done)
    };
    let mut results = Vec::new();
    thread::scope(|scope| {
        let workers: Vec<_> = (0..COMPILER_COUNT).map(|_| scope.spawn(worker)).collect();
        for handle in workers {
            match handle.join() {
                Ok(done) => results.extend(done?),
                Err(panic) => std::panic::resume_unwind(panic),
            }
        }
        Ok::<(), ToolError>(())
    })?;
    results.sort_by_key(|(index, _)| *index);
    Ok(results.into_iter().map(|(_, result)| result).collect())
}

#[derive(Debug, Default, PartialEq, Eq)]
pub(super) struct MakefileLists {
    /// The generated files that run often, without `.cpp`.
    pub(super) fast: Vec<String>,
    /// The generated files that run once, without `.cpp`.
    pub(super) slow: Vec<String>,
    /// The parts of the run time.
    pub(super) run_time: Vec<String>,
    /// The flags for the linker.
    pub(super) libraries: Vec<String>,
    /// The folder of Verilator's headers and run time.
    pub(super) include: PathBuf,
}

impl MakefileLists {
    pub(super) fn read(dir: &Path, prefix: &str) -> Result<Self, ToolError> {
        let read = |name: String| {
            let path = dir.join(name);
            fs::read_to_string(&path).map_err(ToolError::io("read", &path))
        };
        Ok(Self::parse(&read(format!("{prefix}_classes.mk"))?, &read(format!("{prefix}.mk"))?))
    }

    fn parse(classes: &str, main: &str) -> Self {
        let both = |a, b| [assigned_words(classes, a), assigned_words(classes, b)].concat();
        Self {
            fast: both("VM_CLASSES_FAST", "VM_SUPPORT_FAST"),
            slow: both("VM_CLASSES_SLOW", "VM_SUPPORT_SLOW"),
            run_time: both("VM_GLOBAL_FAST", "VM_GLOBAL_SLOW"),
            libraries: assigned_words(main, "VM_USER_LDLIBS"),
            include: Path::new(assigned_text(main, "VERILATOR_ROOT")).join("include"),
        }
    }
}

/// Returns the words assigned to a variable, over continued lines.
fn assigned_words(makefile: &str, variable: &str) -> Vec<String> {
    let joined = makefile.replace("\\\n", " ");
    let assigned = joined.lines().filter_map(|line| assignment(line, variable));
    assigned.flat_map(str::split_whitespace).map(str::to_owned).collect()
}

/// Returns everything that one line assigns to a variable, such as a path with spaces.
fn assigned_text<'a>(makefile: &'a str, variable: &str) -> &'a str {
    makefile.lines().find_map(|line| assignment(line, variable)).unwrap_or_default().trim()
}

/// Returns the text that a line assigns to a variable; `None` if it assigns nothing to it.
fn assignment<'a>(line: &'a str, variable: &str) -> Option<&'a str> {
    let rest = line.strip_prefix(variable)?.trim_start();
    ["+=", "?=", "="].into_iter().find_map(|sign| rest.strip_prefix(sign))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn work_is_done_in_order() {
        let items: Vec<usize> = (0..100).collect();
        assert_eq!(in_parallel(&items, |i| Ok(i * 2)).unwrap()[99], 198);
        let error =
            in_parallel(&items, |i| if *i == 7 { Err(ToolError::NoCacheFolder) } else { Ok(()) });
        assert!(matches!(error, Err(ToolError::NoCacheFolder)));
    }

    #[test]
    fn small_files_share_a_bundle() {
        let dir = tempfile::tempdir().unwrap();
        let large = "x".repeat(300 << 10);
        for (name, text) in [("a", "1"), ("b", "2"), ("c", large.as_str()), ("d", "3")] {
            fs::write(dir.path().join(format!("{name}.cpp")), text).unwrap();
        }
        let names = ["a", "b", "c", "d"].map(str::to_owned);
        let bundles = write_bundles(dir.path(), "fast", &names, None).unwrap();
        assert_eq!(bundles.len(), 3);
        let first = fs::read_to_string(dir.path().join(&bundles[0])).unwrap();
        assert_eq!(first, "#include \"a.cpp\"\n#include \"b.cpp\"\n");
        let small = &names[..2];
        let bundles = write_bundles(dir.path(), "all", small, Some("d.cpp")).unwrap();
        let all = fs::read_to_string(dir.path().join(&bundles[0])).unwrap();
        assert_eq!((bundles.len(), all.lines().last()), (1, Some("#include \"d.cpp\"")));
    }

    #[test]
    fn lists_are_read_over_lines() {
        let classes = "VM_TRACE = 1\nVM_CLASSES_FAST += \\\n\tVtop \\\n\tVtop__0 \\\n\n\
                       VM_CLASSES_SLOW += \\\n\tVtop__Slow \\\n\n\
                       VM_SUPPORT_FAST += \\\n\tVtop__Trace \\\n\n\
                       VM_GLOBAL_FAST += \\\n\tverilated \\\n\tverilated_threads \\\n\n\
                       VM_GLOBAL_SLOW += \\\n\n";
        let main = "VERILATOR_ROOT = /my tools/verilator\nVM_USER_LDLIBS = \\\n\t-lz \\\n\n";
        let makefile = MakefileLists::parse(classes, main);
        assert_eq!(makefile.fast, ["Vtop", "Vtop__0", "Vtop__Trace"]);
        assert_eq!(makefile.slow, ["Vtop__Slow"]);
        assert_eq!(makefile.run_time, ["verilated", "verilated_threads"]);
        assert_eq!(makefile.libraries, ["-lz"]);
        assert_eq!(makefile.include, Path::new("/my tools/verilator/include"));
        let newer = MakefileLists::parse("", "VERILATOR_ROOT ?= /verilator\n");
        assert_eq!(newer.include, Path::new("/verilator/include"));
    }
}

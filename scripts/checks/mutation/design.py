# SPDX-License-Identifier: MIT OR Apache-2.0
"""A design with its Verilog and its vectors, and the effect of a mutant on it: in Icarus, in Yosys, in a proof."""
import concurrent.futures
import functools
import hashlib
import json
import os
import re
import shutil
import signal
import subprocess
import sys
import threading

import proof

TARGET = os.path.abspath(os.environ.get("CARGO_TARGET_DIR", "target"))
WORK = os.path.join(TARGET, "mutation")
FOVEATE = os.environ.get("FOVEATE", "foveate")
DESIGNS = "mutation/designs.txt"
# The last one is the logic around a raster array on AXI; the array inside has mutants of its own.
BUS = "axi"
ORGANIZATIONS = ["pipelined", "serial", "raster", BUS]
AXI_MODULES = ("axi_", "packet_", "rcm_axi")
# Number of rounds and seed of the vectors of each stage.
STAGES = ((1, 1), (3, 2))
LONG_STAGE = 1
TIME_FACTOR = 12
# The script that is called in place of Icarus.
WRAPPER_FOLDER = os.path.abspath("scripts/checks/tool_wrappers")


class Design:
    """A design with its sources and its vectors."""

    def __init__(self, organization, name, options):
        # A late design is only for mutants that have survived the others; a design with a star is in the sample.
        self.organization, self.is_late, self.is_in_sample, self.name = organization, name.endswith("+"), name.endswith("*"), name.rstrip("+*")
        self.options = options
        self.folder = os.path.join(WORK, "designs", organization, self.name)
        self.lock, self.modules, self.netlists, self.program = threading.Lock(), None, {}, None
        self.vectors, self.seconds, self.digests = {}, {}, {}

    def record(self, stage):
        """Keeps the sources, the vectors of a stage, and their run time; a second call for the same stage does nothing."""
        with self.lock:
            if stage in self.seconds:
                return
            # The long vectors of a late design are the short vectors of others.
            rounds, seed = STAGES[0 if self.is_late else stage]
            stage_folder = os.path.join(self.folder, f"stage{stage}")
            seconds_path = os.path.join(stage_folder, "seconds")
            inputs_path, inputs = os.path.join(stage_folder, "made_of"), json.dumps([executable(), self.options, rounds, seed])
            if not os.path.exists(inputs_path) or open(inputs_path).read() != inputs:
                shutil.rmtree(stage_folder, ignore_errors=True)
                os.makedirs(stage_folder)
                self.simulate(stage_folder, rounds, seed)
                with open(inputs_path, "w") as file:
                    file.write(inputs)
            self.vectors[stage] = os.path.join(stage_folder, "vectors.hex")
            self.sources = stage_folder
            self.files = open(os.path.join(stage_folder, "files")).read().split()
            self.bench = next(name for name in self.files if name.endswith("_replay.v"))
            self.top = self.bench[: -len("_replay.v")]
            self.texts = {name: open(os.path.join(stage_folder, name)).read() for name in self.files}
            self.seconds[stage] = float(open(seconds_path).read())

    def simulate(self, stage_folder, rounds, seed):
        """Co-simulates without a mutant, and keeps the files that are needed to repeat that."""
        env = dict(os.environ, FOVEATE_CACHE="off", KEEP=stage_folder, FOVEATE_IVERILOG=os.path.join(WRAPPER_FOLDER, "iverilog"),
                   FOVEATE_VVP=os.path.join(WRAPPER_FOLDER, "vvp"))
        command = [FOVEATE, "cosim", "--simulator", "iverilog", "--preset", "bare", "--quiet", "--seed", str(seed),
                   "--replay", os.path.join(stage_folder, "replay"), *self.options]
        if "--rounds" not in self.options:
            command += ["--rounds", str(rounds)]
        result = subprocess.run(command, env=env, capture_output=True, text=True)
        if result.returncode != 0:
            sys.exit(f"mutation: {self.organization} {self.name} does not agree without a mutant: {result.stdout}{result.stderr}")
        # The processor time: the last line of `times` is that of vvp.
        minutes, seconds = open(os.path.join(stage_folder, "times")).read().split()[2].rstrip("s").split("m")
        with open(os.path.join(stage_folder, "seconds"), "w") as file:
            file.write(str(60 * int(minutes) + float(seconds)))

    def clocks(self, stage):
        """Returns a measure of the length of the vectors."""
        return os.path.getsize(self.vectors[stage])

    def digest(self, phase):
        """Returns a digest of the sources and, if a phase replays them, of the vectors that were recorded first; and of the
        scripts of the proofs, if it has any."""
        with self.lock:
            if phase not in self.digests:
                replayed = phase == "long" or phase == "short" and not self.is_late
                vectors = open(self.vectors[LONG_STAGE if self.is_late else 0], "rb").read() if replayed else b""
                method = "" if phase == "long" else open(proof.__file__).read()
                texts = json.dumps([self.texts, STAGES, method], sort_keys=True).encode()
                self.digests[phase] = hashlib.sha256(texts + vectors).hexdigest()
            return self.digests[phase]

    def has(self, module):
        return f"rtl/{module}.v" in self.files

    def mutable(self):
        """Returns the texts that are mutated, by name."""
        return self.texts

    def compiled(self, module, text):
        """Makes the program for Icarus with another text of a module. Returns it, if it elaborates, and its path; addresses and
        the values of parameters, which the code has as constants, are left out."""
        folder = os.path.join(WORK, "run", str(threading.get_ident()))
        os.makedirs(folder, exist_ok=True)
        files = [os.path.join(self.sources, name) for name in self.files]
        if module:
            mutant = os.path.join(folder, f"{module}.v")
            with open(mutant, "w") as file:
                file.write(text)
            files[self.files.index(f"rtl/{module}.v")] = mutant
        path = os.path.join(folder, "program.vvp")
        compilation = proof.run_limited(["iverilog", "-g2005", "-s", self.elaborated_module(), "-o", path, *files], 60)
        if compilation.returncode != 0:
            return None, path
        code = re.sub(r"^P_.*\n", "", open(path).read().split("\n# The file index")[0], flags=re.M)
        address_numbers = {}
        code = re.sub(r"0x[0-9a-f]{6,}", lambda match: address_numbers.setdefault(match[0], str(len(address_numbers))), code)
        return hashlib.sha256(code.encode()).hexdigest(), path

    def elaborated_module(self):
        return f"{self.top}_replay"

    def has_same_program(self, module, text):
        """Returns whether Icarus makes the same program with another text of a module."""
        self.record(LONG_STAGE if self.is_late else 0)
        with self.lock:
            if not self.program:
                self.program = self.compiled(None, None)[0]
        return self.compiled(module, text)[0] == self.program

    def run(self, stage, module, text):
        """Returns the outcome with another text of a module: `pass`, `fail`, `hang`, `abort` if Icarus itself gives up, `refused` if it
        does not elaborate, or `same` if the program is the same."""
        self.record(stage)
        with self.lock:
            if not self.program:
                self.program = self.compiled(None, None)[0]
        code, program = self.compiled(module, text)
        if code is None:
            return "refused"
        if code == self.program:
            return "same"
        limit = int(max(10, TIME_FACTOR * self.seconds[stage]))
        done = proof.run_limited(["vvp", "-n", program, f"+vectors={self.vectors[stage]}", "+stop"], limit, cwd=os.path.dirname(program))
        if done.returncode in (-signal.SIGXCPU, -signal.SIGKILL):
            return "hang"
        verdicts = [line.split()[0] for line in done.stdout.splitlines() if line.startswith(("PASS ", "FAIL "))]
        if verdicts:
            return {"PASS": "pass", "FAIL": "fail"}[verdicts[-1]]
        # An assertion of Icarus failed, about a part-select beyond its vector. No run of such a design ends with PASS.
        if done.returncode == -signal.SIGABRT:
            return "abort"
        raise RuntimeError(f"{self.name}: the replay says neither PASS nor FAIL: {(done.stdout + done.stderr)[-300:]}")

    def chparam(self):
        """Returns the parameters that the bench gives to the top module, for Yosys."""
        parameters = re.search(rf"^\s*{self.top} #\((.*)\) dut \($", self.texts[self.bench], re.M)
        values = re.findall(r"\.(\w+)\((\d+)\)", parameters.group(1) if parameters else "")
        return "".join(f" -chparam {name} {value}" for name, value in values)

    def variants(self, module):
        """Returns the names in Yosys of the module with its parameters in this design."""
        with self.lock:
            if self.modules is None:
                paths = " ".join(os.path.join(self.sources, name) for name in self.files if name != self.bench)
                script = f"read_verilog {paths}; hierarchy -top {self.top}{self.chparam()}; tee -o /dev/stderr ls"
                result = subprocess.run([proof.YOSYS, "-p", script], capture_output=True, text=True)
                if result.returncode != 0:
                    sys.exit(f"mutation: Yosys does not read {self.name}: {result.stdout[-300:]}")
                self.modules = [line.strip() for line in result.stderr.splitlines()]
        return [name for name in self.modules if re.fullmatch(rf"(\$paramod(\$\w+)?\\)?{module}(\\.*)?", name)]

    def same(self, module, text, inside=None):
        """Returns whether Yosys makes the same netlist with another text of a module, for the whole design or for the module of that
        name; None if the change is not a mutant."""
        with self.lock:
            if inside not in self.netlists:
                self.netlists[inside] = proof.netlist(self, WORK, inside=inside)
        cells, problems = self.netlists[inside]
        mutant, mutant_problems = proof.netlist(self, WORK, module, text, inside)
        if mutant_problems > problems:
            return None
        return cells is not None and mutant == cells

    def equal(self, module, text, inside=None):
        """Returns whether the design, or the module of that name alone, is proven equal with another text of a module."""
        return proof.is_equal(self, WORK, module, text, inside)


class BusDesign(Design):
    """A design on AXI. Its packets are compared as co-simulation does, but in Verilog; no contract defines when they leave."""

    def record(self, stage):
        with self.lock:
            if stage in self.seconds:
                return
            core = os.path.join(self.folder, "core")
            if not self.seconds:
                shutil.rmtree(core, ignore_errors=True)
                settings = [word for word in self.options if word not in ("--level", BUS)]
                subprocess.run([FOVEATE, "generate", "--preset", "bare", *settings, "--output", core], check=True, capture_output=True)
                self.files = sorted(f"rtl/{name}" for name in os.listdir(os.path.join(core, "rtl")))
                self.texts = {name: open(os.path.join(core, name)).read() for name in self.files}
                self.sources, self.bench, self.top = core, None, "rcm_axi"
            began = os.times()
            if self.cosim(stage, os.path.join(core, "rtl"), None) != "pass":
                sys.exit(f"mutation: {self.organization} {self.name} does not agree without a mutant")
            ended = os.times()
            self.seconds[stage] = ended.children_user + ended.children_system - began.children_user - began.children_system

    def cosim(self, stage, rtl, limit):
        rounds, seed = STAGES[0 if self.is_late else stage]
        command = [FOVEATE, "cosim", "--config", os.path.join(self.sources, "design.toml"), "--rtl", rtl, "--level", BUS, "--quiet",
                   "--seed", str(seed), "--rounds", str(rounds), "--replay", os.path.join(WORK, "run", f"replay{threading.get_ident()}")]
        result = proof.run_limited(command, limit or 600)
        if result.returncode in (0, 1):
            return "fail" if result.returncode else "pass"
        # The simulation was ended, found a loop that never settles, or reached the time limit.
        if re.search(r"ended after \d+ of \d+ clocks", result.stderr):
            return "abort"
        if result.returncode in (-signal.SIGXCPU, -signal.SIGKILL):
            return "hang"
        # Icarus accepts this Verilog and Verilator does not, or makes C++ of it that does not compile.
        if "%Error" in result.stderr or re.search(r"\.cpp:\d+:\d+: error:", result.stderr):
            return "refused"
        raise RuntimeError(f"{self.name}: co-simulation has no result: {result.stderr[-300:]}")

    def clocks(self, stage):
        return self.seconds[stage]

    def digest(self, phase):
        with self.lock:
            if phase not in self.digests:
                method = "" if phase == "long" else open(proof.__file__).read()
                self.digests[phase] = hashlib.sha256(json.dumps([self.texts, STAGES, method, executable()]).encode()).hexdigest()
            return self.digests[phase]

    def mutable(self):
        return {name: text for name, text in self.texts.items() if os.path.basename(name).startswith(AXI_MODULES)}

    def elaborated_module(self):
        return self.top

    def run(self, stage, module, text):
        self.record(stage)
        with self.lock:
            if not self.program:
                self.program = self.compiled(None, None)[0]
        code, _ = self.compiled(module, text)
        if code is None:
            return "refused"
        if code == self.program:
            return "same"
        rtl = os.path.join(WORK, "run", str(threading.get_ident()), "rtl")
        shutil.rmtree(rtl, ignore_errors=True)
        shutil.copytree(os.path.join(self.sources, "rtl"), rtl)
        with open(os.path.join(rtl, f"{module}.v"), "w") as out:
            out.write(text)
        return self.cosim(stage, rtl, int(max(60, TIME_FACTOR * self.seconds[stage])))

    def chparam(self):
        return ""


@functools.cache
def executable():
    """Returns a digest of the program."""
    return hashlib.sha256(open(FOVEATE, "rb").read()).hexdigest()


def designs(organization):
    """Yields the designs of mutation/designs.txt, whose lines are `organization name options`."""
    for number, line in enumerate(open(DESIGNS), 1):
        words = line.split()
        if not words or line.startswith("#"):
            continue
        if len(words) < 3 or words[0] not in ORGANIZATIONS:
            sys.exit(f"mutation: {DESIGNS}:{number}: wants `{'|'.join(ORGANIZATIONS)} NAME OPTIONS`")
        if words[0] == organization:
            options = words[2:]
            if organization == BUS:
                options += ["--set", "hardware.organization='raster'", "--set", "hardware.interface='axi'"]
                yield BusDesign(organization, words[1], options)
                continue
            if organization != ORGANIZATIONS[0]:
                options += ["--set", f"hardware.organization='{organization}'"]
            yield Design(organization, words[1], options)


def record_designs(organization, jobs, sample):
    """Returns the designs of an organization with their vectors, the shortest first; for a sample only the designs in it."""
    recorded = [design for design in designs(organization) if design.is_in_sample or not sample]
    with concurrent.futures.ThreadPoolExecutor(jobs) as pool:
        list(pool.map(lambda design: design.record(LONG_STAGE if design.is_late else 0), recorded))
    return sorted(recorded, key=lambda design: design.clocks(LONG_STAGE if design.is_late else 0))

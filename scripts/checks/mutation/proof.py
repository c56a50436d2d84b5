# SPDX-License-Identifier: MIT OR Apache-2.0
"""Used by design.py: proofs that a design with a mutant is equal to the design.

`same`   Yosys makes the same netlist of both, down to the last cell: the change has no effect on it.
`equal`  ABC proves that no sequence of inputs distinguishes the two netlists: registers that are always equal are found by
         induction, the rest is proven by PDR. Registers and memories are 0 at the start; resets may come at any clock.
         First the memories are cut out: both sides read the same words, whatever these are, and every address, word and enable
         that goes to a memory must be the same, too. So the contents are the same at every clock, and no memory is too large.
         If that finds a difference, which may be in a word that is not used, small memories become registers.
"""
import os
import re
import resource
import shutil
import subprocess
import threading

YOSYS = os.environ.get("FOVEATE_YOSYS", "yosys")
# Memories stay as they are if netlists are only compared.
READ = ["proc", "setattr -mod -unset keep_hierarchy *", "flatten", "memory -nomap"]
SMALL = ["opt -full", "wreduce", "opt -full", "wreduce -memx", "opt -full", "opt_clean -purge"]
# Memories with a name. Those without a name are constants and stay inside.
CUT = ["expose -evert t:$mem_v2"]
# This runs before any simplification: Yosys makes an unknown value of a register that is never loaded, and every comparison with
# that is true.
ZERO = ["setundef -undriven -zero", "zinit -all"]
BITS = ["memory_map", *ZERO, "opt -full", "splitnets -ports", "opt_clean -purge"]
MITER = ["miter -equiv -flatten gold gate miter", "hierarchy -top miter", "opt -full", "techmap", "opt -full", "dffunmap",
         "setundef -undriven -zero", "setundef -init -zero", "zinit -all", "opt -full", "dffunmap", "abc -g AND", "opt_clean"]
# Random inputs from reset, for a few seconds, find most differences.
REFUTE = "strash; sim3 -F 2000 -W 4 -T 5"
PROVE = "strash; scorr; scorr -F 2; dc2; scorr; dprove; pdr"
# Seconds of processor time, so that a busy machine has the same results.
READING, PROVING = 60, 90
# The largest number of bits of memories that become registers.
REGISTERS = 2048


def folder(work):
    path = os.path.join(work, "proof", str(threading.get_ident()))
    os.makedirs(path, exist_ok=True)
    return path


def sources(design, work, module=None, text=None):
    """Writes the files of a design, one of them with another text."""
    names = [name for name in design.files if name != design.bench]
    paths = [os.path.join(design.sources, name) for name in names]
    if module:
        mutant = os.path.join(folder(work), f"{module}.v")
        with open(mutant, "w") as out:
            out.write(text)
        paths[names.index(f"rtl/{module}.v")] = mutant
    return paths


def load(design, paths, inside):
    return [f"read_verilog {' '.join(paths)}", f"hierarchy -top {design.top}{design.chparam()}", f"hierarchy -top {inside or design.top}"]


def run_limited(command, seconds, **options):
    """Runs a command for a limited processor time in seconds, after which a signal ends it."""
    def limit():
        resource.setrlimit(resource.RLIMIT_CPU, (seconds, seconds + 1))

    return subprocess.run(command, capture_output=True, text=True, errors="replace", preexec_fn=limit, **options)


def run(command, seconds=READING, **options):
    """Returns the output of a command, if it succeeds in time."""
    result = run_limited(command, seconds, **options)
    return result.stdout if result.returncode == 0 else None


def netlist(design, work, module=None, text=None, inside=None):
    """Returns the netlist, independent of the order in which Yosys made its parts, and the number of nets without one single driver."""
    out = os.path.join(folder(work), "netlist.il")
    script = load(design, sources(design, work, module, text), inside)
    script += READ[:1] + ["tee -q -o " + out + ".check check"] + READ[1:] + SMALL
    script += ["rename -top top", "autoname", f"write_rtlil {out}"]
    if run([YOSYS, "-q", "-p", "; ".join(script)]) is None:
        return None, 0
    problems = re.search(r"found and reported (\d+) problems", open(out + ".check").read(), re.I)
    cells = re.sub(r"^\s*attribute (?!\\init ).*\n|^#.*\n|^autoidx .*\n", "", open(out).read(), flags=re.M)
    return in_order(cells), int(problems.group(1))


def in_order(text):
    """Returns the text of a netlist in which names depend on places and not on the order of making: the parts are sorted, each with
    the initial value of its wire."""
    part = re.compile(r"^(?:  attribute .*\n)*  (?:wire|memory|cell|connect) .*\n(?:    .*\n|  end\n)*", re.M)
    return part.sub("", text) + "".join(sorted(part.findall(text)))


def is_equal(design, work, module, text, inside=None):
    """Returns whether no sequence of inputs distinguishes the design, or the module of that name, from the one with another text."""
    sides = {"gold": sources(design, work), "gate": sources(design, work, module, text)}
    if are_proven_equal(design, work, sides, inside, cut=True):
        return True
    bits = [sum(size * width for size, width, *_ in memories(work, side).values()) for side in sides]
    return 0 < max(bits) <= REGISTERS and are_proven_equal(design, work, sides, inside, cut=False)


def are_proven_equal(design, work, sides, inside, cut):
    """Returns whether ABC finds the two sides equal, with their memories cut out or as registers."""
    out = os.path.join(folder(work), "miter.aig")
    script = []
    for side, paths in sides.items():
        script += load(design, paths, inside) + READ + ZERO + ["opt -full", "opt_clean -purge", f"tee -q -o {out}.{side} dump t:$mem_v2"]
        script += (CUT if cut else []) + BITS + [f"rename -top {side}", f"design -stash {side}"]
    script += [f"design -copy-from {side} -as {side} {side}" for side in sides] + MITER + [f"write_aiger -zinit {out}"]
    if run([YOSYS, "-q", "-p", "; ".join(script)]) is None:
        return False
    # Only memories of the same shape have the same words if their ports are equal.
    if cut and memories(work, "gold") != memories(work, "gate"):
        return False
    # ABC leaves files in its working folder.
    def run_abc(commands):
        return run([abc(), "-c", f"read {out}; {commands}"], PROVING, cwd=folder(work)) or ""

    if "was asserted" in run_abc(REFUTE):
        return False
    answer = run_abc(PROVE)
    return bool(re.search(r"UNSATISFIABLE|Property proved|Networks are equivalent", answer)) and "was asserted" not in answer


def memories(work, side):
    """Returns words, bits of a word and all other parameters of each memory with a name, as of the last `proven`."""
    path = os.path.join(folder(work), f"miter.aig.{side}")
    found_memories = {}
    for cell in re.split(r"^  cell ", open(path).read(), flags=re.M)[1:] if os.path.exists(path) else ():
        name = cell.split()[1]
        if name.startswith("\\"):
            parameters = dict(re.findall(r"^    parameter (\S+) (.*)$", cell, re.M))
            found_memories[name] = int(parameters["\\SIZE"]), int(parameters["\\WIDTH"]), sorted(parameters.items())
    return found_memories


def abc():
    """Returns the ABC that belongs to Yosys."""
    sibling = os.path.join(os.path.dirname(shutil.which(YOSYS) or YOSYS), os.path.basename(YOSYS) + "-abc")
    return sibling if os.path.exists(sibling) else "yosys-abc"

# SPDX-License-Identifier: MIT OR Apache-2.0
"""Called by mutation.sh: mutants of the Verilog, the co-simulation vectors that must kill them, and what to do with survivors.

1. Records the vectors of every design below once, as co-simulation gives them to Icarus.
2. Makes the mutants: one edit each, from a seed, spread over all leaves and rendered modules of an organization. The edits are
   those of `edits`; parameter defaults, clocks and loop steps are left alone, declared ranges only become narrower.
3. Replays the vectors of the designs that contain the module, smallest first, until a mismatch; 12 times the processor time
   of the unmutated one is a mismatch, too.
4. Where Icarus makes the same program the mutant is not in the design. What survives is equivalent if Yosys makes the same netlist of it in every design, and no mutant if a net is left without
   a driver or has two, which every tool for synthesis refuses. What is left sees longer vectors.
5. What still survives must be proven equal in every design, from reset on (mutation_proof.py), or mutation/survivors.txt must say why.
"""
import argparse
import collections
import concurrent.futures
import functools
import hashlib
import json
import os
import random
import re
import shutil
import signal
import subprocess
import sys
import threading
import time

import mutation_proof

TARGET = os.path.abspath(os.environ.get("CARGO_TARGET_DIR", "target"))
WORK = os.path.join(TARGET, "mutation")
FOVEATE = os.environ.get("FOVEATE", "foveate")
YOSYS = mutation_proof.YOSYS
REASONS = "mutation/survivors.txt"
DESIGNS = "mutation/designs.txt"
LEAVES = "crates/emit/src/leaf.rs"
# Rounds and seed of the vectors of each stage.
STAGES = ((1, 1), (3, 2))
LATER = 1
SLOWER = 12
# After so many of the smallest designs it is asked whether the mutant makes another netlist at all.
QUICK = 3
# What stands between Foveate and Icarus.
KEEPING = os.path.abspath("scripts/keeping")

# ---------------------------------------------------------------------------------------------------------------- designs


class Design:
    """A design with its sources and its vectors."""

    def __init__(self, organization, name, options):
        # A late design is only there for what has survived the others, one with a star is in the sample.
        self.organization, self.late, self.starred, self.name = organization, name.endswith("+"), name.endswith("*"), name.rstrip("+*")
        self.options = options
        self.folder = os.path.join(WORK, "designs", organization, self.name)
        self.lock, self.modules, self.netlists, self.program = threading.Lock(), None, {}, None
        self.vectors, self.seconds, self.digests = {}, {}, {}

    def record(self, stage):
        """Keeps the sources and the vectors of a stage, and how long they take; once."""
        with self.lock:
            if stage in self.seconds:
                return
            # The long vectors of a late design are those that are short elsewhere.
            rounds, seed = STAGES[0 if self.late else stage]
            keep = os.path.join(self.folder, f"stage{stage}")
            done_at = os.path.join(keep, "seconds")
            made_of_at, made_of = os.path.join(keep, "made_of"), json.dumps([executable(), self.options, rounds, seed])
            if not os.path.exists(made_of_at) or open(made_of_at).read() != made_of:
                shutil.rmtree(keep, ignore_errors=True)
                os.makedirs(keep)
                self.simulate(keep, rounds, seed)
                with open(made_of_at, "w") as out:
                    out.write(made_of)
            self.vectors[stage] = os.path.join(keep, "vectors.hex")
            self.sources = keep
            self.files = open(os.path.join(keep, "files")).read().split()
            self.bench = next(name for name in self.files if name.endswith("_replay.v"))
            self.top = self.bench[: -len("_replay.v")]
            self.texts = {name: open(os.path.join(keep, name)).read() for name in self.files}
            self.seconds[stage] = float(open(done_at).read())

    def simulate(self, keep, rounds, seed):
        """Co-simulates without a mutant and keeps what is needed to do so again."""
        env = dict(os.environ, FOVEATE_CACHE="off", KEEP=keep, FOVEATE_IVERILOG=os.path.join(KEEPING, "iverilog"),
                   FOVEATE_VVP=os.path.join(KEEPING, "vvp"))
        command = [FOVEATE, "cosim", "--simulator", "iverilog", "--preset", "bare", "--quiet", "--seed", str(seed),
                   "--replay", os.path.join(keep, "replay"), *self.options]
        if "--rounds" not in self.options:
            command += ["--rounds", str(rounds)]
        done = subprocess.run(command, env=env, capture_output=True, text=True)
        if done.returncode != 0:
            sys.exit(f"mutation: {self.organization} {self.name} does not agree without a mutant: {done.stdout}{done.stderr}")
        # Of processor time: the last line of `times` is that of vvp.
        minutes, seconds = open(os.path.join(keep, "times")).read().split()[2].rstrip("s").split("m")
        with open(os.path.join(keep, "seconds"), "w") as out:
            out.write(str(60 * int(minutes) + float(seconds)))

    def clocks(self, stage):
        """A measure of the length of the vectors."""
        return os.path.getsize(self.vectors[stage])

    def digest(self, phase):
        """Changes with the sources and, where a phase replays them, with the vectors that were recorded first."""
        with self.lock:
            if phase not in self.digests:
                replayed = phase == "long" or phase == "short" and not self.late
                vectors = open(self.vectors[LATER if self.late else 0], "rb").read() if replayed else b""
                texts = json.dumps([self.texts, STAGES], sort_keys=True).encode()
                self.digests[phase] = hashlib.sha256(texts + vectors).hexdigest()
            return self.digests[phase]

    def has(self, module):
        return f"rtl/{module}.v" in self.files

    def compiled(self, module, text):
        """The program for Icarus with another text of a module, if it elaborates, and where it is; addresses and the values of
        parameters, which the code has as constants, are left out."""
        folder = os.path.join(WORK, "run", str(threading.get_ident()))
        os.makedirs(folder, exist_ok=True)
        files = [os.path.join(self.sources, name) for name in self.files]
        if module:
            mutant = os.path.join(folder, f"{module}.v")
            with open(mutant, "w") as out:
                out.write(text)
            files[self.files.index(f"rtl/{module}.v")] = mutant
        path = os.path.join(folder, "program.vvp")
        built = mutation_proof.limited(["iverilog", "-g2005", "-s", f"{self.top}_replay", "-o", path, *files], 60)
        if built.returncode != 0:
            return None, path
        code = re.sub(r"^P_.*\n", "", open(path).read().split("\n# The file index")[0], flags=re.M)
        known = {}
        code = re.sub(r"0x[0-9a-f]{6,}", lambda match: known.setdefault(match[0], str(len(known))), code)
        return hashlib.sha256(code.encode()).hexdigest(), path

    def alike(self, module, text):
        """Whether Icarus makes the same program with another text of a module."""
        self.record(LATER if self.late else 0)
        with self.lock:
            if not self.program:
                self.program = self.compiled(None, None)[0]
        return self.compiled(module, text)[0] == self.program

    def run(self, stage, module, text):
        """`pass`, `fail`, `hang`, `refused` if it does not elaborate, or `same` if it is the same program, of a module with another
        text."""
        self.record(stage)
        with self.lock:
            if not self.program:
                self.program = self.compiled(None, None)[0]
        code, program = self.compiled(module, text)
        if code is None:
            return "refused"
        if code == self.program:
            return "same"
        limit = int(max(10, SLOWER * self.seconds[stage]))
        done = mutation_proof.limited(["vvp", "-n", program, f"+vectors={self.vectors[stage]}", "+stop"], limit, cwd=os.path.dirname(program))
        if done.returncode in (-signal.SIGXCPU, -signal.SIGKILL):
            return "hang"
        last = (done.stdout.strip().splitlines() or [""])[-1]
        if last.startswith("PASS"):
            return "pass"
        if last.startswith("FAIL"):
            return "fail"
        raise RuntimeError(f"{self.name}: the replay says neither PASS nor FAIL: {(done.stdout + done.stderr)[-300:]}")

    def chparam(self):
        """The parameters that the bench gives to the top module, for Yosys."""
        parameters = re.search(rf"^\s*{self.top} #\((.*)\) dut \($", self.texts[self.bench], re.M)
        values = re.findall(r"\.(\w+)\((\d+)\)", parameters.group(1) if parameters else "")
        return "".join(f" -chparam {name} {value}" for name, value in values)

    def variants(self, module):
        """What Yosys calls the module with the parameters that it has in this design."""
        with self.lock:
            if self.modules is None:
                paths = " ".join(os.path.join(self.sources, name) for name in self.files if name != self.bench)
                done = subprocess.run([YOSYS, "-p", f"read_verilog {paths}; hierarchy -top {self.top}{self.chparam()}; tee -o /dev/stderr ls"],
                                      capture_output=True, text=True)
                if done.returncode != 0:
                    sys.exit(f"mutation: Yosys does not read {self.name}: {done.stdout[-300:]}")
                self.modules = [line.strip() for line in done.stderr.splitlines()]
        return [name for name in self.modules if re.fullmatch(rf"(\$paramod(\$\w+)?\\)?{module}(\\.*)?", name)]

    def same(self, module, text, inside=None):
        """Whether Yosys makes the same netlist with another text of a module, of the whole or of the module of that name; None if
        the mutant is none."""
        with self.lock:
            if inside not in self.netlists:
                self.netlists[inside] = mutation_proof.netlist(self, WORK, inside=inside)
        cells, problems = self.netlists[inside]
        mutant, mutant_problems = mutation_proof.netlist(self, WORK, module, text, inside)
        if mutant_problems > problems:
            return None
        return cells is not None and mutant == cells

    def equal(self, module, text, inside=None):
        """Whether the design with another text of a module is proven to be the design; or the module of that name alone."""
        return mutation_proof.equal(self, WORK, module, text, inside)


@functools.cache
def executable():
    """Tells one Foveate from another."""
    return hashlib.sha256(open(FOVEATE, "rb").read()).hexdigest()


def designs(organization):
    """Those of mutation/designs.txt, `organization name options`."""
    for number, line in enumerate(open(DESIGNS), 1):
        words = line.split()
        if not words or line.startswith("#"):
            continue
        if len(words) < 3 or words[0] not in ("pipelined", "serial"):
            sys.exit(f"mutation: {DESIGNS}:{number}: wants `pipelined|serial NAME OPTIONS`")
        if words[0] == organization:
            options = words[2:]
            if organization == "serial":
                options += ["--set", "hardware.organization='serial'"]
            yield Design(organization, words[1], options)


def recorded(organization, jobs, sample):
    """The designs of an organization with their vectors, the shortest first; of a sample only those."""
    found = [design for design in designs(organization) if design.starred or not sample]
    with concurrent.futures.ThreadPoolExecutor(jobs) as pool:
        list(pool.map(lambda design: design.record(LATER if design.late else 0), found))
    return sorted(found, key=lambda design: design.clocks(LATER if design.late else 0))


# ---------------------------------------------------------------------------------------------------------------- mutants

TOKEN = re.compile(r"""
    (?P<skip>\s+|//[^\n]*|/\*.*?\*/|`\w+[^\n]*|\(\*(?!\)).*?\*\))
  | (?P<string>"[^"]*")
  | (?P<based>\d*'[sS]?[bBdDoOhH][0-9a-fA-F_]+)
  | (?P<number>\d+)
  | (?P<word>\$?[A-Za-z_]\w*)
  | (?P<op><<<|>>>|===|!==|<<|>>|<=|>=|==|!=|&&|\|\||\+:|-:|\*\*|.)
""", re.X | re.S)
OTHER = {"+": ["-"], "-": ["+"], "*": ["+"], "&&": ["||"], "||": ["&&"], "==": ["!="], "!=": ["=="], "<": ["<=", ">="], ">": [">=", "<="],
         "<=": ["<", ">"], ">=": [">", "<"], "&": ["|"], "|": ["&"], "^": ["|"], "<<": [">>"], ">>": ["<<"]}
DECLARES = {"input", "output", "wire", "reg", "localparam", "parameter", "integer", "genvar"}
KEYWORDS = DECLARES | {"module", "endmodule", "always", "posedge", "assign", "if", "else", "begin", "end", "case", "endcase", "default",
                       "generate", "endgenerate", "for", "function", "endfunction", "or", "initial", "automatic", "signed"}
OPENS, CLOSES = "([{", ")]}"


class Token:
    def __init__(self, match):
        self.kind, self.text, self.start, self.end = match.lastgroup, match.group(), match.start(), match.end()


def tokens(text):
    found = [Token(match) for match in TOKEN.finditer(text)]
    return [token for token in found if token.kind != "skip"]


def partners(stream):
    """Index of the other bracket of each bracket."""
    stack, other = [], {}
    for index, token in enumerate(stream):
        if token.text in OPENS and token.kind == "op":
            stack.append(index)
        elif token.text in CLOSES and token.kind == "op":
            other[index] = stack.pop()
            other[other[index]] = index
    return other


def statements(stream, other):
    """For each token the index of the first token of its statement, and its depth in brackets."""
    first, start, depth, depths = [], 0, 0, []
    for index, token in enumerate(stream):
        closes = token.kind == "op" and token.text in CLOSES
        depth -= closes
        before = stream[index - 1] if index else None
        if before is not None and depth == 0 and (
            before.text in (";", "begin", "else", "end", "generate", "endgenerate", "endcase")
            or before.text == ")" and stream[other[index - 1] - 1].text in ("if", "for", "case")
            or before.text == ")" and stream[other[index - 1] - 1].text == "@"
            or before.kind == "word" and index > 2 and stream[index - 2].text == ":" and stream[index - 3].text == "begin"
            or before.text == ":" and stream[index - 2].text != "begin" and "?" not in (t.text for t in stream[start:index])
        ):
            start = index
        first.append(start)
        depths.append(depth)
        depth += token.kind == "op" and token.text in OPENS
    return first, depths


def literals(token):
    """Other values of a literal: one more, one less."""
    if token.kind == "number":
        value = int(token.text)
        return [str(other) for other in (value + 1, value - 1) if other >= 0]
    width, rest = token.text.split("'")
    base, digits = rest[0], rest[1:].replace("_", "")
    if base in "sS":
        return []
    radix = {"b": 2, "o": 8, "d": 10, "h": 16}[base.lower()]
    value, bits = int(digits, radix), int(width) if width else 32
    show = {2: f"{{:0{len(digits)}b}}", 8: "{:o}", 10: "{}", 16: "{:x}"}[radix]
    values = {(value + 1) % (1 << bits), (value - 1) % (1 << bits)} - {value}
    return [f"{width}'{base}{show.format(other)}" for other in sorted(values)]


def declared(stream, other):
    """Names and the text of their range, by which they can stand for each other."""
    found, index = {}, 0
    while index < len(stream):
        token = stream[index]
        if token.kind == "word" and token.text in DECLARES - {"genvar", "integer"}:
            at, size = index + 1, ""
            while stream[at].text in ("wire", "reg", "signed"):
                at += 1
            if stream[at].text == "[":
                size = "".join(t.text for t in stream[at:other[at] + 1])
                at = other[at] + 1
            kind = "constant" if token.text in ("localparam", "parameter") else "signal"
            while at < len(stream) and stream[at].kind == "word" and stream[at].text not in KEYWORDS:
                memory = stream[at + 1].text == "["
                found[stream[at].text] = ("memory" if memory else kind, size)
                # Further names of a list without initial values.
                at += 1
                if stream[at].text == "," and stream[at + 1].text not in DECLARES:
                    at += 1
                else:
                    break
        index += 1
    return found


def edits(text, is_top, pick):
    """(operator, start, end, replacement) of every mutation of a module."""
    stream = tokens(text)
    other = partners(stream)
    first, depths = statements(stream, other)
    names = declared(stream, other)
    header = next((i for i, token in enumerate(stream) if token.text == ";"), 0)
    # What is left alone: the steps of loops, and defaults of parameters.
    alone = set()
    for index, token in enumerate(stream):
        if token.text == "for":
            semicolons = [i for i in range(index + 1, other[index + 1]) if stream[i].text == ";"]
            alone.update(range(index, semicolons[0] + 1))
            alone.update(range(semicolons[1], other[index + 1] + 1))
        elif token.text == "@" and stream[index + 1].text == "(":
            alone.update(range(index, other[index + 1] + 1))
    assigned_at, ranges = {}, {}
    for index, token in enumerate(stream):
        if depths[index] == 0 and token.text in ("=", "<=") and first[index] not in assigned_at:
            head = stream[first[index]].text
            if token.text == "=" or head not in DECLARES | {"assign"}:
                assigned_at[first[index]] = index
        if token.text == "[":
            head = stream[first[index]].text
            inside = stream[index + 1:other[index]]
            before_value = first[index] not in assigned_at
            before = stream[index - 1].text
            if index < header:
                before_value = before in DECLARES | {"signed"}
            if (head in DECLARES or index < header) and before_value and any(t.text == ":" for t in inside):
                for i in range(index, other[index] + 1):
                    ranges[i] = index
    found = []

    def edit(operator, start, end, replacement):
        found.append((operator, start, end, replacement))

    for index, token in enumerate(stream):
        start, end = token.start, token.end
        if index in ranges:
            # Narrower: one bit, or one word, less.
            if ranges[index] == index and not (is_top and index < header):
                colon = next(i for i in range(index, other[index]) if stream[i].text == ":")
                upwards = stream[index + 1].text == "0" and colon == index + 2
                at = stream[other[index]].start if upwards else stream[colon].start
                if stream[first[index]].text not in ("parameter",):
                    edit("range", at, at, "-1")
            continue
        if index < header or index in alone:
            continue
        statement, assigned = first[index], assigned_at.get(first[index])
        before = stream[index - 1]
        operand = before.kind in ("word", "number", "based") and before.text not in KEYWORDS or before.text in CLOSES
        if token.kind == "op" and token.text in OTHER:
            if token.text == "<=" and index == assigned:
                # A dropped assignment keeps the value.
                close = next(i for i in range(index, len(stream)) if stream[i].text == ";" and depths[i] == 0)
                target = text[stream[statement].start:start].strip()
                edit("drop", stream[index + 1].start, stream[close].start, target)
            elif operand:
                for replacement in OTHER[token.text]:
                    edit("operator", start, end, replacement)
            elif token.text in "&|":
                edit("operator", start, end, OTHER[token.text][0])
        elif token.kind == "op" and token.text in "!~" and not operand:
            edit("negation", start, end, "")
        elif token.text == "?":
            at, depth = index, 0
            while True:
                at -= 1
                if stream[at].text in CLOSES and stream[at].kind == "op":
                    at = other[at]
                elif stream[at].text in ("=", "(", "[", "{", ",", ":", "?") or at == assigned:
                    break
            edit("selection", stream[at + 1].start, start, f"!({text[stream[at + 1].start:start].strip()}) ")
        elif token.text == "if" and stream[index + 1].text == "(":
            inner = stream[index + 1].end, stream[other[index + 1]].start
            edit("condition", *inner, f"!({text[inner[0]:inner[1]]})")
            edit("condition", *inner, "1'b0")
            edit("condition", *inner, "1'b1")
        elif token.kind in ("number", "based"):
            if before.text == "'" or stream[index - 1].text == "#":
                continue
            for replacement in literals(token):
                edit("constant", start, end, replacement)
        elif token.text == "[" and before.kind == "word" and before.text in names:
            # An index one further, if it is no constant.
            inner = stream[index + 1:other[index]]
            if any(t.kind == "word" for t in inner) and not any(t.text == ":" for t in inner):
                at = next((i for i in range(index, other[index]) if stream[i].text in ("+:", "-:")), other[index])
                edit("index", stream[at].start, stream[at].start, " + 1")
        elif token.kind == "word" and token.text in names and token.text != "clk_i":
            declares = stream[statement].text in DECLARES and (assigned is None or index < assigned)
            written = assigned is not None and index < assigned and depths[index] == 0
            connected = before.text == "."
            if declares or written or connected:
                continue
            same = sorted(name for name, what in names.items()
                          if what == names[token.text] and name not in (token.text, "clk_i") and what[0] != "memory")
            if same:
                edit("name", start, end, pick(f"{start}").choice(same))
    return found


class Mutant:
    """One edit of one module; `design` where the module is rendered for that design."""

    def __init__(self, module, design, text, operator, start, end, replacement):
        self.module, self.design, self.operator = module, design, operator
        self.text = text[:start] + replacement + text[end:]
        self.line = text.count("\n", 0, start) + 1
        low, high = text.rfind("\n", 0, start) + 1, text.find("\n", end)
        flat = lambda piece: " ".join(piece.split())
        self.was = flat(text[low:high])
        self.now = flat(text[low:start] + replacement + text[end:high])
        self.verdict = self.by = self.proof = None
        # Designs in which the code that is changed is not elaborated.
        self.apart = set()

    def pointless(self):
        """Whether it only touches a wire that tells lint what is not used, or gives a wire to itself."""
        own = re.match(r"(?:wire|assign)\b.*?(\w+)(?:\[[^=]*\])? = (.*)", self.now)
        return "unused_" in self.was or bool(self.operator == "name" and own and re.search(rf"\b{own[1]}\b", own[2]))

    def key(self):
        return self.place(), self.was, self.now

    def place(self):
        return f"{self.module}@{self.design.name}" if self.design else self.module

    def __str__(self):
        return f"{self.place()}:{self.line} {self.operator}\n    - {self.was}\n    + {self.now}"


def pools(all_of, seed):
    """All mutants of each module, in the order in which they are drawn: the operators take turns."""
    leaves = re.findall(r'^    "(\w+)" => \[', open(LEAVES).read(), re.M)
    texts, pools = {}, {}
    for design in all_of:
        for name, text in design.texts.items():
            module = re.fullmatch(r"rtl/(\w+)\.v", name)
            if not module:
                continue
            module = module.group(1)
            # A leaf is the same text everywhere; a rendered module is the design's own.
            if module in leaves:
                texts[module] = (module, None, text)
            else:
                texts[f"{module}@{design.name}"] = (module, design, text)
    for place, (module, design, text) in sorted(texts.items()):
        def pick(where, place=place):
            return random.Random(f"{seed}:{place}:{where}")

        groups, seen = collections.defaultdict(list), {text}
        for operator, start, end, replacement in edits(text, design is not None, pick):
            mutant = Mutant(module, design, text, operator, start, end, replacement)
            if mutant.text not in seen:
                seen.add(mutant.text)
                groups[operator].append(mutant)
        turns = []
        for operator in sorted(groups):
            pick(operator).shuffle(groups[operator])
            size = len(groups[operator])
            turns += [((rank + pick(f"{operator}{rank}").random()) / size, operator, rank) for rank in range(size)]
        pools[place] = [groups[operator][rank] for _, operator, rank in sorted(turns)]
    return pools


def wanted(pools, count):
    """How many mutants of each module: as the root of how many there are, and at least four."""
    takes = {place: min(4, len(pool)) for place, pool in pools.items()}
    while sum(takes.values()) < count:
        open_places = [place for place in pools if takes[place] < len(pools[place])]
        if not open_places:
            break
        takes[max(open_places, key=lambda place: len(pools[place]) ** 0.5 / (takes[place] + 1))] += 1
    return takes


# ---------------------------------------------------------------------------------------------------------------- verdicts


def reasons():
    """The reviewed survivors: a paragraph each, `place`, `- line`, `+ line`, `reason`."""
    found = {}
    for paragraph in re.split(r"\n\s*\n", open(REASONS).read()):
        lines = [line.strip() for line in paragraph.splitlines() if line.strip() and not line.startswith("#")]
        if not lines:
            continue
        if len(lines) < 4 or not lines[1].startswith("- ") or not lines[2].startswith("+ "):
            sys.exit(f"mutation: {REASONS}: wants a place, `- line`, `+ line` and a reason: {lines[0]}")
        found[lines[0], lines[1][2:], lines[2][2:]] = " ".join(lines[3:])
    return found


class Journal:
    """What has been found of each mutant, so that an interrupted run can go on."""

    def __init__(self, all_of):
        self.all_of, self.lock, self.path, self.found = all_of, threading.Lock(), os.path.join(WORK, "journal"), {}
        for line in open(self.path) if os.path.exists(self.path) else ():
            key, *verdict = json.loads(line)
            self.found[key] = verdict

    def key(self, mutant, phase):
        of = [design.digest(phase) for design in containing(mutant, self.all_of)]
        return hashlib.sha256(json.dumps([sorted(of), mutant.place(), mutant.text, phase]).encode()).hexdigest()

    def ask(self, phase, mutant, find):
        """Sets the verdict: what is known, or what `find` says."""
        key = self.key(mutant, phase)
        if key not in self.found:
            find(mutant)
            with self.lock, open(self.path, "a") as out:
                print(json.dumps([key, mutant.verdict, mutant.by, mutant.proof]), file=out)
        else:
            mutant.verdict, mutant.by, mutant.proof = self.found[key]


def replay(mutant, designs, stage):
    """Whether the vectors of a design decide; the verdict then is `refused` or `killed`."""
    for design in designs:
        if design.name in mutant.apart:
            continue
        outcome = design.run(stage, mutant.module, mutant.text)
        if outcome == "refused":
            mutant.verdict = "refused"
        elif outcome == "same":
            mutant.apart.add(design.name)
        elif outcome != "pass":
            mutant.verdict, mutant.by = "killed", (stage, design.name, outcome)
        if mutant.verdict:
            return True
    return False


def judge(mutant, all_of, prove):
    """Sets the verdict of the short vectors and of the netlists: `refused`, `killed`, `equivalent` or `survived`."""
    if mutant.pointless():
        mutant.verdict = "refused"
        return
    contain = [design for design in containing(mutant, all_of) if not design.late]
    if replay(mutant, contain[:QUICK], 0):
        return
    found = everywhere(mutant, all_of, "same") if prove else False
    if found is not False:
        mutant.verdict, mutant.proof = "refused" if found is None else "equivalent", "same"
        return
    if replay(mutant, contain[QUICK:], 0):
        return
    # A leaf is small beside the designs around it and the longer vectors of all of them.
    if prove and not mutant.design and everywhere(mutant, all_of, "equal", around=False):
        mutant.verdict, mutant.proof = "equivalent", "equal"
        return
    mutant.verdict = "survived"


def judge_longer(mutant, all_of):
    """The same of the longer vectors."""
    mutant.verdict = None
    if not replay(mutant, containing(mutant, all_of), LATER):
        mutant.verdict = "survived"


def containing(mutant, all_of):
    return [mutant.design] if mutant.design else [design for design in all_of if design.has(mutant.module)]


def everywhere(mutant, all_of, proof, around=True):
    """Whether the proof holds for the module with the parameters of every design, or else the design around it, if that is to be
    tried; None if the proof says so."""
    known = {}
    for design in containing(mutant, all_of):
        if design.name in mutant.apart:
            continue
        if design.late and design.alike(mutant.module, mutant.text):
            mutant.apart.add(design.name)
            continue
        variants = design.variants(mutant.module)
        for name in variants:
            if name not in known:
                known[name] = getattr(design, proof)(mutant.module, mutant.text, name)
            if known[name] is None:
                return None
            if not (known[name] or around and design.top not in variants):
                return False
        if not all(known[name] for name in variants) and not getattr(design, proof)(mutant.module, mutant.text):
            return False
    return True


def prove(mutant, all_of):
    if everywhere(mutant, all_of, "equal"):
        mutant.verdict, mutant.proof = "equivalent", "equal"


def drawn(pools, takes, pool, check):
    """The mutants that elaborate and have a point, as many of each module as wanted."""
    at, kept = collections.Counter(), collections.defaultdict(list)
    while True:
        batch = []
        for place, mutants in pools.items():
            missing = takes[place] - len(kept[place])
            batch += mutants[at[place]:at[place] + missing]
            at[place] += missing
        if not batch:
            return [mutant for place in pools for mutant in kept[place]]
        list(pool.map(check, batch))
        for mutant in batch:
            if mutant.verdict != "refused":
                kept[mutant.place()].append(mutant)


def examine(organization, options, excuses, used):
    began = time.monotonic()
    all_of = recorded(organization, options.jobs, options.sample)
    found = pools(all_of, options.seed)
    takes = wanted(found, options.count)
    print(f"{organization}: {len(all_of)} designs recorded in {time.monotonic() - began:.0f} s, {len(found)} modules with"
          f" {sum(map(len, found.values()))} possible mutants", flush=True)
    journal = Journal(all_of)
    with concurrent.futures.ThreadPoolExecutor(options.jobs) as pool:
        if options.sample:
            # Every so many of the mutants of a whole run of these designs.
            whole = [mutant for place in found for mutant in found[place][:takes[place]]]
            step = len(whole) / options.sample
            chosen = collections.defaultdict(list)
            for index in range(options.sample):
                mutant = whole[int((index + 0.5) * step)]
                chosen[mutant.place()].append(mutant)
            found = {place: chosen[place] + [m for m in found[place] if m not in chosen[place]] for place in chosen}
            takes = {place: len(chosen[place]) for place in chosen}
        mutants = drawn(found, takes, pool, lambda mutant: journal.ask("short", mutant, lambda it: judge(it, all_of, options.prove)))
        survivors = [mutant for mutant in mutants if mutant.verdict in ("survived", "equivalent")]
        unknown = [mutant for mutant in survivors if mutant.verdict == "survived"]
        if options.sample:
            # A sample does without the other designs, unless something has survived that they may kill.
            unknown = [mutant for mutant in unknown if mutant.key() not in excuses]
            for mutant in unknown:
                others = [design for design in designs(organization) if not (design.starred or mutant.design)]
                mutant.verdict = None
                for design in others:
                    stage = LATER if design.late else 0
                    design.record(stage)
                    if design.has(mutant.module) and replay(mutant, [design], stage):
                        break
                mutant.verdict = mutant.verdict or "survived"
        elif options.longer:
            list(pool.map(lambda mutant: journal.ask("long", mutant, lambda it: judge_longer(it, all_of)), unknown))
            unknown = [mutant for mutant in unknown if mutant.key() not in excuses]
        unknown = [mutant for mutant in unknown if mutant.verdict == "survived"]
        if options.prove:
            if options.longer:
                list(pool.map(lambda mutant: journal.ask("proof", mutant, lambda it: prove(it, all_of)), unknown))
            # The proofs must tell: what was killed in the same module is not equal.
            proven = {mutant.place(): mutant.proof for mutant in survivors if mutant.proof}
            controls = [mutant for mutant in {m.place(): m for m in mutants if m.verdict == "killed" and m.place() in proven}.values()]
            wrong = pool.map(lambda mutant: everywhere(mutant, all_of, proven[mutant.place()]), controls)
            for mutant in [mutant for mutant, claim in zip(controls, wrong) if claim]:
                sys.exit(f"mutation: proven equal is what the vectors tell apart: {mutant}")
    # Another design may show that a mutant is none: it does not elaborate there.
    mutants, survivors = ([mutant for mutant in of if mutant.verdict != "refused"] for of in (mutants, survivors))
    open_ones = 0
    for mutant in survivors:
        if mutant.verdict == "survived" and mutant.key() in excuses:
            mutant.verdict = "excused"
            used.add(mutant.key())
        if mutant.verdict == "survived":
            open_ones += 1
            print(f"SURVIVES {mutant}")
        elif options.verbose:
            print(f"{mutant.verdict}{f' ({mutant.proof})' if mutant.proof else ''} {mutant}")
    if options.table:
        print(f"  {'module':28} mutants  killed  equivalent  excused")
        for place in found:
            of = [mutant.verdict for mutant in mutants if mutant.place() == place]
            print(f"  {place:28} {len(of):7} {of.count('killed'):7} {of.count('equivalent'):11} {of.count('excused'):8}")
    count = collections.Counter(mutant.verdict for mutant in mutants)
    alike = sum(1 for mutant in mutants if mutant.verdict == "equivalent" and mutant.proof == "same")
    longer = sum(1 for mutant in mutants if mutant.by and mutant.by[0] > 0)
    hangs = sum(1 for mutant in mutants if mutant.by and mutant.by[2] == "hang")
    print(f"{organization}: {len(mutants)} mutants of {len(found)} modules: {count['killed']} killed ({longer} of them by the longer vectors,"
          f" {hangs} by time), {count['equivalent']} proven equivalent ({alike} of them by the same netlist), {count['excused']} excused with a reason, {open_ones} open;"
          f" {time.monotonic() - began:.0f} s", flush=True)
    return open_ones


def main():
    parser = argparse.ArgumentParser(prog="mutation.sh", description="Mutants of the Verilog against the co-simulation vectors.")
    parser.add_argument("organizations", nargs="*", metavar="ORGANIZATION", help="pipelined, serial; by default both")
    parser.add_argument("--count", type=int, default=320, help="mutants of an organization (%(default)s)")
    parser.add_argument("--sample", type=int, metavar="N", help="only N of them, evenly spread, in the smallest designs; the others only for survivors")
    parser.add_argument("--seed", type=int, default=1, help="seed of the mutants (%(default)s)")
    parser.add_argument("--jobs", type=int, default=int(os.environ.get("JOBS", os.cpu_count() or 1)), help="at a time (%(default)s)")
    parser.add_argument("--table", action="store_true", help="print a table by module")
    parser.add_argument("--verbose", action="store_true", help="print the survivors that are proven or excused, too")
    parser.add_argument("--no-proofs", dest="prove", action="store_false", help="do not try to prove survivors equivalent")
    parser.add_argument("--no-longer", dest="longer", action="store_false", help="leave survivors of the short vectors open")
    parser.add_argument("--resume", action="store_true", help="go on where a run was ended; what other designs or vectors touch is found anew")
    options = parser.parse_args()
    organizations = options.organizations or ["pipelined", "serial"]
    if set(organizations) - {"pipelined", "serial"}:
        parser.error(f"an organization is pipelined or serial, not {' '.join(organizations)}")
    if not options.resume:
        shutil.rmtree(WORK, ignore_errors=True)
    excuses, used = reasons(), set()
    open_ones = sum(examine(organization, options, excuses, used) for organization in organizations)
    unused = []
    if not options.sample and options.prove and len(organizations) == 2 and (options.seed, options.count) == (1, 320):
        unused = [key for key in excuses if key not in used]
        for place, was, now in unused:
            print(f"{REASONS}: no survivor needs this; remove it: {place}\n    - {was}\n    + {now}")
    sys.exit(1 if open_ones or unused else 0)


main()

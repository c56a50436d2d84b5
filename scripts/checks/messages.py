#!/usr/bin/env python3
# SPDX-License-Identifier: MIT OR Apache-2.0
"""Collects every text that a user may see in one file, so that a person can read all of them at once.

    scripts/checks/messages.py --write    writes crates/messages.txt
    scripts/checks/messages.py --check    fails if that file differs from the sources

The file has one line per text, `crate/file: text`. A text that occurs twice in a source file has one line, and lines have no
numbers, so code can move inside its file. These are texts:

* the message of each `#[error("…")]`;
* each paragraph of the help of a command: doc comments of types that derive a trait of clap, and of their fields and variants;
* any other literal with two words. Tests, messages of panics (`expect`, `assert!`), reasons of lints, and lines of Verilog,
  scripts and style sheets are left out;
* in Python and JavaScript each literal with two words, without docstrings; in HTML the text between tags, and attributes that
  a browser shows.
"""

import argparse
import ast
import difflib
import re
import sys
from html.parser import HTMLParser
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
GOLDEN = ROOT / "crates/messages.txt"
PLACEHOLDER = re.compile(r"\$?\{[^{}]*\}")
TWO_WORDS = re.compile(r"\b[A-Za-z][a-z'-]*[,;:.)\"'`]* +[(\"'`]*[a-z]{2,}\b")
# Lines of other languages that the program writes or reads: Verilog, Tcl, shell, C++, style sheets, SVG, HTTP.
CODE = re.compile(
    r"^\s*(?:assign|wire|reg|input|output|inout|localparam|parameter|module|always|initial|begin|end|integer|generate|set_\w+|"
    r"create_clock|read_\w+|write_\w+|export|exec|static|const|int|void|var|sw)\b.*[;\[({}=]"
    r"|^\s*(?:synth_|#include|-[a-z:]+ |--\w+ (?:\"|--|\{\w+\} --)|text/|HTTP/|[a-z]+-(?:src|uri) |width=|\(prefers-|\w+ \w+\[|\(\w+(?:=None)?, )"
    r"|<[a-z]+ [a-z-]+=[\"'\\]|\b[a-z-]+: *[\w#.% -]+;|posedge|\w <= .*;$"
)
# Files whose texts are data.
DATA = {"web/class_names.js"}
TEST_FILE = re.compile(r"(?:^|/)(?:tests|benches|examples)(?:/|\.rs$)")
TEST_ITEM = re.compile(r"^( *)#\[cfg\((?:all\()?test\b[^\n]*\n(?:[^\n{]*;\n|.*?^\1\};?\n)", re.S | re.M)
TEST_MODULE = re.compile(r"#\[cfg\((?:all\()?test\b[^\n]*\n\s*(?:pub(?:\(\w+\))? )?mod (\w+);")
TOKEN = re.compile(
    r"""///(?!/)\ ?(?P<help>[^\n]*) | //[^\n]* | /\*.*?\*/
    | b?r(?P<hashes>\#*)"(?P<raw>.*?)"(?P=hashes) | [bc]?"(?P<literal>(?:\\.|[^"\\])*)"
    | b?'(?:\\(?:u\{[^}]*\}|x..|.)|[^\\'])' | '\w+ | (?P<word>[A-Za-z_]\w*!?) | (?P<sign>[^\s])""",
    re.S | re.X,
)
# A literal between the brackets of one of these macros, methods and attributes is not shown to a user.
HIDDEN = {
    *("expect", "expect_err", "panic!", "unreachable!", "todo!", "assert!", "assert_eq!", "assert_ne!", "debug_assert!"),
    *("cfg", "cfg_attr", "allow", "deny", "serde", "must_use", "template", "doc", "deprecated"),
}
CLAP = {"Args", "Parser", "Subcommand", "ValueEnum"}
ESCAPES = {"n": "\n", "t": "\t", "r": "\r", "0": "\0"}
TEMPLATE_TAG = re.compile(r"\{[%#].*?[%#]\}", re.S)
TEMPLATE_VALUE = re.compile(r"\{\{.*?\}\}", re.S)
SHOWN_ATTRIBUTES = {"title", "alt", "placeholder", "aria-label", "label", "content"}
SCRIPT = re.compile(
    r"""//[^\n]*|/\*.*?\*/|(?P<quote>["'`])(?P<text>(?:\\.|(?!(?P=quote))[^\\])*)(?P=quote)|[=(,:]\s*/(?![/*])(?:\\.|[^/\\\n])+/""", re.S
)


def is_message(text):
    """Returns whether a literal has two words and is no line of another language."""
    return bool(TWO_WORDS.search(PLACEHOLDER.sub("", text))) and not CODE.search(text)


def value_of(literal):
    """Returns the value of a string literal without its quotes. Continued lines become one."""
    joined = re.sub(r"\\\n\s*", "", literal)
    plain = re.sub(r"\\u\{(\w+)\}", lambda found: chr(int(found[1], 16)), joined)
    return re.sub(r"\\(.)", lambda found: ESCAPES.get(found[1], found[1]), plain)


class RustReader:
    """Collects the texts of a Rust file token by token."""

    def __init__(self):
        """Starts before the first token."""
        self.texts = []
        self.brackets = []
        self.words = ["", ""]
        self.help = [[]]
        self.derives_clap = False

    def read(self, source):
        """Returns the texts of a source without its tests."""
        for token in TOKEN.finditer(TEST_ITEM.sub("", source)):
            if token["help"] is not None:
                self.help[-1].append(token["help"].strip())
            elif token["literal"] is not None or token["raw"] is not None:
                self.literal(value_of(token["literal"]) if token["raw"] is None else token["raw"])
            elif token["word"]:
                self.word(token["word"])
            elif token["sign"]:
                self.sign(token["sign"])
        return self.texts

    def literal(self, text):
        """Keeps a literal that a user may see."""
        is_error = self.words[-2:] == ["error", "("]
        if is_error or (is_message(text) and not HIDDEN.intersection(self.brackets)):
            self.texts.append(text)
        self.words.append("")

    def word(self, word):
        """Notes a name, which may be that of an attribute or of a derived trait."""
        if self.words[-2:] == ["#", "["]:
            self.brackets[-1] = word
        if word in CLAP and "derive" in self.brackets:
            self.derives_clap = True
        self.words.append(word)

    def sign(self, sign):
        """Follows brackets. The help that stands before or in an item is kept at the end of an item that derives clap."""
        if sign in "([{":
            self.brackets.append(self.words[-1])
        elif sign in ")]}":
            self.brackets.pop()
        if not self.brackets and sign in ";}":
            if self.derives_clap:
                self.texts.extend(paragraph for lines in self.help for paragraph in paragraphs(lines))
            self.help, self.derives_clap = [[]], False
        elif self.help[-1]:
            self.help.append([])
        self.words = [*self.words[-2:], sign]


def paragraphs(lines):
    """Returns the paragraphs of the lines of a comment."""
    return [" ".join(part.split("\n")) for part in "\n".join(lines).split("\n\n") if part.strip()]


def rust_files(folder):
    """Returns the Rust files in a folder that are no tests."""
    files = [file for file in sorted(folder.rglob("*.rs")) if not TEST_FILE.search(file.relative_to(folder).as_posix())]
    tests = set()
    for file in files:
        own = file.parent if file.name in ("lib.rs", "main.rs", "mod.rs") else file.with_suffix("")
        tests.update(own / f"{name}.rs" for name in TEST_MODULE.findall(file.read_text(encoding="utf-8")))
    return [file for file in files if file not in tests]


def python_texts(source):
    """Returns the texts of a Python file without its docstrings."""
    tree = ast.parse(source)
    docstrings = {id(node.value) for node in ast.walk(tree) if isinstance(node, ast.Expr)}
    parts = {id(part) for node in ast.walk(tree) if isinstance(node, ast.JoinedStr) for part in ast.walk(node) if part is not node}
    texts = []
    for node in ast.walk(tree):
        if id(node) in docstrings or id(node) in parts:
            continue
        if isinstance(node, ast.Constant) and isinstance(node.value, str):
            texts.append(node.value)
        elif isinstance(node, ast.JoinedStr):
            texts.append("".join(str(part.value) if isinstance(part, ast.Constant) else f"{{{ast.unparse(part.value)}}}" for part in node.values))
    return [text for text in texts if is_message(text)]


def script_texts(source):
    """Returns the texts of a JavaScript file."""
    texts = [value_of(found["text"]) for found in SCRIPT.finditer(source) if found["quote"]]
    return [text for text in texts if is_message(text)]


class PageReader(HTMLParser):
    """Collects the texts of a page and of its attributes that a browser shows."""

    def __init__(self):
        """Starts with no text."""
        super().__init__()
        self.texts = []
        self.is_code = False

    def handle_starttag(self, tag, attrs):
        """Keeps the attributes of a tag."""
        self.is_code = tag in ("script", "style")
        self.texts.extend(value for name, value in attrs if name in SHOWN_ATTRIBUTES and value)

    def handle_data(self, data):
        """Keeps the text between two tags."""
        if not self.is_code:
            self.texts.append(data)


def page_texts(source):
    """Returns the texts of a page, or of a template of one."""
    reader = PageReader()
    reader.feed(TEMPLATE_VALUE.sub("{}", TEMPLATE_TAG.sub(" ", source)))
    return [text for text in (" ".join(text.split()) for text in reader.texts) if is_message(text)]


def sources():
    """Yields each file that may hold texts, with the function that finds them."""
    for folder in [*sorted(ROOT.glob("crates/*/src")), ROOT / "python/src", ROOT / "web/engine/src"]:
        yield from ((file, lambda source: RustReader().read(source)) for file in rust_files(folder))
    yield from ((file, python_texts) for file in sorted(ROOT.glob("python/foveate/**/*.py")))
    for folder in [ROOT / "web", *sorted(ROOT.glob("crates/*/src")), *sorted(ROOT.glob("crates/*/templates"))]:
        files = [file for file in sorted(folder.rglob("*")) if not file.relative_to(folder).as_posix().startswith("tests/")]
        yield from ((file, script_texts) for file in files if file.suffix == ".js")
        yield from ((file, page_texts) for file in files if file.suffix == ".html")


def collected():
    """Returns the lines of the golden file."""
    lines = []
    for file, texts in sources():
        path = file.relative_to(ROOT).as_posix()
        name = path.removeprefix("crates/").replace("/src/", "/", 1)
        found = {text.strip() for text in texts(file.read_text(encoding="utf-8"))}
        lines.extend(f"{name}: {text}".replace("\n", "\\n") for text in sorted(found) if path not in DATA)
    return lines


def main():
    """Writes the golden file, or compares it."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    action = parser.add_mutually_exclusive_group(required=True)
    action.add_argument("--write", action="store_true", help="write crates/messages.txt")
    action.add_argument("--check", action="store_true", help="compare crates/messages.txt with the sources")
    lines = collected()
    if parser.parse_args().write:
        GOLDEN.write_text("\n".join(lines) + "\n", encoding="utf-8")
        return
    golden = GOLDEN.read_text(encoding="utf-8").splitlines()
    difference = list(difflib.unified_diff(golden, lines, GOLDEN.name, "sources", lineterm="", n=0))
    if difference:
        print("\n".join(difference))
        sys.exit("messages: texts have changed; read them, and run `scripts/checks/messages.py --write`")


if __name__ == "__main__":
    main()

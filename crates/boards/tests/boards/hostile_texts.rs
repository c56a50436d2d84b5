// SPDX-License-Identifier: MIT OR Apache-2.0
//! Data files with hostile texts, one for each place at which a file may hold a text. The places
//! are found by trials of the reader and not from a list, so that a new key is tested, too.

use std::collections::BTreeSet;

use toml::{Table, Value};

/// The file that a command in one of the texts makes.
pub(crate) const CANARY: &str = "canary";

/// A key, or an index in an array.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum PathStep {
    Key(String),
    Place(usize),
}

/// Returns texts with a meaning in a shell, Tcl, Verilog, TOML, YAML, HTML, Markdown, a terminal or
/// a file system.
pub(crate) fn texts() -> Vec<String> {
    let touch = format!("touch {CANARY}");
    let mut texts: Vec<String> = [
        "up5k; TOUCH; :",
        "$(TOUCH)",
        "`TOUCH`",
        "a\nTOUCH\n#",
        "a\r\nTOUCH",
        "'; TOUCH; '",
        "\"; TOUCH; \"",
        "a && TOUCH",
        "a | TOUCH",
        "a > CANARY",
        "x' \"y\" `z`",
        "[exec TOUCH]",
        "} ; exec TOUCH ; {",
        "a\\",
        "\\",
        "{",
        "]",
        "$argv0",
        "*/ TOUCH /*",
        "a */ x",
        "`include \"/etc/passwd\"",
        "a\n`include \"/etc/passwd\"",
        "synopsys translate_off",
        "verilator lint_off WIDTH",
        "</script><script>alert(1)</script>",
        "<img src=x onerror=alert(1)>",
        "](javascript:alert(1))",
        "**x** | [y](z)",
        "--->",
        "&lt;",
        "-flag",
        "--run=x.py",
        "..",
        ".",
        "../x",
        "/etc/passwd",
        "*",
        "~",
        "",
        " ",
        "a b",
        "# x",
        ": x",
        "!sh TOUCH",
        "%s%n",
        "\u{0}",
        "a\u{0}b",
        "\u{1b}[2J",
        "\u{7f}",
        "\u{85}",
        "a\u{2028}TOUCH",
        "\u{202e}abc",
        "Ümläut 目",
        "\t",
        "javascript:alert(1)",
        "http://x/\"onclick=\"y",
        "https://x/)[y](z",
        "run",
        "json",
    ]
    .into_iter()
    .map(|text| text.replace("TOUCH", &touch).replace("CANARY", CANARY))
    .collect();
    texts.push("x".repeat(100_000));
    texts
}

/// The places at which a file may hold a text. `base` is a valid file, and `complaint` returns the
/// reader's error for a file.
pub(crate) struct TextPlaces<'a> {
    pub(crate) base: Table,
    pub(crate) complaint: &'a dyn Fn(&Table) -> Option<String>,
}

impl TextPlaces<'_> {
    /// Returns every place at which the base has a text, and every place at which the reader would
    /// accept one.
    pub(crate) fn places(&self) -> BTreeSet<Vec<PathStep>> {
        let mut places = BTreeSet::new();
        self.search(&Value::Table(self.base.clone()), &mut Vec::new(), &mut places);
        places
    }

    /// Returns every key that the base has or that the reader accepts, without the keys above it.
    pub(crate) fn keys(&self) -> BTreeSet<String> {
        let mut keys = BTreeSet::new();
        let mut pending = vec![(Vec::new(), Value::Table(self.base.clone()))];
        while let Some((path, value)) = pending.pop() {
            let Value::Table(table) = value else { continue };
            keys.extend(self.accepted_keys(&path));
            for (key, value) in table {
                let mut place = path.clone();
                place.push(PathStep::Key(key.clone()));
                keys.insert(key);
                pending.push((place, value));
            }
        }
        keys
    }

    /// Returns the base with a value at a place.
    pub(crate) fn with_value(&self, place: &[PathStep], value: Value) -> Table {
        let mut root = Value::Table(self.base.clone());
        set_value(&mut root, place, value);
        root.as_table().unwrap().clone()
    }

    fn search(
        &self,
        value: &Value,
        above: &mut Vec<PathStep>,
        places: &mut BTreeSet<Vec<PathStep>>,
    ) {
        match value {
            Value::String(_) => drop(places.insert(above.clone())),
            Value::Array(values) => {
                for (place, value) in values.iter().enumerate() {
                    above.push(PathStep::Place(place));
                    self.search(value, above, places);
                    above.pop();
                }
            }
            Value::Table(table) => {
                for (key, value) in table {
                    above.push(PathStep::Key(key.clone()));
                    self.search(value, above, places);
                    above.pop();
                }
                for key in
                    self.accepted_keys(above).into_iter().filter(|key| !table.contains_key(key))
                {
                    above.push(PathStep::Key(key));
                    self.search_unused(above, places);
                    above.pop();
                }
            }
            _ => {}
        }
    }

    /// Returns the keys that the reader names when it finds an unknown one.
    fn accepted_keys(&self, table: &[PathStep]) -> Vec<String> {
        let mut place = table.to_vec();
        place.push(PathStep::Key("zzz".to_owned()));
        let message =
            (self.complaint)(&self.with_value(&place, Value::Integer(1))).unwrap_or_default();
        let Some((_, expected)) = message.rsplit_once("expected") else { return Vec::new() };
        expected.split('`').skip(1).step_by(2).map(str::to_owned).collect()
    }

    /// Adds the places below a key that the base does not have, if the reader accepts a text, a
    /// list of texts, or a table with texts there.
    fn search_unused(&self, key: &[PathStep], places: &mut BTreeSet<Vec<PathStep>>) {
        for inner in self.accepted_keys(key) {
            let mut inside = key.to_vec();
            inside.push(PathStep::Key(inner));
            self.search_unused(&inside, places);
        }
        let text = || Value::String("a1".to_owned());
        let is_no_type = |value: Value| {
            let message = (self.complaint)(&self.with_value(key, value)).unwrap_or_default();
            message.contains("invalid type") || message.contains("unknown variant")
        };
        if !is_no_type(text()) {
            places.insert(key.to_vec());
        }
        if !is_no_type(Value::Array(vec![text()])) {
            let mut first = key.to_vec();
            first.push(PathStep::Place(0));
            places.insert(first);
        }
    }
}

fn set_value(value: &mut Value, place: &[PathStep], new: Value) {
    match place {
        [] => *value = new,
        [PathStep::Key(key), rest @ ..] => {
            let table = value.as_table_mut().unwrap();
            let is_list = matches!(rest.first(), Some(PathStep::Place(_)));
            let empty =
                || if is_list { Value::Array(Vec::new()) } else { Value::Table(Table::new()) };
            set_value(table.entry(key.clone()).or_insert_with(empty), rest, new);
        }
        [PathStep::Place(place), rest @ ..] => {
            let values = value.as_array_mut().unwrap();
            if values.len() == *place {
                values.push(Value::Boolean(false));
            }
            set_value(&mut values[*place], rest, new);
        }
    }
}

/// Returns the name of the key at a place, as a message should have it.
pub(crate) fn key_name(place: &[PathStep]) -> &str {
    let name = |step: &PathStep| matches!(step, PathStep::Key(_));
    match place.iter().rfind(|step| name(step)) {
        Some(PathStep::Key(key)) => key,
        _ => "",
    }
}

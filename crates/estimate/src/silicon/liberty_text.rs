// SPDX-License-Identifier: MIT OR Apache-2.0
//! The text of a liberty file as groups with attributes and groups inside.
//!
//! A file of a process has millions of numbers in tables of delays and energies. They are skipped
//! unless they are asked for: [`parse_library`] keeps only attributes of the form `name : value`.

use std::iter::Peekable;
use std::str::CharIndices;

/// The largest number of groups inside each other. A library has about six.
const MAX_DEPTH: usize = 64;

/// A group, such as `cell (NAND2X1) { ... }`.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub(super) struct LibertyGroup {
    /// The kind of the group: `library`, `cell`, `pin`.
    pub(super) kind: String,
    /// The first argument, which is the name; empty without arguments.
    pub(super) name: String,
    pub(super) other_arguments: Vec<String>,
    /// The simple attributes in order.
    attributes: Vec<(String, String)>,
    /// The attributes with arguments, such as `index_1 ("0.1, 0.2")`, if they are kept.
    lists: Vec<(String, Vec<String>)>,
    pub(super) groups: Vec<LibertyGroup>,
}

impl LibertyGroup {
    /// Returns the value of a simple attribute, without quotes; the last one if there are several.
    pub(super) fn attribute(&self, name: &str) -> Option<&str> {
        self.attributes.iter().rev().find(|(own, _)| own == name).map(|(_, value)| value.as_str())
    }

    /// Returns the arguments of an attribute; the last ones if there are several.
    pub(super) fn list(&self, name: &str) -> Option<&[String]> {
        self.lists.iter().rev().find(|(own, _)| own == name).map(|(_, list)| list.as_slice())
    }

    pub(super) fn groups_of<'a>(&'a self, kind: &'a str) -> impl Iterator<Item = &'a Self> {
        self.groups.iter().filter(move |group| group.kind == kind)
    }
}

/// A fault of the text, with the line in which it was found.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct LibertyFault {
    pub(super) line: usize,
    pub(super) problem: String,
}

#[derive(Clone, Debug, PartialEq, Eq)]
enum LibertyToken<'a> {
    /// A word, or a text in quotes without them.
    Word(&'a str),
    Symbol(char),
}

/// Reads the one library of a file, without its tables.
pub(super) fn parse_library(text: &str) -> Result<LibertyGroup, LibertyFault> {
    parse(text, false)
}

/// Reads the one library of a file with its tables.
pub(super) fn parse_tables(text: &str) -> Result<LibertyGroup, LibertyFault> {
    parse(text, true)
}

fn parse(text: &str, keeps_lists: bool) -> Result<LibertyGroup, LibertyFault> {
    let mut reader = LibertyReader { tokens: LibertyTokens::new(text), depth: 0, keeps_lists };
    let mut top = LibertyGroup::default();
    reader.read_statements(&mut top, true)?;
    let line = reader.tokens.line;
    let mut libraries = top.groups.into_iter().filter(|group| group.kind == "library");
    let fault = |problem: &str| LibertyFault { line, problem: problem.to_owned() };
    let library = libraries.next().ok_or_else(|| fault("there is no group `library`"))?;
    match libraries.next() {
        None => Ok(library),
        Some(_) => Err(fault("there is a second group `library`; give each a file of its own")),
    }
}

struct LibertyReader<'a> {
    tokens: LibertyTokens<'a>,
    depth: usize,
    keeps_lists: bool,
}

impl<'a> LibertyReader<'a> {
    /// Reads statements up to the brace that ends the group, or to the end of the text.
    fn read_statements(
        &mut self,
        group: &mut LibertyGroup,
        is_top: bool,
    ) -> Result<(), LibertyFault> {
        loop {
            match self.tokens.next()? {
                None if is_top => return Ok(()),
                None => return Err(self.fault("the file ends within a group".to_owned())),
                Some((LibertyToken::Symbol('}'), _)) if !is_top => return Ok(()),
                Some((LibertyToken::Symbol(';'), _)) => {}
                Some((LibertyToken::Word(name), _)) => self.read_statement(name, group)?,
                Some((LibertyToken::Symbol(symbol), _)) => {
                    return Err(self.fault(format!("`{symbol}` stands where a name is expected")));
                }
            }
        }
    }

    /// Reads what follows a name: a value, or arguments and perhaps a group.
    fn read_statement(&mut self, name: &str, group: &mut LibertyGroup) -> Result<(), LibertyFault> {
        match self.tokens.next()? {
            Some((LibertyToken::Symbol(':'), line)) => {
                let value = self.read_value(line)?;
                group.attributes.push((name.to_owned(), value));
                Ok(())
            }
            Some((LibertyToken::Symbol('('), _)) => {
                let mut arguments = self.read_arguments()?.into_iter().map(str::to_owned);
                if self.tokens.peek()? != Some(LibertyToken::Symbol('{')) {
                    if self.keeps_lists {
                        group.lists.push((name.to_owned(), arguments.collect()));
                    }
                    return Ok(());
                }
                self.tokens.next()?;
                self.depth += 1;
                if self.depth > MAX_DEPTH {
                    return Err(self.fault(format!(
                        "there are more than {MAX_DEPTH} groups inside each other"
                    )));
                }
                let mut inner = LibertyGroup {
                    kind: name.to_owned(),
                    name: arguments.next().unwrap_or_default(),
                    other_arguments: arguments.collect(),
                    ..LibertyGroup::default()
                };
                self.read_statements(&mut inner, false)?;
                self.depth -= 1;
                group.groups.push(inner);
                Ok(())
            }
            _ => Err(self.fault(format!("`{name}` has neither `:` nor `(` behind it"))),
        }
    }

    /// Reads a value, which ends at `;`, at the end of its line, or before the end of the group.
    fn read_value(&mut self, line: usize) -> Result<String, LibertyFault> {
        let mut words: Vec<&str> = Vec::new();
        loop {
            match self.tokens.peek()? {
                Some(LibertyToken::Word(word))
                    if words.is_empty() || self.tokens.line_of_next() == line =>
                {
                    self.tokens.next()?;
                    words.push(word);
                }
                _ if words.is_empty() => {
                    return Err(self.fault("`:` has no value behind it".to_owned()));
                }
                _ => return Ok(words.join(" ")),
            }
        }
    }

    /// Reads arguments up to `)`.
    fn read_arguments(&mut self) -> Result<Vec<&'a str>, LibertyFault> {
        let mut arguments = Vec::new();
        loop {
            match self.tokens.next()? {
                Some((LibertyToken::Word(word), _)) => arguments.push(word),
                Some((LibertyToken::Symbol(')'), _)) => return Ok(arguments),
                Some((LibertyToken::Symbol(',' | ':'), _)) => {}
                Some((LibertyToken::Symbol(symbol), _)) => {
                    return Err(self.fault(format!("`{symbol}` stands among arguments")));
                }
                None => return Err(self.fault("the file ends among arguments".to_owned())),
            }
        }
    }

    fn fault(&self, problem: String) -> LibertyFault {
        LibertyFault { line: self.tokens.line, problem }
    }
}

struct LibertyTokens<'a> {
    text: &'a str,
    letters: Peekable<CharIndices<'a>>,
    /// The line of the last letter that was read, from 1 on.
    line: usize,
    /// The next token, if it was read already, with its line.
    next: Option<Option<(LibertyToken<'a>, usize)>>,
}

impl<'a> LibertyTokens<'a> {
    fn new(text: &'a str) -> Self {
        Self { text, letters: text.char_indices().peekable(), line: 1, next: None }
    }

    fn next(&mut self) -> Result<Option<(LibertyToken<'a>, usize)>, LibertyFault> {
        match self.next.take() {
            Some(token) => Ok(token),
            None => self.read(),
        }
    }

    fn peek(&mut self) -> Result<Option<LibertyToken<'a>>, LibertyFault> {
        if self.next.is_none() {
            self.next = Some(self.read()?);
        }
        Ok(self.next.as_ref().and_then(|token| token.as_ref()).map(|(token, _)| token.clone()))
    }

    /// Returns the line of the token that was peeked at.
    fn line_of_next(&self) -> usize {
        self.next.as_ref().and_then(|token| token.as_ref()).map_or(self.line, |(_, line)| *line)
    }

    fn step(&mut self) -> Option<(usize, char)> {
        let letter = self.letters.next();
        self.line += usize::from(matches!(letter, Some((_, '\n'))));
        letter
    }

    fn read(&mut self) -> Result<Option<(LibertyToken<'a>, usize)>, LibertyFault> {
        while let Some((start, letter)) = self.step() {
            let line = self.line;
            match letter {
                '\\' => {}
                letter if letter.is_whitespace() => {}
                '/' if self.letters.peek().is_some_and(|&(_, next)| next == '*') => {
                    self.skip_comment()?;
                }
                '/' if self.letters.peek().is_some_and(|&(_, next)| next == '/') => {
                    while self.step().is_some_and(|(_, letter)| letter != '\n') {}
                }
                '"' => {
                    let text = self.read_quoted(start + 1)?;
                    return Ok(Some((LibertyToken::Word(text), line)));
                }
                '(' | ')' | '{' | '}' | ';' | ':' | ',' => {
                    return Ok(Some((LibertyToken::Symbol(letter), line)));
                }
                _ => return Ok(Some((LibertyToken::Word(self.read_word(start)), line))),
            }
        }
        Ok(None)
    }

    fn skip_comment(&mut self) -> Result<(), LibertyFault> {
        let line = self.line;
        self.step();
        let mut last = ' ';
        while let Some((_, letter)) = self.step() {
            if (last, letter) == ('*', '/') {
                return Ok(());
            }
            last = letter;
        }
        Err(LibertyFault { line, problem: "a comment has no end".to_owned() })
    }

    fn read_quoted(&mut self, start: usize) -> Result<&'a str, LibertyFault> {
        let line = self.line;
        while let Some((at, letter)) = self.step() {
            match letter {
                '\\' => drop(self.step()),
                '"' => return Ok(&self.text[start..at]),
                _ => {}
            }
        }
        Err(LibertyFault { line, problem: "a text has no closing quote".to_owned() })
    }

    fn read_word(&mut self, start: usize) -> &'a str {
        let ends = |letter: char| letter.is_whitespace() || "(){};:,\"\\".contains(letter);
        while let Some(&(at, letter)) = self.letters.peek() {
            let is_comment = ["/*", "//"].iter().any(|mark| self.text[at..].starts_with(mark));
            if ends(letter) || is_comment {
                return &self.text[start..at];
            }
            self.step();
        }
        &self.text[start..]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const SMALL: &str = r#"
        /* a comment: { ( */
        library ("small") {
            nom_voltage : 1.8; // another { comment
            time_unit : "1ns"
            capacitive_load_unit (1, pf);
            lu_table_template (a) { index_1 ("0.1, 0.2"); }
            cell (NAND2) { area : 4/* um2 */ ;
                pin (A) { direction : input; }
                pin ("Y") { direction : "output"; function : "!(A B)";
                    timing () { cell_rise (a) { values ("1, 2", \
                        "3, 4"); } }
                }
            }
            cell (EMPTY) { }
        }"#;

    #[test]
    fn groups_and_attributes_are_read() {
        let library = parse_library(SMALL).unwrap();
        assert_eq!(
            (library.name.as_str(), library.attribute("nom_voltage")),
            ("small", Some("1.8"))
        );
        assert_eq!(library.attribute("time_unit"), Some("1ns"));
        let cells: Vec<_> = library.groups_of("cell").collect();
        assert_eq!(
            cells.iter().map(|cell| cell.name.as_str()).collect::<Vec<_>>(),
            ["NAND2", "EMPTY"]
        );
        assert_eq!((cells[0].attribute("area"), cells[1].attribute("area")), (Some("4"), None));
        let output = cells[0].groups_of("pin").nth(1).unwrap();
        assert_eq!(output.attribute("function"), Some("!(A B)"));
        assert_eq!(output.groups_of("timing").count(), 1);
        assert_eq!(library.list("capacitive_load_unit"), None);
    }

    #[test]
    fn tables_are_kept_on_request() {
        let library = parse_tables(SMALL).unwrap();
        assert_eq!(library.list("capacitive_load_unit").unwrap(), ["1", "pf"]);
        let template = library.groups_of("lu_table_template").next().unwrap();
        assert_eq!(template.list("index_1").unwrap(), ["0.1, 0.2"]);
        let cell = library.groups_of("cell").next().unwrap();
        let timing = cell.groups_of("pin").nth(1).unwrap().groups_of("timing").next().unwrap();
        let table = timing.groups_of("cell_rise").next().unwrap();
        assert_eq!(table.list("values").unwrap(), ["1, 2", "3, 4"]);
        let library = parse_tables("library (a) { cell (b) { ff (IQ, IQN) { } } }").unwrap();
        let state = &library.groups[0].groups[0];
        assert_eq!(
            (state.name.as_str(), &state.other_arguments[..]),
            ("IQ", &["IQN".to_owned()][..])
        );
    }

    #[test]
    fn faults_have_a_line() {
        let deep = format!("library (a) {{ {}", "b () {".repeat(100));
        for (text, line, words) in [
            ("", 1, "no group `library`"),
            ("library (a) { }\nlibrary (b) { }", 2, "a second group"),
            ("library (a) {\n\n cell (b) {", 3, "ends within a group"),
            ("library (a) {\n area }", 2, "`area` has neither"),
            ("library (a) {\n area : ; }", 2, "no value"),
            ("library (a) {\n area : \"1 }", 2, "no closing quote"),
            ("/* library", 1, "no end"),
            ("library (a) { , }", 1, "`,` stands where a name"),
            ("library ( { }", 1, "among arguments"),
            ("library (a", 1, "ends among arguments"),
            (&deep, 1, "more than 64 groups"),
        ] {
            let fault = parse_library(text).unwrap_err();
            assert!(fault.line == line && fault.problem.contains(words), "{text}: {fault:?}");
        }
    }

    /// A library that is cut anywhere, or has a wrong letter anywhere, is read or refused.
    #[test]
    fn damaged_texts_never_panic() {
        for at in 0..SMALL.len() {
            let _ = parse_library(&SMALL[..at]);
            for letter in ["{", "}", "(", "\"", ";", "\\", "/", "*", "\u{e9}"] {
                let _ = parse_library(&format!("{}{letter}{}", &SMALL[..at], &SMALL[at + 1..]));
            }
        }
    }
}

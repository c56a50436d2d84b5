// SPDX-License-Identifier: MIT OR Apache-2.0
//! The functions of pins of a liberty library.
//!
//! The operators are `!` before and `'` behind an operand, `^` for exclusive or, `&`, `*` and a
//! space for and, `|` and `+` for or. Each of them binds stronger than those that stand behind it
//! in this list.

/// The largest number of inputs of a function of which a table is made.
const MAX_INPUTS: usize = 4;
/// The largest number of parts inside each other.
const MAX_DEPTH: usize = 64;

/// A logic function of numbered inputs.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum LogicFunction {
    /// A fixed value.
    Constant(bool),
    /// The input of this number.
    Input(usize),
    /// The inverse of a function.
    Not(Box<Self>),
    /// True if all functions are.
    And(Vec<Self>),
    /// True if any function is.
    Or(Vec<Self>),
    /// True if an odd number of functions is.
    Xor(Vec<Self>),
}

impl LogicFunction {
    /// Reads a function; an input is numbered by its place in `inputs`. Returns `None` for a text
    /// that is no function of these inputs.
    pub(super) fn parse(function: &str, inputs: &[&str]) -> Option<Self> {
        let mut parser = FunctionParser { text: function.trim(), inputs, depth: 0 };
        let function = parser.or()?;
        parser.text.is_empty().then_some(function)
    }

    /// Computes 64 values at once, one per bit. `input` returns those of an input.
    pub fn evaluate(&self, input: &impl Fn(usize) -> u64) -> u64 {
        match self {
            Self::Constant(value) => u64::from(*value).wrapping_neg(),
            Self::Input(number) => input(*number),
            Self::Not(inner) => !inner.evaluate(input),
            Self::And(parts) => parts.iter().fold(u64::MAX, |all, part| all & part.evaluate(input)),
            Self::Or(parts) => parts.iter().fold(0, |any, part| any | part.evaluate(input)),
            Self::Xor(parts) => parts.iter().fold(0, |odd, part| odd ^ part.evaluate(input)),
        }
    }
}

/// Returns the value of a function for every combination of its inputs; bit i of the number of a
/// combination is the value of input i. Returns `None` for more than four inputs, and for a text
/// that is no function of these inputs.
pub(super) fn truth_table(function: &str, inputs: &[&str]) -> Option<Vec<bool>> {
    if inputs.len() > MAX_INPUTS {
        return None;
    }
    let function = LogicFunction::parse(function, inputs)?;
    let value = |combination: usize| {
        function.evaluate(&|input| u64::from(combination >> input & 1 == 1)) & 1 == 1
    };
    Some((0..1 << inputs.len()).map(value).collect())
}

/// The parser of the rest of a text.
struct FunctionParser<'a> {
    text: &'a str,
    inputs: &'a [&'a str],
    depth: usize,
}

impl FunctionParser<'_> {
    fn or(&mut self) -> Option<LogicFunction> {
        let mut parts = vec![self.and()?];
        while self.takes(&['|', '+']) {
            parts.push(self.and()?);
        }
        Some(joined(parts, LogicFunction::Or))
    }

    fn and(&mut self) -> Option<LogicFunction> {
        let mut parts = vec![self.exclusive_or()?];
        // An operand behind an operand is the and of both.
        while self.takes(&['&', '*']) || self.text.starts_with(is_start) {
            parts.push(self.exclusive_or()?);
        }
        Some(joined(parts, LogicFunction::And))
    }

    fn exclusive_or(&mut self) -> Option<LogicFunction> {
        let mut parts = vec![self.operand()?];
        while self.takes(&['^']) {
            parts.push(self.operand()?);
        }
        Some(joined(parts, LogicFunction::Xor))
    }

    fn operand(&mut self) -> Option<LogicFunction> {
        let mut value = if self.takes(&['!']) {
            self.depth += 1;
            LogicFunction::Not(Box::new(self.bounded(Self::primary)?))
        } else {
            self.primary()?
        };
        let mut is_inverted = false;
        while self.takes(&['\'']) {
            is_inverted = !is_inverted;
        }
        if is_inverted {
            value = LogicFunction::Not(Box::new(value));
        }
        Some(value)
    }

    fn primary(&mut self) -> Option<LogicFunction> {
        if self.text.starts_with('!') {
            return self.operand();
        }
        if self.takes(&['(']) {
            self.depth += 1;
            let value = self.bounded(Self::or)?;
            return self.takes(&[')']).then_some(value);
        }
        let is_name = |letter: char| letter.is_alphanumeric() || "_[]".contains(letter);
        let end = self.text.find(|letter| !is_name(letter)).unwrap_or(self.text.len());
        let (name, rest) = self.text.split_at(end);
        self.text = rest.trim_start();
        match name {
            "" => None,
            "0" => Some(LogicFunction::Constant(false)),
            "1" => Some(LogicFunction::Constant(true)),
            _ => {
                let input = self.inputs.iter().position(|input| *input == name)?;
                Some(LogicFunction::Input(input))
            }
        }
    }

    /// Reads a part, unless parts are nested too deeply.
    fn bounded(&mut self, part: fn(&mut Self) -> Option<LogicFunction>) -> Option<LogicFunction> {
        if self.depth > MAX_DEPTH {
            return None;
        }
        let value = part(self);
        self.depth -= 1;
        value
    }

    /// Takes one of the letters, if it comes next, and the spaces behind it.
    fn takes(&mut self, letters: &[char]) -> bool {
        let rest = self.text.strip_prefix(letters);
        if let Some(rest) = rest {
            self.text = rest.trim_start();
        }
        rest.is_some()
    }
}

fn joined(
    mut parts: Vec<LogicFunction>,
    join: fn(Vec<LogicFunction>) -> LogicFunction,
) -> LogicFunction {
    match parts.len() {
        1 => parts.remove(0),
        _ => join(parts),
    }
}

/// Returns true if an operand may begin with this letter.
fn is_start(letter: char) -> bool {
    letter.is_alphanumeric() || letter == '_' || letter == '(' || letter == '!'
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn functions_of_libraries_are_evaluated() {
        let nand = Some(vec![true, true, true, false]);
        for text in ["(!(A B))", "(!A) | (!B)", "!(A*B)", "!(A&B)", "A' + B'", "(A & B)'", "!A+!B"]
        {
            assert_eq!(truth_table(text, &["A", "B"]), nand, "{text}");
        }
        assert_eq!(truth_table("A", &["A"]), Some(vec![false, true]));
        assert_eq!(truth_table("((A))", &["A"]), Some(vec![false, true]));
        assert_eq!(truth_table("A^B", &["A", "B"]), Some(vec![false, true, true, false]));
        let mixed = truth_table("A B ^ C + !C", &["A", "B", "C"]).unwrap();
        let expected = (0..8).map(|n| {
            let [a, b, c] = [0, 1, 2].map(|bit| n >> bit & 1 == 1);
            a && (b ^ c) || !c
        });
        assert_eq!(mixed, expected.collect::<Vec<_>>());
        assert_eq!(truth_table("1", &[]), Some(vec![true]));
    }

    #[test]
    fn other_texts_are_no_functions() {
        let deep = "(".repeat(1000) + "A";
        for text in ["", "A +", "(A", "A)", "Q", "A B C D E", &deep, &"!".repeat(1000)] {
            assert_eq!(truth_table(text, &["A", "B"]), None, "{text}");
        }
        assert_eq!(truth_table("A", &["A", "B", "C", "D", "E"]), None);
        assert_eq!(truth_table("A''", &["A"]), Some(vec![false, true]));
        assert_eq!(truth_table("(A B)'''", &["A", "B"]), Some(vec![true, true, true, false]));
    }
}

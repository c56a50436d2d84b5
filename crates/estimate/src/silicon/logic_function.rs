// SPDX-License-Identifier: MIT OR Apache-2.0
//! The function of an output pin of a liberty library, as a table of truth values.
//!
//! The operators are `!` before and `'` behind an operand, `^` for exclusive or, `&`, `*` and a space for
//! and, `|` and `+` for or. Each of them binds stronger than those that stand behind it in this list.

/// The largest number of inputs of a function that is evaluated.
const MAX_INPUTS: usize = 4;

/// Returns the value of a function for every combination of its inputs; bit i of the number of a
/// combination is the value of input i. Returns `None` for more than four inputs, and for a text
/// that is no function of these inputs.
pub(super) fn truth_table(function: &str, inputs: &[&str]) -> Option<Vec<bool>> {
    if inputs.len() > MAX_INPUTS {
        return None;
    }
    let value = |combination: usize| {
        let mut evaluation =
            FunctionEvaluation { text: function.trim(), inputs, combination, depth: 0 };
        let value = evaluation.or()?;
        evaluation.text.is_empty().then_some(value)
    };
    (0..1 << inputs.len()).map(value).collect()
}

/// The evaluation of the rest of a text for one combination of inputs.
struct FunctionEvaluation<'a> {
    text: &'a str,
    inputs: &'a [&'a str],
    combination: usize,
    depth: usize,
}

impl FunctionEvaluation<'_> {
    fn or(&mut self) -> Option<bool> {
        let mut value = self.and()?;
        while self.takes(&['|', '+']) {
            value |= self.and()?;
        }
        Some(value)
    }

    fn and(&mut self) -> Option<bool> {
        let mut value = self.exclusive_or()?;
        // An operand behind an operand is the and of both.
        while self.takes(&['&', '*']) || self.text.starts_with(is_start) {
            value &= self.exclusive_or()?;
        }
        Some(value)
    }

    fn exclusive_or(&mut self) -> Option<bool> {
        let mut value = self.operand()?;
        while self.takes(&['^']) {
            value ^= self.operand()?;
        }
        Some(value)
    }

    fn operand(&mut self) -> Option<bool> {
        let mut value = if self.takes(&['!']) {
            self.depth += 1;
            !self.bounded(Self::primary)?
        } else {
            self.primary()?
        };
        while self.takes(&['\'']) {
            value = !value;
        }
        Some(value)
    }

    fn primary(&mut self) -> Option<bool> {
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
            "0" => Some(false),
            "1" => Some(true),
            _ => {
                let input = self.inputs.iter().position(|input| *input == name)?;
                Some(self.combination >> input & 1 == 1)
            }
        }
    }

    /// Evaluates a part, unless parts are nested too deeply.
    fn bounded(&mut self, part: fn(&mut Self) -> Option<bool>) -> Option<bool> {
        if self.depth > 64 {
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
    }
}

// SPDX-License-Identifier: MIT OR Apache-2.0
//! A font of 3 x 5 dots for the legends of pictures: one octal digit per row, from the top.

/// The columns and rows of a letter, without the space after it.
pub(super) const SIZE: (u32, u32) = (3, 5);

/// Returns true if the letter has a dot at column `x` and row `y`. Letters become capitals; unknown
/// characters become a space.
pub(super) fn has_dot(letter: char, x: u32, y: u32) -> bool {
    let rows = letter_rows(letter.to_ascii_uppercase());
    let row = rows >> (3 * (SIZE.1 - 1 - y));
    row >> (SIZE.0 - 1 - x) & 1 == 1
}

fn letter_rows(letter: char) -> u32 {
    match letter {
        'A' => 0o25755,
        'B' => 0o65656,
        'C' => 0o34443,
        'D' => 0o65556,
        'E' => 0o74647,
        'F' => 0o74644,
        'G' => 0o34553,
        'H' => 0o55755,
        'I' => 0o72227,
        'J' => 0o11152,
        'K' => 0o55655,
        'L' => 0o44447,
        'M' => 0o57755,
        'N' => 0o65555,
        'O' => 0o25552,
        'P' => 0o65644,
        'Q' => 0o25573,
        'R' => 0o65655,
        'S' => 0o34216,
        'T' => 0o72222,
        'U' => 0o55557,
        'V' => 0o55552,
        'W' => 0o55775,
        'X' => 0o55255,
        'Y' => 0o55222,
        'Z' => 0o71247,
        '0' => 0o75557,
        '1' => 0o26227,
        '2' => 0o71747,
        '3' => 0o71717,
        '4' => 0o55711,
        '5' => 0o74717,
        '6' => 0o74757,
        '7' => 0o71122,
        '8' => 0o75757,
        '9' => 0o75717,
        '.' => 0o00002,
        '-' => 0o00700,
        '%' => 0o51245,
        _ => 0,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_letter_f_has_the_dots_of_an_f() {
        let row =
            |y| (0..3).map(|x| if has_dot('f', x, y) { '#' } else { '.' }).collect::<String>();
        assert_eq!([0, 1, 2, 3, 4].map(row), ["###", "#..", "##.", "#..", "#.."]);
    }

    #[test]
    fn letters_differ() {
        let known: Vec<char> = ('A'..='Z').chain('0'..='9').chain(".-%".chars()).collect();
        for (index, &letter) in known.iter().enumerate() {
            assert!(letter_rows(letter) != 0 && letter_rows(letter) < 0o100_000);
            // A zero and an O, or a five and an S, may look similar but not equal.
            assert!(
                known[..index].iter().all(|&other| letter_rows(other) != letter_rows(letter)),
                "{letter}"
            );
        }
    }
}

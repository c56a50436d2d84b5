// SPDX-License-Identifier: MIT OR Apache-2.0
//! The command line in a form that a shell reads.

use foveate_tools::escaping::shell_word;

/// Joins the words, and quotes those that a shell would split or expand.
pub(super) fn shell_command(words: &[String]) -> String {
    words.iter().map(|word| shell_word(word)).collect::<Vec<_>>().join(" ")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_shell_reads_the_words_back() {
        let words =
            ["foveate", "infer", "my net.onnx", "it's <&>.mp4", "", "--tune", "psnr=40", "$HOME"];
        let words = words.map(str::to_owned);
        let line = shell_command(&words);
        assert!(line.starts_with("foveate infer 'my net.onnx' "), "{line}");
        assert!(line.ends_with(" '' --tune psnr=40 '$HOME'"), "{line}");
        let told = std::process::Command::new("sh")
            .args(["-c", &format!("printf '%s\\n' {line}")])
            .output()
            .unwrap();
        assert_eq!(String::from_utf8(told.stdout).unwrap(), words.join("\n") + "\n");
    }
}

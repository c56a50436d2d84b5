// SPDX-License-Identifier: MIT OR Apache-2.0
//! The tests that the command line accepts the examples of every help text.

use clap::{CommandFactory as _, Parser as _};

use super::Cli;

/// Returns the command lines in a help text: `ffmpeg ... | foveate simulate - -o out` has one.
fn examples(help: &str) -> Vec<Vec<String>> {
    let commands = help.lines().flat_map(|line| line.split(" | ")).filter_map(|part| {
        let command = &part[part.find("foveate ")?..];
        // A redirection of the output is for the shell, and no argument of the command.
        let command = command.split(" > ").next().unwrap_or(command);
        Some(command.split_whitespace().map(str::to_owned).collect())
    });
    commands.collect()
}

#[test]
fn every_command_has_examples_that_it_takes() {
    let mut cli = Cli::command();
    cli.build();
    let commands: Vec<_> = cli.get_subcommands().filter(|c| c.get_name() != "help").collect();
    assert!(commands.len() >= 14);
    for command in commands {
        let name = command.get_name();
        let help = command.get_after_help().map(ToString::to_string).unwrap_or_default();
        assert!(help.starts_with("Example"), "{name}: {help}");
        let examples = examples(&help);
        assert!(!examples.is_empty(), "{name} has no example: {help}");
        for example in examples {
            assert_eq!(example[1], name, "an example of another command");
            if let Err(error) = Cli::try_parse_from(&example) {
                panic!("{}: {error}", example.join(" "));
            }
        }
    }
}

#[test]
fn an_example_with_a_mistake_would_be_found() {
    let [first, second] =
        &examples("Examples: foveate check --fsp 3\n   a | foveate chek - > b")[..]
    else {
        panic!("two examples")
    };
    for example in [first, second] {
        assert!(Cli::try_parse_from(example).is_err(), "{example:?}");
    }
}

// SPDX-License-Identifier: MIT OR Apache-2.0
//! The test of the page `docs/commands.md`, which shows the command line as clap sees it, in
//! Markdown. It fails if the page is not current.
//! `FOVEATE_WRITE_PAGES=1 cargo test -p foveate commands_page` writes the page.

use super::Cli;
use clap::{Arg, Command, CommandFactory};
use std::collections::HashMap;
use std::fmt::Write;
use std::{env, fs, path::Path};

/// The number of commands from which on an option that they share, word for word, is listed once at
/// the end of the page.
const SHARED_FROM: usize = 4;
const SHARED_TITLE: &str = "Options of several commands";

#[test]
fn commands_page_is_current() {
    let file = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../docs/commands.md");
    let page = page();
    if env::var_os("FOVEATE_WRITE_PAGES").is_some() {
        fs::write(&file, &page).unwrap();
    }
    let written = fs::read_to_string(&file).unwrap();
    let differ = written.lines().zip(page.lines()).find(|(written, wanted)| written != wanted);
    assert!(
        written == page,
        "docs/commands.md is not current, first at {differ:?}; \
         FOVEATE_WRITE_PAGES=1 cargo test -p foveate commands_page writes it"
    );
}

fn page() -> String {
    let mut cli = Cli::command();
    cli.build();
    let commands: Vec<&Command> =
        cli.get_subcommands().filter(|command| command.get_name() != "help").collect();
    let mut uses: HashMap<String, usize> = HashMap::new();
    for arg in commands.iter().flat_map(|command| options(command)) {
        *uses.entry(option_row(arg)).or_default() += 1;
    }

    let mut page = String::from(
        "# Commands\n\n<!-- Written from the command line itself, see crates/cli/src/args/page.rs. -->\n\n\
         `foveate COMMAND --help` prints the same in a terminal.\n\n",
    );
    let after = cli.get_after_help().map(ToString::to_string).unwrap_or_default();
    writeln!(page, "{after}\n").unwrap();
    page += "| command | |\n| --- | --- |\n";
    for command in &commands {
        let name = command.get_name();
        writeln!(page, "| [`{name}`](#{name}) | {} |", about(command)).unwrap();
    }
    for command in &commands {
        write_section(&mut page, command, &uses);
    }

    writeln!(page, "\n## {SHARED_TITLE}\n").unwrap();
    let mut rows: Vec<String> = Vec::new();
    for row in commands.iter().flat_map(|command| options(command)).map(option_row) {
        if uses[&row] >= SHARED_FROM && !rows.contains(&row) {
            rows.push(row);
        }
    }
    write_table(&mut page, &rows);
    page
}

fn write_section(page: &mut String, command: &Command, uses: &HashMap<String, usize>) {
    let usage = command.clone().render_usage().to_string().replace("Usage: ", "");
    let long = command.get_long_about().map_or_else(|| about(command), ToString::to_string);
    writeln!(page, "\n## {}\n\n{long}\n\n```text\n{usage}\n```", command.get_name()).unwrap();

    let own = |arg: &&Arg| uses.get(&option_row(arg)).is_none_or(|count| *count < SHARED_FROM);
    let mut headings: Vec<Option<&str>> = vec![None];
    for heading in options(command).filter(own).map(Arg::get_help_heading) {
        if !headings.contains(&heading) {
            headings.push(heading);
        }
    }
    for heading in headings {
        let positional = command.get_positionals().filter(|_| heading.is_none());
        let rows: Vec<String> = positional
            .chain(options(command).filter(own).filter(|arg| arg.get_help_heading() == heading))
            .map(option_row)
            .collect();
        if rows.is_empty() {
            continue;
        }
        page.push('\n');
        if let Some(heading) = heading {
            writeln!(page, "**{heading}**\n").unwrap();
        }
        write_table(page, &rows);
    }

    let shared: Vec<String> = options(command)
        .filter(|arg| !own(arg))
        .filter_map(|arg| Some(format!("`--{}`", arg.get_long()?)))
        .collect();
    if !shared.is_empty() {
        writeln!(page, "\nAlso [{}](#options-of-several-commands).", shared.join(", ")).unwrap();
    }
    let after = command.get_after_help().map(ToString::to_string).unwrap_or_default();
    let examples =
        after.replace("Examples: ", "").replace("Example: ", "").replace("\n          --", " --");
    let examples: Vec<&str> = examples.lines().map(str::trim).collect();
    writeln!(page, "\n```sh\n{}\n```", examples.join("\n")).unwrap();
}

fn about(command: &Command) -> String {
    command.get_about().map(ToString::to_string).unwrap_or_default()
}

fn options(command: &Command) -> impl Iterator<Item = &Arg> {
    command
        .get_arguments()
        .filter(|arg| !arg.is_positional() && !arg.is_hide_set() && arg.get_id() != "help")
}

fn write_table(page: &mut String, rows: &[String]) {
    *page += "| option | |\n| --- | --- |\n";
    for row in rows {
        writeln!(page, "{row}").unwrap();
    }
}

fn option_row(arg: &Arg) -> String {
    let short = arg.get_short().map(|short| format!("-{short}, ")).unwrap_or_default();
    let help = arg.get_long_help().or_else(|| arg.get_help());
    let mut text = help.map(ToString::to_string).unwrap_or_default().replace('\n', " ");
    let values: Vec<String> = arg
        .get_possible_values()
        .iter()
        .filter(|_| arg.get_action().takes_values())
        .map(|value| match value.get_help() {
            Some(help) => format!("`{}` ({help})", value.get_name()),
            None => format!("`{}`", value.get_name()),
        })
        .collect();
    if !values.is_empty() {
        write!(text, ". Values: {}", values.join(", ")).unwrap();
    }
    if let ([default], true) = (arg.get_default_values(), arg.get_action().takes_values()) {
        write!(text, ". Default: `{}`", default.to_string_lossy()).unwrap();
    }
    if let Some(aliases) = arg.get_visible_aliases().filter(|aliases| !aliases.is_empty()) {
        let aliases: Vec<String> = aliases.iter().map(|alias| format!("`--{alias}`")).collect();
        write!(text, ". Also {}", aliases.join(", ")).unwrap();
    }
    format!("| `{short}{arg}` | {} |", text.replace('|', "\\|"))
}

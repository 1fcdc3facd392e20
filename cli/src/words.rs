//! The command line: its commands, and the messages about mistakes.

use std::error::Error;
use std::ffi::OsString;

use clap::error::{ContextKind, ContextValue, ErrorKind};
use clap::{CommandFactory, FromArgMatches, Parser, Subcommand};

use crate::failure::{EXIT_STATUS, Failure};
use crate::options::{IGNORED_BY_DOS, Moment};
use crate::typo::COMMANDS;
use crate::{cases, cost, demo, dos, explain, generate, list, output, palette, plan, render, scenes, typo, verify};

/// Columns of help, at most.
const WIDTH: usize = 100;

/// Draw scenes and models as a 386 with a VGA card did
///
/// Frames have 320 x 200 pixels and a palette of 256 colours. `mode13h INPUT` is short for `mode13h demo INPUT` and takes
/// the same options; `mode13h demo --help` explains them all.
#[derive(Parser)]
#[command(name = "mode13h", version, args_conflicts_with_subcommands = true)]
pub(crate) struct Words {
    #[command(subcommand)]
    command: Option<Command>,
    #[command(flatten)]
    demo: demo::Options,
    /// Print no progress and no notes
    ///
    /// File names and the reports of `cost` and `verify` are left out, too; warnings, errors, JSON, lists, plans and
    /// explanations are not.
    #[arg(short, long, global = true, help_heading = None::<&str>)]
    quiet: bool,
}

#[derive(Subcommand)]
enum Command {
    /// Show a scene or a model in a window
    ///
    /// This is the default command. An INPUT is reloaded when one of its files changes; errors are shown in the
    /// window. Without a display, one frame of each INPUT is saved under the first free name of mode13h-0001.png,
    /// mode13h-0002.png and so on.
    Demo(demo::Options),
    /// Write a picture, numbered pictures, or an animation
    ///
    /// Without -o, the picture is saved as INPUT.png in the current directory, several as INPUT-0000.png and so on, and
    /// their names are printed.
    Render(render::Options),
    /// List shadings, palettes, kernels, or scenes
    List(list::Options),
    /// Copy a shipped scene for editing
    Scenes(scenes::Options),
    /// Show which effects each object of a scene needs, and why
    ///
    /// The plan is for a frame 1/35 s after another, so it also shows what can be reused from frame to frame.
    Plan(plan::Options),
    /// Explain the byte of one pixel, or chart the intensity of a row
    Explain(explain::Options),
    /// Measure what accuracy costs in time
    ///
    /// Times every shading and error budget, and compares each with a reference picture in f64. Writes a report, a chart,
    /// the figures as JSON, and all times into a directory.
    Cost(cost::Options),
    /// Show a palette, convert it, or make one for a model
    Palette(palette::Options),
    /// Draw a hard case, right and wrong side by side
    ///
    /// Both are enlarged 16 times. Without an ID, all cases are listed.
    Cases(cases::Options),
    /// Write a DOS program, or a bootable floppy, that shows a scene
    ///
    /// The program repeats one loop of the scene in mode 13h until Esc is pressed. It needs a 386 with 4 MB, HIMEM.SYS and a
    /// VGA. It computes in integers, so it leaves out the effects that `--arithmetic fixed` leaves out, and the palette is
    /// not animated. Started with /B, it prints frames per second and a hash of its frames, which must equal the one
    /// printed here.
    Dos(dos::Options),
    /// Check that this machine draws the right bytes
    ///
    /// Runs every pixel loop against its definition, and draws the conformance frames with every kernel.
    Verify(verify::Options),
    /// Print shell completions or man pages
    Generate(generate::Options),
}

/// All commands and options, for parsing and for making help, completions and man pages.
pub(crate) fn command() -> clap::Command {
    let keys_and_status = format!("{}\n\n{EXIT_STATUS}", demo::help_on_keys(WIDTH));
    // The word after an option is its value, even with a minus.
    let takes_negative = |arg: clap::Arg| match arg.is_positional() || !arg.get_action().takes_values() {
        true => arg,
        false => arg.allow_negative_numbers(true),
    };
    let without_ignored = |arg: clap::Arg| {
        let is_ignored = arg.get_long().is_some_and(|name| IGNORED_BY_DOS.contains(&name));
        arg.hide(is_ignored)
    };
    Words::command()
        .mut_args(takes_negative)
        .max_term_width(WIDTH)
        .mut_subcommands(|command| {
            let command = command.mut_args(takes_negative).after_long_help(EXIT_STATUS);
            match command.get_name() {
                "demo" => command.after_long_help(keys_and_status.clone()),
                "dos" => command.mut_args(without_ignored),
                "plan" | "explain" => Moment::of_one_frame(command),
                _ => command,
            }
        })
        .after_long_help(keys_and_status)
}

/// Parses the command line; if it asks for help or is wrong, deals with that and returns the outcome.
pub(crate) fn parse() -> Result<Words, Result<(), Failure>> {
    if let Some(word) = empty_word() {
        return Err(Err(Failure::words(format!("{word}: empty value ({} shows the options)", help()))));
    }
    // The program's own help lists the commands; drawing options are in the help of the commands that draw.
    let without_drawing = |arg: clap::Arg| {
        let has_heading = arg.get_help_heading().is_some();
        arg.hide(has_heading)
    };
    let typed = command()
        .mut_args(without_drawing)
        .try_get_matches_from(typed())
        .and_then(|matches| Words::from_arg_matches(&matches));
    typed.map_err(|error| match error.kind() {
        ErrorKind::DisplayHelp | ErrorKind::DisplayVersion => output::print(&error.render().to_string()),
        _ => Err(Failure::words(sentence(&error))),
    })
}

pub(crate) fn run(words: &Words) -> Result<(), Failure> {
    if words.quiet {
        output::be_quiet();
    }
    match &words.command {
        None => {
            if let Some(command) = words.demo.inputs.iter().skip(1).find_map(named) {
                return Err(Failure::words(format!("{command} is a command and goes before INPUT")));
            }
            mistyped_command().map_or(Ok(()), |sentence| Err(Failure::words(sentence)))?;
            demo::run(&words.demo)
        }
        Some(Command::Demo(options)) => demo::run(options),
        Some(Command::Render(options)) => render::run(options),
        Some(Command::List(options)) => list::run(options),
        Some(Command::Scenes(options)) => scenes::run(options),
        Some(Command::Plan(options)) => plan::run(options),
        Some(Command::Explain(options)) => explain::run(options),
        Some(Command::Cost(options)) => cost::run(options),
        Some(Command::Palette(options)) => palette::run(options),
        Some(Command::Cases(options)) => cases::run(options),
        Some(Command::Dos(options)) => dos::run(options),
        Some(Command::Verify(options)) => verify::run(options),
        Some(Command::Generate(options)) => generate::run(options, command()),
    }
}

/// Finds a word that is empty, and the option that it belongs to.
fn empty_word() -> Option<String> {
    let words: Vec<OsString> = typed().into_iter().skip(1).collect();
    let is_option = |word: &&OsString| word.as_encoded_bytes().starts_with(b"-");
    let at = words.iter().position(|word| {
        word.is_empty() || (word.as_encoded_bytes().starts_with(b"--") && word.as_encoded_bytes().ends_with(b"="))
    })?;
    if !words[at].is_empty() {
        return Some(words[at].display().to_string());
    }
    let before = at.checked_sub(1).and_then(|before| words.get(before)).filter(is_option);
    Some(before.map_or("''".into(), |option| format!("{} ''", option.display())))
}

/// Describes what is wrong with the command line, in one sentence.
fn sentence(error: &clap::Error) -> String {
    if let Some(sentence) = mistyped_command() {
        return sentence;
    }
    let context = |kind| match error.get(kind) {
        Some(ContextValue::String(word)) => Some(word.as_str()),
        Some(ContextValue::Strings(words)) => words.first().map(String::as_str),
        _ => None,
    };
    let help = help();
    if error.kind() == ErrorKind::DisplayHelpOnMissingArgumentOrSubcommand
        && first_word().is_some_and(|word| word == "generate")
    {
        return "mode13h generate completions SHELL prints completions, mode13h generate man the man page".into();
    }
    let message = error.render().to_string();
    let message = message.strip_prefix("error: ").unwrap_or(&message);
    let paragraph: Vec<&str> = message.lines().map(str::trim).take_while(|line| !line.is_empty()).collect();
    let suggestions = [ContextKind::SuggestedArg, ContextKind::SuggestedValue, ContextKind::SuggestedSubcommand];
    let near = suggestions.into_iter().find_map(context);
    let near = near.map_or(String::new(), |near| format!("; did you mean {near}?"));
    format!("{}{near} ({help} shows the options)", plain(&paragraph.join(" "), error))
}

/// Rewords what clap says of a value, or of an option that was given twice.
fn plain(says: &str, error: &clap::Error) -> String {
    if let Some(argument) = says.strip_suffix(" cannot be used multiple times") {
        return format!("{argument} is given twice");
    }
    let cause = error.source().map(ToString::to_string).unwrap_or_default();
    let bounds = cause.rsplit_once(" is not in ").and_then(|(_, range)| range.split_once("..="));
    let reworded = match (bounds, error.get(ContextKind::InvalidValue)) {
        (Some((least, most)), _) => format!("not a whole number from {least} to {most}"),
        (None, Some(ContextValue::String(word))) if cause == "invalid digit found in string" => {
            // Parsers of unsigned numbers do not even read a sign.
            match word.strip_prefix('-').is_some_and(|digits| digits.parse::<u128>().is_ok()) {
                true => "not a whole number of at least 0".into(),
                false => "not a whole number".into(),
            }
        }
        _ => return says.to_string(),
    };
    says.strip_suffix(cause.as_str()).map_or(says.to_string(), |before| format!("{before}{reworded}"))
}

/// Finds the command that the first word resembles, if it is nothing else, and asks whether it was meant.
fn mistyped_command() -> Option<String> {
    let word = first_word()?;
    let command = typo::mistyped_command(&word)?;
    Some(format!(
        "{}: no such command, file, scene or shape; did you mean {command}? (mode13h --help lists the \
         commands)",
        word.display()
    ))
}

/// The command line that shows the help of the command that was typed.
fn help() -> String {
    match first_word().as_ref().and_then(named) {
        Some(command) => {
            let all = self::command();
            let second = typed().into_iter().nth(2);
            let within = all.find_subcommand(command).zip(second).and_then(|(of, word)| of.find_subcommand(word));
            let within = within.map_or(String::new(), |within| format!(" {}", within.get_name()));
            format!("mode13h {command}{within} --help")
        }
        None => "mode13h --help".to_string(),
    }
}

fn first_word() -> Option<OsString> {
    typed().into_iter().nth(1)
}

/// The command line, with a `-q` before the command moved after it: clap takes a word after an option for an INPUT.
fn typed() -> Vec<OsString> {
    let mut words: Vec<OsString> = std::env::args_os().collect();
    let is_quiet = |word: &&OsString| *word == "-q" || *word == "--quiet";
    let first = words.iter().skip(1).take_while(is_quiet).count() + 1;
    if words.get(first).is_some_and(|word| !word.as_encoded_bytes().starts_with(b"-")) {
        words[1..=first].rotate_right(1);
    }
    words
}

/// The command of this name.
fn named(word: &OsString) -> Option<&'static str> {
    COMMANDS.into_iter().find(|name| word == name)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_commands_are_listed() {
        let command = command();
        assert!(command.get_subcommands().map(clap::Command::get_name).eq(COMMANDS));
        command.debug_assert();
    }
}

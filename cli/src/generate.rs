//! `mode13h generate`: completions and man pages, from the definitions that the command line is parsed with.

use std::fs;
use std::path::{Path, PathBuf};

use clap::{Args, Subcommand};
use clap_complete::Shell;
use clap_mangen::Man;

use crate::failure::Failure;
use crate::output;

#[derive(Args)]
pub(crate) struct Options {
    #[command(subcommand)]
    what: What,
}

#[derive(Subcommand)]
enum What {
    /// Print the completions for a shell
    ///
    /// For bash: mode13h generate completions bash > ~/.local/share/bash-completion/completions/mode13h
    ///
    /// For zsh, into a directory of $fpath: mode13h generate completions zsh > ~/.zfunc/_mode13h
    ///
    /// For fish: mode13h generate completions fish > ~/.config/fish/completions/mode13h.fish
    ///
    /// For PowerShell: mode13h generate completions powershell >> $PROFILE
    Completions {
        /// The shell
        #[arg(value_name = "SHELL")]
        shell: Shell,
    },
    /// Print the main man page, or write all pages to a directory
    ///
    /// Without -o, prints mode13h's page: mode13h generate man | man -l -
    Man {
        /// Write mode13h.1, mode13h-render.1 and so on to DIR
        #[arg(short, long, value_name = "DIR")]
        out: Option<PathBuf>,
    },
}

/// Prints or writes completions or man pages for the whole program's command line.
pub(crate) fn run(options: &Options, mut all: clap::Command) -> Result<(), Failure> {
    match &options.what {
        What::Completions { shell } => {
            let mut script = Vec::new();
            clap_complete::generate(*shell, &mut all, "mode13h", &mut script);
            output::print(&String::from_utf8_lossy(&script))
        }
        What::Man { out: None } => output::print(&String::from_utf8_lossy(&page(built(all))?)),
        What::Man { out: Some(directory) } => write_pages(built(all), directory),
    }
}

/// Writes the page of the program and one for each command.
fn write_pages(all: clap::Command, directory: &Path) -> Result<(), Failure> {
    if directory.exists() && !directory.is_dir() {
        return Err(Failure::work(format!("{}: is not a directory", directory.display())));
    }
    fs::create_dir_all(directory).map_err(|error| Failure::work(format!("{}: {error}", directory.display())))?;
    let mut commands = vec![all];
    while let Some(command) = commands.pop() {
        let name = command.get_display_name().unwrap_or(command.get_name());
        let path = directory.join(format!("{name}.1"));
        commands.extend(command.get_subcommands().cloned());
        output::bytes(&path, &page(command)?)?;
    }
    Ok(())
}

/// All commands, each with its full name, such as mode13h-render.
fn built(all: clap::Command) -> clap::Command {
    let mut all = all.disable_help_subcommand(true);
    all.build();
    all
}

fn page(command: clap::Command) -> Result<Vec<u8>, Failure> {
    let mut page = Vec::new();
    Man::new(command).render(&mut page)?;
    // Text below the options of the help becomes sections of its own.
    let page = String::from_utf8_lossy(&page)
        .replace(".SH EXTRA\n", "")
        .replace("Keys in the window:\n", ".SH KEYS IN THE WINDOW\n")
        .replace("Exit status:\n", ".SH EXIT STATUS\n");
    Ok(page.into_bytes())
}

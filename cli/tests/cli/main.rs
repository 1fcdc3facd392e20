//! The program `mode13h`: its command line, its files, its documents.

mod support;

mod cases;
mod commands;
mod cost;
mod files;
mod folder;
mod looks;
mod terminal;
mod verify;
mod words;

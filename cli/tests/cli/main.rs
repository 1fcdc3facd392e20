//! The program `mode13h`: its words, its files, its documents.

mod support;

mod commands;
mod cost;
mod files;
mod record;
mod show;
mod verify;
mod words;

//! What the engine's sources declare: public types with their fields, variants and methods, as rustfmt lays them out.

use std::fs;
use std::path::PathBuf;

/// A field, a variant or a method.
pub(crate) struct Item {
    /// A name such as `Fog.start`, `Blend::Mix`, `Light::Sun.color` or `Scene::add`.
    pub(crate) name: String,
    pub(crate) is_public: bool,
    /// The type of a field; empty for variants and methods.
    pub(crate) of_type: String,
}

/// Some files of `src`, and all those right in some of its folders.
pub(crate) fn paths(files: &[&str], folders: &[&str]) -> Vec<PathBuf> {
    let root = crate::support::workspace::root().join("src");
    let entries = folders.iter().flat_map(|folder| fs::read_dir(root.join(folder)).expect("a folder"));
    let in_folders = entries.map(|entry| entry.expect("an entry").path());
    let in_folders = in_folders.filter(|path| path.extension().is_some_and(|is| is == "rs"));
    files.iter().map(|file| root.join(file)).chain(in_folders).collect()
}

/// Fields of structs, variants of enums with their fields, and public methods that take `&mut self`.
pub(crate) fn items_of(paths: &[PathBuf]) -> Vec<Item> {
    paths.iter().flat_map(|path| items(&fs::read_to_string(path).expect("a source"))).collect()
}

/// The public types of one source.
pub(crate) fn items(source: &str) -> Vec<Item> {
    let word = |text: &str| -> String { text.chars().take_while(|c| c.is_alphanumeric() || *c == '_').collect() };
    let public = |name: String| Item { name, is_public: true, of_type: String::new() };
    let mut items = Vec::new();
    let mut lines = source.lines();
    while let Some(line) = lines.next() {
        let (kind, rest) = match ["pub struct ", "pub enum ", "impl "].iter().find(|start| line.starts_with(**start)) {
            Some(start) if line.ends_with(" {") => (*start, &line[start.len()..]),
            _ => continue,
        };
        let of = word(rest);
        // An impl of a trait, or for a type with parameters.
        if kind == "impl " && rest != format!("{of} {{") {
            continue;
        }
        let body: Vec<&str> = lines.by_ref().take_while(|line| *line != "}").collect();
        let mut variant = String::new();
        for (i, line) in body.iter().enumerate() {
            let (depth, text) = (line.len() - line.trim_start().len(), line.trim_start());
            if !text.starts_with(|c: char| c.is_alphabetic()) {
                continue;
            }
            match (kind, depth, text.split_once(": ")) {
                ("pub struct ", 4, Some((field, of_type))) => {
                    let name = format!("{of}.{}", field.rsplit(' ').next().unwrap_or_default());
                    items.push(Item { name, is_public: field.starts_with("pub "), of_type: of_type.to_string() });
                }
                ("pub enum ", 4, _) => {
                    variant = word(text);
                    if !text.ends_with('{') {
                        items.push(public(format!("{of}::{variant}")));
                    }
                }
                ("pub enum ", 8, Some((field, of_type))) => {
                    let item = public(format!("{of}::{variant}.{field}"));
                    items.push(Item { of_type: of_type.to_string(), ..item });
                }
                ("impl ", 4, _) => {
                    let Some((_, method)) = text.split_once("fn ").filter(|_| text.starts_with("pub ")) else {
                        continue;
                    };
                    let signature =
                        if text.ends_with('(') { body.get(i + 1).map_or("", |next| next.trim()) } else { text };
                    if signature.contains("&mut self") {
                        items.push(public(format!("{of}::{}", word(method))));
                    }
                }
                _ => {}
            }
        }
    }
    items
}

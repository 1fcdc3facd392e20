//! The header declares the functions as Rust exports them.

use mode13h_capi::abi::{CODES, VERSION};

const HEADER: &str = include_str!("../../include/mode13h.h");
const SOURCES: [&str; 4] = [
    include_str!("../../src/abi.rs"),
    include_str!("../../src/color.rs"),
    include_str!("../../src/draw.rs"),
    include_str!("../../src/target.rs"),
];

/// The Rust type of a C parameter, with the parameter's name removed.
fn rust_of(parameter: &str) -> String {
    let parameter = parameter.trim();
    let is_array = parameter.contains('[');
    let bare = parameter.split('[').next().unwrap_or_default();
    // The name is the last word, unless that is a type.
    let words: Vec<&str> = bare.split([' ', '*']).filter(|word| !word.is_empty()).collect();
    let stars = bare.matches('*').count() + usize::from(is_array);
    let is_const = words.first() == Some(&"const");
    let base = match words[usize::from(is_const)] {
        "uint8_t" => "u8",
        "uint16_t" => "u16",
        "uint32_t" => "u32",
        "int32_t" => "i32",
        "size_t" => "usize",
        "int" => "c_int",
        "char" => "c_char",
        // Opaque.
        "void" | "m13_context" => "c_void",
        "m13_target" => "Target",
        "m13_mesh" => "Mesh",
        "m13_material" => "Material",
        "m13_stats" => "Stats",
        "m13_vertex" => "Vertex",
        "m13_vertex_x" => "VertexX",
        other => panic!("{other}: no type known"),
    };
    let pointer = if is_const { "*const " } else { "*mut " };
    format!("{}{base}", pointer.repeat(stars))
}

/// `name(types) -> type` of every function of the header.
fn declared() -> Vec<String> {
    // Without comments and macros, one declaration each.
    let mut text = String::new();
    let mut rest = HEADER;
    while let Some(start) = rest.find("/*") {
        text += &rest[..start];
        rest = &rest[start + rest[start..].find("*/").expect("an end") + 2..];
    }
    text += rest;
    let lines: Vec<&str> = text.lines().filter(|line| !line.starts_with('#')).collect();
    let mut functions = Vec::new();
    for statement in lines.join(" ").split([';', '{', '}']) {
        let Some((head, parameters)) = statement.split_once('(') else { continue };
        if !head.contains("m13_") {
            continue;
        }
        let (_, name) = head.trim().rsplit_once([' ', '*']).expect("a type and a name");
        let of_result = &head.trim()[..head.trim().len() - name.len()];
        let parameters = parameters.trim_end().trim_end_matches(')');
        let parameters = if parameters == "void" {
            String::new()
        } else {
            parameters.split(',').map(rust_of).collect::<Vec<_>>().join(", ")
        };
        functions.push(format!("{name}({parameters}) -> {}", rust_of(&format!("{of_result} result"))));
    }
    functions.sort();
    functions
}

/// `name(types) -> type` of every function that Rust exports.
fn exported() -> Vec<String> {
    let mut functions = Vec::new();
    for source in SOURCES {
        for part in source.split("extern \"C\" fn ").skip(1) {
            let (name, rest) = part.split_once('(').expect("parameters");
            let (parameters, rest) = rest.split_once(") ->").expect("a result");
            let result = rest.split('{').next().expect("a body").trim();
            let parameters: Vec<&str> = parameters
                .split(',')
                .filter_map(|parameter| parameter.split_once(':'))
                .map(|(_, kind)| kind.trim())
                .collect();
            functions.push(format!("{name}({}) -> {result}", parameters.join(", ")));
        }
    }
    functions.sort();
    functions
}

#[test]
fn every_function_is_declared_as_it_is() {
    let (declared, exported) = (declared(), exported());
    println!("{} functions", declared.len());
    assert!(declared.len() > 30);
    assert_eq!(declared, exported);
}

/// `M13_STRUCT_SIZE` of `StructSize`.
fn macro_of(name: &str) -> String {
    let mut words = String::from("M13");
    for letter in name.chars() {
        if letter.is_uppercase() {
            words.push('_');
        }
        words.push(letter.to_ascii_uppercase());
    }
    words
}

#[test]
fn every_code_has_its_number_and_words() {
    let lines: Vec<&str> = HEADER.lines().collect();
    for (name, code) in CODES {
        // SAFETY: a message is never null, and ends with a zero.
        let words = unsafe { core::ffi::CStr::from_ptr(mode13h_capi::abi::m13_message(*code)) };
        let words = words.to_str().expect("ASCII");
        let starts = format!("#define {} ({code})", macro_of(name));
        let line = lines.iter().find(|line| line.starts_with(&starts));
        let line = line.unwrap_or_else(|| panic!("no {starts}"));
        assert!(line.ends_with(&format!("/* {words} */")), "{line}, but {words}");
    }
    assert_eq!(
        lines.iter().filter(|line| line.starts_with("#define M13_") && line.contains("(-")).count(),
        CODES.len()
    );
    assert!(HEADER.contains(&format!("#define M13_VERSION {VERSION:#08x}u")));
}

//! `mode13h cases`.

use mode13h_lab::hard_cases::{CASES, by_id};

use crate::folder::Folder;

#[test]
fn cases_without_an_id_lists_the_cases_and_writes_nothing() {
    let folder = Folder::new();
    let list = folder.printed("cases");
    assert_eq!(list.lines().count(), CASES.len());
    for (line, case) in list.lines().zip(CASES) {
        assert!(line.starts_with(case.id) && line.contains(case.sentence), "{line}");
    }
    assert!(folder.names().is_empty());
}

#[test]
fn cases_writes_where_it_is_told_in_silence() {
    let folder = Folder::new();
    folder.succeed("cases d1 -o circle.png");
    let case = by_id("D1").expect("a case");
    assert_eq!(folder.read("circle.png"), case.png().expect("memory"));
    assert_eq!(folder.names(), ["circle.png"]);
}

#[test]
fn cases_without_a_name_says_where_and_overwrites_by_force_alone() {
    let folder = Folder::new();
    let read = || folder.read("R5.png");
    let says_where = |words: &str| assert!(folder.printed(words).starts_with("R5.png: "));
    says_where("cases r5");
    let picture = read();
    folder.put("R5.png", "mine");
    folder.fails("cases r5", 1, "mode13h: R5.png: already exists; --force ");
    assert_eq!(read(), b"mine");
    says_where("cases r5 --force");
    assert_eq!((read(), folder.names()), (picture, vec!["R5.png".to_string()]));
}

#[test]
fn cases_of_wrong_words_is_one_line_and_status_2() {
    let folder = Folder::new();
    for (words, status, says) in [
        ("cases R99", 2, "there are R1, R2"),
        ("cases S4", 2, "no case 'S4'"),
        ("cases R5 -o r5.gif", 2, "r5.gif"),
        ("cases -o r5.png", 2, "<ID>"),
        ("cases R5 -o no/such/place.png", 1, "place.png"),
    ] {
        folder.fails(words, status, says);
        assert!(folder.names().is_empty(), "{words}");
    }
}

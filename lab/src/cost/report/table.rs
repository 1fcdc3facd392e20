//! A table of the report, built once and shown both on the page and in a terminal.

use maud::{Markup, html};

use super::figures::{DASH, ratio, time};
use crate::cost::Nanoseconds;

/// A column's heading, and where it is shown.
#[derive(Clone, Copy, Debug)]
struct Heading {
    head: &'static str,
    /// A heading shared with neighbouring columns.
    group: &'static str,
    is_text: bool,
    is_brief: bool,
}

/// A column: its heading, and what it shows of a row.
pub(super) struct Column<Row> {
    heading: Heading,
    cell: Box<dyn Fn(&Row) -> Cell>,
}

impl<Row> Column<Row> {
    /// A column of numbers, on the page.
    pub(super) fn number<C: Into<Cell>>(head: &'static str, cell: impl Fn(&Row) -> C + 'static) -> Self {
        let heading = Heading { head, group: "", is_text: false, is_brief: false };
        Self { heading, cell: Box::new(move |row| cell(row).into()) }
    }

    /// A column of words, on the page.
    pub(super) fn text<C: Into<Cell>>(head: &'static str, cell: impl Fn(&Row) -> C + 'static) -> Self {
        let mut column = Self::number(head, cell);
        column.heading.is_text = true;
        column
    }

    /// Shows the column in a terminal, too.
    pub(super) fn brief(mut self) -> Self {
        self.heading.is_brief = true;
        self
    }

    /// Puts the column under a heading shared with its neighbours.
    pub(super) fn under(mut self, group: &'static str) -> Self {
        self.heading.group = group;
        self
    }
}

/// One cell: its text, and its markup on the page if that is more than the text.
#[derive(Clone, Debug)]
pub(super) struct Cell {
    text: String,
    markup: Option<Markup>,
}

impl Cell {
    /// Text, and its markup on the page.
    pub(super) fn shown(text: impl Into<String>, markup: Markup) -> Self {
        Self { text: text.into(), markup: Some(markup) }
    }

    fn is_empty(&self) -> bool {
        self.text.is_empty() || self.text == DASH
    }
}

impl<T: Into<String>> From<T> for Cell {
    fn from(text: T) -> Self {
        Self { text: text.into(), markup: None }
    }
}

/// A table. Empty columns are left out, and so is a table without rows.
#[derive(Debug)]
pub(super) struct Table {
    columns: Vec<Heading>,
    rows: Vec<Vec<Cell>>,
    /// Notes on a heading or on the whole table, and whether a terminal shows them too.
    notes: Vec<(&'static str, bool)>,
}

impl Table {
    /// A table of these rows.
    pub(super) fn new<Row>(columns: impl IntoIterator<Item = Column<Row>>, rows: &[Row]) -> Self {
        let mut columns: Vec<Column<Row>> = columns.into_iter().collect();
        columns.retain(|column| rows.iter().any(|row| !(column.cell)(row).is_empty()));
        let cells = |row: &Row| columns.iter().map(|column| (column.cell)(row)).collect();
        let rows = rows.iter().map(cells).collect();
        Self { columns: columns.iter().map(|column| column.heading).collect(), rows, notes: Vec::new() }
    }

    /// Adds a note below the table.
    pub(super) fn note(mut self, note: &'static str) -> Self {
        self.notes.push((note, true));
        self
    }

    /// Adds a note on a column that only the page shows.
    pub(super) fn page_note(mut self, note: &'static str) -> Self {
        self.notes.push((note, false));
        self
    }

    /// All columns and notes; empty without rows.
    pub(super) fn html(&self) -> Markup {
        let has_groups = self.columns.iter().any(|column| !column.group.is_empty());
        html! {
            @if !self.rows.is_empty() {
                div.wide { table {
                    thead {
                        @if has_groups { tr {
                            @for (group, count) in self.groups() { th.group[!group.is_empty()] colspan=(count) { (group) } }
                        } }
                        tr { @for (i, column) in self.columns.iter().enumerate() {
                            th.text[column.is_text] .group[self.begins_group(i)] { (column.head) }
                        } }
                    }
                    tbody { @for row in &self.rows { tr { @for (i, cell) in row.iter().enumerate() {
                        @if i == 0 { th scope="row" { (shown(cell)) } }
                        @else { td.text[self.columns[i].is_text] .group[self.begins_group(i)] { (shown(cell)) } }
                    } } } }
                } }
                @if !self.notes.is_empty() { p.key { @for (note, _) in &self.notes { span { (note) } } } }
            }
        }
    }

    fn begins_group(&self, column: usize) -> bool {
        let group = |i: usize| self.columns[i].group;
        !group(column).is_empty() && (column == 0 || group(column) != group(column - 1))
    }

    /// The shared headings, each with its number of columns.
    fn groups(&self) -> Vec<(&'static str, usize)> {
        let mut groups: Vec<(&'static str, usize)> = Vec::new();
        for column in &self.columns {
            match groups.last_mut() {
                Some((group, count)) if *group == column.group => *count += 1,
                _ => groups.push((column.group, 1)),
            }
        }
        groups
    }

    /// The brief columns, aligned, and the notes; empty without rows.
    pub(super) fn text(&self) -> String {
        let brief: Vec<usize> = (0..self.columns.len()).filter(|i| self.columns[*i].is_brief).collect();
        if self.rows.is_empty() || brief.is_empty() {
            return String::new();
        }
        let mut lines: Vec<Vec<String>> = vec![brief.iter().map(|i| self.columns[*i].head.to_string()).collect()];
        lines.extend(self.rows.iter().map(|row| brief.iter().map(|i| row[*i].text.clone()).collect()));
        let length = |text: &str| text.chars().count();
        let mut widths: Vec<usize> =
            (0..brief.len()).map(|i| lines.iter().map(|line| length(&line[i])).max().unwrap_or(0)).collect();
        // The shared headings, each at most as wide as the columns below it.
        let mut groups = String::new();
        let mut i = 0;
        while i < brief.len() {
            let group = self.columns[brief[i]].group;
            let end = (i..brief.len()).find(|j| self.columns[brief[*j]].group != group).unwrap_or(brief.len());
            let width = widths[i..end].iter().map(|width| 2 + width).sum::<usize>() - 2;
            let wider = length(group).saturating_sub(width);
            widths[i] += wider;
            groups += &format!("  {group:<width$}", width = width + wider);
            i = end;
        }
        let groups = groups.trim_end();
        let mut text = if groups.is_empty() { String::new() } else { format!("{groups}\n") };
        for line in &lines {
            let mut row = String::new();
            for ((i, cell), width) in line.iter().enumerate().zip(&widths) {
                let padding = " ".repeat(width - length(cell));
                let is_left = i == 0 || self.columns[brief[i]].is_text;
                row += &if is_left { format!("  {cell}{padding}") } else { format!("  {padding}{cell}") };
            }
            text += row.trim_end();
            text.push('\n');
        }
        self.notes.iter().filter(|note| note.1).for_each(|(note, _)| text += &format!("  {note}\n"));
        text
    }
}

fn shown(cell: &Cell) -> Markup {
    cell.markup.clone().unwrap_or_else(|| html! { (cell.text) })
}

/// The median and quartiles of a time.
pub(super) fn quartiles(of: &Nanoseconds) -> Cell {
    soft(format!("{} – {}", time(of.lower_quartile), time(of.upper_quartile)))
}

/// An interval: low – high.
pub(super) fn interval((low, high): (f64, f64)) -> Cell {
    soft(format!("{} to {}", ratio(low), ratio(high)))
}

/// Subdued text that may wrap onto two lines.
fn soft(text: String) -> Cell {
    Cell::shown(text.clone(), html! { span.soft { (text) } })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn table(rows: &[[&'static str; 3]]) -> Table {
        type Column = super::Column<[&'static str; 3]>;
        let columns = [
            Column::text("way", |row| row[0]).brief(),
            Column::number("time", |row| row[1]).brief().under("all"),
            Column::number("more", |row| row[2]),
        ];
        Table::new(columns, rows).note("A note.").page_note("Of more.")
    }

    #[test]
    fn page_and_terminal_show_the_same_cells() {
        let table = table(&[["flat", "1 µs", "<2>"], ["phong", "10 µs", "–"]]);
        assert_eq!(table.text(), "         all\n  way     time\n  flat    1 µs\n  phong  10 µs\n  A note.\n");
        let page = table.html().into_string();
        for part in ["<th scope=\"row\">phong</th>", ">10 µs<", "&lt;2&gt;", "A note.", "Of more."] {
            assert!(page.contains(part), "{part} in {page}");
        }
    }

    #[test]
    fn what_is_empty_is_left_out() {
        assert_eq!((table(&[]).text(), table(&[]).html().into_string()), (String::new(), String::new()));
        let page = table(&[["flat", "1 µs", "–"], ["phong", "2 µs", ""]]).html().into_string();
        assert!(!page.contains(">more<") && page.contains(">time<"), "{page}");
    }
}

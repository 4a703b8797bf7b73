//! Reports as plain text for a terminal of 100 columns.

use super::block::{Align, Block, Table};
use super::span::plain;

/// The width to which sentences are wrapped.
const WIDTH: usize = 100;

/// The blocks as text, ending in a line feed. No colour, no control characters but line feeds.
#[must_use]
pub fn render(blocks: &[Block]) -> String {
    let mut output = String::new();
    for block in blocks.iter().filter(|block| !matches!(block, Block::Drawing(_) | Block::Detail)) {
        if !output.is_empty() && !matches!(block, Block::Table(_) if output.ends_with("-\n")) {
            output.push('\n');
        }
        match block {
            Block::Title(title) => underlined(&mut output, title, "="),
            Block::Heading(title) | Block::Aside(title) => underlined(&mut output, title, "-"),
            Block::Subheading(title) => wrap(&mut output, &format!("{title}:"), "", ""),
            Block::Verdict(text) | Block::Paragraph(text) => wrap(&mut output, text, "", ""),
            Block::List(_) | Block::Facts(_) | Block::Figures(_) => {
                block.items().iter().for_each(|item| wrap(&mut output, item, "  - ", "    "));
            }
            Block::Table(table) => render_table(&mut output, table),
            Block::Drawing(_) | Block::Detail => {}
            Block::Code(lines) => output.push_str(lines),
        }
    }
    output
}

fn underlined(output: &mut String, title: &str, line: &str) {
    let width = title.chars().count().min(WIDTH);
    output.push_str(&format!("{title}\n{}\n", line.repeat(width)));
}

/// Words in lines of at most [`WIDTH`] characters; a longer word has a line of its own.
fn wrap(output: &mut String, text: &str, first: &str, rest: &str) {
    let mut line = first.to_owned();
    let mut empty = true;
    for word in glued(&plain(text)) {
        if !empty && line.chars().count() + 1 + word.chars().count() > WIDTH {
            output.push_str(line.trim_end());
            output.push('\n');
            line = rest.to_owned();
            empty = true;
        }
        if !empty {
            line.push(' ');
        }
        line.push_str(&word);
        empty = false;
    }
    output.push_str(line.trim_end());
    output.push('\n');
}

/// What stands between two sides that belong on one line.
const RELATIONS: [&str; 4] = ["<=", ">=", "<", "="];

/// The words of a text, with a relation and its two sides as one word, and what stands between two bars too.
fn glued(text: &str) -> Vec<String> {
    let mut words: Vec<String> = Vec::new();
    let mut open = false;
    for word in text.split_whitespace() {
        let relation = RELATIONS.contains(&word);
        match words.last_mut() {
            // A chain of relations is left to break somewhere.
            Some(last) if (relation || open) && last.len() + word.len() < WIDTH / 2 => {
                last.push(' ');
                last.push_str(word);
            }
            _ => words.push(word.to_owned()),
        }
        let bars = words.last().map_or(0, |word| word.matches('|').count());
        open = relation || bars % 2 == 1;
    }
    words
}

fn render_table(output: &mut String, table: &Table) {
    let without_marks = |cells: Vec<String>| cells.iter().map(|cell| plain(cell)).collect::<Vec<String>>();
    let titles = without_marks(table.columns.iter().map(|column| column.title.clone()).collect());
    let rows: Vec<Vec<String>> = table.rows.iter().cloned().map(without_marks).collect();
    let width = |index: usize| {
        let cells = rows.iter().map(|row| row[index].chars().count());
        cells.chain([titles[index].chars().count()]).max().unwrap_or(0)
    };
    let widths: Vec<usize> = (0..table.columns.len()).map(width).collect();
    let mut line = |cells: &mut dyn Iterator<Item = &str>| {
        let mut text = String::from(" ");
        for ((cell, column), width) in cells.zip(&table.columns).zip(&widths) {
            let space = " ".repeat(width - cell.chars().count());
            text.push_str(&match column.align {
                Align::Left => format!(" {cell}{space} "),
                Align::Right => format!(" {space}{cell} "),
            });
        }
        output.push_str(text.trim_end());
        output.push('\n');
    };
    line(&mut titles.iter().map(String::as_str));
    let rules: Vec<String> = widths.iter().map(|width| "-".repeat(*width)).collect();
    line(&mut rules.iter().map(String::as_str));
    for row in &rows {
        line(&mut row.iter().map(String::as_str));
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn columns_are_aligned_and_sentences_wrapped() {
        let mut table = Table::new(&["<name", "value"]);
        table.push(["a", "1"].map(str::to_owned));
        table.push(["long", "-22.5"].map(str::to_owned));
        // A number with an exponent changes none of the others.
        table.push(["tiny", "8e-11"].map(str::to_owned));
        let text = render(&[
            Block::Title("T".to_owned()),
            Block::Table(table),
            Block::List(vec!["word ".repeat(30), "x".repeat(120)]),
        ]);
        let lines: Vec<&str> = text.lines().collect();
        let expected = ["  name  value", "  ----  -----", "  a         1", "  long  -22.5", "  tiny  8e-11"];
        assert_eq!(&lines[3..8], expected);
        assert!(lines[9..11].iter().all(|line| line.chars().count() <= WIDTH));
        assert_eq!(glued("from |x - x_0| <= 1, or |y|"), ["from", "|x - x_0| <= 1,", "or", "|y|"]);
        assert_eq!(lines[11].trim_start_matches([' ', '-']), "x".repeat(120));
    }
}

//! Reports as GitHub-flavoured Markdown.

use super::block::{Align, Block, Table};
use super::span::plain;

/// The blocks as Markdown, ending in a line feed. What has a meaning in Markdown is escaped.
#[must_use]
pub fn render(blocks: &[Block]) -> String {
    let parts: Vec<String> = blocks
        .iter()
        .filter_map(|block| {
            Some(match block {
                Block::Title(title) => format!("# {}\n", escape(title)),
                Block::Heading(title) | Block::Aside(title) => format!("## {}\n", escape(title)),
                Block::Subheading(title) => format!("### {}\n", escape(title)),
                Block::Verdict(text) | Block::Paragraph(text) => format!("{}\n", escape_line(text)),
                Block::List(_) | Block::Facts(_) | Block::Figures(_) => {
                    block.items().iter().map(|item| format!("- {}\n", escape_line(item))).collect()
                }
                Block::Table(table) => render_table(table),
                Block::Drawing(_) | Block::Detail => return None,
                Block::Code(lines) => fenced(lines),
            })
        })
        .collect();
    parts.join("\n")
}

fn render_table(table: &Table) -> String {
    let row = |cells: &mut dyn Iterator<Item = String>| format!("| {} |\n", cells.collect::<Vec<_>>().join(" | "));
    let mut output = row(&mut table.columns.iter().map(|column| escape(&column.title)));
    output.push_str(&row(&mut table.columns.iter().map(|column| {
        match column.align {
            Align::Left => ":--",
            Align::Right => "--:",
        }
        .to_owned()
    })));
    for cells in &table.rows {
        output.push_str(&row(&mut cells.iter().map(|cell| escape(cell))));
    }
    output
}

/// Lines between fences that are longer than any row of backticks in them, so that nothing in them ends the block.
fn fenced(lines: &str) -> String {
    let longest = lines.split(|c| c != '`').map(str::len).max().unwrap_or(0);
    let fence = "`".repeat(longest.max(2) + 1);
    format!("{fence}text\n{}\n{fence}\n", lines.trim_end())
}

/// Text at the start of a line, where a few more characters are markup.
fn escape_line(text: &str) -> String {
    let inside = escape(text);
    if inside.starts_with(['#', '>', '-', '+']) { format!("\\{inside}") } else { inside }
}

/// Text without the marks of formulas, with the characters escaped that could start markup: an underscore between letters or digits cannot. What
/// stands between backticks is code and stays as it is (strangers' texts have no backticks, see `clean`).
fn escape(text: &str) -> String {
    let text = plain(text);
    let characters: Vec<char> = text.chars().collect();
    let is_word = |index: Option<usize>| index.and_then(|i| characters.get(i)).is_some_and(|c| c.is_alphanumeric());
    let mut output = String::with_capacity(text.len());
    let mut code = false;
    for (index, &character) in characters.iter().enumerate() {
        code ^= character == '`';
        let markup = match character {
            '|' => true,
            _ if code || character == '`' => false,
            '\\' | '*' | '<' | '~' | '&' => true,
            '_' => !(is_word(index.checked_sub(1)) && is_word(Some(index + 1))),
            // A link needs a parenthesis or a second bracket after the first.
            ']' => matches!(characters.get(index + 1), Some('(' | '[' | ':')),
            _ => false,
        };
        if markup {
            output.push('\\');
        }
        output.push(character);
    }
    output
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn markup_is_escaped_and_names_stay_readable() {
        assert_eq!(escape("K_alpha <= |z|_N, x_p*, sigma*_oo"), "K_alpha \\<= \\|z\\|\\_N, x_p\\*, sigma\\*\\_oo");
        assert_eq!(escape("[1, 2] [a](b)"), "[1, 2] [a\\](b)");
        assert_eq!(escape_line("# no heading"), "\\# no heading");
        assert_eq!(escape("`a_b*` * `c`"), "`a_b*` \\* `c`");
    }

    #[test]
    fn no_line_of_code_ends_its_block() {
        assert_eq!(render(&[Block::Code("a | b\n".to_owned())]), "```text\na | b\n```\n");
        assert_eq!(render(&[Block::Code("```\n# a\n````\n".to_owned())]), "`````text\n```\n# a\n````\n`````\n");
    }

    #[test]
    fn tables_have_a_rule() {
        let mut table = Table::new(&["<a", "b|c"]);
        table.push(["1", "2"].map(str::to_owned));
        assert_eq!(render(&[Block::Table(table)]), "| a | b\\|c |\n| :-- | --: |\n| 1 | 2 |\n");
    }
}

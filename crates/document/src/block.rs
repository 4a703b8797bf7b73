//! The parts of a document, without any format. Formulas and code are marked in every text but titles and code blocks (see `span`).

use crate::plot::Figure;

/// How the cells of a column are placed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Align {
    /// Against the left edge: words.
    Left,
    /// Against the right edge: numbers.
    Right,
}

/// A column of a table.
#[derive(Clone, Debug)]
pub struct Column {
    /// Its title.
    pub title: String,
    /// Where its cells go.
    pub align: Align,
}

/// A table. Every row has as many cells as there are columns.
#[derive(Clone, Debug)]
pub struct Table {
    /// The columns.
    pub columns: Vec<Column>,
    /// The rows.
    pub rows: Vec<Vec<String>>,
    /// For each row the length of a bar behind it, in formats that can draw one; none without bars.
    pub bars: Vec<f64>,
}

impl Table {
    /// An empty table: a column for each title, words to the left where the title starts with `<`.
    #[must_use]
    pub fn new(titles: &[&str]) -> Table {
        let columns = titles
            .iter()
            .map(|title| match title.strip_prefix('<') {
                Some(title) => Column { title: title.to_owned(), align: Align::Left },
                None => Column { title: (*title).to_owned(), align: Align::Right },
            })
            .collect();
        Table { columns, rows: Vec::new(), bars: Vec::new() }
    }

    /// A table of these rows.
    #[must_use]
    pub fn of<R: IntoIterator<Item = String>>(titles: &[&str], rows: impl IntoIterator<Item = R>) -> Table {
        let mut table = Table::new(titles);
        rows.into_iter().for_each(|row| table.push(row));
        table
    }

    /// Appends a row; cells that are missing are empty, and surplus ones are dropped.
    pub fn push(&mut self, cells: impl IntoIterator<Item = String>) {
        let mut row: Vec<String> = cells.into_iter().take(self.columns.len()).collect();
        row.resize(self.columns.len(), String::new());
        self.rows.push(row);
    }

    /// This table with bars of these lengths behind its rows.
    #[must_use]
    pub fn with_bars(self, bars: Vec<f64>) -> Table {
        Table { bars, ..self }
    }
}

/// A part of a report.
#[derive(Clone, Debug)]
pub enum Block {
    /// The title of the report.
    Title(String),
    /// The title of a section.
    Heading(String),
    /// The title of a section on the history of the matter, which no claim needs: where a format can fold, it is folded.
    Aside(String),
    /// The title of a part of a section.
    Subheading(String),
    /// The end of the short form: what follows, as far as the next title of a report, is left out of it.
    Detail,
    /// What is proved, refuted or undecided, in one sentence.
    Verdict(String),
    /// One or more sentences.
    Paragraph(String),
    /// Items of one line or a few.
    List(Vec<String>),
    /// What something is called, and what is said of it.
    Facts(Vec<(String, String)>),
    /// A table.
    Table(Table),
    /// A figure, in formats that can hold one; it says nothing that the text does not.
    Drawing(Figure),
    /// The names of the files with the figures of the report.
    Figures(Vec<String>),
    /// Lines that are shown as they are.
    Code(String),
}

impl Block {
    /// A paragraph.
    #[must_use]
    pub fn says(text: impl Into<String>) -> Block {
        Block::Paragraph(text.into())
    }

    /// The title of a section.
    #[must_use]
    pub fn heading(title: impl Into<String>) -> Block {
        Block::Heading(title.into())
    }

    /// Names, and what is said of each.
    #[must_use]
    pub fn facts(facts: impl IntoIterator<Item = (impl Into<String>, String)>) -> Block {
        Block::Facts(facts.into_iter().map(|(name, said)| (name.into(), said)).collect())
    }

    /// The items of a list, where the block is one of its kinds.
    pub(super) fn items(&self) -> Vec<String> {
        match self {
            Block::List(items) => items.clone(),
            Block::Facts(facts) => facts.iter().map(|(name, said)| format!("{name}: {said}")).collect(),
            Block::Figures(names) => names.iter().map(|name| format!("`{name}`")).collect(),
            _ => Vec::new(),
        }
    }
}

/// How much of a document is written.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Extent {
    /// Of each report as far as [`Block::Detail`].
    Short,
    /// Everything.
    Full,
}

impl Extent {
    /// The blocks that are written.
    pub(super) fn of(self, blocks: Vec<Block>) -> Vec<Block> {
        let mut detail = false;
        let wanted = |block: &Block| {
            detail = match block {
                Block::Title(_) => false,
                Block::Detail => true,
                _ => detail,
            };
            self == Extent::Full || !detail
        };
        blocks.into_iter().filter(wanted).collect()
    }
}

/// Whether a character is not shown, or moves what is shown: ends of lines and paragraphs and other white space than a blank, control
/// characters, marks of direction, and what has no width.
#[rustfmt::skip]
#[must_use]
pub fn is_hidden(c: char) -> bool {
    c.is_control() || (c.is_whitespace() && c != ' ') || matches!(
        c,
        '\u{ad}' | '\u{34f}' | '\u{600}'..='\u{605}' | '\u{61c}' | '\u{6dd}' | '\u{70f}' | '\u{890}' | '\u{891}' | '\u{8e2}'
        | '\u{115f}' | '\u{1160}' | '\u{17b4}' | '\u{17b5}' | '\u{180b}'..='\u{180f}' | '\u{200b}'..='\u{200f}'
        | '\u{202a}'..='\u{202e}' | '\u{2060}'..='\u{206f}' | '\u{2800}' | '\u{3164}' | '\u{fe00}'..='\u{fe0f}' | '\u{feff}'
        | '\u{ffa0}' | '\u{fff0}'..='\u{fffb}' | '\u{110bd}' | '\u{110cd}' | '\u{13430}'..='\u{1343f}' | '\u{1bca0}'..='\u{1bca3}'
        | '\u{1d173}'..='\u{1d17a}' | '\u{e0000}'..='\u{e0fff}'
    )
}

/// Text of a stranger as it may stand in a report: on one line, without characters that are [hidden](is_hidden) or backticks, and of bounded
/// length.
#[must_use]
pub fn clean(text: &str) -> String {
    shortened(text, 80)
}

/// A sentence in which words of a stranger may stand, as [`clean`] makes it, but longer.
#[must_use]
pub fn clean_sentence(text: &str) -> String {
    shortened(text, 1000)
}

fn shortened(text: &str, longest: usize) -> String {
    let visible = |c: char| match c {
        '`' => '\'',
        c if is_hidden(c) => ' ',
        c => c,
    };
    let line: String = text.chars().map(visible).collect();
    let words: Vec<&str> = line.split_whitespace().collect();
    let line = words.join(" ");
    if line.chars().count() <= longest {
        return line;
    }
    line.chars().take(longest - 3).chain("...".chars()).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn strangers_text_stays_on_its_line() {
        assert_eq!(clean("a\tb\n\u{1b}[31mc"), "a b [31mc");
        assert_eq!(clean("x\u{202e}y`"), "x y'");
        for hidden in [
            '\u{2028}',
            '\u{2029}',
            '\u{2066}',
            '\u{2069}',
            '\u{200b}',
            '\u{85}',
            '\u{a0}',
            '\u{ad}',
            '\u{61c}',
            '\u{feff}',
            '\u{fe0f}',
            '\u{e0041}',
        ] {
            assert_eq!(clean(&format!("a{hidden}b")), "a b", "{hidden:?}");
        }
        assert_eq!(clean("H\u{fc}tte \u{5e9} \u{2026} \u{3b1}'"), "H\u{fc}tte \u{5e9} \u{2026} \u{3b1}'");
        assert_eq!(clean(&"long ".repeat(100)).chars().count(), 80);
        assert_eq!(clean(""), "");
    }

    #[test]
    fn a_short_form_ends_at_the_detail_of_each_report() {
        let text = |text: &str| Block::says(text);
        let title = || Block::Title("T".to_owned());
        let blocks = vec![title(), text("1"), Block::Detail, text("2"), Block::heading("H"), title(), text("3")];
        let shown = |extent: Extent| {
            let said = |block: &Block| match block {
                Block::Paragraph(text) => Some(text.clone()),
                _ => None,
            };
            extent.of(blocks.clone()).iter().filter_map(said).collect::<String>()
        };
        assert_eq!((shown(Extent::Short), shown(Extent::Full)), ("13".to_owned(), "123".to_owned()));
    }

    #[test]
    fn rows_have_the_width_of_the_table() {
        let mut table = Table::new(&["<a", "b"]);
        table.push(["1".to_owned()]);
        table.push(["1", "2", "3"].map(str::to_owned));
        assert_eq!(table.rows, [vec!["1".to_owned(), String::new()], vec!["1".to_owned(), "2".to_owned()]]);
        assert_eq!(table.columns[0].align, Align::Left);
        assert_eq!(table.columns[1].align, Align::Right);
    }
}

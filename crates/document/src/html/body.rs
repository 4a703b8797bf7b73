//! Blocks as HTML. Whatever is text is escaped by the template library; only figures are markup already.

use super::formula::typeset;
use super::parts::Anchors;
use crate::block::{Align, Block, Column, Table};
use crate::plot::{Figure, PlotError, Size};
use crate::span::{Span, spans};
use maud::{Markup, PreEscaped, Render, html};

/// The end of a line, so that the file can be read as text too.
pub(super) const LINE: PreEscaped<&str> = PreEscaped("\n");

/// The blocks of a part, without what starts parts.
pub(super) fn body(blocks: &[Block], anchors: &mut Anchors) -> Markup {
    html! { @for block in blocks { (one(block, anchors)) (LINE) } }
}

fn one(block: &Block, anchors: &mut Anchors) -> Markup {
    match block {
        Block::Title(title) | Block::Heading(title) | Block::Aside(title) | Block::Subheading(title) => {
            let anchor = anchors.name(title);
            html! { h3 id=(anchor) { (title) (link(title, &anchor)) } }
        }
        Block::Verdict(text) => html! { p .verdict { (Inline(text)) } },
        Block::Paragraph(text) => html! { p { (Inline(text)) } },
        Block::List(_) | Block::Figures(_) => {
            html! { ul { @for item in block.items() { (LINE) li { (Inline(&item)) } } } }
        }
        Block::Facts(facts) => html! {
            dl { @for (name, said) in facts { (LINE) dt { (Inline(name)) } dd { (Inline(said)) } } }
        },
        Block::Table(table) => grid(table),
        Block::Drawing(figure) => drawing(figure),
        Block::Detail => html! {},
        Block::Code(lines) => html! { pre tabindex="0" { (lines.trim_end()) } },
    }
}

/// The link of a title to itself.
pub(super) fn link(title: &str, anchor: &str) -> Markup {
    html! { a .anchor href={ "#" (anchor) } aria-label={ "Link to: " (title) } { "#" } }
}

/// A table that scrolls in itself where it is too wide.
fn grid(table: &Table) -> Markup {
    let place = |column: &Column| match column.align {
        Align::Left => None,
        Align::Right => Some("number"),
    };
    let longest = table.bars.iter().copied().filter(|length| length.is_finite()).fold(0.0, f64::max);
    let share = |row: usize| table.bars.get(row).map(|length| 100.0 * (length / longest).clamp(0.0, 1.0));
    html! {
        div .scroll tabindex="0" role="group" aria-label="Table" { table {
            thead { tr { @for column in &table.columns {
                @if column.title.is_empty() { td {} }
                @else { th scope="col" class=[place(column)] { (Inline(&column.title)) } }
            } @if !table.bars.is_empty() { td {} } } }
            tbody { @for (index, row) in table.rows.iter().enumerate() { (LINE) tr {
                @for (at, (cell, column)) in row.iter().zip(&table.columns).enumerate() {
                    // A first column of words says what its row is.
                    @if at == 0 && column.align == Align::Left && !cell.is_empty() { th scope="row" { (Inline(cell)) } }
                    @else { td class=[place(column)] { (Inline(cell)) } }
                }
                @if let Some(share) = share(index) { td .bar { (bar(share)) } }
            } } }
        } }
    }
}

/// A bar of a length in per cent, drawn like text: the number beside it says the same.
fn bar(share: f64) -> Markup {
    let share = if share.is_finite() { format!("{share:.1}") } else { "0".to_owned() };
    html! {
        svg viewBox="0 0 100 10" preserveAspectRatio="none" aria-hidden="true" { rect width=(share) height="10" {} }
    }
}

/// A figure within the page, or why there is none: for a wide window and for a narrow one, of which one is seen.
fn drawing(figure: &Figure) -> Markup {
    let both: Result<Vec<(&str, String)>, PlotError> = [("wide", Size::Wide), ("narrow", Size::Narrow)]
        .into_iter()
        .map(|(class, size)| Ok((class, inline(&figure.drawn(size)?, class))))
        .collect();
    match both {
        Ok(both) => html! {
            figure role="img" aria-label=(figure.title) { @for (_, svg) in &both { (PreEscaped(svg)) } }
        },
        Err(error) => html! { p { "No figure: " (error.to_string()) "." } },
    }
}

/// SVG as a part of a page: there its name space is known.
fn inline(svg: &str, class: &str) -> String {
    svg.trim().replacen(" xmlns=\"http://www.w3.org/2000/svg\"", &format!(" class=\"{class}\""), 1)
}

/// A text with its formulas typeset and its code as code.
struct Inline<'t>(&'t str);

impl Render for Inline<'_> {
    fn render(&self) -> Markup {
        // What closes a bracket or a sentence is not parted from a formula before it.
        let closes = |text: &str| text.len() - text.trim_start_matches([',', '.', ';', ':', '?', ')']).len();
        let mut spans = spans(self.0).into_iter().peekable();
        let mut pieces = Vec::new();
        while let Some(span) = spans.next() {
            pieces.push(match span {
                Span::Text(text) => html! { (text) },
                Span::Code(code) => html! { code { (code) } },
                Span::Math(formula) => {
                    let after = match spans.peek_mut() {
                        Some(Span::Text(next)) => {
                            let (after, rest) = next.split_at(closes(next));
                            *next = rest;
                            after
                        }
                        _ => "",
                    };
                    typeset(formula, after)
                }
            });
        }
        html! { @for piece in pieces { (piece) } }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::plot::{Curve, Figure, Scale, Style};

    fn written(blocks: &[Block]) -> String {
        body(blocks, &mut Anchors::default()).into_string()
    }

    #[test]
    fn text_is_no_markup() {
        let hostile = "<script>\"&'</script>";
        let escaped = "&lt;script&gt;&quot;&amp;'&lt;/script&gt;";
        let mut table = Table::new(&["<", &format!("<{hostile}")]);
        table.push([hostile, hostile].map(str::to_owned));
        let code = format!("`{hostile}`");
        for (block, times) in [
            (Block::Title(hostile.to_owned()), 2),
            (Block::Subheading(hostile.to_owned()), 2),
            (Block::Verdict(hostile.to_owned()), 1),
            (Block::says(hostile), 1),
            (Block::says(code), 1),
            (Block::List(vec![hostile.to_owned()]), 1),
            (Block::Figures(vec![hostile.to_owned()]), 1),
            (Block::facts([(hostile, hostile.to_owned())]), 2),
            (Block::Table(table), 3),
            (Block::Code(hostile.to_owned()), 1),
        ] {
            let text = written(&[block]);
            assert_eq!((text.matches(escaped).count(), text.contains("<script")), (times, false), "{text}");
        }
    }

    #[test]
    fn backticks_are_code_in_pairs() {
        assert_eq!(written(&[Block::says("a `b` c `d`")]), "<p>a <code>b</code> c <code>d</code></p>\n");
        assert_eq!(written(&[Block::says("a ` b")]), "<p>a ` b</p>\n");
    }

    #[test]
    fn formulas_are_typeset_with_what_closes_behind_them() {
        let x = "<math><mrow><mi>x</mi></mrow></math>";
        assert_eq!(written(&[Block::says("a $`x`$ b")]), format!("<p>a {x} b</p>\n"));
        assert_eq!(written(&[Block::says("($`x`$), b$")]), format!("<p>(<span class=\"whole\">{x}),</span> b$</p>\n"));
    }

    #[test]
    fn tables_know_their_edges() {
        let mut table = Table::new(&["<name", "value"]);
        table.push(["a", "1"].map(str::to_owned));
        let text = written(&[Block::Table(table)]);
        assert!(text.contains("<th scope=\"col\">name</th><th scope=\"col\" class=\"number\">value</th>"), "{text}");
        assert!(text.contains("<tr><th scope=\"row\">a</th><td class=\"number\">1</td></tr>"), "{text}");
    }

    #[test]
    fn bars_are_shares_of_the_longest() {
        let mut table = Table::new(&["<name", "value"]);
        [["a", "2"], ["b", "1"], ["c", "?"]].into_iter().for_each(|row| table.push(row.map(str::to_owned)));
        let text = written(&[Block::Table(table.with_bars(vec![2.0, 1.0, f64::NAN]))]);
        let widths: Vec<&str> =
            text.split("<rect width=\"").skip(1).filter_map(|rest| Some(rest.split_once('"')?.0)).collect();
        assert_eq!(widths, ["100.0", "50.0", "0"], "{text}");
    }

    #[test]
    fn figures_are_in_the_page_or_said_to_be_missing() {
        let figure = |y: f64| {
            let curves = vec![Curve { label: "<b>".to_owned(), points: vec![(0.0, y), (1.0, y)], style: Style::Line }];
            let text = |text: &str| text.to_owned();
            Block::Drawing(Figure {
                title: text("<i>"),
                x: text("x"),
                y: text("y"),
                scale: Scale::Linear,
                floor: 0.0,
                curves,
            })
        };
        let text = written(&[figure(1.0)]);
        assert!(
            text.contains("aria-label=\"&lt;i&gt;\"><svg width=\"820\"") && text.ends_with("</svg></figure>\n"),
            "{text}"
        );
        assert_eq!(["wide", "narrow"].map(|name| text.matches(&format!("class=\"{name}\"")).count()), [1, 1]);
        assert!(text.contains("&lt;b&gt;") && !text.contains("<b>") && !text.contains("http"), "{text}");
        assert_eq!(written(&[figure(f64::NAN)]), "<p>No figure: the figure `&lt;i&gt;` has no finite points.</p>\n");
    }
}

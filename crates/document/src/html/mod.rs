//! Reports as one HTML page that needs nothing else: no network, no script, figures inside.

mod body;
mod formula;
mod parts;

use super::block::Block;
use super::plot::dark_style;
use body::{LINE, body, link};
use maud::{DOCTYPE, Markup, PreEscaped, html};
use parts::{Anchors, Part, Start, parts};

/// How the page looks: light and dark, narrow, wide and on paper.
const STYLE: &str = include_str!("style.css");

/// What the page may load: nothing. Its style stands in it.
const POLICY: &str = "default-src 'none'; style-src 'unsafe-inline'; base-uri 'none'; form-action 'none'";

/// So many sections are listed before the first of them.
const LISTED: usize = 3;

/// The blocks as a page, ending in a line feed. The first part, with the claim, comes before everything else.
#[must_use]
pub fn render(blocks: &[Block]) -> String {
    let mut anchors = Anchors::default();
    let parts = parts(blocks, &mut anchors);
    let title = parts.first().map(|part| part.start.words()).filter(|title| !title.is_empty());
    let page = html! {
        (DOCTYPE) (LINE)
        html lang="en" {
            head { (LINE)
                meta charset="utf-8"; (LINE)
                meta http-equiv="Content-Security-Policy" content=(POLICY); (LINE)
                meta name="viewport" content="width=device-width, initial-scale=1"; (LINE)
                meta name="generator" content="sigmastar"; (LINE)
                title { (title.unwrap_or("sigmastar")) } (LINE)
                style { (LINE) (PreEscaped(STYLE)) (PreEscaped(figures())) } (LINE)
            } (LINE)
            body { main { (LINE)
                @for (index, part) in parts.iter().enumerate() {
                    (section(part, &mut anchors)) (LINE)
                    @if index == 0 { (contents(&parts[1..])) }
                }
            } }
        } (LINE)
    };
    page.into_string()
}

/// The colours of figures on a dark screen; paper is white.
fn figures() -> String {
    format!("@media screen and (prefers-color-scheme: dark) {{\n{}}}\n", dark_style("figure "))
}

fn section(part: &Part<'_>, anchors: &mut Anchors) -> Markup {
    let Part { start, anchor, blocks } = part;
    let title = start.words();
    let titled = html! { (title) (link(title, anchor)) };
    let inside = body(blocks, anchors);
    match start {
        Start::Nothing => html! { section { (LINE) (inside) } },
        Start::Title(_) => html! { section { h1 id=(anchor) { (titled) } (LINE) (inside) } },
        Start::Heading(_) => html! { section { h2 id=(anchor) { (titled) } (LINE) (inside) } },
        // A link to something inside of it unfolds it.
        Start::Aside(_) => html! { details { summary { h2 { (titled) } } (LINE) div id=(anchor) { (inside) } } },
    }
}

/// The list of the sections, where there are several.
fn contents(parts: &[Part<'_>]) -> Markup {
    html! {
        @if parts.len() >= LISTED {
            nav aria-label="Sections" { ul { @for part in parts {
                (LINE) li { a href={ "#" (part.anchor) } { (part.start.words()) } }
            } } } (LINE)
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_claim_comes_first_and_asides_are_folded() {
        let page = render(&[
            Block::Title("<T>".to_owned()),
            Block::Verdict("Certified.".to_owned()),
            Block::heading("One"),
            Block::Aside("Two".to_owned()),
            Block::says("old"),
            Block::heading("Three"),
        ]);
        let places = [
            "<title>&lt;T&gt;</title>",
            "<h1 id=\"t\">&lt;T&gt;<a",
            "<p class=\"verdict\">Certified.</p>",
            "<nav ",
            "<h2 id=\"one\">One<a",
            "<details><summary><h2>Two<a",
            "<div id=\"two\"><p>old</p>\n</div></details>",
            "<h2 id=\"three\">",
        ]
        .map(|wanted| page.find(wanted).unwrap_or_else(|| panic!("{wanted}: {page}")));
        assert!(places.is_sorted(), "{places:?}");
        assert!(page.starts_with("<!DOCTYPE html>\n") && page.ends_with("</html>\n"));
    }

    #[test]
    fn a_document_without_a_title_is_a_page() {
        let page = render(&[Block::Code("valid\n".to_owned())]);
        assert!(
            page.contains("<title>sigmastar</title>") && page.contains("<pre tabindex=\"0\">valid</pre>"),
            "{page}"
        );
        assert!(!page.contains("<nav") && !page.contains("<h1"), "{page}");
    }

    /// The relative luminance of `#rrggbb` (WCAG 2.2).
    fn luminance(colour: &str) -> f64 {
        let channel = |at: usize| {
            let value = f64::from(u8::from_str_radix(&colour[at..at + 2], 16).unwrap()) / 255.0;
            if value <= 0.04045 { value / 12.92 } else { ((value + 0.055) / 1.055).powf(2.4) }
        };
        0.2126 * channel(1) + 0.7152 * channel(3) + 0.0722 * channel(5)
    }

    #[test]
    fn every_text_has_contrast_in_both_schemes() {
        let schemes: Vec<&str> = STYLE.lines().filter(|line| line.contains("--page: ")).collect();
        assert_eq!(schemes.len(), 2);
        for scheme in schemes {
            let colour = |name: &str| {
                let start = scheme.find(&format!("--{name}: #")).unwrap() + name.len() + 4;
                luminance(&scheme[start..start + 7])
            };
            for text in ["text", "muted", "link"] {
                for ground in ["page", "card"] {
                    let (a, b) = (colour(text), colour(ground));
                    let contrast = (a.max(b) + 0.05) / (a.min(b) + 0.05);
                    assert!(contrast >= 4.5, "{text} on {ground}: {contrast} in {scheme}");
                }
            }
        }
        // No other colour is used for text.
        let others = STYLE.lines().filter(|line| line.contains(" color: ") && !line.contains("color: var(--"));
        assert_eq!(others.count(), 0);
    }
}

//! Errors shown in their source.

use super::document::COMMAND_LINE;
use super::error::{SpecError, SpecErrors};
use super::json::floor_boundary;
use annotate_snippets::{AnnotationKind, Group, Level, Origin, Renderer, Snippet, normalize_untrusted_str};
use std::ops::Range;

/// The width to which long source lines are cut.
const WIDTH: usize = 120;

/// Lines of context before the offending one.
const CONTEXT: usize = 1;

impl SpecErrors {
    /// The errors as diagnostics with source context, one after the other, each ending in a line feed.
    ///
    /// `colour` adds ANSI escape codes. Control characters of the document are never passed on.
    #[must_use]
    pub fn render(&self, colour: bool) -> String {
        let renderer = if colour { Renderer::styled() } else { Renderer::plain() }.term_width(WIDTH);
        let mut output = String::new();
        for (index, error) in self.errors.iter().enumerate() {
            if index > 0 {
                output.push('\n');
            }
            output.push_str(&self.render_one(error, &renderer));
            output.push('\n');
        }
        if self.omitted > 0 {
            let label = normalize_untrusted_str(&self.origin.label);
            output.push_str(&format!("\n{label}: {} more errors are not shown\n", self.omitted));
        }
        output
    }

    fn render_one(&self, error: &SpecError, renderer: &Renderer) -> String {
        let label = normalize_untrusted_str(&self.origin.label);
        let mut group = Group::with_title(
            Level::ERROR.primary_title(normalize_untrusted_str(&error.message)).id(error.kind.code()),
        );
        let window = Window::around(&self.origin.text, &error.span);
        group = match &window {
            Some(window) => {
                let mut annotation = AnnotationKind::Primary.span(window.span.clone());
                if let Some(expected) = &error.expected {
                    annotation = annotation.label(normalize_untrusted_str(expected));
                }
                group.element(Snippet::source(window.text).line_start(window.line).path(label).annotation(annotation))
            }
            None => {
                let group = group.element(Origin::path(label));
                match &error.expected {
                    Some(expected) => group.element(Level::NOTE.message(normalize_untrusted_str(expected))),
                    None => group,
                }
            }
        };
        // A flag is shown as it was typed; a pointer would only repeat its name.
        if !error.pointer.is_empty() && self.origin.label != COMMAND_LINE {
            group = group.element(Level::NOTE.message(format!("at {}", cut(&error.pointer))));
        }
        if let Some(help) = &error.help {
            group = group.element(Level::HELP.message(normalize_untrusted_str(help)));
        }
        renderer.render(&[group])
    }
}

/// A pointer of reasonable length: keys may be as long as the document.
fn cut(pointer: &str) -> String {
    let short: String = pointer.chars().take(WIDTH).collect();
    let dots = if short.len() < pointer.len() { "..." } else { "" };
    normalize_untrusted_str(&short) + dots
}

/// The lines around a span: rendering works on these alone, so that its cost does not depend on the document.
struct Window<'t> {
    text: &'t str,
    line: usize,
    span: Range<usize>,
}

impl<'t> Window<'t> {
    /// `None` for an empty text, which has no line to show.
    fn around(text: &'t str, span: &Range<usize>) -> Option<Window<'t>> {
        if text.is_empty() {
            return None;
        }
        let at = floor_boundary(text, span.start);
        let until = floor_boundary(text, span.end).max(at);
        let mut start = text[..at].rfind('\n').map_or(0, |position| position + 1);
        for _ in 0..CONTEXT {
            if start > 0 {
                start = text[..start - 1].rfind('\n').map_or(0, |position| position + 1);
            }
        }
        let end = text[until..].find('\n').map_or(text.len(), |position| until + position);
        let line = 1 + text[..start].bytes().filter(|byte| *byte == b'\n').count();
        Some(Window { text: &text[start..end], line, span: at - start..until - start })
    }
}

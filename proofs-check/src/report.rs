//! The answer about a file, as text and as JSON. Nothing is decided here.

use crate::subject::Subject;
use proofs_core::verdict::{Finding, Verdict, escaped};

/// The answer about a file.
pub struct Report {
    /// The verdict on the claim.
    pub verdict: Verdict,
    /// Why it is not `valid`.
    pub finding: Option<Finding>,
    /// What a valid certificate is about.
    pub subject: Option<Subject>,
    /// The argument, line by line, as far as it went.
    pub lines: Vec<String>,
    /// The steps that the answer took ([`proofs_core::effort`]).
    pub steps: u64,
}

impl Report {
    /// Whether the claim is proved.
    pub fn is_valid(&self) -> bool {
        self.verdict == Verdict::Valid
    }

    /// The report as text; with the argument if `verbose`.
    pub fn text(&self, verbose: bool) -> String {
        let mut text = String::new();
        if verbose {
            self.lines.iter().for_each(|line| text += &format!("{line}\n"));
        }
        text += &format!("{}\n", self.verdict);
        self.subject.iter().for_each(|subject| text += &subject_text(subject));
        self.finding.iter().for_each(|finding| text += &finding_text(finding));
        text
    }

    /// The report as JSON.
    pub fn json(&self) -> serde_json::Value {
        let mut json = serde_json::json!({
            "format": "sigmastar/check", "version": 1, "verdict": self.verdict.to_string(),
            "finding": self.finding.as_ref().map(finding_json), "argument": self.lines,
        });
        if let (Some(subject), Some(fields)) = (&self.subject, json.as_object_mut()) {
            let free: serde_json::Map<String, serde_json::Value> =
                subject.free_texts.iter().map(|(name, text)| ((*name).to_owned(), text.as_str().into())).collect();
            fields.insert("statement".to_owned(), subject.statement.as_str().into());
            fields.insert("also_proved".to_owned(), subject.also.as_deref().into());
            fields.insert(format!("{}_sha256", subject.about), subject.digest.as_str().into());
            fields.insert("assumed".to_owned(), subject.assumed.clone().into());
            fields.insert("free_texts".to_owned(), free.into());
        }
        json
    }
}

/// The most characters of a line of the claim and of what is assumed, unless one word has more.
const WIDTH: usize = 100;

/// How far the lines below the first one of a claim or an assumption are moved in.
const INDENT: usize = 11;

/// A text under its title, each sentence from the start of a line, with no line longer than [`WIDTH`].
fn paragraph(title: &str, said: &str) -> String {
    let mut rows = vec![format!("{:INDENT$}", format!("  {title}:"))];
    let mut begins = true;
    for word in said.split(' ') {
        let room = |row: &String| row.chars().count() + 1 + word.chars().count() <= WIDTH;
        match rows.last_mut() {
            Some(row) if row.len() == INDENT => *row += word,
            Some(row) if !begins && room(row) => *row += &format!(" {word}"),
            _ => rows.push(format!("{:INDENT$}{word}", "")),
        }
        begins = word.ends_with('.');
    }
    rows.iter().map(|row| format!("{row}\n")).collect()
}

fn subject_text(subject: &Subject) -> String {
    let mut text = paragraph("proved", &subject.statement);
    subject.also.iter().for_each(|also| text += &paragraph("proved", also));
    subject.assumed.iter().for_each(|line| text += &paragraph("assumed", line));
    text += &format!("  {}: SHA-256 {}\n", subject.about, subject.digest);
    subject.free_texts.iter().for_each(|(name, free)| text += &format!("  {name} (free text): {free}\n"));
    text
}

fn finding_text(finding: &Finding) -> String {
    // Keys and figures of a file stand in them.
    let [pointer, message] = [&finding.pointer, &finding.message].map(|text| escaped(text));
    let mut text = format!("  rule:  {}\n  field: {pointer}\n  {message}\n", finding.rule);
    if let Some([lhs, rhs, gap]) = finding.sides.as_ref().map(|sides| sides.each_ref().map(|side| escaped(side))) {
        text += &format!("  left:  {lhs}\n  right: {rhs}\n  gap:   {gap}\n");
    }
    text
}

fn finding_json(finding: &Finding) -> serde_json::Value {
    let side = |i: usize| finding.sides.as_ref().map(|sides| escaped(&sides[i]));
    serde_json::json!({
        "verdict": finding.verdict.to_string(), "rule": finding.rule, "field": escaped(&finding.pointer),
        "message": escaped(&finding.message), "left": side(0), "right": side(1), "gap": side(2),
    })
}

#[cfg(test)]
mod tests {
    use super::paragraph;

    #[test]
    fn each_sentence_has_a_line_of_its_own_and_no_line_is_too_long() {
        let long = "word ".repeat(40);
        let text = paragraph("proved", &format!("One of 0.5 ends here. {long}ends. Three"));
        let lines: Vec<&str> = text.lines().collect();
        assert_eq!(lines[0], "  proved:  One of 0.5 ends here.");
        assert!(lines[1].starts_with("           word word") && lines.last() == Some(&"           Three"), "{text}");
        assert!(lines.len() == 5 && lines.iter().all(|line| line.len() <= 100 && line.trim_end() == *line), "{text}");
        assert_eq!(paragraph("assumed", "a b"), "  assumed: a b\n");
    }
}

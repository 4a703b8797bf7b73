//! The list of errata as a report.

use crate::errata::{Erratum, Side, errata};
use serde_json::{Value, json};
use sigmastar_document::{Block, Made, Readable, clean, plain};
use sigmastar_lang::spec::Specification;

/// The list of errata, with what each item means for a specification where one is given.
pub struct ErrataReport {
    name: Option<String>,
    items: Vec<Erratum>,
    constants: Option<Made>,
}

impl ErrataReport {
    /// Works the list out; with the report on the paper's constants for the specification behind it, where there is one.
    #[must_use]
    pub fn new(spec: Option<&Specification>, constants: Option<Made>) -> ErrataReport {
        ErrataReport { name: spec.map(|spec| clean(&spec.name)), items: errata(spec), constants }
    }
}

impl Readable for ErrataReport {
    fn blocks(&self) -> Vec<Block> {
        let title = match &self.name {
            Some(name) => format!("Errata of the paper, seen from {name}"),
            None => "Errata of the paper".to_owned(),
        };
        let mut blocks = vec![
            Block::Title(title),
            Block::says(
                "Class A makes the printed chain unsound or empty, B is sound but needlessly large, C has no effect. \
                 Rigorous evidence was decided by this run; cited evidence was not.",
            ),
        ];
        for item in &self.items {
            blocks.push(Block::Heading(format!("{} [{}]", item.id, item.class)));
            let said = [("place", item.place), ("printed", item.printed), ("instead", item.instead)];
            let mut facts: Vec<(&str, String)> = said.map(|(name, text)| (name, text.to_owned())).into();
            facts.extend(item.evidence.iter().map(|evidence| ("evidence", evidence.to_string())));
            facts.extend(item.for_data.iter().map(|for_data| ("for this specification", for_data.to_string())));
            blocks.push(Block::facts(facts));
        }
        blocks.extend(self.constants.iter().flat_map(Made::as_section));
        blocks
    }

    /// As JSON: `{"format": "sigmastar/errata", "version": 1, "errata": [...]}`.
    fn json(&self) -> Value {
        let items: Vec<Value> = self.items.iter().map(item_json).collect();
        json!({
            "format": "sigmastar/errata", "version": 1, "specification": self.name, "errata": items,
            "constants": self.constants.as_ref().map(Readable::json),
        })
    }
}

fn item_json(item: &Erratum) -> Value {
    let side = |side: &Side| json!(side.enclosure().decimals());
    let evidence: Vec<Value> = item
        .evidence
        .iter()
        .map(|evidence| {
            json!({
                "kind": evidence.kind.to_string(), "statement": plain(&evidence.statement),
                "lhs": side(&evidence.lhs), "relation": evidence.relation.to_string(), "rhs": side(&evidence.rhs),
                "truth": evidence.truth.to_string(),
            })
        })
        .collect();
    let for_data = item.for_data.as_ref().map(|for_data| {
        let figures: Vec<Value> = for_data
            .figures
            .iter()
            .map(|figure| json!({ "name": plain(&figure.name), "value": side(&figure.value) }))
            .collect();
        json!({ "bearing": for_data.bearing.to_string(), "summary": plain(&for_data.summary), "figures": figures })
    });
    json!({
        "id": item.id, "class": item.class.to_string(), "place": plain(item.place), "printed": plain(item.printed),
        "instead": plain(item.instead), "proved": item.is_proved(), "evidence": evidence, "for_data": for_data,
    })
}

//! `sigmastar schema`, `new` and `convert`: for the people who write files.

use super::args::{ConvertArgs, NewArg, NewArgs, SchemaArgs};
use super::failure::Failure;
use super::files::{Input, OutputFile};
use super::{input, output};
use sigmastar_lang::spec::{Document, Notation};

/// Writes a JSON Schema to standard output; returns the exit code.
pub fn schema(args: &SchemaArgs) -> u8 {
    let text = output::json_text(&args.name.schema().json());
    output::data(&text).err().unwrap_or(0)
}

/// Writes a template, in the notation that the name of its file says; returns the exit code. JSON has no comments.
pub fn new(args: &NewArgs) -> Result<u8, Failure> {
    let path = args.output.as_deref();
    let [commented, toml] = match args.kind {
        NewArg::Spec => [include_str!("templates/spec.jsonc"), include_str!("templates/spec.toml")],
        NewArg::Plant => [include_str!("templates/plant.jsonc"), include_str!("templates/plant.toml")],
        NewArg::Study => [include_str!("templates/study.jsonc"), include_str!("templates/study.toml")],
    };
    let file = args.replace.asked(path, Input::None, "the template")?;
    match path.map_or(Notation::JsonWithComments, Notation::of) {
        Notation::JsonWithComments => write(commented, file),
        Notation::Toml => write(toml, file),
        Notation::Json => {
            let plain = Document::parse_as("template", commented, Notation::JsonWithComments)?;
            write(&output::json_text(&plain.root().to_json()), file)
        }
    }
}

/// Writes a document as JSON; returns the exit code.
pub fn convert(args: &ConvertArgs) -> Result<u8, Failure> {
    let file = args.replace.asked(args.output.as_deref(), Input::Specification(&args.file), "the JSON")?;
    let document = input::document(&args.file)?;
    write(&output::json_text(&document.root().to_json()), file)
}

/// To the file, or to standard output where none is asked for.
fn write(text: &str, file: Option<OutputFile>) -> Result<u8, Failure> {
    match file {
        Some(file) => file.write(text).map(|()| 0),
        None => Ok(output::data(text).err().unwrap_or(0)),
    }
}

//! Flags of the commands that help to write files.

use super::Replace;
use clap::{Args, ValueEnum, ValueHint};
use sigmastar_schema::Schema;
use std::path::PathBuf;

/// The flags of `schema`.
#[derive(Args, Debug)]
pub struct SchemaArgs {
    /// The file that it is for
    #[arg(value_enum, value_name = "NAME")]
    pub name: SchemaArg,
}

/// A file that has a schema.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum SchemaArg {
    /// A bounding specification
    Specification,
    /// A plant by its formulas
    Plant,
    /// A parameter study
    Study,
}

impl SchemaArg {
    /// The schema itself.
    pub fn schema(self) -> Schema {
        match self {
            SchemaArg::Specification => Schema::Specification,
            SchemaArg::Plant => Schema::Plant,
            SchemaArg::Study => Schema::Study,
        }
    }
}

/// The flags of `new`.
#[derive(Args, Debug)]
pub struct NewArgs {
    /// What to start
    #[arg(value_enum, value_name = "KIND")]
    pub kind: NewArg,

    /// Write it to this file instead of standard output: with comments where its name ends in .jsonc or .toml, else as plain JSON
    #[arg(short, long, value_name = "FILE", value_hint = ValueHint::FilePath)]
    pub output: Option<PathBuf>,

    #[command(flatten)]
    pub replace: Replace,
}

/// A file that can be started.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum NewArg {
    /// A bounding specification: you derive the bounds
    Spec,
    /// A plant by its formulas: the bounds are found and proved
    Plant,
    /// A parameter study, for `sweep`
    Study,
}

/// The flags of `convert`.
#[derive(Args, Debug)]
pub struct ConvertArgs {
    /// Specification, plant or study (.json, .jsonc or .toml), or `-` for standard input
    #[arg(value_name = "FILE", value_hint = ValueHint::FilePath)]
    pub file: PathBuf,

    /// Write the JSON to this file instead of standard output
    #[arg(short, long, value_name = "FILE", value_hint = ValueHint::FilePath)]
    pub output: Option<PathBuf>,

    #[command(flatten)]
    pub replace: Replace,
}

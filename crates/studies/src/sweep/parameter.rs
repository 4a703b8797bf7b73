//! One parameter of a study: where its values go, and which they are.

use super::values::{Values, read_list, read_range};
use sigmastar_lang::spec::{ErrorKind, Errors, Object, Reported, Value};

/// A parameter.
#[derive(Clone, Debug)]
pub struct Parameter {
    /// The JSON pointer (RFC 6901) of the value that is replaced.
    pub pointer: String,
    /// What tables and figures call it: the pointer, where no name is given.
    pub name: String,
    /// Its values.
    pub values: Values,
}

impl Parameter {
    /// Reads a parameter; `latin` is the number of cases of a Latin hypercube.
    ///
    /// # Errors
    /// What is wrong with it, in its place.
    pub(super) fn read(value: &Value<'_>, latin: Option<u32>, errors: &mut Errors) -> Result<Parameter, Reported> {
        let mut object = value.object(errors)?;
        let place = read_place(&mut object, value, errors);
        let name = object.optional("name").map(|value| value.string(errors).map(str::to_owned)).transpose();
        let given: Vec<(&str, Value<'_>)> = ["values", "linear", "logarithmic"]
            .into_iter()
            .filter_map(|kind| object.optional(kind).map(|value| (kind, value)))
            .collect();
        let values = match given.as_slice() {
            [("values", list)] => read_list(list, errors),
            [(kind, range)] => read_range(range, *kind == "logarithmic", latin, errors),
            [] => {
                let error = value.error(ErrorKind::MissingField, "the values of this parameter are missing");
                Err(errors.report(error.expected("expected one of `values`, `linear` and `logarithmic`")))
            }
            [_, (kind, second), ..] => {
                let message = format!("`{kind}` stands beside other values of this parameter");
                let error = second.error(ErrorKind::Range, message);
                Err(errors.report(error.expected("expected one of `values`, `linear` and `logarithmic`")))
            }
        };
        object.finish(errors);
        let ((pointer, usual), name, values) = (place?, name?, values?);
        Ok(Parameter { name: name.unwrap_or(usual), pointer, values })
    }

    /// The steps of the pointer, decoded: two pointers of the same steps are the same place.
    pub(super) fn steps(&self) -> Vec<String> {
        self.pointer.split('/').skip(1).map(|step| step.replace("~1", "/").replace("~0", "~")).collect()
    }
}

/// Where the values go, and what that place is called: `pointer`, or the name of a `parameter` of the plant.
fn read_place(object: &mut Object<'_>, value: &Value<'_>, errors: &mut Errors) -> Result<(String, String), Reported> {
    let (pointer, parameter) = (object.optional("pointer"), object.optional("parameter"));
    match (pointer, parameter) {
        (Some(value), None) => {
            let pointer = value.string(errors)?;
            if pointer.starts_with('/') {
                return Ok((pointer.to_owned(), pointer.to_owned()));
            }
            let error = value.error(ErrorKind::Range, "this is no JSON pointer to a field");
            Err(errors.report(error.expected("expected `/` and a name, as in `/lyapunov/alpha`")))
        }
        (None, Some(value)) => {
            let name = value.string(errors)?;
            let escaped = name.replace('~', "~0").replace('/', "~1");
            Ok((format!("/parameters/{escaped}"), name.to_owned()))
        }
        (None, None) => Err(object.required("pointer", errors).err().unwrap_or_else(|| {
            // It was looked for above.
            errors.report(value.error(ErrorKind::MissingField, "the field `pointer` is missing"))
        })),
        (Some(_), Some(second)) => {
            let error = second.error(ErrorKind::Range, "`parameter` stands beside `pointer`: both say what is varied");
            Err(errors.report(error.help("leave one of them out")))
        }
    }
}

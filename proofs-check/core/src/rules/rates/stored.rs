//! Matrices of a witness as they stand in the file.

use crate::jacobian::Matrix;
use crate::json::Field;
use crate::verdict::{Outcome, bad};
use rug::Rational;

/// The numbers of a row.
pub fn numbers(row: &Field<'_>) -> Outcome<Vec<Rational>> {
    row.elements()?.iter().map(Field::rational).collect()
}

/// The lower triangle of a matrix of so many rows; `what` they are.
pub fn triangle(rows: &Field<'_>, order: usize, what: &str) -> Outcome<Matrix> {
    let list = rows.elements()?;
    if list.len() != order {
        return bad(&rows.pointer, format!("expected {order} rows, {what}"));
    }
    let matrix = list.iter().map(numbers).collect::<Outcome<Matrix>>()?;
    if let Some(i) = matrix.iter().enumerate().position(|(i, row)| row.len() != i + 1) {
        return bad(&list[i].pointer, format!("expected {} numbers, up to the diagonal", i + 1));
    }
    Ok(matrix)
}

//! Break points on [0, 1] by bisection.

use rug::Rational;

/// What is known of a cell.
pub enum Judgement {
    /// It is proved.
    Proved,
    /// Its halves may be proved.
    Halve,
    /// No halves of it can be proved, for what happens at the first end (0) or at the second (1).
    Stop(usize),
}

/// Points that increase from 0 to 1 such that every cell between neighbours is judged to be proved; else a place where that
/// fails. `left`: how many cells may yet be halved; `at`: what is computed once for each end of a cell.
///
/// # Errors
/// The place.
pub fn break_points<S: Clone>(
    left: &mut usize,
    at: impl Fn(&Rational) -> S,
    judge: impl Fn([&Rational; 2], [&S; 2]) -> Judgement,
) -> Result<Vec<Rational>, Rational> {
    let end = |s: Rational| (at(&s), s);
    let mut points = vec![Rational::new()];
    let mut queue = vec![[end(Rational::new()), end(Rational::from(1))]];
    while let Some([(at_a, a), (at_b, b)]) = queue.pop() {
        match judge([&a, &b], [&at_a, &at_b]) {
            Judgement::Proved => points.push(b),
            Judgement::Halve if *left > 0 => {
                *left -= 1;
                let middle = end(Rational::from(&a + &b) / 2u32);
                queue.extend([[middle.clone(), (at_b, b)], [(at_a, a), middle]]);
            }
            Judgement::Stop(0) => return Err(a),
            Judgement::Halve | Judgement::Stop(_) => return Err(b),
        }
    }
    Ok(points)
}

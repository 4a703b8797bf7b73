//! The bounds of all entries, by subdivision of the box of the parameters and of b (docs/mathematics.md, section 14.3).
//!
//! A box is done when each bound is shown on it; those that are not are asked on its halves. All entries share the answers of the plant on a box. Which
//! side is halved decides nothing.

use super::answer::Answer;
use super::answers;
use super::bound::Judgement;
use super::complex::Complex;
use super::entry::{Asked, Entry, OnBox};
use super::held::Held;
use super::jet::{Axes, Jet};
use super::largest::Times;
use super::oscillators::Regulator;
use super::system::{Evaluator, System};
use proofs_core::effort;
use proofs_core::input_gain::Gain;
use proofs_core::interval::Interval;
use proofs_core::rules::by_n_o::claimed::RULE;
use proofs_core::verdict::{Outcome, Verdict, demand, finding};
use rug::Rational;
use std::collections::VecDeque;

/// The most boxes.
const MOST_BOXES: usize = 20_000;
/// How many more are looked at, for a refutation, where a number is too close to be proved.
const MOST_AFTER_CLOSE: usize = 100;
/// A side that is narrower in comparison with that of the first box is not halved.
const LEAST_SHARE: f64 = 1e-9;

/// The box of everything that is uncertain.
pub struct Whole<'w> {
    /// The ends of the parameters.
    pub parameters: Vec<&'w [Rational; 2]>,
    /// b, where it is not 1.
    pub gain: Option<Gain>,
}

/// The sides of the parameters and, where it is not 1, of b; and what is open, by the entry and the places in it.
#[derive(Clone)]
struct Piece {
    sides: Vec<Interval>,
    open: Vec<(usize, Vec<usize>)>,
}

impl Whole<'_> {
    fn piece(&self, entries: &[Entry], precision: u32) -> Piece {
        let of_parameters = self.parameters.iter().map(|[lo, hi]| Interval::between(lo, hi, precision));
        let of_gain = self.gain.iter().map(|gain| gain.low.hull(&gain.high));
        let open = entries.iter().enumerate().map(|(place, entry)| (place, (0..entry.asked.len()).collect()));
        Piece { sides: of_parameters.chain(of_gain).collect(), open: open.collect() }
    }

    /// Its corners, moved inward a little, with everything open; at most 32, for there are at most four parameters.
    fn corners(&self, entries: &[Entry], precision: u32) -> impl Iterator<Item = Piece> {
        let piece = self.piece(entries, precision);
        let inward = Interval::rational(&(Rational::from(1) >> 20), precision);
        let corner = move |corner: usize| {
            let end = |(place, side): (usize, &Interval)| {
                let end = if corner >> place & 1 == 1 { side.ceiling() } else { side.floor() };
                (&end + (side.middle() - &end) * &inward).middle()
            };
            Piece { sides: piece.sides.iter().enumerate().map(end).collect(), open: piece.open.clone() }
        };
        let sides = (self.parameters.len() + usize::from(self.gain.is_some())).min(5);
        (0..1 << sides).map(corner)
    }

    /// Whether the middle of a box certainly belongs to it.
    fn has_middle(&self, piece: &Piece) -> bool {
        let middles: Vec<Interval> = piece.sides.iter().map(Interval::middle).collect();
        let within = |(middle, [lo, hi]): (&Interval, &&[Rational; 2])| *middle.lo() >= *lo && *middle.hi() <= *hi;
        let of_gain = self.gain.as_ref().zip(middles.get(self.parameters.len()));
        middles.iter().zip(&self.parameters).all(within)
            && of_gain.is_none_or(|(gain, b)| *b.lo() >= *gain.low.hi() && *b.hi() <= *gain.high.lo())
    }

    fn place(&self, piece: &Piece) -> String {
        let middles: Vec<String> = piece.sides.iter().map(|side| format!("{:.6}", side.to_f64())).collect();
        let (of_parameters, of_gain) = middles.split_at(self.parameters.len().min(middles.len()));
        let parameters = (!of_parameters.is_empty()).then(|| format!("p = ({})", of_parameters.join(", ")));
        let words: Vec<String> = parameters.into_iter().chain(of_gain.iter().map(|b| format!("b = {b}"))).collect();
        if words.is_empty() { String::new() } else { format!(", at {}", words.join(", ")) }
    }
}

/// What is left of a box.
struct Left {
    /// What is open on it.
    open: Vec<(usize, Vec<usize>)>,
    /// How much each side that counts contributes; a hint.
    scores: Vec<f64>,
    /// Whether a number is so close that nothing will be proved of it.
    close: bool,
}

/// What is computed on a box.
pub struct Computation<'c, 's> {
    pub system: &'c System,
    pub evaluator: Evaluator<'s>,
    pub regulator: &'c Regulator<'c>,
    /// The harmonics of the forcing.
    pub harmonics: &'c [usize],
    pub times: Times,
}

impl Computation<'_, '_> {
    /// The sides that count, by their places: parameters, and b.
    fn sides(&self, whole: &Whole<'_>) -> Vec<usize> {
        let of_gain = whole.gain.iter().map(|_| whole.parameters.len());
        self.system.parameters.iter().copied().chain(of_gain).collect()
    }

    /// Proves every bound of all entries; by how many boxes. What is not proved may be refuted near a corner.
    pub fn prove(&mut self, entries: &[Entry], whole: &Whole<'_>) -> Outcome<usize> {
        let open = match self.cover(entries, whole) {
            Err(finding) if finding.verdict == Verdict::Undecided && !effort::exhausted() => finding,
            decided => return decided,
        };
        for corner in whole.corners(entries, self.regulator.om.precision()) {
            self.judge(entries, whole, &corner).map(drop).or_else(|finding| match finding.verdict {
                Verdict::Invalid => Err(finding),
                _ => Ok(()),
            })?;
        }
        Err(open)
    }

    /// Proves them on boxes that cover the whole. The first that came are looked at first: what is refuted is seen on large boxes.
    fn cover(&mut self, entries: &[Entry], whole: &Whole<'_>) -> Outcome<usize> {
        let first = whole.piece(entries, self.regulator.om.precision());
        let mut queue = VecDeque::from([first.clone()]);
        let (mut count, mut allowed) = (0, MOST_BOXES);
        while let Some(piece) = queue.pop_front() {
            count += 1;
            let asked =
                |(entry, places): &(usize, Vec<usize>)| places.first().map(|place| &entries[*entry].asked[*place]);
            let Some(next) = piece.open.iter().find_map(asked) else { continue };
            if count > allowed || effort::exhausted() {
                return not_shown(next, &whole.place(&piece));
            }
            let left = self.judge(entries, whole, &piece)?;
            let Some(next) = left.open.iter().find_map(asked) else { continue };
            if left.close {
                allowed = allowed.min(count + MOST_AFTER_CLOSE);
            }
            match self.widest(whole, [&piece, &first], &left.scores) {
                None => return not_shown(next, &whole.place(&piece)),
                Some(side) => queue.extend(piece.sides[side].halves().map(|half| {
                    let mut sides = piece.sides.clone();
                    sides[side] = half;
                    Piece { sides, open: left.open.clone() }
                })),
            }
        }
        Ok(count)
    }

    /// What is still open on a box, and how much each side that counts contributes.
    fn judge(&mut self, entries: &[Entry], whole: &Whole<'_>, piece: &Piece) -> Outcome<Left> {
        let count = whole.parameters.len();
        let sides = self.sides(whole);
        let half_widths: Vec<Interval> = sides.iter().map(|side| piece.sides[*side].half_width()).collect();
        let axes = Axes::new(&half_widths);
        let Some(numbers) = self.evaluator.on(&piece.sides[..count]) else { return not_seen() };
        let plant = answers::OnBox { axes: &axes, numbers: &numbers, states: self.system.states() };
        let frequency = |k: &usize| self.regulator.frequency(*k);
        let fastest = frequency(self.harmonics.last().unwrap_or(&0));
        let held = self.regulator.at_samples.as_ref().map(|of| Held::new(&axes, plant.rows(), of, &fastest));
        let answer = |k: &usize| {
            let at_all_times = plant.answer(*k, &frequency(k));
            match &held {
                None => at_all_times,
                Some(held) => held.answer(*k, &frequency(k), at_all_times.forcing),
            }
        };
        let answers: Vec<Answer> = self.harmonics.iter().map(answer).collect();
        let gain = self.gain(&piece.sides[count..], axes.count());
        let on_box = OnBox { axes: &axes, answers: &answers, held: held.as_ref(), gain: &gain };
        let mut left = Left { open: Vec::new(), scores: vec![0.0; axes.count()], close: false };
        for (place, asked) in &piece.open {
            let judged = entries[*place].judge(asked, &on_box, (self.regulator, &self.times));
            let mut open = Vec::new();
            for (which, (judgement, shares)) in asked.iter().zip(judged) {
                let about = &entries[*place].asked[*which];
                match judgement {
                    Judgement::Proved => continue,
                    Judgement::Refuted if whole.has_middle(piece) => {
                        let what = format!("{}{}", about.what, whole.place(piece));
                        demand(Some(false), RULE, &about.pointer, what)?;
                    }
                    Judgement::Stuck => return not_shown(about, &whole.place(piece)),
                    Judgement::Close | Judgement::Refuted => left.close = true,
                    Judgement::Open => {}
                }
                open.push(*which);
                left.scores.iter_mut().zip(&shares).for_each(|(score, share)| *score += share);
            }
            if !open.is_empty() {
                left.open.push((*place, open));
            }
        }
        Ok(left)
    }

    /// b, the last axis; 1 where there is none.
    fn gain(&self, side: &[Interval], axes: usize) -> Jet<Complex> {
        let p = self.regulator.om.precision();
        let one = Complex::real(Interval::int(1, p));
        let Some(side) = side.first() else { return Jet::constant(&one) };
        let slopes = (1..=axes).map(|axis| if axis == axes { one.clone() } else { Complex::zero(p) });
        Jet { middle: Complex::real(side.middle()), all: Complex::real(side.clone()), slopes: slopes.collect() }
    }

    /// The side that contributes most, or the widest one in comparison with the first box; none where that is too narrow.
    fn widest(&self, whole: &Whole<'_>, [piece, first]: [&Piece; 2], scores: &[f64]) -> Option<usize> {
        let sides = self.sides(whole);
        let width = |piece: &Piece, side: usize| piece.sides[side].half_width().hi().to_f64();
        let share = |side: usize| if width(first, side) > 0.0 { width(piece, side) / width(first, side) } else { 0.0 };
        let known = scores.iter().all(|score| score.is_finite()) && scores.iter().any(|score| *score > 0.0);
        let by_score = sides.iter().zip(scores).max_by(|a, b| a.1.total_cmp(b.1)).map(|(side, _)| *side);
        let by_width = sides.iter().copied().max_by(|a, b| share(*a).total_cmp(&share(*b)));
        (if known { by_score } else { by_width }).filter(|side| share(*side) > LEAST_SHARE)
    }
}

fn not_shown<T>(asked: &Asked, place: &str) -> Outcome<T> {
    let message = format!("can be neither proved nor refuted: {}{place}", asked.what);
    Err(finding(Verdict::Undecided, RULE, &asked.pointer, message))
}

/// That f_0 or q_0 is no trigonometric polynomial by its form.
pub fn not_seen<T>() -> Outcome<T> {
    let message = "it is not seen that f(t,0,0) and q(t,0,0) are trigonometric polynomials of the period";
    Err(finding(Verdict::Undecided, RULE, "/plant", message))
}

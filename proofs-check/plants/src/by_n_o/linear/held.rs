//! What a plant that is linear in x and e answers at samples and between them, where the control is held (docs/mathematics.md, section 14.6), harmonic by
//! harmonic on a box of its parameters.
//!
//! With `Ae = [A b_e; c d]`, B the last unit vector, `E = (e^(h Ae) - I)/h`, `G = (1/h) int_0^h e^(s Ae) ds B` and
//! `F_k = (c_k/h) int_0^h e^((h-s) Ae) e^(i om_k s) ds B`, `delta_k = (e^(i om_k h) - 1)/h` and `R_k = (delta_k - E_xx)^-1`, it is
//! `(delta_k - W_k) e_k = beta_k b u_k + gamma_k` and `x_k - x_0k = R_k (E_xe e_k + G_x b u_k + F_x)`, where `W_k = E_ee + E_ex R_k E_xe`,
//! `beta_k = G_e + E_ex R_k G_x` and `gamma_k = F_e + E_ex R_k F_x`.
//!
//! Between samples `q' = (c,d) X_k'(s) + i om_k c_k e^(i om_k s)`, and `X_k'(s) = e^(s Ae) X_k'(0) + i om_k c_k int_0^s e^((s-r) Ae) e^(i om_k r) dr B`
//! with `X_k'(0) = Ae X_k + B (b u_k + c_k)`. The bound of |q'| is taken on parts of [0, h].

use super::answers::{Answer, solved};
use super::bound::Bound;
use super::complex::Complex;
use super::jet::{Axes, Jet, Number};
use super::oscillators::Sampling;
use super::series::{Exponential, column, complex, plus_products};
use proofs_core::interval::Interval;

/// On how many parts of a sample |q'| is bounded.
const PARTS: i64 = 8;

/// What is the same for all harmonics.
pub struct Held<'h> {
    axes: &'h Axes,
    sampling: &'h Sampling,
    of: Exponential<'h>,
    /// E by rows, and G.
    step: Vec<Vec<Jet<Complex>>>,
    control: Vec<Jet<Complex>>,
    /// The parts of [0, h], and `(c,d) e^(s Ae)` on each.
    parts: Vec<(Interval, Vec<Jet<Complex>>)>,
}

/// What one harmonic has besides.
pub struct Between {
    /// c_k.
    input: Jet<Complex>,
    /// beta_k.
    pub of_control: Jet<Complex>,
    /// `R_k G_x` and `R_k F_x`.
    pub states: Vec<[Jet<Complex>; 2]>,
    /// On each part of [0, h] what q' has of c_k alone.
    rates: Vec<Jet<Complex>>,
}

impl<'h> Held<'h> {
    /// Of the rows of Ae, for harmonics up to the frequency `fastest`.
    pub fn new(axes: &'h Axes, rows: Vec<Vec<Jet<Interval>>>, sampling: &'h Sampling, fastest: &Interval) -> Held<'h> {
        let h = &sampling.h;
        let output = rows.last().cloned().unwrap_or_default();
        let of = Exponential::new(axes, rows, fastest, h);
        let over_h = |jet: &Jet<Interval>| complex(&jet.mapped(|value| value / h));
        let step = of.grown(h).iter().map(|row| row.iter().map(over_h).collect()).collect();
        let still = of.driven(&Complex::zero(h.precision()));
        let control = of.answer(&still, h).iter().map(|jet| jet.mapped(|value| value.scaled(&h.recip()))).collect();
        let part = |i: i64| {
            let s = (h * i / PARTS).hull(&(h * (i + 1) / PARTS));
            let grown = of.grown(&s);
            let entry = |j: usize| complex(&plus_products(axes, output[j].clone(), &output, &column(&grown, j)));
            let row = (0..output.len()).map(entry).collect();
            (s, row)
        };
        let parts = (0..PARTS).map(part).collect();
        Held { axes, sampling, step, control, parts, of }
    }

    /// The answer of a harmonic, from its frequency and c_k.
    pub fn answer(&self, k: usize, frequency: &Interval, input: Jet<Complex>) -> Answer {
        let (axes, p, states) = (self.axes, frequency.precision(), self.step.len() - 1);
        let Sampling { h, .. } = self.sampling;
        let turning = Complex { re: Interval::int(0, p), im: frequency.clone() };
        let driven = self.of.driven(&turning);
        let own: Vec<Jet<Complex>> = self
            .of
            .answer(&driven, h)
            .iter()
            .map(|jet| axes.times(&input, &jet.mapped(|value| value.scaled(&h.recip()))))
            .collect();
        let speed = self.sampling.speed(k);
        let (of_e, output) = (&self.step[states], Jet::constant(&speed));
        // The rows of [delta_k - E_xx | E_xe, G_x, F_x].
        let row = |i: usize| {
            let mut row: Vec<Jet<Complex>> =
                self.step[i].iter().take(states).map(|entry| entry.mapped(Number::opposite)).collect();
            row[i] = row[i].plus(&output);
            row.extend([self.step[i][states].clone(), self.control[i].clone(), own[i].clone()]);
            row
        };
        let solved = solved((0..states).map(row).collect(), axes);
        let along = |start: &Jet<Complex>, which: usize| {
            let terms = solved.iter().zip(of_e).map(|(row, entry)| axes.times(entry, &row[which]));
            terms.fold(start.clone(), |sum, term| sum.plus(&term))
        };
        let (transfer, of_control, forcing) =
            (along(&of_e[states], 0), along(&self.control[states], 1), along(&own[states], 2));
        let output: Vec<Jet<Complex>> = self.of.matrix.last().cloned().unwrap_or_default();
        let rate = |(s, _): &(Interval, Vec<Jet<Complex>>)| {
            let angle = frequency * s;
            let wave = Jet::constant(&Complex { re: angle.cos(), im: angle.sin() });
            let moved = plus_products(axes, wave, &output, &self.of.answer(&driven, s));
            axes.times(&input, &moved.mapped(|value| value.times(&turning)))
        };
        let rates = self.parts.iter().map(rate).collect();
        let (mut of_error, mut of_others) = (Vec::new(), Vec::new());
        for row in solved {
            let mut row = row.into_iter();
            of_error.extend(row.next());
            if let (Some(of_control), Some(of_forcing)) = (row.next(), row.next()) {
                of_others.push([of_control, of_forcing]);
            }
        }
        let between = Between { input, of_control, states: of_others, rates };
        Answer { k, speed, of_error, transfer, forcing, between: Some(between) }
    }

    /// rho_k: a bound of the harmonic of q' between samples, for the states, e and b u at the samples.
    pub fn rate(&self, between: &Between, at_sample: &[Jet<Complex>], control: &Jet<Complex>) -> Bound {
        let p = self.sampling.h.precision();
        let zero = Jet::constant(&Complex::zero(p));
        let mut velocity: Vec<Jet<Complex>> =
            self.of.matrix.iter().map(|row| plus_products(self.axes, zero.clone(), row, at_sample)).collect();
        if let Some(last) = velocity.last_mut() {
            *last = last.plus(control).plus(&between.input);
        }
        let bounds = self.parts.iter().zip(&between.rates).map(|((_, row), own)| {
            Bound::of(&self.axes.narrowed(plus_products(self.axes, own.clone(), row, &velocity)))
        });
        bounds.fold(Bound::zero(p), |most, bound| most.most(&bound))
    }
}

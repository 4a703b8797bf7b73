//! What a plant that is linear in x and e answers at samples and between them, where the control is held (docs/mathematics.md, section 14.6), harmonic by
//! harmonic on a box of its parameters.
//!
//! With `Ae = [A b_e; c d]`, B the last unit vector, `E = (e^(h Ae) - I)/h`, `G = (1/h) int_0^h e^(s Ae) ds B` and
//! `F_k = (c_k/h) int_0^h e^((h-s) Ae) e^(i om_k s) ds B`, `delta_k = (e^(i om_k h) - 1)/h` and `R_k = (delta_k - E_xx)^-1`, it is
//! `(delta_k - W_k) e_k = beta_k b u_k + gamma_k` and `x_k - x_0k = R_k (E_xe e_k + G_x b u_k + F_x)`, where `W_k = E_ee + E_ex R_k E_xe`,
//! `beta_k = G_e + E_ex R_k G_x` and `gamma_k = F_e + E_ex R_k F_x`.
//!
//! Between samples q changes as `X_k'(0) = Ae X_k + B (b u_k + c_k)` and c_k say ([`super::between`]).

use super::answer::{Answer, Between, solved};
use super::between::Ways;
use super::bound::Bound;
use super::complex::Complex;
use super::jet::{Axes, Jet, Number};
use super::oscillators::Sampling;
use super::series::{Exponential, complex, plus_products};
use proofs_core::interval::Interval;

/// What is the same for all harmonics.
pub struct Held<'h> {
    axes: &'h Axes,
    sampling: &'h Sampling,
    of: Exponential<'h>,
    /// E by rows, and G.
    step: Vec<Vec<Jet<Complex>>>,
    control: Vec<Jet<Complex>>,
    ways: Ways,
}

impl<'h> Held<'h> {
    /// Of the rows of Ae, for harmonics up to the frequency `fastest`.
    pub fn new(axes: &'h Axes, rows: Vec<Vec<Jet<Interval>>>, sampling: &'h Sampling, fastest: &Interval) -> Held<'h> {
        let h = &sampling.h;
        let of = Exponential::new(axes, rows, fastest, h);
        let over_h = |jet: &Jet<Interval>| complex(&jet.mapped(|value| value / h));
        let step = of.grown(h).iter().map(|row| row.iter().map(over_h).collect()).collect();
        let still = of.driven(&Complex::zero(h.precision()));
        let control = of.answer(&still, h).iter().map(|jet| jet.mapped(|value| value.scaled(&h.recip()))).collect();
        let ways = Ways::new(axes, &of, fastest, h);
        Held { axes, sampling, step, control, ways, of }
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
        let rates = self.ways.of_wave(axes, (&self.of, &driven), (&turning, &input));
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
        let zero = Jet::constant(&Complex::zero(self.sampling.h.precision()));
        let mut velocity: Vec<Jet<Complex>> =
            self.of.matrix.iter().map(|row| plus_products(self.axes, zero.clone(), row, at_sample)).collect();
        if let Some(last) = velocity.last_mut() {
            *last = last.plus(control).plus(&between.input);
        }
        self.ways.most(self.axes, &between.rates, &velocity)
    }
}

//! Rule (14.7b): the poles of every finite set of harmonics that contains 0 (docs/mathematics.md, section 14.7).
//!
//! With nu as the pair's proof has it, `b_lo nu` with an input gain, and for k >= 1 `s_k = sum over |l| != k of c_l/(l - k)^2` and
//! `gamma_k = n_0/k - sum over l > k of n_l k/(l^2 - k^2)`, (14.7b) is `nu^2 (n_k s_k/2 - max{gamma_k, 0}^2) <= 1`.
//!
//! Guarantee where all [`steps`] hold: (14.7b) for every k >= 1, so that `T_H(k) <= 2/(nu^2 n_k)` for each of these sets H, with k in it or not. The
//! last step settles every k from the least K with (14.7c), for its left side does not grow with k; the others are about k < K, one by one. The terms with
//! `|l| <= L = 4 k + 64` are added up; beyond, `n_(L+1)/(L - k)` is at least what they add to s_k, and `n_(L+1) k/(L + 1 - k)` what they take from gamma_k.

use crate::data::Data;
use crate::effort;
use crate::interval::Interval;

/// What is compared, and both sides: the first one has to be at most the other.
pub type Step = (String, Interval, Interval);

/// The largest K.
const MOST: u32 = 4096;

/// The weights that were asked for, each computed once.
struct Table<'d> {
    d: &'d Data<'d>,
    values: Vec<Interval>,
}

impl Table<'_> {
    /// n_l.
    fn weight(&mut self, l: u32) -> &Interval {
        while self.values.len() <= l as usize {
            self.values.push(self.d.weight(self.values.len() as u64));
        }
        &self.values[l as usize]
    }
}

/// The comparisons; none where no K up to 4096 has (14.7c), or nothing is left of the steps that an answer may take.
pub fn steps(d: &Data<'_>) -> Option<Vec<Step>> {
    let mut table = Table { d, values: Vec::new() };
    let last = (1..=MOST).map(|k| settled(&mut table, k)).find(|(_, lhs, rhs)| lhs.le(rhs) == Some(true));
    let last = last.filter(|_| !effort::exhausted())?;
    let count = last.0;
    let mut steps = Vec::new();
    for k in 1..count {
        steps.push(at(&mut table, k));
        if effort::exhausted() {
            return None;
        }
    }
    let what = format!("every k >= {count}: (nu^2 n_K/2)(4 Nbar^2/K^2 + (pi^2/6) n_(floor(K/2)+1)) <= 1");
    steps.push((what, last.1, last.2));
    Some(steps)
}

/// Whether (14.7b) is proved for every k >= 1.
pub fn holds(d: &Data<'_>) -> bool {
    steps(d).is_some_and(|steps| steps.iter().all(|(_, lhs, rhs)| lhs.le(rhs) == Some(true)))
}

/// k, and both sides of (14.7c) with it for K.
fn settled(table: &mut Table<'_>, k: u32) -> (u32, Interval, Interval) {
    let d = table.d;
    let near = d.n_bar.sqr() * 4 / (i64::from(k) * i64::from(k));
    let far = Interval::pi(d.precision).sqr() / 6 * table.weight(k / 2 + 1);
    (k, d.nu.sqr() * table.weight(k) / 2 * (near + far), d.int(1))
}

/// (14.7b) at one k.
fn at(table: &mut Table<'_>, k: u32) -> Step {
    let d = table.d;
    let most = 4 * k + 64;
    let rest = table.weight(most + 1).clone();
    let square = |l: u32| i64::from(l) * i64::from(l);
    // Those beyond, and the pole 0.
    let mut sum = table.weight(0) / square(k) + &rest / i64::from(most - k);
    let mut pull = table.weight(0) / i64::from(k) - rest * i64::from(k) / i64::from(most + 1 - k);
    for l in (1..=most).filter(|l| *l != k) {
        // l and -l together.
        let (apart, weight) = (square(l) - square(k), table.weight(l));
        sum = sum + weight * (square(l) + square(k)) / (apart * apart);
        if l > k {
            pull = pull - weight * i64::from(k) / apart;
        }
    }
    let own = table.weight(k) * sum / 2 - pull.max(&d.int(0)).sqr();
    let what = format!("k = {k}: nu^2 (n_k s_k/2 - max{{gamma_k, 0}}^2) <= 1");
    (what, d.nu.sqr() * own, d.int(1))
}

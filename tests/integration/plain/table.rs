//! The table of constants of a certificate a second time (sections 2 to 6 and 10), cell by cell.

use super::{BITS, R, Spec, constant, number, numbers, r, sizes, weight};
use rug::Float;
use serde_json::Value;
use std::collections::BTreeMap;

/// What stands in a cell.
pub enum Cell<'a> {
    Number(R),
    /// From one number to another.
    Span(R, R),
    /// The largest argument with a property that holds of every smaller one, and the end of the domain.
    Largest(Box<dyn Fn(&R) -> bool + 'a>, Option<R>),
    /// The smallest gain with a property that holds of every larger one.
    Least(Box<dyn Fn(&R) -> bool + 'a>),
    /// A reason in words that names a number, rounded up or down.
    Reason(R),
}

/// The cells by the names of the constant and of the derivation, each with whether it is sound: none where that is a comparison of two
/// numbers that are equal, which enclosures need not decide.
pub type Table<'a> = BTreeMap<(String, &'static str), (Cell<'a>, Option<bool>)>;

fn pi() -> R {
    R(Float::with_val(BITS, rug::float::Constant::Pi))
}

/// A row under construction.
struct Rows<'a>(Table<'a>);

impl<'a> Rows<'a> {
    fn cell(&mut self, name: &str, derivation: &'static str, cell: Cell<'a>, is_sound: bool) {
        self.0.insert((name.to_owned(), derivation), (cell, Some(is_sound)));
    }

    fn sound(&mut self, name: &str, derivation: &'static str, value: &R) {
        self.cell(name, derivation, Cell::Number(value.clone()), true);
    }

    /// Of the printed, the repaired and the sharp derivation; the printed one is sound where it is not below the sharp one.
    fn row(&mut self, name: &str, printed: &R, repaired: &R, sharp: &R) {
        let apart = R((printed - sharp).0.abs()) > printed * r(1e-100);
        let is_sound = apart.then_some(sharp < printed);
        self.0.insert((name.to_owned(), "printed"), (Cell::Number(printed.clone()), is_sound));
        self.sound(name, "repaired", repaired);
        self.sound(name, "sharp", sharp);
    }
}

impl Spec<'_> {
    /// The whole table that a certificate should hold.
    pub fn table<'a>(&'a self, certificate: &'a Value) -> Table<'a> {
        let mut rows = Rows(Table::new());
        self.common(certificate, &mut rows);
        self.own(certificate, &mut rows);
        rows.0
    }

    /// What all derivations have at X_p, E_p and sigma of the claim.
    fn common<'a>(&'a self, certificate: &'a Value, rows: &mut Rows<'a>) {
        let [x, e, k0, k1] = numbers(&certificate["witness"], ["X_p", "E_p", "k0", "k1"]);
        let sigma = number(&certificate["claim"]["sigma_star"]);
        let derived = self.derive(certificate);
        let at = self.at(&x, &e);
        let axis = self.at(&x, &r(0.0)).fxx;
        let (k, beta) = (self.k_alpha(), r(2.0) * self.beta(&sigma));
        let is_matched = self.spec.internal_model.matched;

        let half = R(Float::with_val(BITS, (&self.alpha * &self.t / r(2.0)).0.coth_ref()));
        let root = (half / r(2.0)).sqrt();
        ["printed", "repaired"].into_iter().for_each(|derivation| rows.sound("K_alpha", derivation, &k));
        rows.sound("K_alpha", "sharp", &self.c);
        rows.row("K_alpha2", &(&k * &root * self.t.sqrt()), &(&k * &root), &(&self.c * &root));
        rows.sound("Nbar", "printed", &self.n_bar);
        let bt = (self.beta(&sigma).sq() - r(1.0) / sigma.sq()).sqrt();
        rows.row("beta", &beta, &beta, &bt);
        rows.sound("tau", "sharp", &self.tau(&sigma));

        let over = &k / &self.alpha;
        let paper = [&over * (&at.fex * &e + r(2.0) * &axis * &x), &over * &at.fe, &beta * &at.qx, &beta * &at.qe];
        let over = &self.c / &self.alpha;
        let sg = (sigma.sq() + self.om().sq()).sqrt();
        let sharp = [&over * (&at.fex * &e + &axis * &x), &over * &at.fe, &at.qx / &sg, &at.qe / &sg];
        let derive = |[xx, xe, ex, ee]: &[R; 4]| {
            let discriminant = (xx - ee).sq() + r(4.0) * xe * ex;
            let radius = (xx + ee + discriminant.sqrt()) / r(2.0);
            [radius, (r(1.0) - xx) * (r(1.0) - ee) - xe * ex]
        };
        let names =
            ["Upsilon_xx", "Upsilon_xe", "Upsilon_ex", "Upsilon_ee", "spectral radius of Upsilon", "1 - tr + det"];
        let all = |entries: &[R; 4]| entries.iter().cloned().chain(derive(entries)).collect::<Vec<R>>();
        for ((name, paper), sharp) in names.iter().zip(all(&paper)).zip(all(&sharp)) {
            ["printed", "repaired"].into_iter().for_each(|derivation| rows.sound(name, derivation, &paper));
            rows.sound(name, "sharp", &sharp);
        }
        let determinant = |[xx, xe, ex, ee]: &[R; 4]| xx * ee - xe * ex;
        let name = "second Jury quantity";
        rows.cell(name, "printed", Cell::Number(r(1.0) + determinant(&paper)), false);
        rows.sound(name, "repaired", &(r(1.0) - determinant(&paper)));
        rows.sound(name, "sharp", &(r(1.0) - determinant(&sharp)));

        // The printed transfer lemma counts where both its constants dominate the closed form.
        let weights = &self.spec.internal_model.weights;
        let [n_0, n_1, n_2] = [0, 1, 2].map(|l| weight(weights, l));
        let s = &n_0 / &n_1 + &n_0 / (r(3.0) * &n_2) + r(10.0) / r(3.0);
        let a = ((r(2.0) + r(2.0).sqrt()) * &s).max(&r(3.125));
        let varpi = r(1.0) / (r(48.0) * (r(2.0) + &a));
        let lemma = [r(3.5) * &n_0, r(4.0) * &n_0 / varpi.sq() + r(512.0) / (self.mu.sq() * &n_1)];
        let [closed_0, closed_1] = self.closed_form();
        let closed = self.kappas([&closed_0, &closed_1]);
        let believed = (0..2).all(|i| closed[i] <= lemma[i]);
        for (name, value) in [("S", &s), ("a", &a), ("varpi", &varpi)] {
            rows.cell(name, "printed", Cell::Number(value.clone()), believed);
        }
        for m in 1..4 {
            let span = Cell::Span(&varpi / r(f64::from(m)), r(1.0) / r(5.0));
            rows.cell(&format!("lambda interval, m = {m}"), "printed", span, believed);
        }
        let own = self.kappas([&k0, &k1]);
        for (i, name) in ["kappa_0", "kappa_1"].into_iter().enumerate() {
            rows.cell(name, "printed", Cell::Number(lemma[i].clone()), believed);
            rows.sound(name, "repaired", &closed[i]);
            rows.sound(name, "sharp", &own[i]);
        }
        let [z_printed, z_repaired] = [&lemma, &closed].map(|kappas| self.z_of_paper(&at, kappas));
        rows.cell("Z", "printed", Cell::Number(z_printed.clone()), believed);
        rows.sound("Z", "repaired", &z_repaired);
        rows.sound("Z", "sharp", &derived.sizes[2]);
        let [r_q, r_1] = &derived.rates;
        let psi = &self.t * r_1 / r(12.0).sqrt();
        let of_e = [&at.q + &self.n_bar * z_printed, &at.q + &self.mu * &self.n_bar * z_repaired];
        rows.row("r_e = psi_1", &of_e[0], &of_e[1], &psi);
        let gain = &k * &at.fe / (&self.alpha - &k * &axis * &x / r(2.0));
        rows.row("r_x = psi_x", &(&gain * &of_e[0]), &(&gain * &of_e[1]), &(&derived.x_gain * psi));
        let turn = (&self.t / (r(2.0) * pi())).sq();
        let (printed, sharp) = (&turn * at.q.sq(), &turn * r_q.sq() * &self.t);
        rows.row("psi_2", &printed, &(&printed * &self.t), &sharp);
        if !is_matched {
            ["repaired", "sharp"]
                .into_iter()
                .for_each(|derivation| drop(rows.0.remove(&("psi_2".to_owned(), derivation))));
        }

        let domain = self.spec.domain.as_ref();
        let [of_x, of_e] = [domain.map(|domain| constant(&domain.x)), domain.map(|domain| constant(&domain.e))];
        for derivation in ["printed", "repaired"] {
            let k = k.clone();
            let contracts = move |x: &R| r(2.0) * &k * self.at(x, &r(0.0)).fxx * x < self.alpha;
            rows.cell("x_p*", derivation, Cell::Largest(Box::new(contracts), of_x.clone()), true);
            let (k, x, axis) = (self.k_alpha(), x.clone(), axis.clone());
            let both = move |e: &R| {
                let at = self.at(&x, e);
                let room = &self.alpha / &k - &axis * &x * r(2.0);
                e * &at.fe <= &self.alpha * &x / &k - &axis * x.sq() / r(2.0) && e * &at.fex < room
            };
            rows.cell("e_p*(X_p)", derivation, Cell::Largest(Box::new(both), of_e.clone()), true);
        }
    }

    /// What each derivation has at its own free numbers.
    fn own<'a>(&'a self, certificate: &'a Value, rows: &mut Rows<'a>) {
        let (witness, claim) = (&certificate["witness"], &certificate["claim"]);
        let derived = self.derive(certificate);
        let found = &derived.error_box;
        for (name, value) in [("X_b", &found.x_b), ("E_b", &found.e_b), ("gam", &found.gamma), ("a_2", &found.rate)] {
            rows.sound(name, "sharp", value);
        }
        let names = ["h", "w_x", "D_x", "D_e"];
        names.iter().zip(numbers(witness, names)).for_each(|(name, value)| rows.sound(name, "sharp", &value));
        let [r_x, r_e, r_d] = &derived.means;
        let [r_q, r_1] = &derived.rates;
        let names = ["a_1", "r_x", "r_e", "r_d", "R_q", "R_1"];
        let values = [&derived.a_1, r_x, r_e, r_d, r_q, r_1];
        names.iter().zip(values).for_each(|(name, value)| rows.sound(name, "sharp", value));
        rows.sound("sigma_a*", "sharp", &found.threshold);
        sizes(claim).iter().for_each(|(name, value)| rows.sound(name, "sharp", value));
        rows.sound("sigma*", "sharp", &number(&claim["sigma_star"]));
        let exact = &witness["exact_regulation"]["sigma_star_oo"];
        if exact.is_string() {
            rows.sound("sigma*_oo", "sharp", &number(exact));
        }

        // No x_a, e_a of the paper: 81 <= 3.5 (3 sqrt(2)/c + 1/(2 c^2)) would follow.
        let reached = r(3.5) * (r(3.0) * r(2.0).sqrt() / &self.c + r(0.5) / self.c.sq());
        if reached < r(81.0) {
            for name in ["x_a, e_a of P:eq:boundx_bounde_1", "sigma*"] {
                rows.cell(name, "printed", Cell::Reason(reached.clone()), false);
            }
        }
        let ratio = &self.p_up / &self.p_low;
        if ratio > (r(6.0) + r(4.0) * r(2.0).sqrt()) / r(9.0) {
            rows.cell("sigma*_oo", "printed", Cell::Reason(ratio), false);
        }

        let Some(repaired) = self.repaired(certificate) else { return };
        let [x_b, e_b] = &repaired.arguments;
        let [rho_0, rho_11, rho_12, rho_22] = &repaired.rho;
        let [first, second, third] = &repaired.minors;
        for (name, value) in [
            ("X_b", x_b),
            ("E_b", e_b),
            ("rho_0", rho_0),
            ("rho_11", rho_11),
            ("rho_12", rho_12),
            ("rho_22", rho_22),
            ("h", &repaired.h),
            ("first minor of R", first),
            ("second minor of R", second),
            ("third minor of R", third),
            ("sigma_a*", &repaired.sigma_a),
            ("sigma*", &repaired.sigma),
        ] {
            rows.sound(name, "repaired", value);
        }
        repaired.sizes.iter().for_each(|(name, value)| rows.sound(name, "repaired", value));
        let largest = repaired.beta;
        let holds = move |sigma: &R| r(2.0) * self.beta(sigma) <= largest;
        rows.cell("sigma_p*", "repaired", Cell::Least(Box::new(holds)), true);
    }
}

//! Along which path a difference between two points is split into a part in x and a part in e (derivation, section 13.7).

/// The path from a periodic solution (x_p, e_p) to a point (x, e) of the error box. Where the derivatives along it lie:
///
/// | path | d/dx | d/de |
/// |---|---|---|
/// | x first, then e | (X_b, e_per) | (X_b, E_b) |
/// | e first, then x | (X_b, E_b) | (x_per, E_b) |
/// | straight | (X_b, E_b) | (X_b, E_b) |
///
/// For norms the straight path is no better than the others; certificates without paths have it for q.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Path {
    /// x first.
    StateFirst,
    /// e first.
    ErrorFirst,
    /// Both at once.
    Straight,
}

impl Path {
    /// The paths that a search chooses from.
    pub const CHOICE: [Path; 2] = [Path::StateFirst, Path::ErrorFirst];

    /// Every path.
    pub const ALL: [Path; 3] = [Path::StateFirst, Path::ErrorFirst, Path::Straight];

    /// Its name in files.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Path::StateFirst => "x-first",
            Path::ErrorFirst => "e-first",
            Path::Straight => "straight",
        }
    }

    /// The arguments where d/de is taken, in words.
    pub(super) fn place_of_de(self) -> &'static str {
        if self == Path::ErrorFirst { "(x_per, E_b)" } else { "(X_b, E_b)" }
    }

    /// The largest |e| where d/dx is taken.
    #[must_use]
    pub fn e_of_dx<'r, R>(self, e_per: &'r R, e_b: &'r R) -> &'r R {
        if self == Path::StateFirst { e_per } else { e_b }
    }

    /// The largest |x| where d/de is taken.
    #[must_use]
    pub fn x_of_de<'r, R>(self, x_per: &'r R, x_b: &'r R) -> &'r R {
        if self == Path::ErrorFirst { x_per } else { x_b }
    }
}

/// The paths of f and of q, independent of each other.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Paths {
    /// That of f.
    pub f: Path,
    /// That of q.
    pub q: Path,
}

impl Paths {
    /// Those of a certificate that names none.
    pub const UNNAMED: Paths = Paths { f: Path::StateFirst, q: Path::Straight };

    /// One path for f and q.
    #[must_use]
    pub const fn both(path: Path) -> Paths {
        Paths { f: path, q: path }
    }

    /// One for both: where they differ the straight one, which is open to both.
    #[must_use]
    pub fn common(self) -> Path {
        if self.f == self.q { self.f } else { Path::Straight }
    }

    /// The pairs that a search chooses from.
    pub fn choice() -> impl Iterator<Item = Paths> {
        Path::CHOICE.into_iter().flat_map(|f| Path::CHOICE.into_iter().map(move |q| Paths { f, q }))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::data::{Bound, Data, Numbers, Problem};
    use crate::derivation::stability::{ErrorBox, Sector};
    use proptest::prelude::*;
    use sigmastar_lang::spec::Specification;

    /// The paper's numbers, with P = 1.
    fn numbers(alpha: f64) -> Numbers<f64> {
        let spec = Specification::from_json("example", include_str!("../../../../specs/paper-example.json")).unwrap();
        let numbers = Data::new(&spec, 64).numbers.midpoints();
        Numbers { p_low: 1.0, p_up: 1.0, c: 1.0, alpha, ..numbers }
    }

    /// Bounding functions of which no more is known than that they are nondecreasing, and that the rate is nonincreasing: two
    /// steps and two slopes each.
    struct Nondecreasing {
        numbers: Numbers<f64>,
        terms: Vec<[f64; 5]>,
        rate: bool,
    }

    impl Problem<f64> for Nondecreasing {
        fn numbers(&self) -> &Numbers<f64> {
            &self.numbers
        }
        fn bound(&self, which: Bound, x: &f64, e: &f64) -> f64 {
            let number = Bound::ALL.iter().position(|bound| *bound == which).unwrap();
            let [least, in_x, in_e, step_x, step_e] = self.terms[number];
            let step = |at: f64, from: f64| if at > from { 1.0 } else { 0.0 };
            let value = least + in_x * x + in_e * e + step(*x, 3.0 * step_x) + step(*e, 3.0 * step_e);
            match which {
                Bound::Rate if self.rate => 5.0 - value,
                Bound::Rate => f64::NAN,
                Bound::QeMax => (value - 2.0).min(self.bound(Bound::Qe, x, e)),
                _ => value,
            }
        }
        fn given(&self, _: Bound) -> bool {
            true
        }
        fn zero(&self) -> f64 {
            0.0
        }
    }

    proptest! {
        /// A path that is taken costs nothing against the straight one, which is the older arguments of both derivatives of q.
        #[test]
        fn no_path_of_the_choice_is_worse_than_the_straight_one(
            terms in prop::collection::vec(prop::array::uniform5(0.0..1.0), Bound::ALL.len()),
            rate: bool,
            periodic in prop::array::uniform2(0.0..1.5),
            radii in prop::array::uniform2(0.0..1.5),
        ) {
            let problem = Nondecreasing { numbers: numbers(3.0), terms, rate };
            let (periodic, radii) = (periodic.each_ref(), radii.each_ref());
            let straight = ErrorBox::new(&problem, Paths::both(Path::Straight), periodic, radii);
            let mut seen = Vec::new();
            for (paths, of_path) in ErrorBox::on_paths(&problem, periodic, radii) {
                seen.push(paths);
                prop_assert!(of_path.k_x <= straight.k_x && of_path.k_f <= straight.k_f, "{paths:?}");
                prop_assert!(of_path.sector.below <= straight.sector.below, "{paths:?}");
                prop_assert!(of_path.sector.above <= straight.sector.above, "{paths:?}");
                prop_assert!(of_path.rate >= straight.rate, "{paths:?}");
                prop_assert_eq!((of_path.x_b, of_path.e_b), (straight.x_b, straight.e_b));
                // All at once is what one at a time gives.
                prop_assert_eq!(format!("{of_path:?}"), format!("{:?}", ErrorBox::new(&problem, paths, periodic, radii)));
            }
            prop_assert_eq!(seen, Paths::choice().collect::<Vec<_>>());
        }
    }

    /// f = -x + f_1(x, e) and q with one state: polynomials of x, e, x^2, x e, e^2, x^3, x^2 e, x e^2, of which q has no cubic
    /// terms, so that what bounds its derivatives on a box are their suprema.
    struct Polynomials {
        numbers: Numbers<f64>,
        f: [f64; 8],
        q: [f64; 8],
    }

    fn value([x1, e1, xx, xe, ee, xxx, xxe, xee]: [f64; 8], x: f64, e: f64) -> f64 {
        x1 * x + e1 * e + xx * x * x + xe * x * e + ee * e * e + x * x * (xxx * x + xxe * e) + xee * x * e * e
    }

    impl Problem<f64> for Polynomials {
        fn numbers(&self) -> &Numbers<f64> {
            &self.numbers
        }
        fn bound(&self, which: Bound, x: &f64, e: &f64) -> f64 {
            let [_, f_e, f_xx, f_xe, f_ee, f_xxx, f_xxe, f_xee] = self.f.map(f64::abs);
            let [q_x, q_e, q_xx, q_xe, q_ee, ..] = self.q.map(f64::abs);
            match which {
                Bound::Fe => f_e + f_xe * x + 2.0 * f_ee * e + f_xxe * x * x + 2.0 * f_xee * x * e,
                Bound::Fxx => 2.0 * f_xx + 6.0 * f_xxx * x + 2.0 * f_xxe * e,
                Bound::Fex => f_xe + 2.0 * f_xxe * x + 2.0 * f_xee * e,
                Bound::Qx => q_x + 2.0 * q_xx * x + q_xe * e,
                Bound::Qe => q_e + q_xe * x + 2.0 * q_ee * e,
                Bound::QeMax => self.q[1] + q_xe * x + 2.0 * q_ee * e,
                _ => f64::NAN,
            }
        }
        fn given(&self, which: Bound) -> bool {
            which == Bound::QeMax
        }
        fn zero(&self) -> f64 {
            0.0
        }
    }

    impl Polynomials {
        /// By how much the split of the difference between two points fails on an error box: of q
        /// |dq - delta de| - k_x |dx| for the best delta of the sector, of f dx df + a_2 dx^2 - k_f |dx| |de|.
        fn excess(&self, error_box: &ErrorBox<f64>, [x, e]: [f64; 2], [x_p, e_p]: [f64; 2]) -> [f64; 2] {
            let (dx, de) = (x - x_p, e - e_p);
            let of = |terms| value(terms, x, e) - value(terms, x_p, e_p);
            let (df, dq) = (of(self.f) - dx, of(self.q));
            let Sector { below, above } = error_box.sector;
            let (ends, k_x) = ([-below * de, above * de], error_box.k_x);
            let (least, most) = (ends[0].min(ends[1]), ends[0].max(ends[1]));
            let of_q = (least - dq).max(dq - most).max(0.0) - k_x * dx.abs();
            [dx * df + error_box.rate * dx * dx - error_box.k_f * (dx * de).abs(), of_q]
        }
    }

    /// Differences of random polynomials between points of a box are split as each path says, by the suprema of the derivatives
    /// where it has them. Were both parts taken at the smaller places they would not be: x up to x_per for d/de and e up to e_per for
    /// d/dx.
    #[test]
    fn differences_are_split_along_every_path() {
        let mut state = 5_u64;
        let mut random = move || {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            (state >> 40) as f64 / 2f64.powi(24)
        };
        let mut of_both = [0, 0];
        for _ in 0..400 {
            let mut terms = || std::array::from_fn(|_| 4.0 * random() - 2.0);
            let (f, mut q): ([f64; 8], [f64; 8]) = (terms(), terms());
            q[5..].fill(0.0);
            // With alpha = 1 - f_1'(0) the bounds of f are about its curvature alone.
            let problem = Polynomials { numbers: numbers(1.0 - f[0]), f, q };
            let [x_per, e_per, d_x, d_e] = std::array::from_fn(|_| random());
            let boxes: Vec<(Paths, ErrorBox<f64>)> = Path::ALL
                .into_iter()
                .flat_map(|f| Path::ALL.map(|q| Paths { f, q }))
                .map(|paths| (paths, ErrorBox::new(&problem, paths, [&x_per, &e_per], [&d_x, &d_e])))
                .collect();
            let at = |f, q| &boxes.iter().find(|(paths, _)| *paths == Paths { f, q }).unwrap().1;
            let (x_first, e_first) = (at(Path::StateFirst, Path::StateFirst), at(Path::ErrorFirst, Path::ErrorFirst));
            let wrong = ErrorBox { k_f: e_first.k_f, sector: e_first.sector.clone(), ..x_first.clone() };
            for _ in 0..50 {
                // Now and then in a corner, where the bounds are met.
                let mut within = |size: f64| {
                    let share = 6.0 * random() - 3.0;
                    size * share.clamp(-1.0, 1.0)
                };
                let (x_p, e_p) = (within(x_per), within(e_per));
                let (x, e) = (x_p + within(d_x), e_p + within(d_e));
                for (paths, error_box) in &boxes {
                    let excess = problem.excess(error_box, [x, e], [x_p, e_p]);
                    assert!(excess.iter().all(|excess| *excess <= 1e-12), "{paths:?}: {excess:?} {f:?} {q:?}");
                }
                let excess = problem.excess(&wrong, [x, e], [x_p, e_p]);
                of_both.iter_mut().zip(excess).for_each(|(count, excess)| *count += i32::from(excess > 1e-9));
            }
        }
        assert!(of_both.iter().all(|count| *count > 10), "{of_both:?}");
    }
}

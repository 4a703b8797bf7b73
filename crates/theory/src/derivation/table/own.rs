//! The rows in which each derivation is evaluated at the free numbers that suit it best.

use super::{At, Entry, Row, Status, TableInput, infeasible, number, printed, row, sound};
use crate::derivation::existence::LeastSigma;
use crate::derivation::lyapunov_matrix::LyapunovMatrix;
use crate::derivation::printed::{Infeasible, PrintedEvaluation, level_condition, level_condition_infinite};
use crate::derivation::repaired::RepairedEvaluation;
use rug::Rational;
use sigmastar_exact::enclosure::Enclosure;

/// The rows in which each derivation has its own free numbers.
pub(super) fn own_rows(input: &TableInput<'_>) -> Vec<Row> {
    let TableInput { data, sharp: (w, s), repaired, printed: paper, printed_sigma, sigma_exact } = input;
    let mut rows = Vec::new();
    let mut own = |name: &str, printed: Option<Entry>, repaired: Option<Entry>, sharp: Option<Entry>| {
        rows.push(row(name, At::Own, printed, repaired, sharp));
    };
    let of_paper = |of: &dyn Fn(&PrintedEvaluation<Enclosure>) -> &Enclosure, source| {
        paper.and_then(|p| number(of(p).clone(), Status::PrintedUnsound, source))
    };
    let of_repaired = |of: &dyn Fn(&RepairedEvaluation) -> &Enclosure, source| {
        repaired.and_then(|(_, r)| sound(of(r).clone(), source))
    };
    let ours = |value: &Enclosure, source| sound(value.clone(), source);

    let level = level_condition(data).err();
    let from_level = |source| level.as_ref().and_then(|reason| infeasible(reason, source));
    own("x_a, e_a of P:eq:boundx_bounde_1", from_level("P:eq:boundx_bounde_1"), None, None);
    let [x_b, e_b] = [&s.error_box.x_b, &s.error_box.e_b].map(|value| ours(value, "section 5"));
    let label = "P:eq:temp_bound_xe2";
    own("X_b", of_paper(&|p| &p.point.x_b, label), of_repaired(&|r| &r.point.x_b, "section 5"), x_b);
    own("E_b", of_paper(&|p| &p.point.e_b, label), of_repaired(&|r| &r.point.e_b, "section 5"), e_b);
    // rho_0 as printed is sound only where it dominates the repaired form at the same arguments.
    let rho_0 = paper.and_then(|p| {
        let repaired = LyapunovMatrix::new(*data, &p.point, false);
        printed(p.lyapunov.rho_0.clone(), &repaired.rho_0, "P:eq:def_rho_0")
    });
    own("rho_0", rho_0, of_repaired(&|r| &r.lyapunov.rho_0, "section 5"), None);
    type Part = fn(&LyapunovMatrix<Enclosure>) -> &Enclosure;
    let parts: [(&str, Part); 3] = [("rho_11", |m| &m.rho_11), ("rho_12", |m| &m.rho_12), ("rho_22", |m| &m.rho_22)];
    let label = "P:eq:R-lyap2";
    for (name, part) in parts {
        own(name, of_paper(&|p| part(&p.lyapunov), label), of_repaired(&|r| part(&r.lyapunov), label), None);
    }
    own("gam", None, None, ours(&s.error_box.gamma, "section 5, C5"));
    let [h, w_x, d_x, d_e] = [&w.h, &w.w_x, &w.d_x, &w.d_e].map(|value| sound(data.rational(value), "section 5, free"));
    own("h", of_paper(&|p| &p.point.h, "P:eq:ineq_bounds_b"), of_repaired(&|r| &r.point.h, "section 5, free"), h);
    let forcing = &s.periodic.forcing;
    for (name, value) in [
        ("a_1", &s.bounds.rate),
        ("r_x", &s.squares.x),
        ("r_e", &s.squares.e),
        ("r_d", &s.squares.e_rate),
        ("R_q", &forcing.q_rms),
        ("R_1", &forcing.q_rate_rms),
    ] {
        own(name, None, None, ours(value, "section 10.3"));
    }
    own("a_2", None, None, ours(&s.error_box.rate, "section 10.1"));
    for (name, value) in [("w_x", w_x), ("D_x", d_x), ("D_e", d_e)] {
        own(name, None, None, value);
    }
    let label = "P:eq:R-lyap1";
    for (index, name) in ["first minor of R", "second minor of R", "third minor of R"].into_iter().enumerate() {
        let of_paper = paper.zip(printed_sigma.as_ref()).and_then(|(p, sigma)| {
            let minors = p.lyapunov.leading_minors(*data, sigma, &p.point.h);
            number(minors[index].clone(), Status::PrintedUnsound, label)
        });
        let of_repaired = repaired
            .and_then(|(_, r)| sound(r.lyapunov.leading_minors(*data, &r.sigma, &r.point.h)[index].clone(), label));
        own(name, of_paper, of_repaired, None);
    }
    let result = |value: &Result<Enclosure, Infeasible>, source| match value {
        Ok(value) => number(value.clone(), Status::PrintedUnsound, source),
        Err(reason) => infeasible(reason, source),
    };
    let label = "section 4, C2 and C3 with beta, K_alpha";
    let least = repaired.and_then(|(_, r)| sound(LeastSigma::repaired(*data, &r.bounds).sigma_p(), label));
    own("sigma_p*", paper.and_then(|p| result(&p.sigma_p, "P:19")), least, None);
    let (threshold, source) = s.threshold();
    own(
        "sigma_a*",
        paper.and_then(|p| result(&p.sigma_a, "P:eq:ineq_bounds_sigma")),
        of_repaired(&|r| &r.lyapunov.sigma_a, "section 5"),
        ours(threshold, source),
    );
    let claimed = |value: &Rational| sound(data.rational(value), "section 5, the set that is covered");
    let repaired_set = repaired.map(|(w, _)| &w.set);
    for (at, (name, sharp)) in w.set.named().enumerate() {
        let repaired = repaired_set.and_then(|set| set.named().nth(at)).and_then(|(_, size)| claimed(size));
        own(name, None, repaired, claimed(sharp));
    }
    own("zeta_a", of_paper(&|p| &p.zeta_a, "P:eq:boundzeta_item1"), None, None);
    own(
        "sigma*",
        from_level("P:thm1"),
        repaired.and_then(|(w, _)| sound(data.rational(&w.sigma), "section 5")),
        sound(data.rational(&w.sigma), "section 5"),
    );
    let figure = printed_sigma.clone().and_then(|value| number(value, Status::PrintedUnsound, "P:thm1"));
    own("sigma* without P:eq:boundx_bounde_1", figure, None, None);
    let exact_printed = level_condition_infinite(data).err();
    own(
        "sigma*_oo",
        exact_printed.as_ref().and_then(|reason| infeasible(reason, "P:eq:bound_sigma_inf")),
        None,
        sigma_exact.as_ref().and_then(|value| sound(data.rational(value), "section 6")),
    );
    rows
}

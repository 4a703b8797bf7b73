//! The rows in which each derivation is evaluated at the free numbers that suit it best.

use super::{At, Row, Status, TableInput, infeasible, number, printed, row, sound};
use crate::derivation::existence::LeastSigma;
use crate::derivation::lyapunov_matrix::LyapunovMatrix;
use crate::derivation::printed::{Infeasible, PrintedEvaluation, level_condition, level_condition_infinite};
use crate::derivation::repaired::RepairedEvaluation;
use crate::derivation::sharp::SharpEvaluation;
use rug::Rational;
use sigmastar_exact::enclosure::Enclosure;

/// The rows in which each derivation has its own free numbers.
pub(super) fn own_rows(input: &TableInput<'_>) -> Vec<Row> {
    let data = input.data;
    let mut rows = Vec::new();
    let level = level_condition(data).err();
    let from_level = |source| level.as_ref().and_then(|reason| infeasible(reason, source));
    rows.push(row("x_a, e_a of P:eq:boundx_bounde_1", At::Own, from_level("P:eq:boundx_bounde_1"), None, None));
    let sharp_value =
        |of: &dyn Fn(&SharpEvaluation) -> Enclosure, source| input.sharp.and_then(|sharp| sound(of(sharp), source));
    let paper_value = |of: &dyn Fn(&PrintedEvaluation<Enclosure>) -> Enclosure, source| {
        input.printed.and_then(|p| number(of(p), Status::PrintedUnsound, source))
    };
    let repaired_value =
        |of: &dyn Fn(&RepairedEvaluation) -> Enclosure, source| input.repaired.and_then(|r| sound(of(r), source));
    let sharp_free =
        |index: usize| input.sharp_free.as_ref().and_then(|free| sound(data.rational(&free[index]), "section 5, free"));
    rows.push(row(
        "X_b",
        At::Own,
        paper_value(&|p| p.point.x_b.clone(), "P:eq:temp_bound_xe2"),
        repaired_value(&|r| r.point.x_b.clone(), "section 5"),
        sharp_value(&|s| s.error_box.x_b.clone(), "section 5"),
    ));
    rows.push(row(
        "E_b",
        At::Own,
        paper_value(&|p| p.point.e_b.clone(), "P:eq:temp_bound_xe2"),
        repaired_value(&|r| r.point.e_b.clone(), "section 5"),
        sharp_value(&|s| s.error_box.e_b.clone(), "section 5"),
    ));
    // rho_0 as printed is sound only where it dominates the repaired form at the same arguments.
    let rho_0 = input.printed.and_then(|p| {
        let repaired = LyapunovMatrix::new(data, &p.point, false);
        printed(p.lyapunov.rho_0.clone(), &repaired.rho_0, "P:eq:def_rho_0")
    });
    rows.push(row("rho_0", At::Own, rho_0, repaired_value(&|r| r.lyapunov.rho_0.clone(), "section 5"), None));
    let label = "P:eq:R-lyap2";
    rows.push(row(
        "rho_11",
        At::Own,
        paper_value(&|p| p.lyapunov.rho_11.clone(), label),
        repaired_value(&|r| r.lyapunov.rho_11.clone(), label),
        None,
    ));
    rows.push(row(
        "rho_12",
        At::Own,
        paper_value(&|p| p.lyapunov.rho_12.clone(), label),
        repaired_value(&|r| r.lyapunov.rho_12.clone(), label),
        None,
    ));
    rows.push(row(
        "rho_22",
        At::Own,
        paper_value(&|p| p.lyapunov.rho_22.clone(), label),
        repaired_value(&|r| r.lyapunov.rho_22.clone(), label),
        None,
    ));
    rows.push(row("gam", At::Own, None, None, sharp_value(&|s| s.error_box.gamma.clone(), "section 5, C5")));
    rows.push(row(
        "h",
        At::Own,
        paper_value(&|p| p.point.h.clone(), "P:eq:ineq_bounds_b"),
        repaired_value(&|r| r.point.h.clone(), "section 5, free"),
        sharp_free(0),
    ));
    let from_existence = |of: &dyn Fn(&SharpEvaluation) -> Enclosure| sharp_value(of, "section 10.3");
    rows.push(row("a_1", At::Own, None, None, from_existence(&|s| s.bounds.rate.clone())));
    rows.push(row("r_x", At::Own, None, None, from_existence(&|s| s.squares.x.clone())));
    rows.push(row("r_e", At::Own, None, None, from_existence(&|s| s.squares.e.clone())));
    rows.push(row("r_d", At::Own, None, None, from_existence(&|s| s.squares.e_rate.clone())));
    rows.push(row("R_q", At::Own, None, None, from_existence(&|s| s.periodic.forcing.q_rms.clone())));
    rows.push(row("R_1", At::Own, None, None, from_existence(&|s| s.periodic.forcing.q_rate_rms.clone())));
    rows.push(row("a_2", At::Own, None, None, sharp_value(&|s| s.error_box.rate.clone(), "section 10.1")));
    rows.push(row("w_x", At::Own, None, None, sharp_free(1)));
    rows.push(row("D_x", At::Own, None, None, sharp_free(2)));
    rows.push(row("D_e", At::Own, None, None, sharp_free(3)));
    for index in 0..3 {
        let name = ["first minor of R", "second minor of R", "third minor of R"][index];
        rows.push(row(
            name,
            At::Own,
            input.printed.zip(input.sigmas[0].as_ref()).and_then(|(p, sigma)| {
                let minors = p.lyapunov.leading_minors(data, sigma, &p.point.h);
                number(minors[index].clone(), Status::PrintedUnsound, "P:eq:R-lyap1")
            }),
            input.repaired.and_then(|r| {
                sound(r.lyapunov.leading_minors(data, &r.sigma, &r.point.h)[index].clone(), "P:eq:R-lyap1")
            }),
            None,
        ));
    }
    let result = |value: &Result<Enclosure, Infeasible>, source| match value {
        Ok(value) => number(value.clone(), Status::PrintedUnsound, source),
        Err(reason) => infeasible(reason, source),
    };
    rows.push(row(
        "sigma_p*",
        At::Own,
        input.printed.and_then(|p| result(&p.sigma_p, "P:19")),
        repaired_value(&|r| LeastSigma::repaired(data, &r.bounds).sigma_p(), "section 4, C2 and C3 with beta, K_alpha"),
        None,
    ));
    rows.push(row(
        "sigma_a*",
        At::Own,
        input.printed.and_then(|p| result(&p.sigma_a, "P:eq:ineq_bounds_sigma")),
        repaired_value(&|r| r.lyapunov.sigma_a.clone(), "section 5"),
        sharp_value(&|s| s.decay.sigma_threshold.clone(), "section 5, C5"),
    ));
    for (index, name) in ["X0", "E0", "Z0"].into_iter().enumerate() {
        let claimed = |set: &Option<[Rational; 3]>| {
            set.as_ref().and_then(|set| sound(data.rational(&set[index]), "section 5, the set that is covered"))
        };
        rows.push(row(name, At::Own, None, claimed(&input.sets[0]), claimed(&input.sets[1])));
    }
    rows.push(row("zeta_a", At::Own, paper_value(&|p| p.zeta_a.clone(), "P:eq:boundzeta_item1"), None, None));
    let [figure, repaired, sharp] = input.sigmas.clone();
    let printed_sigma = from_level("P:thm1");
    rows.push(row(
        "sigma*",
        At::Own,
        printed_sigma,
        repaired.and_then(|value| sound(value, "section 5")),
        sharp.and_then(|value| sound(value, "section 5")),
    ));
    rows.push(row(
        "sigma* without P:eq:boundx_bounde_1",
        At::Own,
        figure.and_then(|value| number(value, Status::PrintedUnsound, "P:thm1")),
        None,
        None,
    ));
    let exact_printed = level_condition_infinite(data).err();
    rows.push(row(
        "sigma*_oo",
        At::Own,
        exact_printed.as_ref().and_then(|reason| infeasible(reason, "P:eq:bound_sigma_inf")),
        None,
        input.sigma_exact.as_ref().and_then(|value| sound(data.rational(value), "section 6")),
    ));
    rows
}

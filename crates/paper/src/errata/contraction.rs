//! E5: the second Jury condition.

use super::evidence::Evidence;
use super::evidence::Relation::{Greater, Less};
use super::numbers::ratio;
use super::{Bearing, Class, Erratum, ForData};
use rug::Rational;
use sigmastar_theory::data::{Bound, Data, Problem};

/// E5: `1 > -det` where `1 > det` is meant.
pub(super) fn e5(data: Option<&Data<'_>>) -> Erratum {
    // [[2, 1/10], [1/10, 2]]
    let (diagonal, other) = (Rational::from(2), ratio(1, 10));
    let trace = Rational::from(&diagonal * 2);
    let determinant = Rational::from(diagonal.square_ref()) - Rational::from(other.square_ref());
    // K_alpha/alpha = 1, b_fe = 1, b_qx = 0, b_fex e_p + 2 b_fxx x_p = 1/2, b_qe = 1: alpha/(K_alpha(b_fe b_qx - [..] b_qe)).
    let bracket = ratio(1, 2);
    let third_line = Rational::from(-&bracket).recip();
    let evidence = vec![
        Evidence::rigorous(
            "$`[[2, 0.1], [0.1, 2]]`$ passes the first condition: $`1 - tr + det`$",
            (Rational::from(1) - trace + &determinant, Greater, 0),
        ),
        Evidence::rigorous(
            "and the printed second one, $`1 > -det`$: $`-det`$",
            (Rational::from(-&determinant), Less, 1),
        ),
        Evidence::rigorous("which should have read $`1 > det`$: $`det`$", (determinant, Greater, 1)),
        Evidence::rigorous("its rows sum to its spectral radius", (Rational::from(&diagonal + &other), Greater, 1)),
        Evidence::rigorous(
            "$`K_alpha/alpha = b_fe = b_qe = 1`$, $`b_qx = 0`$, $`b_fex e_p + 2 b_fxx x_p = 1/2`$: the right side of the third line of \
             (19), to exceed $`beta > 0`$, is negative",
            (third_line, Less, 0),
        ),
        Evidence::rigorous(
            "although the matrix $`[[1/2, 1], [0, beta]]`$ is a contraction for every $`beta < 1`$; its largest diagonal entry at \
             $`beta = 1/2`$",
            (bracket, Less, 1),
        ),
    ];
    Erratum {
        id: "E5",
        place: "P:eq:ypsilon_xx, P:15, third line of P:19",
        class: Class::A,
        printed: "$`1 > (K_alpha beta/alpha)(b_fe b_qx - [b_fex e_p + 2 b_fxx x_p] b_qe)`$, that is $`1 > -det`$",
        instead: "$`1 > det`$ (the two lines displayed before are right). Where $`x_p`$, $`e_p`$ are chosen as in the proof the entry xx is \
                  below 1 and the first condition alone suffices; the slip then only refuses valid data",
        evidence,
        for_data: data.map(for_data),
    }
}

fn for_data(data: &Data<'_>) -> ForData {
    let zero = data.zero();
    let [f_e, q_x, q_e] = [Bound::Fe, Bound::Qx, Bound::Qe].map(|bound| data.bound(bound, &zero, &zero));
    let product = f_e * q_x;
    let (bearing, summary) = if product.is_positive().is_true() {
        (
            Bearing::Harmless,
            "for small $`x_p`$, $`e_p`$ the printed right side is positive; with $`x_p`$, $`e_p`$ chosen as in the proof its conditions are \
             sound",
        )
    } else {
        (
            Bearing::Depends,
            "$`b_fe b_qx`$ vanishes at 0, so the printed right side can be negative or undefined: then no $`sigma`$ satisfies it",
        )
    };
    ForData::new(bearing, summary).figure("$`b_fe(0,0) b_qx(0,0)`$", product).figure("$`b_qe(0,0)`$", q_e)
}

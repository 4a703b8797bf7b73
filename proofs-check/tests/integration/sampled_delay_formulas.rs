//! The formulas of a law with a delay (docs/mathematics.md, section 13.4), in floating point beside the checker's.

use super::sampled_formulas::{AT, Float, NBAR_SQUARED, close, existence_at, laws, rational, with_law};
use proofs_check::rules::paths::{Path, Paths};
use proofs_check::rules::sampled::gains::Gains;
use proofs_check::rules::sampled::stability;
use proofs_check::rules::stability::ErrorBox;
use std::f64::consts::PI;

/// Section 13.4, with and without a gain: the laws above that have room for a delay.
fn delayed_laws() -> Vec<Float> {
    let apart = |float: &Float| (1.0 - float.ends[0]).max(float.ends[1] - 1.0);
    let room = |float: &Float| 1.0 - 3.0 * float.ends[1] * float.loss() - apart(float);
    let laws: Vec<Float> = laws().into_iter().filter(|float| room(float) > 1e-3).collect();
    assert!(laws.len() > 60 && laws.iter().any(|float| float.ends != [1.0; 2]));
    laws.into_iter().map(|float| Float { delayed: true, ..float }).collect()
}

#[test]
fn parts_of_existence_with_a_delay() {
    for float in delayed_laws() {
        with_law(&float, |law| {
            let found = existence_at(law);
            let (t, h, sigma, [low, high]) = (float.period, float.h, float.sigma, float.ends);
            let apart = (1.0 - low).max(high - 1.0);
            // 1 + th1, and |y_j| over |q_j| harmonic by harmonic.
            let enlarged = 1.0 / (1.0 - 3.0 * high * float.loss());
            let of_y = |j: u32| 1.0 / (1.0 / enlarged - apart * sigma / float.size(j)[0]);
            let ahead = 1.0 + h * sigma;
            let sum = |term: &dyn Fn(u32) -> f64| (1..float.samples).map(term).sum::<f64>().sqrt();
            let of_e = |j: u32| of_y(j) / float.size(j)[0];
            let gains = Gains::new(law);
            close("bt", &gains.sup, ahead * sum(&|j| of_e(j).powi(2)), &float);
            close("tau", &gains.sup_t, ahead * sum(&|j| (of_e(j) / float.frequency(j)).powi(2)), &float);
            close("rms", &gains.rms, ahead * float.most(of_e), &float);
            close("rms_t", &gains.rms_t, ahead * float.most(|j| of_e(j) / float.frequency(j)), &float);
            let slope = match low < high {
                true => float.most(|j| of_e(j) * float.frequency(j)),
                false => 2.0 / (2.0 - h * sigma) * enlarged,
            };
            close("slope", &gains.slope, ahead * slope, &float);
            close("of_y", &gains.of_y, float.most(of_y), &float);
            let [x_p, e_p] = AT;
            let (f_e, f_x) = (x_p + 0.189, 2.302 + 0.112 * x_p + 0.2237 * x_p);
            let (q_x, q_e) = (0.3 + 0.5 * x_p + 0.7 * e_p, 0.5 + 2.0 * x_p + 3.0 * e_p);
            let r_q = (4.822 + x_p + (e_p * f_e).atan()).min(4.822 + q_x * 0.125 + q_e * 0.25);
            let r_1 = 24.18 + 2.106 * e_p + q_x * (f_x * 0.125 + f_e * 0.25) + q_e * 2.0;
            let shifted = 1.0 + apart * sigma * float.most(of_e);
            let raised = |b: f64| 1.0 / (2.0 * b * float.gain * (1.0 - 2.0 * b * float.loss()));
            let raised = raised(low).max(raised(high)) * shifted * shifted;
            let swing = t * (raised + h * NBAR_SQUARED * float.most(of_y).powi(2)) * r_q * r_q;
            let w = float.w();
            let mean = (enlarged * shifted).powi(2) * (20.0 / w.powi(2) * r_q * r_q + 60.0 / w.powi(4) * r_1 * r_1);
            let z = (swing + mean).sqrt();
            close("Z", &found.z, z, &float);
            let by_rate = ((t * t - h * h) / 12.0).sqrt() * r_1;
            let y_per = float.most(of_y) * by_rate.min(f64::from(float.samples).sqrt() * r_q);
            close("y_per", &found.largest_y, y_per, &float);
            let factor = (1.0 + 2.0 / (2.0 - h * sigma) * ahead * float.most(of_y)) / low;
            let predicted =
                (sum(&|j| of_e(j).powi(2)) * r_q).min(sum(&|j| (of_e(j) / float.frequency(j)).powi(2)) * r_1);
            let by_parts = sigma * predicted + float.gain * NBAR_SQUARED.sqrt() * z;
            close("steady", &found.steady, (r_q / low + factor * by_rate).min(by_parts), &float);
        });
    }
}

#[test]
fn parts_of_stability_with_a_delay() {
    let (x_per, e_per, d_x, d_e, w_x, eta, gm) = (0.01, 0.02, 0.04, 0.08, 3.0, 0.7, 0.3);
    let (x_b, e_b) = (x_per + d_x, e_per + d_e);
    for float in delayed_laws() {
        with_law(&float, |law| {
            let number = |value: f64| law.d.number(&rational(value));
            let [x_p, e_p, far_x, far_e] = [x_per, e_per, d_x, d_e].map(number);
            let paths = Paths { f: Path::StateFirst, q: Path::StateFirst };
            let error_box = ErrorBox::new(law.d, paths, [&x_p, &e_p], [&far_x, &far_e]);
            let (w, zeta, past) = (number(w_x), number(eta), number(gm));
            let found = stability::conditions(law, &error_box, [&w, &zeta], Some(&past));
            assert_eq!(found.len(), 9);
            let c = 1.5512_f64.sqrt();
            let rate = 0.58 - c * (0.2237 * x_per + e_per + 0.2237 * d_x / 2.0);
            let (k_x, k_l, m) = (0.3 + 0.5 * x_b + 0.7 * e_per, 0.5 + 2.0 * x_b + 3.0 * e_b, 0.1 + x_b + e_b);
            let (h, k_e, s, hs) = (float.h, k_l, eta / float.gain, float.h * float.sigma);
            let apart = (1.0 - float.ends[0]).max(float.ends[1] - 1.0);
            let room = 1.0 - h * k_e / PI;
            let coupling = w_x * c * (x_b + 0.189);
            for (t, at_end, first) in [(0.0, 0.0, 1), (h, 1.0, 5)] {
                let ts = t * float.sigma;
                let drift = t * k_e / (PI * room);
                let (c_x, c_e, c_y) =
                    (t * k_x / (PI * room), (1.0 - ts + ts * ts / 3.0).sqrt() + drift, t / (3.0_f64.sqrt() * room));
                let g = t * k_e / 12.0_f64.sqrt() / room;
                let p_y = t * t * k_e * k_e / (6.0 * room);
                let side = |b: f64, slope: f64| 1.0 - ts + s * ((1.0 - ts / 2.0) * slope + (1.0 - b) * float.sigma);
                let d_t = float.gains().flat_map(|b| [m, -k_l].map(|slope| side(b, slope).abs())).fold(0.0, f64::max);
                let load = float.ends[1] * float.loss();
                let (xx, xe) = (2.0 * w_x * rate - 2.0 * coupling * c_x, -coupling * c_e);
                let xy = -coupling * c_y - s * k_x * (1.0 + g);
                let (ee, ey) = (float.sigma * (2.0 - ts), -d_t - s * g * k_e);
                let yy = 2.0 * s * (1.0 - at_end * load) - t - s * t * m - 2.0 * s * p_y - gm;
                let (xp, ep) = (-coupling * c_y * hs, -(1.0 - ts).abs() * hs);
                let yp = -t * hs - s * t * k_e * hs / 2.0 - s * p_y * hs - 2.0 * s * load - s * apart * hs;
                let pp = gm - t * hs * hs;
                let mut rows = [[xx, xe, xy, xp], [xe, ee, ey, ep], [xy, ey, yy, yp], [xp, ep, yp, pp]];
                let size: Vec<f64> = (0..4).map(|i| rows[i].iter().map(|v| v.abs()).sum()).collect();
                let (mut minor, mut scale) = (1.0, 1.0);
                for i in 0..4 {
                    minor *= rows[i][i];
                    scale *= size[i];
                    let [lo, hi] = [found[first + i].rhs.lo(), found[first + i].rhs.hi()].map(|end| end.to_f64());
                    let near = (lo - minor).abs() + (hi - minor).abs() <= 1e-8 * scale;
                    assert!(near, "minor {} at t = {t}: [{lo}, {hi}], not {minor}: {float:?}", i + 1);
                    for k in i + 1..4 {
                        let factor = rows[k][i] / rows[i][i];
                        (i..4).for_each(|j| rows[k][j] -= factor * rows[i][j]);
                    }
                }
            }
        });
    }
}

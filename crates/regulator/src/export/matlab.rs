//! The regulator as a script for MATLAB and Octave.

use super::notice::comment;
use super::{Export, decimal, notice, numbers, sampled_law};

/// A script that sets `sigma`, `mu`, `nominal` (the gain of the actuator, where there is one), `actuator_max`
/// (what it takes, where that is stated), `frequencies`, `weights`, `Phi`, `Gamma`, `M`, `N`, `z_start` (z at the first instant, of e
/// there) and, with a discretisation, `step`, `K`, `weight_sum`, `decay`, `spectral_radius` (of the sampled loop on e' = u), `Phi_d`, `Gamma_d`, `C_d`, `D_d`, and
/// `saturation` where u is clipped; with a delay `delay_samples` and `prediction` (h sigma), and the matrices are those of (z, s). It uses base functions only and runs in MATLAB and in Octave.
#[must_use]
pub fn matlab(export: &Export<'_>) -> String {
    let regulator = export.regulator;
    let row = |values: &[f64]| values.iter().map(|value| decimal(*value)).collect::<Vec<_>>().join(", ");
    let mut script = format!("% Regulator for: {}\n", export.name);
    script.push_str(&comment(&notice(export), "% "));
    script.push_str(match regulator.nominal {
        None => "% z' = Phi*z + Gamma*e, u = -sigma*e + mu*M'*N*(z - M*e)\n",
        Some(_) => "% z' = Phi*z + Gamma*e, u = (-sigma*e + mu*M'*N*(z - M*e))/nominal\n",
    });
    script.push_str(&format!("sigma = {};\n", decimal(regulator.sigma)));
    script.push_str(&format!("mu = {};\n", decimal(regulator.mu)));
    if let Some(nominal) = regulator.nominal {
        script.push_str(&format!("nominal = {};\n", decimal(nominal)));
    }
    if let Some(actuator) = export.actuator {
        script.push_str(&format!("actuator_max = {};\n", decimal(actuator.limit())));
    }
    if let Some(middle) = export.middle {
        script.push_str(&format!("middle = {}; % added to u before it is put out\n", decimal(middle)));
    }
    script.push_str(&format!("frequencies = [{}];\n", row(&regulator.frequencies)));
    script.push_str(&format!("weights = [{}];\n", row(&regulator.weights)));
    let dimension = regulator.dimension();
    script.push_str(&format!("Phi = zeros({dimension});\n"));
    for at in 0..regulator.frequencies.len() {
        // Indices start at 1: the block of l = at + 1 has rows 2 at + 2 and 2 at + 3.
        let (first, second, l) = (2 * at + 2, 2 * at + 3, at + 1);
        script.push_str(&format!("Phi({first}, {second}) = frequencies({l});\n"));
        script.push_str(&format!("Phi({second}, {first}) = -frequencies({l});\n"));
    }
    script.push_str(&format!("M = [{}]';\n", row(&regulator.m())));
    script.push_str(&format!("N = diag([{}]);\n", row(&regulator.n_diagonal())));
    script.push_str(&format!("Gamma = -(Phi + sigma*eye({dimension}))*M;\n"));
    let start = if export.aligned { "M*e" } else { "0*M" };
    script.push_str(&format!("z_start = @(e) {start};\n"));
    if let Some((discrete, sampled)) = export.discrete {
        let law = sampled_law(discrete.prediction.is_some(), regulator.nominal.is_some());
        script.push_str(&match discrete.prediction {
            None => format!(
                "% At samples, with Phi for Phi_d: {law},\n\
                 % which is z_next = Phi_d*z + Gamma_d*e, u = C_d*z + D_d*e (u is held over the sample)\n"
            ),
            Some(_) => format!(
                "% At samples, with R = Phi_d(1:end-1, 1:end-1): {law},\n\
                 % which is x_next = Phi_d*x + Gamma_d*e, u_next = C_d*x + D_d*e for x = [z; s] (u_next is put out at the next sample)\n\
                 delay_samples = 1;\n"
            ),
        });
        script.push_str(&format!("% In floating point, {sampled}\n"));
        let further = discrete.prediction.map(|product| ("prediction", product));
        let further = further.into_iter().chain(discrete.saturation.map(|limit| ("saturation", limit)));
        for (name, value) in numbers(discrete).into_iter().chain(further) {
            script.push_str(&format!("{name} = {};\n", decimal(value)));
        }
        script.push_str(&format!("spectral_radius = {};\n", decimal(sampled.spectral_radius())));
        script.push_str(&format!("Phi_d = eye({});\n", discrete.dimension()));
        for (at, [cosine, sine]) in discrete.rotations.iter().enumerate() {
            let (first, second) = (2 * at + 2, 2 * at + 3);
            let (cosine, sine) = (decimal(*cosine), decimal(*sine));
            script.push_str(&format!(
                "Phi_d({first}:{second}, {first}:{second}) = [{cosine}, {sine}; -({sine}), {cosine}];\n"
            ));
        }
        if let Some(product) = discrete.prediction {
            script.push_str(&format!("Phi_d(1:{dimension}, {}) = M;\n", discrete.dimension()));
            script.push_str(&format!("Phi_d({0}, {0}) = {1};\n", discrete.dimension(), decimal(-product)));
        }
        script.push_str(&format!("Gamma_d = [{}]';\n", row(&discrete.input)));
        script.push_str(&format!("C_d = [{}];\n", row(&discrete.output)));
    }
    script
}

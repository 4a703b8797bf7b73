//! What the data themselves are to be looked at for; no verdict depends on it.

use crate::certify::{Certification, DigitalCertification, ExceededBy, NoPlant};

/// One sentence or two for each.
pub(crate) fn remarks(run: &Certification<'_>) -> Vec<String> {
    of(run.no_plant.as_ref(), run.has_force_at_origin())
}

/// The same of a run about the regulator at samples.
pub(crate) fn digital_remarks(run: &DigitalCertification<'_>) -> Vec<String> {
    of(run.no_plant.as_ref(), run.has_force_at_origin())
}

fn of(no_plant: Option<&NoPlant>, force_at_origin: bool) -> Vec<String> {
    let mut remarks = Vec::new();
    if let Some(reason) = no_plant {
        let check = match reason.exceeded_by {
            ExceededBy::Alpha { .. } => "f, f_xx, their domain, alpha, and the unit of time in each",
            ExceededBy::Rate { .. } => "f, f_xx, their domain, rate, and the unit of time in each",
            ExceededBy::Jacobian { .. } => "f, f_xx, their domain, the Jacobian, and the unit of time in each",
        };
        remarks.push(format!("Remark: {reason}. What is proved of all such plants is proved of none. Check {check}."));
    }
    if force_at_origin {
        remarks.push(
            "Remark: f(0,0) > 0, although |f(t,0,0)| = 0 for every plant of the family. Were the bounds taken before the \
             shift by x_0(t), the periodic solution of x' = f(t,x,0)? They are to hold after it (erratum E18; the guide)."
                .to_owned(),
        );
    }
    remarks
}

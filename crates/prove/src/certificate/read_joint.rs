//! Reading the joint inequalities of a certificate of a plant. What is read is taken as it is: nothing of it is proved here.

use super::fields::{NumberFields, rational};
use super::read::{matrix, vector};
use rug::Rational;
use sigmastar_lang::spec::{Errors, JointInequality, JointStability, Level, Metric, Object, Reported, Value};

/// The joint form of `existence_inequality`, for so many states.
pub(super) fn read_joint(value: &Value<'_>, n: usize, errors: &mut Errors) -> Result<JointInequality, Reported> {
    let (inequality, _) = read(value, n, errors, |_, _| Ok(()))?;
    Ok(inequality)
}

/// `joint_inequality`, for so many states.
pub(super) fn read_joint_stability(
    value: &Value<'_>,
    n: usize,
    errors: &mut Errors,
) -> Result<JointStability, Reported> {
    let of_level = |fields: &mut Object<'_>, errors: &mut Errors| Level::read(fields, errors, |_, _| Ok(()));
    let (inequality, levels) = read(value, n, errors, of_level)?;
    Ok(JointStability { inequality, levels })
}

/// An inequality, and what `more` reads of its near and its far metric.
fn read<T>(
    value: &Value<'_>,
    n: usize,
    errors: &mut Errors,
    more: impl Fn(&mut Object<'_>, &mut Errors) -> Result<T, Reported>,
) -> Result<(JointInequality, [T; 2]), Reported> {
    let mut fields = value.object(errors)?;
    let [x, e, value] = ["X", "E", "sigma"].map(|name| rational(&mut fields, name, errors));
    let mut metric = |name: &'static str, is_near: bool, errors: &mut Errors| {
        let value = fields.required(name, errors)?;
        let mut fields = value.object(errors)?;
        let metric = Metric::read(&mut fields, errors, |fields, errors| {
            let matrix = matrix(fields, "P", errors);
            let cross = match is_near {
                true => fields.required("p", errors).and_then(|value| vector(&value, n, errors)),
                false => Ok(vec![Rational::new(); n]),
            };
            Ok((matrix?, cross?))
        });
        let more = more(&mut fields, errors);
        fields.finish(errors);
        Ok((metric?, more?))
    };
    let (near, far) = (metric("near", true, errors), metric("far", false, errors));
    fields.finish(errors);
    let ((near, of_near), (far, of_far)) = (near?, far?);
    Ok((JointInequality { x: x?, e: e?, value: value?, near, far }, [of_near, of_far]))
}

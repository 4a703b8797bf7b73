//! The specification that a plant's formulas amount to: the data of sections 1 and 10, in the coordinates y of section 11.

use super::refusal::PlantRefusal;
use crate::certify::{covers_ball, inverse_norm, within_ball};
use nalgebra::DMatrix;
use rug::Rational;
use sigmastar_exact::enclosure::Enclosure;
use sigmastar_exact::number::{Direction, round_f64, round_rational};
use sigmastar_lang::plant::Plant;
use sigmastar_lang::spec::model::{Constant, Domain, InitialSet, KnownForcing, LyapunovSource, Specification};
use sigmastar_lang::spec::{Bounds, OfPlant, Parameters, ProvedForcing, ProvedValues};

/// Significant digits of the X_0 that covers a ball, and of a domain in the norm of y.
const DIGITS: u32 = 10;

/// Significant digits of the sizes of harmonics: of which nothing is written, so that they may be long.
const LONG_DIGITS: u32 = 30;

/// Room for rounding in the norms of L and L^-1, which doubles know: the first that is proved to be enough is taken.
const ROOMS: [f64; 4] = [1e-9, 1e-6, 1e-3, 0.1];

/// Bits at which the sizes of harmonics are enclosed.
const PRECISION: u32 = 128;

/// The specification of a plant, with what was proved of it; with other values nothing is proved.
///
/// # Errors
/// [`PlantRefusal::Coordinates`] where L is so ill-conditioned that a ball or a domain cannot be turned into its norm,
/// [`PlantRefusal::Forcing`] where a harmonic of q has no finite enclosure.
pub fn specification(plant: &Plant, of_plant: OfPlant, values: ProvedValues) -> Result<Specification, PlantRefusal> {
    let q_0 = known_forcing(of_plant.cells.iter().map(|cell| (&cell.forcing, &cell.parameters)));
    let q_0 = q_0.ok_or(PlantRefusal::Forcing)?;
    let domain = match &plant.domain {
        Some(domain) => Some(in_coordinates(domain, &of_plant.coordinates).ok_or(PlantRefusal::Coordinates)?),
        None => None,
    };
    let initial_set = initial_set(plant, &of_plant.coordinates).ok_or(PlantRefusal::Coordinates)?;
    Ok(Specification {
        name: plant.name.clone(),
        description: plant.description.clone(),
        period: plant.period.clone(),
        lyapunov: LyapunovSource::Plant(Box::new(of_plant)),
        bounds: Bounds::proved(values),
        q_0: Some(q_0),
        domain,
        internal_model: plant.internal_model.clone(),
        initial_set,
        input_gain: plant.input_gain.clone(),
        actuator: plant.actuator.clone(),
        disturbances: plant.disturbances.clone(),
        relative_degree: None,
        document: plant.document.clone(),
        sha256: plant.sha256.clone(),
        source: plant.source.clone(),
        pointer: plant.pointer.clone(),
    })
}

/// C_0 = |m_0|, C_k = sqrt(a_k^2 + b_k^2)/2 rounded up, r_0 and r_1; of a family the largest of all corners, which bound those of
/// every member: c_k is affine in the parameters, and a magnitude convex; of cells the largest of all. `None` where a C_k leaves the range of
/// exponents.
fn known_forcing<'c>(cells: impl Iterator<Item = (&'c ProvedForcing, &'c Parameters)> + Clone) -> Option<KnownForcing> {
    let size = |[a, b]: &[Rational; 2]| {
        let squares = Rational::from(a * a) + Rational::from(b * b);
        let size = Enclosure::from_rational(&(squares / 4u32), PRECISION).sqrt();
        size.upper_rational().map(|upper| round_rational(&upper, LONG_DIGITS, Direction::Up))
    };
    let mut largest: Vec<Rational> = Vec::new();
    let members = cells.clone().flat_map(|(forcing, parameters)| {
        let deviations = |member: &Vec<Rational>| parameters.deviations(member);
        parameters.looked_at().iter().map(deviations).map(|deviations| forcing.at(&deviations)).collect::<Vec<_>>()
    });
    for wave in members {
        let mean = Some(Rational::from(wave.mean.abs_ref()));
        let sizes: Vec<Rational> =
            std::iter::once(mean).chain(wave.harmonics.iter().map(size)).collect::<Option<_>>()?;
        largest.resize(sizes.len().max(largest.len()), Rational::new());
        for (largest, size) in largest.iter_mut().zip(sizes) {
            if size > *largest {
                *largest = size;
            }
        }
    }
    let rest = |of: fn(&ProvedForcing) -> &Rational| {
        cells.clone().map(|(forcing, _)| of(forcing)).max().map(Constant::rational)
    };
    Some(KnownForcing {
        harmonics: largest.iter().map(Constant::rational).collect(),
        rest_rms: rest(|forcing| &forcing.rest)?,
        rest_t_rms: Some(rest(|forcing| &forcing.rest_t)?),
    })
}

/// X with `|L^-1 (x - x_0)| <= X` inside of `|x - x_0| <= d_x`, proved, and E; `None` where rounding prevents it.
fn in_coordinates(domain: &Domain, coordinates: &[Vec<Rational>]) -> Option<Domain> {
    let distance = domain.x.enclose(PRECISION).lower_rational()?;
    let n = coordinates.len();
    let norm = if n == 0 { 1.0 } else { matrix(coordinates).singular_values().max() };
    let x = ROOMS.into_iter().find_map(|room| {
        let x = round_f64(distance.to_f64() / norm * (1.0 - room), DIGITS, Direction::Down)?;
        (x > 0 && within_ball(coordinates, &x, &distance)).then_some(x)
    })?;
    Some(Domain { x: Constant::rational(&x), e: domain.e.clone() })
}

/// The set that is asked for; where a ball is, with an X_0 that is proved to cover it.
fn initial_set(plant: &Plant, coordinates: &[Vec<Rational>]) -> Option<InitialSet> {
    let Some(ball) = &plant.ball else { return Some(plant.initial_set.clone()) };
    let radius = ball.enclose(PRECISION).upper_rational()?;
    let covering = if radius == 0 {
        radius
    } else {
        let size = radius.to_f64() * inverse_norm(coordinates);
        ROOMS.into_iter().find_map(|room| {
            let x_0 = round_f64(size * (1.0 + room), DIGITS, Direction::Up)?;
            covers_ball(coordinates, &x_0, &radius).then_some(x_0)
        })?
    };
    Some(plant.initial_set.clone().with_x0(Constant::rational(&covering)))
}

fn matrix(rows: &[Vec<Rational>]) -> DMatrix<f64> {
    DMatrix::from_fn(rows.len(), rows.len(), |i, j| rows[i][j].to_f64())
}

#[cfg(test)]
mod tests {
    use super::*;
    use sigmastar_lang::spec::Wave;

    #[test]
    fn harmonics_are_rounded_up_and_none_is_left_out() {
        let forcing = |a: Rational| ProvedForcing {
            mean: Rational::from(-3),
            harmonics: vec![[Rational::from((3, 5)), Rational::from((-4, 5))], [a, Rational::new()]],
            sensitivities: Vec::new(),
            rest: Rational::from((1, 8)),
            rest_t: Rational::from(2),
        };
        let known = known_forcing([(&forcing(Rational::from((1, 3))), &Parameters::default())].into_iter()).unwrap();
        let sizes: Vec<&Rational> = known.harmonics.iter().map(|size| size.as_rational().unwrap()).collect();
        assert_eq!(sizes[..2], [&Rational::from(3), &Rational::from((1, 2))]);
        assert!(*sizes[2] > Rational::from((1, 6)) && *sizes[2] < Rational::from((1_000_001, 6_000_000)));
        assert_eq!(known.rest_rms.as_rational(), Some(&Rational::from((1, 8))));
        assert_eq!(known.rest_t_rms.unwrap().as_rational(), Some(&Rational::from(2)));
        // c_1(p) = (3 - 4 i)/10 + p (1 - i)/2 with p in [-1, 2]: the largest |c_1|^2 is 3.65, at p = 2, and of the mean -3 + p at -1.
        let text = include_str!("../../../../specs/plants/linear.json").replacen(
            "\"states\"",
            r#""parameters": { "p": { "nominal": 0, "low": -1, "high": 2 } }, "states""#,
            1,
        );
        let plant = Plant::from_json("family", &text).unwrap();
        let part = Wave { mean: Rational::from(1), harmonics: vec![[Rational::from(1), Rational::from(-1)]] };
        let moved = ProvedForcing { sensitivities: vec![part], ..forcing(Rational::new()) };
        let known = known_forcing([(&moved, &plant.parameters)].into_iter()).unwrap();
        let [mean, first] = [0, 1].map(|k| known.harmonics[k].as_rational().unwrap());
        let (square, exact) = (Rational::from(first * first), Rational::from((365, 100)));
        assert!(*mean == 4 && square >= exact && square < exact * Rational::from((1_000_001, 1_000_000)));
        // The square leaves the exponents: the harmonic has no bound, and the whole of q_0 none. To square it takes seconds.
        if std::env::var_os("SIGMASTAR_CASES").is_some_and(|cases| cases == "all") {
            let huge = Rational::from(rug::Integer::from(1) << 550_000_000);
            assert!(known_forcing([(&forcing(huge), &Parameters::default())].into_iter()).is_none());
        }
    }
}

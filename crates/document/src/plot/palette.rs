//! How curves are told apart in every figure: by a colour, and without colour by dashes and marks; and what colours become on a
//! dark ground.

use plotters::style::{BLACK, RGBColor, WHITE};

/// Colours that stay apart for most eyes (the first four are Okabe's and Ito's), each with a contrast of 3 against white.
pub const COLOURS: [RGBColor; 6] = [
    RGBColor(0, 114, 178),
    RGBColor(213, 94, 0),
    RGBColor(0, 158, 115),
    RGBColor(204, 121, 167),
    RGBColor(90, 45, 0),
    RGBColor(120, 30, 225),
];

/// [`COLOURS`] on a dark ground, in the same order.
const DARK: [RGBColor; COLOURS.len()] = [
    RGBColor(50, 157, 230),
    RGBColor(241, 140, 55),
    RGBColor(53, 228, 168),
    RGBColor(222, 136, 193),
    RGBColor(157, 128, 73),
    RGBColor(143, 105, 248),
];

/// The ground, what is written on it, and the lines of the grid: strong, faint, each in the light and in the dark.
const GROUND: [RGBColor; 2] = [WHITE, RGBColor(20, 23, 27)];
const INK: [RGBColor; 2] = [BLACK, RGBColor(228, 231, 235)];
pub(super) const GRID: [[RGBColor; 2]; 2] =
    [[RGBColor(220, 220, 220), RGBColor(62, 70, 81)], [RGBColor(242, 242, 242), RGBColor(34, 40, 48)]];

/// CSS that gives the figures within a selector their colours on a dark ground. They are drawn for a light one, so that programs
/// that know no CSS show them as well.
#[must_use]
pub fn dark_style(within: &str) -> String {
    let pairs = COLOURS.into_iter().zip(DARK).map(|(light, dark)| [light, dark]);
    let all = [GROUND, INK].into_iter().chain(GRID).chain(pairs);
    let rule = |property: &str, [light, dark]: [RGBColor; 2]| {
        let [RGBColor(r, g, b), RGBColor(dark_r, dark_g, dark_b)] = [light, dark];
        format!(
            "{within}[{property}=\"#{r:02X}{g:02X}{b:02X}\"] {{ {property}: #{dark_r:02x}{dark_g:02x}{dark_b:02x}; }}\n"
        )
    };
    all.flat_map(|pair| ["fill", "stroke"].map(|property| rule(property, pair))).collect()
}

/// A line: without gaps, or the lengths of a dash and of the gap behind it, in pixels.
pub(super) type Dash = Option<(u32, u32)>;

/// Lines, one for each colour.
const DASHES: [Dash; COLOURS.len()] = [None, Some((12, 5)), Some((4, 4)), Some((22, 6)), Some((8, 10)), Some((2, 6))];

/// A mark.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Mark {
    /// A full circle.
    Disc,
    /// A full triangle.
    Triangle,
    /// A circle.
    Ring,
    /// A cross.
    Cross,
}

/// Marks, in turn.
const MARKS: [Mark; 4] = [Mark::Disc, Mark::Triangle, Mark::Ring, Mark::Cross];

/// What the curves that are no bounds look like, by their place among them. Where the colours are at their end they start
/// again, with another line and another mark.
pub(super) fn look(index: usize) -> (RGBColor, Dash, Mark) {
    let round = index / COLOURS.len();
    (COLOURS[index % COLOURS.len()], DASHES[(index + round) % DASHES.len()], MARKS[(index + round) % MARKS.len()])
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Linear red, green and blue.
    type Light = [f64; 3];

    /// What an eye without one kind of cones sees of linear light (Machado, Oliveira and Fernandes 2009).
    const EYES: [(&str, [Light; 3]); 4] = [
        ("ordinary", [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]]),
        (
            "deuteranopia",
            [[0.367_322, 0.860_646, -0.227_968], [0.280_085, 0.672_501, 0.047_413], [-0.011_820, 0.042_940, 0.968_881]],
        ),
        (
            "protanopia",
            [
                [0.152_286, 1.052_583, -0.204_868],
                [0.114_503, 0.786_281, 0.099_216],
                [-0.003_882, -0.048_116, 1.051_998],
            ],
        ),
        (
            "tritanopia",
            [
                [1.255_528, -0.076_749, -0.178_779],
                [-0.078_411, 0.930_809, 0.147_602],
                [0.004_733, 0.691_367, 0.303_900],
            ],
        ),
    ];

    /// From linear light to X, Y, Z under D65.
    const XYZ: [Light; 3] = [
        [0.412_456_4, 0.357_576_1, 0.180_437_5],
        [0.212_672_9, 0.715_152_2, 0.072_175_0],
        [0.019_333_9, 0.119_192_0, 0.950_304_1],
    ];

    fn times(matrix: &[Light; 3], light: Light) -> Light {
        matrix.map(|row| row.iter().zip(light).map(|(a, b)| a * b).sum())
    }

    fn light(colour: RGBColor) -> Light {
        [colour.0, colour.1, colour.2].map(|value| {
            let value = f64::from(value) / 255.0;
            if value <= 0.04045 { value / 12.92 } else { ((value + 0.055) / 1.055).powf(2.4) }
        })
    }

    /// CIELAB.
    fn lab(light: Light) -> Light {
        let [x, y, z] = times(&XYZ, light);
        let root = |t: f64| if t > 216.0 / 24389.0 { t.cbrt() } else { (24389.0 / 27.0 * t + 16.0) / 116.0 };
        let [x, y, z] = [root(x / 0.95047), root(y), root(z / 1.08883)];
        [116.0 * y - 16.0, 500.0 * (x - y), 200.0 * (y - z)]
    }

    /// The colour difference of 1976, at its smallest among these colours for one eye.
    fn smallest_difference(colours: &[RGBColor], eye: &[Light; 3]) -> f64 {
        let seen: Vec<Light> =
            colours.iter().map(|colour| lab(times(eye, light(*colour)).map(|v| v.clamp(0.0, 1.0)))).collect();
        let mut smallest = f64::INFINITY;
        for (index, a) in seen.iter().enumerate() {
            for b in &seen[..index] {
                smallest = smallest.min(a.iter().zip(b).map(|(a, b)| (a - b).powi(2)).sum::<f64>().sqrt());
            }
        }
        smallest
    }

    /// 2.3 is just noticeable; red and green of traffic lights fail for those whom this is for.
    #[test]
    fn colours_stay_apart_for_every_eye() {
        for (colours, ink) in [(COLOURS, INK[0]), (DARK, INK[1])] {
            let all: Vec<RGBColor> = colours.into_iter().chain([ink]).collect();
            for (name, eye) in &EYES {
                let difference = smallest_difference(&all, eye);
                assert!(difference >= 15.0, "{name}: {difference}");
            }
        }
        let lights = [RGBColor(200, 60, 0), RGBColor(110, 130, 0)];
        assert!(smallest_difference(&lights, &EYES[0].1) > 50.0 && smallest_difference(&lights, &EYES[1].1) < 15.0);
    }

    #[test]
    fn every_line_is_seen_on_its_ground() {
        let luminance = |colour| times(&XYZ, light(colour))[1] + 0.05;
        for (colours, ground) in [(COLOURS, GROUND[0]), (DARK, GROUND[1])] {
            for colour in colours {
                let (a, b) = (luminance(colour), luminance(ground));
                let contrast = a.max(b) / a.min(b);
                assert!(contrast >= 3.0, "{colour:?}: {contrast}");
            }
        }
    }

    #[test]
    fn every_colour_has_one_for_the_dark() {
        let style = dark_style("a ");
        assert!(style.contains("a [fill=\"#FFFFFF\"] { fill: #14171b; }\n"), "{style}");
        assert!(style.contains("a [stroke=\"#0072B2\"] { stroke: #329de6; }\n"), "{style}");
        assert_eq!(style.lines().count(), 2 * (COLOURS.len() + 4));
    }

    #[test]
    fn no_two_curves_differ_in_colour_alone() {
        let looks: Vec<_> = (0..COLOURS.len()).map(look).collect();
        for (index, (_, dash, mark)) in looks.iter().enumerate() {
            assert!(looks[..index].iter().all(|(_, other, _)| other != dash), "{dash:?}");
            assert!(looks[index.saturating_sub(MARKS.len() - 1)..index].iter().all(|(.., other)| other != mark));
        }
        // The next round is another one.
        assert_ne!(look(0), look(COLOURS.len()));
        assert_eq!(look(1).0, look(1 + COLOURS.len()).0);
    }
}

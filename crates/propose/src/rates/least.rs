//! Where a bound of what noise and a disturbance do is about least, in floating point: over the rate, over the size of the room that the
//! inputs are given, and with both of them over its division. Nothing here is a claim.

use sigmastar_exact::number::Portable;

/// Steps of a search for where a product is least, or a gain largest.
pub(super) const GOLDEN: usize = 40;

/// Frequencies about each eigenvalue at which a transfer function is looked at, in units of its distance from the line or the circle.
pub(super) const OFFSETS: [f64; 15] =
    [0.0, 0.1, 0.25, 0.5, 0.8, 1.2, 2.0, 4.0, 10.0, -0.1, -0.25, -0.5, -1.0, -2.0, -5.0];

/// Orders of Pi from which on fewer steps are made.
const LARGE: usize = 50;

/// Where a search is.
#[derive(Clone, Copy)]
pub(super) struct Point {
    /// The rate over the largest one, as log(x/(1-x)).
    position: f64,
    /// log of gam_d + gam_v k^2 over what the condition leaves to a disturbance, k being about what noise is worth as one.
    size: f64,
    /// log of gam_v k v_bar over gam_d d_bar.
    ratio: f64,
}

/// How thorough a search is.
pub(super) struct Thoroughness<'a> {
    /// That of Pi.
    pub(super) order: usize,
    /// Steps in the rate, in the size of the inputs, and in their ratio.
    pub(super) steps: [usize; 3],
    /// By what they are divided where Pi is large.
    pub(super) fewer: usize,
    /// The last position.
    pub(super) last: f64,
    /// What is given away of what the condition leaves over: the first at first, and the best before the ratio is sought.
    pub(super) slacks: &'a [f64],
}

impl Point {
    /// The rate, of which this is the largest one.
    pub(super) fn rate(&self, largest: f64) -> f64 {
        largest / (1.0 + (-self.position).portable_exp())
    }

    /// gam_d + gam_v k^2, of which a condition leaves so much room to a disturbance.
    pub(super) fn total(&self, room: f64) -> f64 {
        room * self.size.portable_exp()
    }

    /// gam_d and gam_v for inputs of these sizes, d_bar and v_bar, with so much room left; k is `worth`.
    pub(super) fn weights(&self, room: f64, [d_bar, v_bar]: [f64; 2], worth: f64) -> [f64; 2] {
        let total = self.total(room);
        let [of_d, of_v] = match (d_bar > 0.0, v_bar > 0.0) {
            (true, true) => {
                let v = self.ratio.portable_exp() * v_bar * worth;
                [d_bar / (d_bar + v), v / (d_bar + v)]
            }
            (d, v) => [f64::from(u8::from(d)), f64::from(u8::from(v))],
        };
        [total * of_d, total * of_v / worth.portable_powi(2)]
    }
}

/// The solution with about the least square, for inputs of these sizes; `None` where there is none.
pub(super) fn least<S>(
    Thoroughness { order, steps, fewer, last, slacks }: &Thoroughness<'_>,
    sizes: [f64; 2],
    solve: impl Fn(Point, f64) -> Option<S>,
    square: impl Fn(&S) -> f64,
) -> Option<S> {
    let cost = |point: Point, slack: f64| solve(point, slack).map_or(f64::INFINITY, |found| square(&found));
    let steps = if *order > LARGE { steps.map(|steps| steps / fewer) } else { *steps };
    let both = sizes.iter().all(|size| *size > 0.0);
    let (mut at, mut slack) = (Point { position: 0.0, size: -1.0, ratio: 0.0 }, *slacks.first()?);
    for round in 0..if both { 2 } else { 1 } {
        // The size that was best for one rate is near that for the next.
        let mut size = at.size;
        let of_position = |position| {
            let of = |size: f64| cost(Point { position, size, ..at }, slack);
            let (found, value) = golden(of, [size - 3.0, size + 3.0], steps[1]);
            if value.is_finite() {
                size = found;
            }
            value
        };
        let (position, _) = golden(of_position, [-5.0, *last], steps[0]);
        (size, _) = golden(|size| cost(Point { position, size, ..at }, slack), [size - 3.0, size + 3.0], steps[1]);
        at = Point { position, size, ..at };
        if slacks.len() > 1 {
            let best = slacks.iter().copied().min_by(|one, other| cost(at, *one).total_cmp(&cost(at, *other)));
            slack = best.unwrap_or(slack);
        }
        if both && round == 0 {
            (at.ratio, _) = golden(|ratio| cost(Point { ratio, ..at }, slack), [-3.0, 3.0], steps[2]);
        }
    }
    solve(at, slack)
}

/// Where a function is about least, by golden sections with so many steps, and what it is there; where it is infinite on both sides the
/// lower end is nearer.
pub(super) fn golden(mut function: impl FnMut(f64) -> f64, [mut low, mut up]: [f64; 2], steps: usize) -> (f64, f64) {
    let ratio = (5f64.sqrt() - 1.0) / 2.0;
    let mut inner = [up - ratio * (up - low), low + ratio * (up - low)];
    let mut values = inner.map(&mut function);
    for _ in 0..steps {
        if values[0] < values[1] || values[1].is_infinite() {
            up = inner[1];
            inner = [up - ratio * (up - low), inner[0]];
            values = [function(inner[0]), values[0]];
        } else {
            low = inner[0];
            inner = [inner[1], low + ratio * (up - low)];
            values = [values[1], function(inner[1])];
        }
    }
    if values[0] < values[1] { (inner[0], values[0]) } else { (inner[1], values[1]) }
}

//! Where a bound of what noise and a disturbance do is about least, in floating point: over the rate, over the size of the room that the
//! inputs are given, and with both of them over its division. Nothing here is a claim.

use sigmastar_exact::number::Portable;

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
pub(super) struct Thoroughness {
    /// Steps in the rate, in the size of the inputs, and in their ratio.
    pub(super) steps: [usize; 3],
    /// The last position.
    pub(super) last: f64,
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

/// Where a cost is about least; what else it depends on is chosen anew in `settle`, before the ratio is.
pub(super) fn descend(
    Thoroughness { steps, last }: Thoroughness,
    sizes: [f64; 2],
    cost: impl Fn(Point) -> f64,
    settle: impl Fn(Point),
) -> Point {
    let both = sizes.iter().all(|size| *size > 0.0);
    let mut at = Point { position: 0.0, size: -1.0, ratio: 0.0 };
    for round in 0..if both { 2 } else { 1 } {
        // The size that was best for one rate is near that for the next.
        let mut size = at.size;
        let of_position = |position| {
            let of = |size: f64| cost(Point { position, size, ..at });
            let (found, value) = golden(of, [size - 3.0, size + 3.0], steps[1]);
            if value.is_finite() {
                size = found;
            }
            value
        };
        let (position, _) = golden(of_position, [-5.0, last], steps[0]);
        (size, _) = golden(|size| cost(Point { position, size, ..at }), [size - 3.0, size + 3.0], steps[1]);
        at = Point { position, size, ..at };
        settle(at);
        if both && round == 0 {
            (at.ratio, _) = golden(|ratio| cost(Point { ratio, ..at }), [-3.0, 3.0], steps[2]);
        }
    }
    at
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

use proofs_check::interval::Interval;
use std::time::Instant;
fn main() {
    for p in [128u32, 256, 512, 1024, 2048, 4096] {
        let third = Interval::int(1, p) / 3;
        let a = (&third * 5) + 1;
        let time = |f: &dyn Fn() -> Interval, n: u32| {
            let t = Instant::now();
            for _ in 0..n {
                std::hint::black_box(f());
            }
            t.elapsed().as_nanos() as f64 / n as f64 / 1000.0
        };
        let n = if p > 1000 { 50 } else { 500 };
        println!(
            "{p}: add {:.3} mul {:.3} div {:.3} sqrt {:.3} exp {:.2} log {:.2} sin {:.2} tan {:.2} atan {:.2} tanh {:.2} coth {:.2} powi {:.2} pow {:.2} zeta {:.1} zeta2 {:.1}",
            time(&|| &a + &third, n),
            time(&|| &a * &third, n),
            time(&|| &a / &third, n),
            time(&|| a.sqrt(), n),
            time(&|| a.exp(), n),
            time(&|| a.log(), n),
            time(&|| a.sin(), n),
            time(&|| a.tan(), n),
            time(&|| a.atan(), n),
            time(&|| a.tanh(), n),
            time(&|| a.coth(), n),
            time(&|| a.powi(-999), n),
            time(&|| a.pow(&third), n),
            time(&|| (&third + 1).zeta(), 5),
            time(&|| (Interval::int(1, p) / 1000 + 1).zeta(), 5)
        );
    }
}

use rug::Rational;
use sigmastar::data::Data;
use sigmastar::plant::Plant;
use sigmastar::reduction::*;
use sigmastar::search::*;
use sigmastar::spec::model::Lyapunov;
use sigmastar::spec::*;
use sigmastar::transfer::TradeOff;
use std::f64::consts::PI;
use std::path::Path;
use std::sync::Arc;

fn f(t: f64, x: [f64; 2], e: f64) -> [f64; 2] {
    [
        -x[0] / 5.0 + 3f64.sqrt() * x[1] + x[1].sin() / 10.0 + (2.0 * PI * t).sin(),
        -3f64.sqrt() * x[0] - x[1]
            + x[1] * x[1] / 10.0
            + x[1] * e
            + (4.0 * PI * t).cos() * (1.0 + (2.0 * PI * t).sin()),
    ]
}
fn main() {
    let plant = Plant::load(Path::new("specs/plants/paper-example.json")).unwrap();
    // orbit
    let n = 4096;
    let h = 1.0 / n as f64;
    let mut x = [0.0; 2];
    let mut orbit = vec![];
    for p in 0..60 {
        orbit.clear();
        for k in 0..n {
            let t = k as f64 * h;
            orbit.push(x);
            let k1 = f(t, x, 0.0);
            let a = |k: [f64; 2], s: f64| [x[0] + s * k[0], x[1] + s * k[1]];
            let k2 = f(t + h / 2.0, a(k1, h / 2.0), 0.0);
            let k3 = f(t + h / 2.0, a(k2, h / 2.0), 0.0);
            let k4 = f(t + h, a(k3, h), 0.0);
            x = [
                x[0] + h / 6.0 * (k1[0] + 2.0 * k2[0] + 2.0 * k3[0] + k4[0]),
                x[1] + h / 6.0 * (k1[1] + 2.0 * k2[1] + 2.0 * k3[1] + k4[1]),
            ];
        }
        let _ = p;
    }
    eprintln!("{:?}", orbit[0]);
    // q harmonics
    let q: Vec<f64> = (0..n)
        .map(|k| {
            let c = (2.0 * PI * k as f64 * h).cos();
            1.0 + orbit[k][0] + c + c * c + c.powi(3) + c.powi(4)
        })
        .collect();
    let mut hs = vec![];
    for k in 0..6 {
        let (mut a, mut b) = (0.0, 0.0);
        for i in 0..n {
            let w = 2.0 * PI * (k * i) as f64 * h;
            a += q[i] * w.cos() * h;
            b += q[i] * w.sin() * h;
        }
        hs.push([2.0 * a, 2.0 * b]);
    }
    let r = |v: f64| Rational::from_f64(v).unwrap();
    let args: Vec<f64> = std::env::args().skip(1).map(|a| a.parse().unwrap()).collect();

    let orbit = Arc::new(orbit);
    let sampler = |lm: &nalgebra::DMatrix<f64>, density: Density| -> Arc<Source> {
        let orb = orbit.clone();
        let (nt, nd) = if density == Density::Coarse { (24usize, 8usize) } else { (64, 16) };
        let l = [[lm[(0, 0)], lm[(0, 1)]], [lm[(1, 0)], lm[(1, 1)]]];
        let inv = lm.clone().try_inverse().unwrap();
        let li = [[inv[(0, 0)], inv[(0, 1)]], [inv[(1, 0)], inv[(1, 1)]]];
        let source: Arc<Source> = Arc::new(move |xx, ee| {
            let mut v = [0f64; 8];
            v[7] = f64::INFINITY;
            v[4] = f64::NEG_INFINITY;
            for kt in 0..nt {
                let t = kt as f64 / nt as f64;
                let o = orb[(kt * 4096) / nt];
                let od = f(t, o, 0.0);
                for kd in 0..=nd {
                    let (c, s) = if kd == nd {
                        (0.0, 0.0)
                    } else {
                        let th = kd as f64 * 2.0 * PI / nd as f64;
                        (th.cos(), th.sin())
                    };
                    let y = [c * xx, s * xx];
                    let x = [o[0] + l[0][0] * y[0] + l[0][1] * y[1], o[1] + l[1][0] * y[0] + l[1][1] * y[1]];
                    for ke in 0..3 {
                        let e = (ke as f64 - 1.0) * ee;
                        let j = [[-0.2, 3f64.sqrt() + x[1].cos() / 10.0], [-3f64.sqrt(), -1.0 + x[1] / 5.0 + e]];
                        let jl = [
                            [j[0][0] * l[0][0] + j[0][1] * l[1][0], j[0][0] * l[0][1] + j[0][1] * l[1][1]],
                            [j[1][0] * l[0][0] + j[1][1] * l[1][0], j[1][0] * l[0][1] + j[1][1] * l[1][1]],
                        ];
                        let m = [
                            [li[0][0] * jl[0][0] + li[0][1] * jl[1][0], li[0][0] * jl[0][1] + li[0][1] * jl[1][1]],
                            [li[1][0] * jl[0][0] + li[1][1] * jl[1][0], li[1][0] * jl[0][1] + li[1][1] * jl[1][1]],
                        ];
                        // spectral norm
                        let (p, qq, rr) = (
                            m[0][0] * m[0][0] + m[1][0] * m[1][0],
                            m[0][0] * m[0][1] + m[1][0] * m[1][1],
                            m[0][1] * m[0][1] + m[1][1] * m[1][1],
                        );
                        let n2 = (p + rr) / 2.0 + (((p - rr) / 2.0).powi(2) + qq * qq).sqrt();
                        v[0] = v[0].max(n2.sqrt());
                        let (p, qq, rr) = (m[0][0], (m[0][1] + m[1][0]) / 2.0, m[1][1]);
                        let lam = (p + rr) / 2.0 + (((p - rr) / 2.0).powi(2) + qq * qq).sqrt();
                        v[7] = v[7].min(-lam);
                        let fe = [li[0][1] * x[1], li[1][1] * x[1]];
                        v[1] = v[1].max(fe[0].hypot(fe[1]));
                        let u = 1.0 + e * e * x[1] * x[1];
                        let qx = [1.0, e / u];
                        let qe = x[1] / u;
                        let qn = [qx[0] * l[0][0] + qx[1] * l[1][0], qx[0] * l[0][1] + qx[1] * l[1][1]];
                        v[2] = v[2].max(qn[0].hypot(qn[1]));
                        v[3] = v[3].max(qe.abs());
                        v[4] = v[4].max(qe);
                        let q22 = -2.0 * e * e * e * x[1] / (u * u);
                        let q2e = (1.0 - e * e * x[1] * x[1]) / (u * u);
                        let row = [0.0, q22 * od[1]];
                        let rn = [row[1] * l[1][0], row[1] * l[1][1]];
                        v[5] = v[5].max(rn[0].hypot(rn[1]));
                        v[6] = v[6].max((q2e * od[1]).abs());
                    }
                }
            }
            v
        });
        source
    };
    let one = Constant::rational(&r(1.0));
    let of_plant = OfPlant {
        coordinates: vec![vec![r(1.0), r(0.0)], vec![r(0.0), r(1.0)]],
        orbit: ProvedOrbit {
            approximation: TrigonometricVector::default(),
            defect: r(0.0),
            tube: r(1.0),
            radius: r(0.0),
        },
        triple: Lyapunov { p_low: one.clone(), p_up: one.clone(), alpha: one.clone() },
        matrix: PeriodicMatrix { mean: vec![], harmonics: vec![] },
        forcing: ProvedForcing {
            mean: r(hs[0][0] / 2.0),
            harmonics: hs[1..].iter().map(|p| p.map(r)).collect(),
            rest: r(1e-6),
            rest_t: r(1e-4),
        },
        domain: None,
        ball: None,
    };
    let mut spec = specification(&plant, of_plant, ProvedValues::default()).unwrap();
    if args.get(0) == Some(&1.0) {
        spec.initial_set = InitialSet::Paper;
    }
    let t0 = std::time::Instant::now();
    let data = Data::new(&spec, 64);
    let base = FloatModel::new(&data, TradeOff::matched(&data));
    eprintln!("base {:?}", t0.elapsed());
    let frame = |_: &nalgebra::DMatrix<f64>, m: &FloatModel| m.clone();
    let units = |_: &nalgebra::DMatrix<f64>| [1.0, 1.0];
    let search = CoordinateSearch { base: &base, sampler: &sampler, frame: &frame, units: &units };
    let id = nalgebra::DMatrix::<f64>::identity(2, 2);
    let t0 = std::time::Instant::now();
    let p = search_sharp(&search.model(&id, Density::Coarse));
    eprintln!("coarse {:?} {:?}", p.map(|p| p.sigma), t0.elapsed());
    let t0 = std::time::Instant::now();
    let m = search.model(&id, Density::Coarse);
    let p = search_sharp(&m).unwrap();
    let t1 = std::time::Instant::now();
    let q = search_sharp(&m);
    eprintln!("again {:?} {:?} {:?}", q.map(|p| p.sigma), t1 - t0, t1.elapsed());
    let t0 = std::time::Instant::now();
    let q = search_sharp_near(&search.model(&id, Density::Coarse), &p);
    eprintln!("near {:?} {:?}", q.map(|p| p.sigma), t0.elapsed());
    let t0 = std::time::Instant::now();
    let c = search.choose(&[id]).unwrap();
    eprintln!("{} {:?} {:?}", c.l, c.proposal, t0.elapsed());
}

use sigmastar::certificate::*;
use sigmastar::spec::Specification;
fn main() {
    for path in std::env::args().skip(1) {
        let t = std::time::Instant::now();
        let spec = match Specification::load(std::path::Path::new(&path)) {
            Ok(s) => s,
            Err(e) => {
                println!("{path}: {e:?}");
                continue;
            }
        };
        let t1 = t.elapsed();
        let c = match certify(&spec, Options::default()) {
            Ok(c) => c,
            Err(e) => {
                println!("{path}: {e:?}");
                continue;
            }
        };
        println!(
            "{path}: {} {:?} read {:?} total {:?}",
            c.verdict,
            c.sigma_star().map(|s| s.to_f64()),
            t1,
            t.elapsed()
        );
        match &c.sharp {
            Outcome::Proved(p) => println!("  sharp {} {:?}", p.witness.sigma.to_f64(), p.witness),
            Outcome::NotProved { failing, proof } => {
                println!(" not proved {:?}", proof.witness);
                for f in failing {
                    println!("   {} {} {:?} {:?}", f.id, f.what, f.lhs.decimals(), f.rhs.decimals())
                }
            }
            Outcome::NotFound(o) => println!(" {o:?}"),
            Outcome::Skipped => {}
        }
        match &c.repaired {
            Outcome::Proved(p) => println!("  repaired {}", p.witness.sigma.to_f64()),
            Outcome::NotProved { failing, .. } => {
                for f in failing {
                    println!("   {} {} {:?} {:?}", f.id, f.what, f.lhs.decimals(), f.rhs.decimals())
                }
            }
            Outcome::NotFound(o) => println!(" {o:?}"),
            Outcome::Skipped => {}
        }
        println!(
            "  printed {:?} {:?}",
            c.printed.refutation.as_ref().map(|r| r.to_string()),
            c.printed.sigma.as_ref().map(|s| s.midpoint_f64())
        );
        println!("  exact {:?} binding {:?}", c.exact.as_ref().map(|e| e.witness.sigma.to_f64()), c.binding);
        println!("  {:?}", c.sensitivities);
    }
}

//! The regulator of a shipped specification, and a step of it at a sample: `cargo run --release --example regulator`.

#![allow(clippy::disallowed_methods, reason = "what is compared need not be the same on every machine")]

use sigmastar::{Error, Specification, regulator_matrices, sampled_regulator};

fn main() -> Result<(), Error> {
    let specification = Specification::from_json(include_str!("../specs/paper-example.json"))?;
    let (sigma, n_o, step) = ("48", 2, "1/1000");
    let regulator = regulator_matrices(&specification, sigma, n_o)?;
    println!(
        "z' = Phi z + Gamma e, u = -sigma e + mu M'N(z - M e), sigma = {}, mu = {}",
        regulator.sigma, regulator.mu
    );
    println!("Phi:");
    for row in &regulator.phi {
        println!("  {row:9.5?}");
    }
    println!("Gamma: {:?}\nM: {:?}\ndiagonal of N: {:?}", regulator.gamma, regulator.m, regulator.n_diagonal);

    let sampled = sampled_regulator(&specification, sigma, n_o, step)?;
    println!("\nAt samples {} apart, the spectral radius on e' = u is {}", sampled.step, sampled.spectral_radius);

    // One step from rest with the error 1/2.
    let (z, e) = (vec![0.0; regulator.m.len()], 0.5);
    let u = sampled.control(&z, e);
    let next: Vec<f64> = sampled
        .phi
        .iter()
        .zip(&sampled.gamma)
        .map(|(row, input)| row.iter().zip(&z).map(|(a, z)| a * z).sum::<f64>() + input * e)
        .collect();
    println!("u = {u:?}, the next z = {next:?}");
    Ok(())
}

//! SHA-256 (FIPS 180-4), for the digest of the specification. The digest identifies; no claim rests on it.

use rug::Integer;

/// The first 32 bits of the fractional parts of the `root`-th roots of the first primes, which are the constants of
/// the standard; computed rather than copied.
fn constants(count: usize, root: u32) -> Vec<u32> {
    let is_prime = |n: &u32| (2..*n).take_while(|d| d * d <= *n).all(|d| !n.is_multiple_of(d));
    let fraction = |prime: u32| (Integer::from(prime) << (32 * root)).root(root).to_u32_wrapping();
    (2..).filter(is_prime).take(count).map(fraction).collect()
}

/// The digest in lower-case hexadecimal.
pub fn hex_digest(message: &[u8]) -> String {
    let rounds = constants(64, 3);
    let mut state = constants(8, 2);
    let mut padded = message.to_vec();
    padded.push(0x80);
    padded.resize((padded.len() + 8).next_multiple_of(64) - 8, 0);
    padded.extend((message.len() as u64 * 8).to_be_bytes());
    for block in padded.chunks_exact(64) {
        let mut w: Vec<u32> = block.chunks_exact(4).map(|b| u32::from_be_bytes([b[0], b[1], b[2], b[3]])).collect();
        for t in 16..64 {
            let (x, y) = (w[t - 15], w[t - 2]);
            let small = x.rotate_right(7) ^ x.rotate_right(18) ^ (x >> 3);
            let large = y.rotate_right(17) ^ y.rotate_right(19) ^ (y >> 10);
            w.push(w[t - 16].wrapping_add(small).wrapping_add(w[t - 7]).wrapping_add(large));
        }
        let mut s = [0_u32; 8];
        s.copy_from_slice(&state);
        for t in 0..64 {
            let [a, b, c, d, e, f, g, h] = s;
            let upper = e.rotate_right(6) ^ e.rotate_right(11) ^ e.rotate_right(25);
            let choice = (e & f) ^ (!e & g);
            let one = h.wrapping_add(upper).wrapping_add(choice).wrapping_add(rounds[t]).wrapping_add(w[t]);
            let lower = a.rotate_right(2) ^ a.rotate_right(13) ^ a.rotate_right(22);
            let two = lower.wrapping_add((a & b) ^ (a & c) ^ (b & c));
            s = [one.wrapping_add(two), a, b, c, d.wrapping_add(one), e, f, g];
        }
        for (total, value) in state.iter_mut().zip(s) {
            *total = total.wrapping_add(value);
        }
    }
    state.iter().map(|word| format!("{word:08x}")).collect()
}

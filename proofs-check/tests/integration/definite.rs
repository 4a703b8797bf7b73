//! Which matrices of intervals are positive definite, and which are certainly not.

use proofs_check::interval::Interval;
use proofs_check::matrix::positive_definite;

fn matrix(rows: &[&[i64]]) -> Vec<Vec<Interval>> {
    rows.iter().map(|row| row.iter().map(|entry| Interval::int(*entry, 64)).collect()).collect()
}

#[test]
fn definite_matrices() {
    for (rows, truth) in [
        (&[&[1_i64][..]][..], Some(true)),
        (&[&[-1]], Some(false)),
        (&[&[0]], None),
        (&[&[2], &[1, 1]], Some(true)),
        (&[&[1], &[1, 1]], None),
        (&[&[1], &[2, 3]], Some(false)),
        (&[&[1], &[-2, 3]], Some(false)),
        (&[&[4], &[2, 2], &[0, 1, 2]], Some(true)),
        (&[&[4], &[2, 2], &[2, 3, 3]], Some(false)),
        (&[&[4], &[2, 2], &[2, 3, 5]], None),
        (&[&[4], &[2, 2], &[2, -1, 9]], Some(true)),
        (&[&[4], &[2, 2], &[2, -1, 4]], Some(false)),
        (&[&[1], &[0, 1], &[0, 0, 1], &[1, 1, 1, 4]], Some(true)),
        (&[&[1], &[0, 1], &[0, 0, 1], &[1, 1, 1, 3]], None),
        (&[&[1], &[0, 1], &[0, 0, 1], &[1, 1, 1, 2]], Some(false)),
    ] {
        assert_eq!(positive_definite(matrix(rows)), truth, "{rows:?}");
    }
    // Wide entries: every member counts.
    let side = |lo: i64, hi: i64| Interval::int(lo, 64).hull(&Interval::int(hi, 64));
    let with = |off: Interval| vec![vec![Interval::int(1, 64)], vec![off, Interval::int(4, 64)]];
    assert_eq!(positive_definite(with(side(-1, 1))), Some(true));
    assert_eq!(positive_definite(with(side(1, 3))), None);
    assert_eq!(positive_definite(with(side(3, 4))), Some(false));
    let undefined = with(Interval::undefined(64));
    assert_eq!(positive_definite(undefined), None);
}

//! The powers of several numbers up to a degree: the terms of their polynomials.

use std::collections::HashMap;

/// Of so many numbers, in rising degree: the first is 1, and then come the numbers themselves.
pub struct Powers {
    /// The exponents.
    pub list: Vec<Vec<u32>>,
    /// How many are of a degree up to this one.
    counts: Vec<usize>,
    /// By the place of a power: those of its products with the first ones, of a degree up to the largest.
    products: Vec<Vec<usize>>,
}

impl Powers {
    /// All of them.
    pub fn new(numbers: usize, degree: usize) -> Powers {
        let mut list: Vec<Vec<u32>> = vec![vec![0; numbers]];
        let mut counts = vec![1];
        let mut places = HashMap::from([(vec![0; numbers], 0)]);
        let mut from = 0;
        for _ in 0..degree {
            let last = list[from..].to_vec();
            from = list.len();
            for (power, i) in last.iter().flat_map(|power| (0..numbers).map(move |i| (power, i))) {
                let mut raised = power.clone();
                raised[i] += 1;
                if !places.contains_key(&raised) {
                    places.insert(raised.clone(), list.len());
                    list.push(raised);
                }
            }
            counts.push(list.len());
        }
        let sum = |a: &[u32], b: &[u32]| a.iter().zip(b).map(|(a, b)| a + b).collect::<Vec<u32>>();
        let row = |a: &Vec<u32>| list.iter().map_while(|b| places.get(&sum(a, b)).copied()).collect();
        let products = list.iter().map(row).collect();
        Powers { list, counts, products }
    }

    /// The largest degree.
    pub fn degree(&self) -> usize {
        self.counts.len() - 1
    }

    /// That of a power.
    pub fn degree_of(&self, place: usize) -> usize {
        self.list[place].iter().sum::<u32>() as usize
    }

    /// The places of the products of a power with the first ones, as far as they are of no larger degree than this.
    pub fn products(&self, place: usize, degree: usize) -> &[usize] {
        let count = degree.checked_sub(self.degree_of(place)).map_or(0, |rest| self.counts[rest.min(self.degree())]);
        let row = &self.products[place];
        &row[..count.min(row.len())]
    }

    /// The place of a power times a number, unless its degree is too large.
    pub fn raised(&self, place: usize, number: usize) -> Option<usize> {
        self.products[place].get(1 + number).copied()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_powers_and_their_products() {
        for (numbers, degree, count) in [(1, 12, 13), (2, 5, 21), (3, 8, 165), (3, 1, 4), (2, 0, 1)] {
            let powers = Powers::new(numbers, degree);
            assert_eq!((powers.list.len(), powers.degree()), (count, degree));
            for (i, a) in powers.list.iter().enumerate() {
                assert_eq!(powers.degree_of(i), a.iter().sum::<u32>() as usize);
                for limit in 0..=degree {
                    let found = powers.products(i, limit);
                    let right = powers
                        .list
                        .iter()
                        .filter(|b| (a.iter().sum::<u32>() + b.iter().sum::<u32>()) as usize <= limit);
                    assert_eq!(found.len(), right.count());
                    for (b, k) in powers.list.iter().zip(found) {
                        assert!(a.iter().zip(b).zip(&powers.list[*k]).all(|((a, b), c)| a + b == *c));
                    }
                }
                for number in 0..numbers {
                    let mut raised = a.clone();
                    raised[number] += 1;
                    assert_eq!(powers.raised(i, number), powers.list.iter().position(|power| *power == raised));
                }
            }
        }
    }
}

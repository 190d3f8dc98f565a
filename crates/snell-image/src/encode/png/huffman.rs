//! Huffman codes of bounded length, as DEFLATE has them (RFC 1951, section 3.2.2).

/// The longest code of DEFLATE.
const LONGEST: usize = 15;

/// The lengths of the best prefix code for symbols that occur that often, none longer than `limit`; 0 for those that do not
/// occur. At least two symbols must occur, and there must be room for all: their number is at most 2 to the power `limit`.
pub fn code_lengths<const N: usize>(counts: &[u32; N], limit: usize) -> [u8; N] {
    let mut used: Vec<usize> = (0..N).filter(|&symbol| counts[symbol] > 0).collect();
    // The rarest first; a stable sort, so that equals stay in the order of symbols.
    used.sort_by_key(|&symbol| counts[symbol]);
    let weights: Vec<u64> = used.iter().map(|&symbol| counts[symbol].into()).collect();
    let numbers = numbers_of_lengths(&depths(&weights), limit);

    let mut lengths = [0; N];
    let mut symbols = used.into_iter();
    for length in (1..=limit).rev() {
        for symbol in symbols.by_ref().take(numbers[length]) {
            lengths[symbol] = length as u8;
        }
    }
    lengths
}

/// The depth of each leaf in Huffman's tree (1952) over weights in ascending order, by two queues: leaves not yet joined, and
/// joined nodes, which come into being in ascending order as well (van Leeuwen 1976).
fn depths(weights: &[u64]) -> Vec<usize> {
    let leaves = weights.len();
    let nodes = (2 * leaves).saturating_sub(1);
    let mut weight = weights.to_vec();
    let mut parent = vec![nodes; nodes];
    let (mut leaf, mut joined) = (0, leaves);
    for node in leaves..nodes {
        let mut sum = 0;
        for _ in 0..2 {
            let lightest = if leaf < leaves && (joined >= node || weight[leaf] <= weight[joined]) {
                &mut leaf
            } else {
                &mut joined
            };
            sum += weight[*lightest];
            parent[*lightest] = node;
            *lightest += 1;
        }
        weight.push(sum);
    }
    let mut depth = vec![0; nodes];
    for node in (0..nodes.saturating_sub(1)).rev() {
        depth[node] = depth[parent[node]] + 1;
    }
    depth.truncate(leaves);
    depth
}

/// How many codes there are of each length, after those that are too long were made as long as may be and others longer, until
/// there is room for all of them.
fn numbers_of_lengths(depths: &[usize], limit: usize) -> [usize; LONGEST + 1] {
    let mut numbers = [0; LONGEST + 1];
    for &depth in depths {
        numbers[depth.min(limit)] += 1;
    }
    // The share of all codes of the greatest length that are taken; the tree itself takes all.
    let mut taken: usize = (1..=limit).map(|length| numbers[length] << (limit - length)).sum();
    while taken > 1 << limit {
        // One of the longest codes goes beside one that was shorter, which becomes longer by one for it.
        let Some(shorter) = (1..limit).rev().find(|&length| numbers[length] > 0) else { break };
        numbers[limit] -= 1;
        numbers[shorter] -= 1;
        numbers[shorter + 1] += 2;
        taken -= 1;
    }
    numbers
}

/// The codes of given lengths, the first bit of each lowest, as they are put into the stream.
pub fn codes<const N: usize>(lengths: &[u8; N]) -> [u16; N] {
    let mut next = [0_u16; LONGEST + 2];
    for length in 1..=LONGEST {
        let number = lengths.iter().filter(|&&other| usize::from(other) == length).count();
        next[length + 1] = (next[length] + number as u16) << 1;
    }
    lengths.map(|length| {
        let code = &mut next[usize::from(length)];
        *code += 1;
        if length == 0 { 0 } else { (*code - 1).reverse_bits() >> (16 - length) }
    })
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    fn kraft(lengths: &[u8], limit: usize) -> u64 {
        lengths.iter().filter(|&&length| length > 0).map(|&length| 1 << (limit - usize::from(length))).sum()
    }

    fn cost(counts: &[u32], lengths: &[u8]) -> u64 {
        counts.iter().zip(lengths).map(|(&count, &length)| u64::from(count) * u64::from(length)).sum()
    }

    proptest! {
        #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::default() })]
        #[test]
        fn codes_are_complete_and_within_the_limit(exponents in prop::collection::vec(0..31_u32, 19), limit in 5..16_usize) {
            let counts: [u32; 19] = std::array::from_fn(|i| (1 << exponents[i]) - 1 + u32::from(i < 2));
            let lengths = code_lengths(&counts, limit);
            prop_assert!((0..19).all(|i| (lengths[i] > 0) == (counts[i] > 0) && usize::from(lengths[i]) <= limit));
            prop_assert_eq!(kraft(&lengths, limit), 1 << limit);
            // Rarer symbols never have shorter codes.
            for (i, j) in (0..19).flat_map(|i| (0..19).map(move |j| (i, j))) {
                prop_assert!(counts[i] == 0 || counts[i] >= counts[j] || lengths[i] >= lengths[j]);
            }
            // No code begins with another one.
            let codes = codes(&lengths);
            for (i, j) in (0..19).flat_map(|i| (0..19).map(move |j| (i, j))) {
                if i != j && lengths[i] > 0 && lengths[i] <= lengths[j] {
                    prop_assert_ne!(codes[i], codes[j] & ((1 << lengths[i]) - 1));
                }
            }
        }
    }

    #[test]
    fn without_a_limit_the_code_is_huffmans() {
        // Weights of Fibonacci give the deepest tree, equal ones the flattest.
        assert_eq!(code_lengths(&[1, 1, 2, 3, 5, 8, 13], 15), [6, 6, 5, 4, 3, 2, 1]);
        assert_eq!(code_lengths(&[7; 8], 15), [3; 8]);
        assert_eq!(code_lengths(&[0, 9, 0, 1], 15), [0, 1, 0, 1]);
        // The entropy of these is 1.75 bits, and the code reaches it.
        assert_eq!(cost(&[4, 2, 1, 1], &code_lengths(&[4, 2, 1, 1], 15)), 14);
    }

    #[test]
    fn the_example_of_the_standard_has_its_codes() {
        // RFC 1951, section 3.2.2, with the first bit lowest.
        let codes = codes(&[3, 3, 3, 3, 3, 2, 4, 4]);
        let expected = [0b010, 0b110, 0b001, 0b101, 0b011, 0b00, 0b0111, 0b1111];
        assert_eq!(codes, expected);
    }
}

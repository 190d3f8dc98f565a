//! All ways of computing give the bits of one number at a time.

use proptest::prelude::*;

use super::{Bits, Eight, End, Floats, InstructionSet, LaneColor, LaneVector, Lanes, WIDTH, Work, dispatch};
use crate::{Rgb, Vector3};

/// Everything that lanes can do, on rows of numbers; a row of bits for each result.
struct Everything<'a> {
    a: &'a [f64; WIDTH],
    b: &'a [f64; WIDTH],
    bits: Bits,
}

type Results = Vec<[u64; WIDTH]>;

impl Work for Everything<'_> {
    type Output = Results;

    #[inline(always)]
    fn run<L: Lanes>(self) -> Results {
        let mut results: Results = Vec::new();
        for at in (0..WIDTH).step_by(L::COUNT) {
            let (a, b, bits) = (L::load(self.a, at), L::load(self.b, at), Bits(self.bits.0 >> at));
            let (f, g) = (a.to_floats(), b.to_floats());
            let vector = LaneVector { x: a, y: b, z: a - b };
            let color = LaneColor { r: f, g, b: f * g };
            let numbers = [
                a + b,
                a - b,
                a * b,
                a / b,
                -a,
                a.sqrt(),
                a.abs(),
                a.copysign(b),
                a.or_where_not(bits, b),
                a.larger(b),
                a.smaller(b),
                L::splat(1.5) * a,
                L::from_floats(f),
                a.floor(),
                a.exponent(),
                a.times_power_of_two(b.exponent().smaller(L::splat(1023.0)).larger(L::splat(-1022.0))),
                vector.dot(vector + vector),
                vector.normalize().y,
                vector.max_abs(),
                (-vector * a).or_where_not(bits, vector).z,
            ];
            let floats = [
                f + g,
                f - g,
                f * g,
                -f,
                f.abs(),
                f.max(g),
                f.or_where_not(bits, g),
                color.max_abs(),
                (color + color * f).or_where_not(bits, color * color).b,
            ];
            let tests =
                [a.lt(b), a.le(b), a.same(b), a.gt(b), a.ge(b), f.lt(g), f.is_zero(), f.is_nan(), color.is_black()];
            let count = numbers.len() + floats.len() + tests.len();
            results.resize(count, [0; WIDTH]);
            let mut rows = results.iter_mut();
            for number in numbers {
                let mut row = [0.0; WIDTH];
                number.store(&mut row, at);
                let target = rows.next().expect("a row for each");
                // Which NaN comes of an invalid operation is not the same everywhere.
                (at..at + L::COUNT).for_each(|i| target[i] = if row[i].is_nan() { u64::MAX } else { row[i].to_bits() });
            }
            for float in floats {
                let mut row = [0.0; WIDTH];
                float.store(&mut row, at);
                let target = rows.next().expect("a row for each");
                (at..at + L::COUNT).for_each(|i| {
                    target[i] = if row[i].is_nan() { u64::MAX } else { u64::from(row[i].to_bits()) };
                });
            }
            for test in tests {
                let target = rows.next().expect("a row for each");
                (0..L::COUNT).for_each(|i| target[at + i] = u64::from(test.has(i)));
            }
        }
        results
    }
}

/// Everything that rows of eight `f32` can do besides.
struct Rows<'a>(&'a [f32; WIDTH], &'a [f32; WIDTH]);

impl Work for Rows<'_> {
    type Output = (Vec<u32>, Bits);

    #[inline(always)]
    fn run<L: Lanes>(self) -> Self::Output {
        let (a, b) = (<L::Eight as Floats>::load(self.0, 0), <L::Eight as Floats>::load(self.1, 0));
        let all = [a / b, a.lesser(b), a.greater(b), a.times_sign(b), <L::Eight as Floats>::splat(2.0)];
        let mut bits = Vec::new();
        for row in all {
            bits.extend(row.to_array().map(|x| if x.is_nan() { u32::MAX } else { x.to_bits() }));
        }
        (bits, a.le(b))
    }
}

fn numbers() -> impl Strategy<Value = [f64; WIDTH]> {
    let number = prop_oneof![
        -1e3..1e3f64,
        any::<f64>(),
        Just(0.0),
        Just(-0.0),
        Just(f64::INFINITY),
        Just(f64::NAN),
        Just(5e-324),
        Just(1.0)
    ];
    prop::collection::vec(number, WIDTH).prop_map(|v| std::array::from_fn(|i| v[i]))
}

/// Products with something added, which may be rounded once or twice.
struct Loose<'a>(&'a [f32; WIDTH], &'a [f32; WIDTH], &'a [f32; WIDTH]);

impl Work for Loose<'_> {
    type Output = [f32; WIDTH];
    #[inline(always)]
    fn run<L: Lanes>(self) -> [f32; WIDTH] {
        let [a, b, c] = [self.0, self.1, self.2].map(|row| <L::Eight as Floats>::load(row, 0));
        a.multiply_add(b, c).to_array()
    }
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::default() })]
    #[test]
    fn loose_sums_err_by_two_roundings(rows in prop::array::uniform3(prop::array::uniform8(-1e3..1e3_f32))) {
        let [a, b, c] = &rows;
        for set in InstructionSet::available() {
            let sums = dispatch(set, Loose(a, b, c));
            for lane in 0..WIDTH {
                let [a, b, c] = [a[lane], b[lane], c[lane]].map(f64::from);
                let bound = f64::from(f32::EPSILON) * 0.5 * 1.001 * ((a * b).abs() + (a * b + c).abs());
                prop_assert!((f64::from(sums[lane]) - (a * b + c)).abs() <= bound, "{set:?} {a} {b} {c}");
            }
        }
    }

    #[test]
    fn all_instructions_give_the_same_bits(a in numbers(), b in numbers(), bits in any::<u8>()) {
        let work = || Everything { a: &a, b: &b, bits: Bits(bits) };
        let expected = dispatch(InstructionSet::Scalar, work());
        for set in InstructionSet::available() {
            prop_assert_eq!(&dispatch(set, work()), &expected, "{:?}", set);
        }
        let floats = [a, b].map(|row| row.map(|x| x as f32));
        let expected_rows = dispatch(InstructionSet::Scalar, Rows(&floats[0], &floats[1]));
        for set in InstructionSet::available() {
            prop_assert_eq!(&dispatch(set, Rows(&floats[0], &floats[1])), &expected_rows, "{:?}", set);
        }
        // The twin: one bit of one number is enough to tell.
        let mut other = a;
        other[5] = f64::from_bits(a[5].to_bits() ^ 1);
        if !a[5].is_nan() && !other[5].is_nan() {
            let different = dispatch(InstructionSet::best(), Everything { a: &other, b: &b, bits: Bits(bits) });
            prop_assert_ne!(different, expected);
        }
    }

    #[test]
    fn one_lane_is_what_vectors_and_colours_are(a in numbers(), f in prop::array::uniform3(any::<f32>())) {
        let v = Vector3::new(a[0], a[1], a[2]);
        let w = Vector3::new(a[3], a[4], a[5]);
        let (lanes, others) = (LaneVector::from(v), LaneVector::from(w));
        let same = |x: f64, y: f64| x.to_bits() == y.to_bits() || x.is_nan() && y.is_nan();
        prop_assert!(same(lanes.dot(others), v.dot(w)));
        let (a, b) = (Vector3::from(lanes.normalize()), v.normalize());
        prop_assert!((0..3).all(|i| same(a[i], b[i])), "{:?} {:?}", a, b);
        prop_assert!(same(lanes.max_abs(), v.max_abs()));
        let color = Rgb::from(f);
        let lane = LaneColor::<f32>::splat(color);
        prop_assert_eq!(lane.is_black().any(), color.is_black());
        prop_assert!(lane.max_abs().to_bits() == color.max_abs().to_bits() || color.max_abs().is_nan());
    }
}

/// Puts rows of numbers of every kind to the end of others.
struct Appending<'a>(&'a [f64; WIDTH], Bits, usize);

impl Work for Appending<'_> {
    type Output = ([[f64; WIDTH]; 2], [[f32; WIDTH]; 2], [[u32; WIDTH]; 2]);

    #[inline(always)]
    fn run<L: Lanes>(self) -> Self::Output {
        let (mut numbers, mut floats, mut words) = ([[-1.0; WIDTH]; 2], [[-1.0; WIDTH]; 2], [[7; WIDTH]; 2]);
        let all = [3, 1, 4, 1, 5, 9, 2, 6];
        let mut from = self.2;
        for at in (0..WIDTH).step_by(L::COUNT) {
            let lanes = Bits(self.1.0 >> at) & L::all();
            let number = L::load(self.0, at);
            // One at a time, it may be in the second row that the next one goes to.
            if from < WIDTH {
                let end = End { lanes, from };
                number.append(end, two(&mut numbers));
                L::append_floats(number.to_floats(), end, two(&mut floats));
                L::append_words(&all, at, end, two(&mut words));
            } else {
                let end = End { lanes, from: from - WIDTH };
                number.append(end, [&mut numbers[1], &mut [0.0; WIDTH]]);
                L::append_floats(number.to_floats(), end, [&mut floats[1], &mut [0.0; WIDTH]]);
                L::append_words(&all, at, end, [&mut words[1], &mut [0; WIDTH]]);
            }
            from += lanes.count() as usize;
        }
        (numbers, floats, words)
    }
}

fn two<T>([first, second]: &mut [T; 2]) -> [&mut T; 2] {
    [first, second]
}

#[test]
fn lanes_go_to_the_end_of_rows() {
    let row = std::array::from_fn(|lane| lane as f64 + 0.5);
    for lanes in 0..=u8::MAX {
        for from in 0..WIDTH {
            let mut expected = [[-1.0; WIDTH]; 2];
            for (place, lane) in (from..).zip(Bits(lanes).lanes()) {
                expected[place / WIDTH][place % WIDTH] = row[lane];
            }
            let end = from + Bits(lanes).count() as usize;
            let scalar = dispatch(InstructionSet::Scalar, Appending(&row, Bits(lanes), from));
            assert_eq!(scalar.0, expected);
            for set in InstructionSet::available() {
                let (numbers, floats, words) = dispatch(set, Appending(&row, Bits(lanes), from));
                // What stands behind the end means nothing.
                let what = format!("{set:?} {lanes:08b} {from}");
                assert_eq!(numbers.as_flattened()[..end], scalar.0.as_flattened()[..end], "{what}");
                assert_eq!(floats.as_flattened()[..end], scalar.1.as_flattened()[..end], "{what}");
                assert_eq!(words.as_flattened()[..end], scalar.2.as_flattened()[..end], "{what}");
            }
        }
    }
}

/// What rounding took from the product of each lane of two rows, one by one and side by side.
struct Products<'a>(&'a [f64; WIDTH], &'a [f64; WIDTH]);

impl Work for Products<'_> {
    type Output = [[f64; WIDTH]; 2];
    #[inline(always)]
    fn run<L: Lanes>(self) -> [[f64; WIDTH]; 2] {
        let [mut errors, mut together] = [[0.0; WIDTH]; 2];
        for (lane, error) in errors.iter_mut().enumerate() {
            let (a, b) = (self.0[lane], self.1[lane]);
            *error = L::product_error(a, b, a * b);
        }
        for at in (0..WIDTH).step_by(L::COUNT) {
            let (a, b) = (L::load(self.0, at), L::load(self.1, at));
            a.product_errors(b, a * b).store(&mut together, at);
        }
        [errors, together]
    }
}

#[test]
fn errors_of_products_are_exact_and_the_same_everywhere() {
    let mut state = 1_u64;
    let mut number = || {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        // Whole numbers of up to 53 bits, often of few, and zeros of both signs.
        let size = (state >> 58).min(53);
        ((state >> 5 & ((1 << size) - 1)) as f64).copysign(if state & (1 << 57) == 0 { 1.0 } else { -1.0 })
    };
    let mut inexact = 0;
    for _ in 0..20_000 {
        let (a, b) = (std::array::from_fn(|_| number()), std::array::from_fn(|_| number()));
        let [scalar, _] = dispatch(InstructionSet::Scalar, Products(&a, &b));
        for lane in 0..WIDTH {
            let truth = (a[lane] as i128 * b[lane] as i128 - (a[lane] * b[lane]) as i128) as f64;
            assert_eq!(scalar[lane], truth, "{} {}", a[lane], b[lane]);
            inexact += usize::from(truth != 0.0);
        }
        for set in InstructionSet::available() {
            for errors in dispatch(set, Products(&a, &b)) {
                assert_eq!(errors.map(f64::to_bits), scalar.map(f64::to_bits), "{set:?} {a:?} {b:?}");
            }
        }
    }
    // The twin: a product alone is not exact.
    assert!(inexact > 20_000, "{inexact}");
}

#[test]
fn sets_of_lanes_are_sets() {
    let bits = Bits(0b1001_0010);
    assert_eq!((bits.count(), bits.lowest(), bits.has(1), bits.has(2)), (3, 1, true, false));
    assert_eq!(bits.lanes().collect::<Vec<_>>(), [1, 4, 7]);
    assert_eq!(bits.without(Bits::lane(4)) | Bits::lane(0), Bits(0b1000_0011));
    assert_eq!((Bits::first(8), Bits::first(0), !Bits::first(3)), (Bits(255), Bits::NONE, Bits(0b1111_1000)));
    assert_eq!((Bits::all_if(true), Bits::all_if(false)), (Bits(255), Bits::NONE));
}

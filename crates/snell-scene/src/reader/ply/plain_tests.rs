//! Rows of nothing but positions or triangles are read at once: the same as number by number.

use std::ops::Range;

use proptest::prelude::*;

use super::header::{self, Element, Format, Scalar};
use super::source::{Binary, Fail, Source};
use super::{Data, body};
use crate::Diagnostics;
use crate::reader::report::Report;

/// A source that reads all rows number by number.
struct NumberByNumber<S>(S);

impl<S: Source> Source for NumberByNumber<S> {
    fn least_size(scalar: Scalar) -> u64 {
        S::least_size(scalar)
    }
    fn remaining(&self) -> u64 {
        self.0.remaining()
    }
    fn begin_row(&mut self) -> Result<(), Fail> {
        self.0.begin_row()
    }
    fn number(&mut self, scalar: Scalar) -> Result<f64, Fail> {
        self.0.number(scalar)
    }
    fn end_row(&mut self) -> Option<Range<usize>> {
        self.0.end_row()
    }
    fn place(&self) -> Range<usize> {
        self.0.place()
    }
    fn skip(&mut self, element: &Element) -> Result<(), Fail> {
        self.0.skip(element)
    }
}

/// The rows of a file and what is told of it.
fn rows(bytes: &[u8], at_once: bool) -> (Option<Data>, Vec<String>) {
    let mut diagnostics = Diagnostics::default();
    let mut report = Report::new("a.ply", bytes, &mut diagnostics);
    let data = header::read(&mut report).and_then(|header| {
        let (little, big) = (Binary::<false>::new(bytes, header.data), Binary::<true>::new(bytes, header.data));
        match (header.format, at_once) {
            (Format::BigEndian, true) => body::read(&header, &mut { big }, &mut report),
            (Format::BigEndian, false) => body::read(&header, &mut NumberByNumber(big), &mut report),
            (_, true) => body::read(&header, &mut { little }, &mut report),
            (_, false) => body::read(&header, &mut NumberByNumber(little), &mut report),
        }
    });
    report.finish();
    (data, diagnostics.list.into_iter().map(|diagnostic| format!("{diagnostic:?}")).collect())
}

/// A file of points and of faces with so many corners, cut off or not.
fn file(big: bool, list: &str, points: &[[f32; 3]], faces: &[(u8, [i32; 4])], left_out: usize) -> Vec<u8> {
    let format = if big { "binary_big_endian" } else { "binary_little_endian" };
    let mut bytes = format!(
        "ply\nformat {format} 1.0\nelement vertex {}\nproperty float x\nproperty float y\nproperty float z\n\
         element face {}\nproperty list {list} vertex_indices\nend_header\n",
        points.len(),
        faces.len()
    )
    .into_bytes();
    for number in points.iter().flatten() {
        bytes.extend(if big { number.to_be_bytes() } else { number.to_le_bytes() });
    }
    for (size, corners) in faces {
        bytes.push(*size);
        for corner in &corners[..usize::from(*size).min(4)] {
            bytes.extend(if big { corner.to_be_bytes() } else { corner.to_le_bytes() });
        }
    }
    bytes.truncate(bytes.len() - left_out);
    bytes
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::with_cases(600) })]
    #[test]
    fn rows_at_once_are_those_number_by_number(
        big in any::<bool>(),
        list in prop::sample::select(vec!["uchar int", "char uint", "uint8 int32", "uchar float", "uchar short"]),
        points in prop::collection::vec(prop::array::uniform3(prop_oneof![
            30 => -9.0..9.0f32, 1 => Just(f32::NAN), 1 => Just(f32::INFINITY), 1 => Just(-0.0),
        ]), 0..9),
        faces in prop::collection::vec(
            (prop_oneof![20 => Just(3u8), 1 => 0..5u8], prop::array::uniform4(prop_oneof![40 => 0..5i32, 1 => -2..12i32])), 0..12),
        left_out in prop_oneof![3 => Just(0), 1 => 0..16usize],
    ) {
        let bytes = file(big, list, &points, &faces, left_out);
        prop_assert_eq!(rows(&bytes, true), rows(&bytes, false));
    }
}

#[test]
fn a_planted_difference_is_seen() {
    let points = [[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]];
    let good = file(false, "uchar int", &points, &[(3, [0, 1, 2, 0])], 0);
    let (data, told) = rows(&good, true);
    assert_eq!((data.as_ref().map(|data| data.corners.len()), told.len()), (Some(3), 0));
    assert_ne!(rows(&good, true), rows(&file(false, "uchar int", &points, &[(3, [0, 2, 1, 0])], 0), false));
    assert_ne!(rows(&good, true), rows(&file(false, "uchar int", &points, &[(3, [0, 1, 3, 0])], 0), false));
}

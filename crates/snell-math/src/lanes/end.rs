//! The end of a queue that stands in rows: where some of eight lanes go.

use super::{Bits, WIDTH};

/// Some lanes that go to the end of rows of which the last has room from place `from` on: in their order, those for which there is no
/// more room in the first of two rows to the beginning of the second.
#[derive(Clone, Copy, Debug)]
pub struct End {
    /// Which lanes.
    pub lanes: Bits,
    /// The first free place, below [`WIDTH`].
    pub from: usize,
}

impl End {
    /// True where some go to the second row.
    #[inline(always)]
    pub fn is_split(self) -> bool {
        self.from + self.lanes.count() as usize > WIDTH
    }

    /// Each lane with its row, 0 or 1, and its place there.
    #[inline(always)]
    pub fn places(self) -> impl Iterator<Item = (usize, usize, usize)> {
        let places = self.from..;
        self.lanes.lanes().zip(places).map(|(lane, place)| (lane, place / WIDTH, place % WIDTH))
    }

    /// Copies them there.
    #[inline(always)]
    pub fn append<T: Copy>(self, row: &[T; WIDTH], rows: [&mut [T; WIDTH]; 2]) {
        let [first, second] = rows;
        for (lane, number, place) in self.places() {
            let row_there = if number == 0 { &mut *first } else { &mut *second };
            row_there[place] = row[lane];
        }
    }
}

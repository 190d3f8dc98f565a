//! A stretch of whole lines of an OBJ file, read by itself: what stands before it is not known yet.
//!
//! Only what is plain is read here. At anything that needs a word said to the user, and at lines continued by a backslash, the
//! stretch is given up, and the file is read line by line instead.

use std::ops::Range;

use snell_math::color::srgb_to_linear;

use super::{Corner, NONE};
use crate::reader::polygon::Triangulator;
use crate::reader::text::{Word, Words, parse_float};

/// What a stretch gave. Numbers of positions, texture coordinates and normals are those of the whole file, but for those in
/// `relative`.
#[derive(Default)]
pub(super) struct Chunk<'a> {
    pub positions: Vec<[f32; 3]>,
    /// Empty until the first vertex with a colour; white before it.
    pub colors: Vec<[f32; 3]>,
    pub uvs: Vec<[f32; 2]>,
    pub normals: Vec<[f32; 3]>,
    /// Of all faces, one face after the other; once they are cut, of all triangles.
    pub corners: Vec<Corner>,
    /// How many corners each face has.
    sizes: Vec<u32>,
    has_polygons: bool,
    /// Corners, and which of their numbers count from the beginning of this stretch.
    relative: Vec<(usize, usize)>,
    /// How many positions, texture coordinates and normals must stand before this stretch for all that faces name to be there.
    pub needs: [i64; 3],
    pub materials: Vec<Change<'a>>,
    pub libraries: Vec<Word<'a>>,
    /// Points and lines passed over.
    pub loose: usize,
}

/// A `usemtl`.
pub(super) struct Change<'a> {
    pub name: Word<'a>,
    /// How many faces of the stretch stand before it, and how many triangles they were cut into.
    pub faces: usize,
    pub triangles: usize,
}

impl<'a> Chunk<'a> {
    /// Reads whole lines; `None` at the first that is not plain.
    pub fn read(bytes: &'a [u8], range: Range<usize>) -> Option<Self> {
        let mut chunk = Self::default();
        let mut cursor = Cursor { bytes: &bytes[..range.end], at: range.start };
        while cursor.at < cursor.bytes.len() {
            chunk.line(&mut cursor)?;
        }
        Some(chunk)
    }

    #[inline]
    fn line(&mut self, cursor: &mut Cursor<'a>) -> Option<()> {
        cursor.skip_blanks();
        match &cursor.bytes[cursor.at..] {
            [b'v', b' ' | b'\t', ..] => {
                cursor.at += 2;
                self.vertex(cursor)?;
            }
            [b'v', b't', b' ' | b'\t', ..] => {
                cursor.at += 3;
                let mut uv = [0.0; 2];
                if cursor.numbers(&mut uv)? < 1 {
                    return None;
                }
                self.uvs.push(uv);
            }
            [b'v', b'n', b' ' | b'\t', ..] => {
                cursor.at += 3;
                let mut normal = [0.0; 3];
                if cursor.numbers(&mut normal)? < 3 {
                    return None;
                }
                self.normals.push(normal);
            }
            [b'f', b' ' | b'\t', ..] => {
                cursor.at += 2;
                self.face(cursor)?;
            }
            _ => self.other(cursor)?,
        }
        cursor.end_line()
    }

    #[inline]
    fn vertex(&mut self, cursor: &mut Cursor<'a>) -> Option<()> {
        // As where lines are read one by one: x y z, then nothing, a weight, or a colour (with an alpha value at most).
        let mut values = [0.0; 7];
        let count = cursor.numbers(&mut values)?;
        let [x, y, z, r, g, b, _] = values;
        if count < 3 {
            return None;
        }
        if count >= 6 {
            if [r, g, b].iter().any(|c| !(0.0..=1.0).contains(c)) {
                return None;
            }
            self.colors.resize(self.positions.len(), [1.0; 3]);
            self.colors.push([r, g, b].map(srgb_to_linear));
        }
        self.positions.push([x, y, z]);
        Some(())
    }

    #[inline]
    fn face(&mut self, cursor: &mut Cursor<'a>) -> Option<()> {
        let first = self.corners.len();
        while cursor.is_at_word() {
            let corner = self.corner(cursor)?;
            self.corners.push(corner);
        }
        let size = self.corners.len() - first;
        if size < 3 {
            return None;
        }
        self.has_polygons |= size > 3;
        self.sizes.push(size as u32);
        Some(())
    }

    /// One corner of a face: `v`, `v/vt`, `v//vn` or `v/vt/vn`.
    #[inline]
    fn corner(&mut self, cursor: &mut Cursor<'a>) -> Option<Corner> {
        let mut corner = [NONE; 3];
        let here = [self.positions.len(), self.uvs.len(), self.normals.len()];
        for kind in 0..3 {
            let next = cursor.peek();
            if kind == 0 || next != b'/' && !is_end(next) {
                let (number, here) = (cursor.integer()?, here[kind] as i64);
                let (place, needed) = match number {
                    0 => return None,
                    1.. => (number - 1, number - here),
                    _ => {
                        self.relative.push((self.corners.len(), kind));
                        (here + number, -number - here)
                    }
                };
                self.needs[kind] = self.needs[kind].max(needed);
                // Below 0 until what stands before is added.
                corner[kind] = place as u32;
            }
            match cursor.peek() {
                b'/' if kind < 2 => cursor.at += 1,
                end if is_end(end) => return Some(corner),
                _ => return None,
            }
        }
        None
    }

    /// Lines of few files or few lines of each.
    #[cold]
    fn other(&mut self, cursor: &mut Cursor<'a>) -> Option<()> {
        let mut words = Words::new(cursor.bytes, cursor.at..cursor.find_end());
        let Some(keyword) = words.next() else { return Some(()) };
        match keyword.text {
            b"usemtl" => {
                self.materials.push(Change {
                    name: words.rest(),
                    faces: self.sizes.len(),
                    triangles: self.sizes.len(),
                });
            }
            b"mtllib" => self.libraries.push(words.rest()),
            b"p" | b"l" => self.loose += 1,
            b"g" | b"o" | b"s" => {}
            text if text[0] == b'#' => {}
            _ => return None,
        }
        Some(())
    }

    /// How many faces there are.
    pub fn faces(&self) -> usize {
        self.sizes.len()
    }

    /// Adds to relative numbers what stands before this stretch, and cuts faces into triangles. `positions` are those of the
    /// whole file, and this is one of `stretches`. `None` where that would take too long.
    pub fn complete(&mut self, before: [usize; 3], positions: &[[f32; 3]], stretches: usize) -> Option<()> {
        for &(corner, kind) in &self.relative {
            let number = &mut self.corners[corner][kind];
            *number = number.wrapping_add(before[kind] as u32);
        }
        if !self.has_polygons {
            return Some(());
        }
        let mut triangulator = Triangulator::with_share(stretches as u64);
        let (mut triangles, mut cut) = (Vec::with_capacity(self.corners.len() * 3 / 2), Vec::new());
        let mut materials = self.materials.iter_mut().peekable();
        let mut rest = self.corners.as_slice();
        for (number, &size) in self.sizes.iter().enumerate() {
            while let Some(change) = materials.next_if(|change| change.faces <= number) {
                change.triangles = triangles.len() / 3;
            }
            let (face, others) = rest.split_at(size as usize);
            rest = others;
            if size == 3 {
                triangles.extend_from_slice(face);
                continue;
            }
            cut.clear();
            let points = face.iter().map(|corner| positions[corner[0] as usize].map(f64::from));
            triangulator.triangulate(points, &mut cut).ok()?;
            triangles.extend(cut.iter().flatten().map(|&corner| face[corner as usize]));
        }
        materials.for_each(|change| change.triangles = triangles.len() / 3);
        self.corners = triangles;
        Some(())
    }
}

/// True at what ends a word: a blank or a line's end.
#[inline]
fn is_end(byte: u8) -> bool {
    // All of them are 9 to 13, and the space.
    byte == b' ' || byte.wrapping_sub(b'\t') < 5
}

/// A place on the way through the file.
struct Cursor<'a> {
    bytes: &'a [u8],
    at: usize,
}

impl<'a> Cursor<'a> {
    /// The byte here; the file's end is a line's end.
    #[inline]
    fn peek(&self) -> u8 {
        self.bytes.get(self.at).copied().unwrap_or(b'\n')
    }

    #[inline]
    fn skip_blanks(&mut self) {
        while matches!(self.peek(), b' ' | b'\t' | 0x0b | 0x0c) {
            self.at += 1;
        }
    }

    /// To the next word of this line; false where there is none, or only a comment.
    #[inline]
    fn is_at_word(&mut self) -> bool {
        self.skip_blanks();
        !matches!(self.peek(), b'\n' | b'\r' | b'#')
    }

    /// Reads numbers up to the line's end or a comment, as many as are asked for. All must be finite. Says how many there were.
    #[inline]
    fn numbers(&mut self, values: &mut [f32]) -> Option<usize> {
        let mut count = 0;
        for value in values {
            if !self.is_at_word() {
                break;
            }
            let rest = &self.bytes[self.at..];
            let word = &rest[..rest.iter().position(|&byte| is_end(byte)).unwrap_or(rest.len())];
            self.at += word.len();
            *value = parse_float(word)? as f32;
            if !value.is_finite() {
                return None;
            }
            count += 1;
        }
        Some(count)
    }

    /// A whole number of few digits, with an optional sign.
    #[inline]
    fn integer(&mut self) -> Option<i64> {
        const MOST_DIGITS: usize = 9;
        let negative = self.peek() == b'-';
        self.at += usize::from(negative || self.peek() == b'+');
        let (mut value, mut count) = (0i64, 0);
        for byte in self.bytes[self.at..].iter().take(MOST_DIGITS + 1) {
            let digit = byte.wrapping_sub(b'0');
            if digit > 9 {
                break;
            }
            value = 10 * value + i64::from(digit);
            count += 1;
        }
        self.at += count;
        (1..=MOST_DIGITS).contains(&count).then_some(if negative { -value } else { value })
    }

    /// Where this line ends.
    fn find_end(&self) -> usize {
        let rest = &self.bytes[self.at..];
        self.at + rest.iter().position(|&b| b == b'\n' || b == b'\r').unwrap_or(rest.len())
    }

    /// To the next line; `None` where a backslash continues this one.
    #[inline]
    fn end_line(&mut self) -> Option<()> {
        if !matches!(self.peek(), b'\n' | b'\r') {
            self.at = self.find_end();
        }
        if self.at > 0 && self.bytes[self.at - 1] == b'\\' {
            return None;
        }
        self.at += 1;
        Some(())
    }
}

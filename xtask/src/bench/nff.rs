//! Eric Haines's Neutral File Format, as far as the Standard Procedural Databases use it, to be written anew for other renderers.
//!
//! After NFF.TXT, version 3.9. This is for files that are known to be good: what is not understood is an error and nothing more.

use super::vectors::Vector;

/// A scene.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Nff {
    /// As a display shows it.
    pub background: Vector,
    pub from: Vector,
    pub at: Vector,
    pub up: Vector,
    /// Degrees from the middle of the top row of pixels to that of the bottom row.
    pub angle: f64,
    /// Rows of pixels.
    pub rows: f64,
    /// Positions of lights, all of one intensity.
    pub lights: Vec<Vector>,
    /// What follows each fill.
    pub parts: Vec<Part>,
}

/// A fill and the shapes that have it.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Part {
    /// As a display shows it.
    pub color: Vector,
    pub diffuse: f64,
    pub specular: f64,
    pub shininess: f64,
    pub transmittance: f64,
    pub index: f64,
    pub shapes: Vec<Shape>,
}

/// A shape.
#[derive(Clone, Debug, PartialEq)]
pub enum Shape {
    Sphere {
        center: Vector,
        radius: f64,
    },
    /// Open at both ends; a cylinder where the radii are equal.
    Cone {
        base: Vector,
        base_radius: f64,
        apex: Vector,
        apex_radius: f64,
    },
    Polygon(Vec<Vector>),
    /// Corners with normals.
    Patch(Vec<(Vector, Vector)>),
}

impl Nff {
    /// Reads a whole file.
    pub fn parse(text: &str) -> Result<Self, String> {
        let mut words = Words(text.split_ascii_whitespace());
        let mut scene = Self::default();
        while let Some(word) = words.0.next() {
            match word {
                "b" => scene.background = words.vector()?,
                "v" => {}
                "from" => scene.from = words.vector()?,
                "at" => scene.at = words.vector()?,
                "up" => scene.up = words.vector()?,
                "angle" => scene.angle = words.number()?,
                "hither" => {
                    words.number()?;
                }
                "resolution" => {
                    words.number()?;
                    scene.rows = words.number()?;
                }
                "l" => scene.lights.push(words.vector()?),
                "f" => {
                    let color = words.vector()?;
                    let [diffuse, specular, shininess] = words.vector()?;
                    let [transmittance, index] = [words.number()?, words.number()?];
                    let shapes = Vec::new();
                    scene.parts.push(Part { color, diffuse, specular, shininess, transmittance, index, shapes });
                }
                _ => {
                    let shape = words.shape(word)?;
                    scene.parts.last_mut().ok_or("a shape before any fill")?.shapes.push(shape);
                }
            }
        }
        Ok(scene)
    }
}

/// The words that are left.
struct Words<'t>(std::str::SplitAsciiWhitespace<'t>);

impl Words<'_> {
    fn shape(&mut self, word: &str) -> Result<Shape, String> {
        Ok(match word {
            "s" => Shape::Sphere { center: self.vector()?, radius: self.number()? },
            "c" => Shape::Cone {
                base: self.vector()?,
                base_radius: self.number()?,
                apex: self.vector()?,
                apex_radius: self.number()?,
            },
            "p" => {
                let count = self.number()? as usize;
                Shape::Polygon((0..count).map(|_| self.vector()).collect::<Result<_, _>>()?)
            }
            "pp" => {
                let count = self.number()? as usize;
                Shape::Patch((0..count).map(|_| Ok((self.vector()?, self.vector()?))).collect::<Result<_, String>>()?)
            }
            _ => return Err(format!("`{word}` is none of NFF's words")),
        })
    }

    fn number(&mut self) -> Result<f64, String> {
        let word = self.0.next().ok_or("the file ends where a number should be")?;
        word.parse().map_err(|_| format!("`{word}` is no number"))
    }

    fn vector(&mut self) -> Result<Vector, String> {
        Ok([self.number()?, self.number()?, self.number()?])
    }
}

#[cfg(test)]
pub mod tests {
    use super::*;

    /// One of each.
    pub const EXAMPLE: &str = "b 0 0.5 1\nv\nfrom 0 0 5\nat 0 0 0\nup 0 1 0\nangle 45\nhither 1\nresolution 512 512\nl 5 5 5\n\
        f 1 0.5 0.2 0.8 0.2 10 0 1\ns 0 0 0 1\nc 0 0 0 1\n0 1 0 1\np 3\n0 0 0\n1 0 0\n0 1 0\n\
        f 1 1 1 0.2 0 100000 0.8 1.1\np 5\n0 0 0\n1 0 0\n1 1 0\n0.5 0.5 0\n0 1 0\npp 3\n0 0 0 0 0 1\n1 0 0 0 0 1\n0 1 0 0 0 1\n";

    #[test]
    fn every_entity_is_read() {
        let scene = Nff::parse(EXAMPLE).expect("it is good");
        assert_eq!((scene.angle, scene.rows, scene.lights.len(), scene.parts.len()), (45.0, 512.0, 1, 2));
        let [first, second] = scene.parts.as_slice() else { panic!("two parts") };
        assert_eq!(first.shapes[0], Shape::Sphere { center: [0.0; 3], radius: 1.0 });
        assert!(matches!(&first.shapes[1], Shape::Cone { apex, .. } if *apex == [0.0, 1.0, 0.0]));
        assert_eq!((second.transmittance, second.index), (0.8, 1.1));
        assert!(matches!(&second.shapes[1], Shape::Patch(corners) if corners.len() == 3));
    }

    #[test]
    fn what_is_not_understood_is_an_error() {
        for text in ["s 0 0 0 1", "f 1 1 1 1 0 1 0 1\nq", "b 1 2", "b 1 2 x"] {
            assert!(Nff::parse(text).is_err(), "{text}");
        }
    }
}

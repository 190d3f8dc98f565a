//! The colour of a compiled texture at a point. Points in texture space, see each pattern; colours scene-linear.

use snell_math::Rgb;
use snell_scene::Id;
use snell_scene::scene::Texture;

use super::checker;
use super::compile::{Node, Spaces, Textures};
use super::coordinates::TextureCoordinates;
use super::fractal;

impl Textures {
    /// The colour of a texture at a point of a surface: finite for finite and other coordinates.
    ///
    /// # Panics
    /// Where the id is not one of the table that was compiled.
    #[inline]
    #[must_use]
    pub fn evaluate(&self, id: Id<Texture>, at: &TextureCoordinates) -> Rgb {
        match self.nodes[id.index()] {
            Node::Constant(color) => color,
            _ => self.color(id.index() as u32, at),
        }
    }

    /// The colour of a texture that has the same everywhere: what [`Textures::evaluate`] gives for all coordinates.
    ///
    /// # Panics
    /// Where the id is not one of the table that was compiled.
    #[must_use]
    pub fn constant(&self, id: Id<Texture>) -> Option<Rgb> {
        match self.nodes[id.index()] {
            Node::Constant(color) => Some(color),
            _ => None,
        }
    }

    /// True where the colour is known to be the same everywhere.
    ///
    /// # Panics
    /// Where the id is not one of the table that was compiled.
    #[must_use]
    pub fn is_constant(&self, id: Id<Texture>) -> bool {
        self.constant(id).is_some()
    }

    /// Which coordinates a texture looks at.
    ///
    /// # Panics
    /// Where the id is not one of the table that was compiled.
    #[must_use]
    pub fn spaces(&self, id: Id<Texture>) -> Spaces {
        self.spaces[id.index()]
    }

    /// How many textures there are; their ids go from 0 to one below.
    #[must_use]
    pub fn len(&self) -> usize {
        self.nodes.len()
    }

    /// True where there are none.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.nodes.is_empty()
    }

    /// Calls itself for one of the two parts of noise, as deep as textures nest, which compilation has limited.
    fn color(&self, mut index: u32, at: &TextureCoordinates) -> Rgb {
        loop {
            match self.nodes[index as usize] {
                Node::Constant(color) => return color,
                Node::Checker { placement, cells } => {
                    let placement = &self.placements[placement as usize];
                    index = cells[checker::parity(placement.locate(at), placement.is_flat())];
                }
                Node::Image { placement, image, repeat, smooth } => {
                    let placement = &self.placements[placement as usize];
                    let point = placement.locate(at);
                    // Texture space has y up, pictures have it down.
                    let position = [point.x(), 1.0 - point.y()];
                    let footprint = placement.footprint(at).map(|side| [side.x(), -side.y()]);
                    return self.images[image as usize].color(position, repeat, smooth, footprint);
                }
                Node::Gradient { placement, ramp } => {
                    let point = self.placements[placement as usize].locate(at);
                    let placed = &self.ramps[ramp as usize];
                    return placed.ramp.color(point.to_vector().dot(placed.axis));
                }
                Node::Noise { placement, kind, first_octave, octaves, colors } => {
                    let point = self.placements[placement as usize].locate(at);
                    let octaves = &self.octaves[first_octave as usize..][..octaves as usize];
                    let weight = fractal::value(kind, octaves, point) as f32;
                    // At the ends one part alone counts, and the other need not be evaluated.
                    if weight <= 0.0 || weight >= 1.0 {
                        index = colors[usize::from(weight > 0.0)];
                        continue;
                    }
                    return self.color(colors[0], at).lerp(self.color(colors[1], at), weight);
                }
            }
        }
    }
}

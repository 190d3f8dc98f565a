//! From a scene's textures to flat tables: checked, folded where they are constant, ready to evaluate.

use std::sync::Arc;

use snell_math::{Rgb, Vector3};
use snell_scene::scene::texture::NoiseKind;
use snell_scene::scene::{ImageAsset, Pattern, Space, Texture};
use snell_scene::{Id, Table};

use super::fractal::{MAX_OCTAVES, Octave, octaves};
use super::image::TextureImage;
use super::placement::Placement;
use super::ramp::{Ramp, RampError};

/// How deep textures may nest: a constant is 1 deep, a checker of constants 2.
pub(super) const MAX_DEPTH: u32 = 32;

/// The most work one evaluation may be, counted in patterns and octaves of noise. Without a bound a chain of noises, each of
/// two parts that are both the one before, would double its work with every link.
pub(super) const MAX_COST: u64 = 1024;

/// All textures of a scene, addressed by their scene's ids. Never changed after [`Textures::compile`]; shared by all threads.
#[derive(Clone, Debug, Default)]
pub struct Textures {
    /// One for each texture of the scene, in its order.
    pub(super) nodes: Vec<Node>,
    /// For each of them, which coordinates it looks at.
    pub(super) spaces: Vec<Spaces>,
    pub(super) placements: Vec<Placement>,
    pub(super) images: Vec<Arc<TextureImage>>,
    pub(super) ramps: Vec<PlacedRamp>,
    pub(super) octaves: Vec<Octave>,
}

/// Which of the coordinates of a point a texture looks at: the others need not be worked out.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Spaces {
    /// Those of the object.
    pub object: bool,
    /// Those of the world.
    pub world: bool,
    /// Those of the surface.
    pub uv: bool,
    /// How much of the surface is seen at once.
    pub footprint: bool,
}

impl Spaces {
    /// What either looks at.
    #[must_use]
    pub fn union(self, other: Self) -> Self {
        Self {
            object: self.object | other.object,
            world: self.world | other.world,
            uv: self.uv | other.uv,
            footprint: self.footprint | other.footprint,
        }
    }
}

/// One texture; numbers are places in the tables of [`Textures`].
#[derive(Clone, Copy, Debug)]
pub(super) enum Node {
    Constant(Rgb),
    Checker { placement: u32, cells: [u32; 2] },
    Image { placement: u32, image: u32, repeat: bool, smooth: bool },
    Gradient { placement: u32, ramp: u32 },
    Noise { placement: u32, kind: NoiseKind, first_octave: u32, octaves: u32, colors: [u32; 2] },
}

/// A ramp along an axis of texture space.
#[derive(Clone, Debug)]
pub(super) struct PlacedRamp {
    /// Its product with a point is the position.
    pub axis: Vector3,
    pub ramp: Ramp,
}

/// What makes a texture impossible to evaluate. Ids are places in the scene's tables.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum TextureError {
    /// There is no such texture in the scene.
    #[error("texture {texture:?} refers to texture {refers_to:?}, but the scene has {count}")]
    UnknownTexture {
        /// Which texture refers to it.
        texture: Id<Texture>,
        /// What is not there.
        refers_to: Id<Texture>,
        /// How many there are.
        count: usize,
    },
    /// There is no such picture in the scene.
    #[error("texture {texture:?} refers to picture {image:?}, but the scene has {count}")]
    UnknownImage {
        /// Which texture refers to it.
        texture: Id<Texture>,
        /// What is not there.
        image: Id<ImageAsset>,
        /// How many there are.
        count: usize,
    },
    /// A texture is made of itself.
    #[error("texture {:?} is made of itself: {}", path[0], chain(path))]
    Cycle {
        /// The way round: each refers to the next, the last to the first.
        path: Vec<Id<Texture>>,
    },
    /// Textures nest too deep.
    #[error("texture {texture:?} nests other textures {depth} deep, more than the limit of {MAX_DEPTH}")]
    TooDeep {
        /// The outermost texture.
        texture: Id<Texture>,
        /// How deep it is.
        depth: u32,
    },
    /// One evaluation would take too long.
    #[error(
        "texture {texture:?} needs up to {cost} patterns and octaves of noise for one colour, more than the limit of \
         {MAX_COST}"
    )]
    TooCostly {
        /// Which texture.
        texture: Id<Texture>,
        /// How many it needs.
        cost: u64,
    },
    /// A colour is NaN or infinite.
    #[error("the colour of texture {texture:?} is not finite")]
    BadColor {
        /// Which texture.
        texture: Id<Texture>,
    },
    /// A gradient's axis has no length, one whose square is no number, or is not finite.
    #[error("the axis of gradient texture {texture:?} has no usable length")]
    BadAxis {
        /// Which texture.
        texture: Id<Texture>,
    },
    /// A gradient's stops make no ramp.
    #[error("gradient texture {texture:?}: {reason}")]
    BadGradient {
        /// Which texture.
        texture: Id<Texture>,
        /// What is wrong with them.
        reason: RampError,
    },
    /// Noise of no octaves, or of too many.
    #[error("noise texture {texture:?} has {octaves} octaves; it can have 1 to {MAX_OCTAVES}")]
    BadOctaves {
        /// Which texture.
        texture: Id<Texture>,
        /// How many.
        octaves: u32,
    },
}

impl TextureError {
    /// The texture to blame.
    pub fn texture(&self) -> Id<Texture> {
        match self {
            Self::Cycle { path } => path[0],
            Self::UnknownTexture { texture, .. }
            | Self::UnknownImage { texture, .. }
            | Self::TooDeep { texture, .. }
            | Self::TooCostly { texture, .. }
            | Self::BadColor { texture }
            | Self::BadAxis { texture }
            | Self::BadGradient { texture, .. }
            | Self::BadOctaves { texture, .. } => *texture,
        }
    }
}

/// The way round a cycle, in words: its beginning where it is long.
fn chain(path: &[Id<Texture>]) -> String {
    const SHOWN: usize = 8;
    let shown: Vec<String> = path.iter().take(SHOWN).map(|id| format!("{id:?}")).collect();
    let rest = if path.len() > SHOWN { " → …" } else { "" };
    format!("{}{rest} → {:?}", shown.join(" → "), path[0])
}

impl Textures {
    /// Compiles the textures of a scene. `images` are its pictures, decoded, in the order of its table of images.
    ///
    /// Folded to constants are: a checker or noise of equal constants, a gradient of one colour, a picture of one colour.
    ///
    /// # Errors
    /// [`TextureError`]: the first texture found that cannot be evaluated.
    pub fn compile(textures: &Table<Texture>, images: &[Arc<TextureImage>]) -> Result<Self, TextureError> {
        let order = children_first(textures)?;
        let mut compiled = Self {
            // Every place is written below, children before parents.
            nodes: vec![Node::Constant(Rgb::BLACK); textures.len()],
            spaces: vec![Spaces::default(); textures.len()],
            images: images.to_vec(),
            ..Self::default()
        };
        let mut limits = vec![Extent::default(); textures.len()];
        for id in order {
            let texture = &textures[id];
            limits[id.index()] = Extent::of(id, &texture.pattern, &limits)?;
            compiled.nodes[id.index()] = compiled.node(id, texture)?;
            compiled.spaces[id.index()] = compiled.spaces_of(id, texture);
        }
        Ok(compiled)
    }

    /// One texture whose parts are compiled already.
    fn node(&mut self, id: Id<Texture>, texture: &Texture) -> Result<Node, TextureError> {
        let node = match &texture.pattern {
            Pattern::Constant(color) if color.is_finite() => Node::Constant(*color),
            Pattern::Constant(_) => return Err(TextureError::BadColor { texture: id }),
            Pattern::Checker(cells) => match self.both_alike(cells) {
                Some(node) => node,
                None => Node::Checker { placement: self.place(texture), cells: cells.map(|c| c.index() as u32) },
            },
            Pattern::Image { image, repeat, smooth } => {
                let count = self.images.len();
                let picture = self.images.get(image.index()).ok_or(TextureError::UnknownImage {
                    texture: id,
                    image: *image,
                    count,
                })?;
                match picture.constant() {
                    Some(color) => Node::Constant(color),
                    None => Node::Image {
                        placement: self.place(texture),
                        image: image.index() as u32,
                        repeat: *repeat,
                        smooth: *smooth,
                    },
                }
            }
            Pattern::Gradient { axis, stops, repeat } => {
                let ramp =
                    Ramp::new(stops, *repeat).map_err(|reason| TextureError::BadGradient { texture: id, reason })?;
                let per_square = 1.0 / axis.length_squared();
                let axis = *axis * per_square;
                if !(per_square > 0.0 && axis.is_finite()) {
                    return Err(TextureError::BadAxis { texture: id });
                }
                match ramp.constant() {
                    Some(color) => Node::Constant(color),
                    None => {
                        self.ramps.push(PlacedRamp { axis, ramp });
                        Node::Gradient { placement: self.place(texture), ramp: self.ramps.len() as u32 - 1 }
                    }
                }
            }
            Pattern::Noise { colors, octaves: count, kind, seed } => {
                if !(1..=MAX_OCTAVES).contains(count) {
                    return Err(TextureError::BadOctaves { texture: id, octaves: *count });
                }
                match self.both_alike(colors) {
                    Some(node) => node,
                    None => {
                        let first_octave = self.octaves.len() as u32;
                        self.octaves.extend(octaves(*seed, *count));
                        Node::Noise {
                            placement: self.place(texture),
                            kind: *kind,
                            first_octave,
                            octaves: *count,
                            colors: colors.map(|c| c.index() as u32),
                        }
                    }
                }
            }
        };
        Ok(node)
    }

    /// Which coordinates a compiled texture looks at, whose parts are compiled already.
    fn spaces_of(&self, id: Id<Texture>, texture: &Texture) -> Spaces {
        if matches!(self.nodes[id.index()], Node::Constant(_)) {
            return Spaces::default();
        }
        let footprint = matches!(texture.pattern, Pattern::Image { .. });
        let own = match texture.mapping.space {
            Space::Object => Spaces { object: true, footprint, ..Spaces::default() },
            Space::World => Spaces { world: true, footprint, ..Spaces::default() },
            Space::Uv => Spaces { uv: true, footprint, ..Spaces::default() },
        };
        parts(&texture.pattern).fold(own, |spaces, part| spaces.union(self.spaces[part.index()]))
    }

    /// What two parts of a texture are, where they are surely the same.
    fn both_alike(&self, parts: &[Id<Texture>; 2]) -> Option<Node> {
        let [a, b] = parts.map(|part| self.nodes[part.index()]);
        match (a, b) {
            _ if parts[0] == parts[1] => Some(a),
            (Node::Constant(one), Node::Constant(other)) if one == other => Some(a),
            _ => None,
        }
    }

    fn place(&mut self, texture: &Texture) -> u32 {
        self.placements.push(Placement::new(&texture.mapping));
        self.placements.len() as u32 - 1
    }
}

/// How deep a texture nests and what one evaluation costs, before anything is folded.
#[derive(Clone, Copy, Debug, Default)]
struct Extent {
    depth: u32,
    cost: u64,
}

impl Extent {
    fn of(id: Id<Texture>, pattern: &Pattern, known: &[Self]) -> Result<Self, TextureError> {
        let parts = parts(pattern).map(|part| known[part.index()]);
        let depth = 1 + parts.clone().map(|part| part.depth).max().unwrap_or(0);
        let cost = match pattern {
            // More octaves than there can be are refused by their own name.
            Pattern::Noise { octaves, .. } => {
                u64::from(*octaves).min(u64::from(MAX_OCTAVES)) + parts.map(|part| part.cost).sum::<u64>()
            }
            _ => 1 + parts.map(|part| part.cost).max().unwrap_or(0),
        };
        if depth > MAX_DEPTH {
            return Err(TextureError::TooDeep { texture: id, depth });
        }
        if cost > MAX_COST {
            return Err(TextureError::TooCostly { texture: id, cost });
        }
        Ok(Self { depth, cost })
    }
}

/// The textures that a pattern is made of.
fn parts(pattern: &Pattern) -> impl Iterator<Item = Id<Texture>> + Clone {
    let parts: &[Id<Texture>] = match pattern {
        Pattern::Checker(parts) | Pattern::Noise { colors: parts, .. } => parts,
        Pattern::Constant(_) | Pattern::Image { .. } | Pattern::Gradient { .. } => &[],
    };
    parts.iter().copied()
}

/// All textures in an order in which each comes after those it is made of: depth-first search, on a stack of its own because
/// a chain of references can be as long as the table.
fn children_first(textures: &Table<Texture>) -> Result<Vec<Id<Texture>>, TextureError> {
    #[derive(Clone, Copy, PartialEq)]
    enum State {
        New,
        Open,
        Done,
    }
    let mut states = vec![State::New; textures.len()];
    let mut order = Vec::with_capacity(textures.len());
    for (root, _) in textures.enumerate() {
        if states[root.index()] != State::New {
            continue;
        }
        states[root.index()] = State::Open;
        // The way from the root to here; with each texture, how many of its parts were looked at.
        let mut way = vec![(root, 0)];
        while let Some((texture, looked_at)) = way.last_mut() {
            let texture = *texture;
            let Some(part) = parts(&textures[texture].pattern).nth(*looked_at) else {
                states[texture.index()] = State::Done;
                order.push(texture);
                way.pop();
                continue;
            };
            *looked_at += 1;
            match states.get(part.index()) {
                None => {
                    return Err(TextureError::UnknownTexture { texture, refers_to: part, count: textures.len() });
                }
                Some(State::New) => {
                    states[part.index()] = State::Open;
                    way.push((part, 0));
                }
                Some(State::Open) => {
                    let path = way.iter().map(|(id, _)| *id).skip_while(|id| *id != part).collect();
                    return Err(TextureError::Cycle { path });
                }
                Some(State::Done) => {}
            }
        }
    }
    Ok(order)
}

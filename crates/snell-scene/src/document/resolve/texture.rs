//! Textures and paints.

use snell_math::{Rgb, Transform, Vector3};

use super::Resolver;
use crate::diagnostic::{Diagnostic, Span};
use crate::document::model::{self, Either, Located, Named, NoiseForm, Paint, TextureSpace};
use crate::scene::texture::NoiseKind;
use crate::scene::{Mapping, Pattern, Space, Texture};
use crate::table::Id;

/// How deep textures may be made of textures: evaluating one recurses.
const MAX_DEPTH: usize = 32;

impl Resolver<'_> {
    /// All textures that have names, each after those it refers to.
    pub(super) fn named_textures(&mut self, named: &Named<model::Texture>) {
        let (needs, order) = self.in_order(named, "texture", "is made of itself", references);
        let mut depths = vec![0; named.0.len()];
        for i in order {
            let (name, texture) = &named.0[i];
            let below = needs[i].iter().map(|need| depths[*need]).max().unwrap_or(0);
            depths[i] = below + nesting(&texture.value);
            if depths[i] > MAX_DEPTH {
                let message = format!("the texture {:?} is made of textures more than {MAX_DEPTH} deep", name.value);
                self.error(&name.span, message, "too deep");
                depths[i] = 0;
            }
            let id = self.texture(&texture.value);
            self.textures.insert(name.value.clone(), id);
        }
    }

    /// The texture of a material's term.
    pub(super) fn term(&mut self, paint: &Located<Paint>) -> Id<Texture> {
        if let Either::B(texture) = &paint.value
            && nesting(texture) > MAX_DEPTH
        {
            let message = format!("textures stand more than {MAX_DEPTH} deep within each other");
            self.error(&paint.span, message, "too deep");
            return self.constant(Rgb::BLACK);
        }
        self.paint(&paint.value)
    }

    /// A paint's texture.
    fn paint(&mut self, paint: &Paint) -> Id<Texture> {
        match paint {
            Either::A(color) => self.constant(color.0),
            Either::B(texture) => self.texture(texture),
        }
    }

    /// A texture that is the same everywhere.
    pub(super) fn constant(&mut self, color: Rgb) -> Id<Texture> {
        self.scene.textures.push(Texture::constant(color))
    }

    fn texture(&mut self, texture: &model::Texture) -> Id<Texture> {
        self.refuse_light(texture);
        if let Some(name) = &texture.texture {
            self.refuse_placement(texture);
            // A name that is missing here was left out for its own mistakes.
            return self.textures.get(&name.0).copied().unwrap_or(Id::from_index(0));
        }
        let (pattern, size) = self.pattern(texture);
        let translate = texture.translate.as_ref().map(|translate| translate.value);
        let placement = self.placement(texture.scale.as_ref(), texture.rotate.as_ref(), translate);
        let space_from_texture = placement * Transform::scale(Vector3::new(size, size, size));
        let default_space = if texture.image.is_some() { TextureSpace::Uv } else { TextureSpace::Object };
        let space = match texture.space.as_ref().map_or(default_space, |space| space.value) {
            TextureSpace::Object => Space::Object,
            TextureSpace::World => Space::World,
            TextureSpace::Uv => Space::Uv,
        };
        let mapping = Mapping { space, texture_from_space: space_from_texture.inverse() };
        self.scene.textures.push(Texture { pattern, mapping })
    }

    /// The pattern, and the size of its unit.
    fn pattern(&mut self, texture: &model::Texture) -> (Pattern, f64) {
        if let Some(checker) = &texture.checker {
            let [a, b] = &checker.colors;
            (Pattern::Checker([self.paint(a), self.paint(b)]), checker.size)
        } else if let Some(image) = &texture.image {
            (Pattern::Image { image: self.image(&image.file), repeat: image.repeat, smooth: image.smooth }, 1.0)
        } else if let Some(gradient) = &texture.gradient {
            (self.gradient(gradient), 1.0)
        } else if let Some(noise) = &texture.noise {
            let [a, b] = &noise.colors;
            let colors = [self.paint(a), self.paint(b)];
            let kind = match noise.form {
                NoiseForm::Smooth => NoiseKind::Smooth,
                NoiseForm::Turbulence => NoiseKind::Turbulence,
                NoiseForm::Marble => NoiseKind::Marble,
                NoiseForm::Wood => NoiseKind::Wood,
            };
            (Pattern::Noise { colors, octaves: noise.octaves, kind, seed: noise.seed }, noise.size)
        } else {
            (Pattern::Constant(Rgb::BLACK), 1.0)
        }
    }

    fn gradient(&mut self, gradient: &model::GradientPattern) -> Pattern {
        self.direction(&gradient.axis, "the gradient's axis", Vector3::Y);
        let stops = match &gradient.stops {
            Some(stops) => {
                let stops: Vec<_> = stops.iter().map(|stop| (stop.value.at, stop.value.color.0, &stop.span)).collect();
                self.stops(&stops)
            }
            None => {
                let [a, b] = gradient.colors.map_or([Rgb::BLACK, Rgb::WHITE], |colors| colors.map(|color| color.0));
                vec![(0.0, a), (1.0, b)]
            }
        };
        Pattern::Gradient { axis: gradient.axis.value.into(), stops, repeat: gradient.repeat }
    }

    /// A texture named by another lies where its own definition says.
    fn refuse_placement(&mut self, texture: &model::Texture) {
        for (key, span) in placements(texture) {
            let message = format!("`{key}` has no effect beside the name of a texture");
            let diagnostic = Diagnostic::error(message).at_optional(span.clone(), "not possible here");
            self.diagnostics.push(diagnostic.help("place the texture where it is defined"));
        }
    }
}

/// What says how a texture lies, by its keys.
pub(super) fn placements(texture: &model::Texture) -> impl Iterator<Item = (&'static str, &Option<Span>)> {
    let spans = [
        ("space", texture.space.as_ref().map(|space| &space.span)),
        ("translate", texture.translate.as_ref().map(|translate| &translate.span)),
        ("rotate", texture.rotate.as_ref().map(|rotate| &rotate.span)),
        ("scale", texture.scale.as_ref().map(|scale| &scale.span)),
    ];
    spans.into_iter().filter_map(|(key, span)| Some((key, span?)))
}

/// The paints of which a texture is made.
fn parts(texture: &model::Texture) -> impl Iterator<Item = &model::Texture> {
    let checker = texture.checker.iter().flat_map(|checker| &checker.colors);
    let noise = texture.noise.iter().flat_map(|noise| &noise.colors);
    checker.chain(noise).filter_map(|paint| match paint {
        Either::A(_) => None,
        Either::B(texture) => Some(&**texture),
    })
}

/// The names of the textures that a texture refers to.
fn references<'a>(texture: &'a model::Texture, names: &mut Vec<&'a str>) {
    names.extend(texture.texture.iter().map(|name| &*name.0));
    parts(texture).for_each(|part| references(part, names));
}

/// How many textures stand within each other in the file.
fn nesting(texture: &model::Texture) -> usize {
    1 + parts(texture).map(nesting).max().unwrap_or(0)
}

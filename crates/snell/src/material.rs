//! Materials: from the scene's description, with textures, to a small value at each hit.
//!
//! A [`Bsdf`] is a sum of lobes, each absent where its coefficient is black. It is plain data: it is made by value at a hit
//! and asks nothing of the heap. Its lobes are of two kinds, as the lecture's `shade` has them: those summed over lights
//! (diffuse, highlight) and those that spawn rays (mirror, interface).

use snell_math::lanes::{Bits, Floats, LaneColor, LaneVector, Lanes, WIDTH, power_to_f32};
use snell_math::spectrum::Spectrum;
use snell_math::{Rgb, Vector3};
use snell_scene::Id;
use snell_scene::scene;

use crate::interaction::SurfaceInteraction;
use crate::optics::Metal;
use crate::texture::{Footprint, LaneCoordinates, Spaces, TextureCoordinates, Textures};

/// What a surface does with light at one point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bsdf {
    /// Light given off.
    pub emission: Rgb,
    /// The factor on ambient light.
    pub ambient: Rgb,
    /// Lambert's reflectance.
    pub diffuse: Rgb,
    /// The highlight's strength.
    pub specular: Rgb,
    /// The highlight's exponent.
    pub shininess: f32,
    /// The coefficient of the mirrored ray.
    pub mirror: Rgb,
    /// The boundary of a transparent body.
    pub interface: Option<Interface>,
    /// Lit from the outward side alone.
    pub one_sided: bool,
}

/// How the boundary of a transparent body shares light between reflection and refraction.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Interface {
    /// The shares follow Fresnel's equations, scaled by the coefficients; or else are the coefficients.
    pub fresnel: bool,
    /// The reflected ray's coefficient.
    pub reflect: Rgb,
    /// The refracted ray's coefficient.
    pub transmit: Rgb,
}

/// What one light adds, before it is known how much of it is blocked.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LocalReflection {
    /// By the diffuse lobe.
    pub diffuse: Rgb,
    /// By the highlight.
    pub specular: Rgb,
}

impl Bsdf {
    const BLACK: Self = Self {
        emission: Rgb::BLACK,
        ambient: Rgb::BLACK,
        diffuse: Rgb::BLACK,
        specular: Rgb::BLACK,
        shininess: 0.0,
        mirror: Rgb::BLACK,
        interface: None,
        one_sided: false,
    };

    /// True where lights matter.
    #[inline]
    pub fn is_lit(&self) -> bool {
        !(self.diffuse.is_black() && self.specular.is_black())
    }

    /// The lobes summed over lights, per unit of irradiance on a surface that faces the light, see [`LaneBsdf::reflect_light`].
    #[inline]
    pub fn reflect_light(&self, normal: Vector3, wo: Vector3, wi: Vector3) -> LocalReflection {
        let [diffuse, specular] = LaneBsdf::<f64>::splat(self).reflect_light(normal.into(), wo.into(), wi.into());
        let color = |lane: LaneColor<f32>| Rgb::new(lane.r, lane.g, lane.b);
        LocalReflection { diffuse: color(diffuse), specular: color(specular) }
    }
}

/// What surfaces of one material do with light, side by side. The fields are those of [`Bsdf`].
#[derive(Clone, Copy, Debug)]
pub struct LaneBsdf<L: Lanes> {
    /// See [`Bsdf::emission`].
    pub emission: LaneColor<L::Floats>,
    /// See [`Bsdf::ambient`].
    pub ambient: LaneColor<L::Floats>,
    /// See [`Bsdf::diffuse`].
    pub diffuse: LaneColor<L::Floats>,
    /// See [`Bsdf::specular`].
    pub specular: LaneColor<L::Floats>,
    /// See [`Bsdf::mirror`].
    pub mirror: LaneColor<L::Floats>,
    /// See [`Interface::reflect`]; black without an interface.
    pub reflect: LaneColor<L::Floats>,
    /// See [`Interface::transmit`]; black without an interface.
    pub transmit: LaneColor<L::Floats>,
    /// See [`Bsdf::shininess`].
    pub shininess: f32,
    /// See [`Interface::fresnel`]; `None` without an interface.
    pub fresnel: Option<bool>,
    /// See [`Bsdf::one_sided`].
    pub one_sided: bool,
}

impl<L: Lanes> LaneBsdf<L> {
    /// The same in all lanes.
    #[inline(always)]
    pub fn splat(bsdf: &Bsdf) -> Self {
        let (reflect, transmit) = bsdf.interface.map_or((Rgb::BLACK, Rgb::BLACK), |i| (i.reflect, i.transmit));
        Self {
            emission: LaneColor::splat(bsdf.emission),
            ambient: LaneColor::splat(bsdf.ambient),
            diffuse: LaneColor::splat(bsdf.diffuse),
            specular: LaneColor::splat(bsdf.specular),
            mirror: LaneColor::splat(bsdf.mirror),
            reflect: LaneColor::splat(reflect),
            transmit: LaneColor::splat(transmit),
            shininess: bsdf.shininess,
            fresnel: bsdf.interface.map(|interface| interface.fresnel),
            one_sided: bsdf.one_sided,
        }
    }

    /// The same material at places whose colours differ; `bsdfs` are those of some lanes, and there are some.
    #[inline(always)]
    pub fn gather(bsdfs: impl Iterator<Item = (usize, Bsdf)>) -> Self {
        let mut rows = [[[0.0_f32; WIDTH]; 3]; 7];
        let mut last = Bsdf::BLACK;
        for (lane, bsdf) in bsdfs {
            let (reflect, transmit) = bsdf.interface.map_or((Rgb::BLACK, Rgb::BLACK), |i| (i.reflect, i.transmit));
            let colors = [bsdf.emission, bsdf.ambient, bsdf.diffuse, bsdf.specular, bsdf.mirror, reflect, transmit];
            for (rows, color) in rows.iter_mut().zip(colors) {
                for (row, component) in rows.iter_mut().zip(color.to_array()) {
                    row[lane] = component;
                }
            }
            last = bsdf;
        }
        let [emission, ambient, diffuse, specular, mirror, reflect, transmit] = &rows;
        Self {
            emission: LaneColor::load(emission, 0),
            ambient: LaneColor::load(ambient, 0),
            diffuse: LaneColor::load(diffuse, 0),
            specular: LaneColor::load(specular, 0),
            mirror: LaneColor::load(mirror, 0),
            reflect: LaneColor::load(reflect, 0),
            transmit: LaneColor::load(transmit, 0),
            ..Self::splat(&last)
        }
    }

    /// What it is in one lane.
    pub fn lane(&self, lane: usize) -> Bsdf {
        let Self { emission, ambient, diffuse, specular, mirror, reflect, transmit, .. } = *self;
        let [emission, ambient, diffuse, specular, mirror, reflect, transmit] =
            [emission, ambient, diffuse, specular, mirror, reflect, transmit].map(|color| {
                let mut rows = [[0.0; WIDTH]; 3];
                color.store(&mut rows, 0);
                Rgb::from(rows.map(|row| row[lane]))
            });
        let interface = self.fresnel.map(|fresnel| Interface { fresnel, reflect, transmit });
        let Self { shininess, one_sided, .. } = *self;
        Bsdf { emission, ambient, diffuse, specular, shininess, mirror, interface, one_sided }
    }

    /// The lanes where lights matter.
    #[inline(always)]
    pub fn is_lit(&self) -> Bits {
        L::all().without(self.diffuse.is_black() & self.specular.is_black())
    }

    /// The lobes summed over lights, the diffuse one and the highlight, per unit of irradiance on a surface that faces the
    /// light, with the cosine: Lambert's k_d (N·L) and Phong's k_s (R·L)^n, R the mirrored `wo` (Phong 1975). The reflectances
    /// are the lecture's: a white surface facing a light of intensity one is one.
    ///
    /// `wo` leads to the viewer and `wi` to the light, both leaving the surface; `normal` is on the viewer's side. All unit.
    #[inline(always)]
    pub fn reflect_light(
        &self,
        normal: LaneVector<L>,
        wo: LaneVector<L>,
        wi: LaneVector<L>,
    ) -> [LaneColor<L::Floats>; 2] {
        let black = LaneColor::splat(Rgb::BLACK);
        let cosine = normal.dot(wi);
        let facing = L::all().without(cosine.le(L::splat(0.0)));
        let shiny = facing.without(self.specular.is_black());
        let specular = if shiny.is_empty() {
            black
        } else {
            let mirrored = normal * (L::splat(2.0) * normal.dot(wo)) - wo;
            (self.specular * highlight::<L>(mirrored.dot(wi), self.shininess, shiny)).or_where_not(shiny, black)
        };
        [(self.diffuse * cosine.to_floats()).or_where_not(facing, black), specular]
    }
}

/// The cosine to the power of the exponent, clipped at 0, in the lanes that are asked for.
#[inline(always)]
fn highlight<L: Lanes>(cosine: L, shininess: f32, asked: Bits) -> L::Floats {
    let exponent = L::splat(f64::from(shininess));
    // Beyond this the result is no f32 but zero; the logarithm is by far the dearest part of a small scene's shading.
    let vanishing = (exponent * (L::splat(1.0) - cosine)).gt(L::splat(104.0));
    let visible = asked.without(cosine.le(L::splat(0.0)) | vanishing);
    if visible.is_empty() {
        return Floats::splat(0.0);
    }
    power_to_f32(L::splat(1.0).smaller(cosine), f64::from(shininess), visible)
}

/// A material, ready to be evaluated.
#[derive(Clone, Debug)]
pub struct Material {
    /// All lobes with their constant colours; those in `textured` are filled in at the hit.
    base: Bsdf,
    textured: Vec<(Slot, Id<scene::Texture>)>,
    emission_spectrum: Option<Spectrum>,
    /// All of those can be evaluated side by side.
    is_plain: bool,
    /// The inside of the body, where it is transparent.
    pub body: Option<Body>,
    /// The metal that it is.
    pub metal: Option<MetalSurface>,
}

/// The surface of a metal.
#[derive(Clone, Debug)]
pub struct MetalSurface {
    /// Which metal.
    pub metal: Metal,
    /// How rough it is, from 0 to 1.
    pub roughness: f32,
    /// A thin film on it.
    pub film: Option<scene::Film>,
}

/// The inside of a transparent body.
#[derive(Clone, Debug)]
pub struct Body {
    /// Its index of refraction.
    pub ior: snell_math::Dispersion,
    /// What paths take for it, where that is another.
    pub measured_ior: Option<snell_math::Dispersion>,
    /// What light meets inside.
    pub medium: scene::Medium,
    /// What it absorbs at each wavelength, where that was measured.
    pub extinction: Option<scene::Extinction>,
    /// Which body wins where several overlap.
    pub priority: i32,
    /// How rough its boundary is, from 0 to 1.
    pub roughness: f32,
    /// A thin film on it.
    pub film: Option<scene::Film>,
}

impl Body {
    /// Its index of refraction for paths.
    pub fn path_ior(&self) -> &snell_math::Dispersion {
        self.measured_ior.as_ref().unwrap_or(&self.ior)
    }

    /// False where its boundary does nothing to light that comes from the world around: of the same index at all wavelengths, without a
    /// film.
    pub fn bends_light(&self) -> bool {
        self.film.is_some() || self.ior != snell_math::Dispersion::Constant(1.0)
    }
}

/// A colour of a material that a texture may give.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Slot {
    Emission,
    Ambient,
    Diffuse,
    Specular,
    Mirror,
    Reflect,
    Transmit,
}

impl Material {
    /// From the scene's material; constant textures are folded in.
    pub fn new(material: &scene::Material, textures: &Textures) -> Self {
        let mut compiled = Self {
            base: Bsdf { shininess: material.shininess, one_sided: material.one_sided, ..Bsdf::BLACK },
            textured: Vec::new(),
            emission_spectrum: material.emission_spectrum.clone(),
            is_plain: false,
            body: None,
            metal: material.metal.as_ref().map(|metal| MetalSurface {
                metal: Metal::new(metal.index),
                roughness: metal.roughness,
                film: metal.film.clone(),
            }),
        };
        if let Some(metal) = &compiled.metal {
            compiled.base = metal_bsdf(metal, &compiled.base);
        }
        if let Some(dielectric) = &material.dielectric {
            compiled.base.interface =
                Some(Interface { fresnel: dielectric.fresnel, reflect: Rgb::BLACK, transmit: Rgb::BLACK });
            compiled.body = Some(Body {
                ior: dielectric.ior.clone(),
                measured_ior: dielectric.measured_ior.clone(),
                medium: dielectric.medium,
                extinction: dielectric.extinction.clone(),
                priority: dielectric.priority,
                roughness: dielectric.roughness,
                film: dielectric.film.clone(),
            });
            compiled.fill(Slot::Reflect, dielectric.reflect, textures);
            compiled.fill(Slot::Transmit, dielectric.transmit, textures);
        }
        let slots = [
            (Slot::Emission, material.emission),
            (Slot::Ambient, material.ambient.or(material.diffuse)),
            (Slot::Diffuse, material.diffuse),
            (Slot::Specular, material.specular),
            (Slot::Mirror, material.mirror),
        ];
        for (slot, texture) in slots {
            if let Some(texture) = texture {
                compiled.fill(slot, texture, textures);
            }
        }
        compiled.is_plain = compiled.textured.iter().all(|&(_, texture)| textures.plain_checker(texture).is_some());
        compiled
    }

    /// What an object without a material has: a light grey, matt surface, reflectance 0.8.
    pub fn unspecified() -> Self {
        let gray = Rgb::gray(0.8);
        Self {
            base: Bsdf { ambient: gray, diffuse: gray, ..Bsdf::BLACK },
            textured: Vec::new(),
            emission_spectrum: None,
            is_plain: true,
            body: None,
            metal: None,
        }
    }

    /// Which coordinates of a hit matter.
    pub fn spaces(&self, textures: &Textures) -> Spaces {
        let of_film = self.film().and_then(|film| film.variation).map(|variation| variation.by);
        let all = self.textured.iter().map(|&(_, texture)| texture).chain(of_film);
        all.fold(Spaces::default(), |all, texture| all.union(textures.spaces(texture)))
    }

    /// The film on it.
    pub fn film(&self) -> Option<&scene::Film> {
        match (&self.body, &self.metal) {
            (Some(body), _) => body.film.as_ref(),
            (None, Some(metal)) => metal.film.as_ref(),
            (None, None) => None,
        }
    }

    /// How thick the film is at a hit, averaged over a footprint around it, in nanometres; 0 without one.
    pub fn film_thickness(&self, textures: &Textures, interaction: &SurfaceInteraction, footprint: &Footprint) -> f64 {
        let Some(scene::Film { thickness_nm, variation, .. }) = self.film() else { return 0.0 };
        let Some(scene::FilmVariation { to_nm, by }) = variation else { return *thickness_nm };
        let share = f64::from(textures.evaluate(*by, &coordinates(interaction, footprint)).mean()).clamp(0.0, 1.0);
        thickness_nm * (1.0 - share) + to_nm * share
    }

    /// True where it gives off light, somewhere at least.
    pub fn emits(&self) -> bool {
        !self.base.emission.is_black() || self.textured.iter().any(|(slot, _)| *slot == Slot::Emission)
    }

    /// True where lights matter, somewhere at least.
    pub fn is_lit(&self) -> bool {
        let is_textured = |(slot, _): &(Slot, _)| matches!(slot, Slot::Diffuse | Slot::Specular);
        let is_rough = self.body.as_ref().is_some_and(|body| body.roughness > 0.0);
        is_rough || self.base.is_lit() || self.textured.iter().any(is_textured)
    }

    /// True where it mirrors or bends light, somewhere at least.
    pub fn is_specular(&self) -> bool {
        let bends = self.body.as_ref().is_some_and(|body| body.roughness == 0.0 && body.bends_light());
        if let Some(metal) = &self.metal {
            return metal.roughness == 0.0;
        }
        bends || !self.base.mirror.is_black() || self.textured.iter().any(|(slot, _)| *slot == Slot::Mirror)
    }

    /// The spectrum of its light, where the scene gives one.
    pub fn emission_spectrum(&self) -> Option<&Spectrum> {
        self.emission_spectrum.as_ref()
    }

    /// True where rays go on from it in single directions: it mirrors, somewhere at least, or is the boundary of a body.
    pub fn sends_rays(&self) -> bool {
        let is_mirror = !self.base.mirror.is_black() || self.textured.iter().any(|(slot, _)| *slot == Slot::Mirror);
        is_mirror || self.metal.is_some() || self.body.is_some()
    }

    /// Its light, where it is the same everywhere.
    pub fn constant_emission(&self) -> Option<Rgb> {
        let is_textured = self.textured.iter().any(|(slot, _)| *slot == Slot::Emission);
        (!is_textured).then_some(self.base.emission)
    }

    /// True where it is lit and shines on its outward side alone.
    pub fn is_one_sided(&self) -> bool {
        self.base.one_sided
    }

    /// The lobes, where they are the same at all hits without a vertex colour.
    #[inline]
    pub fn constant_bsdf(&self) -> Option<&Bsdf> {
        self.textured.is_empty().then_some(&self.base)
    }

    /// True where the lobes can be had side by side at hits whose objects stand in the world as they are.
    #[inline]
    pub fn is_plain(&self) -> bool {
        self.is_plain
    }

    /// The lobes at such hits, of a material that [is plain](Material::is_plain): as [`Material::bsdf`] gives them one by one.
    #[inline(always)]
    pub fn lane_bsdf<L: Lanes>(&self, textures: &Textures, at: &LaneCoordinates<L>) -> LaneBsdf<L> {
        let mut bsdf = LaneBsdf::splat(&self.base);
        let mut before = None;
        for &(slot, texture) in &self.textured {
            let color = match before {
                Some((same, color)) if same == texture => color,
                _ => match textures.plain_checker(texture) {
                    Some(checker) => checker.evaluate(at),
                    None => continue,
                },
            };
            match slot {
                Slot::Emission => bsdf.emission = color,
                Slot::Ambient => bsdf.ambient = color,
                Slot::Diffuse => bsdf.diffuse = color,
                Slot::Specular => bsdf.specular = color,
                Slot::Mirror => bsdf.mirror = color,
                Slot::Reflect => bsdf.reflect = color,
                Slot::Transmit => bsdf.transmit = color,
            }
            before = Some((texture, color));
        }
        bsdf
    }

    /// The lobes at a hit, averaged over a footprint around it where they are pictures.
    #[inline]
    pub fn bsdf(&self, textures: &Textures, interaction: &SurfaceInteraction, footprint: &Footprint) -> Bsdf {
        let mut bsdf = self.base;
        if !self.textured.is_empty() {
            let coordinates = coordinates(interaction, footprint);
            let mut before = None;
            for &(slot, texture) in &self.textured {
                // The ambient colour is most often the diffuse one.
                let color = match before {
                    Some((same, color)) if same == texture => color,
                    _ => textures.evaluate(texture, &coordinates),
                };
                *slot_of(&mut bsdf, slot) = color;
                before = Some((texture, color));
            }
        }
        if let Some(color) = interaction.vertex_color {
            bsdf.diffuse *= color;
            bsdf.ambient *= color;
        }
        bsdf
    }

    fn fill(&mut self, slot: Slot, texture: Id<scene::Texture>, textures: &Textures) {
        match textures.constant(texture) {
            Some(color) => *slot_of(&mut self.base, slot) = color,
            None => self.textured.push((slot, texture)),
        }
    }
}

/// Where textures are asked at a hit.
#[inline]
fn coordinates(interaction: &SurfaceInteraction, footprint: &Footprint) -> TextureCoordinates {
    TextureCoordinates {
        object_point: interaction.object_point,
        object_inside: interaction.object_inside,
        world_point: interaction.point,
        world_inside: interaction.inside(),
        uv: interaction.uv,
        footprint: *footprint,
    }
}

/// A metal as the lecture's terms show it: smooth, a mirror of its colour; the rougher, the more a highlight and the less a mirror.
fn metal_bsdf(metal: &MetalSurface, base: &Bsdf) -> Bsdf {
    let color = metal.metal.color();
    if metal.roughness == 0.0 {
        return Bsdf { mirror: color, ..*base };
    }
    let alpha = metal.roughness * metal.roughness;
    let shininess = (2.0 / (alpha * alpha) - 2.0).clamp(0.0, 1e6);
    let matt = color * (0.5 * alpha);
    Bsdf { mirror: color * (1.0 - metal.roughness), specular: color, shininess, diffuse: matt, ambient: matt, ..*base }
}

#[inline]
fn slot_of(bsdf: &mut Bsdf, slot: Slot) -> &mut Rgb {
    match (slot, &mut bsdf.interface) {
        (Slot::Emission, _) => &mut bsdf.emission,
        (Slot::Ambient, _) => &mut bsdf.ambient,
        (Slot::Diffuse, _) => &mut bsdf.diffuse,
        (Slot::Specular, _) => &mut bsdf.specular,
        (Slot::Reflect, Some(interface)) => &mut interface.reflect,
        (Slot::Transmit, Some(interface)) => &mut interface.transmit,
        // Reflect and Transmit are only filled where there is an interface, so these are the mirror's.
        (Slot::Mirror | Slot::Reflect | Slot::Transmit, _) => &mut bsdf.mirror,
    }
}

#[cfg(test)]
mod tests {
    use snell_math::portable;

    use super::*;

    #[test]
    fn light_is_reflected_as_the_lecture_says() {
        let bsdf = Bsdf { diffuse: Rgb::gray(0.5), specular: Rgb::gray(0.25), shininess: 2.0, ..Bsdf::BLACK };
        let normal = Vector3::Y;
        let wo = Vector3::new(1.0, 1.0, 0.0).normalize();
        let mirrored = Vector3::new(-1.0, 1.0, 0.0).normalize();
        let both = bsdf.reflect_light(normal, wo, mirrored);
        assert!((both.diffuse.r - 0.5 * 0.5_f32.sqrt()).abs() < 1e-7);
        assert!((both.specular.r - 0.25).abs() < 1e-7);
        let straight = bsdf.reflect_light(normal, wo, normal);
        assert!((straight.specular.r - 0.125).abs() < 1e-7, "(R.L)^2 = cos^2 45 degrees");
        let below = bsdf.reflect_light(normal, wo, -normal);
        assert!(below.diffuse.is_black() && below.specular.is_black());
    }

    #[test]
    fn an_early_zero_of_the_highlight_is_a_true_one() {
        for shininess in [0.0_f32, 1.0, 10.0, 1000.0, 1e6] {
            for step in 0..=1000 {
                let cosine = f64::from(step) / 1000.0;
                let exact = portable::pow(cosine, f64::from(shininess)) as f32;
                let quick = highlight::<f64>(cosine, shininess, Bits::first(1));
                assert!(quick == exact || cosine == 0.0, "{cosine}^{shininess}: {quick} and {exact}");
            }
        }
    }
}

//! The scene's materials, ready for wavelengths.

use snell_math::dispersion::fraunhofer::SODIUM_D;
use snell_math::microfacet::{ConductorCompensation, DielectricCompensation, Ggx};
use snell_math::{Dispersion, Ray};
use snell_scene::scene::Film;

use super::lobes::{BoundaryColors, SurfaceColors};
use super::reflector::{Reflector, film_at};
use super::rough::{Rough, RoughKind};
use super::spectra::{BodySpectra, Colors, Reflectance, Spectral, WHITE};
use crate::compile::CompiledScene;
use crate::geometry::Geometry;
use crate::interaction::SurfaceInteraction;
use crate::material::{Bsdf, Material};
use crate::optics::{Metal, fresnel_dielectric};
use crate::task::{Crossing, Inside, MediumStack, MediumStacks};

/// With at most so many other bodies a rough one has tables of its own for what bounces on its surface more than once.
const MOST_NEIGHBOURS: usize = 8;

/// One for each material of the scene.
#[derive(Debug)]
pub struct PathMaterials {
    materials: Vec<PathMaterial>,
    /// The index of refraction of each body; of the others one.
    indices: Vec<Dispersion>,
    some_pass: bool,
}

#[derive(Debug)]
struct PathMaterial {
    /// Where colours are the same everywhere: diffuse, specular, mirror, reflect, transmit.
    constant: Option<[Reflectance; 5]>,
    body: Option<BodySpectra>,
    /// What the boundary lets through where it does nothing else: where it bends nothing, Fresnel's equations say, it reflects nothing.
    clear: Option<Reflectance>,
    film: Option<Film>,
    metal: Option<(Metal, Option<(Ggx, ConductorCompensation)>)>,
    rough: Option<RoughBoundary>,
}

/// A rough boundary of a transparent body.
#[derive(Debug)]
struct RoughBoundary {
    ggx: Ggx,
    /// By what is on the other side: a material, or nothing.
    compensations: Vec<(Option<u32>, DielectricCompensation)>,
}

/// What the boundary of a body is to light that comes to it.
#[derive(Clone, Copy, Debug)]
pub enum Boundary {
    /// Light goes straight on: where another body covers it, or nothing is bent.
    Passed {
        /// The share that goes on.
        share: Spectral,
        /// The bodies behind it.
        media: MediumStack,
    },
    /// Light is reflected and refracted.
    Met(Crossing),
}

/// Where and how a path meets a surface.
#[derive(Clone, Copy, Debug)]
pub struct Meeting {
    /// The bodies at the boundary of one, that of the viewer first.
    pub sides: Option<[Option<Inside>; 2]>,
    /// The body that the viewer is in.
    pub around: Option<Inside>,
    /// The mesh has a colour of its own there.
    pub is_tinted: bool,
    /// How thick the film there is, in nanometres.
    pub film_nm: f64,
    /// The wavelengths.
    pub nm: Spectral,
    /// All wavelengths but the hero have been given up.
    pub hero_alone: bool,
}

impl PathMaterials {
    /// Those of a scene.
    pub fn new(scene: &CompiledScene) -> Self {
        let indices: Vec<Dispersion> = scene
            .materials
            .iter()
            .map(|material| material.body.as_ref().map_or(Dispersion::Constant(1.0), |body| body.path_ior().clone()))
            .collect();
        let bodies: Vec<u32> =
            (0..).zip(&scene.materials).filter(|(_, material)| material.body.is_some()).map(|(i, _)| i).collect();
        let materials = (0..).zip(&scene.materials).map(|(number, material)| PathMaterial {
            constant: material.constant_bsdf().map(|bsdf| colors_of(bsdf).map(Reflectance::new)),
            body: material.body.as_ref().and_then(|body| BodySpectra::new(&body.medium, body.extinction.as_ref())),
            clear: clear(material),
            film: material.film().cloned(),
            metal: material.metal.as_ref().map(|metal| {
                let rough = ggx(metal.roughness).map(|ggx| (ggx, ConductorCompensation::new(ggx)));
                (metal.metal.clone(), rough)
            }),
            rough: rough_boundary(number, material, &indices, &bodies),
        });
        let materials: Vec<PathMaterial> = materials.collect();
        let some_pass = bodies.iter().any(|&body| materials[body as usize].clear.is_some());
        Self { materials, indices, some_pass }
    }

    /// The inside of a body; `None` where light passes unchanged.
    pub fn body(&self, material: u32) -> Option<&BodySpectra> {
        self.materials[material as usize].body.as_ref()
    }

    /// True where the boundary of some body may let light pass straight on: of one with the index of what is around.
    pub fn some_pass(&self) -> bool {
        self.some_pass
    }

    /// What light of a ray in some bodies meets at a surface; `None` where the surface is no body's.
    pub fn boundary(
        &self,
        scene: &CompiledScene,
        stacks: &mut MediumStacks,
        media: MediumStack,
        ray: &Ray,
        interaction: &SurfaceInteraction,
        nm: Spectral,
    ) -> Option<Boundary> {
        let SurfaceInteraction { material, solid, t, .. } = *interaction;
        let priority = scene.materials[material as usize].body.as_ref()?.priority;
        let leaving = interaction.is_outward(ray.direction);
        let inside = Inside { solid, material, priority };
        let crossing = stacks.cross(media, inside, leaving, Geometry::is_at_origin(ray, t));
        let share = if crossing.is_without_effect() {
            Some(WHITE)
        } else {
            self.straight(material, [crossing.before, crossing.beyond], nm)
        };
        Some(share.map_or(Boundary::Met(crossing), |share| Boundary::Passed { share, media: crossing.after }))
    }

    /// What the boundary of a material between two bodies lets through straight on; `None` where it bends light.
    fn straight(&self, material: u32, sides: [Option<Inside>; 2], nm: Spectral) -> Option<Spectral> {
        let clear = self.materials[material as usize].clear?;
        let [before, beyond] = self.indices(sides, nm);
        (before == beyond).then(|| clear.at(nm))
    }

    /// The indices of refraction on both sides of a boundary.
    fn indices(&self, sides: [Option<Inside>; 2], nm: Spectral) -> [Spectral; 2] {
        sides.map(|side| match side {
            None => WHITE,
            Some(inside) => match &self.indices[inside.material as usize] {
                Dispersion::Constant(index) => [*index; 4],
                dispersive => nm.map(|nm| dispersive.index(nm)),
            },
        })
    }

    /// The colours of a surface whose lobes are known as colours, at wavelengths.
    pub fn colors(&self, colors: &Colors, number: u32, bsdf: &Bsdf, meeting: &Meeting) -> SurfaceColors<'_> {
        let Meeting { sides, around, is_tinted, film_nm, nm, hero_alone } = *meeting;
        let material = &self.materials[number as usize];
        let film = material.film.as_ref().map(|film| film_at(film, film_nm, nm));
        let constant = material.constant.filter(|_| !is_tinted);
        let at = |slot: usize| match constant {
            Some(constant) => constant[slot].at(nm),
            None => colors.reflectance(colors_of(bsdf)[slot], nm),
        };
        let mut surface = SurfaceColors {
            diffuse: at(0),
            specular: at(1),
            shininess: f64::from(bsdf.shininess),
            mirror: at(2),
            one_sided: bsdf.one_sided,
            metal: None,
            boundary: None,
            rough: None,
        };
        if let Some((metal, rough)) = &material.metal {
            let [before, _] = self.indices([around, None], nm);
            let reflector = Reflector::metal(before, metal, film, nm);
            // Their colours are those of `whitted`, which shows metals by a mirror and a highlight.
            (surface.mirror, surface.specular, surface.diffuse) = ([0.0; 4], [0.0; 4], [0.0; 4]);
            match rough {
                None => surface.metal = Some(reflector),
                Some((ggx, compensation)) => {
                    let kind = RoughKind::Metal { compensation, average: nm.map(|nm| metal.average(nm)) };
                    surface.rough = Some(Rough { ggx: *ggx, reflector, kind, hero_alone });
                }
            }
        }
        if let Some((interface, sides)) = bsdf.interface.zip(sides) {
            let [before, beyond] = self.indices(sides, nm);
            let reflector = Reflector::dielectric(before, beyond, film, nm);
            let [reflect, transmit] = [at(3), at(4)];
            match &material.rough {
                Some(rough) if interface.fresnel && before != beyond => {
                    let [first, second] = sides.map(|side| side.map(|inside| inside.material));
                    let from_outside = first != Some(number);
                    let other = if from_outside { first } else { second };
                    let compensation = rough.compensations.iter().find(|(neighbour, _)| *neighbour == other);
                    let kind = RoughKind::Dielectric {
                        compensation: compensation.map(|(_, compensation)| compensation),
                        from_outside,
                        tints: [reflect, transmit],
                    };
                    surface.rough = Some(Rough { ggx: rough.ggx, reflector, kind, hero_alone });
                }
                _ => {
                    let fresnel = interface.fresnel;
                    surface.boundary = Some(BoundaryColors { fresnel, reflect, transmit, reflector });
                }
            }
        }
        surface
    }
}

/// The small mirrors of a roughness; `None` for a smooth surface.
fn ggx(roughness: f32) -> Option<Ggx> {
    (roughness > 0.0).then(|| Ggx::from_roughness(f64::from(roughness)))
}

fn rough_boundary(number: u32, material: &Material, indices: &[Dispersion], bodies: &[u32]) -> Option<RoughBoundary> {
    let body = material.body.as_ref()?;
    let ggx = ggx(body.roughness)?;
    let own = body.path_ior().index(SODIUM_D);
    let neighbours = bodies.iter().copied().filter(|&other| other != number).take(MOST_NEIGHBOURS).map(Some);
    let compensations = std::iter::once(None).chain(neighbours).filter_map(|other| {
        let index = own / other.map_or(1.0, |other| indices[other as usize].index(SODIUM_D));
        let table = || DielectricCompensation::new(ggx, index, |cosine, eta| fresnel_dielectric(cosine, eta, 1.0));
        (index != 1.0).then(|| (other, table()))
    });
    Some(RoughBoundary { ggx, compensations: compensations.collect() })
}

/// What a boundary lets through that does nothing else.
fn clear(material: &Material) -> Option<Reflectance> {
    let bsdf = material.constant_bsdf()?;
    material.body.as_ref().filter(|body| !body.bends_light())?;
    let does_nothing_else = !bsdf.is_lit() && bsdf.mirror.is_black() && bsdf.emission.is_black();
    let interface = bsdf.interface.filter(|interface| interface.fresnel && does_nothing_else)?;
    Some(Reflectance::new(interface.transmit))
}

fn colors_of(bsdf: &Bsdf) -> [snell_math::Rgb; 5] {
    let black = snell_math::Rgb::BLACK;
    let (reflect, transmit) =
        bsdf.interface.map_or((black, black), |interface| (interface.reflect, interface.transmit));
    [bsdf.diffuse, bsdf.specular, bsdf.mirror, reflect, transmit]
}

//! The scene's materials, ready for wavelengths.

use super::lobes::{BoundaryColors, SurfaceColors};
use super::spectra::{BodySpectra, Colors, Reflectance, Spectral, WHITE};
use crate::compile::CompiledScene;
use crate::material::Bsdf;
use crate::task::Inside;

/// One for each material of the scene.
#[derive(Debug)]
pub struct PathMaterials {
    materials: Vec<PathMaterial>,
    /// The index of refraction of each body; of the others one.
    indices: Vec<snell_math::Dispersion>,
    some_pass: bool,
}

#[derive(Debug)]
struct PathMaterial {
    /// Where colours are the same everywhere: diffuse, specular, mirror, reflect, transmit.
    constant: Option<[Reflectance; 5]>,
    body: Option<BodySpectra>,
    /// What the boundary lets through where it does nothing else: where it bends nothing, Fresnel's equations say, it reflects nothing.
    clear: Option<Reflectance>,
}

impl PathMaterials {
    /// Those of a scene.
    pub fn new(scene: &CompiledScene) -> Self {
        let material = |material: &crate::material::Material| PathMaterial {
            constant: material.constant_bsdf().map(|bsdf| colors_of(bsdf).map(Reflectance::new)),
            body: material.body.as_ref().and_then(|body| BodySpectra::new(&body.medium)),
            clear: material.constant_bsdf().and_then(|bsdf| {
                let does_nothing_else = !bsdf.is_lit() && bsdf.mirror.is_black() && bsdf.emission.is_black();
                let interface = bsdf.interface.filter(|interface| interface.fresnel && does_nothing_else)?;
                Some(Reflectance::new(interface.transmit))
            }),
        };
        let index = |material: &crate::material::Material| {
            material.body.as_ref().map_or(snell_math::Dispersion::Constant(1.0), |body| body.ior.clone())
        };
        let bends = |material: &crate::material::Material| {
            material.body.as_ref().is_none_or(|body| body.ior != snell_math::Dispersion::Constant(1.0))
        };
        Self {
            materials: scene.materials.iter().map(material).collect(),
            indices: scene.materials.iter().map(index).collect(),
            some_pass: !scene.materials.iter().all(bends),
        }
    }

    /// The inside of a body; `None` where light passes unchanged.
    pub fn body(&self, material: u32) -> Option<&BodySpectra> {
        self.materials[material as usize].body.as_ref()
    }

    /// True where the boundary of some body lets light pass straight on: of one with the index of the world around.
    pub fn some_pass(&self) -> bool {
        self.some_pass
    }

    /// What the boundary of a material between two bodies lets through straight on; `None` where it bends light.
    pub fn straight(&self, material: u32, sides: [Option<Inside>; 2], nm: Spectral) -> Option<Spectral> {
        let [before, beyond] = self.indices(sides, nm);
        if before != beyond {
            return None;
        }
        self.materials[material as usize].clear.map(|clear| clear.at(nm))
    }

    /// The indices of refraction on both sides of a boundary.
    pub fn indices(&self, sides: [Option<Inside>; 2], nm: Spectral) -> [Spectral; 2] {
        sides.map(|side| match side {
            None => WHITE,
            Some(inside) => match &self.indices[inside.material as usize] {
                snell_math::Dispersion::Constant(index) => [*index; 4],
                dispersive => nm.map(|nm| dispersive.index(nm)),
            },
        })
    }

    /// The colours of a surface whose lobes are known as colours, at wavelengths; `sides` are the bodies at the boundary of one, that
    /// of the viewer first. `is_tinted` where the mesh has a colour of its own there.
    pub fn colors(
        &self,
        colors: &Colors,
        material: u32,
        bsdf: &Bsdf,
        is_tinted: bool,
        sides: Option<[Option<Inside>; 2]>,
        nm: Spectral,
    ) -> SurfaceColors {
        let constant = self.materials[material as usize].constant.filter(|_| !is_tinted);
        let at = |slot: usize| match constant {
            Some(constant) => constant[slot].at(nm),
            None => colors.reflectance(colors_of(bsdf)[slot], nm),
        };
        let boundary = bsdf.interface.zip(sides).map(|(interface, sides)| {
            let [before, beyond] = self.indices(sides, nm);
            BoundaryColors { fresnel: interface.fresnel, reflect: at(3), transmit: at(4), before, beyond }
        });
        SurfaceColors {
            diffuse: at(0),
            specular: at(1),
            shininess: f64::from(bsdf.shininess),
            mirror: at(2),
            one_sided: bsdf.one_sided,
            boundary,
        }
    }
}

fn colors_of(bsdf: &Bsdf) -> [snell_math::Rgb; 5] {
    let black = snell_math::Rgb::BLACK;
    let (reflect, transmit) =
        bsdf.interface.map_or((black, black), |interface| (interface.reflect, interface.transmit));
    [bsdf.diffuse, bsdf.specular, bsdf.mirror, reflect, transmit]
}

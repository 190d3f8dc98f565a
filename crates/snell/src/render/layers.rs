//! What the centre of each pixel shows besides colour: depth, normal, object, as [`snell_image::Layers`] has them.

use snell_image::{Image, Layers};
use snell_math::{Ray, Vector3};

use crate::camera::Camera;
use crate::compile::CompiledScene;
use crate::geometry::Hit;

/// What the camera ray of a pixel's first sample met.
#[derive(Clone, Copy, Debug)]
pub struct FirstHit {
    depth: f32,
    normal: [f32; 3],
    object: u32,
}

impl FirstHit {
    const NOTHING: Self = Self { depth: f32::INFINITY, normal: [0.0; 3], object: 0 };

    pub fn new(scene: &CompiledScene, camera: &Camera, ray: &Ray, hit: Option<&Hit>) -> Self {
        let Some(hit) = hit else { return Self::NOTHING };
        let interaction = scene.interaction(ray, hit);
        let [_, _, back] = camera.axes();
        let depth = -(interaction.point - camera.eye()).dot(back);
        let Vector3(normal) = interaction.shading_normal.face_forward(-ray.direction).as_vector();
        Self { depth: depth as f32, normal: normal.as_vec3().to_array(), object: interaction.object + 1 }
    }
}

/// The first hits of a picture in the making, row 0 at the top.
#[derive(Clone, Debug)]
pub struct FirstHits(Image<FirstHit>);

impl FirstHits {
    pub fn new(width: u32, height: u32) -> Self {
        Self(Image::filled(width, height, FirstHit::NOTHING))
    }

    pub fn set(&mut self, pixel: usize, first: FirstHit) {
        self.0.pixels_mut()[pixel] = first;
    }

    pub fn into_layers(self) -> Layers {
        Layers {
            depth: Some(self.0.map(|first| first.depth)),
            normal: Some(self.0.map(|first| first.normal)),
            object: Some(self.0.map(|first| first.object)),
        }
    }
}

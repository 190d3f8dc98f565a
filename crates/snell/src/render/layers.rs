//! What the centre of each pixel shows besides colour: depth, normal, object.

use snell_math::{Ray, Vector3};

use crate::camera::Camera;
use crate::compile::CompiledScene;
use crate::geometry::Hit;

/// Per pixel, by the camera ray of the first sample, row 0 at the top.
#[derive(Clone, Debug, PartialEq)]
pub struct Layers {
    /// Distance from the eye along the gaze, world units; infinite where nothing is.
    pub depth: Vec<f32>,
    /// The shading normal, world space, on the viewer's side; zero where nothing is.
    pub normal: Vec<[f32; 3]>,
    /// The object, counted from 1 in the order of the scene; 0 where nothing is.
    pub object: Vec<u32>,
}

/// The three of one pixel.
#[derive(Clone, Copy, Debug)]
pub struct FirstHit {
    depth: f32,
    normal: [f32; 3],
    object: u32,
}

impl FirstHit {
    pub fn new(scene: &CompiledScene, camera: &Camera, ray: &Ray, hit: Option<&Hit>) -> Self {
        let Some(hit) = hit else { return Self { depth: f32::INFINITY, normal: [0.0; 3], object: 0 } };
        let interaction = scene.interaction(ray, hit);
        let [_, _, back] = camera.axes();
        let depth = -(interaction.point - camera.eye()).dot(back);
        let Vector3(normal) = interaction.shading_normal.face_forward(-ray.direction).as_vector();
        Self { depth: depth as f32, normal: normal.as_vec3().to_array(), object: interaction.object + 1 }
    }
}

impl Layers {
    pub(super) fn new(width: u32, height: u32) -> Self {
        let pixels = width as usize * height as usize;
        Self { depth: vec![f32::INFINITY; pixels], normal: vec![[0.0; 3]; pixels], object: vec![0; pixels] }
    }

    pub(super) fn set(&mut self, pixel: usize, first: FirstHit) {
        self.depth[pixel] = first.depth;
        self.normal[pixel] = first.normal;
        self.object[pixel] = first.object;
    }
}

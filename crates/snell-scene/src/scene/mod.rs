//! The scene as data: everything resolved and checked, nothing compiled.
//!
//! Names have become ids, degrees radians, colours scene-linear, files bytes or meshes. Every number is finite and in its
//! range: readers refuse what is not. The engine compiles this into its own flat form and never changes it.

pub mod background;
pub mod camera;
pub mod drawing;
pub mod expression;
pub mod lens;
pub mod light;
pub mod material;
pub mod mesh;
pub mod object;
pub mod plot;
pub mod settings;
pub mod texture;

use snell_math::Rgb;

pub use background::{Background, ImageAsset};
pub use camera::{Camera, Frame};
pub use drawing::{
    AxesLength, CameraMark, Drawing, Extent, GridMark, GroundGrid, HiddenLines, LineMark, PointMark, StrokeBy,
};
pub use expression::{Expression, ExpressionError};
pub use lens::{CameraLens, LensPrescription, LensSurface, LensSystem, Paraxial, ParaxialImage, ThinLens};
pub use light::{Falloff, Light, LightKind};
pub use material::{Dielectric, Extinction, Film, FilmVariation, Material, Medium, Metal, MetalIndex};
pub use mesh::Mesh;
pub use object::{CsgOperation, Grid, Object, ObjectKind, Prototype, Shape};
pub use plot::{Align, Axis, AxisPlace, CurveKind, Plot, PlotCurve, PlotFit, PlotLabel, Ticks};
pub use settings::{Antialiasing, IntegratorKind, PixelGrid, Settings, Shadows, Tone};
pub use texture::{Mapping, Pattern, Space, Texture};

use crate::table::Table;

/// A whole scene.
#[derive(Clone, Debug, Default)]
pub struct Scene {
    /// How the author wants it rendered; the command line may say otherwise.
    pub settings: Settings,
    /// From where it is seen.
    pub camera: Camera,
    /// What a ray sees that hits nothing.
    pub background: Background,
    /// Ambient light: multiplies every material's ambient colour.
    pub ambient: Rgb,
    /// The lights.
    pub lights: Vec<Light>,
    /// The pictures that textures and backgrounds use, still encoded.
    pub images: Table<ImageAsset>,
    /// The textures.
    pub textures: Table<Texture>,
    /// The materials. An object without one has [`Material::default`].
    pub materials: Table<Material>,
    /// The triangle meshes.
    pub meshes: Table<Mesh>,
    /// Objects defined once and placed by [`ObjectKind::Instance`]. One only refers to those before it, so there is no
    /// cycle.
    pub prototypes: Table<Prototype>,
    /// What stands in the world.
    pub objects: Vec<Object>,
    /// How the author wants it drawn as lines.
    pub drawing: Drawing,
    /// Plots, which need nothing else of the scene.
    pub plots: Vec<Plot>,
}

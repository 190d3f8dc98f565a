//! The scene file as data: one model that drives the reader, the JSON Schema, the reference and the completions.
//!
//! Every documentation comment on a field here is what an editor shows on hovering over the key, and what
//! `docs/scene-format.md` says of it. Every number states its unit (`x-unit`), its range and its default. Numbers are as the
//! author writes them: degrees, colours scene-linear unless given as text.
//!
//! Further words of our own in the schema, all beginning with `x-` so that other programs pass over them:
//! `x-unit`, the unit of a number; `x-called`, what messages call a type; `x-names`, the table whose names a text refers to;
//! `x-at-most-one`, keys that exclude each other; `x-example`, a piece of a scene file for the reference.

mod camera;
mod drawing;
mod formula;
mod lens;
mod light;
mod material;
mod mesh;
mod object;
mod plot;
mod shape;
mod spectrum;
mod texture;
mod value;

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

pub use camera::{
    Background, BackgroundGradient, BackgroundStop, Camera, GradientStop, Panorama, Photograph, Projection, Window,
};
pub use drawing::{CameraMark, Drawing, GridMark, GroundGrid, HiddenLines, LineMark, PointMark, StrokeBy};
pub use formula::{Formula, Quantity};
pub use lens::{
    CameraLens, IndexAndAbbeNumber, LensChoice, LensGlass, LensPrescription, LensSurface, PrescriptionChoice,
};
pub use light::{DirectionalLight, Falloff, FalloffLaw, Light, PointLight, PolynomialFalloff, SpotLight};
pub use material::{
    Absorption, AbsorptionChoice, AbsorptionWord, Cauchy, ComplexIndex, Dielectric, Film, FilmThickness, Ior,
    IorFormula, Material, MaterialChoice, Metal, Scattering, Sellmeier,
};
pub use mesh::Mesh;
pub use object::{Grid, Object, Step, StepVectors};
pub use plot::{
    Align, Axis, AxisWord, Plot, PlotCurve, PlotData, PlotFit, PlotFunction, PlotLabel, PlotParametric, Tick, TicksWord,
};
pub use shape::{AxisBox, Cone, Cylinder, Disk, Lens, Plane, Rectangle, Sphere, Torus};
pub use spectrum::{Illuminant, LightColor, LightSpectrum, MeasuredValues};
pub use texture::{
    CheckerPattern, GradientPattern, ImagePattern, NoiseForm, NoisePattern, Paint, Texture, TextureSpace,
};
pub(in crate::document) use value::LOCATED;
pub use value::{
    AxisAngle, Color, Either, Form, Forms, Located, MaterialName, Named, PrototypeName, Rotation, Scale, TextureName,
    Triple,
};

/// A whole scene file. The keys without a table of their own (`ambient`, `unit`) stand at its top, before the first `[table]`.
#[derive(Debug, Default, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
#[schemars(
    rename = "Scene",
    title = "Snell scene",
    extend("x-example" = "ambient = 0.1\n\n[camera]\neye = [0, 1, 5]\nlook_at = [0, 1, 0]\n\n[[light]]\npoint = { position = [3, 5, 4] }\n\n[material.clay]\ndiffuse = \"#c86432\"\n\n[[object]]\nsphere = { center = [0, 1, 0], radius = 1 }\nmaterial = \"clay\"\n")
)]
pub struct Document {
    /// In a JSON scene, the address of the schema, for editors. Nothing is read from it.
    #[serde(rename = "$schema")]
    pub json_schema: Option<String>,
    /// Ambient light: what reaches every surface from all around. It multiplies each material's `ambient` colour.
    #[schemars(extend("default" = 0))]
    pub ambient: Color,
    /// How long a world unit is: a word, or a number of millimetres. Only what is measured asks for it: real lenses of cameras, and
    /// absorption of the catalogue.
    #[schemars(extend("exclusiveMinimum" = 0, "x-unit" = "mm"))]
    pub unit: Option<Located<Unit>>,
    /// The picture: its size, and how colours become display colours.
    pub image: Image,
    /// How the picture is computed: the limits of the recursion, antialiasing, shadows.
    pub render: Render,
    /// From where the scene is seen.
    pub camera: Camera,
    /// What is seen where there is no object. Without it, black.
    pub background: Option<Background>,
    /// The lights, each as `[[light]]`.
    pub light: Vec<Located<Light>>,
    /// The materials by name, each as `[material.NAME]`.
    pub material: Named<Material>,
    /// Textures by name, each as `[texture.NAME]`, to be used wherever a colour may vary, as `{ texture = "NAME" }`.
    pub texture: Named<Texture>,
    /// Objects that are not in the scene themselves but are placed by `instance = "NAME"`, each as `[prototype.NAME]`.
    pub prototype: Named<Object>,
    /// The objects in the scene, each as `[[object]]`.
    pub object: Vec<Located<Object>>,
    /// How the scene is drawn as lines.
    #[schemars(extend("default" = {}))]
    pub drawing: Drawing,
    /// Two-dimensional pictures of functions and data, each as `[[plot]]`.
    pub plot: Vec<Located<Plot>>,
}

/// The picture.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
#[schemars(extend("x-example" = "[image]\nwidth = 1920\nheight = 1080\ntone = \"filmic\"\n"))]
pub struct Image {
    /// How many pixels the picture has from left to right.
    #[schemars(range(min = 1, max = 65536), extend("x-unit" = "pixels"))]
    pub width: u32,
    /// How many pixels the picture has from top to bottom.
    #[schemars(range(min = 1, max = 65536), extend("x-unit" = "pixels"))]
    pub height: u32,
    /// The curve from scene-linear colours to display colours.
    pub tone: Tone,
    /// Brightens the picture before the tone curve: colours are multiplied by 2 to this power.
    #[schemars(range(min = -32, max = 32), extend("x-unit" = "stops"))]
    pub exposure: f32,
    /// Where in the window the rays of the pixels pass.
    pub pixel_grid: PixelGrid,
}

impl Default for Image {
    fn default() -> Self {
        let of = crate::scene::Settings::default();
        Self { width: of.width, height: of.height, tone: Tone::None, exposure: 0.0, pixel_grid: PixelGrid::Centers }
    }
}

/// A tone curve.
#[derive(Clone, Copy, Debug, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
pub enum Tone {
    /// Colours above 1 are clipped.
    None,
    /// Reinhard's curve on luminance, with white at 4.
    Reinhard,
    /// A filmic curve, Narkowicz's fit of ACES.
    Filmic,
}

/// How long a world unit is: a word, or millimetres.
pub type Unit = Either<UnitName, f64>;

/// A unit of length.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
pub enum UnitName {
    /// A millimetre.
    Mm,
    /// A centimetre.
    Cm,
    /// A metre.
    M,
    /// An inch, 25.4 mm.
    In,
}

impl Forms for UnitName {
    const FORMS: &'static [Form] = &[Form::Text];
}

/// Where in the window the rays of the pixels pass.
#[derive(Clone, Copy, Debug, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
pub enum PixelGrid {
    /// Pixels tile the window, and rays pass through their centres.
    Centers,
    /// The rays of the outermost pixels pass through the window's border, as the Standard Procedural Databases ask.
    Corners,
}

/// How the picture is computed.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
#[schemars(extend("x-example" = "[render]\ndepth = 20\nantialiasing = 16   # rays in every pixel\n"))]
pub struct Render {
    /// How deep rays are followed: a camera ray has depth 1, its reflection depth 2, and so on.
    #[schemars(range(min = 1, max = 1000))]
    pub depth: u32,
    /// A ray that adds less than this share to its pixel is not followed; 0 follows all.
    #[schemars(range(min = 0, max = 1))]
    pub min_weight: f32,
    /// How pixels are sampled: a word, or the number of rays in every pixel.
    #[schemars(extend("minimum" = 1, "maximum" = 65536, "default" = "adaptive"))]
    pub antialiasing: Either<AntialiasingMethod, u32>,
    /// What blocks light.
    pub shadows: Shadows,
    /// Into at most how many bands of wavelength white light splits at glass whose index depends on the wavelength: it splits
    /// into as many as the picture can show apart. Each sample of a pixel splits it at other places, so that more samples
    /// see more wavelengths.
    #[schemars(range(min = 1, max = 64))]
    pub bands: u32,
    /// How light is followed.
    pub integrator: Integrator,
    /// The most samples of a pixel where paths are traced.
    #[schemars(range(min = 1, max = 16777216))]
    pub samples: u32,
}

impl Default for Render {
    fn default() -> Self {
        let of = crate::scene::Settings::default();
        Self {
            depth: of.depth,
            min_weight: of.min_weight,
            antialiasing: Either::A(AntialiasingMethod::Adaptive),
            shadows: Shadows::Filtered,
            bands: of.bands,
            integrator: Integrator::Whitted,
            samples: of.samples,
        }
    }
}

/// How light is followed.
#[derive(Clone, Copy, Debug, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
pub enum Integrator {
    /// Recursive ray tracing, as the lecture has it: mirrors, glass, point lights, shadows.
    Whitted,
    /// Path tracing: light as it is, from lights of any size, off everything, and through glass.
    Path,
}

impl Forms for Integrator {
    const FORMS: &'static [Form] = &[Form::Text];
}

/// How pixels are sampled.
#[derive(Clone, Copy, Debug, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
pub enum AntialiasingMethod {
    /// One ray through the centre of each pixel.
    None,
    /// More rays where neighbouring pixels differ.
    Adaptive,
}

impl Forms for AntialiasingMethod {
    const FORMS: &'static [Form] = &[Form::Text];
}

/// What blocks light.
#[derive(Clone, Copy, Debug, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
pub enum Shadows {
    /// Opaque surfaces block light; transparent ones filter it.
    Filtered,
    /// Every surface blocks light.
    Opaque,
    /// Nothing does.
    None,
}

//! The scene on the device: what the forward draw binds.

use airglow_gpu::ash::vk;
use airglow_gpu::{Binding, Buffer, Context, GpuError, ImageView, Recorder, Sampler, SamplerDesc};
use airglow_graph::Access;
use airglow_scene::{
    AlphaMode, Encoding, Environment, IDENTITY_UV, Image, Material, MaterialClass, Mesh, Scene, Texture, Wrap,
};
use bytemuck::{Pod, Zeroable};
use half::f16;

#[cfg(all(feature = "normals", feature = "relight"))]
use super::needed;
use super::{texture, upload};

/// Everything that the draws of a scene read and that does not change from frame to frame.
#[derive(Clone)]
pub struct DeviceScene {
    /// One for each instance of the scene.
    pub draws: Vec<Draw>,
    /// The environment map, if there is one.
    pub environment: Option<Sky>,
}

/// The environment map and how it is sampled.
#[derive(Clone)]
pub struct Sky {
    /// RGBA32F, one mip.
    pub map: ImageView,
    /// Linear, repeating around the horizon, clamped at the poles.
    pub sampler: Sampler,
}

/// One draw.
#[derive(Clone)]
pub struct Draw {
    /// What is drawn.
    pub mesh: MeshBuffers,
    /// The base colour; white where the material has no texture.
    pub base_colour: ImageView,
    /// How it is sampled.
    pub sampler: Sampler,
    /// Push constants.
    pub material: MaterialConstants,
    /// The normal map, where there is one to be drawn.
    pub mapped: Option<Mapped>,
}

/// How what is kept of a map is looked up and shaded.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
#[cfg_attr(not(feature = "normals"), allow(dead_code, reason = "only the room of normal maps makes it"))]
pub enum Look {
    /// So many array layers, once.
    Layers(u32),
    /// Four layers, at the quarters of a pixel's footprint, each shaded by itself.
    Quarters,
    /// Coefficients of harmonics.
    Harmonics,
}

/// A material's normal map on the device.
#[derive(Clone)]
#[cfg_attr(not(feature = "normals"), allow(dead_code, reason = "only the room of normal maps makes it"))]
pub struct Mapped {
    /// How it is looked up.
    pub look: Look,
    /// As the draw takes it.
    pub bindings: MapBindings,
}

/// A map, what is kept of its coarser levels, and their samplers.
pub type MapBindings = [Binding; 4];

/// The arrays of a mesh; instances share them.
#[derive(Clone)]
pub struct MeshBuffers {
    /// `[f32; 3]` a vertex.
    pub positions: Buffer,
    /// `[f32; 3]` a vertex, where the scene has lights or the surface a normal map that is drawn.
    pub normals: Option<Buffer>,
    /// `[f32; 4]` a vertex, there too, if the mesh has them.
    pub tangents: Option<Buffer>,
    /// `[f32; 2]` a vertex.
    pub texture_coordinates: Buffer,
    /// `u32` each.
    pub indices: Buffer,
    /// How many.
    pub index_count: u32,
}

/// `Material` of `host/material.glsl`.
#[repr(C)]
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
pub struct MaterialConstants {
    world_from_object: [[f32; 4]; 4],
    base_colour: [f32; 4],
    emissive_cutoff: [f32; 4],
    uv_linear: [f32; 4],
    uv_offset: [f32; 2],
    flags: u32,
    surface: u32,
}

/// Flags of a material, the bits of `host/material.glsl`.
const UNLIT: u32 = 1;
#[cfg(feature = "normals")]
const INCIDENT_IN_WORLD: u32 = 2;
const MATT: u32 = 4;

/// Uploads the scene; the recorder's commands must be done before the first frame.
pub fn upload(recorder: &mut Recorder<'_>, scene: &Scene) -> Result<DeviceScene, GpuError> {
    let context = recorder.context();
    let meshes = scene.meshes.iter().enumerate();
    let meshes = meshes.map(|(index, mesh)| upload_mesh(recorder, mesh, has_normals(scene, index)));
    let meshes = meshes.collect::<Result<Vec<_>, _>>()?;
    let white =
        upload::image(recorder, "white", COLOUR, &[(1, 1, vec![[255_u8; 4]])], Access::FragmentSampled)?;
    let images =
        scene.images.iter().map(|image| upload_image(recorder, image)).collect::<Result<Vec<_>, _>>()?;
    let mut draws = Vec::with_capacity(scene.instances.len());
    for instance in &scene.instances {
        let material = &scene.materials[instance.material];
        let texture = material.base_color_texture.and_then(|texture| images.get(texture.image).cloned());
        draws.push(Draw {
            base_colour: texture.unwrap_or_else(|| white.clone()),
            sampler: sampler(context, material)?,
            material: MaterialConstants::new(instance.transform, material),
            mesh: meshes[instance.mesh].clone(),
            mapped: None,
        });
    }
    let environment = match &scene.environment {
        Some(environment) => Some(upload_environment(recorder, environment)?),
        None => None,
    };
    Ok(DeviceScene { draws, environment })
}

const COLOUR: vk::Format = vk::Format::R8G8B8A8_SRGB;

/// Whether draws of a mesh take its normals.
fn has_normals(scene: &Scene, mesh: usize) -> bool {
    #[cfg(all(feature = "normals", feature = "relight"))]
    let mapped = (0..scene.instances.len())
        .any(|number| scene.instances[number].mesh == mesh && needed::normal_map_on(scene, number));
    #[cfg(not(all(feature = "normals", feature = "relight")))]
    let (mapped, _) = (false, mesh);
    !scene.lights.is_empty() || mapped
}

fn upload_mesh(recorder: &mut Recorder<'_>, mesh: &Mesh, lit: bool) -> Result<MeshBuffers, GpuError> {
    let normals = lit.then(|| upload::buffer(recorder, &mesh.name, &mesh.normals, Access::VertexBuffer));
    let tangents = (lit && !mesh.tangents.is_empty())
        .then(|| upload::buffer(recorder, &mesh.name, &mesh.tangents, Access::VertexBuffer));
    let blank = vec![[0.0_f32; 2]; mesh.positions.len()];
    let texture_coordinates = if mesh.uv0.is_empty() { &blank } else { &mesh.uv0 };
    Ok(MeshBuffers {
        positions: upload::buffer(recorder, &mesh.name, &mesh.positions, Access::VertexBuffer)?,
        normals: normals.transpose()?,
        tangents: tangents.transpose()?,
        texture_coordinates: upload::buffer(recorder, &mesh.name, texture_coordinates, Access::VertexBuffer)?,
        indices: upload::buffer(recorder, &mesh.name, &mesh.indices, Access::IndexBuffer)?,
        index_count: mesh.indices.len() as u32,
    })
}

fn upload_image(recorder: &mut Recorder<'_>, image: &Image) -> Result<ImageView, GpuError> {
    let format = match image.encoding {
        Encoding::Srgb => COLOUR,
        Encoding::Linear => vk::Format::R8G8B8A8_UNORM,
    };
    upload::image(recorder, &image.name, format, &texture::mip_levels(image), Access::FragmentSampled)
}

fn upload_environment(recorder: &mut Recorder<'_>, environment: &Environment) -> Result<Sky, GpuError> {
    let context = recorder.context();
    let texels = environment.pixels.iter().map(|&[r, g, b]| [r, g, b, 1.0]).collect();
    let level = (environment.width as u32, environment.height as u32, texels);
    let format = vk::Format::R32G32B32A32_SFLOAT;
    let map = upload::image(recorder, "environment", format, &[level], Access::FragmentSampled)?;
    let address = [
        vk::SamplerAddressMode::REPEAT,
        vk::SamplerAddressMode::CLAMP_TO_EDGE,
        vk::SamplerAddressMode::CLAMP_TO_EDGE,
    ];
    let sampler = context.create_sampler(&SamplerDesc { address, ..SamplerDesc::linear("environment") })?;
    Ok(Sky { map, sampler })
}

fn sampler(context: &Context, material: &Material) -> Result<Sampler, GpuError> {
    let mut desc = SamplerDesc::linear("base colour");
    if let Some(texture) = &material.base_color_texture {
        desc.address = address(texture);
        desc.filter = if texture.nearest { vk::Filter::NEAREST } else { vk::Filter::LINEAR };
    }
    context.create_sampler(&desc)
}

/// What lies outside a texture.
pub fn address(texture: &Texture) -> [vk::SamplerAddressMode; 3] {
    let [u, v] = texture.wrap.map(|wrap| match wrap {
        Wrap::Repeat => vk::SamplerAddressMode::REPEAT,
        Wrap::MirroredRepeat => vk::SamplerAddressMode::MIRRORED_REPEAT,
        Wrap::ClampToEdge => vk::SamplerAddressMode::CLAMP_TO_EDGE,
    });
    [u, v, vk::SamplerAddressMode::CLAMP_TO_EDGE]
}

impl MaterialConstants {
    /// Names the tables of the diffuse and of the specular lobe.
    #[cfg(feature = "fog")]
    pub fn set_tables(&mut self, [diffuse, specular]: [u32; 2]) {
        self.flags = self.flags & 0xff | (diffuse & 0xff) << 8 | specular << 16;
    }

    /// Says that the radiance that meets the vertices is told about the axes of the world.
    #[cfg(feature = "normals")]
    pub fn set_incident_in_world(&mut self) {
        self.flags |= INCIDENT_IN_WORLD;
    }

    /// Whether the surface has holes.
    pub fn has_holes(&self) -> bool {
        self.emissive_cutoff[3] > 0.0
    }

    /// Puts what is drawn elsewhere.
    #[cfg(feature = "radiance")]
    pub fn place(&mut self, world_from_object: glam::Mat4) {
        self.world_from_object = world_from_object.to_cols_array_2d();
    }

    fn new(world_from_object: glam::Mat4, material: &Material) -> Self {
        let rows = material.base_color_texture.map_or(IDENTITY_UV, |texture| texture.transform);
        let cutoff = match material.alpha {
            AlphaMode::Mask { cutoff } => cutoff,
            AlphaMode::Opaque | AlphaMode::Blend => 0.0,
        };
        let [red, green, blue] = material.emissive;
        Self {
            world_from_object: world_from_object.to_cols_array_2d(),
            base_colour: material.base_color,
            emissive_cutoff: [red, green, blue, cutoff],
            uv_linear: [rows[0][0], rows[0][1], rows[1][0], rows[1][1]],
            uv_offset: [rows[0][2], rows[1][2]],
            flags: match material.class {
                MaterialClass::Unlit => UNLIT,
                MaterialClass::Lambert => MATT,
                _ => 0,
            },
            surface: [material.metallic, material.roughness]
                .map(|value| u32::from(f16::from_f32(value).to_bits()))
                .into_iter()
                .rfold(0, |packed, half| packed << 16 | half),
        }
    }
}

//! Draws what egui makes of an interface, triangles and a texture of glyphs, by a pass of the frame's own graph.

use std::collections::BTreeMap;
use std::sync::{Arc, Mutex, PoisonError};

use airglow_gpu::ash::vk;
use airglow_gpu::{
    Binding, BindingDesc, BindingKind, Blend, ColorAttachment, GpuError, GraphicsPipeline,
    GraphicsPipelineDesc, ImageView, Load, Record, Recorder, Rendering, Sampler, SamplerDesc,
    VertexAttribute, VertexBufferLayout,
};
use airglow_graph::{Access, Graph, Handle, Image, PassKind};
use bytemuck::{Pod, Zeroable};
use egui::epaint::{ClippedPrimitive, ImageData, Primitive, Vertex};
use egui::{ColorImage, Rect, TextureId, TexturesDelta};

use crate::failure::{Failure, Outcome};
use crate::host::device::Device;
use crate::host::{shaders, upload};

/// The interface as it is drawn from the next recording on.
#[derive(Clone)]
pub struct Painter {
    pipeline: GraphicsPipeline,
    sampler: Sampler,
    painted: Arc<Mutex<Painted>>,
    /// Whether images of the window encode what is written to them.
    encodes: bool,
}

/// What egui made last.
#[derive(Default)]
struct Painted {
    primitives: Vec<ClippedPrimitive>,
    textures: BTreeMap<TextureId, Texture>,
    /// Pixels of a point.
    scale: f32,
}

/// A texture of egui's.
struct Texture {
    texels: ColorImage,
    /// `None` until the texels are on the device.
    view: Option<ImageView>,
}

/// `Window` of `host/interface.vert`.
#[repr(C)]
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
struct WindowConstants {
    size: [f32; 2],
    decoded: u32,
}

/// Where triangles of one texture lie in the arrays of a frame.
struct Batch {
    clip: Rect,
    texture: TextureId,
    indices: std::ops::Range<u32>,
    first_vertex: i32,
}

impl Painter {
    /// For windows whose images have that format.
    pub fn new(device: &Device<'_>, format: vk::Format) -> Outcome<Self> {
        let attribute = |location, format, offset| VertexAttribute { location, format, offset };
        let context = device.context();
        let pipeline = context.create_graphics_pipeline(&GraphicsPipelineDesc {
            name: "interface",
            vertex: &shaders::interface_vertex(),
            fragment: Some(&shaders::interface_fragment()),
            bindings: &[
                BindingDesc::new(0, BindingKind::SampledImage),
                BindingDesc::new(1, BindingKind::Sampler),
            ],
            push_constant_size: size_of::<WindowConstants>() as u32,
            vertex_buffers: &[VertexBufferLayout {
                stride: size_of::<Vertex>() as u32,
                rate: vk::VertexInputRate::VERTEX,
                attributes: &[
                    attribute(0, vk::Format::R32G32_SFLOAT, 0),
                    attribute(1, vk::Format::R32G32_SFLOAT, 8),
                    attribute(2, vk::Format::R8G8B8A8_UNORM, 16),
                ],
            }],
            topology: vk::PrimitiveTopology::TRIANGLE_LIST,
            cull: vk::CullModeFlags::NONE,
            front_face: vk::FrontFace::COUNTER_CLOCKWISE,
            depth: None,
            colors: &[format],
            blend: Blend::PremultipliedOver,
        });
        let sampler = context.create_sampler(&SamplerDesc::linear("glyphs"));
        Ok(Self {
            pipeline: pipeline.map_err(Failure::work)?,
            sampler: sampler.map_err(Failure::work)?,
            painted: Arc::default(),
            encodes: [vk::Format::B8G8R8A8_SRGB, vk::Format::R8G8B8A8_SRGB].contains(&format),
        })
    }

    /// Draws this from the next recording on; `scale` is pixels a point.
    pub fn set(&self, primitives: Vec<ClippedPrimitive>, textures: TexturesDelta, scale: f32) {
        let mut painted = self.painted.lock().unwrap_or_else(PoisonError::into_inner);
        for (id, delta) in textures.set {
            let ImageData::Color(texels) = delta.image;
            match (delta.pos, painted.textures.get_mut(&id)) {
                (Some(at), Some(texture)) => texture.patch(at, &texels),
                _ => drop(painted.textures.insert(id, Texture { texels: (*texels).clone(), view: None })),
            }
        }
        for id in textures.free {
            painted.textures.remove(&id);
        }
        (painted.primitives, painted.scale) = (primitives, scale);
    }

    /// Adds the pass that draws it over the picture; returns the window's image with it.
    pub fn add(&self, graph: &mut Graph<Record>, window: Handle<Image>) -> Handle<Image> {
        let mut pass = graph.pass("interface", PassKind::Graphics);
        let window = pass.update(window, Access::ColorAttachmentReadWrite);
        let this = self.clone();
        pass.record(Box::new(move |recorder, resources| this.record(recorder, &resources.view(&window)?)));
        window
    }

    fn record(&self, recorder: &mut Recorder<'_>, window: &ImageView) -> Result<(), GpuError> {
        let mut painted = self.painted.lock().unwrap_or_else(PoisonError::into_inner);
        let (vertices, indices, batches) = painted.arrays();
        if batches.is_empty() {
            return Ok(());
        }
        for texture in painted.textures.values_mut().filter(|texture| texture.view.is_none()) {
            texture.view = Some(texture.upload(recorder)?);
        }
        let (vertices, indices) = (recorder.upload(&vertices)?, recorder.upload(&indices)?);
        let [width, height, _] = window.image().extent(0);
        let scale = painted.scale.max(f32::MIN_POSITIVE);
        let size = [width as f32 / scale, height as f32 / scale];
        recorder.begin_rendering(&Rendering {
            colors: &[ColorAttachment { view: window, load: Load::Keep }],
            depth: None,
        })?;
        for batch in batches {
            let view = painted.textures.get(&batch.texture).and_then(|texture| texture.view.clone());
            let (Some(view), Some((offset, extent))) = (view, scissor(batch.clip, scale, [width, height]))
            else {
                continue;
            };
            let bindings = [Binding::sampled(0, view), Binding::sampler(1, &self.sampler)];
            recorder.bind_graphics(&self.pipeline, &bindings)?;
            recorder.push_constants(&WindowConstants { size, decoded: self.encodes.into() })?;
            recorder.bind_vertex_buffer(0, &vertices)?;
            recorder.bind_index_buffer(&indices)?;
            recorder.set_scissor(offset, extent)?;
            recorder.draw_indexed(batch.indices, batch.first_vertex, 0..1)?;
        }
        recorder.end_rendering()
    }
}

impl Painted {
    /// All triangles, and which of them are drawn together.
    fn arrays(&self) -> (Vec<Vertex>, Vec<u32>, Vec<Batch>) {
        let (mut vertices, mut indices, mut batches) = (Vec::new(), Vec::new(), Vec::new());
        for ClippedPrimitive { clip_rect, primitive } in &self.primitives {
            let Primitive::Mesh(mesh) = primitive else { continue };
            let (first, first_vertex) = (indices.len() as u32, vertices.len() as i32);
            vertices.extend_from_slice(&mesh.vertices);
            indices.extend_from_slice(&mesh.indices);
            let indices = first..indices.len() as u32;
            if !indices.is_empty() {
                batches.push(Batch { clip: *clip_rect, texture: mesh.texture_id, indices, first_vertex });
            }
        }
        (vertices, indices, batches)
    }
}

impl Texture {
    /// Replaces the texels from `at` on.
    fn patch(&mut self, [x, y]: [usize; 2], texels: &ColorImage) {
        let [width, height] = self.texels.size;
        let columns = texels.size[0].min(width.saturating_sub(x));
        for row in 0..texels.size[1].min(height.saturating_sub(y)) {
            let (to, from) = ((y + row) * width + x, row * texels.size[0]);
            self.texels.pixels[to..to + columns].copy_from_slice(&texels.pixels[from..from + columns]);
        }
        self.view = None;
    }

    /// A copy on the device; texels hold encoded values, which are not decoded.
    fn upload(&self, recorder: &mut Recorder<'_>) -> Result<ImageView, GpuError> {
        let [width, height] = self.texels.size.map(|side| side as u32);
        let texels: Vec<[u8; 4]> = self.texels.pixels.iter().map(|texel| texel.to_array()).collect();
        let level = (width, height, texels);
        upload::image(recorder, "glyphs", vk::Format::R8G8B8A8_UNORM, &[level], Access::FragmentSampled)
    }
}

/// Offset and extent, in pixels, of what of a rectangle of points is in a window; `None` where that is nothing.
fn scissor(clip: Rect, scale: f32, size: [u32; 2]) -> Option<([u32; 2], [u32; 2])> {
    // A cast saturates.
    let pixel = |points: f32, most: u32| ((points * scale).round() as u32).min(most);
    let low = [pixel(clip.min.x, size[0]), pixel(clip.min.y, size[1])];
    let high = [pixel(clip.max.x, size[0]), pixel(clip.max.y, size[1])];
    let extent = [high[0].saturating_sub(low[0]), high[1].saturating_sub(low[1])];
    (extent[0] > 0 && extent[1] > 0).then_some((low, extent))
}

#[cfg(test)]
mod tests {
    use super::*;
    use egui::{Color32, pos2};

    #[test]
    fn scissors_stay_in_the_window() {
        let clip = |a, b, c, d| Rect::from_min_max(pos2(a, b), pos2(c, d));
        let found = scissor(clip(-5.0, 2.0, 1e9, 4.0), 2.0, [100, 50]);
        assert_eq!(found, Some(([0, 4], [100, 4])));
        assert_eq!(scissor(clip(60.0, 0.0, 70.0, 9.0), 2.0, [100, 50]), None);
        assert_eq!(scissor(clip(f32::NAN, 0.0, 5.0, 9.0), 1.0, [100, 50]), Some(([0, 0], [5, 9])));
    }

    #[test]
    fn patches_keep_within_a_texture() {
        let image = |size: [usize; 2], value| ColorImage::new(size, vec![value; size[0] * size[1]]);
        let mut texture = Texture { texels: image([3, 2], Color32::BLACK), view: None };
        texture.patch([2, 1], &image([2, 2], Color32::WHITE));
        let white: Vec<usize> =
            (0..6).filter(|&texel| texture.texels.pixels[texel] == Color32::WHITE).collect();
        assert_eq!(white, [5]);
    }
}

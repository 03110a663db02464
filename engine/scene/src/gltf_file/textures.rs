//! Textures: images decoded once for each encoding they are used in.

use std::collections::HashMap;

use gltf::image::Source;
use gltf::texture::{MagFilter, WrappingMode};

use super::document::{Document, fetch};
use super::uv_transform::UvTransform;
use super::{label, name_of};
use crate::error::{SceneError, at_most, invalid};
use crate::image::{Encoding, Image};
use crate::image_io::decode_texture;
use crate::limits::MAX_TEXTURE_PIXELS;
use crate::material::{IDENTITY_UV, Texture, Wrap};
use crate::warning::Warnings;

/// The images decoded so far.
pub(super) struct Textures<'a> {
    document: &'a Document,
    pub(super) images: Vec<Image>,
    known: HashMap<(usize, Encoding), usize>,
    pixels: u64,
}

/// What a material says about one of its textures.
pub(super) struct Reference<'a> {
    pub(super) texture: gltf::Texture<'a>,
    pub(super) set: u32,
    pub(super) transform: Option<UvTransform>,
}

impl<'a> From<gltf::texture::Info<'a>> for Reference<'a> {
    fn from(info: gltf::texture::Info<'a>) -> Self {
        let transform = info.texture_transform().map(UvTransform::from);
        Self { texture: info.texture(), set: info.tex_coord(), transform }
    }
}

impl<'a> Textures<'a> {
    pub(super) fn new(document: &'a Document) -> Self {
        Self { document, images: Vec::new(), known: HashMap::new(), pixels: 0 }
    }

    /// The transform of the normal texture of material `index`.
    pub(super) fn normal_transform(&self, index: usize) -> Option<UvTransform> {
        self.document.normal_transforms.get(index).copied().flatten()
    }

    /// Decodes what `reference` names; `item` is the material and the role. `None`, with a warning, if it reads
    /// texture coordinates that are not kept.
    pub(super) fn read(
        &mut self,
        item: &str,
        reference: Reference<'a>,
        encoding: Encoding,
        warnings: &mut Warnings<'_>,
    ) -> Result<Option<Texture>, SceneError> {
        let transform = reference.transform.as_ref().map_or(IDENTITY_UV, UvTransform::affine);
        let set = reference.transform.and_then(|transform| transform.set).unwrap_or(reference.set);
        if !transform.as_flattened().iter().all(|value| value.is_finite()) {
            let problem = "the texture transform is not finite";
            return Err(invalid(warnings.file, item, problem, "state finite offset, rotation and scale"));
        }
        if set != 0 {
            warnings.add(item, format!("texture left out: it reads TEXCOORD_{set}, only TEXCOORD_0 is kept"));
            return Ok(None);
        }
        let sampler = reference.texture.sampler();
        let image = self.image(reference.texture.source(), encoding, warnings)?;
        Ok(Some(Texture {
            image,
            wrap: [sampler.wrap_s(), sampler.wrap_t()].map(wrap),
            nearest: sampler.mag_filter() == Some(MagFilter::Nearest),
            transform,
        }))
    }

    fn image(
        &mut self,
        image: gltf::Image<'a>,
        encoding: Encoding,
        warnings: &mut Warnings<'_>,
    ) -> Result<usize, SceneError> {
        if let Some(known) = self.known.get(&(image.index(), encoding)) {
            return Ok(*known);
        }
        let file = warnings.file;
        let item = label("image", image.index(), image.name());
        let fetched;
        let bytes = match image.source() {
            Source::View { view, .. } => self.document.view(&view).unwrap_or_default(),
            Source::Uri { uri, .. } => {
                fetched = fetch(file, &item, uri)?;
                &fetched
            }
        };
        let decoded = decode_texture(file, &item, bytes, |pixels| {
            self.pixels += pixels;
            const MEND: &str = "use smaller textures";
            at_most(file, &item, self.pixels, MAX_TEXTURE_PIXELS, "pixels of all textures", MEND)
        })?;
        if decoded.was_deeper {
            warnings.add(item, "16 bits in each channel were cut to 8");
        }
        let index = self.images.len();
        self.images.push(Image {
            name: name_of("image", image.index(), image.name()),
            width: decoded.width,
            height: decoded.height,
            encoding,
            pixels: decoded.pixels,
        });
        self.known.insert((image.index(), encoding), index);
        Ok(index)
    }
}

fn wrap(mode: WrappingMode) -> Wrap {
    match mode {
        WrappingMode::Repeat => Wrap::Repeat,
        WrappingMode::MirroredRepeat => Wrap::MirroredRepeat,
        WrappingMode::ClampToEdge => Wrap::ClampToEdge,
    }
}

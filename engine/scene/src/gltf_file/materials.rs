//! Materials of glTF: factors checked, textures decoded, what is not read named.

use std::path::Path;

use gltf::material::AlphaMode as FileAlphaMode;

use super::document::Document;
use super::textures::{Reference, Textures};
use super::{label, name_of};
use crate::error::{SceneError, invalid};
use crate::image::Encoding;
use crate::material::{AlphaMode, Material, MaterialClass};
use crate::scene::Scene;
use crate::warning::Warnings;

/// Reads every material and the images they use.
pub(super) fn read(
    document: &Document,
    scene: &mut Scene,
    warnings: &mut Warnings<'_>,
) -> Result<(), SceneError> {
    let mut textures = Textures::new(document);
    for material in document.gltf.materials() {
        let read = read_one(&material, &mut textures, warnings)?;
        scene.materials.push(read);
    }
    scene.images = textures.images;
    Ok(())
}

fn read_one<'a>(
    material: &gltf::Material<'a>,
    textures: &mut Textures<'a>,
    warnings: &mut Warnings<'_>,
) -> Result<Material, SceneError> {
    let index = material.index().unwrap_or_default();
    let item = label("material", index, material.name());
    let pbr = material.pbr_metallic_roughness();
    let file = warnings.file;
    check_factors(file, &item, material)?;
    let transform = textures.normal_transform(index);
    let mut texture = |role: &str, reference: Option<Reference<'a>>, encoding| match reference {
        Some(reference) => textures.read(&format!("{item}, {role}"), reference, encoding, warnings),
        None => Ok(None),
    };
    let base_color_texture =
        texture("base colour", pbr.base_color_texture().map(Reference::from), Encoding::Srgb)?;
    let metallic_roughness_texture = texture(
        "metallic and roughness",
        pbr.metallic_roughness_texture().map(Reference::from),
        Encoding::Linear,
    )?;
    let emissive_texture =
        texture("emission", material.emissive_texture().map(Reference::from), Encoding::Srgb)?;
    let normal = material.normal_texture();
    let normal_reference = normal.as_ref().map(|normal| Reference {
        texture: normal.texture(),
        set: normal.tex_coord(),
        transform,
    });
    let normal_texture = texture("normals", normal_reference, Encoding::Linear)?;
    if material.occlusion_texture().is_some() {
        warnings.add(&item, "occlusion texture left out: occlusion comes from the bake");
    }
    let strength = material.emissive_strength().unwrap_or(1.0);
    Ok(Material {
        name: name_of("material", index, material.name()),
        class: match material.unlit() {
            true => MaterialClass::Unlit,
            false => MaterialClass::of(pbr.metallic_factor(), pbr.roughness_factor()),
        },
        base_color: pbr.base_color_factor(),
        base_color_texture,
        metallic: pbr.metallic_factor(),
        roughness: pbr.roughness_factor(),
        metallic_roughness_texture,
        normal_texture,
        normal_scale: normal.map_or(1.0, |normal| normal.scale()),
        emissive: material.emissive_factor().map(|factor| factor * strength),
        emissive_texture,
        alpha: alpha(&item, material, warnings),
        double_sided: material.double_sided(),
    })
}

fn alpha(item: &str, material: &gltf::Material<'_>, warnings: &mut Warnings<'_>) -> AlphaMode {
    match material.alpha_mode() {
        FileAlphaMode::Opaque => AlphaMode::Opaque,
        FileAlphaMode::Mask => AlphaMode::Mask { cutoff: material.alpha_cutoff().unwrap_or(0.5) },
        FileAlphaMode::Blend => {
            warnings.add(item, "blended alpha is not supported; the surface counts as opaque");
            AlphaMode::Blend
        }
    }
}

/// Factors lie where glTF has them.
fn check_factors(file: &Path, item: &str, material: &gltf::Material<'_>) -> Result<(), SceneError> {
    let pbr = material.pbr_metallic_roughness();
    let fractions = pbr.base_color_factor().into_iter().chain([
        pbr.metallic_factor(),
        pbr.roughness_factor(),
        material.alpha_cutoff().unwrap_or(0.5).min(1.0),
    ]);
    let bad_fraction = fractions.into_iter().find(|factor| !(0.0..=1.0).contains(factor));
    let strength = material.emissive_strength().unwrap_or(1.0);
    let emitted = material.emissive_factor().map(|factor| factor * strength);
    let bad_emission = emitted.into_iter().find(|factor| !(*factor >= 0.0 && factor.is_finite()));
    let scale = material.normal_texture().map_or(1.0, |normal| normal.scale());
    let (problem, mend) = if let Some(factor) = bad_fraction {
        (format!("a colour, metallic, roughness or cutoff of {factor}"), "keep factors in [0, 1]")
    } else if let Some(factor) = bad_emission {
        (format!("an emission of {factor}"), "keep emission finite and not negative")
    } else if !scale.is_finite() {
        (format!("a normal scale of {scale}"), "keep the scale finite")
    } else {
        return Ok(());
    };
    Err(invalid(file, item, problem, mend))
}

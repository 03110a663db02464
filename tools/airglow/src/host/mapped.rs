//! The scene's normal maps, filtered by the normals room, or as others filter them, for pictures to compare.

use std::collections::BTreeSet;

use airglow::normals::cost::whole;
use airglow::normals::rivals::{self, Lean};
use airglow::normals::{self, Bench, Brdf, Method, NormalMap, Normals, Sample, Settings, Storage};
use airglow_gpu::ash::vk;
use airglow_gpu::{Binding, Execution, ImageView, Imports, Requirements, SamplerDesc};
use airglow_graph::{Access, Graph, LeftOut};
use airglow_math::Preset;
use airglow_scene::{Image, Material, MaterialClass, Scene};

use super::counted::Counted;
use super::device::Device;
use super::filter::{Filter, MappedFragments, Under};
use super::scene::{DeviceScene, Look, Mapped};
use super::source::Source;
use super::{incident, needed, scene, shaders, upload};
use crate::failure::{Failure, Outcome};

/// Relative error that the lobes of a material may have.
const TOLERANCE: f64 = 0.05;

/// The maps of a scene, one for each material that has one.
pub struct MappedMaterials {
    /// What stands for the normals under a pixel.
    pub filter: Filter,
    /// What the scene asks of the room; without it each map gets what its material needs.
    preset: Option<Preset>,
    /// What was left out, as plans say it.
    pub left_out: Vec<LeftOut>,
    /// What is counted of the textures.
    pub counted: Option<Counted>,
    count: bool,
    materials: Vec<Option<Mapped>>,
}

/// Bytes of the maps that are drawn, and of what vertices are told of the light from all around for them.
pub fn bytes(scene: &Scene) -> u64 {
    let drawn = scene.materials.iter().filter(|material| needed::normal_map(scene, material));
    let images = drawn.filter_map(|material| scene.images.get(material.normal_texture?.image));
    let maps: u64 = images.map(|image| 4 * u64::from(image.width) * u64::from(image.height)).sum();
    let vertices = (0..scene.instances.len())
        .filter(|number| needed::incident_on(scene, *number))
        .map(|number| scene.meshes[scene.instances[number].mesh].positions.len() as u64);
    maps + u64::from(incident::vertex_bytes(scene)) * vertices.sum::<u64>()
}

/// What the device must offer for a scene.
pub fn requirements(scene: &Scene) -> Requirements {
    match scene.materials.iter().any(|material| needed::normal_map(scene, material)) {
        true => Normals::requirements(&Settings::default()),
        false => Requirements::engine(),
    }
}

impl MappedMaterials {
    /// Filters the maps of a scene that `source` lights; with `count` what is bad about the textures is counted.
    pub fn new(
        device: &Device<'_>,
        scene: &Scene,
        source: &Source,
        filter: Filter,
        count: bool,
    ) -> Outcome<Self> {
        let preset = scene.presets.of("normals");
        let mut maps =
            Self { filter, preset, left_out: Vec::new(), counted: None, count, materials: Vec::new() };
        let lit = !scene.lights.is_empty() || matches!(source, Source::Relight(_));
        for material in &scene.materials {
            let mapped = match lit && needed::normal_map(scene, material) {
                true => maps.read(device, scene, material)?,
                false => None,
            };
            maps.materials.push(mapped);
        }
        Ok(maps)
    }

    /// Gives each draw the map of its material.
    pub fn attach(&self, scene: &Scene, source: &Source, device_scene: &mut DeviceScene) {
        for (number, (draw, instance)) in device_scene.draws.iter_mut().zip(&scene.instances).enumerate() {
            let drawn = needed::normal_map_on(scene, number);
            draw.mapped = self.materials[instance.material].clone().filter(|_| drawn);
            if let Source::Relight(transfer) = source
                && transfer.instances[number].in_world
            {
                draw.material.set_incident_in_world();
            }
        }
    }

    /// The fragment stages that draw them, each by how it looks them up; those of fog, too, where lights shine into a medium.
    pub fn fragments(&self, scene: &Scene, in_fog: bool) -> Vec<MappedFragments> {
        let looks: BTreeSet<Look> = self.materials.iter().flatten().map(|mapped| mapped.look).collect();
        let of = |look, fogged| {
            let fragment = |incident| shaders::mapped_fragment(self.filter, look, Under { fogged, incident });
            let incident = needed::incident(scene).then(|| (incident::vertex_bytes(scene), fragment(true)));
            MappedFragments { look, fogged, plain: fragment(false), incident }
        };
        let airs = if in_fog { &[false, true][..] } else { &[false] };
        looks.into_iter().flat_map(|look| airs.iter().map(move |fogged| of(look, *fogged))).collect()
    }

    fn read(&mut self, device: &Device<'_>, scene: &Scene, material: &Material) -> Outcome<Option<Mapped>> {
        let Some(texture) = &material.normal_texture else { return Ok(None) };
        let Some(image) = scene.images.get(texture.image) else { return Ok(None) };
        let map = normals(image, material.normal_scale)?;
        let image = scaled(image, material.normal_scale);
        let own = match self.filter {
            Filter::Lobes | Filter::Octahedral => self.chosen(device, &map, material)?,
            Filter::Harmonics => harmonics(device, &map)?,
            _ => None,
        };
        let (look, coarse) = match own {
            Some(own) => own,
            None => {
                let keep = if self.filter == Filter::Lean { slopes } else { mean };
                let coarse = kept(device, &map, keep)?;
                (Look::Layers(coarse.desc().layers), coarse)
            }
        };
        let context = device.context();
        let level = (image.width, image.height, image.pixels);
        let format = vk::Format::R8G8B8A8_UNORM;
        let sampler = |nearest| {
            let filter = if nearest { vk::Filter::NEAREST } else { vk::Filter::LINEAR };
            let desc =
                SamplerDesc { filter, address: scene::address(texture), ..SamplerDesc::linear("normals") };
            context.create_sampler(&desc).map_err(Failure::work)
        };
        let own = device
            .run(|recorder| upload::image(recorder, &image.name, format, &[level], Access::FragmentSampled))
            .map_err(Failure::work)?;
        Ok(Some(Mapped {
            look,
            bindings: [
                Binding::sampled(5, own),
                Binding::sampler(6, &sampler(texture.nearest)?),
                Binding::sampled(7, coarse),
                Binding::sampler(8, &sampler(false)?),
            ],
        }))
    }

    /// What a preset says, else what the room chooses for the material.
    fn chosen(&mut self, device: &Device<'_>, map: &NormalMap, material: &Material) -> Outcome<Option<Kept>> {
        if let Some(preset) = self.preset {
            return self.asked(device, map, preset.into());
        }
        let choice = normals::choose(map, brdf(material), TOLERANCE).map_err(Failure::work)?;
        let (mut settings, mut look) = (Settings::default(), None);
        match choice.method {
            Method::Harmonics(3) => {
                self.left_out.extend(choice.left_out);
                return harmonics(device, map);
            }
            Method::Lobes(lobes) => {
                settings.fit.lobes = lobes;
                self.left_out.extend(choice.left_out);
            }
            Method::Taps if self.filter == Filter::Lobes => look = Some(Look::Quarters),
            // This draw has no more harmonics than nine, nor four bytes at four places: it keeps the default.
            _ => {}
        }
        let lobes = self.asked(device, map, settings)?;
        Ok(lobes.map(|(layers, lobes)| (look.unwrap_or(layers), lobes)))
    }

    /// Lobes by these settings, as the filter stores them.
    fn asked(
        &mut self,
        device: &Device<'_>,
        map: &NormalMap,
        mut settings: Settings,
    ) -> Outcome<Option<Kept>> {
        if self.filter == Filter::Octahedral {
            settings.storage = Storage::Octahedral8;
        }
        let lobes = self.lobes(device, map, settings)?;
        Ok(lobes.map(|lobes| (Look::Layers(lobes.desc().layers), lobes)))
    }

    /// The room's own texture, built in a frame before all others.
    fn lobes(
        &mut self,
        device: &Device<'_>,
        map: &NormalMap,
        settings: Settings,
    ) -> Outcome<Option<ImageView>> {
        let context = device.context();
        let normals = Normals::new(context, settings).map_err(Failure::work)?;
        let mut build = normals.build(context, map).map_err(Failure::input)?;
        if self.count && self.counted.is_none() {
            self.counted = Some(Counted::new(device, &normals::HEALTH)?);
        }
        self.counted.iter().for_each(|counted| build.count(&counted.tally));
        let (mut graph, mut imports) = (Graph::new(), Imports::new());
        build.add(&mut graph, &mut imports, usize::MAX);
        self.left_out.extend(build.left_out().iter().cloned());
        let Some(texture) = build.texture() else { return Ok(None) };
        let plan = graph.compile(&context.graph_limits()).map_err(Failure::work)?;
        let mut execution = Execution::prepare(context, plan).map_err(Failure::work)?;
        device.frames(&mut execution, &imports, None, 1, |_| Ok(()))?;
        whole(&texture.image).map(Some).map_err(Failure::work)
    }
}

/// A texture from level 1 of a map on, and how it is looked up.
type Kept = (Look, ImageView);

/// Nine coefficients of the normals under each texel.
fn harmonics(device: &Device<'_>, map: &NormalMap) -> Outcome<Option<Kept>> {
    let run = device.bench();
    let bench = Bench { context: device.context(), run: &run };
    let image = bench.kept(map, Method::Harmonics(3), &Settings::default()).map_err(Failure::work)?;
    image.map(|image| Ok((Look::Harmonics, whole(&image).map_err(Failure::work)?))).transpose()
}

/// The normals of a map's image, x and y of which are multiplied.
pub fn normals(image: &Image, scale: f32) -> Outcome<NormalMap> {
    let image = scaled(image, scale);
    let vectors: Vec<[f32; 3]> = image.pixels.iter().map(|&texel| vector(texel)).collect();
    NormalMap::from_vectors(image.width as usize, image.height as usize, &vectors)
        .map_err(|error| Failure::input(format!("{}: {error}", image.name)))
}

/// What a material reflects by, as the choice of what is kept takes it.
pub fn brdf(material: &Material) -> Brdf {
    match material.class {
        MaterialClass::Lambert => Brdf::Lambert,
        _ => Brdf::Ggx { alpha: f64::from(material.roughness * material.roughness).clamp(1e-3, 1.0) },
    }
}

/// The vector that a texel holds.
fn vector([r, g, b, _]: [u8; 4]) -> [f32; 3] {
    [r, g, b].map(|value| f32::from(value) / 127.5 - 1.0)
}

/// The map with x and y of its normals multiplied.
fn scaled(image: &Image, scale: f32) -> Image {
    let mut image = image.clone();
    if scale != 1.0 {
        for texel in &mut image.pixels {
            let [x, y, z] = vector(*texel);
            let normal = glam::Vec3::new(scale * x, scale * y, z).normalize_or_zero();
            let [r, g, b] = (127.5 * normal + 128.0).to_array().map(|value| value as u8);
            *texel = [r, g, b, 255];
        }
    }
    image
}

/// The mean normal: a single lobe, too.
fn mean(footprint: &[Sample]) -> Vec<[f32; 4]> {
    vec![rivals::mean(footprint).extend(1.0).as_vec4().to_array()]
}

/// Mean of the slope; means of its products.
fn slopes(footprint: &[Sample]) -> Vec<[f32; 4]> {
    let Lean { mean, moments } = Lean::new(footprint);
    let products = glam::DVec3::new(moments.x_axis.x, moments.x_axis.y, moments.y_axis.y);
    vec![mean.extend(0.0).extend(0.0), products.extend(0.0)]
        .into_iter()
        .map(|layer| layer.as_vec4().to_array())
        .collect()
}

/// An f32 texture from level 1 on (or of the one texel that there is) of what `keep` makes of each footprint.
fn kept(device: &Device<'_>, map: &NormalMap, keep: fn(&[Sample]) -> Vec<[f32; 4]>) -> Outcome<ImageView> {
    let last = map.levels() - 1;
    let mut levels = Vec::new();
    for level in last.min(1)..=last {
        let [width, height] = map.size(level);
        let places = (0..height).flat_map(|y| (0..width).map(move |x| (x, y)));
        let texels = places.map(|(x, y)| Ok(keep(&map.footprint(level, x, y)?)));
        let texels: Vec<_> = texels.collect::<Result<_, normals::NormalsError>>().map_err(Failure::work)?;
        let layers = texels.first().map_or(0, Vec::len);
        let texels: Vec<[f32; 4]> =
            (0..layers).flat_map(|layer| texels.iter().map(move |texel| texel[layer])).collect();
        levels.push((width as u32, height as u32, texels));
    }
    let format = vk::Format::R32G32B32A32_SFLOAT;
    let uploaded = device
        .run(|recorder| upload::array(recorder, "kept normals", format, &levels, Access::FragmentSampled));
    whole(&uploaded.map_err(Failure::work)?).map_err(Failure::work)
}

//! One map on its way to a texture: steps that a host records at once or over several frames.

use airglow_gpu::ash::vk::{BufferUsageFlags, ImageUsageFlags};
use airglow_gpu::{Buffer, Context, GpuError, Image, Label, Location, Readback, Recorder};
use airglow_graph::{Access, BufferDesc, ImageDesc, LeftOut};

use crate::NormalsError;
use crate::cache::PackedChain;
use crate::chain::{self, Level, VECTOR};
use crate::kernels::{AlignConstants, FitConstants, PackConstants};
use crate::map::NormalMap;
use crate::normals::Normals;
use crate::settings::Settings;
use crate::stage::{Resource, Stage, Work};

const OWNER: &str = "normals";
/// Texels that one step fits at most: a fraction of a second on any device, so that no watchdog barks.
const BAND: usize = 1 << 16;

/// The lobes of a map's levels as a shader samples them with filters.
///
/// Array layer j holds lobe j of every texel, `(weight * mean vector, weight)`; mip m is level m + 1 of the map, since
/// where a single texel is seen its own normal is exact. Lobes are in the order of their neighbours', so that between
/// texels and mips they may be interpolated.
#[derive(Clone)]
pub struct LobeTexture {
    /// The image, in the layout for sampling when the build is done.
    pub image: Image,
    /// How it was made.
    pub settings: Settings,
    /// Bytes of its texels.
    pub bytes: u64,
}

/// How far a build is, in texels of steps.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Progress {
    /// Steps taken.
    pub done: u64,
    /// All steps.
    pub total: u64,
}

/// The build of one map. Drop it when the frames of its last step are done; the texture stays. A clone takes steps of its own
/// in the same buffers.
#[derive(Clone)]
pub struct Build {
    pub(crate) stages: Vec<Stage>,
    pub(crate) next: usize,
    pub(crate) levels: Vec<Level>,
    pub(crate) normals: Option<Buffer>,
    pub(crate) lobes: Vec<Buffer>,
    pub(crate) packed: Vec<Buffer>,
    /// Where lobes are counted.
    pub(crate) counters: Option<Buffer>,
    texture: Option<LobeTexture>,
    left_out: Vec<LeftOut>,
    pub(crate) pipeline_count: usize,
}

impl Normals {
    /// Prepares the build of a map: makes its buffers and its texture, copies its normals to where the device reads them,
    /// records nothing.
    ///
    /// # Errors
    /// [`NormalsError::Budget`] with the next setting that fits, whether the chain's budget or the host's memory budget is
    /// the one without room, [`NormalsError::Gpu`] for what the device refuses.
    pub fn build(&self, context: &Context, map: &NormalMap) -> Result<Build, NormalsError> {
        let levels = chain::levels(map, &self.settings)?;
        chain::check_build(map, &self.settings, context.memory_left())?;
        let mut build = Build { pipeline_count: self.pipeline_count, ..Build::empty(map) };
        let Some(texture) = self.texture(context, &levels)? else { return Ok(build) };
        let vectors: Vec<[f32; 4]> =
            map.normals().iter().map(|n| n.extend(1.0).as_vec4().to_array()).collect();
        let desc =
            BufferDesc { size: size_of_val(&*vectors) as u64, usage: BufferUsageFlags::STORAGE_BUFFER };
        let normals =
            context.create_buffer(Label::new(OWNER, "normals of a map"), &desc, Location::Upload)?;
        normals.write(0, &vectors)?;
        for level in &levels {
            let lobe_bytes = self.settings.storage.lobe_bytes();
            build.lobes.push(scratch(context, "lobes of a level", level.bytes / lobe_bytes * VECTOR)?);
            build.packed.push(scratch(context, "packed lobes of a level", level.bytes)?);
        }
        for level in &levels {
            let samples = if level.source == 0 { &normals } else { &build.lobes[level.source - 1] };
            let fine = map.size(level.source);
            build.stages.extend(self.fits(level, fine, samples, &build.lobes[level.level - 1]));
        }
        for pair in levels.windows(2).rev() {
            build.stages.extend(self.align(pair, &build.lobes));
        }
        for level in &levels {
            build.stages.push(self.pack(level, &build.lobes, &build.packed));
        }
        build.stages.push(copy(&build.packed, &texture));
        build.normals = Some(normals);
        build.texture = Some(texture);
        build.levels = levels;
        Ok(build)
    }

    /// Prepares the texture of a chain that was kept: one step copies it.
    ///
    /// # Errors
    /// [`NormalsError::Budget`], [`NormalsError::Chain`] for levels that are not the map's, [`NormalsError::Gpu`].
    pub fn upload(
        &self,
        context: &Context,
        map: &NormalMap,
        chain: &PackedChain,
    ) -> Result<Build, NormalsError> {
        let levels = chain::levels(map, &self.settings)?;
        let sizes = |level: &Level| usize::try_from(level.bytes).ok();
        if !levels.iter().map(sizes).eq(chain.levels.iter().map(|bytes| Some(bytes.len()))) {
            return Err(NormalsError::Chain);
        }
        let mut build = Build { pipeline_count: self.pipeline_count, ..Build::empty(map) };
        let Some(texture) = self.texture(context, &levels)? else { return Ok(build) };
        for bytes in &chain.levels {
            let desc = BufferDesc { size: bytes.len() as u64, usage: BufferUsageFlags::TRANSFER_SRC };
            let buffer = context.create_buffer(Label::new(OWNER, "kept lobes"), &desc, Location::Upload)?;
            buffer.write(0, bytes)?;
            build.packed.push(buffer);
        }
        build.stages.push(copy(&build.packed, &texture));
        build.texture = Some(texture);
        build.levels = levels;
        Ok(build)
    }

    /// The texture of a chain; none for a chain without levels.
    fn texture(&self, context: &Context, levels: &[Level]) -> Result<Option<LobeTexture>, NormalsError> {
        let Some(finest) = levels.first() else { return Ok(None) };
        let [width, height] = finest.size.map(|size| size as u32);
        let desc = ImageDesc {
            mips: levels.len() as u32,
            layers: self.settings.fit.lobes as u32,
            usage: ImageUsageFlags::SAMPLED | ImageUsageFlags::TRANSFER_DST | ImageUsageFlags::TRANSFER_SRC,
            ..ImageDesc::new_2d(width, height, self.settings.storage.format())
        };
        let image = context.create_image(Label::new(OWNER, "lobes of a map"), &desc)?;
        let bytes = levels.iter().map(|level| level.bytes).sum();
        Ok(Some(LobeTexture { image, settings: self.settings, bytes }))
    }

    /// A level in bands.
    fn fits<'a>(
        &'a self,
        level: &'a Level,
        fine: [usize; 2],
        samples: &'a Buffer,
        lobes: &'a Buffer,
    ) -> impl Iterator<Item = Stage> + 'a {
        let texels = level.size[0] * level.size[1];
        let source = if level.source == 0 { Resource::Normals } else { Resource::Lobes(level.source) };
        (0..texels).step_by(BAND).map(move |first| {
            let count = (texels - first).min(BAND);
            let constants = FitConstants {
                fine: fine.map(|size| size as u32),
                size: level.size.map(|size| size as u32),
                per_texel: if level.source == 0 { 1 } else { self.settings.fit.lobes as u32 },
                iterations: self.settings.fit.iterations as u32,
                sharpest: self.settings.fit.sharpest as f32,
                first: first as u32,
            };
            // Later bands keep what earlier ones wrote.
            let writes =
                if first == 0 { Access::ComputeStorageWrite } else { Access::ComputeStorageReadWrite };
            Stage {
                name: "normals fit",
                accesses: vec![(source, Access::ComputeStorageRead), (Resource::Lobes(level.level), writes)],
                texels: count as u64,
                work: Work::Fit {
                    pipeline: self.fit.clone(),
                    samples: samples.clone(),
                    lobes: lobes.clone(),
                    constants,
                    count,
                },
            }
        })
    }

    /// The finer of two levels in the order of the coarser.
    fn align(&self, pair: &[Level], lobes: &[Buffer]) -> Option<Stage> {
        let [fine, coarse] = pair else { return None };
        let pipeline = self.align.clone()?;
        let size = |level: &Level| level.size.map(|size| size as u32);
        Some(Stage {
            name: "normals align",
            accesses: vec![
                (Resource::Lobes(coarse.level), Access::ComputeStorageRead),
                (Resource::Lobes(fine.level), Access::ComputeStorageReadWrite),
            ],
            texels: (fine.size[0] * fine.size[1]) as u64,
            work: Work::Align {
                pipeline,
                coarse: lobes[coarse.level - 1].clone(),
                lobes: lobes[fine.level - 1].clone(),
                constants: AlignConstants { coarse_size: size(coarse), size: size(fine) },
            },
        })
    }

    fn pack(&self, level: &Level, lobes: &[Buffer], packed: &[Buffer]) -> Stage {
        let texels = level.size[0] * level.size[1];
        let (at, count) = (level.level - 1, self.settings.fit.lobes as u32);
        Stage {
            name: "normals pack",
            accesses: vec![
                (Resource::Lobes(level.level), Access::ComputeStorageRead),
                (Resource::Packed(level.level), Access::ComputeStorageWrite),
            ],
            texels: texels as u64,
            work: Work::Pack {
                pipeline: self.pack.clone(),
                lobes: lobes[at].clone(),
                packed: packed[at].clone(),
                constants: PackConstants { texels: texels as u32, lobes: count },
            },
        }
    }
}

impl Build {
    /// Nothing to do, and why the finest level is not there.
    pub(crate) fn empty(map: &NormalMap) -> Self {
        let left_out = LeftOut {
            what: "normals level 0".to_owned(),
            why: "where a single texel is seen its own normal is exact".to_owned(),
            bytes: VECTOR / 2 * map.normals().len() as u64,
            time: None,
            would_return: "nothing: the map itself is sampled there".to_owned(),
        };
        Self {
            stages: Vec::new(),
            next: 0,
            levels: Vec::new(),
            normals: None,
            lobes: Vec::new(),
            packed: Vec::new(),
            pipeline_count: 0,
            counters: None,
            texture: None,
            left_out: vec![left_out],
        }
    }

    /// The texture, whose contents are there when all steps are done. None for a map of one texel, whose normal is all
    /// that there is.
    #[must_use]
    pub fn texture(&self) -> Option<&LobeTexture> {
        self.texture.as_ref()
    }

    /// The levels, finest first.
    #[must_use]
    pub fn levels(&self) -> &[Level] {
        &self.levels
    }

    /// What the texture does not hold, and why.
    #[must_use]
    pub fn left_out(&self) -> &[LeftOut] {
        &self.left_out
    }

    /// How far it is.
    #[must_use]
    pub fn progress(&self) -> Progress {
        let texels = |stages: &[Stage]| stages.iter().map(|stage| stage.texels).sum();
        Progress { done: texels(&self.stages[..self.next]), total: texels(&self.stages) }
    }

    /// The next steps, at most `most`, for a host that makes the barriers of [`Stage::accesses`] before each itself. They
    /// count as taken.
    pub fn take(&mut self, most: usize) -> &[Stage] {
        let first = self.next;
        self.next = self.stages.len().min(first.saturating_add(most));
        &self.stages[first..self.next]
    }

    /// Copies what the texture gets for the CPU, to be kept by [`crate::cache::store`]: all steps but the copy into the
    /// texture are done, and the host has made a barrier from [`Access::ComputeStorageWrite`] to
    /// [`Access::TransferSource`]. One copy a level, finest first.
    ///
    /// # Errors
    /// [`GpuError::Memory`] where there is none left for the copies.
    pub fn read_back(&self, recorder: &mut Recorder<'_>) -> Result<Vec<Readback>, GpuError> {
        self.packed.iter().map(|packed| recorder.read_back_buffer(packed)).collect()
    }

    /// A buffer that steps use; the texture is none.
    #[must_use]
    pub fn buffer(&self, resource: Resource) -> Option<&Buffer> {
        match resource {
            Resource::Normals => self.normals.as_ref(),
            Resource::Lobes(level) => self.lobes.get(level.checked_sub(1)?),
            Resource::Packed(level) => self.packed.get(level.checked_sub(1)?),
            Resource::Health => self.counters.as_ref(),
            Resource::Texture => None,
        }
    }

    /// Lobes of a texel.
    pub(crate) fn lobe_count(&self) -> u64 {
        self.texture.as_ref().map_or(0, |texture| texture.settings.fit.lobes as u64)
    }
}

/// All levels into the texture.
pub(crate) fn copy(packed: &[Buffer], texture: &LobeTexture) -> Stage {
    let source = |level: usize| (Resource::Packed(level + 1), Access::TransferSource);
    let target = (Resource::Texture, Access::TransferDestination);
    let (packed, image) = (packed.to_vec(), texture.image.clone());
    Stage {
        name: "normals copy",
        accesses: (0..packed.len()).map(source).chain([target]).collect(),
        texels: texture.bytes / texture.settings.storage.lobe_bytes() / texture.settings.fit.lobes as u64,
        work: Work::Copy { packed, texture: image },
    }
}

fn scratch(context: &Context, name: &str, bytes: u64) -> Result<Buffer, GpuError> {
    let usage = BufferUsageFlags::STORAGE_BUFFER | BufferUsageFlags::TRANSFER_SRC;
    let desc = BufferDesc { size: bytes, usage };
    context.create_buffer(Label::new(OWNER, name), &desc, Location::Device)
}

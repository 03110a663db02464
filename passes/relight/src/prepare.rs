//! From a frame to stages: what is needed, what is left out and why.

use airglow_gpu::ash::vk::{AccessFlags2, PipelineStageFlags2};
use airglow_gpu::{Buffer, Context};
use airglow_graph::{Access, ImageDesc, PassKind, ResourceDesc, State};

use crate::RelightError;
use crate::builder::Builder;
use crate::constants::Pair;
use crate::control::{Once, Rotations};
use crate::envelope::LightPipelines;
use crate::frame::{Environment, Frame, Instance, Light, ResultRange};
use crate::mesh::Mesh;
use crate::pack::{RECTANGLE_FORMAT, RECTANGLE_WIDTH};
use crate::relight::{Relight, alignment};
use crate::rotation::{LightFrame, Orientation};
use crate::settings::{LightKind, Method, Output};
use crate::shown::Shown;
use crate::stage::{Need, Prepared, Resource, Work};
use crate::tables::map_frame;

/// The environment's light between frames: any vertex, fragment or compute shader may read it.
fn read_anywhere() -> State {
    let access = AccessFlags2::SHADER_STORAGE_READ | AccessFlags2::UNIFORM_READ;
    let stage = PipelineStageFlags2::VERTEX_SHADER
        | PipelineStageFlags2::FRAGMENT_SHADER
        | PipelineStageFlags2::COMPUTE_SHADER;
    State { stage, access, ..State::UNDEFINED }
}

impl Relight {
    /// The frame as data, for a host without our graph: provide what [`Prepared::needs`] lists, then
    /// [`Prepared::record`]. It may be recorded again in later frames while meshes, light and sizes stay;
    /// [`Prepared::rotations`] turns light and instances in between, [`Prepared::shown`] hides instances, their dynamic
    /// visibility, or all light.
    ///
    /// # Errors
    /// [`RelightError::Instance`] and [`RelightError::Settings`] for inputs that the settings do not allow,
    /// [`RelightError::UnknownMesh`], [`RelightError::Math`] for a zero quaternion, [`RelightError::Size`] for an
    /// environment or a packed rectangle past the device's limits, [`RelightError::Gpu`].
    pub fn prepare<B, I>(
        &mut self,
        context: &Context,
        frame: &Frame<B, I>,
    ) -> Result<Prepared, RelightError> {
        let mut builder = Builder::default();
        let ranges = self.ranges(frame)?;
        let incident = self.settings.output == Output::Incident;
        let baked = |instance: &Instance<B>| self.meshes.get(instance.mesh).is_ok_and(Mesh::has_vectors);
        let flags = |instance| (Instance::<B>::is_shadowed(instance), incident && baked(instance));
        let shown = Shown::all(frame.instances.iter().map(flags));
        let total = ranges.last().map_or(0, |range| range.offset + range.size);
        if frame.instances.is_empty() {
            builder.leave_out("relight", "the frame has no instance of a mesh", 0, "an instance");
            return Ok(builder.finish(Vec::new(), None, shown));
        }
        if matches!(frame.light, Light::None) {
            let why = "the scene has no environment and no other light";
            builder.leave_out("relight", why, total, "an environment, or SH light of the host");
            return Ok(builder.finish(Vec::new(), None, shown));
        }
        let rotations = self.light(context, &mut builder, frame)?;
        match frame.target {
            Some(_) => builder.host(Resource::Results),
            None => builder.scratch(Resource::Results, total),
        }
        if self.settings.method == Method::Fragment {
            let rows = total.div_ceil(self.settings.output_bytes() * u64::from(RECTANGLE_WIDTH));
            let most = context.limits().max_image_dimension2_d.min(context.limits().max_framebuffer_height);
            if rows > u64::from(most) {
                return Err(RelightError::Size {
                    name: "the packed rectangle".to_owned(),
                    what: "a height",
                    actual: rows,
                    allowed: format!("at most {most}, or choose Method::Compute"),
                });
            }
            let desc = ImageDesc::new_2d(RECTANGLE_WIDTH, rows as u32, RECTANGLE_FORMAT);
            builder.needs.insert(Resource::Rectangle, Need::Scratch(ResourceDesc::Image(desc)));
        }
        self.vertices(&mut builder, frame, &ranges, &shown)?;
        Ok(builder.finish(ranges, rotations, shown))
    }

    /// The mesh of an instance.
    pub(crate) fn mesh<B, I>(&self, frame: &Frame<B, I>, instance: usize) -> Result<&Mesh, RelightError> {
        self.meshes.get(frame.instances[instance].mesh)
    }

    /// Where the results of each instance lie.
    fn ranges<B, I>(&self, frame: &Frame<B, I>) -> Result<Vec<ResultRange>, RelightError> {
        let (align, bytes) = (u64::from(alignment(&self.settings)), self.settings.output_bytes());
        let mut first = 0;
        let range = |instance| {
            let vertices = self.mesh(frame, instance)?.vertices;
            let range = ResultRange { offset: first * bytes, size: u64::from(vertices) * bytes, vertices };
            first += u64::from(vertices).next_multiple_of(align);
            Ok(range)
        };
        (0..frame.instances.len()).map(range).collect()
    }

    /// The stages from the light's source to the light of each instance.
    fn light<B, I>(
        &mut self,
        context: &Context,
        builder: &mut Builder,
        frame: &Frame<B, I>,
    ) -> Result<Option<Rotations>, RelightError> {
        let (source, light_frame, turn) = match (&frame.light, self.settings.light) {
            (Light::Environment(environment), LightKind::Uniform) => {
                self.environment(context, builder, environment)?;
                (Resource::EnvironmentLight, LightFrame::map(&self.world)?, environment.rotation)
            }
            (Light::Uniform { rotation, .. }, LightKind::Uniform) => {
                builder.host(Resource::UniformLight);
                (Resource::UniformLight, LightFrame::host(&self.world), *rotation)
            }
            (Light::Vertices, LightKind::Vertex) | (Light::None, _) => return Ok(None),
            _ => {
                return Err(RelightError::Settings {
                    what: "the frame's light is not of the kind the settings name",
                    mend: "set Settings::light to the kind of light that frames bring",
                });
            }
        };
        let Some(pipelines) = &self.light_pipelines else { return Ok(None) };
        let instances: Vec<Orientation> =
            frame.instances.iter().map(|instance| instance.orientation).collect();
        let rotations = Rotations::new(light_frame, turn, &instances, self.settings.order)?;
        let (count, stride) = (instances.len() as u32, self.light_stride());
        builder.scratch(Resource::Lights, u64::from(count) * stride);
        let work = Work::Rotate {
            pipeline: pipelines.rotate.clone(),
            source,
            target: Resource::Lights,
            rotations: rotations.clone(),
            strides: Pair::new(0, (stride / 16) as u32),
        };
        let uses =
            vec![(source, Access::ComputeStorageRead), (Resource::Lights, Access::ComputeStorageWrite)];
        builder.stage("relight rotate light", PassKind::Compute, uses, work, None);
        self.matrices(builder, frame, pipelines, count);
        Ok(Some(rotations))
    }

    /// The product matrices, if some instance has visibility, dynamic or baked.
    fn matrices<B, I>(
        &self,
        builder: &mut Builder,
        frame: &Frame<B, I>,
        pipelines: &LightPipelines,
        instances: u32,
    ) {
        let stride = self.matrix_stride();
        let bytes = u64::from(instances) * stride;
        let incident = self.settings.output == Output::Incident;
        let baked = |instance: &Instance<B>| self.meshes.get(instance.mesh).is_ok_and(Mesh::has_vectors);
        let shadowed = |instance: &Instance<B>| instance.is_shadowed() || incident && baked(instance);
        if !frame.instances.iter().any(shadowed) {
            let why =
                if incident { "no instance has visibility" } else { "no instance has dynamic visibility" };
            builder.leave_out("relight product matrices", why, bytes, "a visibility vector for each vertex");
            return;
        }
        let (Some(pipeline), Some(tensor)) = (&pipelines.matrix, &self.tensor) else { return };
        builder.resident(Resource::Tensor, tensor, Access::ComputeStorageRead);
        builder.scratch(Resource::Matrices, bytes);
        let work = Work::Matrices {
            pipeline: pipeline.clone(),
            elements: self.matrix_elements(),
            instances,
            strides: Pair::new((self.light_stride() / 16) as u32, (stride / 16) as u32),
        };
        let uses = vec![
            (Resource::Tensor, Access::ComputeStorageRead),
            (Resource::Lights, Access::ComputeStorageRead),
            (Resource::Matrices, Access::ComputeStorageWrite),
        ];
        builder.stage("relight product matrices", PassKind::Compute, uses, work, None);
    }

    /// The projection of the environment, unless it was done for this revision.
    fn environment<I>(
        &mut self,
        context: &Context,
        builder: &mut Builder,
        environment: &Environment<I>,
    ) -> Result<(), RelightError> {
        let Environment { width, height, revision, .. } = *environment;
        let most = context.limits().max_image_dimension2_d;
        if !(1..=most).contains(&width) || !(1..=most).contains(&height) {
            return Err(RelightError::Size {
                name: "the environment".to_owned(),
                what: "a side",
                actual: u64::from(if (1..=most).contains(&width) { height } else { width }),
                allowed: format!("1 to {most} texels"),
            });
        }
        let order = self.settings.order as u32;
        let (coefficients, azimuths) = (order * order, 2 * order - 1);
        let Some(light) = self.environment_light.clone() else { return Ok(()) };
        let state = read_anywhere();
        let need = |buffer: Buffer| Need::Ours { buffer, entry: state, exit: state };
        builder.needs.insert(Resource::EnvironmentLight, need(light));
        self.map(context, width, height)?;
        let (Some(map), Some(pipelines)) = (&self.map, &self.light_pipelines) else { return Ok(()) };
        let row_bytes = 16 * u64::from(height) * u64::from(azimuths);
        if map.projected.holds(revision) {
            let why = "the environment is the one projected before";
            builder.leave_out("relight environment", why, row_bytes, "another revision of the environment");
            return Ok(());
        }
        let once = |last| Some(Once { projected: map.projected.clone(), revision, last });
        let (read, write) = (Access::ComputeStorageRead, Access::ComputeStorageWrite);
        builder.host(Resource::Environment);
        builder.resident(Resource::ColumnTable, &map.columns, read);
        builder.resident(Resource::RowTable, &map.rows, read);
        builder.scratch(Resource::RowSums, row_bytes);
        builder.scratch(Resource::MapCoefficients, 16 * u64::from(coefficients));
        let size = Pair::new(width, height);
        let mut uses = vec![
            (Resource::Environment, Access::ComputeSampled),
            (Resource::ColumnTable, read),
            (Resource::RowSums, write),
        ];
        if let Some(health) = &self.health {
            let (buffer, access) = (health.buffer().clone(), Access::ComputeStorageReadWrite);
            let need = Need::Ours { buffer, entry: access.into(), exit: access.into() };
            builder.needs.insert(Resource::Health, need);
            uses.push((Resource::Health, access));
        }
        let counted = self.health.is_some();
        let work = Work::Rows { pipeline: pipelines.rows.clone(), size, counted };
        builder.stage("relight environment rows", PassKind::Compute, uses, work, once(false));
        let uses =
            vec![(Resource::RowTable, read), (Resource::RowSums, read), (Resource::MapCoefficients, write)];
        let work = Work::Bands { pipeline: pipelines.bands.clone(), size, coefficients };
        builder.stage("relight environment bands", PassKind::Compute, uses, work, once(false));
        let uses = vec![(Resource::MapCoefficients, read), (Resource::EnvironmentLight, write)];
        let work = Work::Rotate {
            pipeline: pipelines.rotate.clone(),
            source: Resource::MapCoefficients,
            target: Resource::EnvironmentLight,
            rotations: Rotations::fixed(map_frame()),
            strides: Pair::new(0, 0),
        };
        builder.stage("relight environment frame", PassKind::Compute, uses, work, once(true));
        Ok(())
    }

    /// Bytes from the light of one instance to the next: a multiple of the largest alignment of uniform buffers.
    pub(crate) fn light_stride(&self) -> u64 {
        (16 * self.settings.coefficients() as u64).next_multiple_of(256)
    }

    /// Elements of the lower triangle of a product matrix.
    pub(crate) fn matrix_elements(&self) -> u32 {
        let count = self.settings.coefficients() as u32;
        count * (count + 1) / 2
    }

    /// Bytes from the product matrix of one instance to the next.
    pub(crate) fn matrix_stride(&self) -> u64 {
        (16 * u64::from(self.matrix_elements())).next_multiple_of(256)
    }
}

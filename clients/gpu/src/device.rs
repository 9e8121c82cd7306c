//! Runs compute shaders.

use wgpu::util::{BufferInitDescriptor, DeviceExt};
use wgpu::{BindGroupEntry, BindingResource, BufferUsages};

use crate::export::Tables;

/// A device with its queue.
pub struct Gpu {
    device: wgpu::Device,
    queue: wgpu::Queue,
    /// Names of the device and of its driver.
    pub name: String,
}

/// Tables on the device: a buffer, a texture, or a texture with a filter.
pub enum Bound {
    Buffer(wgpu::Buffer),
    Texture(wgpu::TextureView),
    /// One or two of them.
    Filtered(Vec<wgpu::TextureView>, wgpu::Sampler),
}

/// Texels for a filter; a depth of 0 makes the texture two-dimensional.
pub struct Filtered {
    pub size: [u32; 3],
    pub format: wgpu::TextureFormat,
    pub texels: Vec<u8>,
}

/// A program with the tables that it reads.
pub struct Program {
    pipeline: wgpu::ComputePipeline,
    tables: Bound,
}

/// What is used where a device has it.
const OPTIONAL: wgpu::Features =
    wgpu::Features::FLOAT32_FILTERABLE.union(wgpu::Features::SHADER_F16);

impl Gpu {
    /// The software driver of Vulkan, or any hardware if `hardware` is true.
    pub fn new(hardware: bool) -> Result<Self, String> {
        let mut descriptor = wgpu::InstanceDescriptor::new_without_display_handle();
        descriptor.backends = wgpu::Backends::VULKAN;
        let instance = wgpu::Instance::new(descriptor);
        let options =
            wgpu::RequestAdapterOptions { force_fallback_adapter: !hardware, ..Default::default() };
        let adapter = pollster::block_on(instance.request_adapter(&options))
            .map_err(|why| format!("no driver of Vulkan: {why}"))?;
        let descriptor = wgpu::DeviceDescriptor {
            required_limits: adapter.limits(),
            required_features: adapter.features() & OPTIONAL,
            ..Default::default()
        };
        let (device, queue) = pollster::block_on(adapter.request_device(&descriptor))
            .map_err(|why| why.to_string())?;
        let info = adapter.get_info();
        Ok(Self { device, queue, name: format!("{}, {}", info.name, info.driver_info) })
    }

    /// Tables as a storage buffer.
    pub fn buffer(&self, tables: &Tables) -> Bound {
        Bound::Buffer(self.filled(&tables.bytes, BufferUsages::STORAGE))
    }

    /// Tables as a texture.
    pub fn texture(&self, tables: &Tables) -> Bound {
        let size = [tables.width, tables.height, 0];
        Bound::Texture(self.view(size, tables.format, &tables.bytes))
    }

    /// Whether it filters textures of 32-bit floats.
    pub fn filters_singles(&self) -> bool {
        self.device.features().contains(wgpu::Features::FLOAT32_FILTERABLE)
    }

    /// Whether it computes in half precision.
    pub fn has_halves(&self) -> bool {
        self.device.features().contains(wgpu::Features::SHADER_F16)
    }

    /// Textures read by a linear filter that clamps at the edges.
    pub fn filtered(&self, textures: &[Filtered]) -> Bound {
        let sampler = self.device.create_sampler(&wgpu::SamplerDescriptor {
            mag_filter: wgpu::FilterMode::Linear,
            min_filter: wgpu::FilterMode::Linear,
            ..Default::default()
        });
        let view = |of: &Filtered| self.view(of.size, of.format, &of.texels);
        Bound::Filtered(textures.iter().map(view).collect(), sampler)
    }

    /// A texture of these texels; a depth of 0 makes it two-dimensional.
    fn view(
        &self,
        [width, height, depth]: [u32; 3],
        format: wgpu::TextureFormat,
        texels: &[u8],
    ) -> wgpu::TextureView {
        let descriptor = wgpu::TextureDescriptor {
            label: None,
            size: wgpu::Extent3d { width, height, depth_or_array_layers: depth.max(1) },
            mip_level_count: 1,
            sample_count: 1,
            dimension: match depth {
                0 => wgpu::TextureDimension::D2,
                _ => wgpu::TextureDimension::D3,
            },
            format,
            usage: wgpu::TextureUsages::TEXTURE_BINDING,
            view_formats: &[],
        };
        let order = wgpu::util::TextureDataOrder::LayerMajor;
        let texture = self.device.create_texture_with_data(&self.queue, &descriptor, order, texels);
        texture.create_view(&Default::default())
    }

    /// A module of WGSL, which is valid.
    pub fn module(&self, wgsl: &str) -> wgpu::ShaderModule {
        let source = wgpu::ShaderSource::Wgsl(wgsl.into());
        self.device.create_shader_module(wgpu::ShaderModuleDescriptor { label: None, source })
    }

    /// A program with its entry point.
    pub fn program(&self, wgsl: &str, entry: &str, tables: Bound) -> Program {
        let module = &self.module(wgsl);
        let pipeline = self.device.create_compute_pipeline(&wgpu::ComputePipelineDescriptor {
            label: None,
            layout: None,
            module,
            entry_point: Some(entry),
            compilation_options: Default::default(),
            cache: None,
        });
        Program { pipeline, tables }
    }

    /// Runs a program, and returns the `output` bytes that it writes to binding 2. `input` is in
    /// binding 1, `uniform`, if any, in binding 3, a filter in binding 4, and a second filtered
    /// texture in binding 5.
    pub fn run(
        &self,
        program: &Program,
        input: &[u8],
        uniform: Option<&[u8]>,
        output: usize,
        groups: u32,
    ) -> Vec<u8> {
        let input = self.filled(input, BufferUsages::STORAGE);
        let uniform = uniform.map(|bytes| self.filled(bytes, BufferUsages::UNIFORM));
        let sized = |usage| {
            let (size, mapped_at_creation) = (output as u64, false);
            let label = None;
            self.device.create_buffer(&wgpu::BufferDescriptor {
                label,
                size,
                usage,
                mapped_at_creation,
            })
        };
        let written = sized(BufferUsages::STORAGE | BufferUsages::COPY_SRC);
        let read = sized(BufferUsages::MAP_READ | BufferUsages::COPY_DST);

        let texture = BindingResource::TextureView;
        let (tables, sampler, second) = match &program.tables {
            Bound::Buffer(buffer) => (buffer.as_entire_binding(), None, None),
            Bound::Texture(view) => (texture(view), None, None),
            Bound::Filtered(views, sampler) => (
                texture(&views[0]),
                Some(BindingResource::Sampler(sampler)),
                views.get(1).map(texture),
            ),
        };
        let resources = [
            Some(tables),
            Some(input.as_entire_binding()),
            Some(written.as_entire_binding()),
            uniform.as_ref().map(|buffer| buffer.as_entire_binding()),
            sampler,
            second,
        ];
        let entries: Vec<BindGroupEntry<'_>> = (0..)
            .zip(resources)
            .filter_map(|(binding, resource)| Some(BindGroupEntry { binding, resource: resource? }))
            .collect();
        let group = self.device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: None,
            layout: &program.pipeline.get_bind_group_layout(0),
            entries: &entries,
        });

        let mut encoder = self.device.create_command_encoder(&Default::default());
        let mut pass = encoder.begin_compute_pass(&Default::default());
        pass.set_pipeline(&program.pipeline);
        pass.set_bind_group(0, &group, &[]);
        pass.dispatch_workgroups(groups, 1, 1);
        drop(pass);
        encoder.copy_buffer_to_buffer(&written, 0, &read, 0, output as u64);
        self.queue.submit([encoder.finish()]);
        let slice = read.slice(..);
        slice.map_async(wgpu::MapMode::Read, |result| result.expect("a mapped buffer"));
        self.device.poll(wgpu::PollType::wait_indefinitely()).expect("the device works");
        slice.get_mapped_range().expect("a mapped buffer").to_vec()
    }

    fn filled(&self, contents: &[u8], usage: BufferUsages) -> wgpu::Buffer {
        self.device.create_buffer_init(&BufferInitDescriptor { label: None, contents, usage })
    }
}

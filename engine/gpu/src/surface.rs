//! A swapchain on a window, for tools that show a picture: its images are imported like any host's.

use crate::context::Context;
use crate::error::GpuError;
use crate::memory::{Image, Label};
use crate::open::{FrameSemaphores, OpenDevice};
use airglow_graph::ImageDesc;
use ash::vk;
use raw_window_handle::{RawDisplayHandle, RawWindowHandle};
use std::ffi::CStr;

/// Device extensions that a [`Surface`] needs.
pub const DEVICE_EXTENSIONS: &[&CStr] = &[ash::khr::swapchain::NAME];

/// Instance extensions that a window of this display needs.
///
/// # Errors
/// [`GpuError::Vulkan`] for a display that Vulkan does not know.
pub fn instance_extensions(display: RawDisplayHandle) -> Result<Vec<&'static CStr>, GpuError> {
    let names = ash_window::enumerate_required_extensions(display).map_err(GpuError::vulkan("ash_window"))?;
    // SAFETY: ash-window's names are nul-terminated constants.
    Ok(names.iter().map(|&name| unsafe { CStr::from_ptr(name) }).collect())
}

/// A window's surface and its swapchain. Dropped before its context and device.
pub struct Surface<'d> {
    device: &'d OpenDevice,
    functions: ash::khr::surface::Instance,
    swapchains: ash::khr::swapchain::Device,
    surface: vk::SurfaceKHR,
    swapchain: vk::SwapchainKHR,
    images: Vec<Image>,
    /// One more than frames in flight, signalled when an image is there.
    acquired: Vec<vk::Semaphore>,
    /// One per image, signalled when it may be shown.
    rendered: Vec<vk::Semaphore>,
    next: usize,
}

/// An image of the swapchain to render to, and the semaphores around it.
pub struct SurfaceFrame {
    /// The image, in layout `UNDEFINED`; to be left in [`airglow_graph::Access::Present`].
    pub image: Image,
    /// For [`crate::open::FrameLoop::frame`].
    pub semaphores: FrameSemaphores,
    index: u32,
}

impl<'d> Surface<'d> {
    /// A surface on a window, with a swapchain of `extent` pixels where the window leaves the choice.
    ///
    /// # Errors
    /// [`GpuError::Misuse`] if the device cannot show on the window, [`GpuError::Vulkan`] if anything fails.
    ///
    /// # Safety
    /// The handles are a live window's, which outlives the surface. The device was opened with
    /// [`instance_extensions`] and [`DEVICE_EXTENSIONS`], and `context` adopted from it.
    pub unsafe fn new(
        device: &'d OpenDevice,
        context: &Context,
        display: RawDisplayHandle,
        window: RawWindowHandle,
        extent: [u32; 2],
    ) -> Result<Self, GpuError> {
        let (entry, instance) = (device.entry(), device.instance());
        // SAFETY: the caller vouches for the window.
        let surface = unsafe { ash_window::create_surface(entry, instance, display, window, None) }
            .map_err(GpuError::vulkan("vkCreateSurface"))?;
        let mut this = Self {
            device,
            functions: ash::khr::surface::Instance::new(entry, instance),
            swapchains: ash::khr::swapchain::Device::new(instance, device.device()),
            surface,
            swapchain: vk::SwapchainKHR::null(),
            images: Vec::new(),
            acquired: Vec::new(),
            rendered: Vec::new(),
            next: 0,
        };
        // SAFETY: live handles of one instance.
        let shows = unsafe {
            this.functions.get_physical_device_surface_support(
                device.physical_device(),
                device.queue_family(),
                surface,
            )
        };
        if !shows.map_err(GpuError::vulkan("vkGetPhysicalDeviceSurfaceSupportKHR"))? {
            let name = &*device.line().name;
            return Err(GpuError::misuse(name, "cannot show on this window; choose another device"));
        }
        // One more than frames in flight: the frame loop waits for a slot only after the next image is acquired.
        for _ in 0..=context.frames_in_flight() {
            this.acquired.push(this.semaphore()?);
        }
        this.resize(context, extent)?;
        Ok(this)
    }

    /// Makes the swapchain again, after the window changed or [`Surface::acquire`] returned nothing. Waits for the
    /// device: windows change seldom.
    ///
    /// # Errors
    /// [`GpuError::Vulkan`] if anything fails.
    pub fn resize(&mut self, context: &Context, extent: [u32; 2]) -> Result<(), GpuError> {
        self.device.wait_idle()?;
        let physical_device = self.device.physical_device();
        // SAFETY: live handles of one instance.
        let (capabilities, formats) = unsafe {
            (
                self.functions
                    .get_physical_device_surface_capabilities(physical_device, self.surface)
                    .map_err(GpuError::vulkan("vkGetPhysicalDeviceSurfaceCapabilitiesKHR"))?,
                self.functions
                    .get_physical_device_surface_formats(physical_device, self.surface)
                    .map_err(GpuError::vulkan("vkGetPhysicalDeviceSurfaceFormatsKHR"))?,
            )
        };
        let srgb = |format: &&vk::SurfaceFormatKHR| {
            matches!(format.format, vk::Format::B8G8R8A8_SRGB | vk::Format::R8G8B8A8_SRGB)
        };
        let Some(format) = formats.iter().find(srgb).or(formats.first()) else {
            return Err(GpuError::misuse("the window", "the device offers no format to show"));
        };
        let [width, height] = chosen_extent(&capabilities, extent);
        let most = if capabilities.max_image_count == 0 { u32::MAX } else { capabilities.max_image_count };
        let usage = vk::ImageUsageFlags::COLOR_ATTACHMENT | vk::ImageUsageFlags::TRANSFER_DST;
        let old = self.swapchain;
        let info = vk::SwapchainCreateInfoKHR::default()
            .surface(self.surface)
            .min_image_count((capabilities.min_image_count + 1).min(most))
            .image_format(format.format)
            .image_color_space(format.color_space)
            .image_extent(vk::Extent2D { width, height })
            .image_array_layers(1)
            .image_usage(usage)
            .pre_transform(capabilities.current_transform)
            .composite_alpha(vk::CompositeAlphaFlagsKHR::OPAQUE)
            .present_mode(vk::PresentModeKHR::FIFO)
            .clipped(true)
            .old_swapchain(old);
        // SAFETY: the device is idle, and the old swapchain is not used after this.
        let raw = unsafe {
            self.swapchain = self
                .swapchains
                .create_swapchain(&info, None)
                .map_err(GpuError::vulkan("vkCreateSwapchainKHR"))?;
            self.images.clear();
            self.swapchains.destroy_swapchain(old, None);
            self.swapchains
                .get_swapchain_images(self.swapchain)
                .map_err(GpuError::vulkan("vkGetSwapchainImagesKHR"))?
        };
        while self.rendered.len() < raw.len() {
            self.rendered.push(self.semaphore()?);
        }
        let desc = ImageDesc { usage, ..ImageDesc::new_2d(width, height, format.format) };
        let label = Label::new("surface", "swapchain");
        // SAFETY: the images live until the swapchain is destroyed, after `images` is cleared on an idle device.
        self.images = raw.into_iter().map(|raw| unsafe { context.import_image(raw, label, &desc) }).collect();
        Ok(())
    }

    /// What every image of the swapchain is.
    pub fn desc(&self) -> Option<&ImageDesc> {
        self.images.first().map(Image::desc)
    }

    /// The next image, or `None` when the swapchain no longer fits the window: [`Surface::resize`] and try again.
    ///
    /// # Errors
    /// [`GpuError::Vulkan`] if anything else fails.
    pub fn acquire(&mut self) -> Result<Option<SurfaceFrame>, GpuError> {
        let wait = self.acquired[self.next];
        // SAFETY: the semaphore's last use was `frames_in_flight` + 1 frames ago, which the frame loop waited for.
        let acquired =
            unsafe { self.swapchains.acquire_next_image(self.swapchain, u64::MAX, wait, vk::Fence::null()) };
        let index = match acquired {
            Ok((index, _)) => index,
            Err(vk::Result::ERROR_OUT_OF_DATE_KHR) => return Ok(None),
            Err(result) => return Err(GpuError::Vulkan { call: "vkAcquireNextImageKHR", result }),
        };
        self.next = (self.next + 1) % self.acquired.len();
        let semaphores = FrameSemaphores { wait: Some(wait), signal: Some(self.rendered[index as usize]) };
        Ok(Some(SurfaceFrame { image: self.images[index as usize].clone(), semaphores, index }))
    }

    /// Shows an image that was rendered in a submitted frame. False when the swapchain no longer fits the window.
    ///
    /// # Errors
    /// [`GpuError::Vulkan`] if anything fails.
    pub fn present(&mut self, frame: SurfaceFrame) -> Result<bool, GpuError> {
        let (swapchains, indices) = ([self.swapchain], [frame.index]);
        let waits = [self.rendered[frame.index as usize]];
        let info = vk::PresentInfoKHR::default()
            .wait_semaphores(&waits)
            .swapchains(&swapchains)
            .image_indices(&indices);
        // SAFETY: the image was acquired and its semaphore is signalled by the frame submitted; this thread alone
        // submits.
        match unsafe { self.swapchains.queue_present(self.device.queue(), &info) } {
            Ok(suboptimal) => Ok(!suboptimal),
            Err(vk::Result::ERROR_OUT_OF_DATE_KHR) => Ok(false),
            Err(result) => Err(GpuError::Vulkan { call: "vkQueuePresentKHR", result }),
        }
    }

    fn semaphore(&self) -> Result<vk::Semaphore, GpuError> {
        // SAFETY: a live device.
        unsafe { self.device.device().create_semaphore(&Default::default(), None) }
            .map_err(GpuError::vulkan("vkCreateSemaphore"))
    }
}

/// The window's own extent, or `wanted` within what it allows.
fn chosen_extent(capabilities: &vk::SurfaceCapabilitiesKHR, wanted: [u32; 2]) -> [u32; 2] {
    let (low, high) = (capabilities.min_image_extent, capabilities.max_image_extent);
    match capabilities.current_extent {
        vk::Extent2D { width: u32::MAX, .. } => {
            [wanted[0].clamp(low.width, high.width), wanted[1].clamp(low.height, high.height)]
        }
        vk::Extent2D { width, height } => [width, height],
    }
}

impl Drop for Surface<'_> {
    fn drop(&mut self) {
        // A lost device has finished too.
        let _ = self.device.wait_idle();
        self.images.clear();
        // SAFETY: the device is idle; children go before the surface.
        unsafe {
            for &semaphore in self.acquired.iter().chain(&self.rendered) {
                self.device.device().destroy_semaphore(semaphore, None);
            }
            self.swapchains.destroy_swapchain(self.swapchain, None);
            self.functions.destroy_surface(self.surface, None);
        }
    }
}

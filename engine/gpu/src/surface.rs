//! A swapchain on a window, for tools that show a picture: its images are imported like any host's.

use crate::context::Context;
use crate::error::GpuError;
use crate::memory::{Image, Label};
use crate::open::{FrameSemaphores, OpenDevice};
use airglow_graph::{ImageDesc, State};
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

/// The state in which a plan finds an acquired image: [`FrameSemaphores::wait`] holds back every stage, so that the
/// first barrier must follow on from them all.
pub const ACQUIRED: State = State { stage: vk::PipelineStageFlags2::ALL_COMMANDS, ..State::UNDEFINED };

/// Replaced swapchains that are kept until they are no longer shown; for more, the device is waited for.
const MOST_REPLACED: usize = 8;

/// A window's surface and its swapchain. Dropped before its window, its context and its device.
///
/// The swapchain has 8-bit texels that hold sRGB-encoded values, in an order that [`Surface::desc`] tells.
pub struct Surface<'d> {
    device: &'d OpenDevice,
    functions: ash::khr::surface::Instance,
    swapchains: ash::khr::swapchain::Device,
    surface: vk::SurfaceKHR,
    /// Null while the window has no pixels.
    swapchain: vk::SwapchainKHR,
    images: Vec<Image>,
    /// One more than frames in flight, signalled when an image is there.
    acquired: Vec<vk::Semaphore>,
    /// One per image, signalled when it may be shown.
    rendered: Vec<vk::Semaphore>,
    replaced: Vec<Replaced>,
    /// Images acquired so far; modulo their number it finds the next semaphore.
    acquires: u64,
}

/// A swapchain that may still be shown.
struct Replaced {
    swapchain: vk::SwapchainKHR,
    rendered: Vec<vk::Semaphore>,
    /// It is gone from the screen when so many images have been acquired.
    gone_at: u64,
}

/// An image of the swapchain to render to, and the semaphores around it. The image is for this frame only.
pub struct SurfaceFrame {
    /// The image, in state [`ACQUIRED`]; to be left in [`airglow_graph::Access::Present`].
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
            replaced: Vec::new(),
            acquires: 0,
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

    /// Makes the swapchain again, after the window changed or [`Surface::acquire`] returned nothing. The swapchain
    /// before it lives on until it is no longer shown; nothing is waited for, unless many were replaced in a row.
    ///
    /// A window without pixels, such as a minimised one, has no swapchain: resize again when it has some.
    ///
    /// # Errors
    /// [`GpuError::Misuse`] if the window takes no 8-bit sRGB images or none that are copied to,
    /// [`GpuError::is_surface_lost`] if the surface must be made again, other [`GpuError::Vulkan`] if anything else
    /// fails.
    pub fn resize(&mut self, context: &Context, extent: [u32; 2]) -> Result<(), GpuError> {
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
        let format = chosen_format(&formats)?;
        let usage = vk::ImageUsageFlags::COLOR_ATTACHMENT | vk::ImageUsageFlags::TRANSFER_DST;
        if !capabilities.supported_usage_flags.contains(usage) {
            let problem = "its images cannot be copied to; choose another device";
            return Err(GpuError::misuse("the window", problem));
        }
        // For pictures of what is shown, where windows allow them.
        let usage = usage | capabilities.supported_usage_flags & vk::ImageUsageFlags::TRANSFER_SRC;
        let [width, height] = chosen_extent(&capabilities, extent);
        if width == 0 || height == 0 {
            return self.replace(context, vk::SwapchainKHR::null(), Vec::new());
        }
        let most = if capabilities.max_image_count == 0 { u32::MAX } else { capabilities.max_image_count };
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
            .old_swapchain(self.swapchain);
        // SAFETY: a live surface and device; the old swapchain gives no more images after this.
        let swapchain = unsafe { self.swapchains.create_swapchain(&info, None) }
            .map_err(GpuError::vulkan("vkCreateSwapchainKHR"))?;
        // SAFETY: the swapchain just made.
        let raw = unsafe { self.swapchains.get_swapchain_images(swapchain) };
        let desc = ImageDesc { usage, ..ImageDesc::new_2d(width, height, format.format) };
        let label = Label::new("surface", "swapchain");
        // SAFETY: the images live until the swapchain is destroyed, when the frames that used them are done.
        let import = |raw| unsafe { context.import_image(raw, label, &desc) };
        let images = raw.as_ref().map_or(Vec::new(), |raw| raw.iter().copied().map(import).collect());
        self.replace(context, swapchain, images)?;
        raw.map(|_| ()).map_err(GpuError::vulkan("vkGetSwapchainImagesKHR"))
    }

    /// Puts a swapchain in place of the one before.
    fn replace(
        &mut self,
        context: &Context,
        swapchain: vk::SwapchainKHR,
        images: Vec<Image>,
    ) -> Result<(), GpuError> {
        // After one acquisition more than there are images, one image was acquired again: its own showing, and with it
        // whatever was queued before, is over. That acquisition is known to be done when the frames in flight are.
        let gone_at = self.acquires + images.len() as u64 + 1 + u64::from(context.frames_in_flight());
        self.images = images;
        let old = std::mem::replace(&mut self.swapchain, swapchain);
        let rendered = std::mem::take(&mut self.rendered);
        self.replaced.push(Replaced { swapchain: old, rendered, gone_at });
        self.replaced.iter_mut().for_each(|replaced| replaced.gone_at = gone_at);
        if self.replaced.len() > MOST_REPLACED {
            self.device.wait_idle()?;
            self.destroy_replaced(u64::MAX);
        }
        while self.rendered.len() < self.images.len() {
            self.rendered.push(self.semaphore()?);
        }
        Ok(())
    }

    /// Destroys what is gone when `acquires` images have been acquired.
    fn destroy_replaced(&mut self, acquires: u64) {
        for replaced in self.replaced.extract_if(.., |replaced| replaced.gone_at <= acquires) {
            // SAFETY: its images and semaphores are no longer in use; see `replace`, or the device was waited for.
            unsafe {
                for semaphore in replaced.rendered {
                    self.device.device().destroy_semaphore(semaphore, None);
                }
                self.swapchains.destroy_swapchain(replaced.swapchain, None);
            }
        }
    }

    /// What every image of the swapchain is.
    pub fn desc(&self) -> Option<&ImageDesc> {
        self.images.first().map(Image::desc)
    }

    /// The next image, or `None` when the swapchain no longer fits the window or the window has no pixels:
    /// [`Surface::resize`] and try again.
    ///
    /// # Errors
    /// [`GpuError::is_surface_lost`] if the surface must be made again, other [`GpuError::Vulkan`] if anything else
    /// fails.
    pub fn acquire(&mut self) -> Result<Option<SurfaceFrame>, GpuError> {
        if self.images.is_empty() {
            return Ok(None);
        }
        let wait = self.acquired[(self.acquires % self.acquired.len() as u64) as usize];
        // SAFETY: the semaphore's last use was `frames_in_flight` + 1 frames ago, which the frame loop waited for.
        let acquired =
            unsafe { self.swapchains.acquire_next_image(self.swapchain, u64::MAX, wait, vk::Fence::null()) };
        let index = match acquired {
            Ok((index, _)) => index,
            Err(vk::Result::ERROR_OUT_OF_DATE_KHR) => return Ok(None),
            Err(result) => return Err(GpuError::Vulkan { call: "vkAcquireNextImageKHR", result }),
        };
        self.acquires += 1;
        self.destroy_replaced(self.acquires);
        let semaphores = FrameSemaphores { wait: Some(wait), signal: Some(self.rendered[index as usize]) };
        Ok(Some(SurfaceFrame { image: self.images[index as usize].clone(), semaphores, index }))
    }

    /// Shows an image that was rendered in a submitted frame. False when the swapchain no longer fits the window.
    ///
    /// # Errors
    /// As [`Surface::acquire`].
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

/// 8-bit texels that hold sRGB-encoded values.
fn chosen_format(formats: &[vk::SurfaceFormatKHR]) -> Result<vk::SurfaceFormatKHR, GpuError> {
    use vk::Format;
    const WANTED: [Format; 4] =
        [Format::B8G8R8A8_UNORM, Format::R8G8B8A8_UNORM, Format::B8G8R8A8_SRGB, Format::R8G8B8A8_SRGB];
    let offered = |format: &Format| {
        let srgb = vk::ColorSpaceKHR::SRGB_NONLINEAR;
        formats.iter().find(|offered| offered.format == *format && offered.color_space == srgb)
    };
    WANTED.iter().find_map(offered).copied().ok_or_else(|| {
        let offered: Vec<_> = formats.iter().map(|offered| offered.format).collect();
        let problem = format!("it takes {offered:?}, not the 8-bit sRGB expected; choose another device");
        GpuError::misuse("the window", problem)
    })
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
        self.destroy_replaced(u64::MAX);
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

//! A swapchain on a window.

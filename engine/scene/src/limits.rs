//! Caps on what a file may ask for, checked before memory is taken; each names what it protects.

/// Most bytes of any file read whole: 1 GiB.
pub const MAX_FILE_BYTES: u64 = 1 << 30;

/// Most bytes of a scene file, which is written by hand: 1 MiB.
pub const MAX_SCENE_FILE_BYTES: u64 = 1 << 20;

/// Most pixels of one image: 8192 x 4096, which is 384 MiB of RGB in f32.
pub const MAX_IMAGE_PIXELS: u64 = 1 << 25;

/// Longest side of an image, in pixels.
pub const MAX_IMAGE_SIDE: u64 = 1 << 15;

/// Most pixels of all textures of one glTF file together: 1 GiB of RGBA in 8 bits.
pub const MAX_TEXTURE_PIXELS: u64 = 1 << 28;

/// Most elements of one accessor, and most vertices of all primitives of one glTF file together.
pub const MAX_VERTICES: u64 = 1 << 25;

/// Most indices of all primitives of one glTF file together, after strips and fans became lists.
pub const MAX_INDICES: u64 = 3 << 25;

/// Most instances (primitives placed by nodes) of a scene.
pub const MAX_INSTANCES: u64 = 1 << 20;

/// Deepest chain of nodes in a glTF file.
pub const MAX_NODE_DEPTH: usize = 1024;

/// Largest coordinate of a placed vertex, metres; squares of distances then stay far inside the range of f32.
pub const MAX_COORDINATE: f32 = 1e12;

//! Handles: which resource, which version of its contents, which mips and layers.

use std::marker::PhantomData;

/// Marks a [`Handle`] to a buffer.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Buffer {}

/// Marks a [`Handle`] to an image.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Image {}

/// What a [`Handle`] can point at: [`Buffer`] or [`Image`].
pub trait Kind: sealed::Sealed + Copy + 'static {}
impl Kind for Buffer {}
impl Kind for Image {}

mod sealed {
    pub trait Sealed {}
    impl Sealed for super::Buffer {}
    impl Sealed for super::Image {}
}

/// A resource of one graph, and its index in [`Plan::resources`](crate::Plan::resources).
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct ResourceId(pub(crate) u32);

impl ResourceId {
    /// The position in [`Plan::resources`](crate::Plan::resources).
    pub fn index(self) -> usize {
        self.0 as usize
    }
}

/// A rectangle of subresources: a run of mip levels by a run of array layers.
///
/// A count of [`ImageRange::REMAINING`] means all from the base on; a compiled plan holds resolved counts
/// only. A buffer is one subresource: mip 0, layer 0.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct ImageRange {
    /// First mip level.
    pub base_mip: u32,
    /// Number of mip levels.
    pub mips: u32,
    /// First array layer.
    pub base_layer: u32,
    /// Number of array layers (6 per cube).
    pub layers: u32,
}

impl ImageRange {
    /// "All from the base on", as `VK_REMAINING_MIP_LEVELS` and `VK_REMAINING_ARRAY_LAYERS`.
    pub const REMAINING: u32 = u32::MAX;

    /// Every mip of every layer.
    pub const WHOLE: Self =
        Self { base_mip: 0, mips: Self::REMAINING, base_layer: 0, layers: Self::REMAINING };

    /// The range with its counts resolved against a resource of `mips` by `layers` subresources, or `None`
    /// when it is empty or reaches outside.
    pub fn resolve(self, mips: u32, layers: u32) -> Option<Self> {
        let count = |base: u32, count: u32, total: u32| {
            let left = total.checked_sub(base)?;
            let count = if count == Self::REMAINING { left } else { count };
            (count > 0 && count <= left).then_some(count)
        };
        Some(Self {
            mips: count(self.base_mip, self.mips, mips)?,
            layers: count(self.base_layer, self.layers, layers)?,
            ..self
        })
    }

    /// Whether two resolved ranges share a subresource.
    pub fn overlaps(self, other: Self) -> bool {
        let meet = |a: u32, count_a: u32, b: u32, count_b: u32| {
            a < b.saturating_add(count_b) && b < a.saturating_add(count_a)
        };
        meet(self.base_mip, self.mips, other.base_mip, other.mips)
            && meet(self.base_layer, self.layers, other.base_layer, other.layers)
    }

    /// The (mip, layer) pairs of a resolved range, mip by mip.
    pub fn subresources(self) -> impl Iterator<Item = (u32, u32)> {
        (self.base_mip..self.base_mip.saturating_add(self.mips)).flat_map(move |mip| {
            (self.base_layer..self.base_layer.saturating_add(self.layers)).map(move |l| (mip, l))
        })
    }
}

/// Names one version of a resource, and which part of it.
///
/// Writing returns a handle to the next version; reading names the version whose contents are wanted.
/// A version is a state of the whole resource: after writing mip 0 and then mip 1 of what that returned,
/// [`whole`](Self::whole) of the last handle names both. A handle is plain data, valid in the graph that made it.
#[derive(Debug, PartialEq, Eq, Hash)]
pub struct Handle<T: Kind> {
    pub(crate) resource: ResourceId,
    pub(crate) version: u32,
    pub(crate) range: ImageRange,
    pub(crate) kind: PhantomData<T>,
}

impl<T: Kind> Clone for Handle<T> {
    fn clone(&self) -> Self {
        *self
    }
}
impl<T: Kind> Copy for Handle<T> {}

impl<T: Kind> Handle<T> {
    pub(crate) fn new(resource: ResourceId, version: u32, range: ImageRange) -> Self {
        Self { resource, version, range, kind: PhantomData }
    }

    /// The resource.
    pub fn resource(&self) -> ResourceId {
        self.resource
    }

    /// The version: 0 is what the resource held before the graph, each write makes the next.
    pub fn version(&self) -> u32 {
        self.version
    }
}

impl Handle<Image> {
    /// The part of the image this handle names; counts may be [`ImageRange::REMAINING`].
    pub fn range(&self) -> ImageRange {
        self.range
    }

    /// The same version, whole image.
    pub fn whole(self) -> Self {
        Self { range: ImageRange::WHOLE, ..self }
    }

    /// The same version and layers, `count` mips from `base` of the image on.
    pub fn mips(self, base: u32, count: u32) -> Self {
        Self { range: ImageRange { base_mip: base, mips: count, ..self.range }, ..self }
    }

    /// The same version and layers, one mip of the image.
    pub fn mip(self, mip: u32) -> Self {
        self.mips(mip, 1)
    }

    /// The same version and mips, `count` array layers from `base` of the image on.
    pub fn layers(self, base: u32, count: u32) -> Self {
        Self { range: ImageRange { base_layer: base, layers: count, ..self.range }, ..self }
    }

    /// The same version and mips, one array layer of the image.
    pub fn layer(self, layer: u32) -> Self {
        self.layers(layer, 1)
    }
}

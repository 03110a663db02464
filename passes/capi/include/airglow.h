/* airglow: real-time lighting passes for Vulkan. MIT OR Apache-2.0.
 *
 * Made from passes/capi by `cargo run -p xtask -- header`; edit the source there. It needs no other header: handles of
 * Vulkan are integers, 0 for null, and flags, formats, layouts and results are Vulkan's own numbers.
 *
 * Structures that begin with `struct_size` are versioned. Clear them and set it to their sizeof; zero is every other
 * field's default unless it says otherwise. A smaller structure, of an older header, is accepted; a larger one, of a
 * newer header, while the part unknown to this version is zero.
 *
 * Functions return a status. Their last argument, which may be null, takes the message. No panic leaves the library.
 */

#ifndef AIRGLOW_H
#define AIRGLOW_H

#include <stddef.h>
#include <stdint.h>

/**
 * Pixels along a side of a tile.
 */
#define AIRGLOW_FOG_TILE 64

/**
 * The instance brings light of each vertex, bound as `AIRGLOW_RELIGHT_RESOURCE_VERTEX_LIGHT`.
 */
#define AIRGLOW_INPUT_LIGHT 1

/**
 * The instance brings dynamic visibility, bound as `AIRGLOW_RELIGHT_RESOURCE_VISIBILITY`.
 */
#define AIRGLOW_INPUT_VISIBILITY 2

/**
 * The instance brings normals, bound as `AIRGLOW_RELIGHT_RESOURCE_NORMALS`.
 */
#define AIRGLOW_INPUT_NORMALS 4

/**
 * Bytes of the message of an error, the nul included.
 */
#define AIRGLOW_MESSAGE_SIZE 1008

/**
 * How a call went.
 */
enum AirglowStatus
#if defined(__cplusplus) || __STDC_VERSION__ >= 202311L
  : uint32_t
#endif // defined(__cplusplus) || __STDC_VERSION__ >= 202311L
 {
  /**
   * It did what was asked.
   */
  AIRGLOW_STATUS_OK = 0,
  /**
   * An array or text of the caller was too small: its count or length says what is needed, the beginning is filled.
   */
  AIRGLOW_STATUS_INCOMPLETE = 1,
  /**
   * An argument is null, misaligned, out of range, or does not fit the others. Nothing was changed.
   */
  AIRGLOW_STATUS_INVALID_ARGUMENT = 2,
  /**
   * The `struct_size` of a structure is zero, too small, or larger with a tail that is not zero.
   */
  AIRGLOW_STATUS_INVALID_STRUCT = 3,
  /**
   * The device lacks something required; the message names it.
   */
  AIRGLOW_STATUS_MISSING = 4,
  /**
   * No memory, or none left in the budget. Nothing was changed.
   */
  AIRGLOW_STATUS_OUT_OF_MEMORY = 5,
  /**
   * The device is lost: nothing more can be recorded; dropping everything stays safe.
   */
  AIRGLOW_STATUS_DEVICE_LOST = 6,
  /**
   * Another Vulkan call failed; `vulkan_result` in the error says with what.
   */
  AIRGLOW_STATUS_VULKAN = 7,
  /**
   * The caller's own callback asked to stop.
   */
  AIRGLOW_STATUS_CANCELLED = 8,
  /**
   * A defect of the library: it panicked, and the panic was caught. Drop the objects of the call.
   */
  AIRGLOW_STATUS_INTERNAL = 9,
};
#ifndef __cplusplus
#if __STDC_VERSION__ >= 202311L
typedef enum AirglowStatus AirglowStatus;
#else
typedef uint32_t AirglowStatus;
#endif // __STDC_VERSION__ >= 202311L
#endif // __cplusplus

/**
 * One of the six directions along a host's axes.
 */
enum AirglowAxis
#if defined(__cplusplus) || __STDC_VERSION__ >= 202311L
  : uint32_t
#endif // defined(__cplusplus) || __STDC_VERSION__ >= 202311L
 {
  /**
   * As airglow has it: +X right, +Y up, -Z forward.
   */
  AIRGLOW_AXIS_DEFAULT = 0,
  /**
   * +X.
   */
  AIRGLOW_AXIS_PLUS_X = 1,
  /**
   * -X.
   */
  AIRGLOW_AXIS_MINUS_X = 2,
  /**
   * +Y.
   */
  AIRGLOW_AXIS_PLUS_Y = 3,
  /**
   * -Y.
   */
  AIRGLOW_AXIS_MINUS_Y = 4,
  /**
   * +Z.
   */
  AIRGLOW_AXIS_PLUS_Z = 5,
  /**
   * -Z.
   */
  AIRGLOW_AXIS_MINUS_Z = 6,
};
#ifndef __cplusplus
#if __STDC_VERSION__ >= 202311L
typedef enum AirglowAxis AirglowAxis;
#else
typedef uint32_t AirglowAxis;
#endif // __STDC_VERSION__ >= 202311L
#endif // __cplusplus

/**
 * What visibility is below the tangent plane of a vertex, where no ray is traced.
 */
enum AirglowBelowHorizon
#if defined(__cplusplus) || __STDC_VERSION__ >= 202311L
  : uint32_t
#endif // defined(__cplusplus) || __STDC_VERSION__ >= 202311L
 {
  /**
   * The share of the cosine-weighted upper hemisphere that is free.
   */
  AIRGLOW_BELOW_HORIZON_MEAN = 0,
  /**
   * 1: what other geometry blocks, without the vertex's own surface.
   */
  AIRGLOW_BELOW_HORIZON_VISIBLE = 1,
  /**
   * 0: the surface blocks its own lower hemisphere.
   */
  AIRGLOW_BELOW_HORIZON_BLOCKED = 2,
};
#ifndef __cplusplus
#if __STDC_VERSION__ >= 202311L
typedef enum AirglowBelowHorizon AirglowBelowHorizon;
#else
typedef uint32_t AirglowBelowHorizon;
#endif // __STDC_VERSION__ >= 202311L
#endif // __cplusplus

/**
 * What a background uses.
 */
enum AirglowFogBackgroundResource
#if defined(__cplusplus) || __STDC_VERSION__ >= 202311L
  : uint32_t
#endif // defined(__cplusplus) || __STDC_VERSION__ >= 202311L
 {
  /**
   * The environment of the host's, equirectangular, linear radiance; its first mip.
   */
  AIRGLOW_FOG_BACKGROUND_RESOURCE_ENVIRONMENT = 0,
  /**
   * The picture of the host's, equirectangular, of any size, in the format of the settings; all of it is written.
   */
  AIRGLOW_FOG_BACKGROUND_RESOURCE_TARGET = 1,
  /**
   * Sums over parts of the environment.
   */
  AIRGLOW_FOG_BACKGROUND_RESOURCE_PARTS = 2,
};
#ifndef __cplusplus
#if __STDC_VERSION__ >= 202311L
typedef enum AirglowFogBackgroundResource AirglowFogBackgroundResource;
#else
typedef uint32_t AirglowFogBackgroundResource;
#endif // __STDC_VERSION__ >= 202311L
#endif // __cplusplus

/**
 * The kind of phase function; its numbers come with a view.
 */
enum AirglowFogPhase
#if defined(__cplusplus) || __STDC_VERSION__ >= 202311L
  : uint32_t
#endif // defined(__cplusplus) || __STDC_VERSION__ >= 202311L
 {
  /**
   * Henyey and Greenstein's, of mean cosine g: `phase[0]`.
   */
  AIRGLOW_FOG_PHASE_HENYEY_GREENSTEIN = 0,
  /**
   * Alike in all directions.
   */
  AIRGLOW_FOG_PHASE_ISOTROPIC = 1,
  /**
   * The sum of `phase[k]` times the kth power of the cosine; the weights hold the 1 / (4 pi).
   */
  AIRGLOW_FOG_PHASE_POLYNOMIAL = 2,
  /**
   * Draine's: g is `phase[0]`, alpha `phase[1]`.
   */
  AIRGLOW_FOG_PHASE_DRAINE = 3,
};
#ifndef __cplusplus
#if __STDC_VERSION__ >= 202311L
typedef enum AirglowFogPhase AirglowFogPhase;
#else
typedef uint32_t AirglowFogPhase;
#endif // __STDC_VERSION__ >= 202311L
#endif // __cplusplus

/**
 * How exactly the airlight is computed.
 */
enum AirglowFogPreset
#if defined(__cplusplus) || __STDC_VERSION__ >= 202311L
  : uint32_t
#endif // defined(__cplusplus) || __STDC_VERSION__ >= 202311L
 {
  /**
   * 6 points of quadrature a light and pixel.
   */
  AIRGLOW_FOG_PRESET_DEFAULT = 0,
  /**
   * 16 points of quadrature a light and pixel.
   */
  AIRGLOW_FOG_PRESET_REFERENCE = 1,
};
#ifndef __cplusplus
#if __STDC_VERSION__ >= 202311L
typedef enum AirglowFogPreset AirglowFogPreset;
#else
typedef uint32_t AirglowFogPreset;
#endif // __STDC_VERSION__ >= 202311L
#endif // __cplusplus

/**
 * What the pass uses; all are images of the host's, the index is the view.
 */
enum AirglowFogResource
#if defined(__cplusplus) || __STDC_VERSION__ >= 202311L
  : uint32_t
#endif // defined(__cplusplus) || __STDC_VERSION__ >= 202311L
 {
  /**
   * Scene-linear radiance of the surfaces without the medium, any float format.
   */
  AIRGLOW_FOG_RESOURCE_SURFACE = 0,
  /**
   * Their depth, by the host's `AirglowWorld`; the farthest value shows no surface.
   */
  AIRGLOW_FOG_RESOURCE_DEPTH = 1,
  /**
   * The picture through the medium, in the format of the settings; all of it is written.
   */
  AIRGLOW_FOG_RESOURCE_TARGET = 2,
};
#ifndef __cplusplus
#if __STDC_VERSION__ >= 202311L
typedef enum AirglowFogResource AirglowFogResource;
#else
typedef uint32_t AirglowFogResource;
#endif // __STDC_VERSION__ >= 202311L
#endif // __cplusplus

/**
 * What a picture of an environment holds.
 */
enum AirglowFogSeen
#if defined(__cplusplus) || __STDC_VERSION__ >= 202311L
  : uint32_t
#endif // defined(__cplusplus) || __STDC_VERSION__ >= 202311L
 {
  /**
   * All that is seen: what arrives straight, and the glow.
   */
  AIRGLOW_FOG_SEEN_WHOLE = 0,
  /**
   * The glow alone, smooth but for its peaks: for a host that has a smaller picture of it, and adds exp(-optical
   * distance) of the environment itself.
   */
  AIRGLOW_FOG_SEEN_GLOW = 1,
};
#ifndef __cplusplus
#if __STDC_VERSION__ >= 202311L
typedef enum AirglowFogSeen AirglowFogSeen;
#else
typedef uint32_t AirglowFogSeen;
#endif // __STDC_VERSION__ >= 202311L
#endif // __cplusplus

/**
 * The light of a frame.
 */
enum AirglowLight
#if defined(__cplusplus) || __STDC_VERSION__ >= 202311L
  : uint32_t
#endif // defined(__cplusplus) || __STDC_VERSION__ >= 202311L
 {
  /**
   * There is none: the pass is left out, and nothing is written.
   */
  AIRGLOW_LIGHT_NONE = 0,
  /**
   * The environment given with `airglow_relight_set_environment`.
   */
  AIRGLOW_LIGHT_ENVIRONMENT = 1,
  /**
   * An environment in an image of the host's, bound as `AIRGLOW_RELIGHT_RESOURCE_ENVIRONMENT`.
   */
  AIRGLOW_LIGHT_ENVIRONMENT_IMAGE = 2,
  /**
   * SH RGB in a buffer of the host's, bound as `AIRGLOW_RELIGHT_RESOURCE_UNIFORM_LIGHT`: four floats a coefficient, the
   * fourth unused.
   */
  AIRGLOW_LIGHT_UNIFORM = 3,
  /**
   * Each instance brings the light of its vertices; for `AIRGLOW_LIGHT_KIND_VERTEX`.
   */
  AIRGLOW_LIGHT_VERTICES = 4,
};
#ifndef __cplusplus
#if __STDC_VERSION__ >= 202311L
typedef enum AirglowLight AirglowLight;
#else
typedef uint32_t AirglowLight;
#endif // __STDC_VERSION__ >= 202311L
#endif // __cplusplus

/**
 * What kind of light arrives.
 */
enum AirglowLightKind
#if defined(__cplusplus) || __STDC_VERSION__ >= 202311L
  : uint32_t
#endif // defined(__cplusplus) || __STDC_VERSION__ >= 202311L
 {
  /**
   * One SH RGB vector for a mesh, rotated into the space of each instance.
   */
  AIRGLOW_LIGHT_KIND_UNIFORM = 0,
  /**
   * One SH RGB vector for each vertex, already in the space of the instance.
   */
  AIRGLOW_LIGHT_KIND_VERTEX = 1,
};
#ifndef __cplusplus
#if __STDC_VERSION__ >= 202311L
typedef enum AirglowLightKind AirglowLightKind;
#else
typedef uint32_t AirglowLightKind;
#endif // __STDC_VERSION__ >= 202311L
#endif // __cplusplus

/**
 * How a texture holds its lobes.
 */
enum AirglowLobeStorage
#if defined(__cplusplus) || __STDC_VERSION__ >= 202311L
  : uint32_t
#endif // defined(__cplusplus) || __STDC_VERSION__ >= 202311L
 {
  /**
   * `VK_FORMAT_R16G16B16A16_SFLOAT`.
   */
  AIRGLOW_LOBE_STORAGE_F16 = 0,
  /**
   * `VK_FORMAT_R8G8B8A8_SNORM`: half the bytes, for matt materials.
   */
  AIRGLOW_LOBE_STORAGE_SNORM8 = 1,
  /**
   * `VK_FORMAT_R8G8B8A8_UNORM`: axis, width and weight, for `normals_octahedral` of `normals/lobe.glsl`; nearer than the other
   * in as many bytes.
   */
  AIRGLOW_LOBE_STORAGE_OCTAHEDRAL8 = 2,
};
#ifndef __cplusplus
#if __STDC_VERSION__ >= 202311L
typedef enum AirglowLobeStorage AirglowLobeStorage;
#else
typedef uint32_t AirglowLobeStorage;
#endif // __STDC_VERSION__ >= 202311L
#endif // __cplusplus

/**
 * Who touches a piece of memory.
 */
enum AirglowLocation
#if defined(__cplusplus) || __STDC_VERSION__ >= 202311L
  : uint32_t
#endif // defined(__cplusplus) || __STDC_VERSION__ >= 202311L
 {
  /**
   * The device only.
   */
  AIRGLOW_LOCATION_DEVICE = 0,
  /**
   * Written by the CPU, read by the device: mapped, host-coherent.
   */
  AIRGLOW_LOCATION_UPLOAD = 1,
  /**
   * Written by the device, read by the CPU: mapped, host-coherent, cached where there is a choice.
   */
  AIRGLOW_LOCATION_READBACK = 2,
};
#ifndef __cplusplus
#if __STDC_VERSION__ >= 202311L
typedef enum AirglowLocation AirglowLocation;
#else
typedef uint32_t AirglowLocation;
#endif // __STDC_VERSION__ >= 202311L
#endif // __cplusplus

/**
 * How it is written.
 */
enum AirglowMethod
#if defined(__cplusplus) || __STDC_VERSION__ >= 202311L
  : uint32_t
#endif // defined(__cplusplus) || __STDC_VERSION__ >= 202311L
 {
  /**
   * A compute pass writes the vertex buffer.
   */
  AIRGLOW_METHOD_COMPUTE = 0,
  /**
   * A fragment pass over a packed rectangle, copied into the vertex buffer; colours only, the same bits.
   */
  AIRGLOW_METHOD_FRAGMENT = 1,
};
#ifndef __cplusplus
#if __STDC_VERSION__ >= 202311L
typedef enum AirglowMethod AirglowMethod;
#else
typedef uint32_t AirglowMethod;
#endif // __STDC_VERSION__ >= 202311L
#endif // __cplusplus

/**
 * What an `AirglowNeed` is about.
 */
enum AirglowNeedKind
#if defined(__cplusplus) || __STDC_VERSION__ >= 202311L
  : uint32_t
#endif // defined(__cplusplus) || __STDC_VERSION__ >= 202311L
 {
  /**
   * The API version of instance and device: `value` as `VK_MAKE_API_VERSION` packs it.
   */
  AIRGLOW_NEED_KIND_API_VERSION = 0,
  /**
   * An extension of the instance.
   */
  AIRGLOW_NEED_KIND_INSTANCE_EXTENSION = 1,
  /**
   * An extension of the device.
   */
  AIRGLOW_NEED_KIND_DEVICE_EXTENSION = 2,
  /**
   * An extension of a device below Vulkan 1.3, where it stands for a feature that is core later.
   */
  AIRGLOW_NEED_KIND_DEVICE_EXTENSION_BELOW13 = 3,
  /**
   * A feature, by its field's name in the Vulkan specification.
   */
  AIRGLOW_NEED_KIND_FEATURE = 4,
  /**
   * A limit by its field's name; `value` is the least it may be, in its own unit.
   */
  AIRGLOW_NEED_KIND_LIMIT = 5,
  /**
   * A format: `value` is the `VkFormat`, `flags` the `VkFormatFeatureFlags` asked of images with optimal tiling, and
   * of buffers for vertex input.
   */
  AIRGLOW_NEED_KIND_FORMAT = 6,
  /**
   * The queue family that commands are submitted to: `flags` are its `VkQueueFlags`.
   */
  AIRGLOW_NEED_KIND_QUEUE = 7,
};
#ifndef __cplusplus
#if __STDC_VERSION__ >= 202311L
typedef enum AirglowNeedKind AirglowNeedKind;
#else
typedef uint32_t AirglowNeedKind;
#endif // __STDC_VERSION__ >= 202311L
#endif // __cplusplus

/**
 * What a texel of a normal map holds.
 */
enum AirglowNormalFormat
#if defined(__cplusplus) || __STDC_VERSION__ >= 202311L
  : uint32_t
#endif // defined(__cplusplus) || __STDC_VERSION__ >= 202311L
 {
  /**
   * Three floats: a vector of any length.
   */
  AIRGLOW_NORMAL_FORMAT_FLOAT3 = 0,
  /**
   * Two floats, as BC5 has them: z is what is left of 1.
   */
  AIRGLOW_NORMAL_FORMAT_FLOAT2 = 1,
  /**
   * Four bytes: 0 is -1, 255 is 1; the fourth is not read.
   */
  AIRGLOW_NORMAL_FORMAT_RGBA8 = 2,
  /**
   * Four numbers of 16 bits: 0 is -1, 65535 is 1; the fourth is not read.
   */
  AIRGLOW_NORMAL_FORMAT_RGBA16 = 3,
};
#ifndef __cplusplus
#if __STDC_VERSION__ >= 202311L
typedef enum AirglowNormalFormat AirglowNormalFormat;
#else
typedef uint32_t AirglowNormalFormat;
#endif // __STDC_VERSION__ >= 202311L
#endif // __cplusplus

/**
 * What a step of a build uses; all are the library's own.
 */
enum AirglowNormalsResource
#if defined(__cplusplus) || __STDC_VERSION__ >= 202311L
  : uint32_t
#endif // defined(__cplusplus) || __STDC_VERSION__ >= 202311L
 {
  /**
   * The texture of lobes.
   */
  AIRGLOW_NORMALS_RESOURCE_TEXTURE = 0,
  /**
   * A buffer; the index counts them, the name says which.
   */
  AIRGLOW_NORMALS_RESOURCE_OWN = 1,
};
#ifndef __cplusplus
#if __STDC_VERSION__ >= 202311L
typedef enum AirglowNormalsResource AirglowNormalsResource;
#else
typedef uint32_t AirglowNormalsResource;
#endif // __STDC_VERSION__ >= 202311L
#endif // __cplusplus

/**
 * Where a resource of a frame comes from.
 */
enum AirglowOrigin
#if defined(__cplusplus) || __STDC_VERSION__ >= 202311L
  : uint32_t
#endif // defined(__cplusplus) || __STDC_VERSION__ >= 202311L
 {
  /**
   * The library keeps it and synchronises it.
   */
  AIRGLOW_ORIGIN_LIBRARY = 0,
  /**
   * The host gives it, bound when the frame is recorded.
   */
  AIRGLOW_ORIGIN_HOST = 1,
  /**
   * It lives within the frame: bound by the host, or made by `airglow_prepared_make_scratch`.
   */
  AIRGLOW_ORIGIN_SCRATCH = 2,
};
#ifndef __cplusplus
#if __STDC_VERSION__ >= 202311L
typedef enum AirglowOrigin AirglowOrigin;
#else
typedef uint32_t AirglowOrigin;
#endif // __STDC_VERSION__ >= 202311L
#endif // __cplusplus

/**
 * What is written for each vertex.
 */
enum AirglowOutput
#if defined(__cplusplus) || __STDC_VERSION__ >= 202311L
  : uint32_t
#endif // defined(__cplusplus) || __STDC_VERSION__ >= 202311L
 {
  /**
   * The colour: four floats, radiance of a white diffuse surface in W/sr/m2, the fourth 1.
   */
  AIRGLOW_OUTPUT_COLOUR = 0,
  /**
   * The incident radiance, SH RGB: `3 * order^2` floats, for shaders that need direction.
   */
  AIRGLOW_OUTPUT_INCIDENT = 1,
};
#ifndef __cplusplus
#if __STDC_VERSION__ >= 202311L
typedef enum AirglowOutput AirglowOutput;
#else
typedef uint32_t AirglowOutput;
#endif // __STDC_VERSION__ >= 202311L
#endif // __cplusplus

/**
 * How a plan is written.
 */
enum AirglowPlanFormat
#if defined(__cplusplus) || __STDC_VERSION__ >= 202311L
  : uint32_t
#endif // defined(__cplusplus) || __STDC_VERSION__ >= 202311L
 {
  /**
   * Text made to be compared.
   */
  AIRGLOW_PLAN_FORMAT_TEXT = 0,
  /**
   * JSON.
   */
  AIRGLOW_PLAN_FORMAT_JSON = 1,
  /**
   * A mermaid diagram.
   */
  AIRGLOW_PLAN_FORMAT_MERMAID = 2,
};
#ifndef __cplusplus
#if __STDC_VERSION__ >= 202311L
typedef enum AirglowPlanFormat AirglowPlanFormat;
#else
typedef uint32_t AirglowPlanFormat;
#endif // __STDC_VERSION__ >= 202311L
#endif // __cplusplus

/**
 * How the error of a sample that serves many vertices is estimated.
 */
enum AirglowRadianceOracle
#if defined(__cplusplus) || __STDC_VERSION__ >= 202311L
  : uint32_t
#endif // defined(__cplusplus) || __STDC_VERSION__ >= 202311L
 {
  /**
   * The change of the vertices' colours, by their transfer vectors; radiance.
   */
  AIRGLOW_RADIANCE_ORACLE_TRANSFER = 0,
  /**
   * Brightness times variation; radiance times metres.
   */
  AIRGLOW_RADIANCE_ORACLE_ARGUED = 1,
  /**
   * As it is printed in the thesis; radiance a metre.
   */
  AIRGLOW_RADIANCE_ORACLE_PRINTED = 2,
};
#ifndef __cplusplus
#if __STDC_VERSION__ >= 202311L
typedef enum AirglowRadianceOracle AirglowRadianceOracle;
#else
typedef uint32_t AirglowRadianceOracle;
#endif // __STDC_VERSION__ >= 202311L
#endif // __cplusplus

/**
 * What a step of the pass uses.
 */
enum AirglowRadianceResource
#if defined(__cplusplus) || __STDC_VERSION__ >= 202311L
  : uint32_t
#endif // defined(__cplusplus) || __STDC_VERSION__ >= 202311L
 {
  /**
   * Written, a buffer of the host's for each part, whose place in the receiver is the index: `3 * order^2` floats a
   * vertex, in the space of the part, as relighting takes light of each vertex
   * (`AIRGLOW_RELIGHT_RESOURCE_VERTEX_LIGHT`).
   */
  AIRGLOW_RADIANCE_RESOURCE_VERTEX_LIGHT = 0,
  /**
   * A buffer of the library's own; the index counts them, the name says which.
   */
  AIRGLOW_RADIANCE_RESOURCE_OWN = 1,
};
#ifndef __cplusplus
#if __STDC_VERSION__ >= 202311L
typedef enum AirglowRadianceResource AirglowRadianceResource;
#else
typedef uint32_t AirglowRadianceResource;
#endif // __STDC_VERSION__ >= 202311L
#endif // __cplusplus

/**
 * What a step of the pass uses. With `AIRGLOW_RELIGHT_RESOURCE_VECTORS` the index is a mesh's place in the pass, with
 * `..._VERTEX_LIGHT`, `..._VISIBILITY` and `..._NORMALS` an instance's in the frame; otherwise it is 0.
 */
enum AirglowRelightResource
#if defined(__cplusplus) || __STDC_VERSION__ >= 202311L
  : uint32_t
#endif // defined(__cplusplus) || __STDC_VERSION__ >= 202311L
 {
  /**
   * The environment's image.
   */
  AIRGLOW_RELIGHT_RESOURCE_ENVIRONMENT = 0,
  /**
   * Integrals of the basis over the columns of the environment.
   */
  AIRGLOW_RELIGHT_RESOURCE_COLUMN_TABLE = 1,
  /**
   * Integrals of the basis over the rows of the environment.
   */
  AIRGLOW_RELIGHT_RESOURCE_ROW_TABLE = 2,
  /**
   * Sums over the columns of each row.
   */
  AIRGLOW_RELIGHT_RESOURCE_ROW_SUMS = 3,
  /**
   * The environment's coefficients in the frame of its map.
   */
  AIRGLOW_RELIGHT_RESOURCE_MAP_COEFFICIENTS = 4,
  /**
   * The environment's coefficients; kept from frame to frame.
   */
  AIRGLOW_RELIGHT_RESOURCE_ENVIRONMENT_LIGHT = 5,
  /**
   * SH RGB light of the host.
   */
  AIRGLOW_RELIGHT_RESOURCE_UNIFORM_LIGHT = 6,
  /**
   * The light in the space of each instance.
   */
  AIRGLOW_RELIGHT_RESOURCE_LIGHTS = 7,
  /**
   * The sparse triple-product tensor.
   */
  AIRGLOW_RELIGHT_RESOURCE_TENSOR = 8,
  /**
   * The product matrix of each instance's light.
   */
  AIRGLOW_RELIGHT_RESOURCE_MATRICES = 9,
  /**
   * The baked vectors of a mesh.
   */
  AIRGLOW_RELIGHT_RESOURCE_VECTORS = 10,
  /**
   * The light of each vertex of an instance: `3 * order^2` floats a vertex.
   */
  AIRGLOW_RELIGHT_RESOURCE_VERTEX_LIGHT = 11,
  /**
   * The dynamic visibility of each vertex of an instance: `order^2` floats a vertex.
   */
  AIRGLOW_RELIGHT_RESOURCE_VISIBILITY = 12,
  /**
   * The normals of an instance's vertices: 3 floats a vertex.
   */
  AIRGLOW_RELIGHT_RESOURCE_NORMALS = 13,
  /**
   * The packed rectangle of the fragment method.
   */
  AIRGLOW_RELIGHT_RESOURCE_RECTANGLE = 14,
  /**
   * The results of all instances.
   */
  AIRGLOW_RELIGHT_RESOURCE_RESULTS = 15,
  /**
   * Counters of bad texels.
   */
  AIRGLOW_RELIGHT_RESOURCE_HEALTH = 16,
};
#ifndef __cplusplus
#if __STDC_VERSION__ >= 202311L
typedef enum AirglowRelightResource AirglowRelightResource;
#else
typedef uint32_t AirglowRelightResource;
#endif // __STDC_VERSION__ >= 202311L
#endif // __cplusplus

/**
 * The way to the exponential.
 */
enum AirglowShadowExponential
#if defined(__cplusplus) || __STDC_VERSION__ >= 202311L
  : uint32_t
#endif // defined(__cplusplus) || __STDC_VERSION__ >= 202311L
 {
  /**
   * The polynomial of the least degree that is near enough wherever it is asked.
   */
  AIRGLOW_SHADOW_EXPONENTIAL_ADAPTIVE = 0,
  /**
   * The product series of a degree, of the whole vector.
   */
  AIRGLOW_SHADOW_EXPONENTIAL_SERIES = 1,
  /**
   * A series by Horner's rule of what is scaled to a norm, then squared.
   */
  AIRGLOW_SHADOW_EXPONENTIAL_HORNER = 2,
  /**
   * Optimal linear.
   */
  AIRGLOW_SHADOW_EXPONENTIAL_OPTIMAL_LINEAR = 3,
  /**
   * Optimal linear of what is scaled to a threshold, then squared.
   */
  AIRGLOW_SHADOW_EXPONENTIAL_HYBRID = 4,
};
#ifndef __cplusplus
#if __STDC_VERSION__ >= 202311L
typedef enum AirglowShadowExponential AirglowShadowExponential;
#else
typedef uint32_t AirglowShadowExponential;
#endif // __STDC_VERSION__ >= 202311L
#endif // __cplusplus

/**
 * What the pass uses; all are buffers of the host's.
 */
enum AirglowShadowResource
#if defined(__cplusplus) || __STDC_VERSION__ >= 202311L
  : uint32_t
#endif // defined(__cplusplus) || __STDC_VERSION__ >= 202311L
 {
  /**
   * Positions of the vertices in object space, three floats each, tightly packed.
   */
  AIRGLOW_SHADOW_RESOURCE_POSITIONS = 0,
  /**
   * Their normals, three floats each, of any length but 0; with `normals` in the settings.
   */
  AIRGLOW_SHADOW_RESOURCE_NORMALS = 1,
  /**
   * Written: `order^2` floats a vertex, as relighting takes dynamic visibility
   * (`AIRGLOW_RELIGHT_RESOURCE_VISIBILITY`).
   */
  AIRGLOW_SHADOW_RESOURCE_VISIBILITY = 2,
  /**
   * Written: two integers a cluster, for `airglow_shadow_counts`.
   */
  AIRGLOW_SHADOW_RESOURCE_RECORDS = 3,
};
#ifndef __cplusplus
#if __STDC_VERSION__ >= 202311L
typedef enum AirglowShadowResource AirglowShadowResource;
#else
typedef uint32_t AirglowShadowResource;
#endif // __STDC_VERSION__ >= 202311L
#endif // __cplusplus

/**
 * How the vectors of a mesh are stored on the device.
 */
enum AirglowStorage
#if defined(__cplusplus) || __STDC_VERSION__ >= 202311L
  : uint32_t
#endif // defined(__cplusplus) || __STDC_VERSION__ >= 202311L
 {
  /**
   * 32-bit floats.
   */
  AIRGLOW_STORAGE_F32 = 0,
  /**
   * 16-bit floats, half the bytes; values up to 63.96.
   */
  AIRGLOW_STORAGE_F16 = 1,
};
#ifndef __cplusplus
#if __STDC_VERSION__ >= 202311L
typedef enum AirglowStorage AirglowStorage;
#else
typedef uint32_t AirglowStorage;
#endif // __STDC_VERSION__ >= 202311L
#endif // __cplusplus

/**
 * A device as the library sees it. Many can live in one process. Any thread may use it; `airglow_context_begin_frame`
 * and `airglow_context_drop` are to be called while no other call uses it.
 */
typedef struct AirglowContext AirglowContext;

/**
 * The fog pass: its kernels for one context and one choice of settings. Any thread may use it.
 */
typedef struct AirglowFog AirglowFog;

/**
 * Convolves environments of one size with what a medium does to a point of light, for the eye. Any thread may use it.
 */
typedef struct AirglowFogBackground AirglowFogBackground;

/**
 * Counters of one pass, for whichever of its frames; a host that makes none pays nothing. Any thread may use it.
 */
typedef struct AirglowHealth AirglowHealth;

/**
 * A normal map and its texture of lobes. Any thread may use it.
 */
typedef struct AirglowNormalMap AirglowNormalMap;

/**
 * What builds textures of lobes: its kernels for one context and one choice of settings. Any thread may use it.
 */
typedef struct AirglowNormals AirglowNormals;

/**
 * A frame of a pass, ready to be recorded, and again in later frames: a pass has functions that change it in between.
 * One thread at a time. It may outlive its pass.
 */
typedef struct AirglowPrepared AirglowPrepared;

/**
 * The radiance pass: its kernels for one context and one choice of settings. Any thread may use it.
 */
typedef struct AirglowRadiance AirglowRadiance;

/**
 * Vertices that light is sampled for, on the device, with room for samples. Any thread may use it.
 */
typedef struct AirglowRadianceReceiver AirglowRadianceReceiver;

/**
 * The relight pass: kernels, tables and meshes for one context and one choice of settings. Any thread may use it.
 */
typedef struct AirglowRelight AirglowRelight;

/**
 * What passes ask of a device. Made empty, which is what the library itself needs; each pass adds its own
 * (`airglow_relight_require`). One thread at a time.
 */
typedef struct AirglowRequirements AirglowRequirements;

/**
 * The shadow pass: its kernel and tables for one context and one choice of settings. Any thread may use it.
 */
typedef struct AirglowShadow AirglowShadow;

/**
 * The vertices of a mesh, put into clusters once. Any thread may use them.
 */
typedef struct AirglowShadowReceivers AirglowShadowReceivers;

/**
 * The tree of a set of spheres, with the ratios its nodes count by; it stays while the set moves. Any thread may use it.
 */
typedef struct AirglowSphereHierarchy AirglowSphereHierarchy;

/**
 * Triangles that block light, from both sides, beside those of the mesh itself. Elements of arrays never grow.
 */
typedef struct AirglowOccluder {
  /**
   * Name used in errors; null for "occluder".
   */
  const char *name;
  /**
   * Three floats a vertex, metres.
   */
  const float *positions;
  /**
   * Vertices.
   */
  size_t vertex_count;
  /**
   * Three a triangle.
   */
  const uint32_t *indices;
  /**
   * Indices.
   */
  size_t index_count;
  /**
   * From its space to the object space of the mesh: affine, column-major. All zero is the identity.
   */
  float transform[16];
} AirglowOccluder;

/**
 * A mesh to be baked, and how. Positions, normals and vectors are in its object space.
 */
typedef struct AirglowBakeInfo {
  /**
   * `sizeof(AirglowBakeInfo)`.
   */
  uint32_t struct_size;
  /**
   * Bands, 1 to 6: order^2 coefficients a vertex. 0 is 4.
   */
  uint32_t order;
  /**
   * Name used in errors; null for "mesh".
   */
  const char *name;
  /**
   * Three floats a vertex, metres.
   */
  const float *positions;
  /**
   * Three floats a vertex, outward, of any length; a zero normal gives a zero vector.
   */
  const float *normals;
  /**
   * Vertices.
   */
  size_t vertex_count;
  /**
   * Three a triangle.
   */
  const uint32_t *indices;
  /**
   * Indices.
   */
  size_t index_count;
  /**
   * Rays a vertex, 1 to 1048576. 0 is 256.
   */
  uint32_t rays;
  /**
   * Threads, which end with the call. 0 and 1 are the caller's alone. The bits do not depend on it.
   */
  uint32_t threads;
  /**
   * Longest ray in metres; 0 is without end.
   */
  float reach;
  /**
   * Decorrelates two bakes of one mesh.
   */
  uint32_t seed;
  /**
   * More triangles that block light.
   */
  const struct AirglowOccluder *occluders;
  /**
   * How many.
   */
  size_t occluder_count;
  /**
   * Where static visibility vectors are written, as many values as transfer, for incident radiance; or null.
   */
  float *visibility;
  /**
   * An `AirglowBelowHorizon`, for visibility.
   */
  uint32_t below_horizon;
  /**
   * Not used; 0.
   */
  uint32_t reserved;
  /**
   * Told how many vertices are done, about every thirtieth of a second, by one thread at a time; not 0 stops the
   * bake. May be null.
   */
  uint32_t (*progress)(void *user, size_t done, size_t count);
  /**
   * Handed to `progress`.
   */
  void *user;
} AirglowBakeInfo;

/**
 * What a bake did.
 */
typedef struct AirglowBakeStats {
  /**
   * Rays traced.
   */
  uint64_t rays;
  /**
   * Rays that met an occluder.
   */
  uint64_t blocked;
  /**
   * Vertices whose normal is zero.
   */
  uint64_t zero_normals;
  /**
   * Wall-clock time in seconds.
   */
  double seconds;
} AirglowBakeStats;

/**
 * What went wrong, written by a call into memory of the caller. May be null wherever it is asked for. A call that
 * succeeds sets `status` and clears the message.
 */
typedef struct AirglowError {
  /**
   * `sizeof(AirglowError)`.
   */
  uint32_t struct_size;
  /**
   * The status that the call returned.
   */
  AirglowStatus status;
  /**
   * The `VkResult` that a Vulkan call returned, or 0.
   */
  int32_t vulkan_result;
  /**
   * Bytes of the whole message without its nul; more than fits when it was cut.
   */
  uint32_t message_length;
  /**
   * What is wrong and how to mend it: UTF-8, ends in a nul, cut at the end of a character.
   */
  char message[AIRGLOW_MESSAGE_SIZE];
} AirglowError;

/**
 * A Vulkan function of whatever type; cast `vkGetInstanceProcAddr` to it.
 */
typedef void (*AirglowFunction)(void);

/**
 * Device memory that the library asks the host for.
 */
typedef struct AirglowMemoryRequest {
  /**
   * Name of the resource, valid during the call.
   */
  const char *name;
  /**
   * Bytes.
   */
  uint64_t size;
  /**
   * Alignment of the offset in bytes.
   */
  uint64_t alignment;
  /**
   * Memory types allowed, as `VkMemoryRequirements::memoryTypeBits`.
   */
  uint32_t memory_type_bits;
  /**
   * An `AirglowLocation`.
   */
  uint32_t location;
  /**
   * 1 for a buffer, 0 for an image with optimal tiling.
   */
  uint32_t linear;
  /**
   * Not used.
   */
  uint32_t reserved;
} AirglowMemoryRequest;

/**
 * A piece of device memory that the host gives.
 */
typedef struct AirglowAllocation {
  /**
   * The `VkDeviceMemory`.
   */
  uint64_t memory;
  /**
   * Where the piece starts, in bytes.
   */
  uint64_t offset;
  /**
   * Its bytes, at least what was asked for.
   */
  uint64_t size;
  /**
   * Where its first byte is mapped; null for memory of the device only.
   */
  void *mapped;
  /**
   * The host's own number for it, handed back when it is freed.
   */
  uint64_t token;
} AirglowAllocation;

/**
 * The host's memory. Calls come one at a time, on the threads that call the library.
 */
typedef struct AirglowAllocator {
  /**
   * `sizeof(AirglowAllocator)`.
   */
  uint32_t struct_size;
  /**
   * Not used.
   */
  uint32_t reserved;
  /**
   * Handed to both functions.
   */
  void *user;
  /**
   * Fills the allocation and returns 0, or returns a `VkResult` below 0. The memory is the context's device's, meets
   * the request, overlaps no other live piece, and stays until it is freed.
   */
  int32_t (*allocate)(void *user, const struct AirglowMemoryRequest *request, struct AirglowAllocation *allocation);
  /**
   * Takes back what `allocate` gave.
   */
  void (*free)(void *user, const struct AirglowAllocation *allocation);
} AirglowAllocator;

/**
 * A text of the library in memory of the caller. With `data` null and `capacity` 0, a call only says the length.
 */
typedef struct AirglowText {
  /**
   * Where the text is written: UTF-8, with a nul at its end.
   */
  char *data;
  /**
   * Bytes there.
   */
  size_t capacity;
  /**
   * Set by the call: bytes of the whole text without its nul.
   */
  size_t length;
} AirglowText;

/**
 * A device as its host states it. Handles are Vulkan's own as integers, 0 for null.
 */
typedef struct AirglowAdoptInfo {
  /**
   * `sizeof(AirglowAdoptInfo)`.
   */
  uint32_t struct_size;
  /**
   * API version the instance was made for, as `VK_MAKE_API_VERSION` packs it.
   */
  uint32_t api_version;
  /**
   * What the passes in use ask for; null for the library alone. Read during the call.
   */
  const struct AirglowRequirements *requirements;
  /**
   * `vkGetInstanceProcAddr`, the loader's or the host's own in front of it.
   */
  AirglowFunction get_instance_proc_addr;
  /**
   * `vkGetDeviceProcAddr`; null asks the instance for it.
   */
  AirglowFunction get_device_proc_addr;
  /**
   * The `VkInstance`.
   */
  uint64_t instance;
  /**
   * The `VkPhysicalDevice`.
   */
  uint64_t physical_device;
  /**
   * The `VkDevice`.
   */
  uint64_t device;
  /**
   * Family of the queue that commands will be submitted to.
   */
  uint32_t queue_family;
  /**
   * How many frames may be on the device or being recorded at once, at least 1.
   */
  uint32_t frames_in_flight;
  /**
   * The `VkDeviceCreateInfo` that the device was made with, or null: extensions and features are read from it, its
   * `pEnabledFeatures` and its `pNext` chain, during the call. What is named below is added.
   */
  const void *device_create_info;
  /**
   * Names of extensions that the host enabled, of instance and device. `VK_EXT_debug_utils` among them turns on names
   * and labels.
   */
  const char *const *extension_names;
  /**
   * How many.
   */
  size_t extension_count;
  /**
   * Names of features that the host enabled, as their fields are called in the Vulkan specification.
   */
  const char *const *feature_names;
  /**
   * How many.
   */
  size_t feature_count;
  /**
   * The host's memory, or null for blocks of the library's own. Copied; what it points at lives as long as the
   * context and all that was made from it.
   */
  const struct AirglowAllocator *allocator;
  /**
   * The host's `VkPipelineCache`, or 0.
   */
  uint64_t pipeline_cache;
  /**
   * Most bytes of device memory that all made from the context may hold; 0 for no bound.
   */
  uint64_t memory_budget;
  /**
   * 1: each step writes its number where `airglow_context_last_pass_reached` finds it after a loss. It keeps passes
   * from overlapping: for hunting a loss, not for shipping.
   */
  uint32_t breadcrumbs;
  /**
   * Not used; 0.
   */
  uint32_t reserved;
  /**
   * Where a JSON array of what the device lacks is written, one text each, when adopting fails for that; or null.
   */
  struct AirglowText *missing;
} AirglowAdoptInfo;

#if defined(AIRGLOW_CONFORMANCE)
/**
 * What came of a check; `failure` is null where it passed, and else says what is wrong. Both texts are UTF-8 and live
 * during the call.
 */
typedef void (*AirglowConformanceReport)(void *user, const char *check, const char *failure);
#endif

#if defined(AIRGLOW_CONFORMANCE)
/**
 * A host's device for the conformance kit.
 */
typedef struct AirglowConformanceInfo {
  /**
   * `sizeof(AirglowConformanceInfo)`.
   */
  uint32_t struct_size;
  /**
   * Not used; 0.
   */
  uint32_t reserved;
  /**
   * The device, as the host hands it to `airglow_context_adopt`. Of it the kit leaves alone: requirements, frames in
   * flight, allocator, pipeline cache, budget, breadcrumbs and `missing`.
   */
  const struct AirglowAdoptInfo *device;
  /**
   * A `VkQueue` of `queue_family`, which does graphics and compute: the kit submits to it and waits for it.
   */
  uint64_t queue;
  /**
   * Called for each check; or null.
   */
  AirglowConformanceReport report;
  /**
   * Handed to `report`.
   */
  void *user;
} AirglowConformanceInfo;
#endif

/**
 * How far a device came.
 */
typedef struct AirglowPassReached {
  /**
   * 1 if a step was begun; 0 without breadcrumbs, or when no step of the frames in flight was begun.
   */
  uint32_t reached;
  /**
   * 1 if the step was done, too.
   */
  uint32_t finished;
  /**
   * The frame of the step.
   */
  uint64_t frame;
} AirglowPassReached;

/**
 * What fog is prepared for. Zero is the default of every field.
 */
typedef struct AirglowFogSettings {
  /**
   * `sizeof(AirglowFogSettings)`.
   */
  uint32_t struct_size;
  /**
   * `VkFormat` of the picture that is written; 0 is `VK_FORMAT_R32G32B32A32_SFLOAT`.
   */
  uint32_t format;
  /**
   * An `AirglowFogPreset`.
   */
  uint32_t preset;
  /**
   * An `AirglowFogPhase`.
   */
  uint32_t phase;
  /**
   * 1: a medium may thin with height. Not with an environment.
   */
  uint32_t height;
  /**
   * 1: views may have an environment behind the medium.
   */
  uint32_t environment;
  /**
   * Radiance, W/sr/m2, below which the airlight of one light is left out of a pixel; 0 is 1e-4, below 0 nothing is left
   * out.
   */
  double bound;
} AirglowFogSettings;

/**
 * What a background is made for.
 */
typedef struct AirglowFogBackgroundSettings {
  /**
   * `sizeof(AirglowFogBackgroundSettings)`.
   */
  uint32_t struct_size;
  /**
   * `VkFormat` of the picture that is written; 0 is `VK_FORMAT_R32G32B32A32_SFLOAT`.
   */
  uint32_t format;
  /**
   * Texels of a row of the environment.
   */
  uint32_t width;
  /**
   * Rows of the environment.
   */
  uint32_t height;
} AirglowFogBackgroundSettings;

/**
 * The medium before an environment, and what the picture holds.
 */
typedef struct AirglowFogBackgroundView {
  /**
   * `sizeof(AirglowFogBackgroundView)`.
   */
  uint32_t struct_size;
  /**
   * An `AirglowFogSeen`.
   */
  uint32_t seen;
  /**
   * Extinction times the metres to the environment, of red, green and blue.
   */
  double optical_distance[3];
  /**
   * What of the extinction is scattering, 0 to 1 each.
   */
  double albedo[3];
} AirglowFogBackgroundView;

/**
 * A host's conventions: axes, units, winding, depth, exposure. All zero is airglow's own: metres, right-handed, +Y up,
 * -Z forward, counter-clockwise fronts.
 */
typedef struct AirglowWorld {
  /**
   * `sizeof(AirglowWorld)`.
   */
  uint32_t struct_size;
  /**
   * What points to the right of an upright viewer who looks forward, an `AirglowAxis`. The three lie along different
   * lines; which hand they are follows from them.
   */
  uint32_t right;
  /**
   * What points up, an `AirglowAxis`.
   */
  uint32_t up;
  /**
   * What points forward, an `AirglowAxis`.
   */
  uint32_t forward;
  /**
   * 1: front faces wind clockwise in the picture.
   */
  uint32_t front_face_clockwise;
  /**
   * 1: green of normal maps points down the texture, along v.
   */
  uint32_t normal_map_green_down;
  /**
   * 1: depth is 1 near and 0 far.
   */
  uint32_t depth_reversed;
  /**
   * 1: the projection is orthographic.
   */
  uint32_t depth_orthographic;
  /**
   * Length of the unit in metres; 0 is 1.
   */
  double metres_per_unit;
  /**
   * View distance of the near plane, in units; 0 is 0.1.
   */
  double depth_near;
  /**
   * View distance of the far plane, in units; infinity for an infinite perspective, 0 is 1000.
   */
  double depth_far;
  /**
   * Pixels by which the projection shifts the picture, right and down.
   */
  double jitter[2];
  /**
   * What colours are multiplied with before they are stored; 0 is 1. Radiance that comes in is not multiplied yet.
   */
  double pre_exposure;
  /**
   * Where the zero of the positions that the host gives lies in its world, in its axes and units.
   */
  double origin[3];
  /**
   * Views of a frame; 0 is 1.
   */
  uint32_t views;
  /**
   * Not used; 0.
   */
  uint32_t reserved;
} AirglowWorld;

/**
 * A point light or spot light, in the host's axes and units. Elements of arrays never grow.
 */
typedef struct AirglowFogLight {
  /**
   * Where it is.
   */
  double position[3];
  /**
   * Radiant intensity, W/sr, of red, green and blue.
   */
  double intensity[3];
  /**
   * Factor on what the medium scatters of it; 0 is 1.
   */
  double scatter;
  /**
   * Radius; 0 is a point.
   */
  double radius;
  /**
   * Axis of a spot light, away from it.
   */
  double cone_direction[3];
  /**
   * Half angle of full intensity, radians.
   */
  double cone_inner;
  /**
   * Half angle from which on nothing arrives, radians; 0: no spot light.
   */
  double cone_outer;
  /**
   * Distance from which on nothing arrives; 0: none.
   */
  double range;
  /**
   * Lowest coordinates of the box in which it shines.
   */
  double bounds_low[3];
  /**
   * Highest coordinates of that box; where both are all zero there is none.
   */
  double bounds_high[3];
} AirglowFogLight;

/**
 * A view through a medium: all that may change while a prepared view stays.
 */
typedef struct AirglowFogView {
  /**
   * `sizeof(AirglowFogView)`.
   */
  uint32_t struct_size;
  /**
   * Not used; 0.
   */
  uint32_t reserved;
  /**
   * The host's conventions; null is airglow's own.
   */
  const struct AirglowWorld *world;
  /**
   * The eye, in the host's axes and units.
   */
  double eye[3];
  /**
   * Unit vector to the right of the picture.
   */
  double right[3];
  /**
   * Unit vector up the picture.
   */
  double up[3];
  /**
   * Unit vector into the picture.
   */
  double forward[3];
  /**
   * Left, right, lower and upper edge of the picture at distance 1: tangents of the angles from `forward`; of an
   * orthographic view the edges themselves.
   */
  double edges[4];
  /**
   * Extinction coefficient of the medium, 1/m, of red, green and blue. All zero: the pass is left out.
   */
  double extinction[3];
  /**
   * What of the extinction is scattering, 0 to 1 each.
   */
  double albedo[3];
  /**
   * Numbers of the phase function: see `AirglowFogPhase`.
   */
  double phase[4];
  /**
   * Where a medium that thins with height is as dense as it says, metres up.
   */
  double thinning_level;
  /**
   * Metres up in which it thins by a factor of e; 0: it does not.
   */
  double scale_height;
  /**
   * Lights inside the medium, at most 64.
   */
  const struct AirglowFogLight *lights;
  /**
   * How many.
   */
  size_t light_count;
  /**
   * Radiance of what lies behind the scene, without the medium, W/sr/m2: red, green and blue of each of 9 coefficients
   * of spherical harmonics, in right-handed axes with +Y up. Null: darkness. Some needs `environment` in the settings.
   */
  const double *environment;
  /**
   * How far its light comes through the medium, in the host's units.
   */
  double environment_distance;
} AirglowFogView;

/**
 * Lights of a view, and pairs of a tile of the picture and a light.
 */
typedef struct AirglowFogCounts {
  /**
   * Lights whose airlight passes the bound somewhere in the picture.
   */
  uint32_t evaluated;
  /**
   * Lights left out: dark, too weak, or out of reach of every pixel.
   */
  uint32_t left_out;
  /**
   * Pairs of a tile, `AIRGLOW_FOG_TILE` pixels on a side, and a light that is evaluated in it.
   */
  uint32_t pairs;
  /**
   * Pairs left out: with those evaluated, as many as there are tiles times lights.
   */
  uint32_t pairs_left_out;
} AirglowFogCounts;

/**
 * Counts of a frame, in the order in which the function says that made the counters.
 */
typedef struct AirglowHealthCounts {
  /**
   * The context's frame that was counted.
   */
  uint64_t frame;
  /**
   * 1: a frame was counted, and the device is done with it. 0: the other fields say nothing.
   */
  uint32_t counted;
  /**
   * How many counters there are.
   */
  uint32_t count;
  /**
   * The counts; 0 past the last.
   */
  uint32_t counts[8];
} AirglowHealthCounts;

/**
 * A resource of the host's, for one recording: a buffer or an image. Elements of arrays never grow.
 */
typedef struct AirglowBinding {
  /**
   * See `AirglowAccess`.
   */
  uint32_t resource;
  /**
   * See `AirglowAccess`.
   */
  uint32_t index;
  /**
   * The `VkBuffer`, or 0 for an image.
   */
  uint64_t buffer;
  /**
   * First byte of the resource in the buffer.
   */
  uint64_t offset;
  /**
   * Bytes of the whole buffer.
   */
  uint64_t size;
  /**
   * The `VkImage`, 2D with one sample, or 0 for a buffer.
   */
  uint64_t image;
  /**
   * `VkFormat` of the image.
   */
  uint32_t format;
  /**
   * `VkBufferUsageFlags` or `VkImageUsageFlags` that it was made with.
   */
  uint32_t usage;
  /**
   * Width and height of the image.
   */
  uint32_t extent[2];
  /**
   * Mips of the image; 0 is 1.
   */
  uint32_t mips;
  /**
   * Not used; 0.
   */
  uint32_t reserved;
} AirglowBinding;

/**
 * How textures of lobes are made. Zero is the default of every field.
 */
typedef struct AirglowNormalsSettings {
  /**
   * `sizeof(AirglowNormalsSettings)`.
   */
  uint32_t struct_size;
  /**
   * Lobes of a texel: 1, 2, 4 or 6. 0 is 4.
   */
  uint32_t lobes;
  /**
   * Steps of fitting, to 32. 0 is 20.
   */
  uint32_t iterations;
  /**
   * An `AirglowLobeStorage`.
   */
  uint32_t storage;
  /**
   * The sharpest lobe while fitting, 1 to 1e8. 0 is 1000.
   */
  double sharpest;
  /**
   * Bytes that the texture of a map may take; what takes more is refused. 0 is 16 bytes a texel of the map.
   */
  uint64_t budget;
} AirglowNormalsSettings;

/**
 * A normal map in tangent space, z away from the surface.
 */
typedef struct AirglowNormalMapInfo {
  /**
   * `sizeof(AirglowNormalMapInfo)`.
   */
  uint32_t struct_size;
  /**
   * An `AirglowNormalFormat`.
   */
  uint32_t format;
  /**
   * Texels of a row.
   */
  uint32_t width;
  /**
   * Rows.
   */
  uint32_t height;
  /**
   * Its texels, row by row, tightly packed. A texel without direction becomes +Z and is counted.
   */
  const void *texels;
  /**
   * Bytes of them.
   */
  size_t texel_bytes;
  /**
   * Path of a file that `airglow_normal_map_store` wrote, UTF-8: if it holds the texture of this very map with these
   * settings, that is copied in one step; whatever else is there is left alone. Null for none.
   */
  const char *cache;
  /**
   * 1: green points down; 0: up.
   */
  uint32_t green_down;
  /**
   * Not used; 0.
   */
  uint32_t reserved;
} AirglowNormalMapInfo;

/**
 * How far the build of a map is.
 */
typedef struct AirglowNormalMapProgress {
  /**
   * Texels of the steps that were prepared.
   */
  uint64_t done;
  /**
   * Texels of all steps.
   */
  uint64_t total;
  /**
   * Texels of the map that had no direction.
   */
  uint64_t repaired;
  /**
   * 1: the texture comes from the file that was named.
   */
  uint32_t cached;
  /**
   * Not used.
   */
  uint32_t reserved;
} AirglowNormalMapProgress;

/**
 * The texture of a map: array layer j holds lobe j of every texel, `(weight * mean normal, weight)`; mip m is level m + 1
 * of the map. To be sampled with linear filters, after its last step, in `VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL`.
 */
typedef struct AirglowLobeTexture {
  /**
   * The `VkImage`, which lives as long as the map; 0 for a map of one texel, whose normal is all that there is.
   */
  uint64_t image;
  /**
   * Bytes of its texels.
   */
  uint64_t bytes;
  /**
   * Its `VkFormat`.
   */
  uint32_t format;
  /**
   * Its `VkImageUsageFlags`.
   */
  uint32_t usage;
  /**
   * Texels of a row.
   */
  uint32_t width;
  /**
   * Rows.
   */
  uint32_t height;
  /**
   * Mips.
   */
  uint32_t mips;
  /**
   * Array layers: lobes.
   */
  uint32_t layers;
} AirglowLobeTexture;

/**
 * One use of one resource by one step. Elements of arrays never grow; names live as long as the prepared frame.
 */
typedef struct AirglowAccess {
  /**
   * An enumeration of the pass: `AirglowRelightResource`, `AirglowFogResource` and the like.
   */
  uint32_t resource;
  /**
   * See there; 0 where nothing is said.
   */
  uint32_t index;
  /**
   * An `AirglowOrigin`.
   */
  uint32_t origin;
  /**
   * The step, counted from 0 in the order of recording.
   */
  uint32_t step;
  /**
   * `VkPipelineStageFlags2`.
   */
  uint64_t stage;
  /**
   * `VkAccessFlags2`.
   */
  uint64_t access;
  /**
   * `VkImageLayout`; 0 for buffers.
   */
  uint32_t layout;
  /**
   * 1: the step writes it.
   */
  uint32_t writes;
  /**
   * Name of the resource.
   */
  const char *name;
  /**
   * Name of the step.
   */
  const char *step_name;
} AirglowAccess;

/**
 * One resource of a frame. Elements of arrays never grow; names live as long as the prepared frame.
 */
typedef struct AirglowResourceInfo {
  /**
   * See `AirglowAccess`.
   */
  uint32_t resource;
  /**
   * See `AirglowAccess`.
   */
  uint32_t index;
  /**
   * An `AirglowOrigin`.
   */
  uint32_t origin;
  /**
   * `VkFormat` of a scratch image; 0 otherwise.
   */
  uint32_t format;
  /**
   * Bytes of a buffer, or of the texels of a scratch image; 0 for an image of the host's. A device may pad it.
   */
  uint64_t bytes;
  /**
   * Width and height of a scratch image; 0 otherwise.
   */
  uint32_t extent[2];
  /**
   * `VkBufferUsageFlags` or `VkImageUsageFlags` that the frame needs.
   */
  uint32_t usage;
  /**
   * 1: an image.
   */
  uint32_t is_image;
  /**
   * Its name.
   */
  const char *name;
} AirglowResourceInfo;

/**
 * What the light of near emitters is prepared for. Zero is the default of every field.
 */
typedef struct AirglowRadianceSettings {
  /**
   * `sizeof(AirglowRadianceSettings)`.
   */
  uint32_t struct_size;
  /**
   * Bands of light vectors, 3 to 6: that of the relighting they go into. 0 is 4.
   */
  uint32_t order;
  /**
   * 1: samples hold no gradients.
   */
  uint32_t without_gradients;
  /**
   * Texels along a side of a cube face, a multiple of 8 to 128. 0 is 8.
   */
  uint32_t face;
  /**
   * Rays along a side of a texel: 1, 2 or 4. 0 is 4.
   */
  uint32_t rays;
  /**
   * An `AirglowRadianceOracle`.
   */
  uint32_t oracle;
  /**
   * Most samples of a receiver, to 65536: they have their memory from the start. 0 is 4096.
   */
  uint32_t limit;
  /**
   * Most levels that a split goes down, to 8. 0 is 3.
   */
  uint32_t stride;
  /**
   * Nodes estimated above it are split, in the oracle's unit. 0 is 0.01, below 0 is 0.
   */
  double bound;
  /**
   * What part of the light that emitters would send unhidden a sample is taken to miss, to 1. 0 is 0.1, below 0 is 0.
   */
  double hidden;
  /**
   * By what part of the bound samples may be stale before they are taken again when emitters move. 0 is 0.25; below 0
   * all are taken again in each such frame, and half the memory is needed.
   */
  double keep;
  /**
   * 1: samples are never taken in closed form.
   */
  uint32_t without_closed_forms;
  /**
   * Not used; 0.
   */
  uint32_t reserved;
} AirglowRadianceSettings;

/**
 * A triangle that emits the same radiance from both sides; one of radiance zero blocks light. Elements of arrays never
 * grow.
 */
typedef struct AirglowEmitter {
  /**
   * Three corners, metres, in the space of the receiver's positions.
   */
  double corners[3][3];
  /**
   * Linear red, green and blue radiance, W/sr/m2.
   */
  double radiance[3];
} AirglowEmitter;

/**
 * A sphere that emits the same radiance everywhere; one of radiance zero blocks light. Elements of arrays never grow.
 */
typedef struct AirglowEmitterSphere {
  /**
   * Its centre, metres, in the space of the receiver's positions.
   */
  double center[3];
  /**
   * Its radius, metres.
   */
  double radius;
  /**
   * Linear red, green and blue radiance, W/sr/m2.
   */
  double radiance[3];
} AirglowEmitterSphere;

/**
 * What a receiver is lit by.
 */
typedef struct AirglowRadianceLights {
  /**
   * `sizeof(AirglowRadianceLights)`.
   */
  uint32_t struct_size;
  /**
   * Not used; 0.
   */
  uint32_t reserved;
  /**
   * Triangles that emit or block.
   */
  const struct AirglowEmitter *emitters;
  /**
   * How many.
   */
  size_t emitter_count;
  /**
   * Spheres that emit or block.
   */
  const struct AirglowEmitterSphere *spheres;
  /**
   * How many.
   */
  size_t sphere_count;
  /**
   * Light from far away about the axes of that space, which every vertex gets as well: red, green and blue of each of
   * `order^2` coefficients of spherical harmonics. Null for none.
   */
  const float *distant;
  /**
   * Coefficients of it: `order^2`, or 0.
   */
  size_t distant_count;
} AirglowRadianceLights;

/**
 * Consecutive vertices of a receiver whose light lies in a buffer of its own: an instance. Elements of arrays never grow.
 */
typedef struct AirglowRadiancePart {
  /**
   * The first vertex.
   */
  uint32_t first;
  /**
   * How many.
   */
  uint32_t count;
  /**
   * Turns directions from the space of positions and emitters into that of the part's light, orthogonal, column-major:
   * the inverse of an instance's rotation, mirrored or not. All zero is the identity.
   */
  double turn[9];
} AirglowRadiancePart;

/**
 * Vertices in one space, that of the emitters: a mesh, or all instances placed.
 */
typedef struct AirglowRadianceReceiverInfo {
  /**
   * `sizeof(AirglowRadianceReceiverInfo)`.
   */
  uint32_t struct_size;
  /**
   * Not used; 0.
   */
  uint32_t reserved;
  /**
   * Three floats a vertex, metres.
   */
  const float *positions;
  /**
   * Vertices.
   */
  size_t vertex_count;
  /**
   * Transfer vectors (`airglow_bake`), `order^2` values a vertex, that say where light matters; null for vectors of
   * length 1.
   */
  const float *transfer;
  /**
   * Values of them: `order^2 * vertex_count`, or 0.
   */
  size_t transfer_count;
  /**
   * The instances; null for one of all vertices.
   */
  const struct AirglowRadiancePart *parts;
  /**
   * How many; 0 for one of all vertices.
   */
  size_t part_count;
} AirglowRadianceReceiverInfo;

/**
 * What the pass is prepared for. Zero is the default of every field.
 */
typedef struct AirglowRelightSettings {
  /**
   * `sizeof(AirglowRelightSettings)`.
   */
  uint32_t struct_size;
  /**
   * Bands of every vector, 1 to 6; order^2 coefficients. 0 is 4.
   */
  uint32_t order;
  /**
   * An `AirglowStorage`.
   */
  uint32_t storage;
  /**
   * An `AirglowOutput`.
   */
  uint32_t output;
  /**
   * An `AirglowMethod`.
   */
  uint32_t method;
  /**
   * An `AirglowLightKind`.
   */
  uint32_t light;
  /**
   * 1: instances may bring a dynamic visibility vector for each vertex.
   */
  uint32_t visibility;
  /**
   * 1: instances of meshes without vectors may bring the normals of their vertices, for colours.
   */
  uint32_t normals;
  /**
   * 1: texels of environments that are not finite or negative are counted (`airglow_relight_health_latest`).
   */
  uint32_t health;
  /**
   * Not used; 0.
   */
  uint32_t reserved;
} AirglowRelightSettings;

/**
 * Bad texels of a frame, counted where an environment was projected in it; a component that is not finite counts as black.
 */
typedef struct AirglowRelightHealth {
  /**
   * The context's frame that was counted.
   */
  uint64_t frame;
  /**
   * 1: a frame was counted, and the device is done with it. 0: the other fields say nothing.
   */
  uint32_t counted;
  /**
   * Texels with a component that is not finite.
   */
  uint32_t not_finite;
  /**
   * Other texels with a negative component.
   */
  uint32_t negative;
  /**
   * Not used.
   */
  uint32_t reserved;
} AirglowRelightHealth;

/**
 * One appearance of a mesh. Elements of arrays never grow.
 */
typedef struct AirglowRelightInstance {
  /**
   * The number that `airglow_relight_add_mesh` gave.
   */
  uint64_t mesh;
  /**
   * From object space to the world, a quaternion x, y, z, w of any length; all zero is the identity.
   */
  double rotation[4];
  /**
   * 1: the instance is mirrored; an inversion `d -> -d` follows the rotation.
   */
  uint32_t inverted;
  /**
   * A sum of `AIRGLOW_INPUT_...`.
   */
  uint32_t inputs;
} AirglowRelightInstance;

/**
 * A frame: light, and what it falls on. The results of its instances lie one after another in a buffer of the host's.
 */
typedef struct AirglowRelightFrame {
  /**
   * `sizeof(AirglowRelightFrame)`.
   */
  uint32_t struct_size;
  /**
   * An `AirglowLight`.
   */
  uint32_t light;
  /**
   * Turns the light in the world, a quaternion x, y, z, w of any length; all zero is the identity.
   */
  double light_rotation[4];
  /**
   * The instances.
   */
  const struct AirglowRelightInstance *instances;
  /**
   * How many.
   */
  size_t instance_count;
  /**
   * Of an environment in an image of the host's: texels of a row.
   */
  uint32_t environment_width;
  /**
   * Of an environment in an image of the host's: rows.
   */
  uint32_t environment_height;
  /**
   * Of an environment in an image of the host's: a number that changes with its contents, below 2^63; it is projected
   * only when the number changes.
   */
  uint64_t environment_revision;
} AirglowRelightFrame;

/**
 * Where the results of an instance lie in the buffer of results. Elements of arrays never grow.
 */
typedef struct AirglowResultRange {
  /**
   * First byte: the offset of the instance's vertex buffer.
   */
  uint64_t offset;
  /**
   * Bytes.
   */
  uint64_t size;
  /**
   * Vertices.
   */
  uint32_t vertex_count;
  /**
   * Not used.
   */
  uint32_t reserved;
} AirglowResultRange;

/**
 * Bytes that the settings take, before anything is made; a prepared frame says its own
 * (`airglow_prepared_resources`).
 */
typedef struct AirglowRelightBytes {
  /**
   * Of the vectors of a mesh with that many vertices; twice until its first frame is recorded.
   */
  uint64_t vectors;
  /**
   * Of the results of an instance of it.
   */
  uint64_t results;
  /**
   * `VkBufferUsageFlags` that the host's buffer of results needs for the pass, beside its own.
   */
  uint32_t results_usage;
  /**
   * Not used.
   */
  uint32_t reserved;
} AirglowRelightBytes;

/**
 * One thing asked of a device. Texts live until the requirements change or are dropped.
 */
typedef struct AirglowNeed {
  /**
   * An `AirglowNeedKind`.
   */
  uint32_t kind;
  /**
   * 1: without it nothing runs. 0: it only buys something.
   */
  uint32_t required;
  /**
   * See `AirglowNeedKind`.
   */
  uint64_t value;
  /**
   * See `AirglowNeedKind`.
   */
  uint64_t flags;
  /**
   * The name of extension, feature or limit; empty for others.
   */
  const char *name;
  /**
   * What it is for or what it buys.
   */
  const char *why;
} AirglowNeed;

/**
 * A physical device, to be asked what it supports before there is a device.
 */
typedef struct AirglowPhysicalDevice {
  /**
   * `sizeof(AirglowPhysicalDevice)`.
   */
  uint32_t struct_size;
  /**
   * The queue family that commands will be submitted to.
   */
  uint32_t queue_family;
  /**
   * `vkGetInstanceProcAddr`, the loader's or the host's own in front of it.
   */
  AirglowFunction get_instance_proc_addr;
  /**
   * The `VkInstance`.
   */
  uint64_t instance;
  /**
   * The `VkPhysicalDevice`; Vulkan 1.3 or newer.
   */
  uint64_t physical_device;
} AirglowPhysicalDevice;

/**
 * What shadows are prepared for. Zero is the default of every field.
 */
typedef struct AirglowShadowSettings {
  /**
   * `sizeof(AirglowShadowSettings)`.
   */
  uint32_t struct_size;
  /**
   * Bands, 3 to 6: that of the relighting it goes into. 0 is 4.
   */
  uint32_t order;
  /**
   * 1: receivers bring normals, and what lies below their tangent planes is left out.
   */
  uint32_t normals;
  /**
   * 1: results stay as they come, and are not made ones that a visibility can have.
   */
  uint32_t unclamped;
  /**
   * Share of a half space below which a sphere is left out of a whole cluster, to 1. 0 is 1e-5, below 0 nothing is left
   * out.
   */
  double reach;
  /**
   * Deringing: band l is divided by `1 + window l^2 (l + 1)^2`; 0 to 1.
   */
  double window;
  /**
   * Smallest eigenvalue over the largest before the logarithm, to 0.5. 0 is 0.02.
   */
  double clip;
  /**
   * An `AirglowShadowExponential`.
   */
  uint32_t exponential;
  /**
   * Of a series, 1 to 32.
   */
  uint32_t degree;
  /**
   * Of a series by Horner's rule the largest norm of what it is given, of the hybrid its threshold; above 0.
   */
  double norm;
  /**
   * Share of a half space below which a node of a hierarchy stands for what it holds, to 1. 0 is 0.03, below 0 spheres
   * are taken alone.
   */
  double cut;
} AirglowShadowSettings;

/**
 * A blocker. Elements of arrays never grow.
 */
typedef struct AirglowSphere {
  /**
   * Its centre, in the host's world.
   */
  double center[3];
  /**
   * Its radius; a sphere of radius 0 blocks nothing.
   */
  double radius;
} AirglowSphere;

/**
 * A set of spheres in a pose. Elements of arrays never grow.
 */
typedef struct AirglowSphereSet {
  /**
   * Its hierarchy; null for one without.
   */
  const struct AirglowSphereHierarchy *hierarchy;
  /**
   * Its spheres, in the order in which the hierarchy was made of them.
   */
  const struct AirglowSphere *spheres;
  /**
   * How many.
   */
  size_t sphere_count;
} AirglowSphereSet;

/**
 * What the pass did in a frame.
 */
typedef struct AirglowShadowCounts {
  /**
   * Clusters of up to 64 vertices.
   */
  uint64_t clusters;
  /**
   * Clusters out of reach of every sphere.
   */
  uint64_t open;
  /**
   * Spheres, summed over clusters.
   */
  uint64_t spheres;
  /**
   * Vertices whose result was none that a visibility can have.
   */
  uint64_t clamped;
} AirglowShadowCounts;

#ifdef __cplusplus
extern "C" {
#endif // __cplusplus

/**
 * The version of the library: major in the highest 10 bits, minor in the next 10, patch in the lowest 12.
 */
uint32_t airglow_version(void);

/**
 * Bakes transfer vectors: `order^2` values a vertex, vertex-major, to be given to `airglow_relight_add_mesh`. They
 * carry 1/pi and no albedo. The same input gives the same bits on any number of threads. `stats` may be null.
 *
 * The caller promises:
 * All arrays of `info` have as many elements as it says; `transfer` has room for `transfer_count` values, which must be
 * `vertex_count * order^2`.
 */
AirglowStatus airglow_bake(const struct AirglowBakeInfo *info,
                           float *transfer,
                           size_t transfer_count,
                           struct AirglowBakeStats *stats,
                           struct AirglowError *error);

#if defined(AIRGLOW_CONFORMANCE)
/**
 * Adds what the conformance kit asks of a device.
 *
 * The caller promises:
 * Nothing beyond the pointers being valid.
 */
AirglowStatus airglow_conformance_require(struct AirglowRequirements *requirements, struct AirglowError *error);
#endif

#if defined(AIRGLOW_CONFORMANCE)
/**
 * Runs the conformance kit on the host's device: passes made by the functions of this header and by Rust, between
 * commands of the kit's own, by accesses and record and by the library's graph; the bits, the layouts and the state of
 * the command buffer are compared, and nothing may stay alive. `*failures` gets the number of checks that failed. What
 * validation layers say goes to the host's messenger. A check that failed may leave objects of the device behind.
 *
 * The caller promises:
 * As `airglow_context_adopt`; no one else uses the queue meanwhile.
 */
AirglowStatus airglow_conformance_run(const struct AirglowConformanceInfo *info,
                                      uint32_t *failures,
                                      struct AirglowError *error);
#endif

/**
 * Adopts the host's device. Nothing is submitted, waited for or started, now or later.
 *
 * The caller promises:
 * The handles are alive and belong together, and `info` states truly what was enabled on them. Instance and device
 * outlive the context and all that was made from it; before the last of those is dropped, the device has finished all
 * work recorded through it. The pipeline cache is not used by another thread while pipelines are made.
 */
AirglowStatus airglow_context_adopt(const struct AirglowAdoptInfo *info,
                                    struct AirglowContext **context,
                                    struct AirglowError *error);

/**
 * Starts frame `frame`: memory of the frame `frames_in_flight` earlier is used again, and what was dropped that long
 * ago is destroyed. Frame 0 has begun when the context is made; frames count up.
 *
 * The caller promises:
 * The device has finished everything recorded in frames up to `frame - frames_in_flight`, and those command buffers
 * will not be submitted again.
 */
AirglowStatus airglow_context_begin_frame(const struct AirglowContext *context,
                                          uint64_t frame,
                                          struct AirglowError *error);

/**
 * What the device memory is held for, as JSON: `[{"owner": "relight", "bytes": 1024, "objects": 2}]`, sorted by owner.
 *
 * The caller promises:
 * `text` as `AirglowText` says.
 */
AirglowStatus airglow_context_memory_json(const struct AirglowContext *context,
                                          struct AirglowText *text,
                                          struct AirglowError *error);

/**
 * The last step that the device began, by the breadcrumbs it wrote, for after a loss; `name` gets the step's name.
 *
 * The caller promises:
 * `reached` may be written; `name` as `AirglowText` says.
 */
AirglowStatus airglow_context_last_pass_reached(const struct AirglowContext *context,
                                                struct AirglowPassReached *reached,
                                                struct AirglowText *name,
                                                struct AirglowError *error);

/**
 * Drops the context. What was made from it may be dropped before or after. Null is nothing.
 *
 * The caller promises:
 * The pointer is not used again. When the context and all that was made from it are dropped, the device exists and has
 * finished all work recorded through them.
 */
void airglow_context_drop(struct AirglowContext *context);

/**
 * Adds what the pass asks of a device with these settings.
 *
 * The caller promises:
 * `settings` points at as many bytes as it says.
 */
AirglowStatus airglow_fog_require(struct AirglowRequirements *requirements,
                                  const struct AirglowFogSettings *settings,
                                  struct AirglowError *error);

/**
 * Makes the pass: its kernels.
 *
 * The caller promises:
 * `settings` points at as many bytes as it says; `fog` may be written.
 */
AirglowStatus airglow_fog_new(const struct AirglowContext *context,
                              const struct AirglowFogSettings *settings,
                              struct AirglowFog **fog,
                              struct AirglowError *error);

/**
 * Drops the pass; views that were prepared stay usable. Null is nothing.
 *
 * The caller promises:
 * The pointer is not used again.
 */
void airglow_fog_drop(struct AirglowFog *fog);

/**
 * Adds what a background asks of a device with these settings.
 *
 * The caller promises:
 * `settings` points at as many bytes as it says.
 */
AirglowStatus airglow_fog_background_require(struct AirglowRequirements *requirements,
                                             const struct AirglowFogBackgroundSettings *settings,
                                             struct AirglowError *error);

/**
 * Makes a background: its kernels, and memory for 11 bytes a texel of the environment.
 *
 * The caller promises:
 * `settings` points at as many bytes as it says; `background` may be written.
 */
AirglowStatus airglow_fog_background_new(const struct AirglowContext *context,
                                         const struct AirglowFogBackgroundSettings *settings,
                                         struct AirglowFogBackground **background,
                                         struct AirglowError *error);

/**
 * Drops a background; what was prepared stays usable. Null is nothing.
 *
 * The caller promises:
 * The pointer is not used again.
 */
void airglow_fog_background_drop(struct AirglowFogBackground *background);

/**
 * Prepares the picture of an environment in a medium. It is no work for every frame: record it when the environment or
 * the medium before it has changed.
 *
 * The caller promises:
 * `view` points at as many bytes as it says; `prepared` may be written.
 */
AirglowStatus airglow_fog_background_prepare(const struct AirglowFogBackground *background,
                                             const struct AirglowFogBackgroundView *view,
                                             struct AirglowPrepared **prepared,
                                             struct AirglowError *error);

/**
 * Sets the medium of a prepared picture, which counts from the next recording on. On an error the old one stays.
 *
 * The caller promises:
 * `view` points at as many bytes as it says.
 */
AirglowStatus airglow_fog_background_set(const struct AirglowPrepared *prepared,
                                         const struct AirglowFogBackgroundView *view,
                                         struct AirglowError *error);

/**
 * Writes the plan that the library's graph makes of a view of `width * height` pixels: what it uses, its barriers, and
 * what was left out, why, and what would bring it back. The host's images are handed over as their use wants them; depth
 * is of 32 bits. The format is an `AirglowPlanFormat`.
 *
 * The caller promises:
 * `view` as with `airglow_fog_prepare`; `text` as `AirglowText` says.
 */
AirglowStatus airglow_fog_plan(const struct AirglowFog *fog,
                               uint32_t width,
                               uint32_t height,
                               const struct AirglowFogView *view,
                               uint32_t format,
                               struct AirglowText *text,
                               struct AirglowError *error);

/**
 * Makes counters for `airglow_prepared_count`, of frames of this pass: pixels whose surface has a component that is not
 * finite; others with a negative one; pixels whose depth is not between 0 and 1.
 *
 * The caller promises:
 * `health` may be written.
 */
AirglowStatus airglow_fog_health_new(const struct AirglowFog *fog,
                                     struct AirglowHealth **health,
                                     struct AirglowError *error);

/**
 * Prepares a view of `width * height` pixels. `*prepared` gets null where the medium is clear: then there is nothing to
 * record, and the surface is the picture.
 *
 * The caller promises:
 * `view` points at as many bytes as it says, and so does its world; its lights are as many as it says; `prepared` may be
 * written.
 */
AirglowStatus airglow_fog_prepare(const struct AirglowFog *fog,
                                  uint32_t width,
                                  uint32_t height,
                                  const struct AirglowFogView *view,
                                  struct AirglowPrepared **prepared,
                                  struct AirglowError *error);

/**
 * Prepares views of `width * height` pixels each as one frame: pipelines and the barriers around it are those of one.
 * Resources have the place of their view as index. `*prepared` gets null where every medium is clear; a view whose own is
 * clear lists nothing.
 *
 * The caller promises:
 * `views` points at `view_count` pointers to views, each as with `airglow_fog_prepare`; `prepared` may be written.
 */
AirglowStatus airglow_fog_prepare_views(const struct AirglowFog *fog,
                                        uint32_t width,
                                        uint32_t height,
                                        const struct AirglowFogView *const *views,
                                        size_t view_count,
                                        struct AirglowPrepared **prepared,
                                        struct AirglowError *error);

/**
 * Sets camera, medium and lights of a prepared view, which count from the next recording on; lamps that come and go
 * allocate nothing once there were as many. A clear medium is refused: leave the pass out, or prepare anew. On an error
 * the view stays. `counts` may be null.
 *
 * The caller promises:
 * As `airglow_fog_prepare`; `counts` is null or may be written.
 */
AirglowStatus airglow_fog_set(const struct AirglowPrepared *prepared,
                              const struct AirglowFogView *view,
                              struct AirglowFogCounts *counts,
                              struct AirglowError *error);

/**
 * Sets one view of several as `airglow_fog_set` sets the first, by its place among those that were prepared.
 *
 * The caller promises:
 * As `airglow_fog_set`.
 */
AirglowStatus airglow_fog_set_view(const struct AirglowPrepared *prepared,
                                   uint32_t index,
                                   const struct AirglowFogView *view,
                                   struct AirglowFogCounts *counts,
                                   struct AirglowError *error);

/**
 * Sets the counts to 0, before what is counted of a frame.
 *
 * The caller promises:
 * As `airglow_prepared_record`.
 */
AirglowStatus airglow_health_clear(const struct AirglowHealth *health,
                                   uint64_t command_buffer,
                                   struct AirglowError *error);

/**
 * Copies the counts for `airglow_health_latest`, after what is counted of a frame, once in it.
 *
 * The caller promises:
 * As `airglow_prepared_record`.
 */
AirglowStatus airglow_health_collect(const struct AirglowHealth *health,
                                     uint64_t command_buffer,
                                     struct AirglowError *error);

/**
 * Says the counts of the newest frame that is done, without waiting: one that was collected `frames_in_flight` frames ago
 * or earlier.
 *
 * The caller promises:
 * `counts` may be written.
 */
AirglowStatus airglow_health_latest(const struct AirglowHealth *health,
                                    struct AirglowHealthCounts *counts,
                                    struct AirglowError *error);

/**
 * Drops counters. Null is nothing.
 *
 * The caller promises:
 * The pointer is not used again, and the device has finished what was recorded with it.
 */
void airglow_health_drop(struct AirglowHealth *health);

/**
 * Counts what is wrong with what a frame read and wrote, after `airglow_prepared_record` in the same command buffer with
 * the same bindings, before the host uses them. A map of normals counts while it is built (`airglow_normal_map_count`).
 *
 * The caller promises:
 * As `airglow_prepared_record`.
 */
AirglowStatus airglow_prepared_count(const struct AirglowPrepared *prepared,
                                     const struct AirglowHealth *health,
                                     uint64_t command_buffer,
                                     const struct AirglowBinding *bindings,
                                     size_t binding_count,
                                     struct AirglowError *error);

/**
 * Adds what the pass asks of a device with these settings.
 *
 * The caller promises:
 * `settings` points at as many bytes as it says.
 */
AirglowStatus airglow_normals_require(struct AirglowRequirements *requirements,
                                      const struct AirglowNormalsSettings *settings,
                                      struct AirglowError *error);

/**
 * Makes the pass: its kernels.
 *
 * The caller promises:
 * `settings` points at as many bytes as it says; `normals` may be written.
 */
AirglowStatus airglow_normals_new(const struct AirglowContext *context,
                                  const struct AirglowNormalsSettings *settings,
                                  struct AirglowNormals **normals,
                                  struct AirglowError *error);

/**
 * Drops the pass; maps that were made stay usable. Null is nothing.
 *
 * The caller promises:
 * The pointer is not used again.
 */
void airglow_normals_drop(struct AirglowNormals *normals);

/**
 * Makes a map: the memory of its build and its texture; nothing is recorded.
 *
 * The caller promises:
 * `info` points at as many bytes as it says, its texels are as many bytes as it says, its path is null or ends in a nul;
 * `map` may be written.
 */
AirglowStatus airglow_normal_map_new(const struct AirglowNormals *normals,
                                     const struct AirglowNormalMapInfo *info,
                                     struct AirglowNormalMap **map,
                                     struct AirglowError *error);

/**
 * Makes counters for `airglow_normal_map_count`: lobes that are not finite; lobes that hold no normal, so that fewer would
 * do.
 *
 * The caller promises:
 * `health` may be written.
 */
AirglowStatus airglow_normals_health_new(const struct AirglowNormals *normals,
                                         struct AirglowHealth **health,
                                         struct AirglowError *error);

/**
 * Has the lobes of all levels counted in a step of the build of their own, before its last: to be called before any step
 * is prepared. A map that comes from a file has nothing to count.
 *
 * The caller promises:
 * Nothing beyond the pointers being valid.
 */
AirglowStatus airglow_normal_map_count(const struct AirglowNormalMap *map,
                                       const struct AirglowHealth *health,
                                       struct AirglowError *error);

/**
 * Writes the plan that the library's graph makes of the next steps of a map's build, at most `most`; they do not count as
 * taken. The format is an `AirglowPlanFormat`.
 *
 * The caller promises:
 * `text` as `AirglowText` says.
 */
AirglowStatus airglow_normal_map_plan(const struct AirglowNormalMap *map,
                                      size_t most,
                                      uint32_t format,
                                      struct AirglowText *text,
                                      struct AirglowError *error);

/**
 * Says how far the build of a map is.
 *
 * The caller promises:
 * `progress` may be written.
 */
AirglowStatus airglow_normal_map_progress(const struct AirglowNormalMap *map,
                                          struct AirglowNormalMapProgress *progress,
                                          struct AirglowError *error);

/**
 * Says what the texture of a map is; its contents are there when the last step is done.
 *
 * The caller promises:
 * `texture` may be written.
 */
AirglowStatus airglow_normal_map_texture(const struct AirglowNormalMap *map,
                                         struct AirglowLobeTexture *texture,
                                         struct AirglowError *error);

/**
 * Records copies of a texture's bytes for `airglow_normal_map_store`, after its last step.
 *
 * The caller promises:
 * As `airglow_prepared_record`; all steps were recorded before, in this command buffer or in one submitted earlier.
 */
AirglowStatus airglow_normal_map_read_back(const struct AirglowNormalMap *map,
                                           uint64_t command_buffer,
                                           struct AirglowError *error);

/**
 * Writes the texture of a map to a file, whole or not at all, for the `cache` of `AirglowNormalMapInfo`.
 *
 * The caller promises:
 * `path` ends in a nul; the device has finished what `airglow_normal_map_read_back` recorded.
 */
AirglowStatus airglow_normal_map_store(const struct AirglowNormalMap *map,
                                       const char *path,
                                       struct AirglowError *error);

/**
 * Frees what only the build of a map needs, at once or frames later, as the device is done with it; the texture stays.
 *
 * The caller promises:
 * Nothing beyond the pointers being valid.
 */
AirglowStatus airglow_normal_map_finish(const struct AirglowNormalMap *map, struct AirglowError *error);

/**
 * Drops a map and its texture. Null is nothing.
 *
 * The caller promises:
 * The pointer is not used again; the host has no view of the texture any more.
 */
void airglow_normal_map_drop(struct AirglowNormalMap *map);

/**
 * Prepares the next steps of a map's build, at most `most`; they count as taken. `*prepared` gets null when none are left.
 * Steps work on what earlier ones wrote: record each once, in order, in one frame or in many. Nothing is bound, and
 * the host makes no barrier: after the last step the texture is ready for its fragment shaders.
 *
 * The caller promises:
 * `prepared` may be written.
 */
AirglowStatus airglow_normal_map_prepare(const struct AirglowNormalMap *map,
                                         size_t most,
                                         struct AirglowPrepared **prepared,
                                         struct AirglowError *error);

/**
 * Lists every use of every resource, step by step. Before recording, the host makes its own resources, and the scratch,
 * available to the first use listed of each, in that layout; afterwards it waits for the last. Between the steps the
 * library stands its own barriers; layouts of scratch images are all its own. `*count` holds the size of
 * `accesses` before and the number of uses after; with `accesses` null only the number is written.
 *
 * The caller promises:
 * `accesses` is null or has room for `*count` elements.
 */
AirglowStatus airglow_prepared_accesses(const struct AirglowPrepared *prepared,
                                        struct AirglowAccess *accesses,
                                        size_t *count,
                                        struct AirglowError *error);

/**
 * Lists every resource that the frame uses, with its bytes, before anything is made. `*count` as with
 * `airglow_prepared_accesses`.
 *
 * The caller promises:
 * `resources` is null or has room for `*count` elements.
 */
AirglowStatus airglow_prepared_resources(const struct AirglowPrepared *prepared,
                                         struct AirglowResourceInfo *resources,
                                         size_t *count,
                                         struct AirglowError *error);

/**
 * Makes the scratch of a frame, charged to its pass in the context's memory, for hosts that would not place it
 * themselves. Calling it again makes it anew.
 *
 * The caller promises:
 * Nothing beyond the pointers being valid.
 */
AirglowStatus airglow_prepared_make_scratch(struct AirglowPrepared *prepared, struct AirglowError *error);

/**
 * Records a frame into a command buffer of the host's: its steps, with barriers between them and none around them
 * (`airglow_prepared_accesses`). Bound are the host's resources, and the scratch unless
 * `airglow_prepared_make_scratch` made it. State of the command buffer that is changed: pipelines, descriptor set 0 and
 * push constants of both bind points, vertex buffer 0, viewport 0, scissor 0. Rendering and labels are closed again.
 *
 * The last few sets of bindings are kept: recorded again with one of them, a frame allocates nothing on the heap. Images
 * that were bound stay until `airglow_prepared_forget` or until the prepared frame is dropped.
 *
 * The caller promises:
 * `command_buffer` is a primary `VkCommandBuffer` of a pool of the adopted queue family, recording, outside rendering,
 * used by no one else meanwhile; it is submitted at most once, in the context's frame. Bindings describe live resources
 * of the device truly, which stay until the frame is done; host and scratch resources are in the states listed.
 */
AirglowStatus airglow_prepared_record(const struct AirglowPrepared *prepared,
                                      uint64_t command_buffer,
                                      const struct AirglowBinding *bindings,
                                      size_t binding_count,
                                      struct AirglowError *error);

/**
 * Forgets the resources that the frame was recorded with: before the host destroys an image among them.
 *
 * The caller promises:
 * Nothing beyond the pointers being valid.
 */
AirglowStatus airglow_prepared_forget(const struct AirglowPrepared *prepared, struct AirglowError *error);

/**
 * Drops a prepared frame. Null is nothing.
 *
 * The caller promises:
 * The pointer is not used again.
 */
void airglow_prepared_drop(struct AirglowPrepared *prepared);

/**
 * Adds what the pass asks of a device with these settings.
 *
 * The caller promises:
 * `settings` points at as many bytes as it says.
 */
AirglowStatus airglow_radiance_require(struct AirglowRequirements *requirements,
                                       const struct AirglowRadianceSettings *settings,
                                       struct AirglowError *error);

/**
 * Makes the pass: its kernels.
 *
 * The caller promises:
 * `settings` points at as many bytes as it says; `radiance` may be written.
 */
AirglowStatus airglow_radiance_new(const struct AirglowContext *context,
                                   const struct AirglowRadianceSettings *settings,
                                   struct AirglowRadiance **radiance,
                                   struct AirglowError *error);

/**
 * Drops the pass; what was made and prepared stays usable. Null is nothing.
 *
 * The caller promises:
 * The pointer is not used again.
 */
void airglow_radiance_drop(struct AirglowRadiance *radiance);

/**
 * Writes the plan that the library's graph makes of the light of a receiver's vertices: steps, barriers, lifetimes and
 * bytes, and what was left out, why, and what would bring it back. The format is an `AirglowPlanFormat`.
 *
 * The caller promises:
 * `lights` as with `airglow_radiance_prepare`; `text` as `AirglowText` says.
 */
AirglowStatus airglow_radiance_plan(const struct AirglowRadiance *radiance,
                                    const struct AirglowRadianceReceiver *receiver,
                                    const struct AirglowRadianceLights *lights,
                                    uint32_t format,
                                    struct AirglowText *text,
                                    struct AirglowError *error);

/**
 * Makes counters for `airglow_prepared_count`, of frames of this pass: vertices whose light is not finite; receivers whose
 * limit of samples kept nodes from being split.
 *
 * The caller promises:
 * `health` may be written.
 */
AirglowStatus airglow_radiance_health_new(const struct AirglowRadiance *radiance,
                                          struct AirglowHealth **health,
                                          struct AirglowError *error);

/**
 * Prepares the light of a receiver's vertices. `*prepared` gets null where no emitter gives light, or no vertex reflects
 * any: then there is nothing to record, and no light of vertices.
 *
 * The caller promises:
 * `lights` points at as many bytes as it says, and its arrays have as many elements as it says; `prepared` may be written.
 */
AirglowStatus airglow_radiance_prepare(const struct AirglowRadiance *radiance,
                                       const struct AirglowRadianceReceiver *receiver,
                                       const struct AirglowRadianceLights *lights,
                                       struct AirglowPrepared **prepared,
                                       struct AirglowError *error);

/**
 * Sets the lights of a prepared frame, which count from the next recording on; while emitters stay, no sample is taken
 * again. On an error the old ones stay.
 *
 * The caller promises:
 * As `airglow_radiance_prepare`.
 */
AirglowStatus airglow_radiance_set(const struct AirglowPrepared *prepared,
                                   const struct AirglowRadianceLights *lights,
                                   struct AirglowError *error);

/**
 * Makes a receiver: the tree over its vertices, and its memory on the device. Copies go to the device with the first frame
 * that is recorded with it.
 *
 * The caller promises:
 * `info` points at as many bytes as it says, and its arrays have as many elements as it says; `receiver` may be written.
 */
AirglowStatus airglow_radiance_receiver_new(const struct AirglowRadiance *radiance,
                                            const struct AirglowRadianceReceiverInfo *info,
                                            struct AirglowRadianceReceiver **receiver,
                                            struct AirglowError *error);

/**
 * Takes the samples of a receiver anew with the next frame that is recorded: for a host that threw away a recorded frame.
 *
 * The caller promises:
 * Nothing beyond the pointers being valid.
 */
AirglowStatus airglow_radiance_forget_samples(const struct AirglowRadianceReceiver *receiver,
                                              struct AirglowError *error);

/**
 * Drops a receiver; what was prepared with it stays usable. Null is nothing.
 *
 * The caller promises:
 * The pointer is not used again.
 */
void airglow_radiance_receiver_drop(struct AirglowRadianceReceiver *receiver);

/**
 * Adds what the pass asks of a device with these settings.
 *
 * The caller promises:
 * `settings` points at as many bytes as it says.
 */
AirglowStatus airglow_relight_require(struct AirglowRequirements *requirements,
                                      const struct AirglowRelightSettings *settings,
                                      struct AirglowError *error);

/**
 * Makes the pass: its kernels and tables.
 *
 * The caller promises:
 * `settings` points at as many bytes as it says; `relight` may be written.
 */
AirglowStatus airglow_relight_new(const struct AirglowContext *context,
                                  const struct AirglowRelightSettings *settings,
                                  struct AirglowRelight **relight,
                                  struct AirglowError *error);

/**
 * States the host's world: in its axes rotations of light and instances, and light as SH RGB, come in with frames
 * prepared from now on, and results are multiplied with its pre-exposure. Before, it is airglow's own. Object space, and
 * so the bake, is in any axes. On an error the world stays.
 *
 * The caller promises:
 * `world` points at as many bytes as it says.
 */
AirglowStatus airglow_relight_set_world(const struct AirglowRelight *relight,
                                        const struct AirglowWorld *world,
                                        struct AirglowError *error);

/**
 * Drops the pass; frames that were prepared stay usable. Null is nothing.
 *
 * The caller promises:
 * The pointer is not used again.
 */
void airglow_relight_drop(struct AirglowRelight *relight);

/**
 * Adds a mesh of `vertex_count` vertices, in the host's order. `vectors` are vertex-major, `order^2` values a vertex:
 * transfer vectors (`airglow_bake`) for colours, static visibility vectors for incident radiance; null for a mesh that
 * nothing static shadows, whose instances bring their normals. `*mesh` gets its number, never 0. They are copied, and
 * go to the device with the next frame that uses the mesh.
 *
 * The caller promises:
 * `vectors` is null or has `vector_count` values; `name` is null or ends in a nul; `mesh` may be written.
 */
AirglowStatus airglow_relight_add_mesh(const struct AirglowRelight *relight,
                                       const char *name,
                                       uint32_t vertex_count,
                                       const float *vectors,
                                       size_t vector_count,
                                       uint64_t *mesh,
                                       struct AirglowError *error);

/**
 * Drops a mesh; its memory goes back when no frame in flight, and no prepared frame, can use it.
 *
 * The caller promises:
 * Nothing beyond the pointers being valid.
 */
AirglowStatus airglow_relight_drop_mesh(const struct AirglowRelight *relight,
                                        uint64_t mesh,
                                        struct AirglowError *error);

/**
 * Gives the environment of frames whose light is `AIRGLOW_LIGHT_ENVIRONMENT`: `width * height` texels of three floats,
 * equirectangular, linear Rec. 709 radiance in W/sr/m2, the first row up, the centre looking down -Z and u growing to
 * +X. They are checked, copied, and uploaded by the next frame that is recorded with them. Frames prepared before keep
 * the environment they were prepared with.
 *
 * The caller promises:
 * `texels` has `3 * width * height` values.
 */
AirglowStatus airglow_relight_set_environment(const struct AirglowRelight *relight,
                                              uint32_t width,
                                              uint32_t height,
                                              const float *texels,
                                              struct AirglowError *error);

/**
 * Sets the counts to 0, before the recordings of a frame; for settings with `health`.
 *
 * The caller promises:
 * As `airglow_prepared_record`.
 */
AirglowStatus airglow_relight_health_clear(const struct AirglowRelight *relight,
                                           uint64_t command_buffer,
                                           struct AirglowError *error);

/**
 * Copies the counts for `airglow_relight_health_latest`, after the recordings of a frame, once in it.
 *
 * The caller promises:
 * As `airglow_prepared_record`.
 */
AirglowStatus airglow_relight_health_collect(const struct AirglowRelight *relight,
                                             uint64_t command_buffer,
                                             struct AirglowError *error);

/**
 * Says the counts of the newest frame that is done, without waiting: one that was collected `frames_in_flight` frames ago
 * or earlier.
 *
 * The caller promises:
 * `health` may be written.
 */
AirglowStatus airglow_relight_health_latest(const struct AirglowRelight *relight,
                                            struct AirglowRelightHealth *health,
                                            struct AirglowError *error);

/**
 * Writes the plan that the library's graph makes of a frame: steps, barriers, lifetimes and bytes of what they use, and
 * what was left out, why, and what would bring it back. The host's resources stand in it with the sizes needed, handed
 * over as their first use wants them, the results going on to vertex input or to vertex shaders. The format is an
 * `AirglowPlanFormat`.
 *
 * The caller promises:
 * `frame` as with `airglow_relight_prepare`; `text` as `AirglowText` says.
 */
AirglowStatus airglow_relight_plan(const struct AirglowRelight *relight,
                                   const struct AirglowRelightFrame *frame,
                                   uint32_t format,
                                   struct AirglowText *text,
                                   struct AirglowError *error);

/**
 * Prepares a frame. Memory for the device is made for tables of a new size of environment alone; what the frame itself
 * needs is listed by `airglow_prepared_resources` and made by the host or by `airglow_prepared_make_scratch`.
 *
 * The caller promises:
 * `frame` points at as many bytes as it says, its instances are as many as it says; `prepared` may be written.
 */
AirglowStatus airglow_relight_prepare(const struct AirglowRelight *relight,
                                      const struct AirglowRelightFrame *frame,
                                      struct AirglowPrepared **prepared,
                                      struct AirglowError *error);

/**
 * Lists where the results of each instance lie, in the order of the frame; none when the pass was left out. `*count` as
 * with `airglow_prepared_accesses`.
 *
 * The caller promises:
 * `ranges` is null or has room for `*count` elements.
 */
AirglowStatus airglow_relight_ranges(const struct AirglowPrepared *prepared,
                                     struct AirglowResultRange *ranges,
                                     size_t *count,
                                     struct AirglowError *error);

/**
 * Turns the light and the instances of a prepared frame, in the frame's order; it counts from the next recording on. Of
 * the instances only `rotation` and `inverted` are read.
 *
 * The caller promises:
 * `light_rotation` has four values; `instances` has `instance_count` elements.
 */
AirglowStatus airglow_relight_turn(const struct AirglowPrepared *prepared,
                                   const double *light_rotation,
                                   const struct AirglowRelightInstance *instances,
                                   size_t instance_count,
                                   struct AirglowError *error);

/**
 * Sets what each band of the light of a prepared frame is multiplied with, red, green and blue, from the next recording on:
 * the zonal filter of a convolution about every direction, such as that of a medium before an environment. All 1 at first.
 * For light that turns: an environment's, or one vector for all.
 *
 * The caller promises:
 * `factors` has `3 * band_count` values.
 */
AirglowStatus airglow_relight_set_filter(const struct AirglowPrepared *prepared,
                                         const double *factors,
                                         size_t band_count,
                                         struct AirglowError *error);

/**
 * Shows (1) or hides (0) an instance of a prepared frame, and says whether its dynamic visibility blocks anything (1) or
 * not (0); it counts from the next recording on. Nothing is recorded for what is away, and the frame stays as it is.
 * Results of a hidden instance are not to be read.
 *
 * The caller promises:
 * Nothing beyond the pointers being valid.
 */
AirglowStatus airglow_relight_show(const struct AirglowPrepared *prepared,
                                   size_t instance,
                                   uint32_t shown,
                                   uint32_t shadowed,
                                   struct AirglowError *error);

/**
 * Puts the light of a prepared frame on (1) or out (0), from the next recording on. While it is out nothing is recorded:
 * results are not to be read, all is black.
 *
 * The caller promises:
 * Nothing beyond the pointers being valid.
 */
AirglowStatus airglow_relight_set_lit(const struct AirglowPrepared *prepared,
                                      uint32_t lit,
                                      struct AirglowError *error);

/**
 * Says the bytes of a mesh of `vertex_count` vertices and of its results.
 *
 * The caller promises:
 * `settings` points at as many bytes as it says; `bytes` may be written.
 */
AirglowStatus airglow_relight_bytes(const struct AirglowRelightSettings *settings,
                                    uint32_t vertex_count,
                                    struct AirglowRelightBytes *bytes,
                                    struct AirglowError *error);

/**
 * Makes requirements: what the library itself needs. Drop them with `airglow_requirements_drop`.
 *
 * The caller promises:
 * `requirements` may be written; `error` as everywhere.
 */
AirglowStatus airglow_requirements_new(struct AirglowRequirements **requirements, struct AirglowError *error);

/**
 * Drops requirements, and with them the texts of `airglow_requirements_list` and the structures that
 * `airglow_requirements_patch` put into a chain. Null is nothing.
 *
 * The caller promises:
 * `requirements` is not used again.
 */
void airglow_requirements_drop(struct AirglowRequirements *requirements);

/**
 * Lists everything asked for. `*count` holds the size of `needs` before and the number of needs after; with `needs`
 * null only the number is written.
 *
 * The caller promises:
 * `needs` is null or has room for `*count` needs.
 */
AirglowStatus airglow_requirements_list(struct AirglowRequirements *requirements,
                                        struct AirglowNeed *needs,
                                        size_t *count,
                                        struct AirglowError *error);

/**
 * Everything asked for, as JSON: what `airglow requirements` prints.
 *
 * The caller promises:
 * `text` as `AirglowText` says.
 */
AirglowStatus airglow_requirements_json(const struct AirglowRequirements *requirements,
                                        struct AirglowText *text,
                                        struct AirglowError *error);

/**
 * Compares the requirements with what a physical device supports. Returns `AIRGLOW_STATUS_MISSING` where it does not
 * suffice; `missing`, which may be null, then gets a JSON array of texts, one for each thing that is lacking.
 *
 * The caller promises:
 * The handles of `device` are alive and belong together; `missing` as `AirglowText` says.
 */
AirglowStatus airglow_requirements_check(const struct AirglowRequirements *requirements,
                                         const struct AirglowPhysicalDevice *device,
                                         struct AirglowText *missing,
                                         struct AirglowError *error);

/**
 * Switches the features asked for on in the `pNext` chain of a `VkDeviceCreateInfo`, before the device is made: those
 * required, and the optional ones that `device` supports (none, where `device` is null). Structures in the chain are
 * set and never duplicated, unknown ones stay, missing ones are appended. Features of Vulkan 1.0 go to
 * `enabled_features`, the `VkPhysicalDeviceFeatures` behind `pEnabledFeatures`, where it is given and the chain has no
 * `VkPhysicalDeviceFeatures2`. What was appended lives in the requirements: use the chain before they are dropped or
 * patch another.
 *
 * The caller promises:
 * `p_next` points at null or at a valid chain that may be written, `enabled_features` at null or a
 * `VkPhysicalDeviceFeatures`; the handles of `device` are alive and belong together.
 */
AirglowStatus airglow_requirements_patch(struct AirglowRequirements *requirements,
                                         const struct AirglowPhysicalDevice *device,
                                         uint32_t api_version,
                                         void **p_next,
                                         void *enabled_features,
                                         struct AirglowError *error);

/**
 * Adds what the pass asks of a device with these settings.
 *
 * The caller promises:
 * `settings` points at as many bytes as it says.
 */
AirglowStatus airglow_shadow_require(struct AirglowRequirements *requirements,
                                     const struct AirglowShadowSettings *settings,
                                     struct AirglowError *error);

/**
 * Makes the pass: its kernel and tables.
 *
 * The caller promises:
 * `settings` points at as many bytes as it says; `shadow` may be written.
 */
AirglowStatus airglow_shadow_new(const struct AirglowContext *context,
                                 const struct AirglowShadowSettings *settings,
                                 struct AirglowShadow **shadow,
                                 struct AirglowError *error);

/**
 * Drops the pass; what was made and prepared stays usable. Null is nothing.
 *
 * The caller promises:
 * The pointer is not used again.
 */
void airglow_shadow_drop(struct AirglowShadow *shadow);

/**
 * Puts the vertices of a mesh into clusters of 64, by their positions in object space; a mesh that is skinned keeps them.
 * `name`, which may be null, is used in the memory report.
 *
 * The caller promises:
 * `positions` has `3 * vertex_count` values; `name` is null or ends in a nul; `receivers` may be written.
 */
AirglowStatus airglow_shadow_receivers_new(const struct AirglowShadow *shadow,
                                           const char *name,
                                           const float *positions,
                                           size_t vertex_count,
                                           struct AirglowShadowReceivers **receivers,
                                           struct AirglowError *error);

/**
 * Drops receivers; what was prepared with them stays usable. Null is nothing.
 *
 * The caller promises:
 * The pointer is not used again.
 */
void airglow_shadow_receivers_drop(struct AirglowShadowReceivers *receivers);

/**
 * Makes the hierarchy of a set of spheres as it rests, for the order of the pass. Ratios are sought over points all around:
 * once for a set, not in a frame.
 *
 * The caller promises:
 * `spheres` has `sphere_count` elements; `hierarchy` may be written.
 */
AirglowStatus airglow_sphere_hierarchy_new(const struct AirglowShadow *shadow,
                                           const struct AirglowSphere *spheres,
                                           size_t sphere_count,
                                           struct AirglowSphereHierarchy **hierarchy,
                                           struct AirglowError *error);

/**
 * Drops a hierarchy; frames that it was set in keep what it said. Null is nothing.
 *
 * The caller promises:
 * The pointer is not used again.
 */
void airglow_sphere_hierarchy_drop(struct AirglowSphereHierarchy *hierarchy);

/**
 * Sets sets of spheres, with hierarchies and without, in a prepared frame; all else as `airglow_shadow_set` says.
 *
 * The caller promises:
 * `sets` has `set_count` elements, whose spheres are as many as each says; else as `airglow_shadow_set`.
 */
AirglowStatus airglow_shadow_set_sets(const struct AirglowPrepared *prepared,
                                      const struct AirglowSphereSet *sets,
                                      size_t set_count,
                                      const double *receiver_from_world,
                                      uint32_t *blocks,
                                      struct AirglowError *error);

/**
 * Prepares the visibility of the vertices of one instance; before spheres are set (`airglow_shadow_set`) nothing blocks.
 *
 * The caller promises:
 * `prepared` may be written.
 */
AirglowStatus airglow_shadow_prepare(const struct AirglowShadow *shadow,
                                     const struct AirglowShadowReceivers *receivers,
                                     struct AirglowPrepared **prepared,
                                     struct AirglowError *error);

/**
 * Sets the spheres of a prepared frame, which count from the next recording on. `receiver_from_world`, column-major, takes
 * them to the object space of the vertices: a rotation or mirroring, a uniform scale, a translation; null is the identity.
 * `*blocks`, which may be null, gets 1 if one has a radius, else 0: then the recording may be left out together with the
 * visibility of the instance (`airglow_relight_show`). On an error the old ones stay.
 *
 * The caller promises:
 * `spheres` has `sphere_count` elements; `receiver_from_world` is null or has 16 values; `blocks` is null or may be written.
 */
AirglowStatus airglow_shadow_set(const struct AirglowPrepared *prepared,
                                 const struct AirglowSphere *spheres,
                                 size_t sphere_count,
                                 const double *receiver_from_world,
                                 uint32_t *blocks,
                                 struct AirglowError *error);

/**
 * Makes counters for `airglow_prepared_count`, of frames of this pass: receivers whose position, and those whose normal, is
 * not finite; receivers whose visibility is not; those whose result was none that a visibility can have and was clamped.
 *
 * The caller promises:
 * `health` may be written.
 */
AirglowStatus airglow_shadow_health_new(const struct AirglowShadow *shadow,
                                        struct AirglowHealth **health,
                                        struct AirglowError *error);

/**
 * Sums the records of a frame as the host read them back.
 *
 * The caller promises:
 * `records` has two values for each of `cluster_count` clusters; `counts` may be written.
 */
AirglowStatus airglow_shadow_counts(const uint32_t *records,
                                    size_t cluster_count,
                                    struct AirglowShadowCounts *counts,
                                    struct AirglowError *error);

/**
 * Writes the plan that the library's graph makes of a prepared frame, with the spheres that are set now. The format is an
 * `AirglowPlanFormat`.
 *
 * The caller promises:
 * `text` as `AirglowText` says.
 */
AirglowStatus airglow_shadow_plan(const struct AirglowPrepared *prepared,
                                  uint32_t format,
                                  struct AirglowText *text,
                                  struct AirglowError *error);

/**
 * Refuses what no host can mean, with the reason; passes refuse it, too.
 *
 * The caller promises:
 * `world` points at as many bytes as it says.
 */
AirglowStatus airglow_world_check(const struct AirglowWorld *world, struct AirglowError *error);

#ifdef __cplusplus
}  // extern "C"
#endif  // __cplusplus

#endif  /* AIRGLOW_H */

// The demo host's forward draw: places a mesh, and hands on what the passes wrote for each vertex.
//
// AIRGLOW_RELIGHT 1: the relight pass has rendered the light that a white diffuse surface sends out into a vertex
// array, bound as one more attribute. 0: the room is absent, and the draw has no such input.

// HOST_LIGHTS 1: the scene has lights that shine on surfaces, whose place and normal the fragment stage needs.
// FOG_COMPLETE 2: the lights shine on the vertices, through a medium; with AIRGLOW_FOG and HOST_LIGHTS.
// HOST_TANGENTS 1: the surface has a normal map, whose axes the fragment stage needs, too; only with HOST_LIGHTS.
// HOST_INCIDENT 1: and the incident radiance of its vertices, nine coefficients; only with HOST_TANGENTS.

#include "host/frame.glsl"
#include "host/material.glsl"
#if FOG_COMPLETE == 2
#include "host/lit.glsl"
#endif

layout(location = 0) in vec3 position;
layout(location = 1) in vec2 uv;
#if AIRGLOW_RELIGHT
layout(location = 2) in vec4 colour;
#endif
#if HOST_LIGHTS
layout(location = 3) in vec3 normal;
#endif
#if HOST_TANGENTS
layout(location = 4) in vec4 tangent;
#endif
#if HOST_INCIDENT
layout(location = 5) in vec3 incident_0;
layout(location = 6) in vec3 incident_1;
layout(location = 7) in vec3 incident_2;
layout(location = 8) in vec3 incident_3;
layout(location = 9) in vec3 incident_4;
layout(location = 10) in vec3 incident_5;
layout(location = 11) in vec3 incident_6;
layout(location = 12) in vec3 incident_7;
layout(location = 13) in vec3 incident_8;
#endif

// A depth drawn ahead is that of the draw, to the bit.
precise gl_Position;

layout(location = 0) out vec2 out_uv;
layout(location = 1) out vec3 out_light;
#if FOG_COMPLETE == 2
layout(location = 5) out vec3 out_lit;
layout(location = 6) out vec3 out_left;
layout(location = 7) out vec3 out_before;
#elif HOST_LIGHTS
layout(location = 2) out vec3 out_normal;
layout(location = 3) out vec3 out_position;
#endif
#if HOST_TANGENTS
layout(location = 4) out vec4 out_tangent;
#endif
#if HOST_INCIDENT
layout(location = 5) out vec3 out_incident_0;
layout(location = 6) out vec3 out_incident_1;
layout(location = 7) out vec3 out_incident_2;
layout(location = 8) out vec3 out_incident_3;
layout(location = 9) out vec3 out_incident_4;
layout(location = 10) out vec3 out_incident_5;
layout(location = 11) out vec3 out_incident_6;
layout(location = 12) out vec3 out_incident_7;
layout(location = 13) out vec3 out_incident_8;
#endif

void main()
{
    vec4 place = material.world_from_object * vec4(position, 1.0);
    gl_Position = frame.clip_from_world * place;
#if HOST_LIGHTS
    // The cofactors turn normals as the inverse transpose does, up to their length.
    mat3 linear = mat3(material.world_from_object);
    mat3 cofactors = mat3(cross(linear[1], linear[2]), cross(linear[2], linear[0]), cross(linear[0], linear[1]));
#if FOG_COMPLETE == 2
    bool unlit = (material.flags & 1u) != 0u;
    vec2 surface = unpackHalf2x16(material.surface);
    vec3 turned = cofactors * normal;
    out_lit = unlit ? vec3(0.0) : lights_reflected(material.base_colour.rgb, surface, turned, place.xyz, frame.eye.xyz);
    complete(place.xyz - frame.eye.xyz, out_left, out_before);
#else
    out_normal = cofactors * normal;
    out_position = place.xyz;
#endif
#endif
#if HOST_TANGENTS
    out_tangent = vec4(linear * tangent.xyz, tangent.w);
#endif
#if HOST_INCIDENT
    out_incident_0 = incident_0;
    out_incident_1 = incident_1;
    out_incident_2 = incident_2;
    out_incident_3 = incident_3;
    out_incident_4 = incident_4;
    out_incident_5 = incident_5;
    out_incident_6 = incident_6;
    out_incident_7 = incident_7;
    out_incident_8 = incident_8;
#endif
    out_uv = vec2(dot(material.uv_linear.xy, uv), dot(material.uv_linear.zw, uv)) + material.uv_offset;
#if AIRGLOW_RELIGHT
    out_light = colour.rgb;
#else
    out_light = frame.ambient.rgb;
#endif
}

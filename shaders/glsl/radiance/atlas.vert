#version 460
#extension GL_GOOGLE_include_directive : require
// Triangles into an atlas of the faces of many cube maps, by one instanced draw: an instance is a face of a sample, whose
// viewport the vertex shader places and whose sides clip. Depth is the nearness along the face's normal.

#include "radiance/face.glsl"
#include "radiance/sample.glsl"

layout(std430, set = 0, binding = 0) readonly buffer Points { vec4 points[]; };
layout(std430, set = 0, binding = 1) readonly buffer Triangles { Triangle triangles[]; };

layout(push_constant) uniform Settings {
    uint columns; // faces in a row
    float side; // of a face over that of the atlas
    float nearest; // metres: what is nearer is clipped
} settings;

layout(location = 0) flat out float name;
out float gl_ClipDistance[4];

void main()
{
    uint face = uint(gl_InstanceIndex);
    uint triangle = uint(gl_VertexIndex) / 3u;
    vec3 point = points[face / 6u].xyz;
    vec3 corner = triangles[triangle].corners[uint(gl_VertexIndex) % 3u].xyz;
    vec3 seen = face_coordinates(face % 6u, corner - point);
    vec2 place = vec2(face % settings.columns, face / settings.columns);
    vec2 middle = settings.side * (2.0 * place + 1.0) - 1.0;
    gl_Position = vec4(settings.side * seen.xy + middle * seen.z, settings.nearest, seen.z);
    gl_ClipDistance[0] = seen.z - seen.x;
    gl_ClipDistance[1] = seen.z + seen.x;
    gl_ClipDistance[2] = seen.z - seen.y;
    gl_ClipDistance[3] = seen.z + seen.y;
    name = float(triangle + 1u);
}

#version 460
#extension GL_GOOGLE_include_directive : require
// Puts the vertices of a mesh into the pose of its joints: linear blend skinning (glTF 2.0, section 3.7.3.3), positions and
// normals in the world.

layout(local_size_x = 64) in;

layout(std430, set = 0, binding = 0) readonly buffer Positions {
    float values[];
} rest_positions;

layout(std430, set = 0, binding = 1) readonly buffer Normals {
    float values[];
} rest_normals;

// A vertex's four joints, two to a word.
layout(std430, set = 0, binding = 2) readonly buffer VertexJoints {
    uvec2 values[];
} vertex_joints;

layout(std430, set = 0, binding = 3) readonly buffer VertexWeights {
    vec4 values[];
} vertex_weights;

// Rows of world from mesh, three a joint: 256 joints.
layout(std140, set = 0, binding = 4) uniform Joints {
    vec4 rows[768];
} joints;

layout(std430, set = 0, binding = 5) buffer PosedPositions {
    float values[];
} posed_positions;

layout(std430, set = 0, binding = 6) buffer PosedNormals {
    float values[];
} posed_normals;

layout(push_constant) uniform Settings {
    uint vertices;
} settings;

void main()
{
    uint vertex = gl_GlobalInvocationID.x;
    if (vertex >= settings.vertices) { return; }
    uvec2 packed_joints = vertex_joints.values[vertex];
    vec4 weights = vertex_weights.values[vertex];
    vec4 rows[3] = vec4[3](vec4(0.0), vec4(0.0), vec4(0.0));
    for (uint i = 0u; i < 4u; ++i) {
        uint pair = i < 2u ? packed_joints.x : packed_joints.y;
        uint joint = min((i & 1u) == 0u ? pair & 0xffffu : pair >> 16u, 255u);
        for (uint row = 0u; row < 3u; ++row) { rows[row] += weights[i] * joints.rows[3u * joint + row]; }
    }
    uint at = 3u * vertex;
    vec4 place = vec4(rest_positions.values[at], rest_positions.values[at + 1u], rest_positions.values[at + 2u], 1.0);
    vec3 normal = vec3(rest_normals.values[at], rest_normals.values[at + 1u], rest_normals.values[at + 2u]);
    // The rows of the cofactors: what normals are turned by, there for flat matrices too; a mirroring keeps them outside.
    float side = dot(rows[0].xyz, cross(rows[1].xyz, rows[2].xyz)) < 0.0 ? -1.0 : 1.0;
    vec3 turned = side * vec3(
        dot(cross(rows[1].xyz, rows[2].xyz), normal),
        dot(cross(rows[2].xyz, rows[0].xyz), normal),
        dot(cross(rows[0].xyz, rows[1].xyz), normal));
    float size = length(turned);
    turned = size > 0.0 ? turned / size : vec3(0.0);
    for (uint axis = 0u; axis < 3u; ++axis) {
        posed_positions.values[at + axis] = dot(rows[axis], place);
        posed_normals.values[at + axis] = turned[axis];
    }
}

// Places a vertex and passes its colour on, to be interpolated.
#version 460
layout(location = 0) in vec3 position;
layout(location = 1) in vec4 colour;
layout(location = 0) out vec4 shaded;
layout(push_constant) uniform Settings { mat4 clip_from_object; } settings;

void main() {
    gl_Position = settings.clip_from_object * vec4(position, 1.0);
    shaded = colour;
}

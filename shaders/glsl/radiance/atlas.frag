#version 460
// The name of what is seen: exact up to 2^24.

layout(location = 0) flat in float name;
layout(location = 0) out float seen;

void main()
{
    seen = name;
}

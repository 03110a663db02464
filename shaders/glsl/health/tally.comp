#version 460
// Counts the records of a buffer that are not as they should be: a record an invocation, sums of integers.

layout(local_size_x = 64) in;

layout(std430, set = 0, binding = 0) readonly buffer Words {
    uint values[];
} words;

layout(std430, set = 0, binding = 1) buffer Counters {
    uint values[];
} counters;

layout(push_constant) uniform Records {
    uint count;
    uint stride;  // words from one record to the next
    uint first;   // the first word of a record that is looked at
    uint looked;  // how many are
    uint what;    // one of the constants below
    uint counter;
} records;

const uint NOT_FINITE = 0u;   // 1 for a record with an infinite or NaN float
const uint NOT_POSITIVE = 1u; // 1 for one with a float that is not above zero
                              // else: the words themselves, summed

// Bits, because comparisons with NaN may be optimised away.
const uint EXPONENT = 0x7f800000u;

void main()
{
    uint record = gl_GlobalInvocationID.x;
    if (record >= records.count) { return; }
    uint count = 0u;
    for (uint i = 0u; i < records.looked; ++i) {
        uint word = words.values[record * records.stride + records.first + i];
        if (records.what == NOT_FINITE) {
            count |= uint((word & EXPONENT) == EXPONENT);
        } else if (records.what == NOT_POSITIVE) {
            count |= uint(int(word) <= 0);
        } else {
            count += word;
        }
    }
    if (count != 0u) { atomicAdd(counters.values[records.counter], count); }
}

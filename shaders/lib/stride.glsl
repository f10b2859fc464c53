// Runs a function for every item of a list, a dispatch apart per thread. Tests at the end: a
// software device runs a loop's body once more with no active lane otherwise.
#define FW_STRIDE(number, function)                  \
    uint strideCount = number;                       \
    uint strideItem = gl_GlobalInvocationID.x;       \
    if (strideItem >= strideCount) return;           \
    do {                                             \
        function(strideItem);                        \
        strideItem += gl_NumWorkGroups.x * 64u;      \
    } while (strideItem < strideCount);

// The same for tiles of a list, eight per group: function(slot, row), one thread per row of eight
// texels.
#define FW_STRIDE_ROWS(number, function)                                                  \
    uint strideCount = number;                                                            \
    uint strideRow = gl_LocalInvocationID.x & 7u;                                         \
    uint strideSlot = gl_WorkGroupID.x * 8u + (gl_LocalInvocationID.x >> 3u);             \
    if (strideSlot >= strideCount) return;                                                \
    do {                                                                                  \
        function(strideSlot, strideRow);                                                  \
        strideSlot += gl_NumWorkGroups.x * 8u;                                            \
    } while (strideSlot < strideCount);

// Runs a function for every item of a list, a dispatch apart per thread. Tests at the end: a software device runs a
// loop's body once more with no active lane otherwise.
#define FW_STRIDE(number, function)                  \
    uint strideCount = number;                       \
    uint strideItem = gl_GlobalInvocationID.x;       \
    if (strideItem >= strideCount) return;           \
    do {                                             \
        function(strideItem);                        \
        strideItem += gl_NumWorkGroups.x * 64u;      \
    } while (strideItem < strideCount);

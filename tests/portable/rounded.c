/* Functions of floats for the host's own numbers. C libraries differ in the last bit of such a
 * result; rounding that of a double drops the difference. Hidden: the library calls the C library.
 * GCC calls sincosf, which C does not declare, where both results are used. */
#include <math.h>

void sincosf(float x, float* sine, float* cosine);

float atan2f(float y, float x) { return (float)atan2(y, x); }
float cosf(float x) { return (float)cos(x); }
float expf(float x) { return (float)exp(x); }
float hypotf(float x, float y) { return (float)hypot(x, y); }
float powf(float x, float y) { return (float)pow(x, y); }
float sinf(float x) { return (float)sin(x); }
void sincosf(float x, float* sine, float* cosine) {
    *sine = (float)sin(x);
    *cosine = (float)cos(x);
}

/* The smallest C host: asks the version, then makes and destroys a context without a device. */
#include <flamewright/flamewright.h>
#include <stdio.h>

int main(void) {
    const uint32_t version = fwGetVersion();
    const unsigned major = version >> 22, minor = (version >> 12) & 0x3ffu;
    if (major != FW_VERSION_MAJOR || minor != FW_VERSION_MINOR) {
        printf("library version %u.%u, header version %u.%u\n", major, minor, FW_VERSION_MAJOR,
               FW_VERSION_MINOR);
        return 1;
    }
    FwContextDef def = fwDefaultContextDef();
    def.backend = FW_BACKEND_CPU;
    FwContext* context = NULL;
    FwErrorInfo error = {0, {0}};
    if (fwCreateContext(&def, &context, &error) != FW_OK || context == NULL) {
        printf("fwCreateContext: %s\n", error.message);
        return 1;
    }
    fwDestroyContext(context);
    printf("flamewright %u.%u\n", major, minor);
    return 0;
}

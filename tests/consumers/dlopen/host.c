/* A host that loads the library at run time, by path, and links nothing of it. */
#include <dlfcn.h>
#include <flamewright/flamewright.h>
#include <stdio.h>
#include <string.h>

typedef uint32_t (*GetVersion)(void);
typedef void (*InitDef)(uint32_t, void*, uint32_t);
typedef FwResult (*CreateContext)(const FwContextDef*, FwContext**, FwErrorInfo*);
typedef void (*DestroyContext)(FwContext*);

/* ISO C has no cast from void* to a function pointer; the bytes are the same on every host here. */
static int load(void* library, const char* name, void* function, size_t size) {
    void* symbol = dlsym(library, name);
    if (symbol == NULL) {
        printf("dlsym %s: %s\n", name, dlerror());
        return 0;
    }
    memcpy(function, &symbol, size);
    return 1;
}

int main(int argc, char** argv) {
    if (argc != 2) {
        printf("usage: consumer LIBRARY\n");
        return 2;
    }
    void* library = dlopen(argv[1], RTLD_NOW | RTLD_LOCAL);
    if (library == NULL) {
        printf("dlopen: %s\n", dlerror());
        return 1;
    }
    GetVersion getVersion;
    InitDef initDef;
    CreateContext createContext;
    DestroyContext destroyContext;
    if (!load(library, "fwGetVersion", &getVersion, sizeof getVersion) ||
        !load(library, "fwInitDef", &initDef, sizeof initDef) ||
        !load(library, "fwCreateContext", &createContext, sizeof createContext) ||
        !load(library, "fwDestroyContext", &destroyContext, sizeof destroyContext)) {
        return 1;
    }
    FwContextDef def;
    initDef(FW_DEF_CONTEXT, &def, (uint32_t)sizeof def);
    def.abiVersion = FW_ABI_VERSION;
    def.backend = FW_BACKEND_CPU;
    FwContext* context = NULL;
    FwErrorInfo error = {0, {0}};
    if (createContext(&def, &context, &error) != FW_OK) {
        printf("fwCreateContext: %s\n", error.message);
        return 1;
    }
    destroyContext(context);
    printf("flamewright %u.%u\n", getVersion() >> 22, (getVersion() >> 12) & 0x3ffu);
    return dlclose(library) == 0 ? 0 : 1;
}

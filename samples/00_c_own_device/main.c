/* The smallest host, in C11: no Vulkan, no window. The library creates its own device. A plank
 * is built, lit at one end, burns in wind, and is rendered into PNG files. */
#include <flamewright/flamewright.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

/* A minimal PNG writer: chunks with checksums, rows stored without compression. */
static unsigned char* put32(unsigned char* at, uint32_t value) {
    for (int i = 0; i < 4; ++i) at[i] = (unsigned char)(value >> (24 - 8 * i));
    return at + 4;
}
static void writeChunk(FILE* file, const char* type, unsigned char* body, uint32_t size) {
    uint32_t crc = 0xffffffffu; /* body has 8 spare bytes before it and 4 after it */
    memcpy(put32(body - 8, size), type, 4);
    for (uint32_t i = 0; i < size + 4; ++i) {
        crc ^= body[(int64_t)i - 4];
        for (int bit = 0; bit < 8; ++bit) crc = crc & 1 ? crc >> 1 ^ 0xedb88320u : crc >> 1;
    }
    fwrite(body - 8, 1, (size_t)(put32(body + size, ~crc) - body) + 8, file);
}
static int writePng(const char* path, const unsigned char* rgba, uint32_t width, uint32_t height) {
    uint32_t a = 1, b = 0,
             row = width * 4 + 1; /* with its filter byte; one stored deflate block holds the row */
    unsigned char* memory = malloc((size_t)height * (row + 5) + 32);
    FILE* file = memory ? fopen(path, "wb") : NULL;
    if (!file) return free(memory), 0;
    unsigned char *body = memory + 8, *at = put32(put32(body, width), height);
    memcpy(at, "\x08\x06\0\0\0", 5); /* 8 bits, RGBA */
    fwrite("\x89PNG\r\n\x1a\n", 1, 8, file);
    writeChunk(file, "IHDR", body, 13);
    at = body + 2, body[0] = 0x78, body[1] = 1;
    for (uint32_t y = 0; y < height; ++y, at += row + 5) {
        const uint32_t size = row | ~row << 16;
        for (int i = 0; i < 4; ++i) at[1 + i] = (unsigned char)(size >> 8 * i);
        at[0] = y + 1 == height, at[5] = 0;
        memcpy(at + 6, rgba + (size_t)y * width * 4, width * 4);
        for (uint32_t i = 0; i < row; ++i) a = (a + at[5 + i]) % 65521, b = (b + a) % 65521;
    }
    at = put32(at, b << 16 | a);
    writeChunk(file, "IDAT", body, (uint32_t)(at - body));
    writeChunk(file, "IEND", body, 0);
    return free(memory), fclose(file) == 0;
}

static void require(FwResult result, FwWorld* world) {
    char why[512] = "";
    if (result == FW_OK) return;
    fwWorld_GetLastMessage(world, why, sizeof why);
    fprintf(stderr, "%s: %s\n", fwResultName(result), why);
    exit(1);
}

int main(int argc, char** argv) {
    const char* out = "out";
    unsigned frames = 4, width = 640, height = 360;
    for (int i = 1; i + 1 < argc; ++i) {
        if (!strcmp(argv[i], "--out")) out = argv[i + 1];
        if (!strcmp(argv[i], "--frames")) frames = (unsigned)strtoul(argv[i + 1], NULL, 10);
        if (!strcmp(argv[i], "--size")) sscanf(argv[i + 1], "%ux%u", &width, &height);
    }
    FwContext* context;
    FwWorld* world;
    FwErrorInfo error;
    const FwContextDef contextDef = fwDefaultContextDef();
    if (fwCreateContext(&contextDef, &context, &error)) return puts(error.message), 1;
    FwWorldDef worldDef = fwDefaultWorldDef();
    worldDef.paceFactor = 30.0f, worldDef.wind[0] = 1.5f;
    if (fwCreateWorld(context, &worldDef, &world)) return fwDestroyContext(context), 1;

    /* A plank of 1.2 x 0.3 x 0.05 m on its long edge: six faces of four corners. */
    const float half[3] = {0.6f, 0.15f, 0.025f};
    float positions[72];
    uint32_t indices[36];
    for (uint32_t v = 0; v < 24; ++v) {
        const uint32_t face = v / 4, x = face / 2, y = (x + 1) % 3, z = (x + 2) % 3;
        const float side = face & 1 ? 1.0f : -1.0f;
        positions[v * 3 + x] = side * half[x];
        positions[v * 3 + y] = ((v ^ v >> 1) & 1 ? side : -side) * half[y];
        positions[v * 3 + z] = (v & 2 ? 1.0f : -1.0f) * half[z];
    }
    for (uint32_t i = 0; i < 36; ++i) indices[i] = i / 6 * 4 + ("\0\1\2\0\2\3"[i % 6] & 3u);
    FwMeshDef meshDef = fwDefaultMeshDef();
    meshDef.positions = positions, meshDef.vertexCount = 24;
    meshDef.indices = indices, meshDef.indexCount = 36, meshDef.texelsPerMetre = 256.0f;
    FwBurnableMeshDef plank = fwDefaultBurnableMeshDef();
    require(fwWorld_CreateMesh(world, &meshDef, &plank.mesh), world);
    const FwMaterialDef pine = fwDefaultMaterialDef();
    require(fwWorld_CreateMaterial(world, &pine, &plank.materials[0]), world);
    FwBurnableMeshId id;
    require(fwWorld_CreateBurnableMesh(world, &plank, &id), world);
    FwIgnitionDef match = fwDefaultIgnitionDef();
    match.position[0] = -0.5f, match.position[1] = -0.12f, match.radius = 0.05f;
    require(fwWorld_Ignite(world, &match, NULL), world);
    FwOffscreenDef shot = fwDefaultOffscreenDef(); /* a camera 1.6 m away that looks along -z */
    const float zoom = 4.6f, near = 0.1f, far = 20.0f;
    shot.width = width, shot.height = height, shot.pixels = malloc((size_t)width * height * 4);
    for (int i = 0; i < 4; ++i) shot.view.view[i * 5] = 1.0f;
    shot.view.view[14] = -1.6f, shot.background[2] = 0.004f;
    shot.view.projection[0] = zoom * (float)height / (float)width, shot.view.projection[5] = -zoom;
    shot.view.projection[10] = far / (near - far), shot.view.projection[11] = -1.0f;
    shot.view.projection[14] = near * far / (near - far);
    char path[1024] = "";
    snprintf(path, sizeof path - 32, "%s/", out);
    for (char* c = path + 1; *c; ++c)
        if (*c == '/') *c = 0, mkdir(path, 0777), *c = '/';
    for (unsigned frame = 0; shot.pixels && frame < frames; ++frame) {
        for (int i = 0; i < 30; ++i) require(fwWorld_Step(world, 0.1f), world);
        shot.view.time = 3.0f * (float)(frame + 1);
        require(fwWorld_RenderOffscreen(world, &shot), world);
        snprintf(path, sizeof path, "%s/plank_%u.png", out, frame);
        const int written = writePng(path, shot.pixels, width, height);
        printf("%s%s\n", path, written ? "" : " cannot be written");
        if (!written) return 1;
    }
    free(shot.pixels);
    fwDestroyContext(context); /* destroys the world too */
    return 0;
}

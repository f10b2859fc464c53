// Procedural detail of the unburnt material, as a factor on its base colour: grain, paint, print,
// weave, veins, straw. Needs lib/appearance_noise.glsl. coarse, fine: samples of the front warp.

struct Base {
    vec3 factor;  // on the base colour, mean about 1
    float rough;
    float delay;   // [-1, 1]
    float cavity;  // 1 exposed
    float height;  // m, up
};

float plankOf(vec2 d, bool planks) { return planks ? floor(d.x / 0.15 + 64.0) : 3.0; }

// Each plank samples another part of the tree.
vec2 inTree(vec2 d, float plank) { return d + vec2(plank * 0.77, plank * 1.31); }

// grown: noise stretched along the grain, sampled at inTree.
void woodBase(vec2 d, float pixel, bool planks, vec4 grown, out Base b) {
    float plank = plankOf(d, planks);
    float across = fract(d.x / 0.15 + 64.0);
    vec2 q = inTree(d, plank);
    float ring = q.x + 0.020 * sin(q.y * 5.0 + plank * 3.0) + 0.05 * (grown.r - 0.5);
    float sharp = saturate(1.2 - pixel / 0.012);
    float wave = 0.5 + 0.5 * sin(ring * 502.65);
    float g = wave * wave * sharp + 0.35 * (1.0 - sharp);
    float fibre =
        textureLod(appearanceTextures, vec3(q.x * 24.0, q.y * 1.1, kLayerNoise),
                   noiseLod(pixel, 24.0)).b;
    int id = int(plank);
    b.factor = mix(vec3(1.085, 1.118, 1.146), vec3(0.698, 0.590, 0.478), g * 0.75) *
               ((0.82 + 0.36 * fibre) * (0.85 + 0.3 * hash(id, 3, 5)));
    b.height = -0.0003 * (g + fibre);
    b.cavity = 0.6 + 0.4 * fibre;
    b.delay = -(g - 0.5) * 1.4 + (hash(id, 7, 5) - 0.5) * 2.0;
    b.rough = 0.62;
    if (planks) {
        float gap = min(across, 1.0 - across) * 0.15;
        float dark =
            (1.0 - smoothstep(0.0012, 0.0016 + pixel, gap)) * min(1.0, 0.0028 / (0.0028 + pixel));
        b.factor *= 1.0 - 0.85 * dark;
        b.height -= 0.003 * dark;
        b.cavity *= 1.0 - 0.8 * dark;
    }
}

void paintBase(vec3 color, vec4 coarse, inout Base b) {  // over woodBase
    float fibre = (b.cavity - 0.6) * 2.5;
    float worn = smoothstep(0.66, 0.70, coarse.r * 0.75 + fibre * 0.2);
    // Worn paint shows wood in its own colour.
    vec3 wood = vec3(0.41, 0.26, 0.125) * b.factor / max(color, vec3(0.02));
    b.factor = mix(vec3(0.92 + 0.16 * coarse.r) * (b.cavity < 0.5 ? 0.4 : 1.0), wood, worn);
    b.rough = mix(0.28, 0.7, worn);
    b.height = -0.0003 * worn + min(b.height + 0.0006, 0.0);
    b.delay *= 0.5;
}

void paperBase(vec2 d, float pixel, bool print, vec4 coarse, vec4 fine, out Base b) {
    b.factor = vec3((0.96 + 0.08 * fine.b) * (0.97 + 0.06 * coarse.r));
    b.rough = 0.85;
    b.delay = (fine.b - 0.5) * 1.2;
    b.cavity = 1.0;
    b.height = 0.0;
    if (print) {
        int column = int(floor(d.x / 0.062)), line = int(floor(d.y / 0.0042));
        float x = fract(d.x / 0.062), y = fract(d.y / 0.0042);
        bool title = hash(column, line / 9, 3) < 0.16;
        if (title) {
            line /= 3;
            y = fract(d.y / 0.0126);
        }
        float letter = d.x / (title ? 0.0030 : 0.0011);
        float word = hash(int(floor(letter * 0.30 + 5.0 * hash(line, 1, 2))), line, 3);
        float ink = x > 0.06 && x < 0.94 && y > 0.28 && y < 0.70 && word > 0.16 ? 1.0 : 0.0;
        ink *= 0.55 + 0.45 * hash(int(floor(letter)), line, 9);
        float blurred = saturate(pixel / (title ? 0.008 : 0.0028) - 0.3);
        b.factor *= 1.0 - 0.72 * mix(ink, 0.30, blurred);
    }
}

void weaveBase(vec2 d, float pixel, vec4 coarse, out Base b) {
    const float kThread = 0.0022;
    float u = d.x / kThread, v = d.y / kThread;
    int warp = int(floor(u + 0.5)), weft = int(floor(v + 0.5));
    float over = 0.5 + 0.5 * cos((((warp + weft) & 1) != 0 ? u : v) * 6.2832);
    float sharp = saturate(1.3 - pixel / (0.6 * kThread));
    over = mix(0.6, over, sharp);
    b.factor = vec3((0.68 + 0.54 * over) * (0.9 + 0.2 * coarse.r));
    b.height = 0.0004 * over * sharp;
    b.rough = 0.92;
    b.cavity = 0.25 + 0.75 * over;
    b.delay = ((hash(warp, 0, 11) - 0.5) + (hash(0, weft, 12) - 0.5)) * 1.2 * sharp;
}

void leafBase(vec2 d, float pixel, vec4 coarse, out Base b) {
    // Blades of about 9 by 16 cm, staggered, with a midrib and herringbone veins.
    vec2 cell = d / vec2(0.09, 0.16) + 64.0;
    cell.y += 0.5 * float(int(floor(cell.x)) & 1);
    vec2 id = floor(cell), q = (fract(cell) - 0.5) * vec2(0.09, 0.16);
    float random = hash(int(id.x), int(id.y), 17);
    float side = abs(q.x);
    float spacing = 0.012;
    float off = abs(fract((q.y - side * 0.8) / spacing + 0.5) - 0.5) * spacing;
    float midrib = 1.0 - smoothstep(0.0008, 0.0020 + pixel, side);
    float vein = 0.8 * (1.0 - smoothstep(0.0004, 0.0010 + pixel, off));
    float crack = appearanceLayer(d * 14.0, kLayerChar, noiseLod(pixel, 14.0)).g;
    float net = 0.4 * (1.0 - smoothstep(0.02, 0.09 + pixel * 40.0, crack));
    vein = max(max(midrib, vein), net) * saturate(1.4 - pixel / 0.006);
    b.factor = vec3(mix(0.88, 1.35, vein) * (0.65 + 0.7 * coarse.r) * (0.8 + 0.4 * random));
    b.rough = 0.6;
    b.delay = vein * 1.6 - 0.6;
    b.cavity = 0.55 + 0.45 * vein;
    b.height = 0.0005 * vein;
}

void strawBase(vec2 d, float pixel, out Base b) {
    float best = -1.0;
    b.factor = vec3(0.10, 0.095, 0.09);
    b.delay = 0.0;
    float bend = 0.008 * (noiseAt(vec2(d.y * 0.5, d.x * 0.2), 3.0, pixel).r - 0.5);
    for (int layer = 0; layer < 3; ++layer) {
        float angle = (hash(layer, 0, 3) - 0.5) * 0.5;
        float cosine = cos(angle), sine = sin(angle);
        vec2 q = vec2(d.x * cosine + d.y * sine, -d.x * sine + d.y * cosine);
        float row = floor(q.y / 0.18 + 0.37 * float(layer));
        float u = (q.x + hash(int(row), layer, 4) * 0.004 + bend) / 0.0052;
        int id = int(floor(u));
        float within = u - float(id), random = hash(id, int(row), 10 + layer);
        float round_ = 1.0 - (2.0 * within - 1.0) * (2.0 * within - 1.0) / (0.5 + 0.5 * random);
        float z = round_ * 0.0025 + hash(id, int(row), 20 + layer) * 0.006;
        if (random < 0.2 || round_ <= 0.0 || z <= best) continue;
        best = z;
        b.delay = (hash(id, int(row), 30 + layer) - 0.5) * 2.0;
        float dark = hash(id, int(row), 40 + layer);
        b.factor = mix(vec3(1.33, 1.37, 1.30), vec3(0.83, 0.78, 0.76), dark) *
                   ((0.45 + 0.6 * round_) * (0.55 + 0.5 * z / 0.008));
    }
    float sharp = saturate(1.5 - pixel / 0.004);
    b.factor = mix(vec3(0.74), b.factor, sharp);
    b.delay *= mix(0.5, 1.0, sharp);
    b.cavity = mix(0.6, best < 0.0 ? 0.0 : 0.95 * saturate(best / 0.0075), sharp);
    b.height = best * 0.7 * sharp;
    b.rough = 0.65;
}

Base freshBase(uint kind, vec2 d, float pixel, bool planks, vec3 color, vec4 coarse, vec4 fine,
               vec4 grown) {
    Base b;
    b.factor = vec3(0.94 + 0.12 * coarse.r);
    b.rough = 0.7;
    b.delay = 0.0;
    b.cavity = 1.0;
    b.height = 0.0;
    if (kHasWood && (kind == kBaseWood || kind == kBasePaint)) woodBase(d, pixel, planks, grown, b);
    if (kHasPaint && kind == kBasePaint) paintBase(color, coarse, b);
    if (kHasSheet && (kind == kBasePaper || kind == kBasePrint))
        paperBase(d, pixel, kind == kBasePrint, coarse, fine, b);
    if (kHasSheet && kind == kBaseWeave) weaveBase(d, pixel, coarse, b);
    if (kHasPlant && kind == kBaseLeaf) leafBase(d, pixel, coarse, b);
    if (kHasPlant && kind == kBaseStraw) strawBase(d, pixel, b);
    if (kHasHide && kind == kBaseLeather) {
        float pore =
            smoothstep(0.02, 0.12, appearanceLayer(d / 0.022, kLayerChar, noiseLod(pixel, 45.0)).g);
        b.factor = vec3((0.75 + 0.5 * coarse.r) * (0.7 + 0.3 * pore));
        b.rough = 0.60 - 0.15 * pore;
        b.height = -0.0003 * (1.0 - pore);
    }
    if (kHasHide && kind == kBasePlastic) {
        b.factor = vec3(0.97 + 0.06 * coarse.r);
        b.rough = 0.28;
    }
    if (kind == kBaseStone) {
        b.factor = vec3((0.75 + 0.5 * coarse.r) * (0.85 + 0.3 * fine.r));
        b.cavity = 0.5 + 0.5 * fine.g;
        b.rough = 0.9;
    }
    return b;
}

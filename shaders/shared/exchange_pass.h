// Bodies of the exchange's passes, for GLSL and for the cpu backend. The backend includes them in a
// class whose members have the names of the buffers and of the accessors below.
// GLSL too, and laid out by hand.
// clang-format off
#ifndef __cplusplus
#define stateOf(object, texel) state[objects[object].stateBase + (texel)]
#define heatOf(object, texel) heat[objects[object].heatBase + (texel)]
#define positionOf(object, texel) decodePosition(texels[objects[object].texelBase + (texel)])
#define materialOf(object, texel) materials[materialOfTexel(object, texel)]
#define holeTicksOf(object, kind) materials[(object) * kMaterialsPerObject + (kind)].holeTicks
#define hasHeat(object) ((objects[object].flags & kObjectHeat) != 0u)
#define neighbourOf(object, n) neighbours[exchangeObjects[object].neighbourFirst + (n)]
#define sourceCountOf(object) exchangeObjects[object].sourceCount
#define sourceOf(object, cell) sources[exchangeObjects[object].sourceBase + (cell)]
#define exchangeTileOf(object, local) exchangeTiles[objects[object].tileBase + (local)]
#define firstSourceOf(object) exchangeObjects[object].sourceBase
#define sourceAt(object, i) sources[i]
#define burningTilesOfWorld() counters[kRowBurn + push.burnParity].runCount
#define receiverCountOf(object) receivers[(object) * kReceiverWords + 1u]
#define receiverEntryOf(object, i) receivers[(object) * kReceiverWords + 2u + (i)]
#define receiverSourceOf(entry, i) sources[(entry) & 0xFFFFFFu]
#endif

#ifdef FW_PASS_FIRE_CELLS
// Adds a burning tile, of those found by `reduce`, to the fire source of its cell.
void sumTile(uint i) {
    uint object = burnTiles[i].object;
    if ((exchangeObjects[object].flags & kExchangeLive) == 0u) return;
    uint flaming = burnTiles[i].texels;
    FW_IN(ExchangeTile) tile = exchangeTileOf(object, burnTiles[i].tile);
    uint material = tileMaterial(tile), cell = tileCluster(tile);
    uint power = material < 4u ? exchangeObjects[object].power0[material & 3u]
                               : exchangeObjects[object].power1[material & 3u];
    ivec3 middle = tileMiddle(tile);
    atomicAdd(sourceOf(object, cell).power, flaming * power);
    atomicAdd(sourceOf(object, cell).texels, flaming);
    atomicAdd(sourceOf(object, cell).tiles, 1u);
    atomicAdd(sourceOf(object, cell).sumX, uint(middle.x) >> 2u);
    atomicAdd(sourceOf(object, cell).sumY, uint(middle.y) >> 2u);
    atomicAdd(sourceOf(object, cell).sumZ, uint(middle.z) >> 2u);
}
#endif

#ifdef FW_PASS_FIRE_SOURCES
void settleSources(uint slot, uint hops, bool gives, uint strength) {
    FW_IN(ExchangeObject) o = exchangeObjects[slot];
    for (uint cell = 0u; cell < sourceCountOf(slot); ++cell) {
        if (!gives) {
            sourceOf(slot, cell).watts = 0u;
            continue;
        }
        FireSource source = sourceOf(slot, cell);
        source.power = mulShift(source.power, strength, 8u);
        settleSource(source, o);
        source.object = slot;
        source.hops = hops;
        source.ember = 0u;
        if ((push.flags & kExchangeEmbers) != 0u && source.watts != 0u)
            source.ember = emberOf(push.seed, slot, cell, push.now, source.power, push.brands);
        sourceOf(slot, cell) = source;
    }
}

// Settles an object: its igniter, its hold and its sources; wakes the objects that it may heat.
void settleObject(uint slot) {
    if ((exchangeObjects[slot].flags & kExchangeLive) == 0u) return;
    ObjectCounters c = objectCounters[slot];
    recordFire(c, exchangeObjects[slot], push);
    objectCounters[slot].litBy = c.litBy;
    objectCounters[slot].litTick = c.litTick;
    objectCounters[slot].stopTick = c.stopTick;
    objectCounters[slot].spotTexel = c.spotTexel;
    objectCounters[slot].held = heldBits(burningTilesOfWorld(), push.maxTiles, c.burningTiles,
                                         exchangeObjects[slot].maxTiles, c.stopTick, push.now);
    for (bool once = c.burning != 0u; once; once = false) {
        uint hops = hopsOf(c.litBy);
        bool gives = mayTransfer(exchangeObjects[slot], hops, push.hopsMost);
        settleSources(slot, hops, gives, airStrength(c.air));
        bool heats = gives && (push.flags & (kExchangeRadiation | kExchangePlume)) != 0u;
        uint count = heats ? exchangeObjects[slot].neighbourCount : 0u;
        for (uint n = 0u; n < count; ++n)
            atomicMax(objectCounters[neighbourOf(slot, n) & 0xFFFFFFu].until,
                      push.now + kExchangeRounds * kExchangeTicks);
    }
}
#endif

#ifdef FW_PASS_OCCLUSION
// Does the texel that fills an occlusion cell still stand?
bool isOccluderStanding(uint what, uint texel) {
    bool stands = (what & kOcclusionPermanent) != 0u;
    for (bool unknown = !stands; unknown; unknown = false) {
        uint slot = what & kOcclusionSlotMask;
        uint holes = holeTicksOf(slot, (what >> 24u) & 7u);
        uint t = stateOf(slot, texel);
        bool gone = isSource(t) && t <= push.now && push.now - t >= holes;
        if (gone && hasHeat(slot))
            gone = gateOpens(kEventGate, holes, unpackHeat(heatOf(slot, texel)), t, push.now);
        stands = !gone;
    }
    return stands;
}

// Two loops: a software device executes a branch's body for all lanes of its group, so the
// expensive test of a solid cell stays out of the walk over empty ones.
bool isOccluded(FW_IN(OcclusionEnds) ends, ivec3 a, ivec3 b) {
    OcclusionWalk w = beginOcclusionWalk(push, a, b);
    uint words = occlusionWords(push.occlusionCounts);
    bool cut = false;
    while (w.within && !cut) {
        uint what = 0u, texel = 0u;
        bool stops = false;  // in a solid cell
        while (w.within && !stops) {
            uint at = w.cell >> 5u, bit = 1u << (w.cell & 31u);
            for (bool solid = (occlusion[at] & bit) != 0u; solid; solid = false) {
                uint baked = occlusion[words + 2u * at];
                what = kOcclusionPermanent | kOcclusionSlotMask;
                if ((baked & bit) != 0u) {
                    uint i = occlusion[words + 2u * at + 1u] + uint(bitCount(baked & (bit - 1u)));
                    what = occlusion[3u * words + 2u * i];
                    texel = occlusion[3u * words + 2u * i + 1u];
                }
                uint slot = what & kOcclusionSlotMask;
                stops = !isNearWalkEnd(w, ends, slot == kOcclusionSlotMask ? kNoneTexel : slot,
                                       push.occlusionCell);
            }
            stepOcclusionWalk(w, push.occlusionCell);
        }
        for (; stops; stops = false) cut = isOccluderStanding(what, texel);
    }
    return cut;
}
#endif

#ifdef FW_PASS_EXCHANGE
bool isFlameBlocked(FW_IN(FireSource) source, ivec3 up, uint slot, ivec3 at, ivec3 normal) {
    ivec3 flame = alongFlame(source, up, 4);
    for (uint b = 0u; b < push.occluders; ++b)
        if (occluderBlocks(occluders[b], flame, at)) return true;
#ifdef FW_PASS_OCCLUSION
    return push.occlusionCell != 0u &&
           isOccluded(flameOcclusionEnds(source, flame, slot, at, normal, push.occlusionCell),
                      flame, at);
#else
    return false;
#endif
}

// Heat from the sources of a receiver to one of its tiles.
void warmTile(uint slot, uint local) {
    FW_IN(ExchangeTile) tile = exchangeTileOf(slot, local);
    if (tile.texels == 0u) return;
    uint worldTile = objects[slot].worldTileBase + local;
    ivec3 up = ivec3(push.upX, push.upY, push.upZ);
    ivec3 at = toWorldMm(exchangeObjects[slot], tileMiddle(tile));
    ivec3 normal = turnToWorld(exchangeObjects[slot], decodeNormal(tile.normal));
    bool both = (exchangeObjects[slot].flags & kExchangeTwoSided) != 0u;
    uint count = receiverCountOf(slot);
    if (!mayCatch(objectCounters[slot].held, tileState[worldTile].flag)) count = 0u;
    uint flux = 0u, pilot = 0u, strongest = 0u, by = 0u;
    for (uint i = 0u; i < count; ++i) {
        uint entry = receiverEntryOf(slot, i);
        FW_IN(FireSource) source = receiverSourceOf(entry, i);
        Received r = receivedFrom(source, push.flags, push.ambient, up, at, normal, both,
                                  entry >> 24u);
        if ((r.flux | r.pilot) == 0u || isFlameBlocked(source, up, slot, at, normal)) continue;
        flux = min(flux + r.flux, kMaxFlux);
        pilot |= r.pilot;
        uint key = litBy(source.hops, source.object);
        if (r.flux > strongest || (r.flux == strongest && key > by)) {
            strongest = r.flux;
            by = key;
        }
    }
    if (workOfFlux(flux) == kWorkAlways) atomicMin(objectCounters[slot].playsUntil, push.now);
    if (flux != 0u && objectCounters[slot].litTick == 0u) atomicMax(objectCounters[slot].litBy, by);
    if (tileHeat[worldTile].flux == flux && tileHeat[worldTile].pilot == pilot) return;
    tileHeat[worldTile].flux = flux;
    tileHeat[worldTile].pilot = pilot;
    hotList(push.hotParity, worldTile, workOfFlux(flux) == kWorkAlways ? kTileWarm : 0u);
}
#endif

#ifdef FW_PASS_GIVES
// Does the fire of object `from` reach other objects, and object `to` among them?
bool gives(uint from, uint to) {
    return (exchangeObjects[from].flags & kExchangeLive) != 0u &&
           objectCounters[from].burning != 0u &&
           mayTransfer(exchangeObjects[from], hopsOf(objectCounters[from].litBy), push.hopsMost) &&
           mayReach(push.seed, from, to, objectCounters[from].litTick,
                    multiplyChances(push.chance, exchangeObjects[from].chance));
}
#endif

#ifdef FW_PASS_RECEIVERS
// Runs a statement for each source that may act on `slot`: number `source` of the object `from`,
// with a neighbour's `entry` and a `weight`.
#define FW_EACH_SOURCE(statement)                                                   \
    for (uint n = 0u; n < exchangeObjects[slot].neighbourCount; ++n) {              \
        uint entry = neighbourOf(slot, n), from = entry & 0xFFFFFFu;                \
        if (entry >> 24u == 0u || !gives(from, slot)) continue;                     \
        uint source = firstSourceOf(from);                                          \
        for (uint end = source + sourceCountOf(from); source < end; ++source) {     \
            uint weight = sourceWeight(sourceAt(from, source), middle);             \
            if (weight == 0u) continue;                                             \
            statement                                                               \
        }                                                                           \
    }

// Lists the strongest sources that act on an object, found by halving. Returns their number.
uint gatherSources(uint slot) {
    ivec3 middle = boxMiddle(exchangeObjects[slot]);
    uint strong = 0u, least = 0u;
    uint weightBits[32];  // sources by the highest bit of their weight
    FW_UNROLL for (int bit = 0; bit < 32; ++bit) weightBits[bit] = 0u;
    FW_EACH_SOURCE(weightBits[findMSB(weight)] += 1u; ++strong;)
    // Least power of two above which few enough sources lie.
    while (strong > kSourcesPerReceiver) {
        strong -= weightBits[least];
        ++least;
    }
    // First sources above it, then sources of at least half of it, up to the capacity.
    uint low = 1u << least, listed = 0u, weak = strong;
    FW_EACH_SOURCE(if (weight >= low / 2u)
                       listSource(slot, weight >= low ? listed++ : weak++, from, source, entry);)
    return min(weak, kSourcesPerReceiver);
}
#endif

#ifdef FW_PASS_LIGHT
// Lights a texel by another object. True: it caught at this tick, by this flame or also by another
// one. Each counts, so the order of threads does not matter: all ignitions of a texel in one
// dispatch have the same tick.
bool lightTexel(uint object, uint texel, uint tick, uint by) {
    uint before = stateOf(object, texel);
    bool shares = before == tick;
    if (!shares && !isReceptive(before)) return false;
    TexelPlace p = placeOfTexel(object, texel);
    if (!mayCatch(objectCounters[object].held, tileState[p.worldTile].flag)) return false;
    if (isRequestPass() && !mayBurn(p.worldTile)) requestToBurn(p.worldTile);
    if (isRequestPass() || !mayBurn(p.worldTile)) return false;
    if (!shares) shares = atomicCompSwap(stateOf(object, texel), before, tick) != before;
    litFrom(object, by);
    if (shares) return true;
    atomicAdd(objectCounters[object].ignited, 1u);
    nowBurns(object, p.worldTile, push.now);
    if (hasHeat(object)) hotTouch(push.hotParity, p.worldTile);
    atomicMin(objectCounters[object].playsUntil, push.now);
    texelChanged(object, texel, p, true);
    return true;
}
#endif

#ifdef FW_PASS_CONTACTS
// Tick at which a link's source lights its target, or kNever.
uint linkTick(uint i, FW_OUT(uint) by) {
    uint from = contacts[i].fromObject;
    by = 0u;
    if (!gives(from, contacts[i].object)) return kNever;
    uint texel = contacts[i].fromTexel;
    uint tick = contactTick(stateOf(from, texel), materialOf(from, texel).flameTicks,
                            contacts[i].delay, contacts[i].since, push.now);
    if (tick != kNever) by = litBy(hopsOf(objectCounters[from].litBy), from);
    return tick;
}

// A texel's run of links, if link `first` begins one.
void lightContact(uint first) {
    uint object = contacts[first].object;
    uint texel = contacts[first].texel;
    if (object == kNoneTexel) return;  // padding between two objects' links
    if (first > 0u && contacts[first - 1u].object == object && contacts[first - 1u].texel == texel)
        return;
    if ((exchangeObjects[object].flags & kExchangeLive) == 0u) return;
    uint best = kNever, by = 0u, i = first;
    do {
        uint key;
        uint tick = linkTick(i, key);
        if (tick < best || (tick == best && key > by)) by = key;
        best = min(best, tick);
        ++i;
    } while (i < push.count && contacts[i].object == object && contacts[i].texel == texel);
    if (best != kNever) lightTexel(object, texel, best, by);
}
#endif

#ifdef FW_PASS_PARTS
// Fire of a burning tile, of those found by `reduce`, over gaps to other parts of its mesh. All
// ignitions have the exchange's tick, so order does not matter.
void lightParts(uint i) {
    uint object = burnTiles[i].object, tile = burnTiles[i].tile;
    if ((exchangeObjects[object].flags & kExchangeLive) == 0u) return;
    uvec4 links = exchangeTileOf(object, tile).parts;
    for (uint block = 0u; block < 4u; ++block) {
        if (links[block] == kNoneTexel) continue;
        uint from = texelOf(object, tile, partFrom(links[block], block));
        uint to = links[block] % kPartTexels;
        FW_IN(BurnMaterial) other = materialOf(object, to);
        uint delay = partDelay(other, positionOf(object, to) - positionOf(object, from));
        if ((other.flags & 1u) != 0u &&
            partCrossed(stateOf(object, from), materialOf(object, from).flameTicks, delay,
                        push.now))
            lightTexel(object, to, push.now, 0u);
    }
}
#endif

#ifdef FW_PASS_EMBERS
// Landing of embers. They are rare: each tests all objects, then the tiles of one.
ivec3 worldUp() { return ivec3(push.upX, push.upY, push.upZ); }

Ember emberFrom(FW_IN(FireSource) source) {
    ivec3 wind = ivec3(push.windX, push.windY, push.windZ) +
                 unpackWind(uint(exchangeObjects[source.object].high.w));
    return flyingEmber(source, source.ember, worldUp(), wind);
}

// Returns the object and sets its tile; kNoneTexel: none.
uint landsOn(ivec3 at, uint axis, FW_OUT(uint) tile) {
    uint object = kNoneTexel;
    tile = kNoneTexel;
    int top = kNoTop;
    for (uint slot = 0u; slot < push.count; ++slot) {
        if ((exchangeObjects[slot].flags & kExchangeLive) == 0u) continue;
        int here = topBelow(exchangeObjects[slot], at, axis);
        if (here > top) {
            top = here;
            object = slot;
        }
    }
    uint least = kMisses, count = 0u;
    for (bool found = object != kNoneTexel; found; found = false) count = objects[object].tileCount;
    for (uint i = 0u; i < count; ++i) {
        uint miss = landingMiss(exchangeObjects[object], exchangeTileOf(object, i), at, top, axis);
        if (miss < least) {
            least = miss;
            tile = i;
        }
    }
    return object;
}
bool sendsEmber(FW_IN(FireSource) source) { return source.ember != 0u && source.watts != 0u; }
#endif

#ifdef FW_PASS_EMBER_PATHS
// Whether an occluder box or the heat-occlusion grid crosses the path of a source's ember.
bool isEmberStopped(FW_IN(FireSource) source) {
    Ember ember = emberFrom(source);
    uint tile;
    uint object = landsOn(ember.landing, upAxis(worldUp()), tile);
    if (tile == kNoneTexel) return true;
    ivec3 flame = alongFlame(source, worldUp(), 8);
    ivec3 place = toWorldMm(exchangeObjects[object], tileMiddle(exchangeTileOf(object, tile)));
    for (uint b = 0u; b < push.occluders; ++b)
        if (occluderBlocks(occluders[b], flame, ember.landing) ||
            occluderBlocks(occluders[b], ember.landing, place))
            return true;
    if (push.occlusionCell == 0u) return false;
    OcclusionEnds ends = emberOcclusionEnds(source, object, push.occlusionCell);
    return isOccluded(ends, flame, ember.landing) || isOccluded(ends, ember.landing, place);
}
#endif

#ifdef FW_PASS_EMBER_LANDINGS
uint nearestLane(uint object, uint corner, ivec3 at, uint axis) {
    uint nearest = kNoneTexel, found = kNoneTexel;
    for (uint lane = 0u; lane < 64u; ++lane) {
        uint texel = corner + (lane >> 3u) * objects[object].width + (lane & 7u);
        if (stateOf(object, texel) == kInert) continue;
        uint beside = besidePlace(exchangeObjects[object], positionOf(object, texel), at, axis);
        if (beside < nearest) {
            nearest = beside;
            found = lane;
        }
    }
    return found;
}

// Lands a source's ember, which may light its target.
void landEmber(FW_IN(FireSource) source) {
    uint axis = upAxis(worldUp());
    Ember ember = emberFrom(source);
    uint tile;
    uint object = landsOn(ember.landing, axis, tile);
    if (tile == kNoneTexel) return;
    uint chance = multiplyChances(push.chance, exchangeObjects[source.object].chance);
    chance = multiplyChances(emberLights(ember.energy, exchangeObjects[object].catches), chance);
    if (!drawn(hash32(source.ember + 7u), chance)) return;
    uint corner = texelOf(object, tile, 0u);
    uint lane = nearestLane(object, corner, ember.landing, axis);
    if (lane == kNoneTexel) return;
    uint lit = 0u;
    for (uint other = 0u; other < 64u; ++other) {
        if (!besideLane(lane, other)) continue;
        uint texel = corner + (other >> 3u) * objects[object].width + (other & 7u);
        if (lightTexel(object, texel, push.now, litBy(source.hops, source.object))) {
            lit = 1u;
            atomicMax(objectCounters[object].spotTexel, kSpotFresh | texel);
        }
    }
    atomicAdd(objectCounters[object].spots, lit);
}
#endif

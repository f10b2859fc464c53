// The objects of a world, by FW_OBJECT_KIND and FwNameId.
// FW_KIND(KIND, Name, System, destroyFunction, destroy): fwWorld_destroyFunction calls
// System::destroy.
// FW_KIND_OF_DEF(KIND, Name, System, createFunction, create, destroyFunction, destroy): in addition
// fwWorld_createFunction makes the object of a FwNameDef by System::create alone.
#ifndef FW_KIND_OF_DEF
#define FW_KIND_OF_DEF(KIND, Name, System, createFunction, create, destroyFunction, destroy) \
    FW_KIND(KIND, Name, System, destroyFunction, destroy)
#endif
FW_KIND_OF_DEF(MATERIAL, Material, Scene, CreateMaterial, createMaterial, DestroyMaterial,
               destroyMaterial)
FW_KIND_OF_DEF(IMAGE, Image, Scene, CreateImage, createImage, DestroyImage, destroyImage)
FW_KIND(MESH, Mesh, Scene, DestroyMesh, destroyMesh)
FW_KIND(BURNABLE_MESH, BurnableMesh, World, DestroyBurnableMesh, destroyBurnableMesh)
FW_KIND_OF_DEF(HEAT_OCCLUDER, HeatOccluder, ExchangeSystem, AddHeatOccluder, addHeatOccluder,
               RemoveHeatOccluder, removeHeatOccluder)
FW_KIND_OF_DEF(VOLUMETRIC_FIRE, VolumetricFire, FlameSystem, CreateVolumetricFire, create,
               DestroyVolumetricFire, destroy)
FW_KIND_OF_DEF(FIRE_PROFILE, FireProfile, FlameSystem, CreateFireProfile, createProfile,
               DestroyFireProfile, destroyProfile)
FW_KIND(FIRE_COLLIDER, FireCollider, FlameSystem, RemoveFireCollider, removeCollider)
FW_KIND_OF_DEF(FIRE_EMITTER, FireEmitter, EmitterSystem, CreateFireEmitter, create,
               DestroyFireEmitter, destroy)
FW_KIND_OF_DEF(FLIPBOOK, Flipbook, FlameSystem, CreateFlipbook, createFlipbook, DestroyFlipbook,
               destroyFlipbook)
FW_KIND_OF_DEF(PARTICLE_FIELD, ParticleField, FieldSystem, CreateParticleField, create,
               DestroyParticleField, destroy)
FW_KIND_OF_DEF(WIND_ZONE, WindZone, WindSystem, CreateWindZone, createZone, DestroyWindZone,
               destroyZone)
FW_KIND_OF_DEF(ROOM, Room, RoomSystem, CreateRoom, create, DestroyRoom, destroy)
FW_KIND(BURN, Burn, BurnSystem, DestroyBurn, destroyBurn)
#undef FW_KIND_OF_DEF
#undef FW_KIND

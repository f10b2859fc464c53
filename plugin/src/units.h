// Conversion of lengths and speeds between a host's unit and metres. structs.inl lists the fields
// of the ABI's structs that are lengths or speeds; a struct without a row does not compile in the
// functions of a world.
#pragma once
#include "flamewright/flamewright.h"

#include <algorithm>
#include <cfloat>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <list>
#include <memory_resource>
#include <vector>

namespace fw::edge {

// A ratio, since 0.01f is not exactly a hundredth: 250 cm must be exactly 2.5 m.
struct Unit {
    double metres = 1, units = 1;  // this many metres are this many units

    static Unit of(float metersPerUnit) noexcept {
        const double per = 1 / double(metersPerUnit), whole = std::round(per);
        if (whole >= 1 && std::abs(per - whole) < 1e-6 * whole) return {1, whole};
        return {double(metersPerUnit), 1};
    }
    [[nodiscard]] bool isMetre() const noexcept { return metres == units; }
    bool operator==(const Unit&) const = default;
    [[nodiscard]] double perMetre() const noexcept { return units / metres; }
    [[nodiscard]] Unit inverse() const noexcept { return {units, metres}; }
    // This unit relative to the other one.
    [[nodiscard]] Unit in(const Unit& other) const noexcept {
        return {metres * other.units, units * other.metres};
    }
};

// Throws unless metersPerUnit is in range; 0: returns `otherwise`.
Unit checkedUnit(float metersPerUnit, const char* field, const Unit& otherwise);

// Converts lengths of the unit to metres.
class Scale {
 public:
    explicit Scale(const Unit& unit) noexcept : unit_(unit) {}

    template <class... Field>
    void operator()(Field&... fields) const noexcept {
        (scale(fields), ...);
    }
    // The translation of a matrix to world space.
    void transform(float (&matrix)[16]) const noexcept {
        for (int i = 12; i < 15; ++i) scale(matrix[i]);
    }
    // A camera: clip positions stay equal, except for a factor that keeps w the distance along the
    // axis.
    void view(float (&view)[16], float (&projection)[16]) const noexcept {
        transform(view);
        const bool perspective = projection[15] == 0;
        const Scale columns(perspective ? unit_ : unit_.inverse());
        for (int i = 0; i < 16; ++i)
            if ((i >= 12) == perspective) columns.scale(projection[i]);
    }

 private:
    void scale(float& value) const noexcept {
        if (std::abs(value) != FLT_MAX)  // means "none"
            value = float(double(value) * unit_.metres / unit_.units);
    }
    void scale(double& value) const noexcept { value = value * unit_.metres / unit_.units; }
    template <class T, size_t N>
    void scale(T (&values)[N]) const noexcept {
        for (T& value : values) scale(value);
    }

    Unit unit_;
};

// ---- structs of the ABI: structs.inl

template <class T>
struct StructOf;  // name; FwDefType, 0: no def; lengths
#define FW_STRUCT(T, number, ...)                                                                \
    template <>                                                                                  \
    struct StructOf<T> {                                                                         \
        static constexpr const char* kName = #T;                                                 \
        static constexpr uint32_t kType = number;                                                \
        static void visit([[maybe_unused]] T& s, [[maybe_unused]] const Scale& scale) noexcept { \
            __VA_ARGS__;                                                                         \
        }                                                                                        \
    };
#define FW_DEF FW_STRUCT
#define FW_INFO(T, ...) FW_STRUCT(T, 0, __VA_ARGS__)
#include "structs.inl"
#undef FW_INFO
#undef FW_DEF

template <class T>
void toMetres(const Unit& unit, T& given) noexcept {
    if (!unit.isMetre()) StructOf<T>::visit(given, Scale(unit));
}
template <class T>
void fromMetres(const Unit& unit, T& filled) noexcept {
    if (!unit.isMetre()) StructOf<T>::visit(filled, Scale(unit.inverse()));
}

// ---- function arguments besides structs

// Three numbers of the host in metres, for the duration of a call. Null stays null.
class Metres {
 public:
    Metres(const Unit& unit, const float* given) noexcept : there_(given != nullptr) {
        if (!given) return;
        std::memcpy(values_, given, sizeof values_);
        if (!unit.isMetre()) Scale{unit}(values_);
    }
    operator const float*() const noexcept { return there_ ? values_ : nullptr; }

 private:
    bool there_;
    float values_[3] = {};
};

template <class T>
void fromMetres3(const Unit& unit, T* filled) noexcept {
    const Scale host(unit.inverse());
    for (int i = 0; !unit.isMetre() && i < 3; ++i) host(filled[i]);
}

// Converts the axes of a matrix from an object space to a world space of another unit.
inline void scaleAxes(const Unit& object, const Unit& world, float (&matrix)[16]) noexcept {
    if (object == world) return;
    const Scale scale(world.in(object));
    for (int i = 0; i < 12; ++i)
        if (i % 4 != 3) scale(matrix[i]);
}

struct TransformInMetres {
    TransformInMetres(const Unit& object, const Unit& world, const float* given) noexcept {
        std::memcpy(matrix, given, sizeof matrix);
        if (!world.isMetre()) Scale(world).transform(matrix);
        scaleAxes(object, world, matrix);
    }
    float matrix[16];
};

// Arrays in metres, for the duration of a call.
class MetreArrays {
 public:
    MetreArrays(const Unit& unit, std::pmr::memory_resource* memory)
        : unit_(unit), copies_(memory) {}
    // More than `most` elements stay unconverted: the world refuses their number.
    template <class T>
    const T* operator()(const T* given, uint64_t count, uint64_t most) {
        static_assert(sizeof(T) % sizeof(float) == 0);
        if (!given || unit_.isMetre() || count == 0 || count > most) return given;
        std::pmr::vector<float>& copy = copies_.emplace_back();
        copy.resize(size_t(count) * (sizeof(T) / sizeof(float)));
        std::memcpy(copy.data(), given, copy.size() * sizeof(float));
        const Scale scale(unit_);
        for (float& value : copy) scale(value);
        return reinterpret_cast<const T*>(copy.data());
    }

 private:
    Unit unit_;
    std::pmr::list<std::pmr::vector<float>> copies_;
};

// Lengths behind the pointers of structs.
template <class Def>
void visitArrays(Def&, MetreArrays&) noexcept {}
inline void visitArrays(FwWindGridDef& def, MetreArrays& arrays) {
    const uint64_t points = uint64_t(def.counts[0]) * def.counts[1] * def.counts[2];
    const bool few = std::max({def.counts[0], def.counts[1], def.counts[2]}) <= 64;
    def.velocities = arrays(def.velocities, few ? 3 * points : UINT64_MAX, 3 * 32768);
}
inline void visitArrays(FwVolumetricFireDef& def, MetreArrays& arrays) {
    def.points = arrays(def.points, def.pointCount, 32);
}
inline void visitArrays(FwFireTrackDef& def, MetreArrays& arrays) {
    const bool few = def.keyCount <= 4096 && def.pointsPerKey <= 32;
    def.points = arrays(def.points, few ? def.keyCount * def.pointsPerKey : UINT64_MAX, 4096 * 32);
}
inline void visitArrays(FwFireColliderDef& def, MetreArrays& arrays) {
    if (def.kind != FW_COLLIDER_HEIGHT_FIELD) return;  // others do not read it
    const bool few = def.columns <= 4096 && def.rows <= 4096;
    def.heights = arrays(def.heights, few ? def.columns * def.rows : UINT64_MAX, 4096 * 4096);
}
// In the mesh's unit.
inline void visitArrays(FwMeshDef& def, MetreArrays& arrays) {
    constexpr uint64_t kMost = 16u << 20;  // vertices
    if (def.cooked) return;
    def.positions = arrays(def.positions, uint64_t(def.vertexCount) * 3, kMost * 3);
    def.details = arrays(def.details, uint64_t(def.vertexCount) * 2, kMost * 2);
}
inline void visitArrays(FwBurnableMeshDef& def, MetreArrays& arrays) {
    def.pins = arrays(def.pins, def.pinCount, 8);
}

}  // namespace fw::edge

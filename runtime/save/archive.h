// Archives visit the fields of state. A state struct has one `template <class A> void
// serialize(A& a)`. A Writer turns its fields into bytes, a Reader turns bytes into fields, a
// Hasher sums them, and a SnapshotChecker (world/save.cpp) refuses values out of range.
#pragma once
#include "core/hash.h"
#include "core/owned.h"
#include "core/stream.h"
#include "save/plane.h"

#include <array>
#include <concepts>
#include <cstring>

// A serialize() that visits these fields in order.
#define FW_SERIALIZE(...)  \
    template <class A>     \
    void serialize(A& a) { \
        a(__VA_ARGS__);    \
    }

namespace fw::save {

constexpr uint32_t magicWord(const char (&magic)[5]) noexcept {
    uint32_t word = 0;
    for (int i = 3; i >= 0; --i) word = word << 8 | uint32_t(uint8_t(magic[i]));
    return word;
}

template <class Derived>
class Archive {
 public:
    template <class... T>
    void operator()(T&... values) {
        (visit(values), ...);
    }
    // An id as its index: the loading world's generation may differ.
    template <class Id>
    void id(Id& id) {
        visit(id.index1);
    }
    // The id of a burnable mesh that the loading world must have, or null.
    template <class Id>
    void object(const char*, Id& value) {
        id(value);
    }
    // The same as a slot.
    template <std::integral T>
    void object(const char*, T& slot) {
        visit(slot);
    }
    // A burnable mesh, and a texel of it that a triangle covers.
    template <class Object>
    void texel(const char*, Object& object, uint32_t& texel) {
        if constexpr (std::integral<Object>)
            visit(object);
        else
            id(object);
        visit(texel);
    }
    // Checkers refuse other values, and those that are no number.
    template <class T>
    void range(const char*, const T&, double, double) {}
    // Readers and checkers refuse the state unless `good`.
    void require(bool, const char*) {}

 private:
    template <class T>
    void visit(T& value) {
        using Plain = std::remove_const_t<T>;
        if constexpr (std::is_arithmetic_v<Plain>)
            static_cast<Derived*>(this)->number(value);
        else if constexpr (requires { value.begin(); } || std::is_array_v<Plain>)
            for (auto& one : value) visit(one);
        else if constexpr (requires(Plain & plain, Derived & a) { plain.serialize(a); })
            const_cast<Plain&>(value).serialize(*static_cast<Derived*>(this));
        else
            words(value);
    }
    // A struct of 32-bit words alone, as shaders share them.
    template <class T>
    void words(T& value) {
        std::array<uint32_t, sizeof(T) / sizeof(uint32_t)> words;
        static_assert(sizeof words == sizeof(T) && std::is_trivially_copyable_v<T>);
        std::memcpy(words.data(), &value, sizeof words);
        visit(words);
        if constexpr (!std::is_const_v<T>)
            std::memcpy(static_cast<void*>(&value), words.data(), sizeof words);
    }
};

class Writer : public core::Writer, public Archive<Writer> {
 public:
    explicit Writer(std::pmr::vector<std::byte>& out)
        : core::Writer(out), values_(out.get_allocator()) {}
    template <class List>
    void list(const char*, const List& entries, size_t) {
        number(uint32_t(entries.size()));
        for (auto& entry : entries) (*this)(entry);
    }
    void blob(const char*, std::span<const std::byte> bytes) {
        number(uint32_t(bytes.size()));
        this->bytes().insert(this->bytes().end(), bytes.begin(), bytes.end());
    }
    template <class T>
    void optional(const core::Owned<T>& value) {
        number(bool(value));
        if (value) (*this)(*value);
    }
    // A plane of `count` whole numbers in rows of `width`: get(i), or on a reader set(i, value).
    template <class Get, class Set>
    void plane(const char*, size_t count, uint32_t width, PlaneMask mask, uint32_t, const Get& get,
               const Set&) {
        values_.resize(count);
        for (size_t i = 0; i < count; ++i) values_[i] = get(i);
        const size_t at = bytes().size();
        number(uint32_t(0));
        writePlane(values_, width, mask, bytes());
        numberAt(at, uint32_t(bytes().size() - at - sizeof(uint32_t)));
    }

 private:
    std::pmr::vector<uint32_t> values_;
};

class Hasher : public Archive<Hasher> {
 public:
    template <core::Number T>
    void number(const T& value) noexcept {
        const auto word = std::bit_cast<core::WordOf<T>>(value);
        const uint32_t words[] = {uint32_t(word), uint32_t(uint64_t(word) >> 32)};
        hash_ = core::hashWords(words, hash_);
    }
    [[nodiscard]] uint64_t hash() const noexcept { return hash_; }

 private:
    uint64_t hash_ = core::kFnvOffset;
};

class Reader : public core::Reader, public Archive<Reader> {
 public:
    Reader(std::span<const std::byte> bytes, const char* what, std::pmr::memory_resource* memory)
        : core::Reader(bytes, what), values_(memory) {}
    // Each entry has `least` bytes or more.
    template <class List>
    void list(const char* name, List& entries, size_t least) {
        const uint32_t entriesHere = count(name, least);
        entries.clear();
        entries.reserve(entriesHere);
        for (uint32_t i = 0; i < entriesHere; ++i) (*this)(entries.emplace_back());
    }
    void blob(const char* name, std::span<const std::byte>& bytes) { bytes = take(count(name, 1)); }
    template <class T>
    void optional(core::Owned<T>& value) {
        bool there = false;
        number(there);
        value = {};
        if (!there) return;
        std::pmr::memory_resource* memory = values_.get_allocator().resource();
        if constexpr (std::is_constructible_v<T, std::pmr::memory_resource*>)
            value = core::Owned<T>::make(memory, memory);
        else
            value = core::Owned<T>::make(memory);
        (*this)(*value);
    }
    template <class Get, class Set>
    void plane(const char* name, size_t cells, uint32_t width, PlaneMask mask, uint32_t most,
               const Get&, const Set& set) {
        const uint32_t size = count("bytes of a plane", 1);
        values_.assign(cells, 0);
        if (!readPlane(take(size), width, mask, values_))
            core::failData("The plane \"%s\" of the save is damaged.", name);
        for (size_t i = 0; i < cells; ++i) {
            if (values_[i] > most)
                core::failData("The plane \"%s\" of the save holds %u; the limit is %u.", name,
                               values_[i], most);
            set(i, values_[i]);
        }
    }
    void require(bool good, const char* name) {
        if (!good) core::failData("The %s's %s is out of its limits.", core::Reader::name(), name);
    }

 private:
    std::pmr::vector<uint32_t> values_;
};

// Reads the head of a file; throws if its name or version differs.
inline void readHead(core::Reader& reader, const char (&magic)[5], uint32_t version) {
    uint32_t word = 0, found = 0;
    reader.number(word);
    if (word != magicWord(magic))
        core::failData("The %s does not begin with \"%s\".", reader.name(), magic);
    reader.number(found);
    if (found != version)
        core::failData(
            "The %s has format version %u; this library reads version %u alone. Read it with "
            "the %s library that wrote it.",
            reader.name(), found, version, found < version ? "older" : "newer");
}
inline void writeHead(core::Writer& writer, const char (&magic)[5], uint32_t version) {
    writer.number(magicWord(magic));
    writer.number(version);
}

}  // namespace fw::save

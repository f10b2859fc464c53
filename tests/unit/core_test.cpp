// Core: handles, memory, errors, hashes.
#include "core/error.h"
#include "core/handle_pool.h"
#include "core/hash.h"
#include "core/log.h"
#include "core/memory.h"
#include "core/owned.h"
#include "core/slot_set.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <string>
#include <vector>

namespace {

using namespace fw::core;

struct TestId {
    uint32_t index1 = 0, generation = 0;
};

TEST(HandlePool, ReusesTheLowestSlotAndDistinguishesStaleFromWrong) {
    HandlePool<TestId, int> pool("Thing", std::pmr::new_delete_resource());
    TestId ids[5];
    for (int i = 0; i < 5; ++i) ids[i] = pool.create(i);
    EXPECT_EQ(5u, pool.live());
    pool.destroy(ids[3]);
    pool.destroy(ids[1]);
    EXPECT_EQ(nullptr, pool.find(ids[1]));
    EXPECT_EQ(nullptr, pool.find({0, 0}));
    EXPECT_EQ(nullptr, pool.find({99, 1}));
    const TestId again = pool.create(7);
    EXPECT_EQ(2u, again.index1);
    EXPECT_EQ(2u, again.generation);
    EXPECT_EQ(7, *pool.find(again));
    EXPECT_EQ(nullptr, pool.find(ids[1]));
    EXPECT_EQ(4u, pool.create(8).index1);
    EXPECT_EQ(6u, pool.create(9).index1);
    try {
        (void)pool.get(ids[1]);
        FAIL();
    } catch (const Error& error) {
        EXPECT_EQ(FW_ERROR_STALE_ID, error.result);
        EXPECT_STREQ("Thing 2 (generation 1) is already destroyed; the slot is at generation 2.",
                     error.message);
    }
    EXPECT_THROW(pool.destroy({50, 1}), Error);
    EXPECT_THROW(pool.destroy({0, 0}), Error);
}

// Refuses from the n-th request on.
class Miser : public std::pmr::memory_resource {
 public:
    int left = 1 << 30;
    int live = 0;

 private:
    void* do_allocate(size_t size, size_t alignment) override {
        if (left-- <= 0) throw std::bad_alloc();
        ++live;
        return std::pmr::new_delete_resource()->allocate(size, alignment);
    }
    void do_deallocate(void* memory, size_t size, size_t alignment) override {
        --live;
        std::pmr::new_delete_resource()->deallocate(memory, size, alignment);
    }
    bool do_is_equal(const memory_resource& other) const noexcept override {
        return this == &other;
    }
};

TEST(HandlePool, IsUnchangedByFailedAllocationsAndDestroysWithout) {
    for (int budget = 0; budget < 12; ++budget) {
        Miser miser;
        {
            HandlePool<TestId, int> pool("Thing", &miser);
            miser.left = budget;
            TestId ids[20];
            int made = 0;
            try {
                for (; made < 20; ++made) ids[made] = pool.create(made);
            } catch (const std::bad_alloc&) {
            }
            EXPECT_EQ(uint32_t(made), pool.live());
            miser.left = 0;
            for (int i = 0; i < made; ++i) {
                EXPECT_EQ(i, *pool.find(ids[i]));
                EXPECT_NO_THROW(pool.destroy(ids[i]));
            }
            for (int i = 0; i < made; ++i) EXPECT_NO_THROW((void)pool.create(i));
        }
        EXPECT_EQ(0, miser.live);
    }
}

TEST(Owned, OwnsOnceAndMoves) {
    Miser miser;
    {
        auto a = Owned<std::string>::make(&miser, "a text that is longer than a small string");
        EXPECT_EQ(1, miser.live);
        Owned<std::string> b = std::move(a);
        EXPECT_FALSE(a);
        EXPECT_EQ(41u, b->size());
        auto c = Owned<std::string>::make(&miser, "c");
        c = std::move(b);
        EXPECT_EQ(41u, c->size());
        c = Owned<std::string>();
        EXPECT_FALSE(c);
    }
    EXPECT_EQ(0, miser.live);
    miser.left = 0;
    EXPECT_THROW((void)Owned<int>::make(&miser, 1), std::bad_alloc);
}

TEST(SlotSet, WalksInOrderAndAllowsErasingTheCurrentSlot) {
    SlotSet set(std::pmr::new_delete_resource());
    const auto walked = [&] {
        std::vector<uint32_t> slots;
        for (const uint32_t slot : set) slots.push_back(slot);
        return slots;
    };
    EXPECT_TRUE(walked().empty());
    EXPECT_FALSE(set.contains(3));
    set.atLeast(1000);
    EXPECT_TRUE(walked().empty());
    for (const uint32_t slot : {999u, 0u, 63u, 64u, 640u, 64u}) set.insert(slot);
    EXPECT_EQ((std::vector<uint32_t>{0, 63, 64, 640, 999}), walked());
    set.atLeast(3);  // keeps its members
    EXPECT_TRUE(set.contains(999));
    EXPECT_FALSE(set.contains(998));
    EXPECT_FALSE(set.contains(100000));
    for (const uint32_t slot : set)
        if (slot != 64) set.erase(slot);
    EXPECT_EQ((std::vector<uint32_t>{64}), walked());
}

TEST(Memory, CountsAndReturnsAllocations) {
    struct Host {
        size_t size = 0, alignment = 0;
        bool refuse = false;
    } host;
    FwCallbacks callbacks{};
    callbacks.userData = &host;
    callbacks.allocate = [](void* user, size_t size, size_t alignment) -> void* {
        auto* h = static_cast<Host*>(user);
        h->size = size;
        h->alignment = alignment;
        return h->refuse ? nullptr : std::aligned_alloc(alignment, size);
    };
    callbacks.release = [](void* user, void* memory, size_t size, size_t alignment) {
        auto* h = static_cast<Host*>(user);
        EXPECT_EQ(h->size, size);
        EXPECT_EQ(h->alignment, alignment);
        std::free(memory);
    };
    Memory memory(callbacks);
    void* block = memory.allocate(128, 64);
    EXPECT_EQ(0u, reinterpret_cast<uintptr_t>(block) % 64);
    EXPECT_EQ(128u, memory.bytes());
    memory.deallocate(block, 128, 64);
    EXPECT_EQ(0u, memory.bytes());
    host.refuse = true;
    EXPECT_THROW((void)memory.allocate(16, 16), std::bad_alloc);
    EXPECT_EQ(0u, memory.bytes());
    Memory own{FwCallbacks{}};
    void* ours = own.allocate(100, 32);
    own.deallocate(ours, 100, 32);
    EXPECT_EQ(0u, own.bytes());
}

TEST(Error, TruncatesLongTexts) {
    const std::string longText(2000, 'x');
    try {
        fail(FW_ERROR_BAD_DATA, "%s", longText.c_str());
    } catch (const Error& error) {
        EXPECT_EQ(FW_ERROR_BAD_DATA, error.result);
        EXPECT_EQ(sizeof error.message - 1, std::string(error.message).size());
    }
}

TEST(Log, DoesNotFormatWithoutACallback) {
    const Log silent{FwCallbacks{}};
    silent.write(FW_LOG_ERROR, "%s", "nothing");
    std::string heard;
    FwCallbacks callbacks{};
    callbacks.userData = &heard;
    callbacks.log = [](void* user, int32_t level, const char* text) {
        *static_cast<std::string*>(user) = std::to_string(level) + text;
    };
    Log(callbacks).write(FW_LOG_WARNING, "%d of %s", 3, "them");
    EXPECT_EQ("23 of them", heard);
}

TEST(Hash, DependsOnWordOrder) {
    const uint32_t a[] = {1, 2, 3}, b[] = {3, 2, 1};
    EXPECT_NE(hashWords(a), hashWords(b));
    EXPECT_EQ(hashWords(a), hashWords(a));
    EXPECT_EQ(kFnvOffset, hashWords({}));
    EXPECT_NE(hash32(1), hash32(2));
}

}  // namespace

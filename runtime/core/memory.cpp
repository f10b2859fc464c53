#include "core/memory.h"

#include "core/assert.h"

#include <new>

namespace fw::core {

void* Memory::do_allocate(size_t size, size_t alignment) {
    void* memory = callbacks_.allocate
                       ? callbacks_.allocate(callbacks_.userData, size, alignment)
                       : ::operator new(size, std::align_val_t(alignment), std::nothrow);
    if (!memory) throw std::bad_alloc();
    bytes_.fetch_add(size, std::memory_order_relaxed);
    return memory;
}

void Memory::do_deallocate(void* memory, size_t size, size_t alignment) {
    FW_ASSERT(memory);
    bytes_.fetch_sub(size, std::memory_order_relaxed);
    if (callbacks_.release)
        callbacks_.release(callbacks_.userData, memory, size, alignment);
    else
        ::operator delete(memory, std::align_val_t(alignment));
}

}  // namespace fw::core

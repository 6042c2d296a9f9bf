// Memory for large arrays on huge pages of 2 MiB. For every lane, a simulation step accesses a few cache lines in each
// of about forty arrays. With the usual pages of 4 KiB, these cache lines lie on about forty pages per lane. With
// several thousand vehicles, there are more pages than the processor's address cache (TLB) can hold. Far fewer huge
// pages cover the same arrays.
#pragma once

#include <sys/mman.h>

#include <atomic>
#include <cstddef>
#include <cstdlib>
#include <cstring>
#include <new>
#include <vector>

namespace stopline {

template <class T>
struct HugePageAllocator {
    using value_type = T;

    static constexpr std::size_t kPageBytes = std::size_t{2} << 20U;
    static constexpr std::size_t kMinHugeBytes = kPageBytes / 4;  // a smaller array would waste most of a page

    HugePageAllocator() = default;
    template <class U>
    // NOLINTNEXTLINE(google-explicit-constructor): the standard requires this conversion of allocators
    HugePageAllocator(const HugePageAllocator<U>& /*other*/) {}

    T* allocate(std::size_t n) {
        const std::size_t bytes = n * sizeof(T);
        if (bytes < kMinHugeBytes) {
            return static_cast<T*>(throw_if_null(std::aligned_alloc(kLineBytes, rounded_up(bytes, kLineBytes))));
        }
        // Arrays that begin at the same offset within a page compete for the same cache lines, so consecutive arrays
        // get different offsets. The cache line before the array stores the address that free() needs.
        static std::atomic<std::size_t> arrays{0};
        const std::size_t offset = kLineBytes * (1 + 17 * (arrays++ % 60));
        const std::size_t memory_bytes = rounded_up(bytes + offset, kPageBytes);
        void* const memory = throw_if_null(std::aligned_alloc(kPageBytes, memory_bytes));
        // If the operating system refuses huge pages, the memory is slower but usable.
        static_cast<void>(madvise(memory, memory_bytes, MADV_HUGEPAGE));
        char* const array = static_cast<char*>(memory) + offset;
        std::memcpy(array - kLineBytes, &memory, sizeof memory);
        return reinterpret_cast<T*>(array);
    }
    void deallocate(T* array, std::size_t n) {
        void* memory = array;
        if (n * sizeof(T) >= kMinHugeBytes) {
            std::memcpy(&memory, reinterpret_cast<char*>(array) - kLineBytes, sizeof memory);
        }
        std::free(memory);
    }

    friend bool operator==(const HugePageAllocator& /*a*/, const HugePageAllocator& /*b*/) { return true; }

private:
    static constexpr std::size_t kLineBytes = 64;  // size of a cache line
    static std::size_t rounded_up(std::size_t bytes, std::size_t unit) { return (bytes + unit - 1) / unit * unit; }
    static void* throw_if_null(void* memory) {
        if (memory == nullptr) throw std::bad_alloc();
        return memory;
    }
};

template <class T>
using LargeArray = std::vector<T, HugePageAllocator<T>>;

}  // namespace stopline

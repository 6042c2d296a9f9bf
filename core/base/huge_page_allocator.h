// Memory for large arrays on huge pages. A step touches a few lines in each of some forty arrays for every lane; on pages of
// 4 KiB each of these is a page of its own, more than the processor's address cache holds from some thousand vehicles on.
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

    static constexpr std::size_t kPage = std::size_t{2} << 20U;
    static constexpr std::size_t kFrom = kPage / 4;  // smaller arrays would waste most of a page

    HugePageAllocator() = default;
    template <class U>
    // NOLINTNEXTLINE(google-explicit-constructor): allocators convert
    HugePageAllocator(const HugePageAllocator<U>& /*other*/) {}

    T* allocate(std::size_t n) {
        const std::size_t bytes = n * sizeof(T);
        if (bytes < kFrom) return static_cast<T*>(checked(std::aligned_alloc(kLine, rounded_up(bytes, kLine))));
        // Arrays that all begin at a page's start would compete for the same lines of the cache: each begins elsewhere. The
        // line before the array keeps what free() wants.
        static std::atomic<std::size_t> arrays{0};
        const std::size_t offset = kLine * (1 + 17 * (arrays++ % 60));
        const std::size_t whole_pages = rounded_up(bytes + offset, kPage);
        void* const memory = checked(std::aligned_alloc(kPage, whole_pages));
        // A refusal costs speed, nothing else.
        static_cast<void>(madvise(memory, whole_pages, MADV_HUGEPAGE));
        char* const array = static_cast<char*>(memory) + offset;
        std::memcpy(array - kLine, &memory, sizeof memory);
        return reinterpret_cast<T*>(array);
    }
    void deallocate(T* array, std::size_t n) {
        void* memory = array;
        if (n * sizeof(T) >= kFrom) std::memcpy(&memory, reinterpret_cast<char*>(array) - kLine, sizeof memory);
        std::free(memory);
    }

    friend bool operator==(const HugePageAllocator& /*a*/, const HugePageAllocator& /*b*/) { return true; }

private:
    static constexpr std::size_t kLine = 64;
    static std::size_t rounded_up(std::size_t bytes, std::size_t unit) { return (bytes + unit - 1) / unit * unit; }
    static void* checked(void* memory) {
        if (memory == nullptr) throw std::bad_alloc();
        return memory;
    }
};

template <class T>
using LargeArray = std::vector<T, HugePageAllocator<T>>;

}  // namespace stopline

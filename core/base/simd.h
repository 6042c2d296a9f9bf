// How a kernel is compiled for several instruction sets. A kernel is a loop over a span of vehicles whose body has no
// branches; the compiler vectorises it. STOPLINE_SIMD_CLONES before its definition builds it for the baseline, AVX2 and
// AVX-512 and picks one at load time. All give the same bits: there is no contraction to fused multiply-add and no
// reordering of sums (see the flags in the top CMakeLists.txt).
// Sanitizer builds define STOPLINE_NO_SIMD_CLONES: the selector would run before the sanitizer is ready.
#pragma once

#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__) && !defined(STOPLINE_NO_SIMD_CLONES)
#define STOPLINE_SIMD_CLONES __attribute__((target_clones("default", "arch=x86-64-v3", "arch=x86-64-v4")))
#else
#define STOPLINE_SIMD_CLONES
#endif

// Tells the compiler that the iterations of the next loop do not depend on each other through memory.
#if defined(__clang__)
#define STOPLINE_INDEPENDENT _Pragma("clang loop vectorize(assume_safety)")
#elif defined(__GNUC__)
#define STOPLINE_INDEPENDENT _Pragma("GCC ivdep")
#else
#define STOPLINE_INDEPENDENT
#endif

// Functions that kernels are made of: inlined into each clone, so that they get its instruction set.
#define STOPLINE_INLINE inline __attribute__((always_inline))

namespace stopline {

// Spans of vehicles are padded to a multiple of this, so that a kernel's loop has no remainder.
inline constexpr int kSimdWidth = 8;

}  // namespace stopline

// The kernels are compiled for several instruction sets. widest_of() returns the version with the widest vectors that
// the processor supports.
#pragma once

namespace stopline {

template <class Kernels>
const Kernels& widest_of(const Kernels& baseline, [[maybe_unused]] const Kernels& avx2,
                         [[maybe_unused]] const Kernels& avx512) {
#if defined(__x86_64__)
    if (__builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq") && __builtin_cpu_supports("avx512vl") &&
        __builtin_cpu_supports("avx512bw") && __builtin_cpu_supports("avx512cd")) {
        return avx512;
    }
    if (__builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma") && __builtin_cpu_supports("bmi2")) return avx2;
#endif
    return baseline;
}

}  // namespace stopline

#include "sim/full_kernels.h"

namespace stopline {

extern const FullKernels kScalarFullKernels;
extern const FullKernels kBaselineFullKernels;
extern const FullKernels kAvx2FullKernels;
extern const FullKernels kAvx512FullKernels;

namespace {

const FullKernels& widest() {
#if defined(__x86_64__)
    if (__builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq") && __builtin_cpu_supports("avx512vl") &&
        __builtin_cpu_supports("avx512bw") && __builtin_cpu_supports("avx512cd")) {
        return kAvx512FullKernels;
    }
    if (__builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma") && __builtin_cpu_supports("bmi2")) {
        return kAvx2FullKernels;
    }
#endif
    return kBaselineFullKernels;
}

}  // namespace

const FullKernels& full_kernels(bool scalar) {
    static const FullKernels& kWidest = widest();
    return scalar ? kScalarFullKernels : kWidest;
}

}  // namespace stopline

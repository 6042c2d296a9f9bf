#include "sim/meso_kernels.h"

#include "base/simd.h"
#include "sim/instruction_set.h"

namespace stopline {

extern const MesoKernels kScalarMesoKernels;
extern const MesoKernels kBaselineMesoKernels;
extern const MesoKernels kAvx2MesoKernels;
extern const MesoKernels kAvx512MesoKernels;

const MesoKernels& meso_kernels(bool scalar) {
    static const MesoKernels& kWidest = widest_of(kBaselineMesoKernels, kAvx2MesoKernels, kAvx512MesoKernels);
    return scalar ? kScalarMesoKernels : kWidest;
}

void MesoGroupArrays::resize(int vehicles) {
    constexpr std::size_t kUnit = kSimdWidth;  // every stream begins with a line of the cache
    vehicles_ = (static_cast<std::size_t>(vehicles) + kUnit - 1) / kUnit * kUnit;
    doubles_.assign(10 * vehicles_, 0.0);
    ints_.assign(2 * vehicles_, 0);
}

MesoGroup MesoGroupArrays::streams() {
    double* const d = doubles_.data();
    const std::size_t n = vehicles_;
    int* const k = ints_.data();
    return {d, d + n, d + 2 * n, d + 3 * n, d + 4 * n, d + 5 * n, d + 6 * n, d + 7 * n, d + 8 * n, d + 9 * n, k, k + n};
}

}  // namespace stopline

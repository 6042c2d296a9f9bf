#include "sim/full_dynamics/full_kernels.h"

#include "sim/performance/instruction_set.h"

namespace stopline {

extern const FullKernels kScalarFullKernels;
extern const FullKernels kBaselineFullKernels;
extern const FullKernels kAvx2FullKernels;
extern const FullKernels kAvx512FullKernels;

const FullKernels& full_kernels(bool scalar) {
    static const FullKernels& kWidest = widest_of(kBaselineFullKernels, kAvx2FullKernels, kAvx512FullKernels);
    return scalar ? kScalarFullKernels : kWidest;
}

}  // namespace stopline

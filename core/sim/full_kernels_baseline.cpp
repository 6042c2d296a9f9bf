// Full-dynamics kernels for the baseline instruction set (SSE2 on x86-64).
#include "sim/full_kernels.inl"

namespace stopline {

extern const FullKernels kScalarFullKernels;
const FullKernels kScalarFullKernels{"scalar", plan<double, 1>, drive<double, 1>};

extern const FullKernels kBaselineFullKernels;
const FullKernels kBaselineFullKernels{"baseline", plan<Batch, kBatchWidth>, drive<Batch, kBatchWidth>};

}  // namespace stopline

// Full-dynamics kernels for the baseline instruction set (SSE2 on x86-64).
#include "sim/full_kernels.inl"

namespace stopline {

extern const FullKernels kScalarFullKernels;
const FullKernels kScalarFullKernels{"scalar", plan<Single>, drive<Single>, integrate, overlaps};

extern const FullKernels kBaselineFullKernels;
const FullKernels kBaselineFullKernels{"baseline", plan<Batch>, drive<Batch>, integrate, overlaps};

}  // namespace stopline

// Full-dynamics kernels for the baseline instruction set (SSE2 on x86-64), and kernels that compute one vehicle at a
// time.
#include "sim/full_dynamics/full_kernels.inl"

namespace stopline {

extern const FullKernels kScalarFullKernels;
const FullKernels kScalarFullKernels = kernels_of<Single>("scalar");

extern const FullKernels kBaselineFullKernels;
const FullKernels kBaselineFullKernels = kernels_of<Batch>("baseline");

}  // namespace stopline

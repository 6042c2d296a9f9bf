// Full-dynamics kernels for AVX2.
#include "sim/full_dynamics/full_kernels.inl"

namespace stopline {

extern const FullKernels kAvx2FullKernels;
const FullKernels kAvx2FullKernels = kernels_of<Batch>("avx2");

}  // namespace stopline

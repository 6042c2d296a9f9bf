// Full-dynamics kernels for AVX-512.
#include "sim/full_dynamics/full_kernels.inl"

namespace stopline {

extern const FullKernels kAvx512FullKernels;
const FullKernels kAvx512FullKernels = kernels_of<Batch>("avx512");

}  // namespace stopline

// Full-dynamics kernels for AVX-512.
#include "sim/full_kernels.inl"

namespace stopline {

extern const FullKernels kAvx512FullKernels;
const FullKernels kAvx512FullKernels{"avx512", plan<Batch>, drive<Batch>, integrate, overlaps};

}  // namespace stopline

// Mesoscale kernels for AVX-512.
#include "sim/mesoscale/meso_kernels.inl"

namespace stopline {

extern const MesoKernels kAvx512MesoKernels;
const MesoKernels kAvx512MesoKernels{"avx512", kWide, step<Wide>, follow<Wide>};

}  // namespace stopline

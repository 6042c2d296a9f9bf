// Mesoscale kernels for AVX2.
#include "sim/mesoscale/meso_kernels.inl"

namespace stopline {

extern const MesoKernels kAvx2MesoKernels;
const MesoKernels kAvx2MesoKernels{"avx2", kWide, step<Wide>, follow<Wide>};

}  // namespace stopline

// Mesoscale kernels for the baseline instruction set (SSE2 on x86-64).
#include "sim/mesoscale/meso_kernels.inl"

namespace stopline {

extern const MesoKernels kBaselineMesoKernels;
const MesoKernels kBaselineMesoKernels{"baseline", kWide, step<Wide>, follow<Wide>};

}  // namespace stopline

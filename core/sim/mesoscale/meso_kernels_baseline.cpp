// Mesoscale kernels for the baseline instruction set (SSE2 on x86-64).
#include "sim/mesoscale/meso_kernels.inl"

namespace stopline {

extern const MesoKernelsOfTypes kBaselineMesoKernels;
const MesoKernelsOfTypes kBaselineMesoKernels = kernels_of_all<Wide>("baseline", FollowingTypes());

}  // namespace stopline

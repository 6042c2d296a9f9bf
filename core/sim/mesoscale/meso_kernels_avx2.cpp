// Mesoscale kernels for AVX2.
#include "sim/mesoscale/meso_kernels.inl"

namespace stopline {

extern const MesoKernelsOfTypes kAvx2MesoKernels;
const MesoKernelsOfTypes kAvx2MesoKernels = kernels_of_all<Wide>("avx2", FollowingTypes());

}  // namespace stopline

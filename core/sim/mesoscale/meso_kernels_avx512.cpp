// Mesoscale kernels for AVX-512.
#include "sim/mesoscale/meso_kernels.inl"

namespace stopline {

extern const MesoKernelsOfTypes kAvx512MesoKernels;
const MesoKernelsOfTypes kAvx512MesoKernels = kernels_of_all<Wide>("avx512", FollowingTypes());

}  // namespace stopline

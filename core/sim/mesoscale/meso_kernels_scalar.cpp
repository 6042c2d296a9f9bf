// Mesoscale kernels that compute one vehicle at a time. They are the reference for all other versions of the kernels,
// and are compiled without vectorisation (see CMakeLists.txt).
#include "sim/mesoscale/meso_kernels.inl"

namespace stopline {

extern const MesoKernelsOfTypes kScalarMesoKernels;
const MesoKernelsOfTypes kScalarMesoKernels = kernels_of_all<double>("scalar", FollowingTypes());

}  // namespace stopline

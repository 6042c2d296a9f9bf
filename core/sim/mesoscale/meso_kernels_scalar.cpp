// Mesoscale kernels that compute one vehicle at a time. They are the reference for all other versions of the kernels,
// and are compiled without vectorisation (see CMakeLists.txt).
#include "sim/mesoscale/meso_kernels.inl"

namespace stopline {

extern const MesoKernels kScalarMesoKernels;
const MesoKernels kScalarMesoKernels{"scalar", 1, step<double>, follow<double>};

}  // namespace stopline

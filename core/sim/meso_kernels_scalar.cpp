// Mesoscale kernels for one vehicle at a time: compiled without vectorisation (see CMakeLists.txt), the oracle of the others.
#include "sim/meso_kernels.inl"

namespace stopline {

extern const MesoKernels kScalarMesoKernels;
const MesoKernels kScalarMesoKernels{"scalar", 1, step<double>, follow<double>};

}  // namespace stopline

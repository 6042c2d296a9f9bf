// Mesoscale kernels for one vehicle at a time: compiled without vectorisation (see CMakeLists.txt), the oracle of the others.
#include "sim/meso_kernels.inl"

namespace stopline {

extern const MesoKernels kScalarMesoKernels;
const MesoKernels kScalarMesoKernels{"scalar", gather, follow, follow_two, scatter};

}  // namespace stopline

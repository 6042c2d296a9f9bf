#include "sim/mesoscale/meso_kernels.h"

#include "sim/performance/instruction_set.h"

namespace stopline {

extern const MesoKernels kScalarMesoKernels;
extern const MesoKernels kBaselineMesoKernels;
extern const MesoKernels kAvx2MesoKernels;
extern const MesoKernels kAvx512MesoKernels;

const MesoKernels& meso_kernels(bool scalar) {
    static const MesoKernels& kWidest = widest_of(kBaselineMesoKernels, kAvx2MesoKernels, kAvx512MesoKernels);
    return scalar ? kScalarMesoKernels : kWidest;
}

}  // namespace stopline

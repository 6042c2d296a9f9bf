#include "sim/mesoscale/meso_kernels.h"

#include <algorithm>

#include "base/containers/index.h"
#include "sim/performance/instruction_set.h"

namespace stopline {

extern const MesoKernelsOfTypes kScalarMesoKernels;
extern const MesoKernelsOfTypes kBaselineMesoKernels;
extern const MesoKernelsOfTypes kAvx2MesoKernels;
extern const MesoKernelsOfTypes kAvx512MesoKernels;

const MesoKernels& meso_kernels(int type, bool scalar) {
    static const MesoKernelsOfTypes& kWidest = widest_of(kBaselineMesoKernels, kAvx2MesoKernels, kAvx512MesoKernels);
    return (scalar ? kScalarMesoKernels : kWidest)[at(type)];
}

int step_blocks(bool scalar, const MesoStreams& streams, std::span<const int> blocks, MesoKernels::Models models,
                ExtraGap extra_gap, const MesoStep& step) {
    const auto kernels = models[0].family().kernels;
    const bool has_one_model = std::all_of(
        models.begin(), models.end(), [&](const FollowingModel& model) { return model.family().kernels == kernels; });
    const MesoKernels& first = kernels(scalar);
    return (has_one_model ? first.step : first.step_mixed)(streams, blocks, models, extra_gap, step);
}

int meso_block_size(bool scalar) { return meso_kernels(0, scalar).size; }

}  // namespace stopline

#include "runs/network/congestion.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/containers/index.h"

namespace stopline {

namespace {

constexpr double kCongested_mps = 12.0 / 3.6;
constexpr std::size_t kCongestedIntervals = 5;

}  // namespace

double CongestionSampler::SpeedSum::mean_mps() const {
    return vehicles == 0 ? std::numeric_limits<double>::quiet_NaN() : speed_mps / vehicles;
}

std::optional<double> Congestion::congested_from_s(std::size_t approach) const {
    const std::vector<ApproachInterval>& intervals = approaches.at(approach).intervals;
    std::size_t slow = 0;  // number of successive slow intervals
    for (std::size_t k = 0; k < intervals.size(); ++k) {
        slow = intervals[k].upstream_speed_mps < kCongested_mps ? slow + 1 : 0;
        if (slow == kCongestedIntervals) return static_cast<double>(k + 1 - kCongestedIntervals) * interval_s;
    }
    return std::nullopt;
}

CongestionSampler::CongestionSampler(const Model& model, double interval_s)
    : model_(model), second_ticks_(to_ticks(1.0, model.step_s)), interval_ticks_(to_ticks(interval_s, model.step_s)) {
    congestion_.interval_s = interval_s;
    const std::vector<Approach>& approaches = model.graph.approaches;
    if (approaches.empty()) return;
    double low_m = std::numeric_limits<double>::max();
    double high_m = std::numeric_limits<double>::lowest();
    for (const Approach& approach : approaches) {
        congestion_.approaches.push_back({approach.name, {}});
        for (const int lane : approach.lanes) {
            for (const Point& point : model.graph.lanes[at(lane)].shape) {
                low_m = std::min(low_m, point.x_m);
                high_m = std::max(high_m, point.x_m);
            }
        }
    }
    approach_.resize(approaches.size());
    upstream_.resize(approaches.size());
    congestion_.map.from_m = std::floor(low_m / SpeedMap::kStretch_m) * SpeedMap::kStretch_m;
    const auto stretches =
        static_cast<std::size_t>(std::ceil((high_m - congestion_.map.from_m) / SpeedMap::kStretch_m)) + 1;
    eastwards_.resize(stretches);
    westwards_.resize(stretches);
}

void CongestionSampler::sample_lane(const State& state, int lane) {
    constexpr double kMinCosine = 0.9;  // the map omits vehicles with a smaller |cosine| of the angle to the x axis
    const VehicleArrays& v = state.vehicles;
    const Lane& road = model_.graph.lanes[at(lane)];
    const double from_m = road.start_offset_m;
    const double third_m = (from_m + road.stop_line_m) / 3.0;
    const LaneBlock& block = state.blocks[at(lane)];
    for (int slot = block.first; slot < block.past_last(); ++slot) {
        const double speed_mps = v.speed_mps[at(slot)];
        const double position_m = v.position_m[at(slot)];
        approach_[at(road.approach)].add(speed_mps);
        if (position_m + from_m < third_m) upstream_[at(road.approach)].add(speed_mps);
        const Pose pose = pose_at(road.shape, position_m + road.shape_start_m);
        if (std::abs(pose.cosine) < kMinCosine) continue;
        const double stretch = (pose.point.x_m - congestion_.map.from_m) / SpeedMap::kStretch_m;
        std::vector<SpeedSum>& sums = pose.cosine > 0.0 ? eastwards_ : westwards_;
        if (stretch >= 0.0 && stretch < static_cast<double>(sums.size())) {
            sums[static_cast<std::size_t>(stretch)].add(speed_mps);
        }
    }
}

void CongestionSampler::sample(const State& state) {
    if (congestion_.approaches.empty()) return;
    if (state.tick % second_ticks_ == 0) {
        for (const Approach& approach : model_.graph.approaches) {
            for (const int lane : approach.lanes) sample_lane(state, lane);
        }
    }
    if (state.tick % interval_ticks_ == 0 && state.tick > 0) finish_interval();
}

void CongestionSampler::finish_interval() {
    const double samples = static_cast<double>(interval_ticks_) / static_cast<double>(second_ticks_);
    for (std::size_t k = 0; k < approach_.size(); ++k) {
        congestion_.approaches[k].intervals.push_back(
            {approach_[k].vehicles / samples, approach_[k].mean_mps(), upstream_[k].mean_mps()});
    }
    const auto means_mps = [](const std::vector<SpeedSum>& sums) {
        std::vector<double> means;
        for (const SpeedSum& sum : sums) means.push_back(sum.mean_mps());
        return means;
    };
    congestion_.map.eastwards_mps.push_back(means_mps(eastwards_));
    congestion_.map.westwards_mps.push_back(means_mps(westwards_));
    for (std::vector<SpeedSum>* sums : {&approach_, &upstream_, &eastwards_, &westwards_}) {
        sums->assign(sums->size(), {});
    }
}

}  // namespace stopline

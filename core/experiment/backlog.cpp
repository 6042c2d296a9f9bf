#include "experiment/backlog.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace stopline {

namespace {

std::size_t at(int index) { return static_cast<std::size_t>(index); }

constexpr double kSlow_mps = 12.0 / 3.6;
constexpr std::size_t kTogether = 5;  // intervals

}  // namespace

double BacklogWatch::Sum::mean() const {
    return vehicles == 0 ? std::numeric_limits<double>::quiet_NaN() : speed_mps / vehicles;
}

std::optional<double> Backlog::filled_s(std::size_t approach) const {
    const std::vector<ApproachInterval>& all = approaches.at(approach).intervals;
    std::size_t slow = 0;
    for (std::size_t k = 0; k < all.size(); ++k) {
        slow = all[k].upstream_speed_mps < kSlow_mps ? slow + 1 : 0;
        if (slow == kTogether) return static_cast<double>(k + 1 - kTogether) * interval_s;
    }
    return std::nullopt;
}

BacklogWatch::BacklogWatch(const Model& model, double interval_s)
    : model_(model), second_(to_ticks(1.0, model.step_s)), every_(to_ticks(interval_s, model.step_s)) {
    backlog_.interval_s = interval_s;
    const std::vector<Approach>& approaches = model.graph.approaches;
    if (approaches.empty()) return;
    double low_m = std::numeric_limits<double>::max();
    double high_m = std::numeric_limits<double>::lowest();
    for (const Approach& approach : approaches) {
        backlog_.approaches.push_back({approach.name, {}});
        for (const int lane : approach.lanes) {
            for (const Point& point : model.graph.lanes[at(lane)].shape) {
                low_m = std::min(low_m, point.x_m);
                high_m = std::max(high_m, point.x_m);
            }
        }
    }
    all_.resize(approaches.size());
    upstream_.resize(approaches.size());
    backlog_.map.from_m = std::floor(low_m / SpeedMap::kStretch_m) * SpeedMap::kStretch_m;
    const auto stretches =
        static_cast<std::size_t>(std::ceil((high_m - backlog_.map.from_m) / SpeedMap::kStretch_m)) + 1;
    eastwards_.resize(stretches);
    westwards_.resize(stretches);
}

void BacklogWatch::see(const State& state, int lane) {
    constexpr double kHeadsAlong = 0.9;
    const VehicleArrays& v = state.vehicles;
    const Lane& road = model_.graph.lanes[at(lane)];
    const double from_m = road.begin_m;
    const double third_m = (from_m + road.stop_line_m) / 3.0;
    const LaneBlock& block = state.blocks[at(lane)];
    for (int slot = block.first; slot < block.stop(); ++slot) {
        const double speed_mps = v.speed_mps[at(slot)];
        const double position_m = v.position_m[at(slot)];
        all_[at(road.approach)].add(speed_mps);
        if (position_m + from_m < third_m) upstream_[at(road.approach)].add(speed_mps);
        const Pose place = place_at(road.shape, position_m + road.shape_start_m);
        if (std::abs(place.cosine) < kHeadsAlong) continue;
        const double stretch = (place.point.x_m - backlog_.map.from_m) / SpeedMap::kStretch_m;
        std::vector<Sum>& sums = place.cosine > 0.0 ? eastwards_ : westwards_;
        if (stretch >= 0.0 && stretch < static_cast<double>(sums.size())) {
            sums[static_cast<std::size_t>(stretch)].add(speed_mps);
        }
    }
}

void BacklogWatch::look(const State& state) {
    if (backlog_.approaches.empty()) return;
    if (state.tick % second_ == 0) {
        for (const Approach& approach : model_.graph.approaches) {
            for (const int lane : approach.lanes) see(state, lane);
        }
    }
    if (state.tick % every_ == 0 && state.tick > 0) note_interval();
}

void BacklogWatch::note_interval() {
    const double samples = static_cast<double>(every_) / static_cast<double>(second_);
    for (std::size_t k = 0; k < all_.size(); ++k) {
        backlog_.approaches[k].intervals.push_back({all_[k].vehicles / samples, all_[k].mean(), upstream_[k].mean()});
    }
    const auto means = [](const std::vector<Sum>& sums) {
        std::vector<double> each;
        for (const Sum& sum : sums) each.push_back(sum.mean());
        return each;
    };
    backlog_.map.eastwards_mps.push_back(means(eastwards_));
    backlog_.map.westwards_mps.push_back(means(westwards_));
    for (std::vector<Sum>* sums : {&all_, &upstream_, &eastwards_, &westwards_}) sums->assign(sums->size(), {});
}

}  // namespace stopline

// A vehicle for which the reference engine decides right of way, and the result.
#pragma once

#include "reference/junction/occupants.h"

namespace stopline::reference_engine {

struct Candidate {
    Vehicle* vehicle = nullptr;
    int connection = -1;
    double front_m = 0.0;    // along the connection; below 0 on the approach lane
    bool is_inside = false;  // the front is past the stop line

    bool is_stopped() const { return vehicle->is_slow(); }
};

// Where a candidate must be able to stop, and the vehicle for which it waits.
struct Wait {
    double place_m = kNoLimit;  // along the connection; infinity: no wait
    Vehicle* blocker = nullptr;
    WaitReason reason = WaitReason::priority;
    bool keeps_gap = false;  // the candidate has accepted the gap behind the blocker

    bool exists() const { return place_m < kNoLimit; }
};

inline Wait nearer(const Wait& a, const Wait& b) { return b.place_m < a.place_m ? b : a; }

// Two slow vehicles wait for each other: vehicle `proceeds` drives on, and vehicle `yields` waits.
struct Resolution {
    int proceeds = -1;
    int yields = -1;
    std::int64_t last_tick = 0;
};

class Resolutions {
public:
    void forget_unused(std::int64_t tick) {
        constexpr std::int64_t kMemory_ticks = 5;
        std::erase_if(list_, [&](const Resolution& r) { return tick - r.last_tick > kMemory_ticks; });
    }
    // Returns the resolution between two vehicles; null if there is none.
    Resolution* find(const Vehicle& proceeds, const Vehicle& yields) {
        return find_if([&](const Resolution& r) { return r.proceeds == proceeds.id && r.yields == yields.id; });
    }
    Resolution* find(const Vehicle& proceeds) {
        return find_if([&](const Resolution& r) { return r.proceeds == proceeds.id; });
    }
    void add(const Vehicle& proceeds, const Vehicle& yields, std::int64_t tick) {
        list_.push_back({proceeds.id, yields.id, tick});
    }

private:
    template <class Matches>
    Resolution* find_if(Matches matches) {
        const auto found = std::find_if(list_.begin(), list_.end(), matches);
        return found == list_.end() ? nullptr : &*found;
    }
    std::vector<Resolution> list_;
};

}  // namespace stopline::reference_engine

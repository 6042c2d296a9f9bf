// The requests and agreements of cooperative gap opening. Owner: sim/lane_change/gap_cooperation.cpp. The
// requests are empty if no driver of the population uses it.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

namespace stopline {

// The request of one vehicle for a gap in the adjacent lane, and the agreement about it.
struct GapRequest {
    int requester = -1;  // id
    int place = 0;       // index of the requester on its lane in the last step
    int target_lane = -1;
    // Id of the vehicle behind the gap; -1: no vehicle has agreed yet.
    int opener = -1;
    int leader = -1;              // id of the vehicle ahead of the gap; -1: the opener is the first vehicle of its lane
    std::int64_t since_tick = 0;  // the messages of the requester contain the request from this tick on
    std::int64_t agreed_tick = -1;      // the messages of the opener contain its agreement from this tick on
    bool is_confirmed = false;          // the requester knows of the agreement
    std::int64_t next_search_tick = 0;  // the requester looks for an opener from this tick on
    std::int64_t begin_tick = -1;       // tick at which the opening begins; -1: not yet
    double begin_gap_m = 0.0;           // gap ahead of the opener at begin_tick
    double extra_m = 0.0;  // further length of the gap, because the requester was beside the opener at the agreement
    double hold_s = 0.0;   // time after begin_tick for which a stopped opener does not start
    bool is_open = false;  // the gap has reached its length

    bool agreed() const { return opener >= 0; }
};

// The end of an agreement. All values except `used` mean that the requester has not used the gap.
enum class GapEnding : std::uint8_t {
    used,        // the requester changes to the place ahead of the opener
    expired,     // the time limit has passed
    taken,       // a third vehicle has changed into the gap
    left,        // the opener has left its lane
    missed,      // the requester and the gap are no longer beside each other
    stopped,     // the opener must stop at the line, or the requester waits
    lost,        // one of the two vehicles receives no message from the other one any more
    not_needed,  // the requester has left its lane without the gap, or needs no lane change any more
    count
};

// Numbers of gap requests and their outcomes in the whole network.
struct GapCounts {
    std::int64_t requested = 0;  // vehicles that asked for a gap, once for each lane change
    std::int64_t agreed = 0;     // agreements to open a gap
    std::int64_t opened = 0;     // gaps that have reached their length
    std::array<std::int64_t, static_cast<std::size_t>(GapEnding::count)> endings{};
    double given_s = 0.0;  // delay of the openers

    std::int64_t& of(GapEnding ending) { return endings[static_cast<std::size_t>(ending)]; }
    std::int64_t of(GapEnding ending) const { return endings[static_cast<std::size_t>(ending)]; }

    void add(const GapCounts& other) {
        requested += other.requested;
        agreed += other.agreed;
        opened += other.opened;
        for (std::size_t k = 0; k < endings.size(); ++k) endings[k] += other.endings[k];
        given_s += other.given_s;
    }
};

struct GapCooperation {
    std::vector<std::vector<GapRequest>> requests;  // [lane of the requester]
    std::vector<char> cooperates;                   // [policy] 1: the vehicles ask for gaps and open gaps by V2V
    std::int64_t search_ticks = 1;                  // interval at which vehicles look for an opener
    // With a V2V channel: an agreement ends if the newest message between the two vehicles is older than this.
    std::int64_t longest_age_ticks = 0;

    bool is_on() const { return !requests.empty(); }
};

}  // namespace stopline

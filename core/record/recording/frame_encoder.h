// Encodes snapshots of a run as frames of a recording (recording_format.h). The encoder tracks vehicles by slot: it
// reads placements for new occupants of a slot, and only position and speed for all others.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "record/recording/recording_header.h"
#include "record/recording/snapshot.h"

namespace stopline {

class FrameEncoder {
public:
    FrameEncoder(const Model& model, const FrameGrid& grid);

    // Begins a section that can be read without the frames before it. The next snapshot must list all placements.
    void start_section();
    // Appends the next frame to `bytes`.
    void append(const Snapshot& snapshot, std::string& bytes);

    // Returns the number of vehicles in all frames together.
    std::int64_t vehicle_states() const { return vehicle_states_; }

private:
    // The vehicle in a seat, with lane and next lane as the reader knows them.
    struct Seat {
        int vehicle = -1;
        int slot = -1;
        int lane = -1;
        int next = -1;
    };
    struct Reason {
        DelayCause cause = DelayCause::none;
        int waited_for = -1;  // vehicle
        bool operator==(const Reason&) const = default;
    };
    struct Wait {
        Reason reason = {};       // at the last update of the delay causes
        Reason written = {};      // the last reason in the recording
        bool is_current = false;  // the vehicle was stopped at the last update
        bool is_listed = false;   // the seat is in waiting_seats_
    };
    // Position and speed in units of the header.
    struct Motion {
        std::uint16_t position = 0;
        std::uint16_t speed = 0;
    };
    // Encoded events of one kind.
    struct Events {
        std::string bytes;
        std::uint64_t count = 0;
        void clear();
        void append_to(std::string& frame) const;
    };
    // The kinds of events, in the order in which they are written.
    enum EventKind : std::size_t { light_events, exit_events, entry_events, lane_events, wait_events, event_kinds };

    // A value that differs from the motion of any vehicle.
    static constexpr std::uint32_t kUnknownMotion = 0xFFFFFFFF;

    void resize_slots(const std::vector<Snapshot::Slots>& lanes);
    void encode_lights(std::int64_t tick);
    void vacate_slots(const Snapshot& snapshot);
    void vacate(int slot);
    void encode_placement(const Snapshot::Placement& placement);
    void encode_next_lane(const Snapshot::BeyondStopLine& vehicle);
    void compare_motion(const Snapshot& snapshot);
    int seat_of(int vehicle) const;
    int assign_seat(const Snapshot::Placement& placement);
    void encode_lane(int seat, int lane, int next);
    void encode_exits();
    void encode_causes(const Snapshot& snapshot);
    void update_waits(const Snapshot& snapshot);
    void encode_reason(int seat, const Reason& reason);
    void append_columns(std::string& bytes);
    void append_codes(std::string& bytes);

    std::vector<GroupProgramme> signals_;
    std::int64_t watch_ticks_;
    FrameGrid grid_;
    std::vector<Seat> seats_;
    std::vector<int> free_seats_;  // the next one at the back
    std::vector<int> seat_of_;     // [vehicle]; -1: none
    // The next three members hold the state in the frame before.
    std::vector<int> seat_in_slot_;            // [slot]; -1: none
    std::vector<std::uint32_t> last_motion_;   // [slot]
    std::vector<Snapshot::Slots> lanes_;       // [lane]
    std::vector<int> vacated_;                 // seats of vehicles that moved or left the network
    std::vector<Wait> waits_;                  // [seat]
    std::vector<int> waiting_seats_;           // seats with a delay cause
    std::vector<Motion> reader_motion_;        // [seat] motion as the reader knows it
    std::vector<std::uint64_t> changed_bits_;  // one bit per seat: its motion is written in this frame
    std::string speeds_, positions_, wide_speeds_, wide_positions_;
    std::vector<Motion> motion_;  // [seat] in this frame
    std::vector<Light> lights_;   // [signal group]
    std::array<Events, event_kinds> events_;
    std::int64_t cause_tick_ = -1;  // last update of the delay causes
    std::int64_t entered_ = 0;      // since the beginning of the run
    std::int64_t exited_ = 0;       // since the beginning of the run
    std::int64_t vehicle_states_ = 0;
};

}  // namespace stopline

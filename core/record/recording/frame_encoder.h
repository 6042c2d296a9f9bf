// Encodes snapshots (copies of the state of a run, snapshot.h) as frames of a recording (recording_format.h). The
// encoder tracks vehicles by slot, which is the index of a vehicle in the arrays of the simulation. A snapshot contains
// position and speed of every vehicle. For each vehicle that is new, was in another slot before or has a new next lane,
// the snapshot also contains a Placement, which names the vehicle, its slot and its lane.
//
// Slots depend on the number of threads, but the bytes must not. So a Placement in another slot is no event of its own,
// and exits and delay causes are written in the order of the seats.
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

    // Begins a section that can be read without earlier sections. The next snapshot must list the placements of all
    // vehicles.
    void start_section();
    // Appends the next frame to `bytes`.
    void append(const Snapshot& snapshot, std::string& bytes);

    // Returns the sum, over all frames, of the number of vehicles in the frame.
    std::int64_t vehicle_states() const { return vehicle_states_; }

private:
    // The vehicle in a seat of the recording. `lane` and `next` (the next lane) are the values that were written last.
    struct Seat {
        int vehicle = -1;
        int slot = -1;
        int lane = -1;
        int next = -1;
    };
    struct Reason {
        DelayCause cause = DelayCause::none;
        int waited_for = -1;  // vehicle for which the stopped vehicle waits; -1: none
        bool operator==(const Reason&) const = default;
    };
    // The delay cause of the vehicle in a seat. The simulation updates the delay causes at regular intervals.
    struct Wait {
        Reason reason = {};       // why the vehicle stopped, from the latest update that found it stopped
        Reason written = {};      // reason that was last written to the recording
        bool is_current = false;  // the latest update found the vehicle stopped
        bool is_listed = false;   // the seat is in waiting_seats_
    };
    // Position in FrameGrid::position_unit_m and speed in kSpeedUnit_mps.
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

    // A value of Snapshot::motion that no vehicle has.
    static constexpr std::uint32_t kUnknownMotion = 0xFFFFFFFF;

    void resize_slots(const std::vector<Snapshot::Slots>& lanes);
    void encode_lights(const std::vector<Light>& lights);
    void vacate_slots(const Snapshot& snapshot);
    void vacate(int slot);
    void encode_placement(const Snapshot::Placement& placement);
    void compare_motion(const Snapshot& snapshot);
    int seat_of(int vehicle) const;
    int assign_seat(const Snapshot::Placement& placement);
    void encode_lane(int seat, int lane, int next);
    void encode_exits();
    void encode_causes(const Snapshot& snapshot);
    void update_waits(const Snapshot& snapshot);
    static void append_links(const std::vector<VehicleLink>& links, std::string& bytes);
    void encode_reason(int seat, const Reason& reason);
    void append_columns(std::string& bytes);
    void append_codes(std::string& bytes);

    std::int64_t watch_ticks_;
    bool has_links_;
    FrameGrid grid_;
    std::vector<Seat> seats_;
    std::vector<int> free_seats_;  // seats without a vehicle; the next seat to assign is at the back
    std::vector<int> seat_of_;     // [vehicle] its seat; -1: none
    // The next three members describe the previous frame.
    std::vector<int> seat_in_slot_;            // [slot] seat of the vehicle in the slot; -1: the slot is empty
    std::vector<std::uint32_t> last_motion_;   // [slot] value of Snapshot::motion
    std::vector<Snapshot::Slots> lanes_;       // [lane] slots of the lane
    std::vector<int> vacated_;                 // seats of vehicles that moved to another slot or left the network
    std::vector<Wait> waits_;                  // [seat]
    std::vector<int> waiting_seats_;           // seats whose vehicle has a delay cause
    std::vector<Motion> reader_motion_;        // [seat] motion that a reader knows from earlier frames
    std::vector<std::uint64_t> changed_bits_;  // one bit per seat; set: this frame contains the motion of the seat
    std::string speeds_, positions_, wide_speeds_, wide_positions_;
    std::vector<Motion> motion_;  // [seat] motion in this frame
    std::vector<Light> lights_;   // [signal group] light that was written last
    std::array<Events, event_kinds> events_;
    std::int64_t cause_tick_ = -1;  // tick of the latest update of the delay causes
    std::int64_t entered_ = 0;      // vehicles that entered since the beginning of the run
    std::int64_t exited_ = 0;       // vehicles that exited since the beginning of the run
    std::int64_t vehicle_states_ = 0;
};

}  // namespace stopline

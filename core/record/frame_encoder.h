// Turns snapshots of a run into frames of a recording (recording_format.h). A vehicle that is where it was in the frame before,
// by slot, is known by comparing one number, and only positions and speeds are looked at.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "record/recording_header.h"
#include "record/snapshot.h"

namespace stopline {

class FrameEncoder {
public:
    FrameEncoder(const Model& model, const FrameGrid& grid);

    // The next frame can be read without those before it.
    void start_section();
    void append(const Snapshot& shot, std::string& bytes);

    std::int64_t vehicle_states() const { return vehicle_states_; }

private:
    // Who sits there, and what the reader knows of it besides position, speed and what it waits for.
    struct Seat {
        int vehicle = -1;
        int slot = -1;
        int lane = -1;
        int next = -1;
    };
    struct Reason {
        Cause cause = Cause::none;
        int waited_for = -1;
        bool operator==(const Reason&) const = default;
    };
    struct Wait {
        Reason reason = {};   // at the last look
        Reason told = {};     // to the reader
        bool seen = false;    // at the last look
        bool listed = false;  // in waiting_
    };
    // Both in units of the header.
    struct Motion {
        std::uint16_t position = 0;
        std::uint16_t speed = 0;
    };
    struct Events {
        std::string bytes;
        std::uint64_t count = 0;
        void clear();
        void append_to(std::string& frame) const;
    };
    enum Kind : std::size_t { lights, left, came, moved, waits, kinds };

    void note_lights(std::int64_t tick);
    void note_vehicles(const Snapshot& shot);
    void vacate_slots(const Snapshot& shot);
    void note_vehicle(const Snapshot& shot, int slot, int lane);
    void vacate(int slot);
    int seat_at(const Snapshot& shot, int slot, int lane);
    int seat_of(int vehicle) const;
    int new_seat(const Snapshot& shot, int slot, int lane);
    void move(int seat, int lane, int next);
    void note_left();
    void note_causes(const Snapshot& shot);
    void look_at_standing(const Snapshot& shot);
    void tell_reason(int seat, const Reason& reason);
    void append_columns(std::string& bytes);
    void append_codes(std::string& bytes);

    std::vector<GroupProgramme> signals_;
    std::int64_t watch_ticks_;
    FrameGrid grid_;
    double positions_per_m_;
    std::vector<std::uint16_t> stop_line_;  // [lane] position; behind it vehicles are drawn on the lane that follows
    std::vector<Seat> seats_;
    std::vector<int> free_;     // seats, the one to take next at the back
    std::vector<int> seat_of_;  // [vehicle] -1: none
    // [slot] in the frame before: who was there, on which lane (-1: on none), and where it stood; NaN where it did not, so that
    // whoever stands where it stood is known by comparing, many at a time.
    std::vector<int> guest_;
    std::vector<int> guest_seat_;
    std::vector<int> lane_of_;
    std::vector<double> rest_m_;
    std::vector<char> moves_;               // [slot] to be looked at
    std::vector<int> changed_;              // lanes with other slots than in the frame before
    std::vector<Snapshot::Slots> lanes_;    // [lane] in the frame before
    std::vector<int> vacated_;              // seats whose slot is another's now: they moved, or left
    std::vector<Wait> waits_;               // [seat]
    std::vector<int> waiting_;              // seats with a cause
    std::vector<Motion> known_;             // [seat] by the reader
    std::vector<std::uint64_t> differing_;  // a bit a seat: told in this frame
    std::string speeds_, positions_, wide_speeds_, wide_positions_;
    std::vector<Motion> now_;  // [seat]
    std::vector<Light> lights_;
    std::array<Events, kinds> events_;
    std::int64_t look_tick_ = -1;  // last look at hindrance
    std::int64_t entered_ = 0;
    std::int64_t left_ = 0;
    std::int64_t vehicle_states_ = 0;
};

}  // namespace stopline

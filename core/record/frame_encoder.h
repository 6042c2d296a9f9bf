// Turns snapshots of a run into frames of a recording (recording_format.h). Vehicles are known by slot: a snapshot tells who has
// come to one, and of all others only positions and speeds are looked at.
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

    // The next frame can be read without those before it; its snapshot is one taken afresh.
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

    // A motion that no vehicle has, nor had when it was looked at last.
    static constexpr std::uint32_t kToLookAt = 0xFFFFFFFF;

    void make_room(const std::vector<Snapshot::Slots>& lanes);
    void note_lights(std::int64_t tick);
    void vacate_slots(const Snapshot& shot);
    void vacate(int slot);
    void note_guest(const Snapshot::Guest& guest);
    void note_past_line(const Snapshot::PastLine& one);
    void note_motion(const Snapshot& shot);
    int seat_of(int vehicle) const;
    int new_seat(const Snapshot::Guest& guest);
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
    std::vector<Seat> seats_;
    std::vector<int> free_;     // seats, the one to take next at the back
    std::vector<int> seat_of_;  // [vehicle] -1: none
    // [slot] in the frame before: the seat of who was there, and how it moved.
    std::vector<int> guest_seat_;
    std::vector<std::uint32_t> motion_before_;
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

// Decodes the frames of one section of a recording. FrameEncoder wrote them in the format of recording_format.h.
#pragma once

#include <cstdint>
#include <string_view>
#include <vector>

#include "record/recording/bytes.h"
#include "record/recording/recording_header.h"
#include "record/recording/vehicle_links.h"

namespace stopline {

// The vehicle in one seat of a frame. A vehicle keeps its seat while it is in the network (recording_format.h).
struct RecordedVehicle {
    int vehicle = -1;  // -1: the seat is empty
    int policy = 0;
    double length_m = 0.0;
    int lane = 0;
    int next = -1;               // next lane; -1: the vehicle leaves the network
    int cause = 0;               // delay cause: index in RecordedRun::causes
    int waited_for = -1;         // vehicle for which this vehicle waits; -1: none
    std::uint16_t position = 0;  // of the front, from the start of the lane, in FrameGrid::position_unit_m
    std::uint16_t speed = 0;     // in kSpeedUnit_mps
};

class FrameDecoder {
public:
    // The decoder keeps references to both arguments, so they must outlive the decoder.
    FrameDecoder(const RecordedRun& run, std::string_view section);

    // Decodes the next frame. Throws InputError if it is invalid.
    void next();
    // Throws InputError if bytes remain after the last frame.
    void check_end() const;

    const std::vector<RecordedVehicle>& seats() const { return seats_; }
    const std::vector<std::uint8_t>& lights() const { return lights_; }  // [signal group] 0 red, 1 green, 2 yellow
    const std::vector<VehicleLink>& links() const { return links_; }     // `kind`: index in RecordedRun::links
    // Return the numbers of vehicles that entered and exited the network since the previous frame.
    std::int64_t entered() const { return entered_; }
    std::int64_t exited() const { return exited_; }

private:
    RecordedVehicle& read_seat();
    void read_events();
    void read_links();
    void read_columns();

    const RecordedRun& run_;
    ByteReader reader_;
    std::vector<RecordedVehicle> seats_;
    std::vector<std::uint8_t> lights_;
    std::vector<VehicleLink> links_;
    std::int64_t entered_ = 0;
    std::int64_t exited_ = 0;
};

}  // namespace stopline

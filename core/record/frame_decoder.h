// Reads the frames of a section of a recording (recording_format.h): the other half of FrameEncoder.
#pragma once

#include <cstdint>
#include <string_view>
#include <vector>

#include "record/bytes.h"
#include "record/recording_header.h"

namespace stopline {

struct RecordedVehicle {
    int vehicle = -1;  // -1: the seat is empty
    int policy = 0;
    double length_m = 0.0;
    int lane = 0;
    int next = -1;  // lane; -1: it leaves the network
    int cause = 0;
    int waited_for = -1;         // vehicle
    std::uint16_t position = 0;  // in units of the header
    std::uint16_t speed = 0;
};

class FrameDecoder {
public:
    // Both must outlive it.
    FrameDecoder(const RecordedRun& run, std::string_view section);

    // The next frame. Throws InputError where it makes no sense.
    void next();
    // Throws InputError where something is left after the last frame.
    void check_end() const;

    const std::vector<RecordedVehicle>& seats() const { return seats_; }
    const std::vector<std::uint8_t>& lights() const { return lights_; }  // [signal group]
    std::int64_t entered() const { return entered_; }                    // since the frame before
    std::int64_t left() const { return left_; }

private:
    RecordedVehicle& seat();
    void read_events();
    void read_columns();

    const RecordedRun& run_;
    ByteReader reader_;
    std::vector<RecordedVehicle> seats_;
    std::vector<std::uint8_t> lights_;
    std::int64_t entered_ = 0;
    std::int64_t left_ = 0;
};

}  // namespace stopline

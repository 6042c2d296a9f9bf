// Helpers for tests of demand: scenarios with a traffic file, and counts of their events.
#pragma once

#include <gtest/gtest.h>

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "demand/route_search.h"
#include "scenario/build_model.h"
#include "scenario/load_scenario.h"
#include "sim/step/simulation.h"

namespace stopline {

// A file in a temporary folder, removed by the destructor.
class TrafficFile {
public:
    explicit TrafficFile(const std::string& text) {
        const ::testing::TestInfo* const test = ::testing::UnitTest::GetInstance()->current_test_info();
        folder_ = std::filesystem::temp_directory_path() /
                  (std::string("stopline_") + test->test_suite_name() + "_" + test->name());
        std::filesystem::create_directories(folder_);
        std::ofstream(folder_ / "traffic.csv") << text;
    }
    ~TrafficFile() { std::filesystem::remove_all(folder_); }
    TrafficFile(const TrafficFile&) = delete;
    TrafficFile& operator=(const TrafficFile&) = delete;

    Scenario scenario(const std::string& text, const std::vector<std::string>& overrides = {}) const {
        return parse_scenario(text, "test.yaml", overrides, folder_);
    }

private:
    std::filesystem::path folder_;
};

// Returns the number of vehicles by leg of entry and leg of exit. All vehicles must have left the network.
inline std::map<std::pair<std::string, std::string>, std::int64_t> trips_by_legs(const Model& model,
                                                                                 const State& state) {
    std::map<int, std::string> entry_leg;  // [vehicle]
    std::map<std::pair<std::string, std::string>, std::int64_t> trips;
    for (const Passage& passage : state.records.passages) {
        const auto leg = [&](int lane) { return leg_name(model.graph.lanes[static_cast<std::size_t>(lane)].name); };
        if (passage.from_lane < 0) entry_leg[passage.vehicle] = leg(passage.to_lane);
        if (passage.to_lane < 0) ++trips[{entry_leg.at(passage.vehicle), leg(passage.from_lane)}];
    }
    return trips;
}

}  // namespace stopline

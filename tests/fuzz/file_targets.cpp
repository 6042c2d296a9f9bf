// Targets that read files: scenarios, sweeps, SUMO's files and recordings.
#include <memory>
#include <string>
#include <string_view>

#include "fuzz/outcome.h"
#include "fuzz/targets.h"
#include "network/lane_graph.h"
#include "record/recording/frame_decoder.h"
#include "record/recording/recording_reader.h"
#include "scenario/load_scenario.h"
#include "scenario/make_network.h"
#include "scenario/sweep_file/load_sweep.h"
#include "sumo_import/sumo_graph.h"
#include "sumo_import/sumo_net.h"
#include "sumo_import/sumo_routes.h"
#include "sumo_import/sumo_signals.h"

namespace stopline::fuzz {

namespace {

constexpr double kClearance_m = 2.0;
constexpr double kStep_s = 0.1;

const std::filesystem::path kTestData = STOPLINE_TEST_DATA_DIR;
const std::filesystem::path kProject = STOPLINE_SOURCE_DIR;

}  // namespace

// Relative paths start at a folder that does not exist, so that the result depends on the input alone.
void run_scenario(std::string_view input) {
    expect_success_or_input_error([&] {
        const Scenario scenario = parse_scenario(input, "fuzz.yaml", {}, "/nonexistent");
        for (const std::string& warning : scenario.warnings) require_printable(warning);
    });
}

// Also builds the lane graph, because the user describes each street.
void run_streets(std::string_view input) {
    expect_success_or_input_error([&] {
        const Scenario scenario = parse_scenario(input, "fuzz.yaml", {}, "/nonexistent");
        if (scenario.network.kind == "streets") check(make_network(scenario.network));
    });
}

void run_sweep(std::string_view input) {
    expect_success_or_input_error(
        [&] { static_cast<void>(parse_sweep(input, "fuzz.yaml", kProject / "scenarios/sweeps")); });
}

void run_sumo_net(std::string_view input) {
    expect_success_or_input_error([&] {
        const SumoNetwork network = make_sumo_network(read_sumo_net(MemoryFile::with(input)), kClearance_m);
        check(network.graph);
        static_cast<void>(make_sumo_signals(network, kStep_s));
        static_cast<void>(make_sumo_phase_priorities(network, kStep_s));
        for (const std::string& line : network.net.warnings.lines()) require_printable(line);
    });
}

void run_sumo_additional(std::string_view input) {
    static const SumoNet kNet = read_sumo_net(kTestData / "left_turns.net.xml");
    expect_success_or_input_error([&] {
        SumoNet net = kNet;
        read_sumo_additional(MemoryFile::with(input), net);
        const SumoNetwork network = make_sumo_network(std::move(net), kClearance_m);
        static_cast<void>(make_sumo_signals(network, kStep_s));
        static_cast<void>(make_sumo_phase_priorities(network, kStep_s));
        for (const std::string& line : network.net.warnings.lines()) require_printable(line);
    });
}

// The run is short, because a flow may have 1,000 vehicles a second.
void run_sumo_routes(std::string_view input) {
    constexpr double kUntil_s = 2.0;
    static const SumoNetwork kNetwork =
        make_sumo_network(read_sumo_net(kTestData / "left_turns.net.xml"), kClearance_m);
    expect_success_or_input_error([&] {
        const SumoTraffic traffic = read_sumo_routes({{}, {MemoryFile::with(input)}, true}, kNetwork, kUntil_s, 1);
        require(traffic.ids.size() == traffic.trips.size(), "every trip has an id");
        for (const std::string& line : traffic.warnings.lines()) require_printable(line);
    });
}

void run_recording(std::string_view input) {
    expect_success_or_input_error([&] {
        RecordingReader reader(MemoryFile::with(input));
        for (RecordedSection section; reader.next(section);) {
            FrameDecoder decoder(reader.run(), section.bytes);
            for (int k = 0; k < section.frames; ++k) decoder.next();
            decoder.check_end();
        }
    });
}

}  // namespace stopline::fuzz

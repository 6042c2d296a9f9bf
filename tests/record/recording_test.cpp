// Tests of recordings (files that store a run frame by frame). Reading a recording back gives the simulated states
// within rounding. Damage to the file is detected.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <map>
#include <string>
#include <tuple>
#include <vector>

#include "record/recording/frame_decoder.h"
#include "record/recording/recorder.h"
#include "record/recording/recording_reader.h"
#include "runs/network/network_run.h"
#include "runs/observation.h"
#include "scenario/scenario_text.h"
#include "sim/state/queries/stopped_vehicles.h"

namespace stopline {
namespace {

namespace fs = std::filesystem;

struct VehicleState {
    int policy, lane, next;
    double position_m, speed_mps;
};
using VehicleStates = std::map<int, VehicleState>;  // by vehicle id

VehicleStates states_of(const State& state) {
    VehicleStates states;
    const VehicleArrays& v = state.vehicles;
    for (int lane = 0; lane < static_cast<int>(state.blocks.size()); ++lane) {
        const LaneBlock& block = state.blocks[static_cast<std::size_t>(lane)];
        for (auto slot = static_cast<std::size_t>(block.first); slot < static_cast<std::size_t>(block.past_last());
             ++slot) {
            states[v.id[slot]] = {v.policy[slot], lane, v.next_lane[slot], v.position_m[slot], v.speed_mps[slot]};
        }
    }
    return states;
}

// Reference data of a recorded run, one entry for each frame.
struct Recorded {
    std::vector<VehicleStates> frames;
    std::vector<std::vector<Light>> lights;
    std::vector<std::map<int, DelayCause>> causes;  // delay causes of stopped vehicles, by vehicle id
    std::vector<std::vector<VehicleLink>> links;
    std::uint64_t hash = 0;
    RecordingSize size;
};

// Returns a small grid that is prone to gridlock.
Scenario small_grid(const std::string& fidelity) {
    return load_scenario(STOPLINE_SOURCE_DIR "/scenarios/grid.yaml",
                         {"network.grid.columns=2", "network.grid.rows=2", "duration=240 s", "measure.window=60 s",
                          "fidelity=" + fidelity, "signal.green=20 s", "demand.left=20 %", "rules.teleport_cycles=1"});
}

Recorded record_run(const Scenario& scenario, const fs::path& file, const RecordingWindow& window) {
    Recorded result;
    std::unique_ptr<Recorder> recorder;
    Observation observation;
    observation.look = [&](std::size_t, const Simulation& simulation) {
        const Model& model = simulation.model();
        const State& state = simulation.state();
        if (!recorder) recorder = std::make_unique<Recorder>(file, window, RunOrigin{"again", "grid"}, model);
        recorder->observe(state);
        const double frame = (simulation.time_s() - window.from_s) / window.interval_s;
        if (frame < -1e-6 || std::abs(frame - std::round(frame)) > 1e-6) return;
        if (simulation.time_s() > window.until_s + 1e-6) return;
        result.frames.push_back(states_of(state));
        result.lights.emplace_back();
        for (int group = 0; group < model.signals.groups(); ++group) {
            result.lights.back().push_back(model.signals.programme(group).light(state.tick));
        }
        result.links.emplace_back();
        const std::vector<const LinkKind*> kinds = link_kinds_of(model);
        for (std::size_t k = 0; k < kinds.size(); ++k) kinds[k]->add(state, static_cast<int>(k), result.links.back());
        result.causes.emplace_back();
        for_each_stopped_vehicle(
            state, [&](const StoppedVehicle& stopped) { result.causes.back()[stopped.vehicle] = stopped.cause; });
    };
    result.hash = run_network(scenario, 2, {}, 1, observation).state_hash;
    result.size = recorder->finish();
    return result;
}

void expect_equal_frame(const RecordedRun& run, const FrameDecoder& decoder, const Recorded& recorded,
                        std::size_t frame) {
    std::size_t present = 0;
    const VehicleStates& states = recorded.frames[frame];
    for (const RecordedVehicle& read : decoder.seats()) {
        if (read.vehicle < 0) continue;
        ++present;
        const auto found = states.find(read.vehicle);
        ASSERT_NE(found, states.end()) << "frame " << frame << " vehicle " << read.vehicle;
        const VehicleState& state = found->second;
        EXPECT_EQ(std::tie(read.policy, read.lane), std::tie(state.policy, state.lane)) << "frame " << frame;
        EXPECT_NEAR(read.position * run.grid.position_unit_m, state.position_m, 0.5001 * run.grid.position_unit_m);
        EXPECT_NEAR(read.speed * 0.01, state.speed_mps, 0.00501);
        EXPECT_EQ(read.next, state.next);
        const auto& causes = recorded.causes[frame];
        const auto cause = causes.find(read.vehicle);
        const DelayCause expected = cause != causes.end() ? cause->second : DelayCause::none;
        EXPECT_EQ(read.cause, static_cast<int>(expected));
    }
    EXPECT_EQ(present, states.size()) << "frame " << frame;
    EXPECT_EQ(decoder.links(), recorded.links[frame]) << "frame " << frame;
    for (std::size_t group = 0; group < decoder.lights().size(); ++group) {
        EXPECT_EQ(decoder.lights()[group], static_cast<std::uint8_t>(recorded.lights[frame][group]));
    }
}

void expect_round_trip_of(const Scenario& scenario, const RecordingWindow& window, Recorded& recorded) {
    const TemporaryFolder folder;
    const fs::path file = folder.path() / "run.rec";
    recorded = record_run(scenario, file, window);
    EXPECT_EQ(recorded.hash, run_network(scenario, 2).state_hash) << "the recording changes the run";
    RecordingReader reader(file);
    EXPECT_EQ(reader.run().origin.command, "again");
    RecordedSection section;
    std::size_t frame = 0;
    std::int64_t state_count = 0;
    while (reader.next(section)) {
        FrameDecoder decoder(reader.run(), section.bytes);
        for (int k = 0; k < section.frames; ++k, ++frame) {
            decoder.next();
            ASSERT_LT(frame, recorded.frames.size());
            expect_equal_frame(reader.run(), decoder, recorded, frame);
            state_count += static_cast<std::int64_t>(recorded.frames[frame].size());
            if (testing::Test::HasFailure()) return;
        }
        decoder.check_end();
    }
    EXPECT_EQ(frame, recorded.frames.size());
    EXPECT_EQ(recorded.size.frames, static_cast<std::int64_t>(frame));
    EXPECT_EQ(recorded.size.vehicle_states, state_count);
    EXPECT_EQ(recorded.size.bytes, fs::file_size(file));
    EXPECT_LT(recorded.size.bytes_per_state(), 4.0);
}

void expect_round_trip(const std::string& fidelity, const RecordingWindow& window) {
    Recorded recorded;
    expect_round_trip_of(small_grid(fidelity), window, recorded);
}

TEST(Recording, ReadsBackAMesoscaleRun) { expect_round_trip("meso", {}); }
TEST(Recording, ReadsBackEveryStep) { expect_round_trip("meso", {0.1, 30.0, 150.0}); }

// Cooperative clearing refuses vehicles, which wait for the last vehicle on their exit lane.
TEST(Recording, ReadsBackLinks) {
    Scenario scenario = small_grid("meso");
    scenario.rules.clearing = "cooperative";
    Recorded recorded;
    expect_round_trip_of(scenario, {}, recorded);
    std::size_t refusals = 0;
    for (std::size_t frame = 0; frame < recorded.frames.size(); ++frame) {
        for (const VehicleLink& link : recorded.links[frame]) {
            EXPECT_TRUE(recorded.frames[frame].contains(link.vehicle));
            EXPECT_GE(link.lane, 0);
            if (link.other >= 0) {
                EXPECT_EQ(recorded.frames[frame].at(link.other).lane, link.lane);
            }
            ++refusals;
        }
    }
    EXPECT_GT(refusals, 10u);
}

// With cooperative gap opening, links lead from vehicles that ask for a gap to the vehicles that open it.
TEST(Recording, ReadsBackGapAgreements) {
    const Scenario scenario = load_scenario(
        STOPLINE_SOURCE_DIR "/scenarios/berlin.yaml",
        {"populations=[CTG-Ref, SWITCH-1, CDG]", "driver.lane_change.gap_opening=cooperative", "duration=150 s"});
    Recorded recorded;
    expect_round_trip_of(scenario, {}, recorded);
    std::size_t agreements = 0;
    for (std::size_t frame = 0; frame < recorded.frames.size(); ++frame) {
        for (const VehicleLink& link : recorded.links[frame]) {
            EXPECT_TRUE(recorded.frames[frame].contains(link.vehicle));
            EXPECT_NE(link.vehicle, link.other);
            ++agreements;
        }
    }
    EXPECT_GT(agreements, 10u);
}

TEST(Recording, ReadsBackRareFrames) { expect_round_trip("meso", {7.0, 0.0, 238.0}); }
TEST(Recording, SlowReadsBackAFullDynamicsRun) { expect_round_trip("full", {0.5, 60.0, 120.0}); }

// Returns the slot (index in the vehicle arrays) of a vehicle past the stop line of its lane; -1 if there is none.
int slot_past_line(const Model& model, const State& state) {
    for (std::size_t lane = 0; lane < state.blocks.size(); ++lane) {
        const int first = state.blocks[lane].first;
        const bool occupied = state.blocks[lane].count > 0 && model.graph.lanes[lane].signal_group >= 0;
        const double front_m = state.vehicles.position_m[static_cast<std::size_t>(first)];
        if (occupied && front_m > model.graph.lanes[lane].stop_line_m + 0.1) return first;
    }
    return -1;
}

// A stopped vehicle past the stop line may change its next lane. The recording must contain this change, although the
// position of the vehicle stays the same.
TEST(Recording, UpdatesTheNextLaneOfAStoppedVehicle) {
    const TemporaryFolder folder;
    const fs::path file = folder.path() / "run.rec";
    const Model model = network_model(small_grid("meso"), 2);
    Simulation simulation(model);
    while (slot_past_line(model, simulation.state()) < 0 || simulation.state().tick % 5 != 0) simulation.step();
    State state = simulation.state();
    const auto slot = static_cast<std::size_t>(slot_past_line(model, state));
    state.vehicles.speed_mps[slot] = 0.0;
    Recorder recorder(file, {0.5, model.time_s(state.tick), 300.0}, {}, model);
    const std::vector<int> next_lanes{3, 3, 4, 4};
    for (const int next_lane : next_lanes) {
        state.vehicles.next_lane[slot] = next_lane;
        recorder.observe(state);
        state.tick += 5;
    }
    recorder.finish();
    RecordingReader reader(file);
    RecordedSection section;
    ASSERT_TRUE(reader.next(section));
    FrameDecoder decoder(reader.run(), section.bytes);
    for (const int next_lane : next_lanes) {
        decoder.next();
        int next = -2;
        int position = -1;
        for (const RecordedVehicle& read : decoder.seats()) {
            if (read.vehicle != state.vehicles.id[slot]) continue;
            next = read.next;
            position = read.position;
        }
        EXPECT_EQ(next, next_lane);
        EXPECT_NEAR(position * reader.run().grid.position_unit_m, state.vehicles.position_m[slot], 0.01);
    }
}

class DamagedRecording : public testing::Test {
protected:
    void SetUp() override {
        record_run(small_grid("meso"), good_, {1.0, 0.0, 200.0});
        bytes_ = read_text(good_);
    }
    // Returns the error message of reading a file with these bytes to its end, or "".
    std::string error_of_bytes(const std::string& bytes) const {
        const fs::path file = folder_.write("bad.rec", bytes);
        return input_error_of([&] {
            RecordingReader reader(file);
            RecordedSection section;
            while (reader.next(section)) {
            }
        });
    }
    TemporaryFolder folder_;
    fs::path good_ = folder_.path() / "good.rec";
    std::string bytes_;
};

TEST_F(DamagedRecording, IsDetectedForAnyTruncationOrChange) {
    ASSERT_EQ(error_of_bytes(bytes_), "");
    for (std::size_t size = 0; size < bytes_.size(); size += 1 + bytes_.size() / 97) {
        EXPECT_TRUE(contains(error_of_bytes(bytes_.substr(0, size)), "bad.rec: ")) << "cut at " << size;
    }
    for (std::size_t index = 0; index < bytes_.size(); index += 1 + bytes_.size() / 211) {
        std::string changed = bytes_;
        changed[index] = static_cast<char>(~changed[index]);
        EXPECT_TRUE(contains(error_of_bytes(changed), "bad.rec: ")) << "changed at " << index;
    }
    EXPECT_TRUE(contains(error_of_bytes(bytes_ + "x"), "bytes follow the end of the recording"));
    EXPECT_TRUE(contains(error_of_bytes("population,time_s\n"), "not written by stopline-run --record"));
    std::string newer = bytes_;
    newer[8] = 9;
    EXPECT_TRUE(contains(error_of_bytes(newer), "version 9"));
}

// Corrupt frames may pass the checksum. For any bytes, the decoder must decode the frame or throw an InputError.
TEST_F(DamagedRecording, CorruptFramesAreRefusedOrDecoded) {
    RecordingReader reader(good_);
    RecordedSection section;
    ASSERT_TRUE(reader.next(section));
    std::srand(1);  // NOLINT: any bytes will do
    int refused = 0;
    for (int trial = 0; trial < 300; ++trial) {
        std::string bytes = section.bytes;
        for (int k = 0; k < 3; ++k) {
            bytes[static_cast<std::size_t>(std::rand()) % bytes.size()] = static_cast<char>(std::rand());  // NOLINT
        }
        refused += input_error_of([&] {
                       FrameDecoder decoder(reader.run(), bytes);
                       for (int k = 0; k < section.frames; ++k) decoder.next();
                       decoder.check_end();
                   }).empty()
                       ? 0
                       : 1;
    }
    EXPECT_GT(refused, 10);
}

TEST(Recording, AppearsWhenFinishedAndIsReproducible) {
    const TemporaryFolder folder;
    const Scenario scenario = small_grid("meso");
    const Model model = network_model(scenario, 2);
    {
        Simulation simulation(model);
        Recorder recorder(folder.path() / "half.rec", {}, {}, model);
        for (int k = 0; k < 1000; ++k) {
            recorder.observe(simulation.state());
            simulation.step();
        }
    }
    EXPECT_TRUE(fs::is_empty(folder.path()));
    record_run(scenario, folder.path() / "a.rec", {});
    record_run(scenario, folder.path() / "b.rec", {});
    EXPECT_EQ(read_text(folder.path() / "a.rec"), read_text(folder.path() / "b.rec"));
}

}  // namespace
}  // namespace stopline

// What is read back from a recording is what the simulation did, to the unit; whatever is done to the file is noticed.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <map>
#include <string>
#include <tuple>
#include <vector>

#include "runs/network/network_run.h"
#include "runs/observation.h"
#include "record/recording/frame_decoder.h"
#include "record/recording/recorder.h"
#include "record/recording/recording_reader.h"
#include "scenario/scenario_text.h"

namespace stopline {
namespace {

namespace fs = std::filesystem;

struct Seen {
    int policy, lane, next;
    double position_m, speed_mps;
};
using Picture = std::map<int, Seen>;  // by vehicle

Picture picture_of(const State& state) {
    Picture picture;
    const VehicleArrays& v = state.vehicles;
    for (int lane = 0; lane < static_cast<int>(state.blocks.size()); ++lane) {
        const LaneBlock& block = state.blocks[static_cast<std::size_t>(lane)];
        for (auto slot = static_cast<std::size_t>(block.first); slot < static_cast<std::size_t>(block.past_last()); ++slot) {
            picture[v.id[slot]] = {v.policy[slot], lane, v.next_lane[slot], v.position_m[slot], v.speed_mps[slot]};
        }
    }
    return picture;
}

// A gridlock-prone small grid, its recording, and what was to be seen at each frame.
struct Recorded {
    std::vector<Picture> pictures;
    std::vector<std::vector<Light>> lights;
    std::vector<std::map<int, DelayCause>> causes;  // by vehicle, of those that stand
    std::uint64_t hash = 0;
    RecordingSize size;
};

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
        result.pictures.push_back(picture_of(state));
        result.lights.emplace_back();
        for (const GroupProgramme& programme : model.signals) {
            result.lights.back().push_back(programme.light(state.tick));
        }
        result.causes.emplace_back();
        for (const int slot : state.congestion.watch.stopped_slots) {
            const auto k = static_cast<std::size_t>(slot);
            result.causes.back()[state.congestion.watch.vehicle[k]] = state.congestion.watch.cause[k];
        }
    };
    result.hash = run_network(scenario, 2, {}, 1, observation).state_hash;
    result.size = recorder->finish();
    return result;
}

void expect_same(const RecordedRun& run, const FrameDecoder& decoder, const Recorded& recorded, std::size_t frame) {
    std::size_t present = 0;
    const Picture& picture = recorded.pictures[frame];
    for (const RecordedVehicle& read : decoder.seats()) {
        if (read.vehicle < 0) continue;
        ++present;
        const auto found = picture.find(read.vehicle);
        ASSERT_NE(found, picture.end()) << "frame " << frame << " vehicle " << read.vehicle;
        const Seen& seen = found->second;
        EXPECT_EQ(std::tie(read.policy, read.lane), std::tie(seen.policy, seen.lane)) << "frame " << frame;
        EXPECT_NEAR(read.position * run.grid.position_unit_m, seen.position_m, 0.5001 * run.grid.position_unit_m);
        EXPECT_NEAR(read.speed * 0.01, seen.speed_mps, 0.00501);
        EXPECT_EQ(read.next, seen.next);
        const auto& causes = recorded.causes[frame];
        const auto cause = causes.find(read.vehicle);
        const DelayCause expected = cause != causes.end() ? cause->second : DelayCause::none;
        EXPECT_EQ(read.cause, static_cast<int>(expected));
    }
    EXPECT_EQ(present, picture.size()) << "frame " << frame;
    for (std::size_t group = 0; group < decoder.lights().size(); ++group) {
        EXPECT_EQ(decoder.lights()[group], static_cast<std::uint8_t>(recorded.lights[frame][group]));
    }
}

void expect_round_trip(const std::string& fidelity, const RecordingWindow& window) {
    const TemporaryFolder folder;
    const fs::path file = folder.path() / "run.rec";
    const Scenario scenario = small_grid(fidelity);
    const Recorded recorded = record_run(scenario, file, window);
    EXPECT_EQ(recorded.hash, run_network(scenario, 2).state_hash) << "looking on changes the run";
    RecordingReader reader(file);
    EXPECT_EQ(reader.run().origin.command, "again");
    RecordedSection section;
    std::size_t frame = 0;
    std::int64_t states = 0;
    while (reader.next(section)) {
        FrameDecoder decoder(reader.run(), section.bytes);
        for (int k = 0; k < section.frames; ++k, ++frame) {
            decoder.next();
            ASSERT_LT(frame, recorded.pictures.size());
            expect_same(reader.run(), decoder, recorded, frame);
            states += static_cast<std::int64_t>(recorded.pictures[frame].size());
            if (testing::Test::HasFailure()) return;
        }
        decoder.check_end();
    }
    EXPECT_EQ(frame, recorded.pictures.size());
    EXPECT_EQ(recorded.size.frames, static_cast<std::int64_t>(frame));
    EXPECT_EQ(recorded.size.vehicle_states, states);
    EXPECT_EQ(recorded.size.bytes, fs::file_size(file));
    EXPECT_LT(recorded.size.bytes_per_state(), 4.0);
}

TEST(Recording, ReadsBackWhatTheMesoscaleModeDid) { expect_round_trip("meso", {}); }
TEST(Recording, ReadsBackEveryStep) { expect_round_trip("meso", {0.1, 30.0, 150.0}); }
TEST(Recording, ReadsBackRareFrames) { expect_round_trip("meso", {7.0, 0.0, 238.0}); }
TEST(Recording, SlowReadsBackWhatFullDynamicsDid) { expect_round_trip("full", {0.5, 60.0, 120.0}); }

// The first vehicle past the stop line of its lane.
int slot_past_line(const Model& model, const State& state) {
    for (std::size_t lane = 0; lane < state.blocks.size(); ++lane) {
        const int first = state.blocks[lane].first;
        const bool may_be = state.blocks[lane].count > 0 && model.graph.lanes[lane].signal_group >= 0;
        const double front_m = state.vehicles.position_m[static_cast<std::size_t>(first)];
        if (may_be && front_m > model.graph.lanes[lane].stop_line_m + 0.1) return first;
    }
    return -1;
}

// A vehicle may choose another way at the end of its lane, without being anywhere else.
TEST(Recording, TellsWhereOnePastTheLineGoesOnAlthoughItStands) {
    const TemporaryFolder folder;
    const fs::path file = folder.path() / "run.rec";
    const Model model = network_model(small_grid("meso"), 2);
    Simulation simulation(model);
    while (slot_past_line(model, simulation.state()) < 0 || simulation.state().tick % 5 != 0) simulation.step();
    State state = simulation.state();
    const auto slot = static_cast<std::size_t>(slot_past_line(model, state));
    state.vehicles.speed_mps[slot] = 0.0;
    Recorder recorder(file, {0.5, model.time_s(state.tick), 300.0}, {}, model);
    const std::vector<int> ways{3, 3, 4, 4};
    for (const int way : ways) {
        state.vehicles.next_lane[slot] = way;
        recorder.observe(state);
        state.tick += 5;
    }
    recorder.finish();
    RecordingReader reader(file);
    RecordedSection section;
    ASSERT_TRUE(reader.next(section));
    FrameDecoder decoder(reader.run(), section.bytes);
    for (const int way : ways) {
        decoder.next();
        int next = -2;
        int position = -1;
        for (const RecordedVehicle& read : decoder.seats()) {
            if (read.vehicle != state.vehicles.id[slot]) continue;
            next = read.next;
            position = read.position;
        }
        EXPECT_EQ(next, way);
        EXPECT_NEAR(position * reader.run().grid.position_unit_m, state.vehicles.position_m[slot], 0.01);
    }
}

class DamagedRecording : public testing::Test {
protected:
    void SetUp() override {
        record_run(small_grid("meso"), good_, {1.0, 0.0, 200.0});
        bytes_ = read_text(good_);
    }
    // The message of reading a file of these bytes to its end.
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

TEST_F(DamagedRecording, IsNoticedWhereverItEndsOrDiffers) {
    ASSERT_EQ(error_of_bytes(bytes_), "");
    for (std::size_t size = 0; size < bytes_.size(); size += 1 + bytes_.size() / 97) {
        EXPECT_TRUE(contains(error_of_bytes(bytes_.substr(0, size)), "bad.rec: ")) << "cut at " << size;
    }
    for (std::size_t at = 0; at < bytes_.size(); at += 1 + bytes_.size() / 211) {
        std::string other = bytes_;
        other[at] = static_cast<char>(~other[at]);
        EXPECT_TRUE(contains(error_of_bytes(other), "bad.rec: ")) << "changed at " << at;
    }
    EXPECT_TRUE(contains(error_of_bytes(bytes_ + "x"), "bytes follow the end of the recording"));
    EXPECT_TRUE(contains(error_of_bytes("population,time_s\n"), "not written by stopline-run --record"));
    std::string newer = bytes_;
    newer[8] = 9;
    EXPECT_TRUE(contains(error_of_bytes(newer), "version 9"));
}

// Frames that pass the checksum but make no sense: whatever their bytes are, the decoder ends with an error or a frame.
TEST_F(DamagedRecording, FramesOfAnyBytesAreRefusedOrRead) {
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

TEST(Recording, AppearsOnlyOnceItIsFinishedAndIsTheSameEachTime) {
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

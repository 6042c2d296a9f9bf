#include "sumo_export/facts.h"

#include <cmath>
#include <unordered_map>
#include <utility>

#include "base/containers/index.h"
#include "base/speed_thresholds.h"
#include "base/units.h"
#include "record/departure_delay.h"
#include "sumo_import/sumo_xml.h"

namespace stopline {

namespace {

class FactsWriter : public RunWriter {
public:
    FactsWriter(const Model& model, std::vector<std::string> stop_lines, RunFacts& facts)
        : model_(model),
          stop_lines_(std::move(stop_lines)),
          facts_(facts),
          ticks_per_second_(to_ticks(1.0, model.step_s)) {}

    void observe(const State& state) override {
        add_passages(state);
        if (state.tick % ticks_per_second_ == 0) add_instant(state);
        facts_.teleported = state.congestion.delays.teleported;  // blocked vehicles and vehicles that missed a turn
    }
    std::string finish() override { return ""; }

private:
    // Records entries, completed trips and passages of stop lines. In a Passage, lane -1 means outside the network.
    void add_passages(const State& state) {
        for (; next_passage_ < state.records.passages.size(); ++next_passage_) {
            const Passage& passage = state.records.passages[next_passage_];
            if (passage.from_lane < 0) {
                entries_[passage.vehicle] = {passage.time_s, delay_of_entry_s(state, passage)};
            } else if (passage.to_lane < 0) {
                const auto found = entries_.find(passage.vehicle);
                const Entry from = found == entries_.end() ? Entry{} : found->second;
                facts_.trips.push_back({passage.time_s, passage.time_s - from.time_s, from.departure_delay_s});
                if (found != entries_.end()) entries_.erase(found);
            }
        }
        for (; next_crossing_ < state.records.crossings.size(); ++next_crossing_) {
            const Crossing& crossing = state.records.crossings[next_crossing_];
            const Detector& detector = model_.detectors[at(crossing.detector)];
            if (detector.kind != Detector::Kind::stop_line || stop_lines_[at(detector.lane)].empty()) continue;
            facts_.passed_s[stop_lines_[at(detector.lane)]].push_back(crossing.time_s);
        }
    }

    // Returns the departure delay of a vehicle that has entered the network in the present step, s.
    double delay_of_entry_s(const State& state, const Passage& passage) const {
        const LaneBlock& block = state.blocks[at(passage.to_lane)];
        for (int slot = block.first; slot < block.past_last(); ++slot) {
            if (state.vehicles.id[at(slot)] != passage.vehicle) continue;
            return departure_delay_s(model_, state.vehicles.itinerary_of(at(slot)).trip, state.tick);
        }
        return 0.0;
    }

    void add_instant(const State& state) {
        RunFacts::Instant instant{model_.time_s(state.tick)};
        double speeds_mps = 0.0;
        for (const LaneBlock& block : state.blocks) {
            for (int slot = block.first; slot < block.past_last(); ++slot) {
                const double speed_mps = state.vehicles.speed_mps[at(slot)];
                speeds_mps += speed_mps;
                instant.stopped += speed_mps < kStoppedSpeed_mps ? 1 : 0;
                ++instant.present;
            }
        }
        for (const std::vector<int>& trips : state.insertion.waiting_trips)
            instant.backlog += static_cast<int>(trips.size());
        instant.mean_speed_mps = instant.present > 0 ? speeds_mps / instant.present : 0.0;
        facts_.instants.push_back(instant);
    }

    const Model& model_;
    std::vector<std::string> stop_lines_;  // [lane] name of its stop line; "": its passages are not counted
    RunFacts& facts_;
    std::int64_t ticks_per_second_;
    std::size_t next_passage_ = 0;
    std::size_t next_crossing_ = 0;
    struct Entry {
        double time_s = 0.0;
        double departure_delay_s = 0.0;
    };
    std::unordered_map<int, Entry> entries_;  // [vehicle]
};

void read_passages(const std::filesystem::path& file, RunFacts& facts) {
    const SumoXml loops(file, {"instantE1"});
    const std::string suffix = " stop_line";
    for (const pugi::xml_node event : loops.root().children("instantOut")) {
        if (loops.text(event, "state") != "enter") continue;
        std::string lane = loops.text(event, "id");
        if (lane.ends_with(suffix)) lane.resize(lane.size() - suffix.size());
        facts.passed_s[lane].push_back(loops.number(event, "time"));
    }
}

}  // namespace

std::unique_ptr<RunWriter> make_facts_writer(const Model& model, std::vector<std::string> stop_lines, RunFacts& facts) {
    return std::make_unique<FactsWriter>(model, std::move(stop_lines), facts);
}

RunSummary summary_of(const RunFacts& facts, double from_s, double to_s) {
    const auto within = [&](double time_s) { return time_s > from_s && time_s <= to_s; };
    const double hours = (to_s - from_s) / kSecondsPerHour;
    RunSummary summary;
    int trips = 0;
    for (const RunFacts::Trip& trip : facts.trips) {
        if (!within(trip.arrival_s)) continue;
        ++trips;
        summary.travel_time_s += trip.duration_s;
        summary.departure_delay_s += trip.departure_delay_s;
    }
    int passages = 0;
    for (const auto& [lane, times_s] : facts.passed_s) {
        for (const double time_s : times_s) passages += within(time_s) ? 1 : 0;
    }
    int instants = 0;
    // The mean speed is averaged over these instants only. SUMO writes -1 as mean speed if the network is empty.
    int instants_with_vehicles = 0;
    for (const RunFacts::Instant& instant : facts.instants) {
        if (!within(instant.time_s)) continue;
        ++instants;
        summary.stopped += instant.stopped;
        summary.backlog = instant.backlog;
        if (instant.present == 0) continue;
        ++instants_with_vehicles;
        summary.speed_mps += instant.mean_speed_mps;
    }
    const double nan = std::nan("");
    summary.throughput_veh_h = trips / hours;
    summary.passages_veh_h = passages / hours;
    summary.travel_time_s = trips > 0 ? summary.travel_time_s / trips : nan;
    summary.departure_delay_s = trips > 0 ? summary.departure_delay_s / trips : nan;
    summary.speed_mps = instants_with_vehicles > 0 ? summary.speed_mps / instants_with_vehicles : nan;
    summary.stopped = instants > 0 ? summary.stopped / instants : nan;
    return summary;
}

RunFacts read_sumo_facts(const std::filesystem::path& folder, bool has_loops) {
    RunFacts facts;
    const SumoXml trips(folder / "trips.out.xml", {"tripinfos"});
    for (const pugi::xml_node trip : trips.root().children("tripinfo")) {
        facts.trips.push_back(
            {trips.number(trip, "arrival"), trips.number(trip, "duration"), trips.number(trip, "departDelay")});
    }
    if (has_loops) read_passages(folder / "detectors.out.xml", facts);
    const SumoXml summary(folder / "summary.out.xml", {"summary"});
    for (const pugi::xml_node step : summary.root().children("step")) {
        facts.instants.push_back({summary.number(step, "time"), summary.whole_number(step, "running"),
                                  summary.whole_number(step, "halting"), summary.number(step, "meanSpeed"),
                                  summary.whole_number(step, "waiting")});
        facts.teleported = summary.whole_number(step, "teleports");
    }
    return facts;
}

}  // namespace stopline

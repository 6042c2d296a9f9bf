#include "sumo/facts.h"

#include <algorithm>
#include <cmath>
#include <unordered_map>
#include <utility>

#include "network/sumo_xml.h"

namespace stopline {

namespace {

constexpr double kHalts_mps = 0.1;  // SUMO's limit
constexpr double kHour_s = 3600.0;

std::size_t at(int index) { return static_cast<std::size_t>(index); }

class FactsWriter : public RunWriter {
public:
    FactsWriter(const Model& model, std::vector<std::string> stop_lines, RunFacts& facts)
        : model_(model), stop_lines_(std::move(stop_lines)), facts_(facts), every_(to_ticks(1.0, model.step_s)) {}

    void look(const State& state) override {
        note_passages(state);
        if (state.tick % every_ == 0) note_instant(state);
        facts_.moved_on = state.hindrance.taken_out;  // those that strayed are among them
    }
    std::string finish() override { return ""; }

private:
    // Who enters comes from lane -1, who leaves goes to -1.
    void note_passages(const State& state) {
        for (; seen_ < state.passages.size(); ++seen_) {
            const Passage& passage = state.passages[seen_];
            if (passage.from_lane < 0) {
                entered_[passage.vehicle] = {passage.time_s, delay_s(state, passage)};
            } else if (passage.to_lane < 0) {
                const auto entered = entered_.find(passage.vehicle);
                const Entry from = entered == entered_.end() ? Entry{} : entered->second;
                facts_.trips.push_back({passage.time_s, passage.time_s - from.time_s, from.delay_s});
                if (entered != entered_.end()) entered_.erase(entered);
            }
        }
        for (; crossed_ < state.crossings.size(); ++crossed_) {
            const Crossing& crossing = state.crossings[crossed_];
            const Detector& detector = model_.detectors[at(crossing.detector)];
            if (detector.kind != Detector::Kind::stop_line || stop_lines_[at(detector.lane)].empty()) continue;
            facts_.passed_s[stop_lines_[at(detector.lane)]].push_back(crossing.time_s);
        }
    }

    // Who is due in a step and finds room has entered at its end.
    double delay_s(const State& state, const Passage& passage) const {
        const LaneBlock& block = state.blocks[at(passage.to_lane)];
        for (int slot = block.first; slot < block.stop(); ++slot) {
            if (state.vehicles.id[at(slot)] != passage.vehicle) continue;
            const int trip = state.vehicles.record[at(slot)].trip;
            if (trip < 0) break;
            return std::max(passage.time_s - model_.demand.trips[at(trip)].depart_s - model_.step_s, 0.0);
        }
        return 0.0;
    }

    void note_instant(const State& state) {
        RunFacts::Instant now{model_.time_s(state.tick)};
        double speeds_mps = 0.0;
        for (const LaneBlock& block : state.blocks) {
            for (int slot = block.first; slot < block.stop(); ++slot) {
                const double speed_mps = state.vehicles.speed_mps[at(slot)];
                speeds_mps += speed_mps;
                now.halting += speed_mps < kHalts_mps ? 1 : 0;
                ++now.present;
            }
        }
        for (const std::vector<int>& trips : state.waiting_trips) now.waiting += static_cast<int>(trips.size());
        now.mean_speed_mps = now.present > 0 ? speeds_mps / now.present : 0.0;
        facts_.instants.push_back(now);
    }

    const Model& model_;
    std::vector<std::string> stop_lines_;  // [lane]
    RunFacts& facts_;
    std::int64_t every_;
    std::size_t seen_ = 0;
    std::size_t crossed_ = 0;
    struct Entry {
        double time_s = 0.0;
        double delay_s = 0.0;
    };
    std::unordered_map<int, Entry> entered_;  // by vehicle
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
    const double hours = (to_s - from_s) / kHour_s;
    RunSummary sum;
    int trips = 0;
    for (const RunFacts::Trip& trip : facts.trips) {
        if (!within(trip.arrival_s)) continue;
        ++trips;
        sum.travel_time_s += trip.duration_s;
        sum.delay_s += trip.delay_s;
    }
    int passages = 0;
    for (const auto& [lane, times_s] : facts.passed_s) {
        for (const double time_s : times_s) passages += within(time_s) ? 1 : 0;
    }
    int instants = 0;
    int driven = 0;  // of them, with vehicles: SUMO writes a mean speed of -1 where there are none
    for (const RunFacts::Instant& instant : facts.instants) {
        if (!within(instant.time_s)) continue;
        ++instants;
        sum.halting += instant.halting;
        sum.waiting = instant.waiting;
        if (instant.present == 0) continue;
        ++driven;
        sum.speed_mps += instant.mean_speed_mps;
    }
    const double nan = std::nan("");
    sum.throughput_veh_h = trips / hours;
    sum.passages_veh_h = passages / hours;
    sum.travel_time_s = trips > 0 ? sum.travel_time_s / trips : nan;
    sum.delay_s = trips > 0 ? sum.delay_s / trips : nan;
    sum.speed_mps = driven > 0 ? sum.speed_mps / driven : nan;
    sum.halting = instants > 0 ? sum.halting / instants : nan;
    return sum;
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
        facts.instants.push_back({summary.number(step, "time"), summary.whole(step, "running"),
                                  summary.whole(step, "halting"), summary.number(step, "meanSpeed"),
                                  summary.whole(step, "waiting")});
        facts.moved_on = summary.whole(step, "teleports");
    }
    return facts;
}

}  // namespace stopline

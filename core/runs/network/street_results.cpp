#include "runs/network/street_results.h"

#include <fmt/format.h>

#include "base/io/csv.h"
#include "base/nan.h"
#include "base/units.h"
#include "scenario/make_network.h"

namespace stopline {

namespace {

std::size_t index_of(Turn turn) { return static_cast<std::size_t>(turn); }

// Returns the share of one movement among right, left and straight on, %; NaN if there is no vehicle.
double share_percent(const std::array<std::int64_t, kMaxTurns>& turned, Turn turn) {
    const std::int64_t all =
        turned[index_of(Turn::straight)] + turned[index_of(Turn::right)] + turned[index_of(Turn::left)];
    return all == 0 ? kNan : 100.0 * static_cast<double>(turned[index_of(turn)]) / static_cast<double>(all);
}

}  // namespace

std::string inflow_csv(const NetworkReport& report) {
    CsvWriter csv({"population", "from_s", "west_veh_h", "south_veh_h", "east_veh_h", "north_veh_h"});
    const double hours = report.scenario.measure.interval_s / kSecondsPerHour;
    for (const NetworkResult& f : report.populations) {
        for (std::size_t k = 0; k < f.inflow.size(); ++k) {
            std::vector<std::string> row{f.population, fixed(static_cast<double>(k) * hours * kSecondsPerHour, 0)};
            for (const int vehicles : f.inflow[k]) row.push_back(fixed(vehicles / hours, 1));
            csv.row(row);
        }
    }
    return csv.text();
}

std::string approaches_csv(const NetworkReport& report) {
    CsvWriter csv({"population", "approach", "from_s", "vehicles", "speed_kmh", "upstream_speed_kmh"});
    for (const NetworkResult& f : report.populations) {
        for (const ApproachSeries& approach : f.congestion.approaches) {
            for (std::size_t k = 0; k < approach.intervals.size(); ++k) {
                const ApproachInterval& interval = approach.intervals[k];
                csv.row({f.population, approach.name, fixed(static_cast<double>(k) * f.congestion.interval_s, 0),
                         fixed(interval.vehicles, 2), fixed(kKmhPerMps * interval.speed_mps, 2),
                         fixed(kKmhPerMps * interval.upstream_speed_mps, 2)});
            }
        }
    }
    return csv.text();
}

std::string turns_csv(const NetworkReport& report) {
    CsvWriter csv({"population", "approach", "vehicles", "right_percent", "right_target_percent", "left_percent",
                   "left_target_percent", "congested_from_s", "departure_delay_mean_s", "departure_delay_max_s"});
    const LaneGraph graph = make_network(report.scenario.network);
    for (const NetworkResult& f : report.populations) {
        for (std::size_t k = 0; k < f.turn_counts.size(); ++k) {
            const Approach& approach = graph.approaches[k];
            const auto& turned = f.turn_counts[k];
            const DepartureDelays& departure = f.approach_departures[k];
            csv.row({f.population, approach.name,
                     std::to_string(turned[index_of(Turn::straight)] + turned[index_of(Turn::right)] +
                                    turned[index_of(Turn::left)]),
                     fixed(share_percent(turned, Turn::right), 2), fixed(100.0 * approach.right_share, 2),
                     fixed(share_percent(turned, Turn::left), 2), fixed(100.0 * approach.left_share, 2),
                     fixed(f.congestion.congested_from_s(k).value_or(kNan), 0), fixed(departure.mean_s(), 3),
                     fixed(departure.vehicles > 0 ? departure.max_s : kNan, 3)});
        }
    }
    return csv.text();
}

}  // namespace stopline

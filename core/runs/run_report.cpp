#include "runs/run_report.h"

#include <fmt/format.h>

#include "runs/driving/driving_csv.h"
#include "runs/hcm/hcm_sampler.h"
#include "runs/hcm/hcm_tables.h"
#include "runs/network/street_results.h"
#include "runs/run_kind.h"
#include "runs/single_light/single_light_csv.h"
#include "runs/v2v_results.h"
#include "scenario/kinds/network_kind.h"

namespace stopline {

namespace {

// Adds the table of changes between the modes of V2V if a channel is active.
void add_v2v(const std::vector<PopulationV2v>& populations, std::vector<NamedText>& tables) {
    if (std::string text = v2v_modes_csv(populations); !text.empty())
        tables.emplace_back("v2v_modes.csv", std::move(text));
}

// Adds the tables of energy, comfort and safety that the scenario asks for.
void add_driving(const std::vector<PopulationDriving>& populations, std::vector<NamedText>& tables) {
    if (std::string text = energy_csv(populations); !text.empty()) tables.emplace_back("energy.csv", std::move(text));
    if (std::string text = safety_distributions_csv(populations); !text.empty())
        tables.emplace_back("safety_distributions.csv", std::move(text));
}

// Adds the tables of the report by the Highway Capacity Manual if the scenario asks for it.
template <class Result>
void add_hcm(const Scenario& scenario, const std::vector<Result>& results, std::vector<NamedText>& tables) {
    if (!asks_for_hcm(scenario)) return;
    tables.emplace_back("hcm.csv", hcm_csv(hcm_of(results)));
    tables.emplace_back("hcm_headways.csv", hcm_headways_csv(hcm_of(results)));
}

}  // namespace

std::vector<NamedText> result_tables(const SingleLightReport& report) {
    std::vector<NamedText> tables{{"summary.csv", summary_csv(report)},
                                  {"improvement.csv", improvement_csv(report)},
                                  {"passages.csv", passages_csv(report)}};
    add_v2v(v2v_of(report.runs), tables);
    add_driving(driving_of(report.runs), tables);
    add_hcm(report.scenario, report.runs, tables);
    return tables;
}

std::vector<NamedText> result_tables(const IntersectionReport& report) {
    std::vector<NamedText> tables{{"summary.csv", intersection_csv(report)},
                                  {"headways.csv", headways_csv(report)},
                                  {"starvations.csv", starvations_csv(report.starvations(), report.lanes)}};
    add_v2v(v2v_of(report.populations), tables);
    add_driving(driving_of(report.populations), tables);
    add_hcm(report.scenario, report.populations, tables);
    return tables;
}

std::vector<NamedText> result_tables(const NetworkReport& report) {
    std::vector<NamedText> tables{{"summary.csv", network_csv(report)},
                                  {"series.csv", network_series_csv(report)},
                                  {"origin_destination.csv", origin_destination_csv(report)},
                                  {"delays.csv", delays_csv(report)},
                                  {"lane_delays.csv", lane_delays_csv(report)},
                                  {"gridlocks.csv", gridlocks_csv(report)},
                                  {"starvations.csv", starvations_csv(report.starvations(), report.lanes)},
                                  {"rules.csv", rules_csv(report)}};
    add_v2v(v2v_of(report.populations), tables);
    add_driving(driving_of(report.populations), tables);
    add_hcm(report.scenario, report.populations, tables);
    if (network_kind(report.scenario.network).reports_approaches) {
        tables.emplace_back("inflow.csv", inflow_csv(report));
        tables.emplace_back("approaches.csv", approaches_csv(report));
        tables.emplace_back("turns.csv", turns_csv(report));
    }
    if (report.scenario.measure.time_space_s > 0.0)
        tables.emplace_back("time_space.csv", street_time_space_csv(report));
    return tables;
}

std::string state_hash_text(std::uint64_t hash) { return fmt::format("{:016x}", hash); }

RunReport run_report(const Scenario& scenario, int threads, const std::function<bool(double)>& on_progress) {
    const std::string_view kind = run_kind(scenario).name;
    if (kind == kRunAsSingleLight) {
        SingleLightOptions options;
        options.threads = threads;
        options.on_progress = on_progress;
        const SingleLightReport report = run_single_light(scenario, options);
        return {result_tables(report), state_hashes(report.runs), report.no_violations()};
    }
    if (kind == kRunAsIntersection) {
        const IntersectionReport report = run_intersections(scenario, {threads, 0.0, on_progress});
        return {result_tables(report), state_hashes(report.populations),
                report.no_violations() && report.no_starvation()};
    }
    const NetworkReport report = run_networks(scenario, {threads, on_progress});
    return {result_tables(report), state_hashes(report.populations), report.no_violations() && report.no_starvation()};
}

}  // namespace stopline

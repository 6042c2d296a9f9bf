#include "calibration/calibration.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <map>

#include <fmt/format.h>

#include "base/containers/index.h"
#include "base/input_error.h"
#include "base/io/csv.h"
#include "base/nearest_name.h"
#include "scenario/build_model.h"

namespace stopline {

namespace {

// Returns the index of the population `name`, or the last index if there is none with this name.
std::size_t index_of_population(const Scenario& scenario, const std::string& name) {
    std::size_t k = 0;
    while (k + 1 < scenario.populations.size() && scenario.populations[k].name != name) ++k;
    return k;
}

// Returns the end of a message about an unknown name: the most similar name, and some known names. Each name is in
// quotes, because the names of permutations contain commas.
std::string quoted_names_hint(const std::string& name, const std::vector<std::string>& known) {
    constexpr std::size_t kListedMax = 10;
    std::vector<std::string> listed = known;
    if (listed.size() > kListedMax) listed.resize(kListedMax);
    const std::size_t left = known.size() - listed.size();
    const std::string more = left > 0 ? fmt::format(" and {} more", left) : "";
    const std::string nearest = nearest_name(name, known);
    return fmt::format("{} '{}'{}", nearest.empty() ? "; known:" : fmt::format("; did you mean '{}'? Known:", nearest),
                       joined(listed, "', '"), more);
}

bool is_in(const CalibrationCase& c, CaseSubset subset) {
    return subset == CaseSubset::all || c.fit.held_out == (subset == CaseSubset::held_out);
}

// Returns the axis values and the seed of a run as text. The text omits the seed if the sweep has only one seed.
std::string permutation_text(const Sweep& sweep, std::size_t point) {
    const std::string text = sweep.describe(point);
    return sweep.settings().repetitions > 1 ? text : text.substr(0, text.rfind(", seed"));
}

double cycle_of(const Scenario& scenario) { return scenario.nominal_cycle().cycle_s; }

// Returns, as text, the cause of the differences at one detector. If no pair of passages differs by more than the
// limit, there are only unpaired passages. If the largest difference is half a cycle or more, a vehicle passed in
// another green than in full dynamics. If it is smaller, the vehicle passed in the same green, but earlier or later.
std::string cause_of(const TimingMiss& miss, double cycle_s) {
    if (miss.pairs_beyond_limit == 0) return "one mode has more passages than the other";
    if (cycle_s > 0.0 && std::abs(miss.largest_s) >= 0.5 * cycle_s) {
        return fmt::format("vehicle {} passes one green {} than in full dynamics; its followers keep that shift",
                           miss.first_passage, miss.largest_s > 0.0 ? "later" : "earlier");
    }
    return miss.largest_s > 0.0 ? "the mesoscale vehicles are late" : "the mesoscale vehicles are early";
}

}  // namespace

std::vector<CalibrationCase> calibration_cases(const Sweep& sweep, const RunStore& full, const MesoSettings& settings) {
    constexpr std::size_t kHeldOut = 3;  // every third permutation is held out of the fit
    std::vector<CalibrationCase> cases;
    full.for_each_run([&](std::size_t point, const std::string& result) {
        CalibrationCase c;
        c.permutation = permutation_text(sweep, point);
        Scenario scenario = sweep.scenario(sweep.combination(point));
        scenario.seed = sweep.seed(point);
        scenario.fidelity = "meso";
        scenario.meso = settings;
        c.cycle_s = cycle_of(scenario);
        c.fit.model = build_model(scenario, index_of_population(scenario, sweep.population(point)));
        c.fit.reference = parse_detector_times(result, c.fit.model);
        c.fit.scenario = std::move(scenario);
        c.fit.held_out = point % kHeldOut == kHeldOut - 1;
        cases.push_back(std::move(c));
    });
    return cases;
}

TimingResult evaluate_timing(const std::string& name, const std::vector<CalibrationCase>& cases,
                             const MesoSettings& settings, int threads) {
    TimingResult result{name, settings, {}, {}, 0};
    std::vector<DetectorRun> runs(cases.size());
    const auto count = static_cast<int>(cases.size());
#pragma omp parallel for schedule(dynamic) num_threads(threads)
    for (int k = 0; k < count; ++k) runs[at(k)] = run_case(cases[at(k)].fit, settings);
    for (std::size_t k = 0; k < runs.size(); ++k) {
        result.pairs.push_back(pair_up(cases[k].fit.reference, runs[k].times));
        const Violations& v = runs[k].violations;
        result.violations.overlaps += v.overlaps;
        result.violations.conflicts += v.conflicts;
        result.violations.red_entries += v.red_entries;
        result.violations.lost_vehicles += std::abs(v.lost_vehicles);
        result.updates += runs[k].updates;
    }
    return result;
}

Agreement timing_agreement(const TimingResult& result, const std::vector<CalibrationCase>& cases, CaseSubset subset) {
    std::vector<PermutationPairs> pairs;
    for (std::size_t k = 0; k < cases.size(); ++k) {
        if (is_in(cases[k], subset)) pairs.push_back({&result.pairs[k], cases[k].cycle_s});
    }
    return agreement(pairs, kTimingLimit_s);
}

void check_accepted(const AcceptedFile& accepted, const Sweep& sweep) {
    if (accepted.accepted.empty()) return;
    std::vector<std::string> permutations;
    for (std::size_t point = 0; point < sweep.points(); ++point) permutations.push_back(permutation_text(sweep, point));
    for (std::size_t entry = 0; entry < accepted.accepted.size(); ++entry) {
        const AcceptedDifference& difference = accepted.accepted[entry];
        const auto check = [&](const std::string& place, const char* field, const std::string& name,
                               const std::vector<std::string>& known) {
            if (std::find(known.begin(), known.end(), name) != known.end()) return;
            throw InputError(fmt::format("{}: field 'accepted[{}].{}': there is no {} '{}'{}", place, entry, field,
                                         field, shortened(name), quoted_names_hint(name, known)));
        };
        check(difference.permutation_place, "permutation", difference.permutation, permutations);
        const auto found = std::find(permutations.begin(), permutations.end(), difference.permutation);
        const auto point = static_cast<std::size_t>(found - permutations.begin());
        const Scenario scenario = sweep.scenario(sweep.combination(point));
        const Model model = build_model(scenario, index_of_population(scenario, sweep.population(point)));
        std::vector<std::string> detectors;
        for (std::size_t k = 0; k < model.detectors.size(); ++k) detectors.push_back(detector_name(model, k));
        check(difference.detector_place, "detector", difference.detector, detectors);
    }
}

std::vector<TimingMiss> timing_misses(const TimingResult& result, const std::vector<CalibrationCase>& cases,
                                      const AcceptedFile& accepted) {
    std::vector<TimingMiss> misses;
    for (std::size_t k = 0; k < cases.size(); ++k) {
        std::map<int, TimingMiss> of_detector;
        for (const PassagePair& pair : result.pairs[k].pairs) {
            TimingMiss& miss =
                of_detector.try_emplace(pair.detector, TimingMiss{k, pair.detector, 0, 0, 0, 0.0, 0, "", ""})
                    .first->second;
            ++miss.pairs_compared;
            if (std::abs(pair.difference_s()) <= kTimingLimit_s) continue;
            if (miss.pairs_beyond_limit++ == 0) miss.first_passage = pair.k + 1;
            if (std::abs(pair.difference_s()) > std::abs(miss.largest_s)) miss.largest_s = pair.difference_s();
        }
        for (const auto& [detector, unpaired] : result.pairs[k].unpaired) {
            of_detector.try_emplace(detector, TimingMiss{k, detector, 0, 0, 0, 0.0, 0, "", ""}).first->second.unpaired =
                unpaired;
        }
        for (auto& [detector, miss] : of_detector) {
            if (miss.pairs_beyond_limit == 0 && miss.unpaired == 0) continue;
            miss.cause = cause_of(miss, cases[k].cycle_s);
            const std::string name = detector_name(cases[k].fit.model, at(detector));
            for (const AcceptedDifference& a : accepted.accepted) {
                if (a.permutation == cases[k].permutation && a.detector == name) miss.accepted = a.reason;
            }
            misses.push_back(miss);
        }
    }
    return misses;
}

double valid_share(const TimingResult& result, const std::vector<CalibrationCase>& cases,
                   const std::vector<TimingMiss>& misses, CaseSubset subset) {
    const Agreement objective = timing_agreement(result, cases, subset);
    const auto all = static_cast<double>(objective.pairs + objective.unpaired);
    double valid = objective.within_share * all;
    for (const TimingMiss& miss : misses) {
        if (!miss.accepted.empty() && is_in(cases[miss.permutation], subset))
            valid += miss.pairs_beyond_limit + miss.unpaired;
    }
    return all > 0.0 ? valid / all : 0.0;
}

std::string differences_csv(const TimingResult& result, const std::vector<CalibrationCase>& cases) {
    CsvWriter csv({"permutation", "held_out", "detector", "passage", "full_s", "meso_s", "difference_s"});
    for (std::size_t k = 0; k < cases.size(); ++k) {
        for (const PassagePair& pair : result.pairs[k].pairs) {
            csv.row({cases[k].permutation, cases[k].fit.held_out ? "1" : "0",
                     detector_name(cases[k].fit.model, at(pair.detector)), fmt::format("{}", pair.k + 1),
                     fixed(pair.reference_s, 3), fixed(pair.other_s, 3), fixed(pair.difference_s(), 3)});
        }
    }
    return csv.text();
}

std::string misses_csv(const std::vector<TimingMiss>& misses, const std::vector<CalibrationCase>& cases) {
    CsvWriter csv({"permutation", "held_out", "detector", "pairs_beyond_limit", "pairs", "unpaired", "first_passage",
                   "largest_difference_s", "cause", "accepted"});
    for (const TimingMiss& miss : misses) {
        const CalibrationCase& c = cases[miss.permutation];
        csv.row({c.permutation, c.fit.held_out ? "1" : "0", detector_name(c.fit.model, at(miss.detector)),
                 fmt::format("{}", miss.pairs_beyond_limit), fmt::format("{}", miss.pairs_compared),
                 fmt::format("{}", miss.unpaired), fmt::format("{}", miss.first_passage), fixed(miss.largest_s, 3),
                 miss.cause, miss.accepted});
    }
    return csv.text();
}

std::string permutations_csv(const std::vector<TimingResult>& results, const std::vector<CalibrationCase>& cases) {
    CsvWriter csv({"permutation", "held_out", "parameters", "pairs", "unpaired", "within_limit_percent",
                   "median_difference_s", "p95_difference_s", "largest_difference_s", "pairs_in_other_green"});
    for (std::size_t k = 0; k < cases.size(); ++k) {
        for (const TimingResult& result : results) {
            const PermutationPairs own{&result.pairs[k], cases[k].cycle_s};
            const Agreement a = agreement({&own, 1}, kTimingLimit_s);
            csv.row({cases[k].permutation, cases[k].fit.held_out ? "1" : "0", result.name, fmt::format("{}", a.pairs),
                     fmt::format("{}", a.unpaired), fixed(100.0 * a.within_share, 2), fixed(a.median_s, 3),
                     fixed(a.p95_s, 3), fixed(a.largest_s, 3), fmt::format("{}", a.other_green)});
        }
    }
    return csv.text();
}

std::string history_csv(const MesoFit& fit) {
    std::vector<std::string> columns{"evaluation", "search", "loss"};
    for (const FitParameter& p : fit_parameters()) columns.emplace_back(p.name);
    CsvWriter csv(columns);
    for (std::size_t k = 0; k < fit.history.size(); ++k) {
        const FitEvaluation& e = fit.history[k];
        std::vector<std::string> row{fmt::format("{}", k + 1), e.stage, fixed(e.loss, 6)};
        for (const double value : e.values) row.push_back(fixed(value, 4));
        csv.row(row);
    }
    return csv.text();
}

}  // namespace stopline

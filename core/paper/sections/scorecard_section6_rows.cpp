// Row functions of Section VI. They read the measurements that the experiments in scorecard_section6.cpp make.
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <string>

#include <fmt/format.h>

#include "paper/sections/scorecard_section6.h"
#include "paper/sections/scorecard_sections.h"
#include "runs/network/network_run.h"

namespace stopline {

using namespace section6;

namespace {

// Reads the measurements of a sweep. Returns NaN for a value that was not measured.
struct Reader {
    const Measurements& measured;

    double value(const char* quantity, const std::string& traffic, int green_s, int offset_s,
                 const char* population) const {
        return measured.find(std::string(quantity) + " " + point_name(traffic, green_s, offset_s, population))
            .value_or(std::numeric_limits<double>::quiet_NaN());
    }
    // Returns the throughput gain over CTG-Ref, percent.
    double gain(const std::string& traffic, int green_s, int offset_s, const char* population) const {
        return 100.0 * (value("throughput", traffic, green_s, offset_s, population) /
                            value("throughput", traffic, green_s, offset_s, "CTG-Ref") -
                        1.0);
    }
    // Returns the reduction of the travel time relative to CTG-Ref, percent.
    double saved(const std::string& traffic, int green_s, int offset_s, const char* population) const {
        return 100.0 * (1.0 - value("time", traffic, green_s, offset_s, population) /
                                  value("time", traffic, green_s, offset_s, "CTG-Ref"));
    }
};

template <class Greens, class Offsets, class Value>
double mean_over(const Greens& greens_s, const Offsets& offsets_s, Value value) {
    double sum = 0.0;
    int count = 0;
    for (const int green_s : greens_s) {
        for (const int offset_s : offsets_s) {
            sum += value(green_s, offset_s);
            ++count;
        }
    }
    return sum / count;
}

using MaybeAnswer = std::optional<Answer>;

MaybeAnswer from(const Measurements& measured, const std::string& name, double factor = 1.0, double offset = 0.0) {
    const std::optional<double> value = measured.find(name);
    return value ? MaybeAnswer(number_answer(factor * *value + offset)) : std::nullopt;
}

// Returns the length of a platoon of all n vehicles that pass the stop line in one green, m. Each vehicle is 5.15 m
// long, and the n - 1 gaps are 2.95 m long.
MaybeAnswer platoon_length(const Target&, const Measurements& m) { return from(m, "platoon_veh", 5.15 + 2.95, -2.95); }
MaybeAnswer synchronous(const Target&, const Measurements& m) { return from(m, "interspace 0 east"); }
MaybeAnswer with_wave(const Target&, const Measurements& m) { return from(m, "interspace 15 east"); }
MaybeAnswer against_wave(const Target&, const Measurements& m) { return from(m, "interspace 15 west"); }

MaybeAnswer no_turns(const Measurements& m, int green_s) {
    const std::optional<double> ctg = m.find(fmt::format("no_turns {} CTG-Ref", green_s));
    const std::optional<double> cdg = m.find(fmt::format("no_turns {} CDG", green_s));
    if (!ctg || !cdg) return std::nullopt;
    return number_answer(100.0 * (*cdg / *ctg - 1.0));
}
MaybeAnswer no_turns_25(const Target&, const Measurements& m) { return no_turns(m, 25); }
MaybeAnswer no_turns_35(const Target&, const Measurements& m) { return no_turns(m, 35); }

// Row functions that read the sweep of the arterial, and their helper functions.
double arterial_gain(const Reader& r, const char* population) {
    return mean_over(kArterialGreens_s, kArterialOffsets_s,
                     [&](int g, int o) { return r.gain("free", g, o, population); });
}
MaybeAnswer free_cdg(const Target&, const Measurements& m) { return number_answer(arterial_gain({m}, "CDG")); }
MaybeAnswer free_mix(const Target&, const Measurements& m) { return number_answer(arterial_gain({m}, "MIX")); }

MaybeAnswer saved_at(const Measurements& m, int offset_s) {
    const Reader r{m};
    const std::array<int, 1> offset{offset_s};
    const double cdg = mean_over(kArterialGreens_s, offset, [&](int g, int o) { return r.saved("free", g, o, "CDG"); });
    const double mix = mean_over(kArterialGreens_s, offset, [&](int g, int o) { return r.saved("free", g, o, "MIX"); });
    return range_answer(std::min(cdg, mix), std::max(cdg, mix));
}
MaybeAnswer saved_0(const Target&, const Measurements& m) { return saved_at(m, 0); }
MaybeAnswer saved_15(const Target&, const Measurements& m) { return saved_at(m, 15); }

MaybeAnswer peak_with_turns(const Target&, const Measurements& m) {
    const Reader r{m};
    return number_answer(std::max(r.gain("turns", 35, 0, "CDG"), r.gain("turns", 35, 15, "CDG")));
}

MaybeAnswer saved_range(const Target&, const Measurements& m) {
    const Reader r{m};
    double low = std::numeric_limits<double>::infinity();
    double high = -low;
    for (const int g : kArterialGreens_s) {
        for (const int o : kArterialOffsets_s) {
            low = std::min(low, r.saved("turns", g, o, "CDG"));
            high = std::max(high, r.saved("turns", g, o, "CDG"));
        }
    }
    return range_answer(low, high);
}

MaybeAnswer saved_mix_30(const Target&, const Measurements& m) {
    const Reader r{m};
    return number_answer(0.5 * (r.saved("turns", 30, 0, "MIX") + r.saved("turns", 30, 15, "MIX")));
}

MaybeAnswer minimum_at_30_15(const Target&, const Measurements& m) {
    const Reader r{m};
    double lowest = std::numeric_limits<double>::infinity();
    std::string where;
    for (const int g : kArterialGreens_s) {
        for (const int o : kArterialOffsets_s) {
            const double value = r.value("throughput", "free", g, o, "CDG");
            if (value >= lowest) continue;
            lowest = value;
            where = fmt::format("{}/{} s", g, o);
        }
    }
    return claim_answer(where == "30/15 s", fmt::format("minimum {:.0f} veh/h at {}", lowest, where));
}

MaybeAnswer cdg_keeps_rising(const Target&, const Measurements& m) {
    constexpr double kSaturated = 0.03;
    const Reader r{m};
    const auto mean = [&](int g, const char* population) {
        return 0.5 *
               (r.value("throughput", "turns", g, 0, population) + r.value("throughput", "turns", g, 15, population));
    };
    const bool rises = mean(25, "CDG") < mean(30, "CDG") && mean(30, "CDG") < mean(35, "CDG");
    const bool saturates = mean(35, "CTG-Ref") <= (1.0 + kSaturated) * mean(30, "CTG-Ref");
    return claim_answer(
        rises && saturates,
        fmt::format("CDG {:.0f}, {:.0f}, {:.0f}; CTG-Ref {:.0f}, {:.0f}, {:.0f} veh/h", mean(25, "CDG"),
                    mean(30, "CDG"), mean(35, "CDG"), mean(25, "CTG-Ref"), mean(30, "CTG-Ref"), mean(35, "CTG-Ref")));
}

// The paper claims that turns reduce the density to "about half". We accept 40 to 60 %.
MaybeAnswer density_halves(const Target&, const Measurements& m) {
    const Reader r{m};
    bool all = true;
    std::string text;
    for (const char* const population : {"CTG-Ref", "MIX", "CDG"}) {
        const auto mean = [&](const char* traffic) {
            return mean_over(kArterialGreens_s, kArterialOffsets_s,
                             [&](int g, int o) { return r.value("density", traffic, g, o, population); });
        };
        const double share = mean("turns") / mean("free");
        all = all && share > 0.4 && share < 0.6;
        text += fmt::format("{}{} {:.0f} %", text.empty() ? "" : ", ", population, 100.0 * share);
    }
    return claim_answer(all, text);
}

MaybeAnswer slowest_at_25_0(const Target&, const Measurements& m) {
    const Reader r{m};
    double highest = 0.0;
    std::string where;
    for (const int g : kArterialGreens_s) {
        for (const int o : kArterialOffsets_s) {
            const double value = r.value("time", "free", g, o, "CDG");
            if (value <= highest) continue;
            highest = value;
            where = fmt::format("{}/{} s", g, o);
        }
    }
    return claim_answer(where == "25/0 s", fmt::format("{:.0f} s at {}", highest, where));
}

// Row functions that read the sweep of the grid, and their helper functions.
double grid_gain(const Reader& r, const char* traffic, int green_s, const char* population) {
    return mean_over(std::array{green_s}, kGridOffsets_s,
                     [&](int g, int o) { return r.gain(traffic, g, o, population); });
}
double grid_mean(const Reader& r, const char* quantity, const char* traffic, int green_s, const char* population) {
    return mean_over(std::array{green_s}, kGridOffsets_s,
                     [&](int g, int o) { return r.value(quantity, traffic, g, o, population); });
}

MaybeAnswer grid_10(const Target&, const Measurements& m) { return number_answer(grid_gain({m}, "free", 10, "CDG")); }
MaybeAnswer grid_20(const Target&, const Measurements& m) { return number_answer(grid_gain({m}, "free", 20, "CDG")); }
MaybeAnswer grid_time(const Measurements& m, int green_s) {
    return number_answer(grid_mean({m}, "time", "free", green_s, "CTG-Ref") / 60.0);
}
MaybeAnswer grid_time_5(const Target&, const Measurements& m) { return grid_time(m, 5); }
MaybeAnswer grid_time_20(const Target&, const Measurements& m) { return grid_time(m, 20); }

MaybeAnswer turns_cost(const Target&, const Measurements& m) {
    const Reader r{m};
    return number_answer(mean_over(kGridGreens_s, kGridOffsets_s, [&](int g, int o) {
        return 100.0 *
               (r.value("throughput", "turns", g, o, "CTG-Ref") / r.value("throughput", "free", g, o, "CTG-Ref") - 1.0);
    }));
}
MaybeAnswer grid_mix(const Target&, const Measurements& m) {
    const Reader r{m};
    return number_answer(
        mean_over(kGridGreens_s, kGridOffsets_s, [&](int g, int o) { return r.gain("turns", g, o, "MIX"); }));
}
MaybeAnswer before_drop(const Target&, const Measurements& m) {
    const Reader r{m};
    return number_answer(
        mean_over(std::array{5, 10}, kGridOffsets_s, [&](int g, int o) { return r.gain("turns", g, o, "CDG"); }));
}
MaybeAnswer after_drop(const Target&, const Measurements& m) {
    const Reader r{m};
    return number_answer(
        mean_over(std::array{15, 20}, std::array{0}, [&](int g, int o) { return r.gain("turns", g, o, "CDG"); }));
}
MaybeAnswer mix_beats_cdg(const Target&, const Measurements& m) {
    const Reader r{m};
    const double mix = r.value("throughput", "turns", 20, 0, "MIX");
    const double cdg = r.value("throughput", "turns", 20, 0, "CDG");
    return claim_answer(mix > cdg, fmt::format("MIX {:.0f}, CDG {:.0f} veh/h", mix, cdg));
}
// The paper claims a dent in throughput at 15 s of green. We accept a value below the straight line between the values
// at 10 s and 20 s.
MaybeAnswer dent(const Target&, const Measurements& m) {
    const Reader r{m};
    const auto at = [&](int g) { return grid_mean(r, "throughput", "free", g, "CDG"); };
    return claim_answer(at(15) < 0.5 * (at(10) + at(20)),
                        fmt::format("{:.0f}, {:.0f}, {:.0f} veh/h at 10, 15, 20 s", at(10), at(15), at(20)));
}
// The paper claims that the offset has "no notable influence" on throughput. We accept a difference of up to 5 %
// between the lowest and the highest throughput over all offsets, at the same population and green time.
MaybeAnswer offset_no_influence(const Target&, const Measurements& m) {
    constexpr double kNotable = 0.05;
    const Reader r{m};
    double highest = 0.0;
    std::string where;
    for (const char* const population : {"CTG-Ref", "MIX", "CDG"}) {
        for (const int g : kGridGreens_s) {
            double low = std::numeric_limits<double>::infinity();
            double high = 0.0;
            for (const int o : kGridOffsets_s) {
                const double value = r.value("throughput", "free", g, o, population);
                low = std::min(low, value);
                high = std::max(high, value);
            }
            if (high / low - 1.0 <= highest) continue;
            highest = high / low - 1.0;
            where = fmt::format("{} at {} s", population, g);
        }
    }
    return claim_answer(highest <= kNotable, fmt::format("at most {:.1f} % apart ({})", 100.0 * highest, where));
}
MaybeAnswer time_rises(const Target&, const Measurements& m) {
    const Reader r{m};
    bool holds = true;
    std::string text;
    for (const int g : kGridGreens_s) {
        const double saved =
            100.0 * (1.0 - grid_mean(r, "time", "free", g, "CDG") / grid_mean(r, "time", "free", g, "CTG-Ref"));
        holds = holds && (g <= 10 ? saved > 0.0 : saved < 0.0);
        text += fmt::format("{}{:.0f} % at {} s", text.empty() ? "saved " : ", ", saved, g);
    }
    return claim_answer(holds, text);
}

// Row functions that read the stability sweep, and their helper functions.
std::string stability_name(const Reader& r, const std::string& traffic, int green_s, int offset_s,
                           const char* population) {
    const double value = r.value("stability", traffic, green_s, offset_s, population);
    return std::isnan(value) ? "?" : kStabilityNames[static_cast<std::size_t>(value)];
}
MaybeAnswer cdg_unstable(const Target&, const Measurements& m) {
    const Reader r{m};
    std::string text;
    bool holds = true;
    for (const char* const population : {"CTG-Ref", "MIX", "CDG"}) {
        const std::string name = stability_name(r, "saturated_5", 20, 0, population);
        holds = holds && (name == (std::string(population) == "CDG" ? "unstable" : "stable"));
        text += fmt::format("{}{} {}", text.empty() ? "" : ", ", population, name);
    }
    return claim_answer(holds, text);
}
MaybeAnswer ctg_unstable_too(const Target&, const Measurements& m) {
    const Reader r{m};
    bool holds = true;
    std::string text;
    for (const int o : {0, 15}) {
        for (const int g : {10, 20, 30}) {
            const std::string name = stability_name(r, "saturated_10", g, o, "CTG-Ref");
            holds = holds && ((name == "stable") == (o == 0 && g < 30));
            text += fmt::format("{}{}/{} s {}", text.empty() ? "" : ", ", g, o, name);
        }
    }
    return claim_answer(holds, text);
}
// Rates each combination of green time and offset: 0 (stable), 1 (semi-stable) or 2 (unstable). The claim holds if the
// sum of the ratings is smaller for CDG than for CTG-Ref.
MaybeAnswer cdg_more_stable(const Target&, const Measurements& m) {
    const Reader r{m};
    const auto sum = [&](const char* population) {
        return 6.0 * mean_over(std::array{10, 20, 30}, std::array{0, 15},
                               [&](int g, int o) { return r.value("stability", "rate_10", g, o, population); });
    };
    return claim_answer(
        sum("CDG") < sum("CTG-Ref"),
        fmt::format("CDG {:.0f}, CTG-Ref {:.0f} of 12 points of instability", sum("CDG"), sum("CTG-Ref")));
}
MaybeAnswer semi_stable_limit(const Target&, const Measurements&) { return number_answer(100.0 * kSemiStableShare); }

}  // namespace

std::span<const RowJudge> section6_rows() {
    static const std::array kRows{RowJudge{"A01", kPlatoons, platoon_length},
                                  RowJudge{"A02", kPlatoons, synchronous},
                                  RowJudge{"A03", kPlatoons, with_wave},
                                  RowJudge{"A04", kPlatoons, against_wave},
                                  RowJudge{"A05", kArterial, free_cdg},
                                  RowJudge{"A06", kArterial, free_mix},
                                  RowJudge{"A07", kPlatoons, no_turns_25},
                                  RowJudge{"A08", kPlatoons, no_turns_35},
                                  RowJudge{"A09", kArterial, saved_0},
                                  RowJudge{"A10", kArterial, saved_15},
                                  RowJudge{"A11", kArterial, peak_with_turns},
                                  RowJudge{"A12", kArterial, saved_range},
                                  RowJudge{"A13", kArterial, saved_mix_30},
                                  RowJudge{"A14", kArterial, minimum_at_30_15},
                                  RowJudge{"A15", kArterial, cdg_keeps_rising},
                                  RowJudge{"A16", kArterial, density_halves},
                                  RowJudge{"A17", kArterial, slowest_at_25_0},
                                  RowJudge{"G01", kGrid, grid_10},
                                  RowJudge{"G02", kGrid, grid_20},
                                  RowJudge{"G03", kGrid, grid_time_5},
                                  RowJudge{"G04", kGrid, grid_time_20},
                                  RowJudge{"G05", kGrid, turns_cost},
                                  RowJudge{"G06", kGrid, grid_mix},
                                  RowJudge{"G07", kGrid, before_drop},
                                  RowJudge{"G08", kGrid, after_drop},
                                  RowJudge{"G09", kGrid, mix_beats_cdg},
                                  RowJudge{"G10", kGrid, dent},
                                  RowJudge{"G11", kGrid, offset_no_influence},
                                  RowJudge{"G12", kGrid, time_rises},
                                  RowJudge{"S01", kStability, cdg_unstable},
                                  RowJudge{"S02", kStability, ctg_unstable_too},
                                  RowJudge{"S03", kStability, cdg_more_stable},
                                  RowJudge{"S04", kStability, semi_stable_limit}};
    return kRows;
}

}  // namespace stopline

#include "figures/studies/turn_figures.h"

#include <algorithm>
#include <array>
#include <limits>
#include <map>
#include <optional>
#include <tuple>

#include <fmt/format.h>

#include "base/io/csv.h"
#include "runs/metrics/metric_groups.h"

namespace stopline {

namespace {

// The metrics of the panels: the beginnings of the names of their columns.
constexpr std::array kMetrics{"throughput", "travel_time", "density_network"};

constexpr std::size_t kNone = std::numeric_limits<std::size_t>::max();

// Returns the index of the first column whose name starts with `prefix`, or kNone.
std::size_t column_named(const CsvTable& results, const std::string& prefix) {
    for (std::size_t k = 0; k < results.columns.size(); ++k) {
        if (results.columns[k].starts_with(prefix)) return k;
    }
    return kNone;
}

struct Turns {
    double left;
    double right;
    auto operator<=>(const Turns&) const = default;
};

// Means over the runs (rows of the results table) that differ only in their seed.
class Means {
public:
    explicit Means(const CsvTable& results) {
        const std::size_t green = column_named(results, "green");
        const std::size_t left = column_named(results, "left");
        const std::size_t right = column_named(results, "right");
        const std::size_t population = column_named(results, "population");
        for (const std::vector<std::string>& row : results.rows) {
            const Turns turns{parse_number(row[left]).value_or(0.0), parse_number(row[right]).value_or(0.0)};
            const double green_s = parse_number(row[green]).value_or(0.0);
            if (std::find(populations.begin(), populations.end(), row[population]) == populations.end()) {
                populations.push_back(row[population]);
            }
            if (std::find(greens_s.begin(), greens_s.end(), green_s) == greens_s.end()) greens_s.push_back(green_s);
            if (std::find(turns_.begin(), turns_.end(), turns) == turns_.end()) turns_.push_back(turns);
            for (const char* const metric : kMetrics) {
                const std::optional<double> value = parse_number(row[column_named(results, metric)]);
                if (!value) continue;
                auto& [sum, count] = sums_[{metric, green_s, turns, row[population]}];
                sum += *value;
                ++count;
            }
        }
        std::sort(turns_.begin(), turns_.end());
    }

    std::optional<double> find(const char* metric, double green_s, const Turns& turns,
                               const std::string& population) const {
        const auto found = sums_.find({metric, green_s, turns, population});
        if (found == sums_.end()) return std::nullopt;
        return found->second.first / found->second.second;
    }

    const std::vector<Turns>& turns() const { return turns_; }
    std::vector<std::string> populations;
    std::vector<double> greens_s;

private:
    std::vector<Turns> turns_;
    std::map<std::tuple<std::string, double, Turns, std::string>, std::pair<double, int>> sums_;
};

// Returns the data of a figure: a row for each pair of turn ratios and a column for each population.
std::string data_of(const Means& means, const char* metric, double green_s) {
    std::string text = "# left/right in percent, then one column for each population\n";
    for (const Turns& turns : means.turns()) {
        text += fmt::format("{:g}/{:g}", turns.left, turns.right);
        for (const std::string& population : means.populations) {
            const std::optional<double> value = means.find(metric, green_s, turns, population);
            text += value ? fmt::format(" {:.6g}", *value) : " NaN";
        }
        text += "\n";
    }
    return text;
}

Figure figure_of(const CsvTable& results, const Means& means, double green_s) {
    Figure figure;
    figure.name = fmt::format("turns_green_{:g}", green_s);
    figure.width_px = 1000;
    figure.height_px = 1100;
    figure.body = fmt::format(
        "set multiplot layout 3,1 title 'Intersection over turn ratios, {:g} s of green'\nset xtics rotate by -35\nset yrange "
        "[0:*]\nset key outside right\nset lmargin 11\nset rmargin 18\n",
        green_s);
    for (const char* const metric : kMetrics) {
        const std::string file = fmt::format("{}_{}.dat", figure.name, metric);
        figure.data.emplace_back(file, data_of(means, metric, green_s));
        figure.body +=
            fmt::format("set ylabel {}\nset xlabel 'left turns / right turns [% of the vehicles of a lane]'\nplot ",
                        gnuplot_text(axis_title(results.columns[column_named(results, metric)])));
        for (std::size_t k = 0; k < means.populations.size(); ++k) {
            figure.body +=
                fmt::format("{}'{}' using {}:xtic(1) with linespoints lc rgb '{}' lw 2 pt {} ps 0.8 title {}",
                            k == 0 ? "" : ", ", file, k + 2, ordered_colour(k, means.populations.size()),
                            line_style(k).hollow_point, gnuplot_text(means.populations[k]));
        }
        figure.body += "\nunset key\n";
    }
    figure.body += "unset multiplot\n";
    return figure;
}

// Returns true if the sweep has an axis with several values other than green, left, right and population. The figures
// have no place for such an axis.
bool varies_another_axis(const CsvTable& results) {
    for (std::size_t k = 0; k < results.columns.size() && results.columns[k] != "seed"; ++k) {
        const std::string& column = results.columns[k];
        const auto is = [&](std::string_view prefix) { return column.starts_with(prefix); };
        if (column == "point" || is("green") || is("left") || is("right") || is("population")) continue;
        const auto differs = [&](const auto& row) { return row[k] != results.rows.front()[k]; };
        if (std::any_of(results.rows.begin(), results.rows.end(), differs)) return true;
    }
    return false;
}

}  // namespace

bool has_turns(const CsvTable& results) {
    const auto has = [&](const char* prefix) { return column_named(results, prefix) != kNone; };
    for (const char* const axis : {"green", "left", "right", "population"}) {
        if (!has(axis)) return false;
    }
    if (!std::all_of(kMetrics.begin(), kMetrics.end(), has)) return false;
    return !results.rows.empty() && !varies_another_axis(results);
}

std::vector<Figure> turn_figures(const CsvTable& results) {
    const Means means(results);
    std::vector<Figure> figures;
    figures.reserve(means.greens_s.size());
    for (const double green_s : means.greens_s) figures.push_back(figure_of(results, means, green_s));
    return figures;
}

std::string table1_csv(const CsvTable& results, const std::vector<Target>& targets) {
    const Means means(results);
    CsvWriter csv({"id", "population", "green_s", "left_percent", "right_percent", "paper_percent", "ours_percent",
                   "difference_percent"});
    for (const Target& target : targets) {
        if (target.section != "IV Table 1") continue;
        const std::optional<TurnCondition> condition = parse_turn_condition(target.condition);
        if (!condition) continue;
        const Turns turns{condition->left_percent, condition->right_percent};
        const std::optional<double> ours = means.find("throughput", condition->green_s, turns, condition->population);
        const std::optional<double> baseline = means.find("throughput", condition->green_s, turns, "CTG-Ref");
        const bool has_both = ours && baseline;
        const double gain = has_both ? 100.0 * (*ours / *baseline - 1.0) : std::numeric_limits<double>::quiet_NaN();
        csv.row({target.id, condition->population, fixed(condition->green_s, 0), fixed(turns.left, 0),
                 fixed(turns.right, 0), target.value, fixed(gain, 1),
                 fixed(gain - parse_number(target.value).value_or(0.0), 1)});
    }
    return csv.text();
}

namespace {

// Returns the share of CDG in a mixed population: 25 for "P25". Returns nothing for another name.
std::optional<double> percent_of(const std::string& population) {
    return population.starts_with("P") ? parse_number(population.substr(1)) : std::nullopt;
}

void add_step(const Means& means, double green_s, const std::string& population, const Turns& from, const Turns& to,
              ThroughputTrends& trends) {
    const std::optional<double> before = means.find("throughput", green_s, from, population);
    const std::optional<double> after = means.find("throughput", green_s, to, population);
    if (!before || !after) return;
    ++trends.steps;
    if (*after <= *before) return;
    ++trends.rises;
    const double percent = 100.0 * (*after / *before - 1.0);
    if (percent <= trends.largest_rise_percent) return;
    trends.largest_rise_percent = percent;
    trends.largest_rise = fmt::format("{}, green {:g} s, left/right {:g}/{:g} to {:g}/{:g} %", population, green_s,
                                      from.left, from.right, to.left, to.right);
}

}  // namespace

ThroughputTrends throughput_trends(const CsvTable& results) {
    const Means means(results);
    ThroughputTrends trends;
    const std::vector<Turns>& turns = means.turns();
    for (const double green_s : means.greens_s) {
        for (const Turns& from : turns) {
            // `right` has the same left turns as `from` and the next larger share of right turns. `left` has the same
            // right turns as `from` and the next larger share of left turns.
            const auto right = std::find_if(turns.begin(), turns.end(), [&](const Turns& t) {
                return t.left == from.left && t.right > from.right;
            });
            const auto left = std::find_if(turns.begin(), turns.end(),
                                           [&](const Turns& t) { return t.right == from.right && t.left > from.left; });
            for (const std::string& population : means.populations) {
                if (right != turns.end()) add_step(means, green_s, population, from, *right, trends);
                if (left != turns.end()) add_step(means, green_s, population, from, *left, trends);
                const std::optional<double> share = percent_of(population);
                const std::optional<double> none = means.find("throughput", green_s, from, "CTG-Ref");
                const std::optional<double> all = means.find("throughput", green_s, from, "CDG");
                const std::optional<double> here = means.find("throughput", green_s, from, population);
                if (!share || !none || !all || !here) continue;
                ++trends.points;
                if (*here > *none + 0.01 * *share * (*all - *none)) ++trends.above_line;
            }
        }
    }
    return trends;
}

}  // namespace stopline

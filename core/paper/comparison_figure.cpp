#include "paper/comparison_figure.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <optional>
#include <span>

#include <fmt/format.h>

#include "figures/population_style.h"
#include "paper/sections/scorecard_section6.h"

namespace stopline {

namespace {

constexpr std::array<int, 6> kSingleGreens_s{5, 10, 15, 20, 25, 30};

// Throughput gain over CTG-Ref at one green time, for the worst and for the best offset, percent.
struct Range {
    int green_s;
    double worst;
    double best;
};

struct Series {
    std::string name;  // name of the data file
    std::string title;
    std::string colour;  // of the population
    int point;           // gnuplot point type of the network
    bool band;           // true: draw the band between worst and best offset; false: draw a line
    std::vector<Range> values;
};

// Returns the throughput of a population (given by its name) at a green time and an offset, both in s. The unit of the
// throughput does not matter, because the gain is a ratio of two throughputs.
using Throughput = std::function<std::optional<double>(const std::string&, int, int)>;

std::vector<Range> improvements(const std::string& population, std::span<const int> greens_s,
                                std::span<const int> offsets_s, const Throughput& throughput) {
    std::vector<Range> ranges;
    for (const int green_s : greens_s) {
        Range range{green_s, 1e9, -1e9};
        for (const int offset_s : offsets_s) {
            const std::optional<double> own = throughput(population, green_s, offset_s);
            const std::optional<double> base = throughput("CTG-Ref", green_s, offset_s);
            if (!own || !base || !std::isfinite(*own / *base)) continue;
            const double percent = 100.0 * (*own / *base - 1.0);
            range.worst = std::min(range.worst, percent);
            range.best = std::max(range.best, percent);
        }
        if (range.worst <= range.best) ranges.push_back(range);
    }
    return ranges;
}

std::vector<Series> series_of(const std::map<std::string, Measurements>& measured, const std::string& traffic) {
    std::vector<Series> all;
    const auto find = [&](const char* experiment, const std::string& name) -> std::optional<double> {
        const auto found = measured.find(experiment);
        return found == measured.end() ? std::nullopt : found->second.find(name);
    };
    const auto add = [&](const char* network, int point, bool band, const std::string& population,
                         std::span<const int> greens_s, std::span<const int> offsets_s, const Throughput& throughput) {
        Series series{fmt::format("comparison_{}_{}_{}.dat", traffic, all.size(), population),
                      fmt::format("{}, {}", population, network),
                      line_style(style_index({population}, population)).colour,
                      point,
                      band,
                      improvements(population, greens_s, offsets_s, throughput)};
        if (!series.values.empty()) all.push_back(std::move(series));
    };
    constexpr int kCircle = 6;
    constexpr int kSquare = 4;
    constexpr int kTriangle = 8;
    for (const char* const population : {"CDG", "MIX"}) {
        const auto throughput_in = [&](const char* experiment) {
            return [&find, &traffic, experiment](const std::string& name, int green_s, int offset_s) {
                return find(experiment, "throughput " + section6::point_name(traffic, green_s, offset_s, name));
            };
        };
        add("grid", kCircle, true, population, section6::kGridGreens_s, section6::kGridOffsets_s,
            throughput_in(section6::kGrid));
        add("arterial", kSquare, true, population, section6::kArterialGreens_s, section6::kArterialOffsets_s,
            throughput_in(section6::kArterial));
        if (traffic == "free") {
            add("single intersection", kTriangle, false, population, kSingleGreens_s, std::array{0},
                [&find](const std::string& name, int green_s, int) {
                    const std::string policy = name == "MIX" ? "P50" : name;
                    return find("intersection", fmt::format("throughput {} green={} left=0 right=0", policy, green_s));
                });
        }
    }
    return all;
}

}  // namespace

std::vector<Figure> comparison_figure(const std::map<std::string, Measurements>& measured) {
    if (!measured.contains(section6::kGrid) && !measured.contains(section6::kArterial)) return {};
    Figure figure;
    figure.name = "comparison";
    figure.width_px = 1300;
    figure.height_px = 560;
    std::string body =
        "set multiplot layout 1,2 title 'Throughput gain over CTG-Ref; bands span from the worst to the best offset' margins "
        "0.06,0.79,0.12,0.86 spacing 0.06\nset xlabel 'green [s]'\nset xrange [3:37]\nset xtics 5\nset yrange "
        "[-40:160]\nset ylabel 'throughput gain [%]'\n";
    for (const auto& [traffic, title] :
         {std::pair("free", "without turns (arterial: no turns from the major street)"),
          std::pair("turns", "with turns (grid: 5 % left, 10 % right; arterial: on all streets)")}) {
        const bool first = traffic == std::string("free");
        body += fmt::format("set title '{}'\n{}plot ", title,
                            first ? "set key at screen 0.995,0.86 right top width -1\n" : "unset key\n");
        for (const Series& series : series_of(measured, traffic)) {
            std::string data = "# green_s worst_percent best_percent\n";
            for (const Range& r : series.values) {
                data += fmt::format("{} {:.3f} {:.3f}\n", r.green_s, r.worst, r.best);
            }
            figure.data.emplace_back(series.name, data);
            if (series.band) {
                body += fmt::format(
                    "'{0}' using 1:2:3 with filledcurves lc rgb '{1}' fs transparent solid 0.25 title {2}, '{0}' using "
                    "1:2 with linespoints dt 1 lc rgb '{1}' pt {3} notitle, '{0}' using 1:3 with linespoints dt 1 lc rgb '{1}' pt "
                    "{3} notitle, ",
                    series.name, series.colour, gnuplot_text(series.title), series.point);
            } else {
                body += fmt::format("'{}' using 1:2 with linespoints lw 2 dt 2 lc rgb '{}' pt {} title {}, ",
                                    series.name, series.colour, series.point, gnuplot_text(series.title));
            }
        }
        body += "0 with lines dt 1 lc rgb '#888888' notitle\n";
    }
    figure.body = body + "unset multiplot\n";
    return {figure};
}

}  // namespace stopline

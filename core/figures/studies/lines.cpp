#include "figures/studies/lines.h"

#include <algorithm>
#include <array>
#include <optional>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "figures/population_style.h"

namespace stopline {

namespace {

constexpr std::size_t kMaxNamedLines = 12;  // largest number of lines that the legend names one by one

// 8 dashes and 11 points: these numbers have no common factor, so 88 lines have different combinations.
constexpr std::array<const char*, 8> kDashes{"1",      "(9,4)",          "(2,4)",      "(12,4,2,4)",
                                             "(18,5)", "(12,4,2,4,2,4)", "(5,3,5,10)", "(2,9)"};
constexpr std::array<int, 11> kPoints{6, 4, 8, 12, 10, 14, 1, 2, 7, 5, 9};

struct CurveStyle {
    std::string colour;
    std::string dash;
    int point = 0;

    std::string text() const { return fmt::format("lw 2 dt {} pt {} ps 0.8 lc rgb '{}'", dash, point, colour); }
};

CurveStyle curve_style(const SweepPlanes& all, std::size_t population, std::size_t line) {
    const LineStyle style = line_style(style_index(all.names_in_order, all.populations[population]));
    if (!all.line_axis.exists()) return {style.colour, fmt::format("{}", style.dash), style.hollow_point};
    return {style.colour, kDashes[line % kDashes.size()], kPoints[line % kPoints.size()]};
}

// Returns tick positions at the axis values. A tick is left out if its number would touch the previous number.
std::string ticks_of(const std::vector<double>& values) {
    constexpr double kPanel_px = 235.0;  // width of the narrowest panel
    constexpr double kDigit_px = 8.0;
    constexpr double kBetween_px = 12.0;
    std::size_t digits = 0;
    for (const double value : values) digits = std::max(digits, fmt::format("{:g}", value).size());
    const double number_px = kDigit_px * static_cast<double>(digits) + kBetween_px;
    const double apart = (values.back() - values.front()) * number_px / kPanel_px;
    std::vector<std::string> ticks;
    double last = 0.0;
    for (const double value : values) {
        if (!ticks.empty() && value - last < apart) continue;
        ticks.push_back(fmt::format("{:g}", value));
        last = value;
    }
    return fmt::format("({})", fmt::join(ticks, ", "));
}

// Distance between the points of neighbouring populations over an axis of texts. All points of a text are together less
// than 0.5 wide.
double population_shift(const SweepPlanes& all, std::size_t population) {
    if (all.x_axis.has_numbers()) return 0.0;
    const double middle = 0.5 * static_cast<double>(all.populations.size() - 1);
    return 0.5 * (static_cast<double>(population) - middle) / static_cast<double>(all.populations.size());
}

// Returns the ticks of an axis of texts. The labels are inclined, because long ones would overlap.
std::string text_ticks(const std::vector<std::string>& texts, bool with_labels) {
    std::vector<std::string> ticks;
    for (std::size_t k = 0; k < texts.size(); ++k) {
        ticks.push_back(fmt::format("{} {}", with_labels ? gnuplot_text(texts[k]) : "''", k));
    }
    return fmt::format("rotate by 30 right ({})", fmt::join(ticks, ", "));
}

// Returns the height that the inclined labels of an axis need.
double text_labels_px(const std::vector<std::string>& texts) {
    constexpr double kLetter_px = 8.0;
    constexpr double kSine = 0.5;  // of 30 degrees
    constexpr double kBelow_px = 40.0;
    std::size_t letters = 0;
    for (const std::string& text : texts) letters = std::max(letters, text.size());
    return kBelow_px + kSine * kLetter_px * static_cast<double>(letters);
}

std::string cells_of(const std::optional<SeedSpread>& spread) {
    if (!spread) return " NaN NaN NaN";
    const auto cell = [](double value) { return fmt::format(" {:.6g}", value + 0.0); };  // + 0.0 turns -0 into 0
    return cell(spread->mean) + cell(spread->low) + cell(spread->high);
}

// Returns one data block for each line of the figure.
std::string data_of(const SweepPlanes& all, const SweepPlane& plane) {
    std::string names;
    for (const SweepMetric& metric : all.metrics) {
        const char* const before = &metric == &all.metrics.front()  ? ""
                                   : &metric == &all.metrics.back() ? " and "
                                                                    : ", ";
        names += before + metric.name;
    }
    std::string data = fmt::format("# {}; mean and 95 % confidence interval of {}; then of their changes in percent\n",
                                   all.x_axis.name, names);
    for (std::size_t population = 0; population < all.populations.size(); ++population) {
        for (std::size_t line = 0; line < all.line_axis.values.size(); ++line) {
            data += "# " + all.populations[population] +
                    (all.line_axis.exists() ? ", " + all.line_axis.value_titles[line] : "") + "\n";
            for (std::size_t x = 0; x < all.x_axis.values.size(); ++x) {
                const PlanePoint point{x, line, population};
                data += fmt::format("{:g}", all.x_axis.values[x] + population_shift(all, population));
                for (std::size_t metric = 0; metric < all.metrics.size(); ++metric)
                    data += cells_of(plane.value(metric, point));
                for (std::size_t metric = 0; metric < all.metrics.size(); ++metric)
                    data += cells_of(plane.change(metric, point, all.metrics[metric].sign()));
                data += "\n";
            }
            data += "\n\n";
        }
    }
    return data;
}

struct KeyEntry {
    std::string style;
    std::string title;
};

// Returns the legend. It has one entry for each line. With more than kMaxNamedLines lines, it has one entry for each
// colour (population) and one for each dash (value of the line axis) instead.
std::vector<KeyEntry> key_of(const SweepPlanes& all) {
    constexpr const char* kGrey = "#404040";
    const std::size_t populations = all.populations.size();
    const std::size_t lines = all.line_axis.values.size();
    std::vector<KeyEntry> entries;
    if (!all.line_axis.exists() || populations * lines <= kMaxNamedLines) {
        for (std::size_t p = 0; p < populations; ++p) {
            for (std::size_t line = 0; line < lines; ++line) {
                const std::string line_name = all.line_axis.exists() ? ", " + all.line_axis.value_titles[line] : "";
                entries.push_back({"linespoints " + curve_style(all, p, line).text(), all.populations[p] + line_name});
            }
        }
        return entries;
    }
    for (std::size_t p = 0; p < populations; ++p) {
        entries.push_back(
            {fmt::format("lines lw 4 dt 1 lc rgb '{}'", curve_style(all, p, 0).colour), all.populations[p]});
    }
    for (std::size_t line = 0; line < lines; ++line) {
        CurveStyle style = curve_style(all, 0, line);
        style.colour = kGrey;
        entries.push_back({"linespoints " + style.text(), all.line_axis.value_titles[line]});
    }
    return entries;
}

double key_width_px(const std::vector<KeyEntry>& entries) {
    constexpr double kSample_px = 85.0;
    constexpr double kLetter_px = 8.0;
    std::size_t letters = 0;
    for (const KeyEntry& entry : entries) letters = std::max(letters, entry.title.size());
    return kSample_px + kLetter_px * static_cast<double>(letters);
}

std::string panel_of(const SweepPlanes& all, const std::string& file, std::size_t metric, bool change) {
    std::string plots;
    const std::size_t column = 2 + 3 * (metric + (change ? all.metrics.size() : 0));
    for (std::size_t p = change ? 1 : 0; p < all.populations.size(); ++p) {
        for (std::size_t line = 0; line < all.line_axis.values.size(); ++line) {
            const CurveStyle style = curve_style(all, p, line);
            const std::string block =
                fmt::format("'{}' index {} using 1:{}", file, p * all.line_axis.values.size() + line, column);
            if (all.seeds > 1) {
                plots += fmt::format("{}:{}:{} with yerrorbars pt 0 lw 1.2 dt 1 lc rgb '{}' notitle, ", block,
                                     column + 1, column + 2, style.colour);
            }
            plots += fmt::format("{} with {} {} notitle, ", block, all.x_axis.has_numbers() ? "linespoints" : "points",
                                 style.text());
        }
    }
    return plots;
}

}  // namespace

Figure sweep_lines_figure(const SweepPlanes& all, const SweepPlane& plane, std::size_t number) {
    constexpr double kMargin = 0.05;  // share of the range, keeps points off the frame
    constexpr double kTextMargin = 0.5;
    constexpr double kKeyMargin = 0.008;
    Figure figure;
    figure.name = fmt::format("{}_{}", all.has_stability ? "network" : "lines", number);
    const std::size_t metrics = all.metrics.size();
    figure.width_px = 160 + 380 * static_cast<int>(metrics);
    const bool compares = all.populations.size() > 1;
    const bool has_numbers = all.x_axis.has_numbers();
    const double base_px = compares ? 760.0 : 410.0;
    const double below_px = has_numbers ? (compares ? 0.08 : 0.15) * base_px : text_labels_px(all.x_axis.texts);
    figure.height_px = static_cast<int>(base_px + (has_numbers ? 0.0 : below_px));
    const std::string file = figure.name + ".dat";
    figure.data.emplace_back(file, data_of(all, plane));
    const std::string title = all.title(plane, "means of {} seeds with 95 % confidence intervals");
    const std::vector<double>& values = all.x_axis.values;
    const double margin = !has_numbers        ? kTextMargin
                          : values.size() > 1 ? kMargin * (values.back() - values.front())
                                              : 1.0;
    const std::vector<KeyEntry> key = key_of(all);
    const double right = 1.0 - key_width_px(key) / figure.width_px;
    std::string body = fmt::format(
        "set multiplot layout {},{}{} margins 0.075,{:.4f},{:.4f},{} spacing 0.065,0.10\nset xrange [{:g}:{:g}]\nset bars 0.5\n",
        compares ? 2 : 1, metrics, title.empty() ? "" : " title " + gnuplot_text(title), right,
        below_px / figure.height_px,
        title.empty() ? "0.97"
        : compares    ? "0.94"
                      : "0.89",
        values.front() - margin, values.back() + margin);
    for (std::size_t panel = 0; panel < (compares ? 2 : 1) * metrics; ++panel) {
        const bool change = panel >= metrics;
        const std::size_t metric = panel % metrics;
        const SweepMetric& shown = all.metrics[metric];
        const bool with_texts = change || !compares;
        body += fmt::format("set xlabel {}\nset xtics {}\n",
                            gnuplot_text(has_numbers || with_texts ? all.x_axis.label() : ""),
                            has_numbers ? ticks_of(values) : text_ticks(all.x_axis.texts, with_texts));
        body += fmt::format("set ylabel {}\n", gnuplot_text(change ? all.change_label(shown) : shown.label()));
        // gnuplot needs an explicit range if no value is a number.
        body += change ? "set yrange [*:*]\n" : plane.has(metric) ? "set yrange [0:*]\n" : "set yrange [0:1]\n";
        const bool with_key = panel + 1 == metrics;
        body += with_key ? fmt::format("set key at screen {:.4f},graph 1 left top\nplot ", right + kKeyMargin)
                         : "unset key\nplot ";
        body += panel_of(all, file, metric, change);
        for (std::size_t k = 0; with_key && k < key.size(); ++k) {
            body += fmt::format("NaN with {} title {}, ", key[k].style, gnuplot_text(key[k].title));
        }
        body += change ? "0 with lines lw 1 dt 1 lc rgb '#888888' notitle\n" : "NaN notitle\n";
    }
    figure.body = body + "unset multiplot\n";
    return figure;
}

}  // namespace stopline

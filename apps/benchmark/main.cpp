// stopline-benchmark: cost of a vehicle update, and what bounds it.
#include <algorithm>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include <benchmark/benchmark.h>
#include <fmt/core.h>
#include <fmt/format.h>

#include "base/input_error.h"
#include "benchmark/full_step_benchmark.h"
#include "benchmark/meso_benchmark.h"
#include "benchmark/network_benchmark.h"
#include "common/command_line.h"
#include "common/program.h"

namespace stopline {

namespace {

constexpr const char* kFooter =
    "\nExamples:\n"
    "  stopline-benchmark\n"
    "  stopline-benchmark --benchmark_filter=batch/160/\n"
    "  stopline-benchmark --benchmark_out=benchmark.json\n\n"
    "All flags of Google Benchmark (--benchmark_...) are taken too. One thread is used, where the\n"
    "name does not say otherwise.\n\n";

// The table of Google Benchmark; keeps the least cost of each benchmark, which the rest of the machine disturbs least.
class TableReporter : public benchmark::ConsoleReporter {
public:
    void ReportRuns(const std::vector<Run>& runs) override {
        for (const Run& run : runs) {
            const auto cost = run.counters.find(kCostCounter);
            if (run.run_type != Run::RT_Iteration || cost == run.counters.end()) continue;
            const auto [kept, first] = least_ns_.try_emplace(run.run_name.function_name + "/" + run.run_name.args, 0.0);
            const double ns = 1e9 * cost->second.value;
            kept->second = first ? ns : std::min(kept->second, ns);
        }
        ConsoleReporter::ReportRuns(runs);
    }

    std::optional<double> least_ns(const std::string& kernels, int vehicles) const {
        return least_ns_named(fmt::format("{}/{}", benchmark_name(kernels), vehicles));
    }

    std::optional<double> least_ns_named(const std::string& name) const {
        const auto found = least_ns_.find(name);
        return found == least_ns_.end() ? std::nullopt : std::optional(found->second);
    }

private:
    std::map<std::string, double> least_ns_;
};

// What the numbers say of the limits, and no more; empty where not all were measured.
std::string limits_text(const TableReporter& table) {
    const std::optional<double> few = table.least_ns(kBatch, 16);
    const std::optional<double> batch = table.least_ns(kBatch, 160);
    const std::optional<double> many = table.least_ns(kBatch, 16000);
    const std::optional<double> scalar = table.least_ns(kScalar, 160);
    if (!few || !batch || !many || !scalar) return "";
    const double gain = *scalar / *batch;
    const double growth = *many / *batch;
    std::string text = "\nWhat bounds the step (least of the repetitions, ns an update):\n";
    text += fmt::format("  160 vehicles     {:6.1f} in batches, {:.1f} one at a time: {:.1f} times. {}\n", *batch,
                        *scalar, gain,
                        gain > 2.0 ? "Batches pay, so most of it is arithmetic."
                                   : "Batches hardly pay, so little of it is arithmetic.");
    text += fmt::format("  16,000 vehicles  {:6.1f}, {:.2f} times that of 160. {}\n", *many, growth,
                        growth > 1.15 ? "The excess comes with the size of the state: caches and memory."
                                      : "The size of the state costs next to nothing.");
    text +=
        fmt::format("  16 vehicles      {:6.1f}, {:.2f} times that of 160. {}\n", *few, *few / *batch,
                    *few > 1.15 * *batch ? "The excess is work that is done once a step or lane, whatever stands there."
                                         : "Work that is done once a step does not matter.");
    return text;
}

std::string meso_limits_text(const TableReporter& table) {
    const std::optional<double> loop = table.least_ns_named(fmt::format("{}/{}", following_name(kBatch), kFollowers));
    const std::optional<double> scalar =
        table.least_ns_named(fmt::format("{}/{}", following_name(kScalar), kFollowers));
    const std::optional<double> kernel = table.least_ns_named(fmt::format("{}/{}", moving_name(kBatch), kFollowers));
    const std::optional<double> step = table.least_ns_named(fmt::format("{}/0", kMesoStep));
    if (!loop || !scalar || !kernel || !step) return "";
    const double gain = *scalar / *loop;
    std::string text = "\nWhat bounds the mesoscale mode (least of the repetitions, ns an update):\n";
    text += fmt::format("  car following    {:6.1f} in batches, {:.1f} one at a time: {:.1f} times. {}\n", *loop,
                        *scalar, gain, gain > 2.0 ? "It is arithmetic." : "Batches hardly pay.");
    text += fmt::format("  the kernel       {:6.1f} with looking ahead, limits and moving on.\n", *kernel);
    text += fmt::format(
        "  a whole step     {:6.1f} at the reference intersection, where vehicles that rest are left out: what is\n"
        "                   not the kernel's is work at lane heads, conflict areas, detectors.\n",
        *step);
    return text;
}

std::string network_limits_text(const TableReporter& table) {
    const auto cost = [&](const std::string& name) { return table.least_ns_named(name + "/"); };
    std::string text;
    for (const char* const population : kGridPopulations) {
        const std::optional<double> ns = cost(grid_name(population));
        if (!ns) continue;
        if (text.empty()) text = "\nSeveral intersections, one thread (least of the repetitions):\n";
        text +=
            fmt::format("  {:16} {:6.1f} ns an update, {:.1f} million updates a second on the grid of Section VI.C\n",
                        population, *ns, 1e3 / *ns);
    }
    double least = 0.0;
    double most = 0.0;
    for (const int side : kGridSides) {
        const std::optional<double> ns = cost(large_grid_name(side, 1));
        if (!ns) return text;
        least = least == 0.0 ? *ns : std::min(least, *ns);
        most = std::max(most, *ns);
    }
    text += fmt::format("  by size          {:6.1f} to {:.1f} ns from {} x {} to {} x {} intersections: {:.2f} times\n",
                        least, most, kGridSides.front(), kGridSides.front(), kGridSides.back(), kGridSides.back(),
                        most / least);
    const std::optional<double> one = cost(large_grid_name(kSharedSide, 1));
    const std::optional<double> two = cost(large_grid_name(kSharedSide, 2));
    if (one && two)
        text += fmt::format("  two threads      {:6.2f} times one, on one run of {} x {}\n", *one / *two, kSharedSide,
                            kSharedSide);
    return text;
}

// Only what Google Benchmark understands, since it stops the program at anything else.
void check(const std::vector<std::string>& flags) {
    for (const std::string& flag : flags) {
        if (!flag.starts_with("--benchmark_")) throw InputError(fmt::format("unknown option '{}'; see --help", flag));
    }
}

ExitCode run(std::vector<std::string> flags) {
    check(flags);
    const bool console = std::none_of(flags.begin(), flags.end(), [](const std::string& flag) {
        return flag.starts_with("--benchmark_format=") && flag != "--benchmark_format=console";
    });
    std::string name = "stopline-benchmark";
    std::vector<char*> arguments{name.data()};
    for (std::string& flag : flags) arguments.push_back(flag.data());
    int count = static_cast<int>(arguments.size());
    benchmark::Initialize(&count, arguments.data());
    if (count > 1) throw InputError(fmt::format("unknown option '{}'; see --help", arguments[1]));
    add_full_step_benchmarks();
    add_meso_benchmarks();
    add_network_benchmarks();
    TableReporter table;
    if (benchmark::RunSpecifiedBenchmarks(console ? &table : nullptr) == 0) {
        throw InputError("no benchmark matches the filter");
    }
    if (interrupted()) throw Interrupted();
    if (console) fmt::print("{}{}{}", limits_text(table), meso_limits_text(table), network_limits_text(table));
    return ExitCode::done;
}

}  // namespace

int benchmark_main(int argc, const char* const* argv) {
    return run_program("stopline-benchmark", [&] {
        CLI::App app("Measures what a vehicle update costs in both fidelities and says what bounds it.",
                     "stopline-benchmark");
        add_version_option(app);
        app.footer(kFooter + std::string(kExitCodesText));
        app.allow_extras();
        const std::optional<ExitCode> end = parse_command_line(app, argc, argv);
        return end ? *end : run(app.remaining());
    });
}

}  // namespace stopline

int main(int argc, char** argv) { return stopline::benchmark_main(argc, argv); }

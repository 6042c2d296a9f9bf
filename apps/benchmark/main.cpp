// stopline-benchmark: measures the time per vehicle update and explains what limits it.
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
#include "common/examples.h"
#include "common/program.h"

namespace stopline {

namespace {

constexpr const char* kFooter =
    "\nExamples:\n"
    "  stopline-benchmark\n"
    "  stopline-benchmark --benchmark_filter=batch/160/\n"
    "  stopline-benchmark --benchmark_out=benchmark.json\n\n"
    "All options of Google Benchmark (--benchmark_...) work too. The benchmarks use one thread unless\n"
    "the name says otherwise.\n\n";

// Prints the table of Google Benchmark and keeps the minimum time over the repetitions of each benchmark. Other
// programs on the machine affect the minimum less than the mean.
class TableReporter : public benchmark::ConsoleReporter {
public:
    void ReportRuns(const std::vector<Run>& runs) override {
        for (const Run& run : runs) {
            const auto cost = run.counters.find(kCostCounter);
            if (run.run_type != Run::RT_Iteration || cost == run.counters.end()) continue;
            const auto [entry, first] = min_ns_.try_emplace(run.run_name.function_name + "/" + run.run_name.args, 0.0);
            const double ns = 1e9 * cost->second.value;
            entry->second = first ? ns : std::min(entry->second, ns);
        }
        ConsoleReporter::ReportRuns(runs);
    }

    std::optional<double> min_ns(const std::string& kernels, int vehicles) const {
        return min_ns_of(fmt::format("{}/{}", benchmark_name(kernels), vehicles));
    }

    std::optional<double> min_ns_of(const std::string& name) const {
        const auto found = min_ns_.find(name);
        return found == min_ns_.end() ? std::nullopt : std::optional(found->second);
    }

private:
    std::map<std::string, double> min_ns_;
};

// Returns a text that explains what limits the speed of full dynamics: arithmetic, memory, or fixed work. Fixed work is
// done in each step for each lane, however many vehicles there are.
// Returns an empty text if one of the benchmarks did not run.
std::string limits_text(const TableReporter& table) {
    const std::optional<double> small = table.min_ns(kBatch, 16);
    const std::optional<double> batch = table.min_ns(kBatch, 160);
    const std::optional<double> large = table.min_ns(kBatch, 16000);
    const std::optional<double> scalar = table.min_ns(kScalar, 160);
    if (!small || !batch || !large || !scalar) return "";
    const double gain = *scalar / *batch;
    const double growth = *large / *batch;
    std::string text = "\nLimits of full dynamics (minimum of the repetitions, ns per update):\n";
    text += fmt::format("  160 vehicles     {:6.1f} in batches, {:.1f} one at a time: {:.1f} times faster. {}\n",
                        *batch, *scalar, gain, gain > 2.0 ? "Arithmetic dominates." : "Arithmetic does not dominate.");
    text += fmt::format(
        "  16,000 vehicles  {:6.1f}, {:.2f} times the time with 160 vehicles. {}\n", *large, growth,
        growth > 1.15 ? "Caches and memory cause the difference." : "Caches and memory cost almost nothing.");
    text += fmt::format("  16 vehicles      {:6.1f}, {:.2f} times the time with 160 vehicles. {}\n", *small,
                        *small / *batch,
                        *small > 1.15 * *batch ? "Work per step and lane causes the difference."
                                               : "Work per step and lane costs almost nothing.");
    return text;
}

std::string meso_limits_text(const TableReporter& table) {
    const std::optional<double> loop = table.min_ns_of(fmt::format("{}/{}", following_name(kBatch), kFollowers));
    const std::optional<double> scalar = table.min_ns_of(fmt::format("{}/{}", following_name(kScalar), kFollowers));
    const std::optional<double> kernel = table.min_ns_of(fmt::format("{}/{}", kernel_name(kBatch), kFollowers));
    const std::optional<double> step = table.min_ns_of(fmt::format("{}/0", kMesoStep));
    if (!loop || !scalar || !kernel || !step) return "";
    const double gain = *scalar / *loop;
    std::string text = "\nLimits of the mesoscale mode (minimum of the repetitions, ns per update):\n";
    text += fmt::format("  car following    {:6.1f} in batches, {:.1f} one at a time: {:.1f} times faster. {}\n", *loop,
                        *scalar, gain, gain > 2.0 ? "Arithmetic dominates." : "Arithmetic does not dominate.");
    text += fmt::format("  whole kernel     {:6.1f} with look-ahead, speed limits and motion.\n", *kernel);
    text += fmt::format(
        "  whole step       {:6.1f} at the reference intersection. The step skips vehicles at rest. Lane heads,\n"
        "                   conflict areas and detectors cause the difference from the kernel.\n",
        *step);
    return text;
}

std::string network_limits_text(const TableReporter& table) {
    const auto cost = [&](const std::string& name) { return table.min_ns_of(name + "/"); };
    std::string text;
    for (const char* const population : kGridPopulations) {
        const std::optional<double> ns = cost(grid_name(population));
        if (!ns) continue;
        if (text.empty()) text = "\nSeveral intersections, one thread (minimum of the repetitions):\n";
        text += fmt::format(
            "  {:16} {:6.1f} ns per update, {:.1f} million updates per second on the grid of Section VI.C\n",
            population, *ns, 1e3 / *ns);
    }
    double min_of_sizes = 0.0;
    double max_ns = 0.0;
    for (const int side : kGridSides) {
        const std::optional<double> ns = cost(large_grid_name(side, 1));
        if (!ns) return text;
        min_of_sizes = min_of_sizes == 0.0 ? *ns : std::min(min_of_sizes, *ns);
        max_ns = std::max(max_ns, *ns);
    }
    text += fmt::format("  by size          {:6.1f} to {:.1f} ns from {} x {} to {} x {} intersections: {:.2f} times\n",
                        min_of_sizes, max_ns, kGridSides.front(), kGridSides.front(), kGridSides.back(),
                        kGridSides.back(), max_ns / min_of_sizes);
    const std::optional<double> one_thread_ns = cost(large_grid_name(kTwoThreadSide, 1));
    const std::optional<double> two_threads_ns = cost(large_grid_name(kTwoThreadSide, 2));
    if (one_thread_ns && two_threads_ns)
        text += fmt::format("  two threads      {:6.2f} times as fast as one, on a grid of {} x {}\n",
                            *one_thread_ns / *two_threads_ns, kTwoThreadSide, kTwoThreadSide);
    return text;
}

// Throws InputError for an option that does not begin with --benchmark_. Google Benchmark would end the program
// instead.
void check_flags(const std::vector<std::string>& flags) {
    for (const std::string& flag : flags) {
        if (!flag.starts_with("--benchmark_")) throw InputError(fmt::format("unknown option '{}'; see --help", flag));
    }
}

ExitCode run(std::vector<std::string> flags) {
    check_flags(flags);
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
        throw InputError("no benchmark matches the filter; see --benchmark_list_tests=true");
    }
    if (interrupted()) throw Interrupted();
    if (console) fmt::print("{}{}{}", limits_text(table), meso_limits_text(table), network_limits_text(table));
    return ExitCode::done;
}

}  // namespace

int benchmark_main(int argc, const char* const* argv) {
    return run_program("stopline-benchmark", [&] {
        Options app("Measures the time per vehicle update in both fidelities and explains what limits it.",
                    "stopline-benchmark");
        app.footer(runnable(kFooter) + kExitCodesText);
        const std::vector<std::string>& others = app.accept_others();
        const std::optional<ExitCode> end = app.parse(argc, argv);
        return end ? *end : run(others);
    });
}

}  // namespace stopline

int main(int argc, char** argv) { return stopline::benchmark_main(argc, argv); }

// stopline-sweep: runs all combinations of a sweep file's axes, keeps every finished run in a store, and writes one table.
#include <cstdio>
#include <filesystem>
#include <optional>
#include <stdexcept>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

#include <fmt/core.h>
#include <fmt/format.h>

#include "base/input_error.h"
#include "common/command_line.h"
#include "common/program.h"
#include "common/progress_bar.h"
#include "common/results.h"
#include "common/text_table.h"
#include "experiment/csv.h"
#include "experiment/network_sweep_figures.h"
#include "experiment/output.h"
#include "experiment/seed_means.h"
#include "experiment/sweep_merge.h"
#include "experiment/sweep_results.h"
#include "experiment/sweep_run.h"
#include "experiment/turn_figures.h"
#include "scenario/load_sweep.h"
#include "scenario/quantity.h"
#include "sweep/ranks.h"

namespace {

using namespace stopline;

constexpr std::size_t kFailuresShown = 5;

struct SweepOptionsOfUser {
    CommonOptions common;
    std::string file;
    std::string shard = "1/1";
    std::string rank_timeout = "60 s";
    bool list = false;
    bool describe = false;

    CLI::App* merge = nullptr;
    std::string merge_output;
    std::vector<std::string> stores;
};

void declare(CLI::App& app, SweepOptionsOfUser& options) {
    app.add_option("FILE", options.file, "Sweep file (YAML), such as scenarios/sweeps/single_light.yaml");
    add_common_options(app, options.common, "Folder for store and table (default: out/NAME of the sweep)");
    add_set_option(app, options.common);
    app.add_option("--shard", options.shard, "Run only the K-th of N parts, for job arrays")->type_name("K/N");
    app.add_option("--rank-timeout", options.rank_timeout,
                   "Silence after which a rank of mpirun --enable-recovery counts as dead (default: 60 s)")
        ->type_name("TIME");
    app.add_flag("--list", options.list, "List all runs as CSV and exit");
    app.add_flag("--describe", options.describe, "List all fields of sweep files and exit");
    options.merge = app.add_subcommand("merge", "Join the stores of shards; refuses overlaps and holes");
    options.merge->add_option("--output", options.merge_output, "Folder for the joined store and the table")
        ->type_name("DIR")
        ->required();
    options.merge->add_option("STORE", options.stores, "Stores of all shards (*.sqlite)")->required();
    app.footer(
        std::string(
            "\nEvery finished run is stored at once. Started again after an interrupt, a kill or a power cut, the\n"
            "same command runs what is missing and writes the same bytes.\n\n"
            "Examples:\n"
            "  stopline-sweep scenarios/sweeps/single_light.yaml\n"
            "  stopline-sweep scenarios/sweeps/single_light.yaml --list\n"
            "  stopline-sweep scenarios/sweeps/single_light.yaml --set vehicle=electric_100kw --output out/electric\n"
            "  stopline-sweep scenarios/sweeps/single_light.yaml --shard 2/8 --output out/shards\n"
            "  stopline-sweep merge --output out/joined out/shards/*.sqlite\n"
            "  mpirun -n 5 stopline-sweep scenarios/sweeps/single_light.yaml    (rank 0 hands out, four run)\n\n"
            "Next: the table NAME.csv has a row a run; rows of equal axes differ in their seed.\n\n") +
        kExitCodesText);
}

Sweep expanded(const SweepOptionsOfUser& options, int threads) {
    SweepOptions sweep_options;
    sweep_options.overrides = options.common.settings;
    if (options.common.seed) sweep_options.overrides.push_back(fmt::format("seed={}", *options.common.seed));
    sweep_options.threads = threads;
    ProgressBar bar("checking all combinations");
    sweep_options.on_progress = [&bar](double share) { return bar.update(share); };
    return Sweep(load_sweep(options.file), sweep_options);
}

std::string list_of_points(const Sweep& sweep, const Shard& shard) {
    std::vector<std::string> columns = sweep.columns();
    columns.insert(columns.begin(), "point");
    columns.emplace_back("seed");
    CsvWriter csv(columns);
    for (std::size_t point = 0; point < sweep.points(); ++point) {
        if (!shard.has(point)) continue;
        std::vector<std::string> cells = sweep.cells(point);
        cells.insert(cells.begin(), fmt::format("{}", point));
        cells.push_back(fmt::format("{}", sweep.seed(point)));
        csv.row(cells);
    }
    return csv.text();
}

RunStore store_for(const Sweep& sweep, const Shard& shard, const SweepFiles& files, const SweepOptionsOfUser& options) {
    StoreIdentity identity;
    identity.name = sweep.settings().name;
    identity.sweep = sweep.key();
    identity.program = identity_of_program();
    identity.points = sweep.points();
    if (shard.count > 1) identity.shard = fmt::format("{}/{}", shard.index, shard.count);
    identity.provenance = sweep_provenance(sweep, command_text("stopline-sweep", options.file, options.common));
    return RunStore::open_or_make(files.store, identity);
}

// A whole sweep, opened and ready to run.
struct Work {
    Sweep sweep;
    Shard shard;
    SweepFiles files;
    RunStore store;
    std::vector<std::size_t> todo;
};

Work prepare(const SweepOptionsOfUser& options, int threads) {
    const Shard shard = parse_shard(options.shard);
    Sweep sweep = expanded(options, threads);
    const std::filesystem::path folder =
        options.common.output.empty() ? "out/" + sweep.settings().name : options.common.output;
    prepare_folder(folder);
    SweepFiles files = sweep_files(folder, sweep.settings().name, shard);
    RunStore store = store_for(sweep, shard, files, options);
    std::vector<std::size_t> todo = points_to_do(sweep, shard, store);
    return {std::move(sweep), shard, std::move(files), std::move(store), std::move(todo)};
}

std::size_t runs_of(const Sweep& sweep, const Shard& shard) {
    std::size_t runs = 0;
    for (std::size_t point = 0; point < sweep.points(); ++point) runs += shard.has(point) ? 1U : 0U;
    return runs;
}

// A table that lies here while runs are missing is of a store that is gone.
void remove_old_table(const SweepFiles& files) {
    std::error_code ignored;
    std::filesystem::remove(files.table, ignored);
    std::filesystem::remove(files.provenance, ignored);
}

double rank_timeout_s(const SweepOptionsOfUser& options) {
    const ParsedQuantity timeout = parse_quantity(options.rank_timeout, unit("s"));
    if (!timeout.problem.empty() || timeout.si < 2.0) {
        throw InputError(fmt::format("--rank-timeout: value '{}' {}", options.rank_timeout,
                                     timeout.problem.empty() ? "is less than 2 s" : timeout.problem));
    }
    return timeout.si;
}

SweepSession run_all(Work& work, Ranks& ranks, int threads, double silence_max_s) {
    const std::size_t runs = runs_of(work.sweep, work.shard);
    const std::size_t before = runs - work.todo.size();
    ProgressBar bar(before == 0 ? fmt::format("{} runs", runs)
                                : fmt::format("{} runs, {} were done before", runs, before));
    const auto on_progress = [&bar](double share) { return bar.update(share); };
    if (work.todo.empty() && ranks.count() == 1) return {};
    if (!work.todo.empty()) remove_old_table(work.files);
    if (ranks.count() > 1) return ranks.serve(work.todo, work.store, on_progress, silence_max_s);
    SweepRunOptions options;
    options.threads = threads;
    options.on_progress = on_progress;
    return run_points(work.sweep, work.todo, work.store, options);
}

std::string totals_text(const SweepTotals& totals) {
    TextTable table("lr");
    table.row({"runs", fmt::format("{}", totals.runs)});
    table.row({"vehicle updates", fmt::format("{}", totals.updates)});
    table.row({"overlaps", fmt::format("{}", totals.overlaps)});
    table.row({"entries on red", fmt::format("{}", totals.red_entries)});
    table.row({"lost vehicles", fmt::format("{}", totals.lost_vehicles)});
    if (totals.deadlocks) table.row({"deadlocks", fmt::format("{}", *totals.deadlocks)});
    table.row({"runs with such violations", fmt::format("{}", totals.runs_with_violations)});
    if (totals.gridlocks) {
        table.row({"gridlocks", fmt::format("{}", *totals.gridlocks)});
        table.row({"vehicles moved on", fmt::format("{}", totals.moved_on)});
    }
    if (totals.longest_inside_s > 0.0) {
        table.row({"longest way through an intersection", fmt::format("{:.1f} s", totals.longest_inside_s)});
    }
    std::string text = table.text();
    if (totals.unsettled > 0) {
        text += fmt::format("{} of {} runs are measured from before traffic settles (window_from_s, warm_up_s).\n",
                            totals.unsettled, totals.runs);
    }
    if (totals.with_waiting > 0) {
        text +=
            fmt::format("In {} of {} runs vehicles had come, but found no room to enter until the end (waiting_veh).\n",
                        totals.with_waiting, totals.runs);
    }
    return text;
}

void print_session(const SweepSession& session, const std::string& by) {
    if (session.runs == 0) return fmt::print("All runs were done before.\n");
    fmt::print("{} runs now, in {} on {}: {:.1f} million vehicle updates per second\n", session.runs,
               duration_text(session.wall_s), by, static_cast<double>(session.updates) / session.wall_s / 1e6);
}

ExitCode report_failures(const Work& work, const SweepSession& session) {
    fmt::print(stderr, "stopline-sweep: {} runs failed, all others are stored:\n", session.failures.size());
    for (std::size_t i = 0; i < session.failures.size() && i < kFailuresShown; ++i) {
        const SweepFailure& failure = session.failures[i];
        fmt::print(stderr, "  run {} ({}): {}\n", failure.point, work.sweep.describe(failure.point), failure.message);
    }
    fmt::print(stderr, "No table is written. The same command tries them again.\n");
    return ExitCode::check_failed;
}

void print_orders(const Orders& orders) {
    const std::string most =
        orders.rises == 0 ? ""
                          : fmt::format(", at most by {:.1f} % ({})", orders.largest_rise_percent, orders.largest_rise);
    fmt::print("  throughput falls with turns in {} of {} steps, rises in {}{}\n", orders.steps - orders.rises,
               orders.steps, orders.rises, most);
    fmt::print("  it grows more than in proportion to the share of CDG at {} of {} points\n",
               orders.points - orders.above, orders.points);
}

// Figures where the sweep went over an intersection's greens and turns, with the paper's Table 1, or over several intersections'
// greens and offsets.
void draw_results(const Sweep& sweep, const std::string& csv, const std::filesystem::path& file) {
    const CsvTable results = parse_csv(csv, file.string());
    if (has_seeds(results)) {
        const std::string name = file.stem().string() + "_means.csv";
        write_file(file.parent_path() / name, seed_means_csv(results, sweep.population_column()));
        fmt::print("  {}\n", name);
    }
    const std::string note = network_sweep_note(results, sweep.titles(), sweep.population_column());
    if (!note.empty()) fmt::print("  {}\n", note);
    const std::vector<Figure> figures = network_sweep_figures(results, sweep.titles(), sweep.population_column());
    if (!figures.empty()) draw_all(figures, file.parent_path());
    if (!has_turns(results)) return;
    write_file(file.parent_path() / "table1.csv", table1_csv(results, load_targets()));
    fmt::print("  table1.csv\n");
    print_orders(orders_of(results));
    draw_all(turn_figures(results), file.parent_path());
}

ExitCode finish(Work& work, const SweepSession& session, const std::string& by) {
    if (!session.failures.empty()) return report_failures(work, session);
    if (!points_to_do(work.sweep, work.shard, work.store).empty()) throw std::logic_error("runs were left out");
    const SweepTable table = sweep_results(work.store);
    write_file(work.files.table, table.csv);
    write_file(work.files.provenance, work.store.identity().provenance);
    fmt::print("{}\n", work.sweep.settings().title.empty() ? work.sweep.settings().name : work.sweep.settings().title);
    print_session(session, by);
    fmt::print("{}\nWritten to {}\n", totals_text(table.totals), work.files.table.parent_path().string());
    for (const auto& file : {work.files.table, work.files.provenance, work.files.store}) {
        fmt::print("  {}\n", file.filename().string());
    }
    if (work.shard.count > 1) {  // figures of some of the runs would mislead
        fmt::print("\nNext: when all {} shards are done, stopline-sweep merge --output DIR {}/*.sqlite\n",
                   work.shard.count, work.files.table.parent_path().string());
    } else {
        draw_results(work.sweep, table.csv, work.files.table);
        fmt::print("\nNext: the table has a row a run; rows of equal axes differ in their seed.\n");
    }
    return table.totals.runs_with_violations == 0 ? ExitCode::done : ExitCode::check_failed;
}

// What all ranks must agree on: the sweep and the program.
std::string key_of(const Sweep& sweep) { return sweep.key() + identity_of_program(); }

ExitCode run_as_worker(const SweepOptionsOfUser& options, const Ranks& ranks) {
    std::optional<Sweep> sweep;
    std::string key;
    try {
        sweep.emplace(expanded(options, 1));
        key = key_of(*sweep);
    } catch (const std::exception&) {
        key.clear();  // rank 0 has met the same, and says so; or says that this rank sees something else
    }
    if (ranks.agree(key)) ranks.work(*sweep);
    return ExitCode::done;
}

ExitCode run_sweep(const SweepOptionsOfUser& options, Ranks& ranks) {
    const int threads = ranks.count() > 1 ? 1 : threads_or_all(options.common.threads);
    std::optional<Work> work;
    double silence_max_s = 0.0;
    try {
        silence_max_s = rank_timeout_s(options);
        work.emplace(prepare(options, threads));
    } catch (...) {
        static_cast<void>(ranks.agree(""));
        throw;
    }
    static_cast<void>(ranks.agree(key_of(work->sweep)));
    const SweepSession session = [&] {
        try {
            return run_all(*work, ranks, threads, silence_max_s);
        } catch (const Interrupted&) {
            const std::size_t missing = points_to_do(work->sweep, work->shard, work->store).size();
            const std::size_t runs = runs_of(work->sweep, work->shard);
            fmt::print(stderr, "stopline-sweep: {} of {} runs are stored; the same command continues\n", runs - missing,
                       runs);
            throw;
        }
    }();
    if (ranks.lost() > 0) {
        fmt::print(stderr, "stopline-sweep: {} of {} ranks died; others did their runs\n", ranks.lost(), ranks.count());
    }
    const std::string by = ranks.count() > 1 ? fmt::format("{} ranks", ranks.count() - 1)
                                             : fmt::format("{} thread{}", threads, threads == 1 ? "" : "s");
    return finish(*work, session, by);
}

ExitCode merge(const SweepOptionsOfUser& options) {
    const std::filesystem::path folder = options.merge_output;
    prepare_folder(folder);
    const MergedSweep merged = merge_stores({options.stores.begin(), options.stores.end()}, folder);
    fmt::print("{} stores joined\n{}\nWritten to {}\n", options.stores.size(), totals_text(merged.table.totals),
               folder.string());
    const SweepFiles files = sweep_files(folder, merged.name);
    for (const auto& file : {files.table, files.provenance, files.store}) {
        fmt::print("  {}\n", file.filename().string());
    }
    fmt::print(
        "\nNext: stopline-sweep FILE --output {}, with the options of the shards but --shard, runs nothing again\n"
        "and adds figures and means.\n",
        folder.string());
    return merged.table.totals.runs_with_violations == 0 ? ExitCode::done : ExitCode::check_failed;
}

ExitCode run(const SweepOptionsOfUser& options, Ranks& ranks) {
    const bool worker = ranks.rank() != 0;
    const bool simple = options.describe || options.list || options.merge->parsed() || options.file.empty();
    if (worker) return simple ? ExitCode::done : run_as_worker(options, ranks);
    if (options.describe) return fmt::print("{}", describe_sweep_fields()), ExitCode::done;
    if (options.merge->parsed()) return merge(options);
    if (options.file.empty()) {
        throw InputError("no sweep file given; try: stopline-sweep scenarios/sweeps/single_light.yaml (or --help)");
    }
    if (!options.list) return run_sweep(options, ranks);
    const Shard shard = parse_shard(options.shard);
    fmt::print("{}", list_of_points(expanded(options, threads_or_all(options.common.threads)), shard));
    return ExitCode::done;
}

// All ranks do the same until the work begins, and would say the same.
void be_silent() {
    if (std::freopen("/dev/null", "w", stdout) == nullptr || std::freopen("/dev/null", "w", stderr) == nullptr) return;
}

}  // namespace

int main(int argc, char** argv) {
    Ranks ranks;
    if (ranks.rank() != 0) be_silent();
    const int exit_code = run_program("stopline-sweep", [&] {
        CLI::App app(
            "Runs all combinations of the axes of a sweep file, each with several seeds, and writes one table of results.",
            "stopline-sweep");
        SweepOptionsOfUser options;
        declare(app, options);
        const std::optional<ExitCode> end = parse_command_line(app, argc, argv);
        return end ? *end : run(options, ranks);
    });
    ranks.leave(exit_code);
    return exit_code;
}

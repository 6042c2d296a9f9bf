// stopline-sweep: runs all combinations of the axes of a sweep file, stores each finished run, and writes one table.
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
#include "base/io/command_files.h"
#include "base/io/console.h"
#include "base/io/csv.h"
#include "base/io/data_directory.h"
#include "base/io/output.h"
#include "common/command_line.h"
#include "common/examples.h"
#include "common/program.h"
#include "common/progress_bar.h"
#include "common/results.h"
#include "figures/studies/sweep_figures.h"
#include "figures/studies/turn_figures.h"
#include "runs/tables/column_aliases.h"
#include "scenario/scenario.h"
#include "scenario/schema/quantity.h"
#include "scenario/sweep_file/load_sweep.h"
#include "sweep/ranks.h"
#include "sweep/sweep_text.h"
#include "sweeps/seed_means.h"
#include "sweeps/sweep_merge.h"
#include "sweeps/sweep_results.h"
#include "sweeps/sweep_run.h"

namespace {

using namespace stopline;

constexpr std::size_t kMaxFailuresShown = 5;
constexpr const char* kTable1 = "table1.csv";

struct SweepCliOptions {
    CommonOptions common;
    std::string file;
    std::string shard = "1/1";
    std::string rank_timeout = "60 s";
    bool list = false;
    bool describe = false;

    Options* merge = nullptr;  // options of the subcommand merge
    std::string merge_output;
    std::vector<std::string> stores;
};

void declare(Options& app, SweepCliOptions& options) {
    app.add("FILE", options.file, runnable("Sweep file (YAML), such as scenarios/sweeps/single_light.yaml"));
    add_common_options(app, options.common,
                       "Folder for the store and the table (default: out/ and the name of the sweep)");
    add_set_option(app, options.common);
    app.add("--shard", options.shard, "Run only part K of N, for job arrays (join the parts with merge)")
        .type_name("K/N");
    app.add("--rank-timeout", options.rank_timeout,
            "With mpirun --enable-recovery: silence after which a rank counts as dead (default: 60 s)")
        .type_name("TIME");
    add_old_column_names_option(app, options.common);
    app.add_flag("--list", options.list, "List all runs as CSV and exit");
    app.add_flag("--describe", options.describe, "List all fields of sweep files and exit");
    options.merge =
        &app.add_subcommand("merge", "Join the stores of all shards (overlapping or missing runs are an error)");
    options.merge->add("--output", options.merge_output, "Folder for the joined store and the table")
        .type_name("DIR")
        .required();
    options.merge->add("STORE", options.stores, "Stores of all shards (*.sqlite)").required();
    app.footer(
        runnable(
            "\nEach finished run is stored at once. After an interruption, the same command continues with the\n"
            "missing runs; the final table is the same.\n\n"
            "Examples:\n"
            "  stopline-sweep scenarios/sweeps/single_light.yaml\n"
            "  stopline-sweep scenarios/sweeps/single_light.yaml --list\n"
            "  stopline-sweep scenarios/sweeps/single_light.yaml --set vehicle=electric_100kw --output out/electric\n"
            "  stopline-sweep scenarios/sweeps/single_light.yaml --shard 1/2 --output out/shards\n"
            "  stopline-sweep scenarios/sweeps/single_light.yaml --shard 2/2 --output out/shards\n"
            "  stopline-sweep merge --output out/joined out/shards/*.sqlite\n"
            "  mpirun --oversubscribe -n 3 stopline-sweep scenarios/sweeps/single_light.yaml --output out/ranks\n"
            "With mpirun, rank 0 distributes the runs and the other ranks execute them.\n\n"
            "Next: open NAME_means.csv, the means over the seeds. A sweep with one seed has only NAME.csv, with one\n"
            "row per run.\n\n") +
        kExitCodesText);
}

Sweep expand_sweep(const SweepCliOptions& options, int threads) {
    SweepOptions sweep_options;
    sweep_options.overrides = options.common.settings;
    if (options.common.seed) sweep_options.overrides.push_back(fmt::format("seed={}", *options.common.seed));
    sweep_options.threads = threads;
    Sweep sweep = [&] {
        ProgressBar bar("checking all combinations");
        sweep_options.on_progress = [&bar](double share) { return bar.update(share); };
        return Sweep(load_sweep(options.file), sweep_options);
    }();
    print_warnings(sweep.warnings());
    return sweep;
}

RunStore open_store(const Sweep& sweep, const Shard& shard, const SweepFiles& files, const SweepCliOptions& options) {
    StoreIdentity identity;
    identity.name = sweep.settings().name;
    identity.sweep = sweep.key();
    identity.program = required_program_identity();
    identity.points = sweep.points();
    if (shard.count > 1) identity.shard = fmt::format("{}/{}", shard.index, shard.count);
    identity.provenance = sweep_provenance(sweep, command_text("stopline-sweep", options.file, options.common));
    return RunStore::open_or_make(files.store, identity);
}

// A sweep with its open store. `todo` holds the numbers of the runs that are not in the store yet.
struct PreparedSweep {
    Sweep sweep;
    Shard shard;
    SweepFiles files;
    RunStore store;
    std::vector<std::size_t> todo;
};

// Returns the path of the table with the means over the seeds.
std::filesystem::path means_file(const SweepFiles& files) {
    return files.table.parent_path() / (files.table.stem().string() + "_means.csv");
}

PreparedSweep prepare(const SweepCliOptions& options, int threads) {
    const Shard shard = parse_shard(options.shard);
    Sweep sweep = expand_sweep(options, threads);
    const std::filesystem::path folder =
        options.common.output.empty() ? "out/" + sweep.settings().name : options.common.output;
    SweepFiles files = sweep_files(folder, sweep.settings().name, shard);
    CommandFiles command_files;
    add_sweep_inputs(command_files, options.file, sweep.settings(), options.common.settings);
    for (const auto& file : {files.store, files.table, files.provenance, means_file(files), folder / kTable1}) {
        command_files.add_output(file, "a result in the folder of --output");
    }
    prepare_folder(folder);
    RunStore store = open_store(sweep, shard, files, options);
    std::vector<std::size_t> todo = missing_points(sweep, shard, store);
    return {std::move(sweep), shard, std::move(files), std::move(store), std::move(todo)};
}

std::size_t count_runs(const Sweep& sweep, const Shard& shard) {
    std::size_t runs = 0;
    for (std::size_t point = 0; point < sweep.points(); ++point) runs += shard.has(point) ? 1U : 0U;
    return runs;
}

// Removes the table of an earlier sweep, so that no table disagrees with the store while runs are missing.
void remove_old_table(const SweepFiles& files) {
    std::error_code ignored;
    std::filesystem::remove(files.table, ignored);
    std::filesystem::remove(files.provenance, ignored);
}

double rank_timeout_s(const SweepCliOptions& options) {
    const ParsedQuantity timeout = parse_quantity(options.rank_timeout, unit("s"));
    if (!timeout.problem.empty() || timeout.si < 2.0) {
        throw InputError(fmt::format("--rank-timeout: value '{}' {}", options.rank_timeout,
                                     timeout.problem.empty() ? "is too short; give 2 s or more" : timeout.problem));
    }
    return timeout.si;
}

SweepSession run_all(PreparedSweep& work, Ranks& ranks, int threads, double silence_max_s) {
    const std::size_t runs = count_runs(work.sweep, work.shard);
    const std::size_t stored = runs - work.todo.size();
    ProgressBar bar(stored == 0 ? fmt::format("{} runs", runs)
                                : fmt::format("{} runs, {} already stored", runs, stored));
    const auto on_progress = [&bar](double share) { return bar.update(share); };
    if (work.todo.empty() && ranks.count() == 1) return {};
    if (!work.todo.empty()) remove_old_table(work.files);
    if (ranks.count() > 1) return ranks.serve(work.todo, work.store, on_progress, silence_max_s);
    SweepRunOptions options;
    options.threads = threads;
    options.on_progress = on_progress;
    return run_points(work.sweep, work.todo, work.store, options);
}

ExitCode verdict_of(const SweepTotals& totals) {
    return totals.runs_with_violations == 0 && totals.starving_runs == 0 ? ExitCode::done : ExitCode::check_failed;
}

// Prints the number, duration and speed of the runs of this session. `workers` is a text such as "4 threads".
void print_session(const SweepSession& session, const std::string& workers) {
    if (session.runs == 0) return fmt::print("All runs were done before.\n");
    fmt::print("{} runs now, in {} on {}: {:.1f} million vehicle updates per second\n", session.runs,
               duration_text(session.wall_s), workers, static_cast<double>(session.updates) / session.wall_s / 1e6);
}

ExitCode report_failures(const PreparedSweep& work, const SweepSession& session) {
    print_message("stopline-sweep: {} runs failed; all others are stored:\n", session.failures.size());
    for (std::size_t i = 0; i < session.failures.size() && i < kMaxFailuresShown; ++i) {
        const SweepFailure& failure = session.failures[i];
        print_message("  run {} ({}): {}\n", failure.point, work.sweep.describe(failure.point), failure.message);
    }
    print_message("No table is written. Repeat the command to try the failed runs again.\n");
    return ExitCode::check_failed;
}

// Returns true if the sweep varies the reference intersection of the paper.
bool is_of_reference_intersection(const Sweep& sweep) {
    const std::filesystem::path reference = data_directory() / ".." / "scenarios" / "intersection.yaml";
    std::error_code ignored;
    return std::filesystem::equivalent(sweep.settings().scenario, reference.lexically_normal(), ignored);
}

// Prints how often the sweep confirms two statements of the paper: throughput falls with the share of turns, and it
// grows more than in proportion to the share of CDG. Leaves out a statement that the sweep cannot test.
void print_throughput_trends(const ThroughputTrends& trends) {
    const std::string largest =
        trends.rises == 0 ? ""
                          : fmt::format(", by up to {:.1f} % ({})", trends.largest_rise_percent, trends.largest_rise);
    if (trends.steps > 0) {
        fmt::print("  throughput: falls in {} of {} steps to a larger turn ratio, rises in {}{}\n",
                   trends.steps - trends.rises, trends.steps, trends.rises, largest);
    }
    if (trends.points > 0) {
        fmt::print("  throughput: grows more than in proportion to the share of CDG at {} of {} points\n",
                   trends.points - trends.above_line, trends.points);
    }
}

// Returns the population with which the sweep compares the others: measure.baseline, which an axis with one value can
// set. Says so if the sweep does not run this population. The first population then takes its place.
std::string baseline_of(const Sweep& sweep, const CsvTable& results) {
    std::string baseline = sweep.base().measure.baseline;
    for (const SweepAxis& axis : sweep.settings().axes) {
        if (axis.paths == std::vector<std::string>{"measure.baseline"} && axis.values.size() == 1) {
            baseline = axis.values.front();
        }
    }
    if (baseline == kNoBaseline) baseline.clear();
    const std::size_t column = results.column(sweep.population_column());
    const auto runs_it = [&](const std::vector<std::string>& row) { return row[column] == baseline; };
    if (!baseline.empty() && !results.rows.empty() && !std::any_of(results.rows.begin(), results.rows.end(), runs_it)) {
        fmt::print("  measure.baseline is {}, which the sweep does not run: differences are against {}\n", baseline,
                   results.rows.front()[column]);
    }
    return baseline;
}

// Writes the means over seeds, the figures, and Table 1 of the paper. Each of them needs certain axes, and is left out
// if the sweep does not have these axes. Only sweeps of the paper's intersection get Table 1. Returns the sentences
// that tell the user which file to open.
std::string draw_results(const Sweep& sweep, const std::string& csv, const std::filesystem::path& file,
                         ColumnNames names) {
    const CsvTable results = parse_csv(csv, file.string());
    const std::string baseline = baseline_of(sweep, results);
    std::string next = fmt::format("open {}. It has one row per run.", file.string());
    if (has_seeds(results)) {
        const ResultFile means = result_file("sweep/NAME_means.csv", file.stem().string() + "_means.csv",
                                             seed_means_csv(results, sweep.population_column(), baseline), names);
        write_file(file.parent_path() / means.name, means.text);
        fmt::print("  {}\n", means.name);
        next = fmt::format("open {}. It has the means over the seeds, with confidence intervals.",
                           (file.parent_path() / means.name).string());
    }
    const std::string note = sweep_figures_note(results, sweep.titles(), sweep.population_column());
    if (!note.empty()) fmt::print("  {}\n", note);
    if (!has_turns(results)) {
        const std::vector<Figure> figures = sweep_figures(results, sweep.titles(), sweep.population_column(), baseline);
        if (!figures.empty()) draw_figures(figures, file.parent_path());
        return next;
    }
    if (is_of_reference_intersection(sweep)) {
        write_file(file.parent_path() / kTable1, table1_csv(results, load_targets()));
        fmt::print("  {}\n", kTable1);
        print_throughput_trends(throughput_trends(results));
    }
    draw_figures(turn_figures(results), file.parent_path());
    return next;
}

ExitCode finish(PreparedSweep& work, const SweepSession& session, const std::string& workers, ColumnNames names) {
    if (!session.failures.empty()) return report_failures(work, session);
    if (!missing_points(work.sweep, work.shard, work.store).empty())
        throw std::logic_error("runs are missing after the sweep");
    const SweepTable table = sweep_results(work.store);
    write_file(work.files.table, result_file("sweep/NAME.csv", "", table.csv, names).text);
    write_file(work.files.provenance, work.store.identity().provenance);
    fmt::print("{}\n", work.sweep.settings().title.empty() ? work.sweep.settings().name : work.sweep.settings().title);
    print_session(session, workers);
    fmt::print("{}\nWritten to {}\n", totals_text(table.totals), work.files.table.parent_path().string());
    for (const auto& file : {work.files.table, work.files.provenance, work.files.store}) {
        fmt::print("  {}\n", file.filename().string());
    }
    if (work.shard.count > 1) {  // no figures, because figures of a part of the runs would mislead
        const std::string folder = work.files.table.parent_path().string();
        fmt::print("\nNext: when all {} shards are done, join them\n  {} merge --output {} {}/*.sqlite\n",
                   work.shard.count, program_command("stopline-sweep"), shell_word(folder + "_joined"),
                   shell_word(folder));
    } else {
        const std::string next = draw_results(work.sweep, table.csv, work.files.table, names);
        fmt::print("\nNext: {}\n", next);
    }
    return verdict_of(table.totals);
}

// Returns a text that is equal on all ranks if they run the same sweep with the same program.
std::string agreement_key(const Sweep& sweep) { return sweep.key() + required_program_identity(); }

ExitCode run_as_worker(const SweepCliOptions& options, const Ranks& ranks) {
    std::optional<Sweep> sweep;
    std::string key;
    try {
        sweep.emplace(expand_sweep(options, 1));
        key = agreement_key(*sweep);
    } catch (const std::exception&) {
        key.clear();  // rank 0 reports the error
    }
    if (ranks.agree_on(key)) ranks.work(*sweep);
    return ExitCode::done;
}

ExitCode run_sweep(const SweepCliOptions& options, Ranks& ranks) {
    const int threads = ranks.count() > 1 ? 1 : thread_count(options.common.threads);
    std::optional<PreparedSweep> work;
    double silence_max_s = 0.0;
    try {
        silence_max_s = rank_timeout_s(options);
        work.emplace(prepare(options, threads));
    } catch (...) {
        static_cast<void>(ranks.agree_on(""));
        throw;
    }
    static_cast<void>(ranks.agree_on(agreement_key(work->sweep)));
    const SweepSession session = [&] {
        try {
            return run_all(*work, ranks, threads, silence_max_s);
        } catch (const Interrupted&) {
            const std::size_t missing = missing_points(work->sweep, work->shard, work->store).size();
            const std::size_t runs = count_runs(work->sweep, work->shard);
            print_message("stopline-sweep: {} of {} runs are stored; the same command continues with the others\n",
                          runs - missing, runs);
            throw;
        }
    }();
    if (ranks.lost() > 0) {
        print_message("stopline-sweep: {} of {} ranks died; the others did their runs\n", ranks.lost(), ranks.count());
    }
    const std::string workers = ranks.count() > 1 ? fmt::format("{} ranks", ranks.count() - 1)
                                                  : fmt::format("{} thread{}", threads, threads == 1 ? "" : "s");
    return finish(*work, session, workers, column_names(options.common));
}

ExitCode merge(const SweepCliOptions& options) {
    const std::filesystem::path folder = options.merge_output;
    prepare_folder(folder);
    const MergedSweep merged =
        merge_stores({options.stores.begin(), options.stores.end()}, folder, column_names(options.common));
    print_warnings(merged.table.warnings);
    fmt::print("{} stores joined\n{}\nWritten to {}\n", options.stores.size(), totals_text(merged.table.totals),
               folder.string());
    const SweepFiles files = sweep_files(folder, merged.name);
    for (const auto& file : {files.table, files.provenance, files.store}) {
        fmt::print("  {}\n", file.filename().string());
    }
    fmt::print(
        "\nNext: add figures and means over seeds. Use the sweep file and options of the shards, but not --shard\n"
        "  {} FILE --output {}\n",
        program_command("stopline-sweep"), shell_word(folder.string()));
    return verdict_of(merged.table.totals);
}

ExitCode run(const SweepCliOptions& options, Ranks& ranks) {
    const bool is_worker = ranks.rank() != 0;
    const bool runs_nothing = options.describe || options.list || options.merge->parsed() || options.file.empty();
    if (is_worker) return runs_nothing ? ExitCode::done : run_as_worker(options, ranks);
    if (options.describe) return fmt::print("{}", describe_sweep_fields()), ExitCode::done;
    if (options.merge->parsed()) return merge(options);
    if (options.file.empty()) {
        throw InputError(
            runnable("no sweep file given; try: stopline-sweep scenarios/sweeps/single_light.yaml (or --help)"));
    }
    if (!options.list) return run_sweep(options, ranks);
    const Shard shard = parse_shard(options.shard);
    fmt::print("{}", points_csv(expand_sweep(options, thread_count(options.common.threads)), shard));
    return ExitCode::done;
}

// Throws InputError for an option before the subcommand merge. Such an option has no effect on merging.
void check_merge_options(const Options& app) {
    for (const std::string& name : app.given()) {
        if (name != "--old-column-names")
            throw InputError(fmt::format("{} before 'merge' has no effect; see stopline-sweep merge --help", name));
    }
}

// Discards all output of this process. Ranks other than 0 do this, because they would repeat the messages of rank 0.
void silence_output() {
    if (std::freopen("/dev/null", "w", stdout) == nullptr || std::freopen("/dev/null", "w", stderr) == nullptr) return;
}

}  // namespace

int main(int argc, char** argv) {
    open_closed_streams();  // before MPI opens files of its own
    Ranks ranks;
    if (ranks.rank() != 0) silence_output();
    const int exit_code = run_program("stopline-sweep", [&] {
        Options app("Runs all combinations of the axes of a sweep file, each with several seeds, and writes one table.",
                    "stopline-sweep");
        SweepCliOptions options;
        declare(app, options);
        if (ranks.rank() != 0) end_at_once_on_termination();
        const std::optional<ExitCode> end = app.parse(argc, argv);
        if (!end && options.merge->parsed()) check_merge_options(app);
        return end ? *end : run(options, ranks);
    });
    ranks.leave(exit_code);
    return exit_code;
}

#include "paper/sections/scorecard_sweeps.h"

#include <filesystem>
#include <optional>
#include <utility>

#include <fmt/format.h>

#include "base/input_error.h"
#include "base/io/data_directory.h"
#include "runs/program_identity.h"
#include "scenario/sweep_file/load_sweep.h"

namespace stopline {

namespace {

RunStore store_of(const std::filesystem::path& file, const Sweep& sweep, const std::string& program) {
    StoreIdentity identity;
    identity.name = file.stem().string();
    identity.sweep = sweep.key();
    identity.program = program;
    identity.points = sweep.points();
    // A locked or damaged store is not deleted, because is_outdated() throws.
    if (std::filesystem::exists(file) && RunStore::is_outdated(file, identity)) std::filesystem::remove(file);
    return RunStore::open_or_make(file, identity);
}

}  // namespace

SweepRuns run_sweep(const ScorecardOptions& options, const char* file, const std::vector<std::string>& overrides,
                    const char* name, RunFunction function, ProgressRange range) {
    SweepOptions sweep_options;
    sweep_options.overrides = options.settings;
    sweep_options.overrides.insert(sweep_options.overrides.end(), overrides.begin(), overrides.end());
    sweep_options.threads = options.threads;
    SweepSettings settings = load_sweep(scenario_directory() / "sweeps" / file);
    options.reductions.apply(settings);
    const std::vector<std::string> reduced = options.reductions.settings("sweeps/" + settings.name);
    sweep_options.overrides.insert(sweep_options.overrides.end(), reduced.begin(), reduced.end());
    Sweep sweep(std::move(settings), sweep_options);
    const std::filesystem::path folder = options.folder / "measured";
    std::filesystem::create_directories(folder);
    const std::optional<std::string> program = program_identity();
    if (!program) throw InputError("cannot read this program's own file, which identifies the stored runs");
    RunStore store = store_of(folder / (std::string(name) + ".sqlite"), sweep, *program);
    const std::vector<std::size_t> todo = missing_points(sweep, Shard{}, store);
    const double before =
        options.on_stored ? 1.0 - static_cast<double>(todo.size()) / static_cast<double>(sweep.points()) : 0.0;
    const auto experiment_share = [range](double share) { return range.from + share * (range.to - range.from); };
    if (options.on_stored) options.on_stored(experiment_share(before));
    SweepRunOptions run_options;
    run_options.threads = options.threads;
    run_options.run = function;
    run_options.on_progress = [&](double share) {
        return !options.on_progress || options.on_progress(experiment_share(before + share * (1.0 - before)));
    };
    const SweepSession session = run_points(sweep, todo, store, run_options);
    for (const SweepFailure& failure : session.failures) {
        throw InputError(fmt::format("{}: {}", sweep.describe(failure.point), failure.message));
    }
    SweepTotals totals = sweep_results(store).totals;
    return {std::move(sweep), std::move(store), totals};
}

}  // namespace stopline

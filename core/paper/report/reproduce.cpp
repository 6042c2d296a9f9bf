#include "paper/report/reproduce.h"

#include <algorithm>
#include <chrono>
#include <ctime>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "base/input_error.h"
#include "base/io/csv.h"
#include "base/io/data_directory.h"
#include "base/io/output.h"
#include "base/io/replaced_file.h"
#include "base/text_hash.h"
#include "figures/gnuplot.h"
#include "paper/report/work_estimate.h"
#include "runs/interrupted.h"
#include "runs/program_identity.h"

namespace stopline {

namespace {

namespace fs = std::filesystem;

using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point begin) { return std::chrono::duration<double>(Clock::now() - begin).count(); }

// Returns the processor time of all threads of this program, s. Processes that the program starts, such as gnuplot, are
// not included.
double processor_seconds() { return static_cast<double>(std::clock()) / CLOCKS_PER_SEC; }

// Returns true for a data file that no job reads. A change of such a file does not make finished jobs invalid.
bool is_report_input(const fs::path& file) {
    return file.filename() == "explanations.csv" || file.filename() == "figures.csv" || file.extension() == ".png" ||
           file.extension() == ".md";
}

// Returns a hash of the names and contents of all scenario and data files that jobs may read.
std::uint64_t hash_of_inputs() {
    std::vector<fs::path> files;
    const fs::path scenarios = scenario_directory();  // throws InputError if a folder is missing
    for (const fs::path& folder : {data_directory(), scenarios}) {
        for (const fs::directory_entry& entry : fs::recursive_directory_iterator(folder)) {
            if (entry.is_regular_file() && !is_report_input(entry.path())) files.push_back(entry.path());
        }
    }
    std::sort(files.begin(), files.end());
    std::string all;
    for (const fs::path& file : files)
        all += fmt::format("{} {:016x}\n", file.filename().string(), hash_of(read_file(file)));
    return hash_of(all);
}

std::string key_of(const Reductions& reductions) {
    const std::optional<std::string> program = program_identity();
    if (!program) throw InputError("cannot read this program's own file, which identifies the finished jobs");
    return fmt::format("{}, inputs {:016x}, {}", *program, hash_of_inputs(),
                       reductions.rows().empty() ? "whole" : "reduced");
}

// Runs the jobs of one call of run_jobs, and reports the progress of all these jobs together.
class Session {
public:
    Session(const ReproduceOptions& options, std::vector<const Job*> jobs)
        : options_(options),
          jobs_(std::move(jobs)),
          key_(key_of(options.reductions)),
          folder_(jobs_folder(options)),
          begin_(Clock::now()),
          estimate_(expected(), options.threads) {
        prepare_folder(folder_);
        remove_stale_parts(folder_);
        for (const Job* job : jobs_) remove_stale_parts(folder_ / job->name);
    }

    std::vector<JobResult> run() {
        std::vector<std::optional<JobOutput>> stored;
        for (std::size_t k = 0; k < jobs_.size(); ++k) {
            stored.push_back(load_record(folder_ / jobs_[k]->name, key_));
            if (stored.back()) estimate_.skip(k);
        }
        std::vector<JobResult> ends;
        for (std::size_t k = 0; k < jobs_.size(); ++k) {
            JobResult end{jobs_[k], folder_ / jobs_[k]->name, {}, "", {}};
            if (stored[k]) {
                end.output = *stored[k];
                send_message(k, "done before");
            } else {
                run_job(k, end);
            }
            read_measured(end);
            ends.push_back(std::move(end));
        }
        return ends;
    }

private:
    std::vector<double> expected() const {
        std::vector<double> seconds;
        for (const Job* job : jobs_) {
            seconds.push_back(options_.reductions.rows().empty() ? job->expected_s : job->quick_expected_s);
        }
        return seconds;
    }

    void send_message(std::size_t k, const std::string& outcome) const {
        if (!options_.on_message) return;
        options_.on_message(
            fmt::format("{:2}/{}  {:<4} {:<36} {}", k + 1, jobs_.size(), jobs_[k]->section, jobs_[k]->title, outcome));
    }

    // Reports the progress while job `k` runs. Returns false if the user wants to stop.
    bool show_progress(std::size_t k) const {
        if (!options_.on_progress) return true;
        return options_.on_progress({estimate_.share(), estimate_.remaining_s(seconds_since(begin_)),
                                     fmt::format("{}: {}", jobs_[k]->section, jobs_[k]->title)});
    }

    void run_job(std::size_t k, JobResult& end) {
        const Job& job = *jobs_[k];
        const Clock::time_point begin = Clock::now();
        const double processor_begin_s = processor_seconds();
        estimate_.begin(k, seconds_since(begin_));
        JobContext context{end.folder, folder_ / "stores", options_.reductions, key_, options_.threads, {}, {}};
        context.on_progress = [&](double share) {
            estimate_.progress(share);
            return show_progress(k);
        };
        context.on_stored = [&](double share) { estimate_.stored(share); };
        if (!show_progress(k)) throw Interrupted();
        try {
            prepare_folder(end.folder);
            end.output = job.run(context);
            store_record(end.folder, key_, end.output);
            send_message(k, fmt::format("{:.1f} s", seconds_since(begin)));
            store_time(job, seconds_since(begin), processor_seconds() - processor_begin_s);
        } catch (const Interrupted&) {
            throw;
        } catch (const std::exception& error) {
            // The failure may only be a consequence of Ctrl-C, which also ends gnuplot. In this case the run is
            // interrupted, and no failure is reported.
            if (!show_progress(k)) throw Interrupted();
            end.output = {};
            end.problem = error.what();
            send_message(k, fmt::format("FAILED: {}", error.what()));
        }
        estimate_.end(seconds_since(begin_));
    }

    void read_measured(JobResult& end) const {
        for (const std::string& experiment : end.output.measured) {
            const std::optional<Measurements> measured = load_measurements(measured_file(end.folder, experiment), key_);
            if (measured) end.measured[experiment] = *measured;
        }
    }

    void store_time(const Job& job, double wall_s, double processor_s) const {
        const fs::path file = folder_ / "times.csv";
        CsvWriter csv({"job", "threads", "wall_s", "processor_s"});
        if (fs::exists(file)) {
            try {  // copies the rows of other jobs
                for (const std::vector<std::string>& row : parse_csv(read_file(file), file.string()).rows) {
                    if (row.size() == 4 && row[0] != job.name) csv.row(row);
                }
            } catch (const InputError&) {  // a damaged times.csv is replaced
            }
        }
        csv.row({job.name, fmt::format("{}", options_.threads), fixed(wall_s, 1), fixed(processor_s, 1)});
        write_file(file, csv.text());
    }

    const ReproduceOptions& options_;
    std::vector<const Job*> jobs_;
    std::string key_;
    fs::path folder_;
    Clock::time_point begin_;
    WorkEstimate estimate_;
};

}  // namespace

std::vector<std::string> known_sections() {
    std::vector<std::string> sections;
    for (const Job& job : all_jobs()) {
        if (sections.empty() || sections.back() != job.section) sections.emplace_back(job.section);
    }
    sections.emplace_back("all");
    return sections;
}

fs::path jobs_folder(const ReproduceOptions& options) {
    return options.folder / (options.reductions.rows().empty() ? "runs" : "runs_reduced");
}

std::vector<JobResult> run_jobs(const ReproduceOptions& options) {
    std::vector<const Job*> jobs = jobs_of(options.section);
    if (jobs.empty()) {
        throw InputError(
            fmt::format("section '{}' has no jobs; allowed: {}", options.section, fmt::join(known_sections(), ", ")));
    }
    prepare_folder(options.folder);
    if (!gnuplot_installed())
        throw InputError("gnuplot is needed for the figures; install the Debian package gnuplot-nox");
    return Session(options, std::move(jobs)).run();
}

}  // namespace stopline

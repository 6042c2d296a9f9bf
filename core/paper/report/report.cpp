#include "paper/report/report.h"

#include <algorithm>
#include <set>
#include <sstream>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "base/input_error.h"
#include "base/io/base64.h"
#include "base/io/data_directory.h"
#include "base/io/output.h"
#include "base/io/replaced_file.h"
#include "base/version.h"
#include "paper/report/html.h"
#include "paper/report/job_writer.h"
#include "paper/report/machine.h"
#include "runs/program_identity.h"

namespace stopline {

namespace {

namespace fs = std::filesystem;

// The page embeds a drawing as SVG up to this size, and a larger drawing as PNG.
constexpr std::size_t kMaxSvg_bytes = 500'000;

// Writes the files of the report. finish() removes the files of an earlier report that were not written again.
class ReportFiles {
public:
    explicit ReportFiles(fs::path folder) : folder_(std::move(folder)) {
        for (const char* sub : {"", "figures", "tables"}) {
            prepare_folder(folder_ / sub);
            remove_stale_parts(folder_ / sub);
        }
    }
    void put(const std::string& name, const std::string& content) {
        write_file(folder_ / name, content);
        names_.insert(name);
    }
    // `list` is a file with the names of the report's files. finish() reads the names that the earlier report stored,
    // and then stores the names of this report.
    void finish(const fs::path& list) {
        if (fs::exists(list)) {
            std::istringstream earlier(read_file(list));
            std::error_code ignored;
            for (std::string name; std::getline(earlier, name);) {
                const bool in_report = name.starts_with("figures/") || name.starts_with("tables/");
                if (in_report && name.find("..") == std::string::npos && !names_.contains(name)) {
                    fs::remove(folder_ / name, ignored);
                }
            }
        }
        std::string text;
        for (const std::string& name : names_) text += name + "\n";
        write_file(list, text);
    }

private:
    fs::path folder_;
    std::set<std::string> names_;
};

const JobResult* job_named(const std::vector<JobResult>& jobs, const std::string& name) {
    const auto found =
        std::find_if(jobs.begin(), jobs.end(), [&](const JobResult& end) { return name == end.job->name; });
    return found == jobs.end() ? nullptr : &*found;
}

std::string picture_of(const std::string& svg, const std::string& png) {
    if (svg.size() <= kMaxSvg_bytes) return "data:image/svg+xml;base64," + encode_base64(svg);
    return "data:image/png;base64," + encode_base64(png);
}

// Draws Fig. 23, the only figure of the scorecard. Returns it in the form of a job result, with the scenarios and seeds
// of the jobs whose measurements the figure shows.
JobResult comparison_job(const ReproduceOptions& options, const std::vector<JobResult>& jobs,
                         const Scorecard& scorecard) {
    JobContext context;
    context.folder = jobs_folder(options) / kComparisonJob;
    context.reductions = options.reductions;
    JobWriter writer(context);
    writer.figures(scorecard.figures);
    std::vector<std::string> scenarios;
    for (const char* name : {"intersection_table", "arterial", "grid"}) {
        const JobResult* const job = job_named(jobs, name);
        if (job == nullptr) continue;
        for (const auto& [condition, text] : job->output.conditions) {
            if (condition == "Scenario") scenarios.push_back(text);
        }
        writer.output.seeds.insert(job->output.seeds.begin(), job->output.seeds.end());
    }
    writer.condition("Scenarios", fmt::format("{}", fmt::join(scenarios, "; ")));
    writer.command("stopline-scorecard");
    return {nullptr, context.folder, writer.output, "", {}};
}

// Fills in drawing or table, conditions, seeds and commands of a figure. `end` is the result of the job that makes the
// figure.
void fill_figure(ShownFigure& shown, const JobResult& end, ReportFiles& files) {
    if (!end.problem.empty()) {
        shown.problem = "the runs failed: " + end.problem;
        return;
    }
    const std::string& name = shown.listed.file;
    const std::vector<std::string>& available = shown.listed.is_table() ? end.output.tables : end.output.figures;
    if (std::find(available.begin(), available.end(), name) == available.end()) {
        shown.problem = "these runs do not include it";
        return;
    }
    shown.conditions = end.output.conditions;
    shown.seeds = seeds_text(end.output.seeds);
    shown.commands = end.output.commands;
    if (shown.listed.is_table()) {
        shown.table = html_of_csv(read_file(end.folder / name), name);
        return;
    }
    const std::string svg = read_file(end.folder / (name + ".svg"));
    const std::string png = read_file(end.folder / (name + ".png"));
    files.put("figures/" + shown.listed.id() + ".svg", svg);
    files.put("figures/" + shown.listed.id() + ".png", png);
    shown.picture = picture_of(svg, png);
}

}  // namespace

ReportContent write_report(const ReproduceOptions& options, const std::vector<JobResult>& jobs,
                           const std::string& command) {
    ReportContent content;
    content.section = options.section;
    content.command = command;
    content.version = version();
    content.program = program_identity().value_or("");
    content.machine = machine_text();
    content.reductions = options.reductions;
    std::map<std::string, Measurements> measured;
    std::set<std::uint64_t> seeds;
    ReportFiles files(options.folder);
    for (const JobResult& end : jobs) {
        measured.insert(end.measured.begin(), end.measured.end());
        seeds.insert(end.output.seeds.begin(), end.output.seeds.end());
        if (!end.problem.empty()) content.problems.push_back(fmt::format("{}: {}", end.job->title, end.problem));
        for (const std::string& table : end.output.tables) {
            const std::string name = fmt::format("{}_{}", end.job->name, html_id(table.substr(0, table.size() - 4)));
            files.put("tables/" + name + ".csv", read_file(end.folder / table));
            content.tables.push_back(name + ".csv");
        }
    }
    content.seeds = seeds_text(seeds);
    content.scorecard = score(options.section == "all" ? "" : options.section, measured);
    files.put("tables/scorecard.csv", scorecard_csv(content.scorecard));
    content.tables.insert(content.tables.begin(), "scorecard.csv");
    const JobResult comparison = comparison_job(options, jobs, content.scorecard);
    for (const ListedFigure& listed : load_figure_list(data_directory() / "paper" / "figures.csv")) {
        if (options.section != "all" && listed.major_section() != options.section) continue;
        ShownFigure shown{listed, "", "", "", {}, "", {}};
        const JobResult* const end = listed.job == kComparisonJob ? &comparison : job_named(jobs, listed.job);
        if (end != nullptr) fill_figure(shown, *end, files);
        content.figures.push_back(std::move(shown));
    }
    write_file(options.folder / "index.html", report_page(content));
    files.finish(jobs_folder(options).parent_path() / ".report_files");
    return content;
}

}  // namespace stopline

#include "report/report.h"

#include <algorithm>
#include <set>
#include <sstream>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "base/input_error.h"
#include "base/replaced_file.h"
#include "base/version.h"
#include "experiment/output.h"
#include "experiment/program_identity.h"
#include "report/html.h"
#include "report/job_writer.h"
#include "report/machine.h"
#include "scenario/load_scenario.h"

namespace stopline {

namespace {

namespace fs = std::filesystem;

// Larger drawings go into the page as PNG.
constexpr std::size_t kSvgMost_bytes = 500'000;

// What is written into the report's folder, by name.
class Files {
public:
    explicit Files(fs::path folder) : folder_(std::move(folder)) {
        for (const char* sub : {"", "figures", "tables"}) {
            prepare_folder(folder_ / sub);
            remove_left_parts(folder_ / sub);
        }
    }
    void put(const std::string& name, const std::string& content) {
        write_file(folder_ / name, content);
        names_.insert(name);
    }
    // Files of an earlier report that this one does not have.
    void finish(const fs::path& list) {
        if (fs::exists(list)) {
            std::istringstream earlier(read_file(list));
            std::error_code ignored;
            for (std::string name; std::getline(earlier, name);) {
                const bool ours = name.starts_with("figures/") || name.starts_with("tables/");
                if (ours && name.find("..") == std::string::npos && !names_.contains(name)) {
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

const JobEnd* job_named(const std::vector<JobEnd>& jobs, const std::string& name) {
    const auto found = std::find_if(jobs.begin(), jobs.end(), [&](const JobEnd& end) { return name == end.job->name; });
    return found == jobs.end() ? nullptr : &*found;
}

std::string picture_of(const std::string& svg, const std::string& png) {
    if (svg.size() <= kSvgMost_bytes) return "data:image/svg+xml;base64," + base64(svg);
    return "data:image/png;base64," + base64(png);
}

// Fig. 23, from what all jobs measured.
JobEnd comparison_job(const ReproduceOptions& options, const std::vector<JobEnd>& jobs, const Scorecard& scorecard) {
    JobContext context;
    context.folder = jobs_folder(options) / kComparisonJob;
    context.reductions = options.reductions;
    JobWriter writer(context);
    writer.figures(scorecard.figures);
    std::vector<std::string> scenarios;
    for (const char* name : {"intersection_table", "arterial", "grid"}) {
        const JobEnd* const from = job_named(jobs, name);
        if (from == nullptr) continue;
        for (const auto& [what, words] : from->output.conditions) {
            if (what == "Scenario") scenarios.push_back(words);
        }
        writer.output.seeds.insert(from->output.seeds.begin(), from->output.seeds.end());
    }
    writer.condition("Scenarios", fmt::format("{}", fmt::join(scenarios, "; ")));
    writer.command("stopline-scorecard");
    return {nullptr, context.folder, writer.output, "", {}};
}

void find(ShownFigure& shown, const JobEnd& end, Files& files) {
    if (!end.problem.empty()) {
        shown.problem = "the runs failed: " + end.problem;
        return;
    }
    const std::string& name = shown.listed.file;
    const std::vector<std::string>& has = shown.listed.is_table() ? end.output.tables : end.output.figures;
    if (std::find(has.begin(), has.end(), name) == has.end()) {
        shown.problem = "not among what was run";
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

ReportContent write_report(const ReproduceOptions& options, const std::vector<JobEnd>& jobs,
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
    Files files(options.folder);
    for (const JobEnd& end : jobs) {
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
    const JobEnd comparison = comparison_job(options, jobs, content.scorecard);
    for (const ListedFigure& listed : load_figure_list(data_directory() / "paper" / "figures.csv")) {
        if (options.section != "all" && listed.major_section() != options.section) continue;
        ShownFigure shown{listed, "", "", "", {}, "", {}};
        const JobEnd* const end = listed.job == kComparisonJob ? &comparison : job_named(jobs, listed.job);
        if (end != nullptr) find(shown, *end, files);
        content.figures.push_back(std::move(shown));
    }
    write_file(options.folder / "index.html", report_page(content));
    files.finish(jobs_folder(options).parent_path() / ".report_files");
    return content;
}

}  // namespace stopline

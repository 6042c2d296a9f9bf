// Report of a reproduction: index.html, which needs no other file, figures/ (SVG and PNG) and tables/ (CSV).
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "paper/report/figure_list.h"
#include "paper/report/reproduce.h"
#include "paper/scorecard.h"

namespace stopline {

// A figure of the paper with our result.
struct ShownFigure {
    ListedFigure listed;
    std::string picture;  // "data:" URI; empty for a table
    std::string table;    // HTML; empty for a picture
    std::string problem;  // reason why both are missing
    std::vector<std::pair<std::string, std::string>> conditions;
    std::string seeds;
    std::vector<std::string> commands;
};

struct ReportContent {
    std::string section;  // requested section
    std::string command;  // command that makes the report
    std::string version;
    std::string program;  // identity of the program file
    std::string machine;
    std::string seeds;
    Reductions reductions;
    Scorecard scorecard;
    std::vector<ShownFigure> figures;
    std::vector<std::string> tables;    // file names in tables/
    std::vector<std::string> problems;  // messages of failed jobs

    bool reduced() const { return !reductions.rows().empty(); }
};

// Returns the page. The same content gives the same bytes.
std::string report_page(const ReportContent& content);

// Writes the report into options.folder and removes the files of an earlier report that this one does not have.
// `command` is shown as the command of the report. Throws InputError if a file cannot be written.
ReportContent write_report(const ReproduceOptions& options, const std::vector<JobResult>& jobs,
                           const std::string& command);

}  // namespace stopline

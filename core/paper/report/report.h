// Report of a reproduction. index.html contains all figures, so it can be read alone. The folders figures/ (SVG and
// PNG) and tables/ (CSV) hold the figures and tables as files.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "paper/report/figure_list.h"
#include "paper/report/reproduce.h"
#include "paper/scorecard.h"

namespace stopline {

// A figure or table of the paper with our counterpart.
struct ShownFigure {
    ListedFigure listed;
    std::string picture;  // drawing as "data:" URI; empty for a table
    std::string table;    // table as HTML; empty for a drawing
    std::string problem;  // reason why drawing and table are missing; otherwise empty
    std::vector<std::pair<std::string, std::string>> conditions;
    std::string seeds;
    std::vector<std::string> commands;
};

struct ReportContent {
    std::string section;  // section that the user requested, or "all"
    std::string command;  // command that makes the report
    std::string version;
    std::string program;  // text that identifies the program file
    std::string machine;
    std::string seeds;
    Reductions reductions;
    Scorecard scorecard;
    std::vector<ShownFigure> figures;
    std::vector<std::string> tables;    // file names in tables/
    std::vector<std::string> problems;  // messages of failed jobs

    bool reduced() const { return !reductions.rows().empty(); }
};

// Returns the HTML page. The same content gives the same bytes.
std::string report_page(const ReportContent& content);

// Writes the report into options.folder. Removes figures and tables of an earlier report that the new report does not
// contain. The page shows `command` as the command that made the report. Throws InputError if a file cannot be written.
ReportContent write_report(const ReproduceOptions& options, const std::vector<JobResult>& jobs,
                           const std::string& command);

}  // namespace stopline

// The report of a reproduction: index.html, which needs nothing beside it, figures/ (SVG and PNG) and tables/ (CSV).
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "experiment/scorecard.h"
#include "report/figure_list.h"
#include "report/reproduce.h"

namespace stopline {

// A figure of the paper with what was found for it.
struct ShownFigure {
    ListedFigure listed;
    std::string picture;  // "data:" URI; empty: none, or a table
    std::string table;    // HTML; empty: none, or a picture
    std::string problem;  // why there is neither; empty: there is one
    std::vector<std::pair<std::string, std::string>> conditions;
    std::string seeds;
    std::vector<std::string> commands;
};

struct ReportContent {
    std::string section;  // that was asked for
    std::string command;  // that makes the report
    std::string version;
    std::string program;  // identity
    std::string machine;
    std::string seeds;
    Reductions reductions;
    Scorecard scorecard;
    std::vector<ShownFigure> figures;
    std::vector<std::string> tables;    // file names in tables/
    std::vector<std::string> problems;  // of jobs that failed

    bool reduced() const { return !reductions.rows().empty(); }
};

// The page: the same content gives the same bytes.
std::string report_page(const ReportContent& content);

// Writes the report into options.folder and removes what an earlier report left there and this one does not have. `command` made it.
// Throws InputError where something cannot be written.
ReportContent write_report(const ReproduceOptions& options, const std::vector<JobEnd>& jobs,
                           const std::string& command);

}  // namespace stopline

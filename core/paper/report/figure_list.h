// Figures and tables of the report, one for each row of data/paper/figures.csv (columns
// figure,section,job,file,title,caption).
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace stopline {

struct ListedFigure {
    std::string figure;   // number in the paper, such as "Fig. 5" or "Table 1"
    std::string section;  // section of the paper, such as III.E
    std::string job;      // job that makes the figure; empty: no figure is made, and the caption says why
    std::string file;     // in the job's folder: NAME for a figure (NAME.svg, NAME.png), NAME.csv for a table
    std::string title;
    std::string caption;

    bool is_table() const { return file.ends_with(".csv"); }
    std::string major_section() const { return section.substr(0, section.find('.')); }
    // Returns the identifier of the figure, such as fig05_counters. The files of the figure and its anchor in the page
    // have this name.
    std::string id() const;
};

// Loads the list. Throws InputError if the file cannot be read or a row names an unknown job.
std::vector<ListedFigure> load_figure_list(const std::filesystem::path& file);

// Entry in the column `job` for Fig. 23. No job makes this figure. The report draws it from the measurements of several
// jobs.
inline constexpr const char* kComparisonJob = "comparison";

}  // namespace stopline

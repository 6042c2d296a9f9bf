// Figures and tables of the report, one for each row of data/paper/figures.csv (columns
// figure,section,job,file,title,caption).
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace stopline {

struct ListedFigure {
    std::string figure;   // number in the paper: "Fig. 5", "Table 1"
    std::string section;  // such as III.E
    std::string job;      // job that makes it; empty: not drawn, and the caption says why
    std::string file;     // file in the job's folder: NAME of NAME.svg and NAME.png, or a table NAME.csv
    std::string title;
    std::string caption;  // in our own words

    bool is_table() const { return file.ends_with(".csv"); }
    std::string major_section() const { return section.substr(0, section.find('.')); }
    // Returns the name of its files and its anchor in the page, such as fig05_counters.
    std::string id() const;
};

// Throws InputError if the file cannot be read or a row names an unknown job.
std::vector<ListedFigure> load_figure_list(const std::filesystem::path& file);

// Job name for Fig. 23, which the report itself draws from the measurements of several jobs.
inline constexpr const char* kComparisonJob = "comparison";

}  // namespace stopline

// The figures and tables of the paper as the report shows them: data/paper/figures.csv, columns figure,section,job,file,title,caption.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace stopline {

struct ListedFigure {
    std::string figure;   // of the paper: "Fig. 5", "Table 1"
    std::string section;  // III.E
    std::string job;      // that makes it; "": we do not draw it, the caption says why
    std::string file;     // NAME of NAME.svg and NAME.png in the job's folder, or a table NAME.csv
    std::string title;
    std::string caption;  // in our own words

    bool is_table() const { return file.ends_with(".csv"); }
    std::string major_section() const { return section.substr(0, section.find('.')); }
    // Of its files in the report and of its place in the page: fig05_counters.
    std::string id() const;
};

// Throws InputError where the file cannot be read or a row cannot be understood (an unknown job).
std::vector<ListedFigure> load_figure_list(const std::filesystem::path& file);

// A job's name that stands for what the report itself draws from all jobs: Fig. 23.
inline constexpr const char* kComparisonJob = "comparison";

}  // namespace stopline

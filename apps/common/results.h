// Helpers for programs that store results or draw figures.
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "figures/gnuplot.h"

namespace stopline {

// Returns program_identity(), a text with a hash of the program file, which is stored with the results. Throws
// InputError if the program file cannot be read.
std::string required_program_identity();

// Draws the figures as SVG and PNG into `folder` and prints their names. If there is nothing to draw, prints the
// reason. If a figure fails, the others are still drawn and the first error is thrown at the end. Throws Interrupted
// after Ctrl-C.
void draw_figures(const std::vector<Figure>& figures, const std::filesystem::path& folder);

// The tables and figures in a folder, with the times at which they were last written.
using ResultFiles = std::map<std::string, std::filesystem::file_time_type>;
ResultFiles result_files(const std::filesystem::path& folder);

// Prints the names of the tables and figures in `folder` that have not changed since `before` was taken.
void print_unchanged_files(const std::filesystem::path& folder, const ResultFiles& before);

}  // namespace stopline

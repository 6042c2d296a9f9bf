// Helpers for programs that store results or draw figures.
#pragma once

#include <filesystem>
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

// Prints the names of the tables and figures in `folder` that were written before `start`: earlier runs left them.
void print_older_files(const std::filesystem::path& folder, std::filesystem::file_time_type start);

}  // namespace stopline

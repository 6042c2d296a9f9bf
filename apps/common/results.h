// Helpers of programs that store results or draw figures.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "figures/gnuplot.h"

namespace stopline {

// Returns program_identity(). Throws InputError if the program cannot read its own file.
std::string required_program_identity();

// Draws the figures as SVG and PNG into `folder` and prints their names. Prints why a figure is left out.
// A figure that fails does not stop the others: the first error is thrown at the end. Throws Interrupted after Ctrl-C.
void draw_figures(const std::vector<Figure>& figures, const std::filesystem::path& folder);

}  // namespace stopline

// What programs that keep or draw results share.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "experiment/gnuplot.h"

namespace stopline {

// program_identity(), for stores. Throws InputError where the program cannot be read.
std::string identity_of_program();

// Draws them as SVG and PNG, naming each; says so where gnuplot is missing, and why a figure with nothing to draw is left out. One that
// cannot be drawn costs only itself: the first such error is thrown behind the others. Throws Interrupted.
void draw_all(const std::vector<Figure>& figures, const std::filesystem::path& folder);

}  // namespace stopline

// Draws figures with gnuplot as SVG and PNG. The data and the script stay beside the figure, so that a user can restyle
// the figure. The command `gnuplot NAME.gp` in the folder of the script draws the figure again.
#pragma once

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

namespace stopline {

struct Figure {
    std::string name;  // files NAME.svg, NAME.png, NAME.gp
    int width_px = 900;
    int height_px = 560;
    std::vector<std::pair<std::string, std::string>> data;  // names and contents of the files that the script reads
    // gnuplot commands that draw the figure. The script contains these commands twice, for SVG and for PNG. Before the
    // commands, the script sets terminal, output, font, axes without a box, a light grid, and the line types 1 to 16 of
    // line_style(). A command must not have a line break inside quotes.
    std::string body;
    std::string nothing;  // reason why there is nothing to draw; empty for a complete figure
};

// Colour, dash and point of a line. The eight colours are those of Okabe and Ito (2008), which colour-blind readers can
// distinguish. Grey replaces the yellow of these eight, because yellow is too light on white. Beyond eight lines, the
// colours repeat with other dashes.
struct LineStyle {
    std::string colour;    // #rrggbb
    int dash = 1;          // gnuplot dash type
    int hollow_point = 6;  // gnuplot point type, not filled
};
LineStyle line_style(std::size_t index);

// Returns the colour for item `index` of `count` ordered items, from dark to light (viridis).
std::string ordered_colour(std::size_t index, std::size_t count);

// Returns the text in single quotes for gnuplot, with _ ^ @ & ~ { } escaped.
std::string gnuplot_text(const std::string& text);

bool gnuplot_installed();

// Draws the figure and returns the files written, pictures first. Throws InputError with gnuplot's message if gnuplot
// fails; data and script are still written. Throws InputError if there is nothing to draw.
std::vector<std::filesystem::path> draw(const Figure& figure, const std::filesystem::path& folder);

}  // namespace stopline

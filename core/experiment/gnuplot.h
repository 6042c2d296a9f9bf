// Figures through gnuplot: data and script are written beside the figure, then drawn as SVG and PNG. They are kept, so that a
// reader can restyle a figure: `gnuplot NAME.gp` in its folder draws it again.
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
    std::vector<std::pair<std::string, std::string>> data;  // file name and text; the script reads them by these names
    // gnuplot commands that draw the figure once. They find set: terminal, output, font, axes without a box, a light grid, and
    // the line types 1..8 as in line_style(). No command may hold a line break inside quotes.
    std::string body;
    std::string nothing;  // why there is nothing to draw; empty: there is
};

// The colours of Okabe and Ito (2008), which colour-blind readers can tell apart, without their yellow (too light on white),
// with a grey; each with its own pair of dash and point. Repeats after 8.
struct LineStyle {
    std::string colour;    // #rrggbb
    int dash = 1;          // gnuplot dash type
    int hollow_point = 6;  // gnuplot point type, not filled
};
LineStyle line_style(std::size_t index);

// A dark-to-light colour (viridis) for the `index`-th of `count` ordered things.
std::string ordered_colour(std::size_t index, std::size_t count);

// Text in single quotes for gnuplot, without the special meaning of _ ^ @ & ~ { }.
std::string gnuplot_text(const std::string& text);

bool gnuplot_installed();

// Draws, and returns the files made, figures first. Throws InputError with gnuplot's own words where it fails; data and script
// are there all the same. So does a figure with nothing to draw.
std::vector<std::filesystem::path> draw(const Figure& figure, const std::filesystem::path& folder);

}  // namespace stopline

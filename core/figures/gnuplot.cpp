#include "figures/gnuplot.h"

#include <algorithm>
#include <array>
#include <system_error>

#include <fmt/format.h>

#include "base/input_error.h"
#include "base/io/child_process.h"
#include "base/io/output.h"
#include "base/io/replaced_file.h"

namespace stopline {

namespace {

namespace fs = std::filesystem;

constexpr const char* kHead = R"(# Draws {name}.svg and {name}.png from the data beside it: gnuplot {name}.gp
if (!exists("prefix")) prefix = ''
if (!exists("suffix")) suffix = ''
set encoding utf8
set border 3 lc rgb '#404040'
set tics nomirror out scale 0.5
set grid back lt 1 dt 1 lc rgb '#dddddd' lw 0.6
set key reverse Left noenhanced spacing 1.15 samplen 4
set style textbox opaque fillcolor rgb 'white' noborder margins 0.6,0.3
)";

constexpr const char* kLoop = R"(do for [kind in "svg png"] {{
if (kind eq 'svg') {{
set terminal svg size {width},{height} enhanced font 'DejaVu Sans,13' background rgb 'white'
}} else {{
set terminal pngcairo size {width2},{height2} enhanced font 'DejaVu Sans,13' fontscale 1.5 linewidth 2 pointscale 2 dashlength 1
}}
set output prefix.'{name}.'.kind.suffix
{body}
set output
}}
)";

std::string line_types() {
    std::string text;
    for (std::size_t k = 0; k < 16; ++k) {
        const LineStyle style = line_style(k);
        text += fmt::format("set linetype {} lc rgb '{}' dt {} pt {} lw 1.8\n", k + 1, style.colour, style.dash,
                            style.hollow_point);
    }
    return text;
}

std::string script_of(const Figure& figure) {
    std::string script = fmt::format(fmt::runtime(kHead), fmt::arg("name", figure.name)) + line_types();
    return script + fmt::format(fmt::runtime(kLoop), fmt::arg("name", figure.name), fmt::arg("width", figure.width_px),
                                fmt::arg("height", figure.height_px), fmt::arg("width2", 2 * figure.width_px),
                                fmt::arg("height2", 2 * figure.height_px), fmt::arg("body", figure.body));
}

[[noreturn]] void fail(const Figure& figure, const fs::path& folder, const std::string& reason) {
    throw InputError(fmt::format("cannot draw {}: {}\n(its script: {})", (folder / figure.name).string(), reason,
                                 (folder / (figure.name + ".gp")).string()));
}

// Returns true if the file is a complete picture, with the end mark of SVG or PNG near its end. This check is needed
// because gnuplot reports no error if the disk is full.
bool complete(const fs::path& file) {
    std::error_code error;
    if (!fs::is_regular_file(file, error)) return false;
    const std::string text = read_file(file);
    const std::string tail = text.substr(text.size() - std::min<std::size_t>(text.size(), 32));
    return tail.find("</svg>") != std::string::npos || tail.find("IEND") != std::string::npos;
}

}  // namespace

LineStyle line_style(std::size_t index) {
    static const std::array<LineStyle, 8> kStyles{{{"#0072B2", 1, 6},
                                                   {"#56B4E9", 2, 4},
                                                   {"#009E73", 1, 8},
                                                   {"#E69F00", 4, 10},
                                                   {"#CC79A7", 1, 12},
                                                   {"#000000", 1, 14},
                                                   {"#D55E00", 2, 6},
                                                   {"#7F7F7F", 4, 8}}};
    LineStyle style = kStyles[index % kStyles.size()];
    if (index >= kStyles.size()) style.dash = style.dash == 1 ? 3 : 5;  // the colours repeat with other dashes
    return style;
}

std::string ordered_colour(std::size_t index, std::size_t count) {
    static const std::array<const char*, 8> kViridis{"#440154", "#46327e", "#365c8d", "#277f8e",
                                                     "#1fa187", "#4ac16d", "#8fcc2a", "#d4b511"};
    const std::size_t steps = std::max<std::size_t>(1, count - 1);
    return kViridis[std::min<std::size_t>(7, (index * 7 + steps / 2) / steps)];
}

std::string gnuplot_text(const std::string& text) {
    std::string quoted = "'";
    for (const char c : text) {
        if (c == '\'')
            quoted += "''";
        else if (std::string_view("_^@&~{}\\").find(c) != std::string_view::npos)
            quoted += std::string("\\") + c;
        else
            quoted += c == '\n' ? ' ' : c;
    }
    return quoted + "'";
}

bool gnuplot_installed() {
    const ProcessResult ended = run_process({"gnuplot", "--version"}, ".");
    return !ended.failed();
}

std::vector<fs::path> draw(const Figure& figure, const fs::path& folder) {
    if (!figure.nothing.empty()) throw InputError(fmt::format("cannot draw {}: {}", figure.name, figure.nothing));
    std::vector<fs::path> files{folder / (figure.name + ".svg"), folder / (figure.name + ".png")};
    for (const auto& [name, text] : figure.data) {
        write_file(folder / name, text);
        files.push_back(folder / name);
    }
    files.push_back(folder / (figure.name + ".gp"));
    write_file(files.back(), script_of(figure));
    const std::array<fs::path, 2> parts{temporary_path(files[0]), temporary_path(files[1])};
    const std::string part = parts[0].filename().string();  // .NAME.svg.MACHINE.PROCESS.part
    const std::string suffix = part.substr(1 + files[0].filename().string().size());
    const ProcessResult ended =
        run_process({"gnuplot", "-e", "prefix = '.'; suffix = '" + suffix + "'", figure.name + ".gp"}, folder);
    const bool succeeded = !ended.failed() && std::all_of(parts.begin(), parts.end(), complete);
    std::error_code error;
    for (std::size_t k = 0; k < parts.size(); ++k) {
        if (succeeded && !error) fs::rename(parts[k], files[k], error);
        std::error_code ignored;
        fs::remove(parts[k], ignored);  // after a failure, no part of the two pictures is left
    }
    if (ended.start_error != 0) fail(figure, folder, "gnuplot: " + std::generic_category().message(ended.start_error));
    if (error) fail(figure, folder, error.message());
    if (!succeeded) fail(figure, folder, ended.output.empty() ? "gnuplot wrote an incomplete picture" : ended.output);
    return files;
}

}  // namespace stopline

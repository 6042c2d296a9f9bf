#include "common/results.h"

#include <exception>
#include <optional>

#include <fmt/core.h>

#include "base/input_error.h"
#include "common/program.h"
#include "runs/program_identity.h"

namespace stopline {

std::string required_program_identity() {
    const std::optional<std::string> identity = program_identity();
    if (!identity)
        throw InputError(
            "this program cannot read its own file, which identifies stored runs; make the file readable (chmod +r)");
    return *identity;
}

void draw_figures(const std::vector<Figure>& figures, const std::filesystem::path& folder) {
    if (!gnuplot_installed()) {
        fmt::print("  no figures: gnuplot is not installed (apt-get install gnuplot-nox)\n");
        return;
    }
    std::exception_ptr first_error;
    for (const Figure& figure : figures) {
        if (interrupted()) throw Interrupted();
        if (!figure.nothing.empty()) {
            fmt::print("  no figure {}: {}\n", figure.name, figure.nothing);
            continue;
        }
        try {
            draw(figure, folder);
            fmt::print("  {0}.svg, {0}.png\n", figure.name);
        } catch (const InputError&) {
            if (!first_error) first_error = std::current_exception();
        }
    }
    if (first_error) std::rethrow_exception(first_error);
}

}  // namespace stopline

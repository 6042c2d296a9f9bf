#include "common/results.h"

#include <exception>
#include <optional>

#include <fmt/core.h>

#include "base/input_error.h"
#include "common/program.h"
#include "experiment/program_identity.h"

namespace stopline {

std::string identity_of_program() {
    const std::optional<std::string> identity = program_identity();
    if (!identity) throw InputError("cannot read this program's own file, so that stored runs could not be told apart");
    return *identity;
}

void draw_all(const std::vector<Figure>& figures, const std::filesystem::path& folder) {
    if (!gnuplot_installed()) {
        fmt::print("  no figures: gnuplot is not installed (Debian package gnuplot-nox)\n");
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

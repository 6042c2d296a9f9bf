#include "common/results.h"

#include <algorithm>
#include <exception>
#include <optional>
#include <system_error>

#include <fmt/core.h>
#include <fmt/format.h>

#include "base/input_error.h"
#include "base/io/console.h"
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

ResultFiles result_files(const std::filesystem::path& folder) {
    ResultFiles files;
    std::error_code error;
    for (std::filesystem::directory_iterator entry(folder, error), end; !error && entry != end;
         entry.increment(error)) {
        const std::string name = entry->path().filename().string();
        const bool is_result = name.ends_with(".csv") || name.ends_with(".svg") || name.ends_with(".png") ||
                               name.ends_with(".provenance.json");
        std::error_code unreadable;
        if (!is_result || !entry->is_regular_file(unreadable)) continue;
        const std::filesystem::file_time_type time = entry->last_write_time(unreadable);
        if (!unreadable) files[name] = time;
    }
    return files;
}

void print_unchanged_files(const std::filesystem::path& folder, const ResultFiles& before) {
    const ResultFiles now = result_files(folder);
    std::vector<std::string> names;
    for (const auto& [name, time] : before) {
        const auto found = now.find(name);
        if (found != now.end() && found->second == time) names.push_back(name);
    }
    if (names.empty()) return;
    constexpr std::size_t kListed = 8;
    const std::size_t others = names.size() - std::min(names.size(), kListed);
    names.resize(names.size() - others);
    print_message("note: {} also holds files that this run did not write: {}{}\n", folder.string(),
                  fmt::join(names, ", "), others > 0 ? fmt::format(" and {} more", others) : "");
}

}  // namespace stopline

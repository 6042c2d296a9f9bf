#include "sumo_export/export.h"

#include <algorithm>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "base/input_error.h"
#include "base/io/child_process.h"
#include "base/nearest_name.h"
#include "runs/interrupted.h"
#include "runs/intersection/intersection_run.h"
#include "runs/run_kind.h"
#include "scenario/build_model.h"
#include "scenario/kinds/network_kind.h"
#include "sumo_export/inputs.h"
#include "sumo_export/staged_folder.h"

namespace stopline {

namespace {

constexpr const char* kNetFile = "net.net.xml";

const std::vector<std::string>& netconvert_arguments() {
    static const std::vector<std::string> kArguments{"netconvert",
                                                     "--node-files=nodes.nod.xml",
                                                     "--edge-files=edges.edg.xml",
                                                     "--connection-files=connections.con.xml",
                                                     "--tllogic-files=lights.tll.xml",
                                                     "--no-turnarounds=true",
                                                     "--offset.disable-normalization=true",
                                                     std::string("--output-file=") + kNetFile};
    return kArguments;
}

}  // namespace

double run_end_s(const Scenario& scenario) { return run_kind(scenario).measured_window(scenario).to_s; }

std::vector<std::string> run_with_writers(Simulation& simulation, double end_s,
                                          const std::vector<std::unique_ptr<RunWriter>>& writers,
                                          const std::function<bool(double)>& on_progress) {
    constexpr std::int64_t kProgressTicks = 100;
    const std::int64_t last = to_ticks(end_s, simulation.model().step_s);
    const auto observe = [&] {
        for (const std::unique_ptr<RunWriter>& writer : writers) writer->observe(simulation.state());
    };
    while (simulation.state().tick < last) {
        const std::int64_t tick = simulation.state().tick;
        if (tick % kProgressTicks == 0 && on_progress &&
            !on_progress(static_cast<double>(tick) / static_cast<double>(last))) {
            throw Interrupted();
        }
        observe();
        simulation.step();
    }
    simulation.run_until(end_s);  // checks that no vehicle is lost
    observe();
    std::vector<std::string> summaries;
    for (const std::unique_ptr<RunWriter>& writer : writers) summaries.push_back(writer->finish());
    return summaries;
}

void check_exportable(const Scenario& scenario) {
    if (network_kind(scenario.network).is_exportable) return;
    throw InputError(
        fmt::format("field 'network.kind': value '{}' cannot be exported: the scenario already names SUMO files; "
                    "kinds that can be exported: {}",
                    scenario.network.kind,
                    fmt::join(kinds_with([](const NetworkKind& kind) { return kind.is_exportable; }), ", ")));
}

std::string sumo_limits_note(const Model& model) {
    const bool keeps_distance =
        std::any_of(model.following.begin(), model.following.end(),
                    [](const FollowingModel& following) { return !following.in_sumo().is_same_model; });
    return keeps_distance
               ? "SUMO has no constant-distance model. Such vehicles drive there with a time gap of nearly 0 s, and SUMO "
                 "reports collisions."
               : "";
}

std::string export_to_sumo(const Scenario& scenario, std::size_t population, const std::filesystem::path& folder,
                           const std::function<bool(double)>& on_progress) {
    check_exportable(scenario);
    const Model model = build_model(scenario, population);
    const PlainNetwork network = plain_network(model.graph);
    const double end_s = run_end_s(scenario);
    StagedFolder staged(folder);
    write_sumo_inputs(staged.path(), model, network, end_s);
    std::vector<std::unique_ptr<RunWriter>> writers;
    writers.push_back(make_sumo_route_writer(staged.path() / "vehicles.rou.xml", model, network));
    Simulation simulation(model);
    const std::string summary = run_with_writers(simulation, end_s, writers, on_progress)[0];
    if (has_sumo()) make_net_file(staged.path());
    staged.commit(kNetFile);
    const std::string note = sumo_limits_note(model);
    return note.empty() ? summary : summary + "\n" + note;
}

std::size_t population_index(const Scenario& scenario, const std::string& name) {
    std::vector<std::string> known;
    for (std::size_t k = 0; k < scenario.populations.size(); ++k) {
        if (scenario.populations[k].name == name) return k;
        known.push_back(scenario.populations[k].name);
    }
    throw InputError(fmt::format("there is no population '{}'{}", shortened(name), known_names_hint(name, known)));
}

bool has_sumo() {
    return !run_process({"netconvert", "--version"}, ".").failed() && !run_process({"sumo", "--version"}, ".").failed();
}

std::string netconvert_command(const std::filesystem::path& folder) {
    std::string command = "cd '" + folder.string() + "' &&";
    for (const std::string& argument : netconvert_arguments()) command += " " + argument;
    return command;
}

void make_net_file(const std::filesystem::path& folder) {
    const ProcessResult result = run_process(netconvert_arguments(), folder);
    if (!result.failed()) return;
    throw InputError(fmt::format("netconvert failed in {}:\n{}", folder.string(), result.output));
}

}  // namespace stopline

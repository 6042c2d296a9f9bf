#include "sumo/export.h"

#include <algorithm>

#include <fmt/format.h>

#include "base/child_process.h"
#include "base/input_error.h"
#include "experiment/build_model.h"
#include "experiment/interrupted.h"
#include "experiment/intersection_run.h"
#include "sumo/inputs.h"
#include "sumo/staged_folder.h"

namespace stopline {

namespace {

constexpr const char* kNetFile = "net.net.xml";

const std::vector<std::string>& netconvert_words() {
    static const std::vector<std::string> kWords{"netconvert",
                                                 "--node-files=nodes.nod.xml",
                                                 "--edge-files=edges.edg.xml",
                                                 "--connection-files=connections.con.xml",
                                                 "--tllogic-files=lights.tll.xml",
                                                 "--no-turnarounds=true",
                                                 "--offset.disable-normalization=true",
                                                 std::string("--output-file=") + kNetFile};
    return kWords;
}

}  // namespace

double run_end_s(const Scenario& scenario) {
    return scenario.network.kind == "intersection" ? measured_window(scenario).to_s : scenario.duration_s;
}

std::vector<std::string> run_watched(Simulation& simulation, double end_s,
                                     const std::vector<std::unique_ptr<RunWriter>>& writers,
                                     const std::function<bool(double)>& on_progress) {
    constexpr std::int64_t kReport = 100;
    const std::int64_t last = to_ticks(end_s, simulation.model().step_s);
    const auto look = [&] {
        for (const std::unique_ptr<RunWriter>& writer : writers) writer->look(simulation.state());
    };
    while (simulation.state().tick < last) {
        const std::int64_t tick = simulation.state().tick;
        if (tick % kReport == 0 && on_progress && !on_progress(static_cast<double>(tick) / static_cast<double>(last))) {
            throw Interrupted();
        }
        look();
        simulation.step();
    }
    simulation.run_until(end_s);  // checks that nobody is lost
    look();
    std::vector<std::string> said;
    for (const std::unique_ptr<RunWriter>& writer : writers) said.push_back(writer->finish());
    return said;
}

void check_exportable(const Scenario& scenario) {
    if (scenario.network.kind != "sumo") return;
    throw InputError("networks of the kind 'sumo' are not exported: the scenario names the files that SUMO runs");
}

std::string stand_in_note(const Model& model) {
    const bool keeps_distance =
        std::any_of(model.krauss.begin(), model.krauss.end(), [](const Krauss& k) { return k.constant_distance; });
    return keeps_distance
               ? "SUMO has no model of a constant distance: such vehicles run there with a time gap of nearly 0 s, and "
                 "collide by its count."
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
    const std::string vehicles = run_watched(simulation, end_s, writers, on_progress)[0];
    if (has_sumo()) make_net_file(staged.path());
    staged.commit(kNetFile);
    const std::string note = stand_in_note(model);
    return note.empty() ? vehicles : vehicles + "\n" + note;
}

std::size_t population_index(const Scenario& scenario, const std::string& name) {
    std::string known;
    for (std::size_t k = 0; k < scenario.populations.size(); ++k) {
        if (scenario.populations[k].name == name) return k;
        known += (known.empty() ? "" : ", ") + scenario.populations[k].name;
    }
    throw InputError(fmt::format("there is no population '{}'; known: {}", name, known));
}

bool has_sumo() {
    return !run_process({"netconvert", "--version"}, ".").failed() && !run_process({"sumo", "--version"}, ".").failed();
}

std::string netconvert_command(const std::filesystem::path& folder) {
    std::string command = "cd '" + folder.string() + "' &&";
    for (const std::string& word : netconvert_words()) command += " " + word;
    return command;
}

void make_net_file(const std::filesystem::path& folder) {
    const EndedProcess ended = run_process(netconvert_words(), folder);
    if (!ended.failed()) return;
    throw InputError(fmt::format("netconvert made no network of {}:\n{}", folder.string(), ended.words));
}

}  // namespace stopline

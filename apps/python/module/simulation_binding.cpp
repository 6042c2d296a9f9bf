#include <algorithm>
#include <limits>
#include <map>
#include <stdexcept>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <pybind11/numpy.h>
#include <pybind11/stl.h>

#include "base/containers/index.h"
#include "base/nan.h"
#include "module/bindings.h"
#include "runs/network/network_run.h"
#include "runs/run_kind.h"
#include "scenario/build_model.h"
#include "scenario/kinds/network_kind.h"
#include "sim/perception/look_ahead.h"
#include "sim/step/simulation.h"

namespace stopline::python {

namespace {

namespace py = pybind11;

template <class Number>
using Values = py::array_t<Number, py::array::c_style | py::array::forcecast>;

Model model_of(const Scenario& scenario, std::size_t population) {
    if (population >= scenario.populations.size()) {
        throw std::out_of_range(
            fmt::format("population {}: the scenario has {} populations", population, scenario.populations.size()));
    }
    return run_kind(scenario).name == kRunAsNetwork ? network_model(scenario, population)
                                                    : build_model(scenario, population);
}

// Makes arrays with one value for each vehicle, in the order of the lanes.
class VehicleColumns {
public:
    explicit VehicleColumns(const Simulation& simulation) : model_(simulation.model()), state_(simulation.state()) {
        std::size_t k = 0;
        for (int lane = 0; lane < static_cast<int>(state_.blocks.size()); ++lane) {
            const LaneBlock& block = state_.blocks[at(lane)];
            for (int slot = block.first; slot < block.past_last(); ++slot) set(k++, lane, slot);
        }
    }

    const py::dict& dictionary() const { return columns_; }

private:
    static py::ssize_t vehicles_of(const State& state) {
        py::ssize_t vehicles = 0;
        for (const LaneBlock& block : state.blocks) vehicles += static_cast<py::ssize_t>(block.count);
        return vehicles;
    }
    // Adds an array to the dictionary and returns its memory.
    template <class Number>
    Number* add(const char* name) {
        py::array_t<Number> array(vehicles_);
        columns_[name] = array;
        return array.mutable_data();
    }

    void set(std::size_t k, int lane, int slot) {
        const VehicleArrays& v = state_.vehicles;
        const std::size_t i = at(slot);
        id_[k] = v.id[i];
        lane_[k] = lane;
        policy_[k] = v.policy[i];
        position_m_[k] = v.position_m[i];
        speed_mps_[k] = v.speed_mps[i];
        acceleration_mps2_[k] = v.acceleration_mps2[i];
        length_m_[k] = v.length_m[i];
        speed_limit_mps_[k] = state_.plan.free_speed_mps(lane, v.policy[i]);
        const bool is_first = slot == state_.blocks[at(lane)].first;
        const LeaderAhead ahead = is_first ? leader_ahead(state_, lane, slot, model_.common_driver().cacc.radar_range_m)
                                           : LeaderAhead{slot - 1, 0.0};
        const bool has_leader = ahead.slot >= 0;
        const std::size_t j = has_leader ? at(ahead.slot) : 0;
        leader_id_[k] = has_leader ? v.id[j] : -1;
        gap_m_[k] = has_leader
                        ? ahead.lane_start_m + v.position_m[j] - static_cast<double>(v.length_m[j]) - v.position_m[i]
                        : kNan;
        leader_speed_mps_[k] = has_leader ? v.speed_mps[j] : kNan;
        leader_acceleration_mps2_[k] = has_leader ? static_cast<double>(v.acceleration_mps2[j]) : kNan;
    }

    const Model& model_;
    const State& state_;
    py::ssize_t vehicles_ = vehicles_of(state_);
    py::dict columns_;
    int* id_ = add<int>("id");
    int* lane_ = add<int>("lane");
    int* policy_ = add<int>("policy");
    double* position_m_ = add<double>("position_m");
    double* speed_mps_ = add<double>("speed_mps");
    double* acceleration_mps2_ = add<double>("acceleration_mps2");
    double* length_m_ = add<double>("length_m");
    double* speed_limit_mps_ = add<double>("speed_limit_mps");
    int* leader_id_ = add<int>("leader_id");
    double* gap_m_ = add<double>("gap_m");
    double* leader_speed_mps_ = add<double>("leader_speed_mps");
    double* leader_acceleration_mps2_ = add<double>("leader_acceleration_mps2");
};

// A simulation that Python steps. It owns copies of all that the simulation refers to.
class SteppedSimulation {
public:
    SteppedSimulation(const Scenario& scenario, std::size_t population, int threads)
        : scenario_(scenario), model_(model_of(scenario, population)), simulation_(model_, threads) {}

    void step(int steps) {
        for (int k = 0; k < steps; ++k) simulation_.step();
    }
    void run_until(double time_s) { simulation_.run_until(time_s); }
    const Simulation& simulation() const { return simulation_; }
    const Model& model() const { return model_; }
    double step_s() const { return model_.step_s; }

    py::dict vehicles() const { return VehicleColumns(simulation_).dictionary(); }

    void set_acceleration(const Values<int>& vehicles, const Values<double>& accelerations_mps2) {
        if (vehicles.size() != accelerations_mps2.size()) {
            throw std::invalid_argument(
                fmt::format("{} vehicles, but {} accelerations", vehicles.size(), accelerations_mps2.size()));
        }
        for (py::ssize_t k = 0; k < vehicles.size(); ++k)
            simulation_.request_acceleration(vehicles.data()[k], accelerations_mps2.data()[k]);
    }
    void release(const Values<int>& vehicles) {
        for (py::ssize_t k = 0; k < vehicles.size(); ++k)
            simulation_.request_acceleration(vehicles.data()[k], std::numeric_limits<double>::quiet_NaN());
    }
    int set_policy(const Values<int>& vehicles, const std::string& policy) {
        int changed = 0;
        for (py::ssize_t k = 0; k < vehicles.size(); ++k)
            changed += simulation_.set_policy(vehicles.data()[k], policy_number(policy)) ? 1 : 0;
        return changed;
    }
    void set_phase(int signal, int phase) {
        if (signal < 0) throw std::invalid_argument("the number of a signal is 0 or more");
        simulation_.request_phase(at(signal), phase);
    }

    std::vector<std::string> policies() const {
        std::vector<std::string> names;
        for (const GapPolicy& policy : model_.policies) names.push_back(policy.settings.name);
        return names;
    }
    std::vector<std::string> lanes() const {
        std::vector<std::string> names;
        for (const Lane& lane : model_.graph.lanes) names.push_back(lane.name);
        return names;
    }
    std::vector<std::string> lights() const {
        std::vector<std::string> names;
        for (const Light light : simulation_.state().signals.lights)
            names.emplace_back(light == Light::green ? "green" : light == Light::yellow ? "yellow" : "red");
        return names;
    }
    std::map<std::string, std::int64_t> violations() const {
        const Violations& all = simulation_.state().records.violations;
        return {{"overlaps", all.overlaps}, {"conflicts", all.conflicts}, {"red_entries", all.red_entries}};
    }

private:
    int policy_number(const std::string& policy) const {
        const std::vector<std::string> names = policies();
        const auto found = std::find(names.begin(), names.end(), policy);
        if (found == names.end()) {
            throw std::invalid_argument(
                fmt::format("the population has no policy '{}'; its policies are: {}", policy, fmt::join(names, ", ")));
        }
        return static_cast<int>(found - names.begin());
    }

    Scenario scenario_;
    Model model_;
    Simulation simulation_;
};

using Bound = py::class_<SteppedSimulation>;

void bind_control(Bound& bound) {
    bound
        .def("set_acceleration", &SteppedSimulation::set_acceleration, py::arg("vehicles"),
             py::arg("acceleration_mps2"),
             "Full dynamics: accelerations of vehicles (ids) that replace their gap law in all later steps. They are "
             "upper limits: the vehicles never accelerate more than in free driving, stop at lines, yield, keep speed "
             "limits and brake in an emergency. Human drivers also keep their own distance.")
        .def("release", &SteppedSimulation::release, py::arg("vehicles"), "Gives vehicles back to their gap laws.")
        .def("set_policy", &SteppedSimulation::set_policy, py::arg("vehicles"), py::arg("policy"),
             "Changes the spacing policy of vehicles (ids). The policy must be one of `policies`. Returns how many of "
             "the vehicles are in the network.")
        .def("set_phase", &SteppedSimulation::set_phase, py::arg("signal"), py::arg("phase"),
             "Asks a signal with the controller `external` for a phase, both counted from 0. The present green ends "
             "after its minimum. Yellow and red follow, then the phase.");
}

}  // namespace

void bind_simulation(py::module_& module) {
    Bound bound(module, "Simulation", "A simulation of one population, step by step.");
    bound
        .def(py::init<const Scenario&, std::size_t, int>(), py::arg("scenario"), py::arg("population") = 0,
             py::arg("threads") = 1)
        .def("step", &SteppedSimulation::step, py::arg("steps") = 1, py::call_guard<py::gil_scoped_release>(),
             "Runs steps. Other Python threads run meanwhile.")
        .def("run_until", &SteppedSimulation::run_until, py::arg("time_s"), py::call_guard<py::gil_scoped_release>(),
             "Runs steps up to a time.")
        .def(
            "vehicles", &SteppedSimulation::vehicles,
            "Returns a dictionary of NumPy arrays with one value for each vehicle: id, lane, policy, position_m (front, "
            "from the start of the lane), speed_mps, acceleration_mps2, length_m, speed_limit_mps, leader_id (-1: "
            "none), gap_m (net gap), leader_speed_mps, leader_acceleration_mps2. The numbers of lanes and policies are "
            "indices in `lanes` and `policies`.")
        .def_property_readonly("time_s", [](const SteppedSimulation& s) { return s.simulation().time_s(); })
        .def_property_readonly("step_s", &SteppedSimulation::step_s)
        .def_property_readonly("lanes", &SteppedSimulation::lanes, "names of the lanes")
        .def_property_readonly("policies", &SteppedSimulation::policies, "spacing policies of the population")
        .def_property_readonly("lights", &SteppedSimulation::lights, "light of each signal group")
        .def_property_readonly(
            "phases", [](const SteppedSimulation& s) { return s.simulation().state().signals.phase; },
            "phase of each signal, counted from 0; -1: none")
        .def_property_readonly("entered",
                               [](const SteppedSimulation& s) { return s.simulation().state().records.entered; })
        .def_property_readonly("exited",
                               [](const SteppedSimulation& s) { return s.simulation().state().records.exited; })
        .def_property_readonly("violations", &SteppedSimulation::violations)
        .def_property_readonly(
            "state_hash",
            [](const SteppedSimulation& s) { return fmt::format("{:016x}", s.simulation().state_hash()); },
            "hash of the present state; equal states have equal hashes");
    bind_control(bound);
}

}  // namespace stopline::python

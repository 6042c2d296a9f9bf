#include <algorithm>
#include <cstdint>
#include <map>
#include <mutex>
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
        : scenario_(scenario), model_(model_of(scenario, population)), simulation_(model_, checked_threads(threads)) {}

    // Runs steps up to a tick. Other Python threads run meanwhile, and Ctrl-C ends the call.
    void run_to_tick(std::int64_t end_tick) {
        constexpr std::int64_t kStepsAtOnce = 100;
        const Lock lock = exclusive();
        while (simulation_.state().tick < end_tick) {
            {
                const py::gil_scoped_release other_threads_run;
                const std::int64_t next = std::min(end_tick, simulation_.state().tick + kStepsAtOnce);
                simulation_.run_until(model_.time_s(next));
            }
            if (PyErr_CheckSignals() != 0) throw py::error_already_set();
        }
    }
    void step(int steps) {
        if (steps < 0) throw std::invalid_argument(fmt::format("{} steps: the number must be 0 or more", steps));
        run_to_tick(tick() + steps);
    }
    void run_until(double time_s) {
        constexpr double kLongest_s = 1e7;
        if (!(time_s <= kLongest_s))
            throw std::invalid_argument(fmt::format("{} s: the time must be at most {} s", time_s, kLongest_s));
        run_to_tick(to_ticks(time_s, model_.step_s));
    }
    std::int64_t tick() {
        const Lock lock = exclusive();
        return simulation_.state().tick;
    }
    // Returns what `visit` returns for the simulation, while no other thread uses it.
    template <class Visit>
    auto read(Visit visit) {
        const Lock lock = exclusive();
        return visit(simulation_);
    }
    double step_s() const { return model_.step_s; }

    py::dict vehicles() {
        const Lock lock = exclusive();
        return VehicleColumns(simulation_).dictionary();
    }

    void set_acceleration(const py::object& vehicles, const Values<double>& accelerations_mps2) {
        const Lock lock = exclusive();
        const std::vector<int> ids = ids_of(vehicles);
        if (static_cast<py::ssize_t>(ids.size()) != accelerations_mps2.size()) {
            throw std::invalid_argument(
                fmt::format("{} vehicles, but {} accelerations", ids.size(), accelerations_mps2.size()));
        }
        for (std::size_t k = 0; k < ids.size(); ++k)
            simulation_.request_acceleration(ids[k], accelerations_mps2.data()[k]);
    }
    void release(const py::object& vehicles) {
        const Lock lock = exclusive();
        for (const int id : ids_of(vehicles)) simulation_.request_acceleration(id, kNan);
    }
    int set_policy(const py::object& vehicles, const std::string& policy) {
        const Lock lock = exclusive();
        const int number = policy_number(policy);
        int changed = 0;
        for (const int id : ids_of(vehicles)) changed += simulation_.set_policy(id, number) ? 1 : 0;
        return changed;
    }
    void set_phase(int signal, int phase) {
        const Lock lock = exclusive();
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

private:
    using Lock = std::unique_lock<std::mutex>;

    static int checked_threads(int threads) {
        if (threads < 1 || threads > kMaxThreads)
            throw std::invalid_argument(fmt::format("{} threads: allowed are 1 to {}", threads, kMaxThreads));
        return threads;
    }
    // A simulation serves one Python thread at a time.
    Lock exclusive() {
        Lock lock(mutex_, std::try_to_lock);
        if (!lock) throw std::runtime_error("another thread uses this simulation now");
        return lock;
    }
    // Returns the ids of vehicles. Throws if one of them is no whole number, or has not entered the network.
    std::vector<int> ids_of(const py::object& vehicles) const {
        const py::array array = py::array::ensure(vehicles);
        if (!array || (array.size() > 0 && array.dtype().kind() != 'i' && array.dtype().kind() != 'u'))
            throw std::invalid_argument("the ids of vehicles must be whole numbers");
        const py::array_t<std::int64_t, py::array::c_style | py::array::forcecast> numbers(array);
        std::vector<int> ids;
        for (py::ssize_t k = 0; k < numbers.size(); ++k) {
            const std::int64_t id = numbers.data()[k];
            if (id < 0 || id >= simulation_.state().insertion.next_id)
                throw std::invalid_argument(fmt::format("vehicle {} has not entered the network", id));
            ids.push_back(static_cast<int>(id));
        }
        return ids;
    }
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
    std::mutex mutex_;
};

std::vector<std::string> lights_of(const Simulation& simulation) {
    std::vector<std::string> names;
    for (const Light light : simulation.state().signals.lights)
        names.emplace_back(light == Light::green ? "green" : light == Light::yellow ? "yellow" : "red");
    return names;
}

std::map<std::string, std::int64_t> violations_of(const Simulation& simulation) {
    const Violations& all = simulation.state().records.violations;
    return {{"overlaps", all.overlaps}, {"conflicts", all.conflicts}, {"red_entries", all.red_entries}};
}

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
        .def("step", &SteppedSimulation::step, py::arg("steps") = 1, "Runs steps. Other Python threads run meanwhile.")
        .def("run_until", &SteppedSimulation::run_until, py::arg("time_s"), "Runs steps up to a time.")
        .def(
            "vehicles", &SteppedSimulation::vehicles,
            "Returns a dictionary of NumPy arrays with one value for each vehicle: id, lane, policy, position_m (front, "
            "from the start of the lane), speed_mps, acceleration_mps2, length_m, speed_limit_mps, leader_id (-1: "
            "none), gap_m (net gap), leader_speed_mps, leader_acceleration_mps2. The numbers of lanes and policies are "
            "indices in `lanes` and `policies`.")
        .def_property_readonly(
            "time_s", [](SteppedSimulation& s) { return s.read([](const Simulation& one) { return one.time_s(); }); })
        .def_property_readonly("step_s", &SteppedSimulation::step_s)
        .def_property_readonly("lanes", &SteppedSimulation::lanes, "names of the lanes")
        .def_property_readonly("policies", &SteppedSimulation::policies, "spacing policies of the population")
        .def_property_readonly(
            "lights", [](SteppedSimulation& s) { return s.read(lights_of); }, "light of each signal group")
        .def_property_readonly(
            "phases",
            [](SteppedSimulation& s) {
                return s.read([](const Simulation& one) { return one.state().signals.phase; });
            },
            "phase of each signal, counted from 0; -1: none")
        .def_property_readonly("entered",
                               [](SteppedSimulation& s) {
                                   return s.read([](const Simulation& one) { return one.state().records.entered; });
                               })
        .def_property_readonly("exited",
                               [](SteppedSimulation& s) {
                                   return s.read([](const Simulation& one) { return one.state().records.exited; });
                               })
        .def_property_readonly("violations", [](SteppedSimulation& s) { return s.read(violations_of); })
        .def_property_readonly(
            "state_hash",
            [](SteppedSimulation& s) {
                return s.read([](const Simulation& one) { return fmt::format("{:016x}", one.state_hash()); });
            },
            "hash of the present state; equal states have equal hashes");
    bind_control(bound);
}

}  // namespace stopline::python

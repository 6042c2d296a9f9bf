#include <string>
#include <vector>

#include <fmt/format.h>
#include <pybind11/stl.h>

#include "module/bindings.h"
#include "scenario/load_scenario.h"

namespace stopline::python {

namespace {

std::vector<std::string> names_of(const std::vector<PopulationSettings>& populations) {
    std::vector<std::string> names;
    for (const PopulationSettings& population : populations) names.push_back(population.name);
    return names;
}

}  // namespace

void bind_scenario(pybind11::module_& module) {
    namespace py = pybind11;
    py::class_<Scenario>(module, "Scenario", "A scenario file that has been loaded and checked.")
        .def(py::init([](const std::string& file, const std::vector<std::string>& settings) {
                 return load_scenario(file, settings);
             }),
             py::arg("file"), py::arg("settings") = std::vector<std::string>())
        .def_readonly("name", &Scenario::name)
        .def_readonly("title", &Scenario::title)
        .def_readonly("fidelity", &Scenario::fidelity, "'full' or 'meso'")
        .def_readonly("duration_s", &Scenario::duration_s)
        .def_readonly("seed", &Scenario::seed)
        .def_property_readonly("step_s", &Scenario::tick_s)
        .def_property_readonly("populations", [](const Scenario& scenario) { return names_of(scenario.populations); })
        .def("__repr__", [](const Scenario& scenario) {
            return fmt::format("<stopline.Scenario '{}', {} populations>", scenario.name, scenario.populations.size());
        });
}

}  // namespace stopline::python

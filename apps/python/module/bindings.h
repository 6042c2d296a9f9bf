// The parts of the Python module. Each function declares the classes of one source file.
#pragma once

#include <pybind11/pybind11.h>

namespace stopline::python {

inline constexpr int kMaxThreads = 1024;

void bind_scenario(pybind11::module_& module);
void bind_tables(pybind11::module_& module);
void bind_run(pybind11::module_& module);
void bind_simulation(pybind11::module_& module);

}  // namespace stopline::python

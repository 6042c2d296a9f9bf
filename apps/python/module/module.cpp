// The Python module stopline._core.
#include <pybind11/pybind11.h>

#include "base/input_error.h"
#include "base/version.h"
#include "module/bindings.h"

PYBIND11_MODULE(_core, module) {
    namespace py = pybind11;
    module.doc() = "Core of the package stopline";
    py::register_exception<stopline::InputError>(module, "InputError", PyExc_ValueError).attr("__doc__") =
        "The error for unusable input: the message names file, line, field and allowed values.";
    module.def("version", &stopline::version, "Returns version and revision of the build.");
    stopline::python::bind_scenario(module);
    stopline::python::bind_tables(module);
    stopline::python::bind_run(module);
    stopline::python::bind_simulation(module);
}

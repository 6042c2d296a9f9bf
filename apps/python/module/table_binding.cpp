#include <algorithm>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <pybind11/numpy.h>
#include <pybind11/stl.h>

#include "module/bindings.h"
#include "module/table.h"

namespace stopline::python {

namespace {

namespace py = pybind11;

std::vector<std::string> names_of(const Table& table) {
    std::vector<std::string> names;
    for (const Column& column : table.columns) names.push_back(column.name);
    return names;
}

// Returns a column of numbers as an array that shares the memory of the table, and a column of texts as a list.
py::object column_of(const std::shared_ptr<const Table>& table, const std::string& name) {
    const auto found = std::find_if(table->columns.begin(), table->columns.end(),
                                    [&](const Column& column) { return column.name == name; });
    if (found == table->columns.end()) {
        throw py::key_error(
            fmt::format("'{}'; the columns of {} are: {}", name, table->name, fmt::join(names_of(*table), ", ")));
    }
    if (!found->has_numbers) return py::cast(found->texts);
    // The array keeps the table alive. It is read-only, because all arrays of the column share the memory.
    const auto owner = py::capsule(new std::shared_ptr<const Table>(table), [](void* pointer) {
        delete static_cast<std::shared_ptr<const Table>*>(pointer);  // NOLINT(cppcoreguidelines-owning-memory)
    });
    py::array_t<double> array(static_cast<py::ssize_t>(found->numbers.size()), found->numbers.data(), owner);
    array.attr("flags").attr("writeable") = false;
    return array;
}

py::object to_pandas(const std::shared_ptr<const Table>& table) {
    py::dict columns;
    for (const Column& column : table->columns) columns[py::str(column.name)] = column_of(table, column.name);
    return py::module_::import("pandas").attr("DataFrame")(columns);
}

}  // namespace

void bind_tables(py::module_& module) {
    py::class_<Table, std::shared_ptr<Table>>(module, "Table", "A table of results. table['name_unit'] is a column.")
        .def_readonly("name", &Table::name)
        .def_property_readonly("columns", &names_of, "names of the columns, which end with the unit")
        .def("__getitem__",
             [](const std::shared_ptr<Table>& table, const std::string& name) { return column_of(table, name); })
        .def("__contains__",
             [](const Table& table, const std::string& name) {
                 return std::any_of(table.columns.begin(), table.columns.end(),
                                    [&](const Column& column) { return column.name == name; });
             })
        .def("__len__", [](const Table& table) { return table.rows; })
        .def("to_pandas", &to_pandas, "Returns the table as a pandas.DataFrame.")
        .def("__repr__", [](const Table& table) {
            return fmt::format("<stopline.Table '{}', {} rows, {} columns>", table.name, table.rows,
                               table.columns.size());
        });
}

}  // namespace stopline::python

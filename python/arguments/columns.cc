#include "arguments/columns.h"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>

namespace python {
namespace {

std::string typeOf(const py::handle& object) {
  return py::type::handle_of(object).attr("__name__").cast<std::string>();
}

/// (name, values) of each column.
py::list itemsOf(const py::object& columns, const std::string& name) {
  if (py::hasattr(columns, "columns") && py::hasattr(columns, "to_numpy")) {
    const py::list names(columns.attr("columns"));
    const py::object rows = columns.attr("to_numpy")();
    py::list items;
    for (std::size_t i = 0; i < names.size(); ++i) {
      items.append(py::make_tuple(names[i], rows[py::make_tuple(py::ellipsis(), i)]));
    }
    return items;
  }
  if (py::hasattr(columns, "items")) return py::list(columns.attr("items")());
  throw py::type_error(
      fmt::format("{}: a {}, must be a dict of columns or a DataFrame", name, typeOf(columns)));
}

}  // namespace

Numbers numbersOf(const py::handle& values, const std::string& what) {
  if (values.is_none()) throw py::type_error(what + ": None, must be numbers");
  try {
    const py::object array = py::module_::import("numpy").attr("asarray")(values);
    const py::object type = array.attr("dtype");
    // which NumPy would make numbers of all the same
    if (std::string("cmM").find(type.attr("kind").cast<std::string>()) != std::string::npos) {
      throw py::type_error(
          fmt::format("{}: {}, must be numbers", what, py::str(type).cast<std::string>()));
    }
    return Numbers(array);
  } catch (const py::error_already_set& error) {
    if (!error.matches(PyExc_TypeError) && !error.matches(PyExc_ValueError)) throw;
    throw std::invalid_argument(
        fmt::format("{}: {}", what, py::str(error.value()).cast<std::string>()));
  }
}

Eigen::VectorXd columnOf(const py::handle& values, const std::string& what) {
  const Numbers numbers = numbersOf(values, what);
  if (numbers.ndim() == 0) {
    throw py::type_error(
        fmt::format("{}: a single {}, must be a list or array of numbers", what, typeOf(values)));
  }
  if (numbers.ndim() > 2 || (numbers.ndim() == 2 && numbers.shape(1) != 1)) {
    const auto shape = numbers.attr("shape").cast<std::vector<py::ssize_t>>();
    throw std::invalid_argument(fmt::format("{}: an array of {} numbers, must have one dimension",
                                            what, fmt::join(shape, " x ")));
  }
  return Eigen::Map<const Eigen::VectorXd>(numbers.data(), numbers.size());
}

bio::Table tableOf(const py::object& columns, const std::string& name) {
  bio::Table table;
  const py::list items = itemsOf(columns, name);
  for (const py::handle item : items) {
    const auto [key, values] = item.cast<std::pair<py::object, py::object>>();
    if (!py::isinstance<py::str>(key)) {
      throw py::type_error(fmt::format("{}: column name {} is a {}, must be a str", name,
                                       py::repr(key).cast<std::string>(), typeOf(key)));
    }
    const auto called = key.cast<std::string>();
    const Eigen::VectorXd column = columnOf(values, fmt::format("{}: column '{}'", name, called));
    if (std::find(table.columns.begin(), table.columns.end(), called) != table.columns.end()) {
      throw std::invalid_argument(fmt::format("{}: column '{}' is given twice", name, called));
    }
    const auto index = static_cast<Eigen::Index>(table.columns.size());
    if (index == 0) table.values.resize(column.size(), static_cast<Eigen::Index>(items.size()));
    table.columns.push_back(called);
    if (column.size() != table.values.rows()) {
      throw std::invalid_argument(fmt::format("{}: column '{}' has {} rows, must be {} as '{}' has",
                                              name, called, column.size(), table.values.rows(),
                                              table.columns.front()));
    }
    table.values.col(index) = column;
  }
  return table;
}

py::dict columnsOf(const bio::Table& table) {
  py::dict columns;
  for (std::size_t i = 0; i < table.columns.size(); ++i) {
    columns[table.columns[i].c_str()] =
        Eigen::VectorXd(table.values.col(static_cast<Eigen::Index>(i)));
  }
  return columns;
}

}  // namespace python

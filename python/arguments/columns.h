#pragma once

#include <string>

#include "bio/tables/table_file.h"
#include "namespace.h"

namespace python {

using Numbers = py::array_t<double, py::array::forcecast | py::array::c_style>;

/// The array that NumPy makes of values, in any number of dimensions. A message is one line.
/// @param what the argument, for messages
/// @throws py::type_error for None and complex numbers, dates and durations
/// @throws std::invalid_argument for what holds no numbers or is ragged
Numbers numbersOf(const py::handle& values, const std::string& what);

/// Numbers of one dimension, n or n × 1.
/// @throws py::type_error for a single number, and as numbersOf
/// @throws std::invalid_argument for more dimensions, and as numbersOf
Eigen::VectorXd columnOf(const py::handle& values, const std::string& what);

/// A table of columns: {name: values}, or what has `columns` and `to_numpy`, such as a DataFrame of
/// pandas, whose index is left out.
/// @param name of the table, for messages, which name the column, too
/// @throws py::type_error for what is no table, a name that is no str, and as columnOf
/// @throws std::invalid_argument for columns of different lengths, a name that is given twice, and
/// as columnOf
bio::Table tableOf(const py::object& columns, const std::string& name);
/// The table as make_trial takes it.
py::dict columnsOf(const bio::Table& table);

}  // namespace python

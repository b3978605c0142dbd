#pragma once

#include <string>

#include "namespace.h"

namespace python {

/// The name of a file as a function takes it: a str or what has __fspath__, such as pathlib.Path.
struct FileName {
  std::string text;
};

}  // namespace python

template <>
struct pybind11::detail::type_caster<python::FileName> {
  PYBIND11_TYPE_CASTER(python::FileName, const_name("str | os.PathLike"));

  bool load(handle source, bool) {
    PyObject* encoded = nullptr;
    if (PyUnicode_FSConverter(source.ptr(), &encoded) == 0) {
      PyErr_Clear();
      return false;
    }
    value.text = reinterpret_steal<bytes>(encoded);
    return true;
  }
  static handle cast(const python::FileName& file, return_value_policy, handle) {
    return str(file.text).release();
  }
};

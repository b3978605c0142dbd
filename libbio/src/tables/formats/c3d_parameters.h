#pragma once

#include <map>
#include <string>
#include <vector>

#include "tables/formats/bytes.h"

namespace bio::tables {

/// Is this a C3D file, by its first bytes?
bool isC3d(std::string_view bytes);

/// The parameter section of a C3D file: values by "GROUP:NAME" in capitals. Source: The C3D File
/// Format, user guide (Motion Lab Systems, c3d.org), chapter "The parameter section".
class C3dParameters {
 public:
  /// @param start of the section [byte], its number format in `bytes`
  /// @throws FileError for a chain of entries that leaves the file or goes back
  C3dParameters(const Bytes& bytes, std::size_t start);

  bool has(const std::string& name) const { return values_.count(name) > 0; }

  /// All numbers of a parameter (a byte or a 16-bit integer without its sign if `isUnsigned`); none
  /// if it is absent.
  /// @throws FileError if it holds text
  std::vector<double> numbers(const std::string& name, bool isUnsigned = false) const;

  /// Its texts without blanks at the ends; of NAME, NAME2, NAME3 … together.
  std::vector<std::string> texts(const std::string& name) const;
  /// Likewise for numbers.
  std::vector<double> allNumbers(const std::string& name, bool isUnsigned = false) const;

 private:
  struct Value {
    int type = 0;  ///< bytes of an element, −1: characters
    std::vector<std::size_t> dimensions;
    std::size_t at = 0;     ///< [byte]
    std::size_t count = 0;  ///< elements
  };
  struct Entry {
    int group = 0;
    std::string name;
    Value value;
  };
  Value valueAt(std::size_t at, const std::string& name) const;

  Bytes bytes_;
  std::map<std::string, Value> values_;
};

}  // namespace bio::tables

#pragma once

#include <tinyxml2.h>

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "bio/tables/file_error.h"

/// Properties of OpenSim objects in an XML tree, with messages that name file, line and element.
namespace bio::osim {

using Element = tinyxml2::XMLElement;

/// A parsed file: its name for messages, and the objects of its <defaults>, which OpenSim takes
/// properties from that an object of the same class does not state itself.
struct Source {
  std::string file;
  std::map<std::string, const Element*> defaults;
};

enum class Rule { finite, notNegative, positive };

/// A text that is no finite number.
class UnreadableNumber : public FileError {
 public:
  using FileError::FileError;
};

/// "WrapCylinder 'TRI'", with "of <outer object>" where the element alone would not be found.
std::string label(const Element& element);

/// Throws FileError "file:line: label: message"; the line is that of `where`, if given.
[[noreturn]] void fail(const Source& source, const Element& element, const std::string& message,
                       const Element* where = nullptr);

/// The element's name attribute; FileError when it is absent or empty.
std::string nameOf(const Source& source, const Element& element);

/// Child `property` of the object, else of its class's default object, else null.
const Element* findProperty(const Source& source, const Element& object, const char* property);

/// The element's text without surrounding white space; empty if there is none.
std::string trimmedText(const Element* element);

/// Each FileError when the text is not of that kind, or the property is absent without a fallback.
double readNumber(const Source& source, const Element& object, const char* property,
                  const char* unit, Rule rule, std::optional<double> fallback = {});
std::vector<double> readNumbers(const Source& source, const Element& object, const char* property,
                                const char* unit, std::optional<std::size_t> count,
                                std::optional<std::vector<double>> fallback = {});
bool readFlag(const Source& source, const Element& object, const char* property, bool fallback);
std::string readText(const Source& source, const Element& object, const char* property,
                     std::optional<std::string> fallback = {});

/// The objects of a set, `<SET><objects>…`; empty if there is no such set.
std::vector<const Element*> objectsOf(const Element& owner, const char* set);

/// All child elements.
std::vector<const Element*> childrenOf(const Element* parent);

}  // namespace bio::osim

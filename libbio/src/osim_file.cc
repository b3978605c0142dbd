#include "bio/osim_file.h"

#include <fmt/format.h>
#include <tinyxml2.h>

#include <fstream>
#include <sstream>

#include "bio/file_error.h"
#include "osim/read_model.h"
#include "text_file.h"

namespace bio {
namespace {

void parse(tinyxml2::XMLDocument& document, const std::string& text, const std::string& file) {
  if (text.find_first_not_of(" \t\r\n") == std::string::npos) {
    throw FileError(file + ": is empty, must be an OpenSim model");
  }
  if (document.Parse(text.c_str(), text.size()) != tinyxml2::XML_SUCCESS) {
    throw FileError(fmt::format("{}:{}: is not well-formed XML ({})", file, document.ErrorLineNum(),
                                tinyxml2::XMLDocument::ErrorIDToName(document.ErrorID())));
  }
}

}  // namespace

Model readOsim(const std::filesystem::path& file) {
  tinyxml2::XMLDocument document;
  parse(document, readTextFile(file), file.string());
  return osim::readModel(document, file.string());
}

}  // namespace bio

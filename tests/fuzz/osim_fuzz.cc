#include "model_reading.h"

// A stranger's .osim, written as a fresh document.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static fuzz::InputFile file("model.osim"), copy("copy.osim");
  fuzz::readsModel(
      file, copy, data, size,
      [](const auto&, const bio::Model& model, const auto& to) { bio::writeOsim(model, to); });
  return 0;
}

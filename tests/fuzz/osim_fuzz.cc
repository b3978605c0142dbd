#include "bio/opensim/osim_file.h"
#include "bio/review/model_review.h"
#include "reading.h"

// A stranger's model is read and reviewed, or refused; what was read can be written and read again.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static fuzz::InputFile file("model.osim"), copy("copy.osim");
  bio::Model model;
  const auto& path = file.holding(fuzz::textOf(data, size));
  if (!fuzz::readsOrRefuses<bio::FileError>([&] { model = bio::readOsim(path); })) return 0;
  bio::reviewNumbers(model);
  // A model that OpenSim would take may hold what a fresh document cannot say.
  const bool written = fuzz::readsOrRefuses<std::invalid_argument>([&] {
    try {
      bio::writeOsim(model, copy.path());
    } catch (const bio::FileError& refusal) {
      throw std::invalid_argument(refusal.what());
    }
  });
  if (written) bio::readOsim(copy.path());
  return 0;
}

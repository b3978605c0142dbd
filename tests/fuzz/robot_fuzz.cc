#include "bio/opensim/osim_file.h"
#include "bio/review/model_review.h"
#include "reading.h"

// A stranger's URDF or MJCF is read and reviewed, or refused; what was read can be written as an
// OpenSim model and read again.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static fuzz::InputFile file("robot.xml"), copy("copy.osim");
  bio::Model model;
  const auto& path = file.holding(fuzz::textOf(data, size));
  if (!fuzz::readsOrRefuses<bio::FileError>([&] { model = bio::readOsim(path); })) return 0;
  bio::reviewNumbers(model);
  const bool written = fuzz::readsOrRefuses<std::invalid_argument>([&] {
    try {
      bio::rewriteOsim(path, model, copy.path());
    } catch (const bio::FileError& refusal) {
      throw std::invalid_argument(refusal.what());
    }
  });
  if (written) bio::readOsim(copy.path());
  return 0;
}

#pragma once

#include "bio/opensim/osim_file.h"
#include "bio/review/model_review.h"
#include "reading.h"

namespace fuzz {

/// A stranger's model is read and reviewed, or refused; what was read can be written and read
/// again. A model that OpenSim would take may hold what a document cannot say.
/// @param write  takes the input's path, the model and the copy's path
template <class Write>
void readsModel(InputFile& file, InputFile& copy, const std::uint8_t* data, std::size_t size,
                const Write& write) {
  bio::Model model;
  const auto& path = file.holding(textOf(data, size));
  if (!readsOrRefuses<bio::FileError>([&] { model = bio::readOsim(path); })) return;
  bio::reviewNumbers(model);
  const bool written = readsOrRefuses<std::invalid_argument>([&] {
    try {
      write(path, model, copy.path());
    } catch (const bio::FileError& refusal) {
      throw std::invalid_argument(refusal.what());
    }
  });
  if (written) bio::readOsim(copy.path());
}

}  // namespace fuzz

#include <cmath>

#include "bio/emg/emg_config.h"
#include "reading.h"

namespace {

// A second and a half of two channels and a point, as their file would be read.
bio::Recording recording() {
  bio::Recording out;
  out.file = "recording.csv";
  for (const auto& [name, unit] : {std::pair("BIClong_uV", "uV"), std::pair("elbow_deg", "deg")}) {
    const auto wave = [](Eigen::Index i) { return std::sin(0.9 * static_cast<double>(i * i)); };
    out.channels.push_back({name, unit, 200, 0, Eigen::VectorXd::NullaryExpr(300, wave)});
  }
  for (const char* axis : {"P.x", "P.y", "P.z"}) {
    out.channels.push_back({axis, "m", 50, 0, Eigen::VectorXd::LinSpaced(75, 0, 1)});
  }
  return out;
}

}  // namespace

// A configuration is read and applied, or refused.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static fuzz::InputFile file("emg.toml");
  static const bio::Recording signal = recording();
  const auto& path = file.holding(fuzz::textOf(data, size));
  bio::EmgConfigFile config;
  if (!fuzz::readsOrRefuses<bio::FileError>([&] { config = bio::readEmgConfig(path.string()); })) {
    return 0;
  }
  bio::EmgConfig ready;
  for (bio::FullDeclaration& full : config.full) {
    if (!full.mvcFile.empty()) return 0;  // opens files of the machine
  }
  if (!fuzz::readsOrRefuses<bio::FileError>([&] { ready = emgConfigFor(config, signal); })) {
    return 0;
  }
  fuzz::readsOrRefuses<std::invalid_argument>([&] { excitationsFromEmg(signal, ready); });
  return 0;
}

#include <array>

#include "bio/tables/recording.h"
#include "reading.h"

namespace {

// Nothing declared, or the first two columns as a file without a header needs them.
bio::RecordingLayout layoutOf(std::uint8_t choice) {
  using enum bio::RecordingFormat;
  constexpr std::array formats = {automatic, columns, trigno,    table,
                                  emgworks,  noraxon, nexus,     listing,
                                  edf,       automatic, automatic, automatic};
  bio::RecordingLayout layout;
  layout.format = formats[choice % formats.size()];
  if (choice & 0x80) {
    layout.columns = {{.number = 1, .name = "one", .rate = 1000},
                      {.number = 2, .name = "two", .unit = "mV", .rate = 500, .scale = 1000}};
  }
  return layout;
}

}  // namespace

// The first byte chooses the layout; the rest is a recording.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static fuzz::InputFile text("a.txt"), table("a.csv");
  if (size < 1) return 0;
  auto& file = data[0] & 0x40 ? table : text;
  const auto& path = file.holding(fuzz::textOf(data + 1, size - 1));
  fuzz::readsOrRefuses<bio::FileError>([&] {
    const bio::Recording recording = bio::readRecording(path.string(), layoutOf(data[0]));
    for (const bio::Channel& channel : recording.channels) {
      if (!(channel.rate > 0) || channel.values.size() < 2) {
        fuzz::finding("channel", channel.name.c_str());
      }
    }
  });
  return 0;
}

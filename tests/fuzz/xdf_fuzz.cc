#include "bio/tables/xdf_file.h"

#include <cmath>

#include "reading.h"

// The input is an XDF file.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  fuzz::readsOrRefuses<bio::FileError>([&] {
    const bio::XdfFile xdf = bio::xdfFrom(fuzz::textOf(data, size), "a.xdf");
    for (const bio::XdfStream& stream : xdf.streams) {
      for (const bio::Channel& channel : stream.channels) {
        if (!(channel.rate > 0) || !std::isfinite(channel.startTime)) {
          fuzz::finding("channel", channel.name.c_str());
        }
        if (static_cast<std::size_t>(channel.values.size()) > 2 * size + 1000) {
          fuzz::finding("channel", "longer than the file lets expect");
        }
        if (channel.values.array().isInf().any()) fuzz::finding("channel", "infinite");
      }
    }
  });
  return 0;
}

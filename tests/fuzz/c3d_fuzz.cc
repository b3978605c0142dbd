#include "bio/tables/c3d_file.h"

#include "reading.h"

// The input is a C3D file.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  fuzz::readsOrRefuses<bio::FileError>([&] {
    const bio::C3dFile c3d = bio::c3dFrom(fuzz::textOf(data, size), "a.c3d");
    const bio::MarkerTrajectories& markers = c3d.markers;
    const auto columns = static_cast<Eigen::Index>(3 * markers.names.size());
    if (!(markers.rate > 0)) fuzz::finding("rate", "not above 0");
    if (markers.positions.cols() != columns) fuzz::finding("markers", "columns and names differ");
    if (columns > 0 && markers.positions.rows() != markers.times.size()) {
      fuzz::finding("markers", "rows and times differ");
    }
    if (markers.positions.array().isInf().any()) fuzz::finding("markers", "infinite");
    // at most eight bytes for two, and one number per byte and channel
    const auto held = static_cast<std::size_t>(markers.positions.size());
    if (held > size) fuzz::finding("markers", "more numbers than bytes");
    for (const bio::Channel& channel : c3d.analog) {
      if (!(channel.rate > 0)) fuzz::finding("channel", channel.name.c_str());
    }
  });
  return 0;
}

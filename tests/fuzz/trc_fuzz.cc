#include "bio/tables/marker_trajectories.h"
#include "reading.h"

// The input is a TRC file.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  fuzz::readsOrRefuses<bio::FileError>([&] {
    const bio::MarkerTrajectories markers = bio::trcFrom(fuzz::textOf(data, size), "a.trc");
    if (!(markers.rate > 0)) fuzz::finding("rate", "not above 0");
    const auto columns = static_cast<Eigen::Index>(3 * markers.names.size());
    if (markers.positions.cols() != columns) fuzz::finding("markers", "columns and names differ");
    if (static_cast<std::size_t>(markers.positions.size()) > 8 * size) {
      fuzz::finding("markers", "more numbers than the file lets expect");
    }
  });
  return 0;
}

#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <vector>

#include "view/child_process.h"

namespace bio::view {

/// A picture: rows from the top, red, green and blue of each pixel.
struct Image {
  int width = 0;
  int height = 0;
  std::vector<std::uint8_t> rgb;  ///< 3·width·height
};

/// An MP4 film (H.264) made by ffmpeg from pictures handed over one by one.
class FilmWriter {
 public:
  /// @param width, height  even
  /// @throws std::runtime_error if ffmpeg cannot be started
  FilmWriter(const std::filesystem::path& file, int width, int height, double framesPerSecond,
             int threads);
  ~FilmWriter();

  /// False if ffmpeg is not installed.
  static bool available();

  /// @throws std::runtime_error if ffmpeg takes no more
  void add(const Image& image);
  /// Ends the film. @throws std::runtime_error with ffmpeg's own words if it failed
  void finish();

 private:
  [[noreturn]] void fail();

  int socket_ = -1;    ///< pictures to ffmpeg
  int messages_ = -1;  ///< what ffmpeg says
  std::unique_ptr<ChildProcess> ffmpeg_;
};

}  // namespace bio::view

#include "view/film_writer.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cerrno>
#include <stdexcept>

namespace bio::view {

FilmWriter::FilmWriter(const std::filesystem::path& file, int width, int height,
                       double framesPerSecond, int threads) {
  // A socket rather than a pipe: sending into a closed one is an error, not a signal.
  int pictures[2], words[2];
  if (socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, pictures) != 0 ||
      pipe2(words, O_CLOEXEC | O_NONBLOCK) != 0) {
    throw std::runtime_error("a connection to ffmpeg cannot be created");
  }
  socket_ = pictures[0];
  messages_ = words[0];
  ffmpeg_ = std::make_unique<ChildProcess>(
      std::vector<std::string>{"ffmpeg",
                               "-loglevel",
                               "error",
                               "-nostdin",
                               "-y",
                               "-f",
                               "rawvideo",
                               "-pixel_format",
                               "rgb24",
                               "-video_size",
                               fmt::format("{}x{}", width, height),
                               "-framerate",
                               fmt::format("{}", framesPerSecond),
                               "-i",
                               "pipe:0",
                               "-c:v",
                               "libx264",
                               "-preset",
                               "veryfast",
                               "-crf",
                               "18",
                               "-threads",
                               std::to_string(threads),
                               "-pix_fmt",
                               "yuv420p",
                               "-movflags",
                               "+faststart",
                               "-f",
                               "mp4",
                               std::filesystem::absolute(file).string()},
      std::vector<std::pair<int, int>>{{pictures[1], 0}, {words[1], 2}});
  close(pictures[1]);
  close(words[1]);
}

FilmWriter::~FilmWriter() {
  ffmpeg_.reset();
  if (socket_ >= 0) close(socket_);
  if (messages_ >= 0) close(messages_);
}

bool FilmWriter::available() {
  return findProgram("ffmpeg").has_value();
}

void FilmWriter::add(const Image& image) {
  std::size_t sent = 0;
  while (sent < image.rgb.size()) {
    const ssize_t count =
        send(socket_, image.rgb.data() + sent, image.rgb.size() - sent, MSG_NOSIGNAL);
    if (count < 0 && errno == EINTR) continue;
    if (count <= 0) fail();
    sent += static_cast<std::size_t>(count);
  }
}

void FilmWriter::finish() {
  shutdown(socket_, SHUT_WR);
  if (ffmpeg_->wait() != 0) fail();
}

void FilmWriter::fail() {
  std::string words(2000, ' ');
  const ssize_t count = read(messages_, words.data(), words.size());
  words.resize(count > 0 ? static_cast<std::size_t>(count) : 0);
  throw std::runtime_error("ffmpeg could not make the film" +
                           (words.empty() ? std::string() : ": " + words));
}

}  // namespace bio::view

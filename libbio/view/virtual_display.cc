#include "view/virtual_display.h"

#include <X11/Xlib.h>
#include <fcntl.h>
#include <poll.h>
#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <stdexcept>
#include <string>

namespace bio::view {
namespace {

constexpr int startSeconds = 20;  ///< Xvfb needs 0.1 s; a very busy machine some more

bool displayAnswers() {
  const char* name = std::getenv("DISPLAY");
  if (name == nullptr || *name == '\0') return false;
  Display* display = XOpenDisplay(nullptr);
  if (display == nullptr) return false;
  XCloseDisplay(display);
  return true;
}

/// The number that the server writes once it accepts connections; empty if it ended or is late.
std::string readNumber(int descriptor) {
  std::string text;
  for (;;) {
    pollfd ready = {descriptor, POLLIN, 0};
    const int count = poll(&ready, 1, startSeconds * 1000);
    if (count < 0 && errno == EINTR) continue;
    char letter = 0;
    if (count <= 0 || read(descriptor, &letter, 1) != 1) return {};
    if (letter == '\n') return text;
    text += letter;
  }
}

}  // namespace

VirtualDisplay::VirtualDisplay() {
  if (displayAnswers()) return;
  if (!findProgram("Xvfb")) {
    throw std::runtime_error(
        "no display to draw on: DISPLAY names none that works, and Xvfb (Debian package xvfb) is "
        "not installed");
  }
  int pipe[2];
  if (pipe2(pipe, O_CLOEXEC) != 0) throw std::runtime_error("a pipe cannot be created");
  constexpr int theirs = 3;
  server_ = std::make_unique<ChildProcess>(
      std::vector<std::string>{"Xvfb", "-displayfd", std::to_string(theirs), "-screen", "0",
                               "640x480x24", "-nolisten", "tcp", "-noreset", "+extension", "GLX"},
      std::vector<std::pair<int, int>>{{pipe[1], theirs}});
  close(pipe[1]);
  const std::string number = readNumber(pipe[0]);
  close(pipe[0]);
  if (number.empty()) {
    server_.reset();
    throw std::runtime_error("the virtual display Xvfb did not start");
  }
  setenv("DISPLAY", (":" + number).c_str(), 1);
}

VirtualDisplay::~VirtualDisplay() {
  if (server_) unsetenv("DISPLAY");
}

}  // namespace bio::view

// What the page calls of its simulation core: C functions over one LiveModel. Texts come as bytes
// of UTF-8 with their length, numbers as doubles; arrays that go out stay where they are until the
// next call. Functions that can fail return a text, empty if all is well.

#include <cstdint>
#include <cstring>
#include <exception>
#include <map>
#include <new>
#include <numbers>
#include <optional>
#include <string>
#include <vector>

#include "bio/model/units.h"
#include "bio/tables/file_error.h"
#include "explore/live_model.h"
#include "tables/text_file.h"
#include "view/system_shape.h"

namespace {

/// The files that the page carries.
std::map<std::string, std::string>& files() {
  static std::map<std::string, std::string> all;
  return all;
}

app::LiveChoice choice;
std::optional<app::LiveModel> live;
std::string text;             // that went out last
std::vector<double> numbers;  // that went out last

template <class F>
const char* attempt(F&& work) {
  text.clear();
  try {
    work();
  } catch (const std::bad_alloc&) {
    text = "there is not enough memory";
  } catch (const std::exception& error) {
    text = error.what();
    if (text.empty()) text = "unknown error";
  }
  return text.c_str();
}

void add(const Eigen::Vector3d& v) {
  numbers.insert(numbers.end(), v.begin(), v.end());
}

void add(const bio::Placement<double>& X) {
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) numbers.push_back(X.R(i, j));
  add(X.p);
}

template <class Matrix>
void addAll(const Matrix& values) {
  numbers.insert(numbers.end(), values.data(), values.data() + values.size());
}

std::string lines(const std::vector<std::string>& names) {
  std::string all;
  for (const std::string& name : names) all += bio::onOneLine(name) + "\n";
  return all;
}

}  // namespace

namespace bio {

// Instead of tables/text_file.cc: there is no file system.
std::string readTextFile(const std::filesystem::path& file) {
  const auto found = files().find(file.string());
  if (found == files().end()) throw FileError(file.string() + ": there is no such file");
  return found->second;
}

void writeTextFile(const std::filesystem::path& file, const std::string& content) {
  files()[file.string()] = content;
}

std::string onOneLine(std::string line) {
  for (char& c : line) {
    if (static_cast<unsigned char>(c) < 32 || c == 127) c = ' ';
  }
  return line;
}

}  // namespace bio

extern "C" {

void* live_allocate(std::size_t bytes) {
  return ::operator new(bytes);
}
void live_free(void* memory) {
  ::operator delete(memory);
}

void live_file(const char* name, std::size_t nameLength, const char* content, std::size_t length) {
  files()[std::string(name, nameLength)] = std::string(content, length);
}

/// What a name of the choice is.
enum Role : std::int32_t {
  isFree,
  isLocked,
  isPrescribed,
  isHeld,
  isCylinder,
  startsAt,
  ignoreExtra
};
void live_choose(std::int32_t role, const char* name, std::size_t length, double value) {
  const std::string what(name, length);
  switch (role) {
    case isFree:
      choice.system.skeleton.freeCoordinates.push_back(what);
      break;
    case isLocked:
      choice.system.skeleton.lockedValues[what] = value;
      break;
    case isPrescribed:
      choice.trial.prescribed.push_back(what);
      break;
    case isHeld:
      choice.trial.held[what] = value;
      break;
    case isCylinder:
      choice.system.wrapAsCylinder.push_back(what);
      break;
    case startsAt:
      choice.initial[what] = value;
      break;
    case ignoreExtra:
      choice.trial.ignoreExtra = true;
      break;
    default:
      break;
  }
}
/// Coordinates that the system prescribes; among the free ones, too.
void live_prescribe(const char* name, std::size_t length) {
  choice.system.prescribed.emplace_back(name, length);
}

const char* live_load(const char* model, std::size_t length) {
  return attempt([&] { live.emplace(std::string(model, length), choice); });
}

const char* live_add_trial(const char* file, std::size_t length, const char* sha,
                           std::size_t shaLength) {
  return attempt([&] { live->addTrial(std::string(file, length), std::string(sha, shaLength)); });
}

/// @param names  of parameters, one a line
const char* live_select(const char* names, std::size_t length) {
  return attempt([&] {
    std::vector<std::string> wanted;
    std::string line;
    for (std::size_t i = 0; i < length; ++i) {
      if (names[i] != '\n') {
        line += names[i];
      } else {
        wanted.push_back(std::move(line));
        line.clear();
      }
    }
    live->select(wanted);
  });
}

const char* live_run(std::uint32_t trial, const double* values, std::size_t count,
                     std::int32_t integrator, double step) {
  return attempt([&] {
    live->run(trial, Eigen::Map<const Eigen::VectorXd>(values, static_cast<Eigen::Index>(count)),
              static_cast<bio::Integrator>(integrator), step);
  });
}
/// One line; empty if the last run reached the end of the trial.
const char* live_why() {
  return live->motion().why.c_str();
}

/// Names, one a line: 0 free coordinates, 1 muscles, 2 bodies, 3 paths.
const char* live_names(std::int32_t what) {
  return attempt([&] {
    std::vector<std::string> names;
    if (what == 0) {
      for (const bio::Coordinate& coordinate : live->system().skeleton().coordinates())
        names.push_back(coordinate.name);
    } else if (what == 1) {
      for (const bio::SystemMuscle& muscle : live->system().muscles()) names.push_back(muscle.name);
    } else {
      names = what == 2 ? live->bodies() : live->paths();
    }
    text = lines(names);
  });
}

/// Series of the last run, in numbers: 0 times, 1 coordinates, 2 activations, 3 excitations (all of
/// one time together); 4 the measured channels, one after the other.
const char* live_series(std::int32_t what) {
  return attempt([&] {
    numbers.clear();
    const bio::Trajectory& motion = live->motion();
    if (what == 0) numbers = motion.time;
    if (what == 1) addAll(motion.q);
    if (what == 2) addAll(motion.activation);
    if (what == 3) addAll(live->excitations());
    if (what == 4)
      for (const Eigen::VectorXd& channel : live->measured()) addAll(channel);
  });
}

/// The bodies' placements (rotation row by row, then translation); then of each path: number of
/// points, force, activation, radius of its tube, points.
const char* live_drawing(double time) {
  return attempt([&] {
    numbers.clear();
    const app::LiveModel::Drawing drawing = live->drawingAt(time);
    for (const bio::Placement<double>& body : drawing.bodies) add(body);
    for (const app::LivePath& path : drawing.paths) {
      numbers.push_back(static_cast<double>(path.points.size()));
      numbers.push_back(path.force);
      numbers.push_back(path.activation);
      numbers.push_back(bio::view::tubeRadius(path.force > 0 ? path.force : 0));
      for (const Eigen::Vector3d& point : path.points) add(point);
    }
  });
}

/// The bodies' shapes in their frames, as bio::view::shapeNumbers() has them.
const char* live_shapes() {
  return attempt(
      [&] { numbers = bio::view::shapeNumbers(bio::view::bodyShapes(live->changedModel())); });
}

const double* live_numbers() {
  return numbers.data();
}
std::size_t live_count() {
  return numbers.size();
}
}
